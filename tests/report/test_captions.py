"""What a caption says is what its picture shows: every number with a unit is read off what is drawn."""

import pytest
from captions import numbers_of, unsaid

from mechsym import cases, jobs
from mechsym.report import case_report
from mechsym.sweep import Plan, sweep
from mechsym.sweep.plots import caption, picture

FAST = ("zotov-89",)
NAMES = [name if name in FAST else pytest.param(name, marks=pytest.mark.slow) for name in cases.names()]


@pytest.mark.parametrize("name", NAMES)
def test_numbers_of_a_caption_are_read_off_its_picture(name):
    report = case_report(cases.load(name))
    pictures = [p for part in report.parts if part.view for p in part.view.pictures]
    said = [n for p in pictures for n in numbers_of(p.see)]
    assert len(pictures) >= 3 and len(said) >= 3
    assert {p.name: missing for p in pictures if (missing := unsaid(p.see, p.draw()))} == {}


def test_a_wrong_number_would_be_noticed():
    report = case_report(cases.load("zotov-89"), ["cycle"])
    (shown,) = (p for part in report.parts for p in part.view.pictures)
    wrong, figure = shown.see.replace("7.427 MPa", "7.527 MPa"), shown.draw()
    assert unsaid(shown.see, figure) == [] and unsaid(wrong, figure) == ["7.527 MPa"]


@pytest.mark.slow
def test_the_comparison_of_mechanisms():
    view = jobs.forces(cases.load("zotov-89"), comparison=True).view
    (one,) = (p for p in view.pictures if p.name == "comparison")
    assert len(numbers_of(one.see)) == 2 and unsaid(one.see, one.draw()) == []


@pytest.mark.slow
def test_a_sweep():
    """Of two points there is no picture, and nothing to say of it."""
    over, shown = "chamber.compression_ratio=8..14:{}", ("p_max_mpa", "power_kw")
    two, four = (sweep(Plan(case="nunes-slider-crank", over=(over.format(n),), show=shown)) for n in (2, 4))
    assert (caption(two), picture(two)) == ("", None)
    see, figure = caption(four), picture(four)
    assert len(numbers_of(see)) == 2 and unsaid(see, figure) == []
    assert {line.get_linestyle() for axis in figure.axes for line in axis.lines} == {"-"}
