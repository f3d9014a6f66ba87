"""The rodless mechanism with play: limits of the other closing rules, least energy, sensitivity to a wrong crank."""

import math

import casadi as ca
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize_scalar

from mechsym.mechanisms.closing import Clearances, redundant_force
from mechsym.mechanisms.rodless import CrankFreeRadially, RodlessParameters, Stiffnesses, build, closed

PARAMETERS = RodlessParameters(r=0.04, I1=0.02, m_link=1.5, I_link=2e-3, m_a=2.0, m_b=2.0)
K = {"k_a": 2e8, "k_b": 1e8, "k_c": 3e8}
FORCES = st.floats(-2e4, 2e4)


def reactions(rule, alpha):
    function = closed(build(PARAMETERS), rule).functions["reactions"]
    letters = {"alpha": alpha, "alphad": 200.0, "alphadd": 0.0, "F_a": 8e3, "F_b": -2e3, "M": 0.0}
    found = function(**{n: letters[n] for n in function.name_in()})
    return {name: float(found[name]) for name in ("X_a", "X_b", "pin_force_radial")}


ANGLES = np.linspace(0.0, 2 * math.pi, 25)


@pytest.mark.parametrize("alpha", ANGLES)
def test_no_play_is_the_rule_of_stiffnesses(alpha):
    assert reactions(Clearances(**K), alpha) == pytest.approx(reactions(Stiffnesses(**K), alpha), abs=1e-6)


@pytest.mark.parametrize("alpha", ANGLES)
def test_much_play_of_the_pin_is_a_crank_free_radially(alpha):
    free = reactions(CrankFreeRadially(), alpha)
    assert reactions(Clearances(**K, gap_c=1.0), alpha) == pytest.approx(free, abs=1e-6)


@given(FORCES, FORCES, st.floats(0, 2 * math.pi), st.lists(st.floats(0, 1e-4), min_size=3, max_size=3),
       st.floats(-5e-5, 5e-5))  # fmt: skip
def test_force_has_the_least_complementary_energy(X_a, X_b, alpha, gaps, error):
    rule = Clearances(**K, gap_a=gaps[0], gap_b=gaps[1], gap_c=gaps[2], radius_error=error)
    s, c = math.sin(alpha), math.cos(alpha)

    def energy(S):
        parts = ((X_a - S * s, rule.k_a, rule.gap_a), (X_b - S * c, rule.k_b, rule.gap_b), (S, rule.k_c, rule.gap_c))
        return sum(X**2 / (2 * k) + g * abs(X) for X, k, g in parts) - error * S

    found = float(redundant_force(rule, X_a, X_b, s, c))
    near = minimize_scalar(energy, bounds=(-2e5, 2e5), method="bounded", options={"xatol": 1e-6})
    assert energy(found) <= near.fun + 1e-12 + 1e-9 * abs(near.fun)


@given(FORCES, FORCES, st.floats(0, 2 * math.pi))
def test_determinate_combination_does_not_see_the_rule(X_a, X_b, alpha):
    s, c = math.sin(alpha), math.cos(alpha)
    S = float(redundant_force(Clearances(**K, gap_a=1e-5, radius_error=2e-5), X_a, X_b, s, c))
    assert (X_a - S * s) * c - (X_b - S * c) * s == pytest.approx(X_a * c - X_b * s, abs=1e-6)


def test_a_wrong_crank_is_pressed_in_by_the_stiffness_of_the_whole():
    # one hundredth of a millimetre: e/(1/k_c + s^2/k_a + c^2/k_b)
    alpha = 0.7
    exact, wrong = (reactions(Clearances(**K, radius_error=e), alpha)["pin_force_radial"] for e in (0.0, 1e-5))
    soft = 1 / 3e8 + math.sin(alpha) ** 2 / 2e8 + math.cos(alpha) ** 2 / 1e8
    assert wrong - exact == pytest.approx(1e-5 / soft, rel=1e-9)


def test_play_takes_the_error_up():
    rule = Clearances(**K, radius_error=1e-5, gap_c=2e-5)
    assert float(redundant_force(rule, 0.0, 0.0, 0.6, 0.8)) == 0
    X = ca.SX.sym("X")
    f = ca.Function("f", [X], [redundant_force(rule, X, 0.5 * X, 0.6, 0.8)])
    assert float(f(1e5)) > 0
