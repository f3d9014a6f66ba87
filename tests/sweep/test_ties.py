"""Values that follow from others at every point of a sweep."""

import math

import pytest

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.sweep import Plan, columns, failures, layout, sweep

SWEPT = 2.94e-4
TIED = (f"V={SWEPT}", "chamber.bore=sqrt(4*V/(pi*2*4*parameters.e))")


def over_throw(tied, **more):
    return Plan(case="nunes-hypocycloid", over=("parameters.e=12,13,14 mm",), tied=tied, **more)


def test_a_tied_value_is_that_of_its_formula():
    ties = layout(over_throw(TIED)).ties
    found = ties.at({"parameters.e": "13 mm"})
    assert found["chamber.bore"] == pytest.approx(math.sqrt(SWEPT / (2 * math.pi * 0.013)), rel=1e-15)
    assert "V" not in found


def test_a_tied_sweep_is_the_same_as_each_point_alone():
    tied = columns(sweep(over_throw(TIED)))
    for i, e in enumerate((0.012, 0.013, 0.014)):
        bore = math.sqrt(SWEPT / (2 * math.pi * e))
        alone = sweep(
            Plan(case="nunes-hypocycloid", over=("operation.speed=8000 rpm",),
                 overrides={"parameters.e": e, "chamber.bore": bore})
        )  # fmt: skip
        assert tied["efficiency"][i] == pytest.approx(columns(alone)["efficiency"][0], rel=1e-12)


def test_guides_follow_their_ties():
    plain = Plan(case="zotov-89", over=("spring.p0=5,6 MPa",), analysis="guides", overrides={"spring.H": "1.1 m"})
    tied = Plan(
        case="zotov-89", over=("spring.p0=5,6 MPa",), analysis="guides", tied=("spring.H=5.5e6/5e6 + 0*spring.p0",)
    )
    assert columns(sweep(tied))["margin"] == pytest.approx(columns(sweep(plain))["margin"], rel=1e-9)


def test_a_formula_without_a_value_leaves_a_gap():
    found = sweep(over_throw(("chamber.bore=sqrt(parameters.e - 0.0125)",)))
    assert list(failures(found)) == [0] and "no value here" in failures(found)[0]


def test_a_value_of_the_case_that_is_not_swept_may_stand_in_a_formula():
    case = cases.load("nunes-hypocycloid")
    ties = layout(over_throw(("chamber.bore=chamber.bore*0 + 2*operation.speed/operation.speed*parameters.e",))).ties
    assert ties.at({"parameters.e": "12 mm"})["chamber.bore"] == pytest.approx(0.024)
    assert case.need("chamber").bore == 0.06


@pytest.mark.parametrize(
    "tied, words",
    [
        (("bore",), "is not KEY=FORMULA"),
        (("bore=sqrt(",), "is no formula"),
        (("bore=2*parameters.q",), "parameters.q is not known"),
        (("bore=V", "V=0.05"), "V is not known"),
        (("V=0.05",), "V is not known"),
        (("bore=__import__(1)",), "is no function"),
        (("bore=e if e else 1",), "has no place in a formula"),
        (("bore='a'",), "is no number"),
        (("bore=e % 2",), "is no sum"),
        (("cycle.kind=2",), "is a word"),
        (("parameters.e=0.01",), "give the same value"),
        (("bore=0.05", "chamber.bore=0.05"), "give the same value"),
    ],
)
def test_nonsense_is_refused(tied, words):
    with pytest.raises(BadInput, match=words):
        layout(over_throw(tied))
