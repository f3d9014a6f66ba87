"""Piecewise polynomials: values, derivatives, integrals and zeros against scipy's, which another house keeps."""

import math

import numpy as np
import pytest
import scipy
from hypothesis import given
from hypothesis import strategies as st

from mechsym.periodic.pieces import PPoly


def random_pieces(seed, tail=()):
    rng = np.random.default_rng(seed)
    order, pieces = rng.integers(1, 11), rng.integers(1, 30)
    return rng.normal(size=(order, pieces, *tail)), np.cumsum(rng.uniform(0.01, 1.0, pieces + 1)) - 3.0


@pytest.mark.parametrize("beyond", [True, False, "periodic"])
@pytest.mark.parametrize("tail", [(), (3,)])
@given(seed=st.integers(0, 2**32))
def test_values_slopes_and_integrals_are_scipys(beyond, tail, seed):
    c, x = random_pieces(seed, tail)
    ours, theirs = PPoly(c, x, beyond), scipy.interpolate.PPoly(c, x, beyond)
    inside = np.random.default_rng(seed).uniform(x[0], x[-1], (2, 5))
    asked = inside if beyond is False else np.concatenate([inside, inside + 0.3 * (x[-1] - x[0])])
    for points in (asked, x[:-1], float(inside[0, 0])):
        for mine, other in (
            (ours, theirs), (ours.derivative(), theirs.derivative()), (ours.derivative(2), theirs.derivative(2)),
            (ours.antiderivative(), theirs.antiderivative()),
        ):  # fmt: skip
            assert mine(points).shape == other(points).shape
            size = np.nanmax(np.abs(other(points)), initial=1.0)
            np.testing.assert_allclose(mine(points), other(points), rtol=1e-11, atol=1e-12 * size)
    np.testing.assert_array_equal(ours(inside, 1), ours.derivative()(inside))


@given(seed=st.integers(0, 2**32))
def test_a_number_alone_has_the_value_that_it_has_among_others(seed):
    c, x = random_pieces(seed)
    ours, points = PPoly(c, x, "periodic"), np.random.default_rng(seed).uniform(-50, 50, 40)
    assert [float(ours(p)) for p in points] == ours(points).tolist()


def test_beyond_the_ends_and_where_there_is_no_number():
    line = [[1.0], [0.0]], [0.0, 2.0]
    assert PPoly(*line)(3.0) == 3.0 and PPoly(*line, "periodic")(3.0) == 1.0
    assert np.isnan(PPoly(*line, False)([-1.0, 3.0])).all() and PPoly(*line, False)(2.0) == 2.0
    assert math.isnan(PPoly(*line, "periodic")(math.nan))
    assert PPoly(*line).derivative(2)(1.0) == 0.0


@given(seed=st.integers(0, 2**32))
def test_zeros_are_scipys(seed):
    c, x = random_pieces(seed)
    theirs = scipy.interpolate.PPoly(c, x).roots(discontinuity=False, extrapolate=False)
    np.testing.assert_allclose(np.unique(PPoly(c, x).zeros().round(7)), np.unique(theirs.round(7)), atol=1.1e-7)


def test_zeros_of_what_is_zero_and_of_what_has_none():
    assert PPoly([[0.0, 1.0], [0.0, 1.0]], [0.0, 1.0, 2.0]).zeros().size == 0
    assert PPoly([[1.0], [0.0], [0.0]], [0.0, 1.0]).zeros() == pytest.approx([0.0, 0.0])  # touched


@given(seed=st.integers(0, 2**32))
def test_cubics_have_the_values_and_slopes_that_they_were_given(seed):
    rng = np.random.default_rng(seed)
    x, y, slope = np.cumsum(rng.uniform(0.1, 1.0, 6)), rng.normal(size=6), rng.normal(size=6)
    curve = PPoly.hermite(x, y, slope)
    assert curve(x) == pytest.approx(y, abs=1e-12) and curve(x, 1) == pytest.approx(slope, abs=1e-11)
    np.testing.assert_allclose(curve.c, scipy.interpolate.CubicHermiteSpline(x, y, slope).c, atol=1e-9)


@pytest.mark.parametrize("periodic", [True, False])
@given(seed=st.integers(0, 2**32), count=st.sampled_from((2, 3, 4, 5, 40)))
def test_splines_are_scipys(periodic, seed, count):
    rng = np.random.default_rng(seed)
    count = max(count, 4) if periodic else count
    x, y = np.cumsum(10 ** rng.uniform(-1, 1, count)), rng.normal(size=count)
    if periodic:
        y[-1] = y[0]
    ours = PPoly.spline(x, y, periodic)
    theirs = scipy.interpolate.CubicSpline(x, y, bc_type="periodic" if periodic else "not-a-knot")
    asked = np.linspace(x[0], x[-1], 50)
    np.testing.assert_allclose(ours(asked), theirs(asked), rtol=0, atol=1e-11 * np.abs(theirs(asked)).max())
    assert ours(x[-1] + 0.1) == pytest.approx(theirs(x[0] + 0.1 if periodic else x[-1] + 0.1), rel=1e-8, abs=1e-10)


def test_a_spline_through_a_cubic_is_the_cubic():
    x = np.array([0.0, 0.3, 1.0, 1.2, 2.0, 3.5])
    curve = PPoly.spline(x, x**3 - x)
    asked = np.linspace(0, 3.5, 30)
    assert curve(asked) == pytest.approx(asked**3 - asked, abs=1e-12)
