"""Case files of version 1.0 are read for as long as its successors promise, and what was renamed since is told."""

import tomllib
from pathlib import Path

import pytest

from mechsym import cases
from mechsym.cases import older
from mechsym.cases.check import check_file

FILES = sorted((Path(__file__).parent / "version-1.0").glob("*.toml"))


@pytest.mark.parametrize("file", FILES, ids=lambda path: path.stem)
def test_a_case_of_version_1_is_read_and_every_change_of_name_is_told(file):
    case, checked = cases.load(str(file)), check_file(str(file))
    assert checked.problems == () and case.sections.keys() == tomllib.loads(file.read_text()).keys() - {
        "mechanism", "source", "about", "doubts"}  # fmt: skip
    told = [doubt.quantity for doubt in case.doubts if doubt.code == "renamed"]
    written = tomllib.loads(file.read_text())
    assert told == [f"older name: {old}" for old in older.RENAMED if old.partition(".")[0] in written]


@pytest.fixture
def renamed(monkeypatch):
    """A later version in which a key and a section of today have other names."""
    later = {"spring.pressure0": older.Renamed("spring.p0", "1.1"), "wheels": older.Renamed("rollers", "1.2")}
    for name, value in later.items():
        monkeypatch.setitem(older.RENAMED, name, value)


def test_an_older_name_is_read_with_a_note(renamed, tmp_path):
    text = cases.text("zotov-89").replace("\np0 = ", "\npressure0 = ").replace("[rollers]", "[wheels]")
    (tmp_path / "old.toml").write_text(text)
    case, today = cases.load(str(tmp_path / "old.toml")), cases.load("zotov-89")
    assert case.need("spring") == today.need("spring") and case.need("rollers") == today.need("rollers")
    notes = [doubt for doubt in case.doubts if doubt.code == "renamed"]
    assert [note.quantity for note in notes] == ["older name: spring.pressure0", "older name: wheels"]
    assert "read as spring.p0, its name since version 1.1" in notes[0].why
    assert {d.quantity for d in check_file(str(tmp_path / "old.toml")).doubts} >= {note.quantity for note in notes}
    assert cases.load("zotov-89", {"spring.pressure0": "8 MPa"}).need("spring").p0 == 8e6


def test_of_two_names_side_by_side_neither_is_guessed(renamed, tmp_path):
    text = cases.text("zotov-89").replace("[rollers]", "[wheels]\nradius = 1\n[rollers]")
    (tmp_path / "both.toml").write_text(text)
    assert "wheels" in [problem.key for problem in check_file(str(tmp_path / "both.toml")).problems]
