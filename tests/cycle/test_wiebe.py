"""Wiebe functions: limits, derivative, and the same numbers on floats, arrays and CasADi symbols."""

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shen2020 import SHEN_2020

from mechsym.cycle.wiebe import burnt_at, ddouble_wiebe_dy, double_burnt_at, double_wiebe, dwiebe_dy, wiebe

positive = st.floats(0.5, 30.0)
form = st.floats(0.0, 4.0)


def test_limits():
    assert wiebe(0.0, 5.0, 2.0) == 0.0
    assert wiebe(-3.0, 5.0, 0.0) == 0.0
    assert wiebe(1.0, 5.0, 2.0) == pytest.approx(1 - np.exp(-5.0), rel=1e-15)
    assert wiebe(50.0, 5.0, 2.0) == 1.0
    # the start, where 1 - exp(.) would lose all digits
    assert wiebe(1e-6, 5.0, 1.0) == pytest.approx(5e-12, rel=1e-11)


def test_one_share_is_the_single_function():
    y = np.linspace(-0.5, 2.0, 101)
    assert np.array_equal(double_wiebe(y, 3.0, 1.2, 20.0, 0.9, 0.0), wiebe(y, 3.0, 1.2))
    assert np.array_equal(double_wiebe(y, 3.0, 1.2, 20.0, 0.9, 1.0), wiebe(y, 20.0, 0.9))


@pytest.mark.parametrize("fitted", SHEN_2020)
def test_fitted_sets_burn_nearly_all_by_the_nominal_end(fitted):
    assert 0.98 < double_wiebe(1.0, **fitted) < 1.0
    assert double_wiebe(2.0, **fitted) == pytest.approx(1.0, abs=1e-4)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(a=positive, m=form, y=st.floats(0.01, 2.0))
def test_rate_is_the_derivative(a, m, y):
    h = 1e-5 * y
    slope = (wiebe(y + h, a, m) - wiebe(y - h, a, m)) / (2 * h)
    assert dwiebe_dy(y, a, m) == pytest.approx(slope, rel=1e-6, abs=1e-8 * a)


@settings(deadline=None, derandomize=True, max_examples=30)
@given(a=positive, m=form)
def test_rises_from_zero_to_one(a, m):
    f = wiebe(np.linspace(-1, 5, 400), a, m)
    assert np.all(np.diff(f) >= 0) and f[0] == 0 and f[-1] <= 1


def test_rate_before_the_start_is_zero_even_for_m_zero():
    assert dwiebe_dy(-0.1, 5.0, 0.0) == 0.0
    assert dwiebe_dy(0.0, 5.0, 0.0) == 5.0
    assert dwiebe_dy(np.array([-1.0, 0.0]), 5.0, 1.0).tolist() == [0.0, 0.0]


def test_symbols_give_the_same_numbers_as_arrays():
    y, grid, fitted = ca.SX.sym("y"), np.linspace(-0.3, 1.5, 37), SHEN_2020[3]
    symbolic = ca.Function("f", [y], [double_wiebe(y, **fitted), ddouble_wiebe_dy(y, **fitted)])
    f, rate = (np.asarray(part).ravel() for part in symbolic(grid.reshape(1, -1)))
    assert np.allclose(f, double_wiebe(grid, **fitted), rtol=1e-14, atol=1e-16)
    assert np.allclose(rate, ddouble_wiebe_dy(grid, **fitted), rtol=1e-13, atol=1e-15)


def test_symbolic_derivatives_are_finite_at_the_start():
    y, a, m = ca.SX.sym("y"), ca.SX.sym("a"), ca.SX.sym("m")
    gradient = ca.Function("g", [y, a, m], [ca.gradient(wiebe(y, a, m), ca.vertcat(y, a, m))])
    for at in (-0.1, 0.0, 1e-12):
        assert np.allclose(np.asarray(gradient(at, 5.0, 0.7)).ravel(), 0.0, atol=1e-6)
    assert np.isclose(float(gradient(0.4, 5.0, 0.7)[0]), dwiebe_dy(0.4, 5.0, 0.7), rtol=1e-13)


@settings(deadline=None, derandomize=True, max_examples=60)
@given(a=positive, m=form, share=st.floats(0.01, 0.99))
def test_where_a_share_is_burnt_is_the_inverse(a, m, share):
    assert wiebe(burnt_at(share, a, m), a, m) == pytest.approx(share * wiebe(1.0, a, m), rel=1e-12)
    # both functions alike: the double one is the single one, and half of it lies where its closed form says
    assert double_burnt_at(share, (a, m, a, m, 0.3), 1.0) == pytest.approx(float(burnt_at(share, a, m)), rel=1e-9)


def test_nothing_is_burnt_at_the_start_and_all_of_it_at_its_end():
    fitted = tuple(SHEN_2020[2].values())
    assert double_burnt_at(0.0, fitted, 1.0) == 0.0
    assert double_burnt_at(1.0, fitted, 0.8) == pytest.approx(0.8, rel=1e-12)
    assert double_wiebe(double_burnt_at(0.5, fitted, np.inf), *fitted) == pytest.approx(0.5, rel=1e-12)
