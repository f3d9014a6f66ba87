"""Collocation: its numbers, which equations it is for, and what has once gone wrong with it."""

import shutil

import casadi as ca
import numpy as np
import pytest
from native.models import PENDULUM, rhs

from mechsym.errors import BadInput
from mechsym.native.integrate import integrate
from mechsym.native.integrators import STAGES, gauss_tableau, legendre_coefficients
from mechsym.native.runs import STATUS, Breaks, Level, Runs

pytestmark = pytest.mark.skipif(not any(map(shutil.which, ("gcc", "clang", "cc"))), reason="no C compiler")


def test_numbers_of_collocation():
    a, b, c, _ = gauss_tableau(STAGES)
    for k in range(2 * STAGES):
        assert b @ c**k == pytest.approx(1 / (k + 1), abs=1e-14)
    for k in range(2 * STAGES - 1):
        # a state two integrals away from its rate
        assert b @ a @ c**k == pytest.approx(1 / ((k + 1) * (k + 2)), abs=1e-14)
    coefficients = np.array([0.3, -1.0, 0.5, 0.0, 2.0, 0.0, -0.7, 0.1])
    values = np.polynomial.legendre.legval(2 * c - 1, coefficients)
    np.testing.assert_allclose(legendre_coefficients(STAGES) @ values, coefficients, atol=1e-14)


def test_smooth_equations_are_collocated_and_others_are_not():
    rough = rhs("rough", 2, 0, lambda t, y, p: (y[1], -ca.sin(y[0]) - 0.1 * y[1] * ca.fabs(y[1])))
    for system, method in ((PENDULUM, "collocation"), (rough, "dop853")):
        run = Runs(rhs=system, start=np.array([1.0, 0.0]), until=np.array([5.0]))
        np.testing.assert_array_equal(integrate(run).y, integrate(run, method).y)
    many = Runs(rhs=PENDULUM, start=np.tile([1.0, 0.0], (16, 1)), until=np.array([5.0]))
    np.testing.assert_array_equal(integrate(many).y, integrate(many, "dop853").y)


def test_strong_damping_goes_to_explicit_steps():
    damped = rhs("damped", 2, 0, lambda t, y, p: (y[1], -1e4 * y[1] - ca.sin(y[0])))
    run = Runs(rhs=damped, start=np.array([1.0, 0.0]), until=np.linspace(0, 5, 51)[1:], held=np.zeros((50, 0)))
    assert "dop853" in STATUS[integrate(run, "collocation").status[0]]
    np.testing.assert_array_equal(integrate(run).y, integrate(run, "dop853").y)
    assert integrate(run).status[0] == 0


def test_collocation_needs_smooth_equations():
    kinks = (Breaks(state=0, angles=np.array([0.0]), period=1.0),)
    with pytest.raises(BadInput, match="knows no kinks and tables; use dop853"):
        integrate(Runs(rhs=PENDULUM, start=np.zeros(2), until=np.array([1.0]), kinks=kinks), "collocation")


def test_collocation_of_many_coordinates():
    # a chain of pendulums: more angles than one evaluation of the slopes can hold
    n = 11
    chain = rhs("chain", 2 * n, 0, lambda t, y, p: (
        *y[n:], *(-ca.sin(y[i]) - 5 * (2 * y[i] - (y[i - 1] if i else 0) - (y[i + 1] if i < n - 1 else 0))
                  for i in range(n))
    ))  # fmt: skip
    start = np.concatenate([np.linspace(0.5, 1.5, n), np.zeros(n)])
    found, wanted = (integrate(Runs(rhs=chain, start=start, until=np.array([20.0]), rtol=1e-12, atol=1e-12), m).y
                     for m in ("collocation", "dop853"))  # fmt: skip
    np.testing.assert_allclose(found, wanted, atol=1e-9)


def test_equations_without_angles():
    # dy/dt depends on time and on the state itself, no state is the rate of another
    growth = rhs("growth", 1, 0, lambda t, y, p: (y[0] * ca.cos(t),))
    times = np.linspace(0.3, 6, 20)
    found = integrate(Runs(rhs=growth, start=np.array([1.0]), until=np.array([6.0]), times=times), "collocation")
    np.testing.assert_allclose(found.samples[0, :, 0], np.exp(np.sin(times)), rtol=1e-10)


@pytest.mark.parametrize(("name", "formula", "start", "wanted"), [
    ("itself", lambda t, y, p: (y[0],), [1.0], [np.e]),
    ("swap", lambda t, y, p: (y[1], y[0]), [1.0, 0.0], [np.cosh(1), np.sinh(1)]),
    ("chain", lambda t, y, p: (y[1], y[2], y[0]), [1.0, 1.0, 1.0], [np.e] * 3),
    ("jerk", lambda t, y, p: (y[1], y[2], ca.SX(6), y[0]), [1.0, 0.0, 0.0, 0.0], [2, 3, 6, 1.25]),
])  # fmt: skip
def test_speeds_that_are_states_with_speeds(name, formula, start, wanted):
    run = Runs(rhs=rhs(name, len(start), 0, formula), start=np.array(start), until=np.array([1.0]), atol=1e-12)
    np.testing.assert_allclose(integrate(run, "collocation").y[0], wanted, rtol=1e-10)


@pytest.mark.parametrize("direction", [-1, 0, 1])
def test_surface_of_a_state_that_nothing_depends_on(direction):
    work = rhs("work", 3, 0, lambda t, y, p: (y[1], -ca.sin(y[0]), y[1] ** 2))
    surface = Level(state=2, level=1.0, direction=direction)
    run = Runs(rhs=work, start=np.array([1.0, 0.0, 0.0]), until=np.array([9.0]), surfaces=(surface,))
    found, wanted = integrate(run, "collocation"), integrate(run, "dop853")
    assert found.status[0] == wanted.status[0] == (direction >= 0)
    assert found.t[0] == pytest.approx(wanted.t[0], abs=1e-8)


def test_step_into_what_is_not_finite_is_shortened():
    falls = rhs("falls", 2, 0, lambda t, y, p: (y[1], -ca.sqrt(y[0])))
    run = Runs(rhs=falls, start=np.array([1.0, 0.0]), until=np.array([9.0]), surfaces=(Level(state=0, level=1e-4),))
    found = integrate(run, "collocation")
    # v^2/2 + 2/3 y^(3/2) stays
    assert found.met[0] == 0
    assert found.y[0, 1] == pytest.approx(-np.sqrt(4 / 3 * (1 - 1e-6)), abs=1e-9)


def test_many_wanted_times_are_no_slow_convergence():
    run = Runs(rhs=PENDULUM, start=np.array([2.0, 0.0]), until=np.array([400.0]), times=np.linspace(0.02, 400, 20000))
    found = integrate(run, "collocation")
    assert found.status[0] == 0
    assert not np.isnan(found.samples).any()


def test_sweeps_that_only_stagnate_are_not_taken_for_rounding():
    kepler = rhs("kepler", 4, 0, lambda t, y, p: (
        y[2], y[3], -y[0] / (y[0] ** 2 + y[1] ** 2) ** 1.5, -y[1] / (y[0] ** 2 + y[1] ** 2) ** 1.5
    ))  # fmt: skip
    run = Runs(rhs=kepler, start=np.array([0.1, 0, 0, 19**0.5]), until=np.array([20.0]), rtol=1e-13, atol=1e-13)
    x, y, u, v = integrate(run, "collocation").y[0]
    assert (u * u + v * v) / 2 - 1 / np.hypot(x, y) == pytest.approx(-0.5, abs=1e-11)
    assert x * v - y * u == pytest.approx(0.1 * 19**0.5, abs=1e-12)


def test_stiff_shaft_far_from_its_start():
    # rounding of 1e5 rad is far above the tolerance of the short steps to the wanted times
    shaft = rhs("shaft", 4, 0, lambda t, y, p: (y[2], y[3], 1 - 1e7 * (y[0] - y[1]), 1e7 * (y[0] - y[1])))
    start, times = np.array([1e5, 1e5 + 1e-4, 50, 50]), np.linspace(1e-4, 0.1, 1000)
    found = integrate(Runs(rhs=shaft, start=start, until=np.array([0.1]), times=times), "collocation")
    assert found.status[0] == 0
    np.testing.assert_allclose(found.samples[0, :, 2:].sum(axis=1), 100 + times, atol=1e-8)


@pytest.mark.parametrize(("count", "tolerance", "method"), [
    (2, 1e-8, "collocation"), (3, 1e-8, "dop853"), (3, 1e-12, "collocation"), (4, 1e-12, "dop853"),
])  # fmt: skip
def test_few_runs_go_one_by_one_fewer_at_a_loose_tolerance(count, tolerance, method):
    start = np.tile([1.0, 0.0], (count, 1))
    runs = Runs(rhs=PENDULUM, start=start, until=np.array([3.0]), rtol=tolerance, atol=tolerance)
    wanted = {m: integrate(runs, m).steps.tolist() for m in ("collocation", "dop853")}
    assert integrate(runs).steps.tolist() == wanted[method]
    assert wanted["collocation"] != wanted["dop853"]
