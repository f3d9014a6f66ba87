"""Cases that name other cases and files: from their own folder, whichever folder the command runs in."""

import pytest

from mechsym import cases
from mechsym.cases.check import check_file
from mechsym.cases.keys import keys
from mechsym.errors import BadInput
from mechsym.jobs.hinge import hinge


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "engines").mkdir()
    slow = cases.text("zotov-89").replace('case = "zotov-142"', 'case = "fast.toml"')
    (tmp_path / "engines" / "slow.toml").write_text(slow.replace('high_case = "zotov-142"', 'high_case = "fast.toml"'))
    (tmp_path / "engines" / "fast.toml").write_text(cases.text("zotov-142"))
    return tmp_path


def test_a_case_beside_the_file(folder, monkeypatch):
    monkeypatch.chdir(folder)
    mine, theirs = (hinge(cases.load(name)) for name in ("engines/slow.toml", "zotov-89"))
    assert mine.retuned.setting == theirs.retuned.setting


def test_a_case_of_the_working_folder_comes_first(folder, monkeypatch):
    monkeypatch.chdir(folder)
    (folder / "fast.toml").write_text("")
    assert cases.load("engines/slow.toml").need("retune").case == "fast.toml"


def test_another_engine_is_no_other_speed(folder):
    file = folder / "engines" / "fast.toml"
    file.write_text(file.read_text().replace('bore = "0.3 m"', 'bore = "0.32 m"'))
    design = hinge(cases.load(str(folder / "engines" / "slow.toml")))
    with pytest.raises(BadInput, match=r"another engine: its bore is 0.32 m, not 0.3 m"):
        assert design.retuned


@pytest.mark.parametrize(
    ("name", "old", "new", "key"),
    [
        ("zotov-89", 'case = "zotov-142"', 'case = "none.toml"', "retune.case"),
        ("zotov-89", 'high_case = "zotov-142"', 'high_case = "none.toml"', "codesign.high_case"),
        ("zotov-89", 'curve = "propeller"', 'curve = "none.csv"', "codesign.curve"),
        ("nunes-hypocycloid", "[sizing]", '[sizing]\nmaterials_file = "none.csv"', "sizing.materials_file"),
        ("nunes-hypocycloid", 'rival = "nunes-slider-crank"', 'rival = "none"', "sizing.rival"),
        ("generator", 'file = "generator-synthetic.csv"', 'file = "none.csv"', "cycle.file"),
    ],
)
def test_check_tells_what_is_not_there(folder, name, old, new, key):
    text = cases.text(name)
    assert old in text
    file = folder / "engines" / "mine.toml"
    file.write_text(text.replace(old, new, 1))
    (problem,) = [one for one in check_file(str(file)).problems if "there is no" in one.why]
    assert problem.key == key and "none" in problem.why and "that of the case" in problem.allowed


def test_check_finds_what_is_there(folder):
    assert check_file(str(folder / "engines" / "slow.toml")).problems == ()
    assert check_file("generator").problems == ()


def test_what_names_a_file_or_a_case_says_so():
    named = {f"{row['section']}.{row['key']}": row["kind"] for row in keys() if row["kind"] in ("file", "case")}
    assert named["cycle.file"] == named["sizing.materials_file"] == named["torque.file"] == "file"
    assert named["retune.case"] == named["sizing.rival"] == named["codesign.high_case"] == "case"


def test_files_of_one_name_are_told_apart(folder):
    (folder / "other").mkdir()
    (folder / "other" / "slow.toml").write_text(cases.text("zotov-89"))
    loaded = [cases.load(str(folder / name / "slow.toml")) for name in ("engines", "other")]
    assert [case.name for case in cases.told_apart(loaded)] == ["engines/slow", "other/slow"]
    assert [case.name for case in cases.told_apart([loaded[0], cases.load("zotov-89")])] == ["slow", "zotov-89"]
    assert [case.name for case in cases.told_apart([loaded[0], loaded[0]])] == ["slow", "slow"]
