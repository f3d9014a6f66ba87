"""Small programs of textbooks and single slips in them: the right ones are left in peace, and which slips are told."""

import tomllib
from pathlib import Path

import pytest

from mechsym.audit.hosts.repository import audited
from mechsym.audit.judge.asked import Asked

PROGRAMS = tomllib.loads((Path(__file__).parent / "programs.toml").read_text(encoding="utf-8"))["program"]
LIGHT = ("crankclass", "spring2")


def findings(folder, program, old="", new=""):
    if program["ends"] != ".py":
        pytest.importorskip("tree_sitter")
    assert old in program["text"]
    place = folder / f"a{program['ends']}"
    place.write_text(program["text"].replace(old, new, 1) if old else program["text"], encoding="utf-8")
    (file,) = audited(place, Asked(text="", against=""), [place])
    assert not file.why
    return file.rows


def every():
    for program in PROGRAMS:
        yield pytest.param(program, id=program["name"], marks=[] if program["name"] in LIGHT else pytest.mark.slow)


@pytest.mark.parametrize("program", list(every()))
def test_the_right_program_is_left_in_peace_and_slips_are_told(program, tmp_path):
    assert not findings(tmp_path, program)
    silent = [old for old, new in program["slips"] if not findings(tmp_path, program, old, new)]
    assert silent == program.get("silent", [])
