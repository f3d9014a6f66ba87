"""Every example in a docstring gives what it says."""

import doctest
import importlib
from pathlib import Path

import pytest

import mechsym

ROOT = Path(mechsym.__file__).parent
TOLD = sorted(path for path in ROOT.rglob("*.py") if ">>> " in path.read_text(encoding="utf-8"))
PUBLIC = {
    "cases": {"load", "locate", "names"},
    "jobs": {"cycle", "forces", "gas", "machine"},
    "mechanisms": {"evaluate", "names", "parameters_class"},
    "page": {"grid", "page"},
}


def test_there_are_examples():
    assert len(TOLD) > 60


@pytest.mark.parametrize("path", TOLD, ids=lambda p: str(p.relative_to(ROOT)))
def test_examples_in_docstrings(path):
    name = ".".join(("mechsym", *path.relative_to(ROOT).with_suffix("").parts)).removesuffix(".__init__")
    found = doctest.testmod(importlib.import_module(name), report=True)
    assert found.attempted and not found.failed, f"{found.failed} of {found.attempted} examples of {name}"


@pytest.mark.parametrize(("room", "names"), PUBLIC.items())
def test_what_is_used_first_has_an_example(room, names):
    module = importlib.import_module(f"mechsym.{room}")
    assert {name for name in names if ">>> " not in (getattr(module, name).__doc__ or "")} == set()
