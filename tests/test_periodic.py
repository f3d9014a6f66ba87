"""Periodic piecewise polynomials: accuracy between the knots, kinks, calculus, fast evaluation."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.interpolate import CubicSpline

from mechsym import periodic
from mechsym.errors import BadInput

TURN = 2 * np.pi


def smooth(phi):
    return np.exp(np.sin(phi)) - 0.3 * np.cos(3 * phi)


def wiebe(m, at=0.7):
    def function(phi):
        y = np.mod(phi - at, TURN) / 1.3
        return np.exp(-3 * y ** (m + 1)) * np.sin(phi)

    return function


def between(poly, rng, count=4000):
    phi = rng.uniform(-20, 20, count)
    return phi, poly(phi)


def test_smooth_function_to_round_off(rng):
    phi, values = between(periodic.fit(smooth, (), TURN), rng)
    assert np.max(np.abs(values - smooth(phi))) < 1e-11


@pytest.mark.parametrize("m", [0.72, 1.0, 1.15, 2.2])
def test_wiebe_start_to_tolerance_where_an_even_spline_is_not(m, rng):
    function = wiebe(m)
    poly = periodic.fit(function, (0.7,), TURN)
    phi, values = between(poly, rng)
    assert np.max(np.abs(values - function(phi))) < 5e-12
    even = np.linspace(0.7, 0.7 + TURN, 721)
    ends = np.append(function(even[:-1]), function(even[:1]))
    spline = CubicSpline(even, ends, bc_type="periodic")
    assert np.max(np.abs(spline(np.mod(phi - 0.7, TURN) + 0.7) - function(phi))) > 1e-8


def test_pieces_grow_away_from_a_kink():
    widths = np.diff(periodic.fit(lambda phi: np.mod(phi, TURN) ** 1.72, (0.0,), TURN).x)
    assert widths[0] < 1e-3 * widths[-1]
    assert np.all(np.diff(widths[:10]) >= -1e-15)


def test_a_jump_at_a_break_is_kept():
    poly = periodic.fit(lambda phi: np.where(np.mod(phi, TURN) < 2, 1.0, np.cos(phi)), (2.0,), TURN)
    assert poly(2 - 1e-9) == pytest.approx(1)
    assert poly(2 + 1e-9) == pytest.approx(np.cos(2))


def test_a_jump_elsewhere_is_refused_with_its_angle():
    with pytest.raises(BadInput, match=r"jumps near 2\.1"):
        periodic.fit(lambda phi: np.where(np.mod(phi, TURN) < 2.123, 1.0, 0.0), (), TURN)


def test_what_is_not_finite_is_refused():
    with pytest.raises(BadInput, match="not finite"):
        periodic.fit(lambda phi: np.where(np.cos(phi) > 0.9, np.nan, 1.0), (), TURN)


def test_several_functions_at_once(rng):
    poly = periodic.fit(lambda phi: np.stack([smooth(phi), 2 * np.sin(phi)]), (), TURN)
    phi, values = between(poly, rng)
    assert values.shape == (phi.size, 2)
    assert np.max(np.abs(values[:, 1] - 2 * np.sin(phi))) < 1e-11


def test_mean_and_antiderivative_are_exact():
    poly = periodic.fit(lambda phi: 2 + np.cos(phi) + 3 * np.sin(2 * phi), (), TURN)
    integral = periodic.antiderivative(poly)
    phi = np.linspace(-9, 9, 500)
    assert periodic.mean(poly) == pytest.approx(2, abs=1e-13)
    assert np.max(np.abs(integral(phi) - np.sin(phi) - 1.5 * (1 - np.cos(2 * phi)))) < 1e-11
    assert np.max(np.abs(integral.derivative()(phi) - poly(phi) + 2)) < 1e-10


def test_scalar_evaluation_is_that_of_scipy(rng):
    poly = periodic.fit(wiebe(0.72), (0.7,), TURN)
    function, slope = periodic.scalar(poly), poly.derivative()
    angles = [*rng.uniform(-50, 50, 300), 0.0, TURN, -TURN, 0.7, -1e-300, np.nextafter(TURN, 0)]
    for phi in angles:
        value, rate = function(float(phi))
        assert value == pytest.approx(float(poly(phi)), abs=1e-13)
        assert rate == pytest.approx(float(slope(phi)), abs=1e-9)


def test_extremes_are_exact():
    low, at_low, high, at_high = periodic.extremes(periodic.fit(lambda phi: np.cos(phi - 1.234), (), TURN))
    assert (low, high) == (pytest.approx(-1, abs=1e-13), pytest.approx(1, abs=1e-13))
    assert at_high == pytest.approx(1.234, abs=1e-6)
    assert at_low == pytest.approx(1.234 + np.pi, abs=1e-6)


def test_extremes_of_a_constant():
    low, _, high, _ = periodic.extremes(periodic.fit(lambda phi: np.full_like(phi, 3.0), (), TURN))
    assert (low, high) == (pytest.approx(3, abs=1e-13), pytest.approx(3, abs=1e-13))


@given(st.floats(-3, 3), st.integers(0, 11))
def test_extremes_beside_a_break_are_found_on_the_right_side(offset, piece):
    # the top stands a little off an even break, where the points of the wrong piece may lie higher
    top = piece * TURN / 12 + 10.0**offset * 1e-3
    poly = periodic.fit(lambda phi: np.cos(phi - top) + 0.3 * np.cos(2 * (phi - top)), (), TURN)
    assert periodic.extremes(poly)[2] == pytest.approx(1.3, abs=1e-12)


def test_noise_of_the_function_ends_the_halving_and_much_of_it_is_refused():
    def noisy(level):
        return lambda phi: np.sin(phi) + level * np.sin(1e9 * phi)

    poly = periodic.fit(noisy(1e-11), (), TURN)
    assert poly.x.size < 20_000
    assert poly(1.0) == pytest.approx(np.sin(1.0), abs=1e-9)
    with pytest.raises(BadInput, match="noise"):
        periodic.fit(noisy(1e-6), (), TURN)


def test_pieces_see_both_sides_of_a_kink():
    slope = periodic.fit(lambda phi: np.abs(np.mod(phi, TURN) - 3), (3.0,), TURN).derivative()
    values = periodic.piece_values(slope, periodic.piece_points(slope))
    at = int(np.flatnonzero(np.isclose(slope.x, 3.0))[0])
    assert values[at - 1, -1] == pytest.approx(-1)
    assert values[at, 0] == pytest.approx(1)


@given(st.floats(0.6, 2.5), st.floats(0, TURN), st.floats(1, 1e5), st.floats(-2, 2), st.sampled_from([TURN, 2 * TURN]))
def test_any_kink_any_scale(m, at, scale, level, period):
    def function(phi):
        return scale * (level + np.mod(phi - at, period) ** (m + 1) * np.exp(-np.mod(phi - at, period)))

    poly = periodic.fit(function, (at,), period)
    phi = np.random.default_rng(1).uniform(-period, 2 * period, 500)
    peak = np.max(np.abs(function(phi)))
    assert np.max(np.abs(poly(phi) - function(phi))) < 1e-10 * peak
