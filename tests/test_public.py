"""What version 1.0 promised is there: names of Python, commands and options, keys of cases, numbers of JSON."""

import importlib
import re
import sys
from pathlib import Path
from types import ModuleType

import public
import pytest

import mechsym
from mechsym.cases.older import RENAMED
from mechsym.quantities import by_name

DOCS = Path(__file__).parents[1] / "docs"


@pytest.mark.parametrize("kind", ["python", "command", "key", "json", "exit"])
def test_no_public_name_is_gone(kind):
    now = {name for name in public.names() if name.startswith(kind)}
    promised = {name for name in public.listed() if name.startswith(kind)}
    renamed = {f"key {old}" for old in RENAMED} | {f"python {old}" for old in by_name.RENAMED}
    assert len(promised) > 5 and sorted(promised - now - renamed) == []


def test_a_name_that_is_listed_can_be_imported():
    for name in public.listed():
        if match := re.fullmatch(r"python (mechsym\.\w+)\.(\w+)", name):
            assert hasattr(importlib.import_module(match[1]), match[2]), name


def test_an_older_name_is_the_new_one_with_a_warning_that_names_it(monkeypatch):
    from mechsym import hinge

    monkeypatch.setitem(by_name.RENAMED, "mechsym.hinge.track", ("mechsym.hinge.cut", "1.1"))
    with pytest.warns(DeprecationWarning, match=r"hinge\.track is mechsym\.hinge\.cut since version 1\.1") as told:
        assert hinge.track is hinge.cut
    assert told[0].filename == __file__  # where it is to be changed
    with pytest.warns(DeprecationWarning, match="write that"):
        from mechsym.hinge import track
    assert track is hinge.cut
    with pytest.raises(AttributeError, match="no attribute 'trak'"):
        _ = hinge.trak


def test_a_room_without_lazy_names_renames_by_one_line(monkeypatch):
    room = ModuleType("mechsym.room")
    monkeypatch.setitem(sys.modules, "mechsym.room", room)
    monkeypatch.setitem(by_name.RENAMED, "mechsym.room.old", ("mechsym.hinge.cut", "2.0"))
    room.__getattr__ = by_name.lazily("mechsym.room", {})
    with pytest.warns(DeprecationWarning, match=r"since version 2\.0"):
        assert room.old.__name__ == "cut"


def test_the_page_on_stability_says_which_version_this_is():
    text = (DOCS / "stability.md").read_text(encoding="utf-8")
    assert f"version {mechsym.__version__.rpartition('.')[0]}" in text
    assert {int(status) for status in re.findall(r"^\| `(\d+)` \|", text, re.M)} == {*public.EXITS}
