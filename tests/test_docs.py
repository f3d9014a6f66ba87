"""The docs site: what it says to type runs, it builds without a warning, and nothing in it comes from elsewhere."""

import importlib
import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym.cli import COMMANDS, mechsym

DOCS = Path(__file__).parent.parent / "docs"


@pytest.fixture
def pages(monkeypatch):
    monkeypatch.syspath_prepend(str(DOCS))
    return importlib.import_module("pages")


@pytest.mark.slow
@pytest.mark.parametrize("page", ["start", "engine"])
def test_what_a_page_says_to_type_runs(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(r"```sh\n(.*?)```", (DOCS / f"{page}.md").read_text(encoding="utf-8"), re.S)
    lines = [line for block in blocks for line in block.splitlines()]
    assert len(lines) >= 4
    for line in lines:
        program, *words = shlex.split(line)
        done = CliRunner().invoke(mechsym, words, catch_exceptions=False)
        assert program == "mechsym" and done.exit_code == 0, f"{line}: {done.output}"


def test_examples_are_of_commands_that_are_there(pages):
    assert pages.EXAMPLES.keys() <= COMMANDS.keys()
    assert all(shlex.split(line)[0] == name for name, line in pages.EXAMPLES.items())


@pytest.mark.slow
def test_rooms_and_sections_are_told_in_full(pages):
    text = pages.rooms()
    for room in pages.ROOMS:
        module = importlib.import_module(f"mechsym.{room}")
        names = [n for n in getattr(module, "__all__", ()) if type(getattr(module, n)).__name__ != "module"]
        assert all(f"### {room}.{name}\n" in text for name in names), room
    assert "| `bore` | m | \\> 0 | **needed** | cylinder bore |" in pages.sections()


@pytest.mark.slow
def test_the_site_builds_without_a_warning_and_is_all_local(tmp_path):
    pytest.importorskip("sphinx")
    pytest.importorskip("furo")
    pytest.importorskip("myst_parser")
    command = [sys.executable, "-m", "sphinx", "-W", "-q", "-b", "html", str(DOCS), str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and not done.stderr, done.stderr
    for page in tmp_path.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        assert not re.findall(r"<(?:script|link|img)[^>]*(?:src|href)=.https?://", text), page.name
        for link in re.findall(r'href="([^"#?:]+)["#?]', text):
            assert (page.parent / link).exists(), f"{page.name}: {link}"
