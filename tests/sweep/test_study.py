"""Several sweeps of one file, one report."""

import json

import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.sweep import layout
from mechsym.sweep.study import built_in, read

TEXT = """
title = "Two questions"
case = "nunes-hypocycloid"
show = ["efficiency", "p_max_mpa"]
[set]
"operation.speed" = "4000 rpm"

[[sweep]]
name = "compression"
about = "How tight"
over = ["chamber.compression_ratio=9,10,11"]

[[sweep]]
name = "bore"
over = ["chamber.bore=55,60 mm"]
tied = ["parameters.e=0.013*(0.06/chamber.bore)^2"]
set = { "chamber.compression_ratio" = 12 }
"""


@pytest.fixture
def file(tmp_path):
    path = tmp_path / "two.toml"
    path.write_text(TEXT)
    return path


def run(*args):
    return CliRunner().invoke(mechsym, ["study", *map(str, args)], catch_exceptions=False, standalone_mode=False)


@pytest.mark.slow
def test_a_study_is_its_sweeps(file, tmp_path):
    found = json.loads(run(file, "--json", "--out", tmp_path / "out").output)
    assert [one["name"] for one in found["sweeps"]] == ["compression", "bore"] and not found["interrupted"]
    first, second = found["sweeps"]
    assert first["data"]["efficiency"] == sorted(first["data"]["efficiency"])
    assert second["points"] == 2 and second["failed"] == []
    assert second["data"]["efficiency"][1] > first["data"]["efficiency"][2]  # the tightest, at the same bore
    page = (tmp_path / "out" / "report.html").read_text()
    for words in ("Two questions", "How tight", "0.013*(0.06/chamber.bore)^2", "<svg", "compression/sweep.csv"):
        assert words in page
    assert (tmp_path / "out" / "bore" / "sweep.csv").read_text().count("\n") == 3

    again = json.loads(run(file, "--json", "--out", tmp_path / "out", "--only", "bore").output)
    assert [one["kept"] for one in again["sweeps"]] == [2]
    assert again["sweeps"][0]["data"] == second["data"]


def test_the_study_of_chapter_6_asks_what_the_chapter_names():
    assert "nunes2017-chapter-6" in built_in()
    asked = read("nunes2017-chapter-6")
    assert [one.name for one in asked.sweeps] == [
        "materials", "gear-sets", "bore-to-stroke", "compression", "boost", "rod", "narrow-gears",
        "hypocycloid-speeds", "slider-crank-speeds", "hypocycloid-losses", "slider-crank-losses",
    ]  # fmt: skip
    for one in asked.sweeps:
        assert layout(one.plan).points


@pytest.mark.slow
@pytest.mark.heavy
def test_chapter_6_in_numbers(tmp_path):
    found = {one["name"]: one for one in json.loads(run("nunes2017-chapter-6", "--json").output)["sweeps"]}
    assert not any(one["failed"] for one in found.values())
    nitralloy, maraging = found["materials"]["data"]["gears.face_width"]
    assert maraging < 0.7 * nitralloy
    assert found["gear-sets"]["data"]["failing"] == [0, 1]  # one pair does not bear it, as the thesis found
    narrow, wide = (found["bore-to-stroke"]["data"][name] for name in ("loads.tooth_force", "efficiency"))
    assert narrow == sorted(narrow) and wide == sorted(wide)
    assert found["compression"]["data"]["efficiency"] == sorted(found["compression"]["data"]["efficiency"])
    assert found["boost"]["data"]["power_kw"] == sorted(found["boost"]["data"]["power_kw"])


@pytest.mark.parametrize(
    "old, new, words",
    [
        ('title = "Two questions"', "", "title is missing"),
        ('name = "bore"', "", "sweep 2: name is missing"),
        ('name = "bore"', 'name = "../bore"', "is no word for a folder"),
        ('name = "bore"', 'name = "compression"', "two sweeps have the name"),
        ('over = ["chamber.bore=55,60 mm"]', "", "sweep 2: over is missing"),
        ('over = ["chamber.bore=55,60 mm"]', 'over = "chamber.bore=55,60 mm"', "is not a list of texts"),
        ('over = ["chamber.bore=55,60 mm"]', "over = [5]", "is not a list of texts"),
        ('name = "bore"', 'name = "bore"\nsamples = true', "is not a whole number"),
        ('name = "bore"', 'name = "bore"\nsample = 5', "did you mean 'samples'"),
        ('name = "bore"', 'name = "bore"\nof = "cycles"', "sweep 2: .*is not an option"),
        ("[[sweep]]", "[[sweeps]]", "did you mean 'sweep'"),
        ('title = "Two', "title = Two", "not valid TOML"),
    ],
)
def test_nonsense_is_refused(file, old, new, words):
    file.write_text(TEXT.replace(old, new))
    with pytest.raises(BadInput, match=words):
        read(str(file))


def test_a_file_that_is_not_there_is_refused():
    with pytest.raises(BadInput, match="neither built in nor a readable file"):
        read("chapter-7")


def test_a_sweep_that_is_not_there_is_refused(file):
    with pytest.raises(BadInput, match="did you mean 'bore'"):
        run(file, "--only", "bor")


def test_a_study_is_told_in_units_for_people(tmp_path):
    file = tmp_path / "ripple.toml"
    file.write_text(
        'title = "Ripple"\ncase = "zotov-89"\n[[sweep]]\nname = "speed"\nover = ["speed_rpm=80,89"]\n'
        'show = ["hinge_torque_max", "check.speed_ripple"]\n'
    )
    out = tmp_path / "out"
    text = run(file, "--out", out).output
    assert "largest hinge torque  kN*m  44.26" in text and "check, speed ripple   -     0" in text
    page = (out / "report.html").read_text()
    assert ">44.26 kN m<" in page and "0" in page
    # the picture draws round-off as nothing
    assert "0.000000" not in page
