"""What version 1.0 promised is there: names of Python, commands and options, keys of cases, numbers of JSON."""

import importlib
import re
from pathlib import Path

import public
import pytest

import mechsym
from mechsym.cases.older import RENAMED

DOCS = Path(__file__).parents[1] / "docs"


@pytest.mark.parametrize("kind", ["python", "command", "key", "json", "exit"])
def test_no_public_name_is_gone(kind):
    now = {name for name in public.names() if name.startswith(kind)}
    promised = {name for name in public.listed() if name.startswith(kind)}
    renamed = {f"key {old}" for old in RENAMED}
    assert len(promised) > 5 and sorted(promised - now - renamed) == []


def test_a_name_that_is_listed_can_be_imported():
    for name in public.listed():
        if match := re.fullmatch(r"python (mechsym\.\w+)\.(\w+)", name):
            assert hasattr(importlib.import_module(match[1]), match[2]), name


def test_the_page_on_stability_says_which_version_this_is():
    text = (DOCS / "stability.md").read_text(encoding="utf-8")
    assert f"version {mechsym.__version__.rpartition('.')[0]}" in text
    assert {int(status) for status in re.findall(r"^\| `(\d+)` \|", text, re.M)} == {*public.EXITS}
