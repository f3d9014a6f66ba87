"""Roots and least values of continuous functions: as close as asked, as scipy's, and refused where there is none."""

import math

import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st

from mechsym.periodic.roots import minimum, root

SHAPES = {
    "a cube that is flat at its root": lambda x: x**3 + 1e-3 * x,
    "an exponential": lambda x: math.expm1(3 * x),
    "a steep arc tangent": lambda x: math.atan(50 * x),
    "a jump": lambda x: math.copysign(1.0, x),
    "a tiny slope": lambda x: 1e-300 * x,
}


@pytest.mark.parametrize("shape", SHAPES)
@given(at=st.floats(-3, 3), left=st.floats(0.01, 5), right=st.floats(0.01, 5), sign=st.sampled_from((-1, 1)))
def test_a_root_is_as_close_as_asked(shape, at, left, right, sign):
    calls = []

    def function(x):
        calls.append(x)
        return sign * SHAPES[shape](x - at)

    assert abs(root(function, at - left, at + right, xtol=1e-12) - at) <= 1e-12 + 1e-15 * abs(at)
    assert len(calls) < 65  # no more than halves need
    there = scipy.optimize.brentq(function, at - left, at + right, xtol=1e-12)
    assert root(function, at + right, at - left, xtol=1e-12) == pytest.approx(there, abs=3e-12)


def test_roots_at_the_ends():
    assert root(lambda x: x, 0, 1) == 0 and root(lambda x: x - 1, 0, 1) == 1


@pytest.mark.parametrize(
    "function", [lambda x: x * x + 1, lambda x: math.nan, lambda x: math.log(x) if x < 1 else math.nan]
)
def test_what_encloses_no_root_is_refused(function):
    with pytest.raises(ValueError, match="no root|not a number"):
        root(function, 0.5, 2.0)


BOWLS = {
    "a parabola": lambda x: x * x,
    "flat at its least": lambda x: x**4,
    "a V": abs,
    "lopsided": lambda x: math.expm1(x) - x,
    "tiny": lambda x: 1e-300 * x * x,
}


@pytest.mark.parametrize("bowl", BOWLS)
@given(at=st.floats(-3, 3), left=st.floats(0.01, 5), right=st.floats(0.01, 5))
def test_the_least_value_is_where_it_is(bowl, at, left, right):
    asked = []

    def function(x):
        asked.append(x)
        return BOWLS[bowl](x - at)

    x, value = minimum(function, at - left, at + right, xtol=1e-9)
    assert value == min(map(BOWLS[bowl], (a - at for a in asked))) and len(asked) < 120
    assert at - left < min(asked) and max(asked) < at + right  # where it may have no value
    # rounding leaves a parabola flat within half of the digits, a fourth power within a quarter
    assert abs(x - at) <= {"flat at its least": 1e-3, "tiny": 1e-6}.get(bowl, 1e-7 * (1 + abs(at)))
    bounds, near = (at - left, at + right), {"xatol": 1e-9}
    count = len(asked)
    there = scipy.optimize.minimize_scalar(function, bounds=bounds, method="bounded", options=near)
    assert count <= there.nfev + 3  # parabolas are taken where they help
    assert value == pytest.approx(there.fun, abs=1e-7)


@pytest.mark.parametrize("slope", [1.0, -1.0])
def test_a_least_value_at_an_end_is_approached(slope):
    x, value = minimum(lambda x: slope * x, 0.0, 2.0, xtol=1e-6)
    assert x == pytest.approx(0.0 if slope > 0 else 2.0, abs=2e-6) and value == slope * x
