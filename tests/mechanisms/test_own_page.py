"""docs/own-mechanism.md does what it says, in an empty folder."""

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

PAGE = Path(__file__).parents[2] / "docs" / "own-mechanism.md"


@pytest.mark.slow
@pytest.mark.heavy
def test_every_block_of_the_page_runs(tmp_path):
    blocks = re.findall(r"```(\w+)(?: file=(\S+))?\n(.*?)```", PAGE.read_text(), re.S)
    ran = 0
    for kind, file, text in blocks:
        if file:
            (tmp_path / file).write_text(text)
        elif kind == "sh":
            for line in text.splitlines():
                command = [sys.executable, "-m", *shlex.split(line)]
                done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, check=False)
                assert done.returncode == 0, (line, done.stderr)
                ran += 1
    assert ran == 16
    shown = set(re.findall(r"\(pictures/(\w+)\.svg\)", PAGE.read_text()))
    assert all((PAGE.parent / "pictures" / f"{name}.svg").is_file() for name in shown)
    assert (tmp_path / "forces" / "mechanism.html").is_file()
    lines = (tmp_path / "fourbar.py").read_text().split("def fourbar")[1].strip().splitlines()
    assert len(lines) <= 18
