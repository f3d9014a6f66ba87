"""The examples run, stay short, and use nothing but the public interface."""

import ast
import importlib
import re
import subprocess
import sys
from pathlib import Path

import pytest

import mechsym

FOLDER = Path(__file__).parent.parent / "examples"
EXAMPLES = sorted(FOLDER.glob("*.py"))
FILES = {"design_hinge": "report.html", "design_guide": "profile air.csv", "sweep_spring": "sweep.csv",
         "codesign_marine": "track.csv"}  # fmt: skip


def test_there_are_examples():
    assert {file.stem for file in EXAMPLES} >= FILES.keys()


@pytest.mark.parametrize("name", mechsym.__all__)
def test_public_modules_exist(name):
    assert getattr(mechsym, name) is importlib.import_module(f"mechsym.{name}")
    assert name in dir(mechsym)


def test_nothing_else_is_public():
    assert mechsym.__version__
    with pytest.raises(AttributeError, match="no attribute 'spring'"):
        _ = mechsym.spring


@pytest.mark.parametrize("file", EXAMPLES, ids=lambda f: f.stem)
def test_short_and_public(file):
    text = file.read_text(encoding="utf-8")
    assert text.count("\n") <= 40
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.ImportFrom) and node.module.split(".")[0] == "mechsym":
            names = [a.name for a in node.names] if node.module == "mechsym" else [node.module.split(".")[1]]
            assert set(names) <= set(mechsym.__all__)
        if isinstance(node, ast.Attribute):
            assert not node.attr.startswith("_")


@pytest.mark.slow
@pytest.mark.parametrize("stem", FILES)
def test_runs(stem, tmp_path):
    command = [sys.executable, FOLDER / f"{stem}.py", tmp_path]
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "can be cut" in done.stdout
    assert (tmp_path / FILES[stem]).exists()


def test_example_of_the_readme_runs(tmp_path):
    readme = (FOLDER.parent / "README.md").read_text(encoding="utf-8")
    (code,) = re.findall(r"```python\n(.*?)```", readme, re.S)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert "can be cut: True" in done.stdout
