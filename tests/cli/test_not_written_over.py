"""What a result is computed from is never written over by it."""

import shutil
from pathlib import Path

import pytest

from mechsym.cli import mechsym
from mechsym.errors import BadInput

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"


@pytest.mark.parametrize(
    "line", ["export atkinson.toml --to jax --out .", "export atkinson.toml --to c,jax", "derive ./atkinson.py --out ."]
)
def test_a_declaration_is_kept(line, tmp_path, monkeypatch):
    for name in ("atkinson.py", "atkinson.toml"):
        shutil.copy(EXAMPLES / name, tmp_path / name)
    monkeypatch.chdir(tmp_path)
    before = (tmp_path / "atkinson.py").read_text()
    with pytest.raises(BadInput, match="atkinson.py was read for this and would be written over; give another folder"):
        mechsym.main(line.split(), "mechsym", standalone_mode=False)
    assert (tmp_path / "atkinson.py").read_text() == before
    assert sorted(path.name for path in tmp_path.iterdir()) == ["atkinson.py", "atkinson.toml"]
