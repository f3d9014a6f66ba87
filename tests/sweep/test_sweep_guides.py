"""Which guides can be built: the numbers of `hinge` to 1e-4, the same verdicts, gaps where a value is impossible."""

import inspect
import math

import numpy as np
import pytest

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.sweep import Gap, Plan, columns, sweep

# the first kernel of a kind is compiled
pytestmark = pytest.mark.slow

OVER = ("spring.p0=1.5..8 MPa:4", "guide.rho0=0.6,0.9", "speed_rpm=89,95")


def test_the_same_verdicts_as_the_hinge():
    fast, full = (sweep(Plan(case="zotov-89", over=OVER, analysis=analysis)) for analysis in ("guides", "hinge"))
    assert fast.points == full.points
    fast, full = columns(fast), columns(full)
    np.testing.assert_array_equal(fast["feasible"], full["guide.feasible"])
    assert set(fast["feasible"]) == {0, 1}
    np.testing.assert_allclose(fast["margin"], full["guide.margin"], atol=1e-4)
    judged = fast["judged"] == 1
    assert judged.any() and not judged.all()
    # numbers of `judge` are its own; the order of sums may differ beside other guides
    np.testing.assert_allclose(fast["margin"][judged], full["guide.margin"][judged], rtol=1e-12, atol=1e-14)
    assert "margins.roller_reaction" in fast and "margins.spring_force" not in fast


def test_what_is_impossible_is_a_gap_with_its_reason():
    found = sweep(Plan(case="zotov-89", over=("spring.n=0.5,1.25", "spring.H=1,1.2"), analysis="guides"))
    assert [isinstance(o, Gap) for o in found.outcomes] == [True, True, False, False]
    assert "n = 0.5" in found.outcomes[0].reason and "case zotov-89" in found.outcomes[0].reason


def test_a_law_that_is_a_word_and_samples():
    found = sweep(Plan(case="zotov-89", over=("spring.law=air_gauge,air_absolute",), analysis="guides"))
    assert [o["feasible [-]"] for o in found.outcomes] == [1.0, 1.0]
    assert all(math.isfinite(o["margin [-]"]) for o in found.outcomes)
    drawn = sweep(Plan(case="zotov-89", over=("spring.p0=3+-0.6 MPa",), analysis="guides", samples=16))
    assert len({o["margin [-]"] for o in drawn.outcomes}) == 16


def test_a_gas_with_heat_is_refused_with_words():
    overrides = {"spring.law": "air_thermal", "spring.tau": "1 s"}
    with pytest.raises(BadInput, match="force follows from the closing alone"):
        sweep(Plan(case="zotov-89", over=("spring.p0=3..8 MPa:3",), overrides=overrides, analysis="guides"))


def test_each_value_of_a_guide_is_checked_by_itself():
    """The map checks each value once; a record that judged two together would need its point made."""
    case = cases.load("zotov-89")
    for section in ("spring", "guide", "rollers", "limits"):
        checked = type(case.need(section)).__post_init__
        assert inspect.getclosurevars(checked).nonlocals["own"] is None
