"""Periodic cubic splines: they add up to one, the closed form of even knots, kinks, the curve beside the matrices."""

import numpy as np
import pytest

from mechsym.codesign.certificate import swing_per_inertia
from mechsym.codesign.unknowns import basis, curve, fitted, matrices

TURN = 2 * np.pi


def dense(found):
    return [np.asarray(part.full()) for part in found]


@pytest.mark.parametrize("kinks", [(), (0.3, 4.0)])
def test_values_add_up_to_one_and_slopes_to_nothing(kinks):
    phi = np.linspace(-TURN, 2 * TURN, 101)
    value, slope, bend = dense(matrices(basis(TURN, kinks, 12), phi))
    assert value.sum(axis=1) == pytest.approx(np.ones(phi.size), abs=1e-14)
    assert np.abs(slope.sum(axis=1)).max() < 1e-12
    assert np.abs(bend.sum(axis=1)).max() < 1e-11


def test_even_knots_have_the_closed_form_of_the_uniform_spline():
    """At a knot 1/6, 4/6, 1/6; slopes -1/2, 0, 1/2 by h; bends 1, -2, 1 by h^2; halfway 1/48, 23/48, 23/48, 1/48."""
    h = TURN / 10
    even = basis(TURN, (), 10)
    at_knots = [np.sort(part[part != 0]) for part in dense(matrices(even, np.array([3 * h])))]
    assert at_knots[0] == pytest.approx([1 / 6, 1 / 6, 4 / 6], rel=1e-13)
    assert at_knots[1] * h == pytest.approx([-0.5, 0.5], rel=1e-12)
    assert at_knots[2] * h**2 == pytest.approx([-2, 1, 1], rel=1e-12)
    halfway = dense(matrices(even, np.array([3.5 * h])))[0]
    assert np.sort(halfway[halfway != 0]) == pytest.approx([1 / 48, 1 / 48, 23 / 48, 23 / 48], rel=1e-12)


def test_the_nearest_knot_goes_to_a_kink_round_the_turn_too():
    h = TURN / 8
    found = basis(TURN, (TURN - 0.1 * h, 2.4 * h, TURN + 2.4 * h), 8)
    assert found.count == 8
    # knot 0 is the nearest of a kink right before a whole turn
    assert found.knots == pytest.approx([h, 2.4 * h, 3 * h, 4 * h, 5 * h, 6 * h, 7 * h, TURN - 0.1 * h], rel=1e-14)


def test_the_curve_is_what_the_matrices_say_and_is_fitted_back():
    draw = np.random.default_rng(5)
    some = basis(TURN, (1.1, 5.0), 14)
    coefficients = draw.normal(size=some.count)
    whole, phi = curve(some, coefficients), draw.uniform(-TURN, 2 * TURN, 200)
    for order, part in enumerate(dense(matrices(some, phi))):
        assert whole(phi, order) == pytest.approx(part @ coefficients, abs=1e-10)
    assert whole.x[-1] - whole.x[0] == pytest.approx(TURN, rel=1e-15)
    assert fitted(some, whole(phi), phi) == pytest.approx(coefficients, abs=1e-10)


@pytest.mark.parametrize("ripple", [0.01, 0.2])
@pytest.mark.parametrize("by", ["mean", "mid-range"])
def test_no_speeds_of_a_ripple_swing_more(by, ripple):
    """Over all u_low <= 1 <= u_high of the ripple, by brute force; the largest has its low or its high end at 1."""
    low = np.linspace(1 / (1 + ripple) ** 2, 1, 20001)
    high = low + ripple if by == "mean" else low * (1 + ripple / 2) / (1 - ripple / 2)
    swing = ((high**2 - low**2) / 2)[high >= 1]
    assert swing.max() == pytest.approx(swing_per_inertia(ripple, by), rel=1e-12)
