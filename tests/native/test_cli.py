"""`mechsym native`."""

import json

import pytest
from click.testing import CliRunner

from mechsym.cli.catalogue import native


@pytest.fixture(autouse=True)
def home(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))


def test_info_as_json(tmp_path):
    done = CliRunner().invoke(native, ["--info", "--json"])
    found = json.loads(done.stdout)
    assert done.exit_code == 0
    assert found["cache"].startswith(str(tmp_path))
    assert set(found["flags"]) == {"fast", "strict"}
    assert found["route"] == ("C" if found["compiler"] else "numpy")


def test_info_without_compiler(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.delenv("CC", raising=False)
    done = CliRunner().invoke(native, [])
    assert "numpy (no C compiler found" in done.output
    assert "install gcc or clang" in done.output


def test_clear_empties_the_cache(tmp_path):
    folder = tmp_path / "mechsym" / "native"
    folder.mkdir(parents=True)
    (folder / "left.c").write_text("")
    done = CliRunner().invoke(native, ["--clear", "--json"])
    assert json.loads(done.output)["removed"] == 1
    assert not folder.exists()
