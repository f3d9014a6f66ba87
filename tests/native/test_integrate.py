"""Integrators in C: order, splitting, surfaces, kinks, tables, lanes, and the energy of real runs."""

import shutil

import casadi as ca
import numpy as np
import pytest
from native.models import FLYWHEEL, PENDULUM, functions, rhs
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline, PPoly

from mechsym import native
from mechsym.errors import BadInput
from mechsym.native import integrators as table
from mechsym.native.integrate import LANES, integrate
from mechsym.native.integrators import gauss_tableau
from mechsym.native.runs import STATUS, Breaks, Level, Runs, Table

pytestmark = pytest.mark.skipif(not any(map(shutil.which, ("gcc", "clang", "cc"))), reason="no C compiler")


# adaptive ones
METHODS = ("dop853", "collocation")

FORCED = rhs("forced", 2, 1, lambda t, y, p: (y[1], p[0] - ca.sin(y[0])))
CLOCK = rhs("clock", 2, 1, lambda t, y, p: (ca.SX(1.0), p[0]))


def flywheel() -> ca.Function:
    """The two-degree model as a first-order system with its driving torque as the held value."""
    acceleration = functions("crankshaft_flywheel")["acceleration"]
    return rhs("flywheel", 4, 1, lambda t, y, p: (y[2], y[3], acceleration(*y, p[0], 0)))


def energy(y: np.ndarray) -> np.ndarray:
    return native.compiled(functions("crankshaft_flywheel")["energy"]).batch(*y.T).sum(axis=0)


def test_order_conditions_of_the_table():
    b = np.zeros(13)
    a = np.zeros((13, 13))
    for stage, row in table.A.items():
        for j, value in row.items():
            if stage < 13:
                a[stage - 1, j - 1] = value
            elif stage == 13:
                b[j - 1] = value
    c = np.array(table.NODES[:13])
    c[12] = 0.0
    np.testing.assert_allclose(a[:12].sum(axis=1), c[:12], atol=2e-15)
    for k in range(8):
        assert b @ c**k == pytest.approx(1 / (k + 1), abs=2e-15)
    for k in range(1, 7):
        # trees with one branch point below the root
        assert b @ a @ c**k == pytest.approx(1 / ((k + 1) * (k + 2)), abs=2e-15)
        assert (b * c) @ a @ c ** (k - 1) == pytest.approx(1 / (k * (k + 2)), abs=2e-15)
    assert b @ a @ a @ a @ a @ a @ a @ np.ones(13) == pytest.approx(1 / 5040, abs=1e-16)
    assert sum(table.WEIGHTS_3.values()) == pytest.approx(1, abs=1e-15)
    for k in range(3):
        three = sum(w * table.NODES[s - 1] ** k for s, w in table.WEIGHTS_3.items())
        assert three == pytest.approx(1 / (k + 1), abs=1e-14)
    assert sum(table.ERROR_5.values()) == pytest.approx(0, abs=1e-14)


def fixed_steps(count: int) -> tuple[float, float]:
    """Errors at the end and between the steps, with equal steps: each is a segment, the tolerance forbids nothing."""
    until = np.linspace(0, 6, count + 1)[1:]
    between = until - 6 / count * 0.37
    growth = rhs("growth", 1, 0, lambda t, y, p: (y[0] * ca.cos(t),))
    run = Runs(rhs=growth, start=np.array([1.0]), until=until, times=between, rtol=1e9, atol=1e9, first_step=10.0)
    found = integrate(run, "dop853", mode="strict")
    assert found.steps[0] == count
    error = np.abs(found.samples[0, :, 0] - np.exp(np.sin(between)))
    return abs(found.y[0, 0] - np.exp(np.sin(6))), np.max(error)


def test_orders_of_the_steps_and_of_dense_output():
    ends, inside = np.array([fixed_steps(n) for n in (6, 12, 24)]).T
    assert np.log2(ends[0] / ends[2]) / 2 == pytest.approx(8, abs=0.5)
    # a polynomial of degree 7 between the steps
    assert np.log2(inside[0] / inside[2]) / 2 == pytest.approx(8, abs=0.7)


@pytest.mark.parametrize("method", METHODS)
def test_dense_output_is_as_good_as_the_steps(method):
    times = np.linspace(0.05, 9.95, 400)
    runs = {tol: Runs(rhs=PENDULUM, start=np.array([2.0, 0.0]), until=np.array([10.0]), times=times, rtol=tol, atol=tol)
            for tol in (1e-9, 1e-14)}  # fmt: skip
    found, exact = (integrate(r, method).samples[0] for r in runs.values())
    assert np.max(np.abs(found - exact)) < 2e-8
    assert not np.isnan(found).any()


@pytest.mark.parametrize("method", METHODS)
def test_the_same_as_scipy(method):
    found = integrate(
        Runs(rhs=FORCED, start=np.array([0.5, 1.0]), until=np.array([20.0]), held=np.array([[0.3]])), method
    )
    wanted = solve_ivp(
        lambda t, y: [y[1], 0.3 - np.sin(y[0])], (0, 20), [0.5, 1.0], method="DOP853", rtol=1e-12, atol=1e-12
    ).y[:, -1]
    np.testing.assert_allclose(found.y[0], wanted, rtol=1e-9)
    assert STATUS[found.status[0]] == "done"


@pytest.mark.parametrize("method", METHODS)
def test_segments_are_split_exactly(method):
    # the integral of a step function is exact only when no step reaches across a jump
    until, held = np.array([0.1, 0.7, 2.0]), np.array([[3.0], [-1.0], [10.0]])
    times = np.array([0.1, 0.4, 0.7, 2.0])
    found = integrate(Runs(rhs=CLOCK, start=np.zeros(2), until=until, held=held, times=times), method)
    np.testing.assert_allclose(found.samples[0, :, 1], [0.3, 0.0, -0.3, 12.7], atol=1e-14)
    assert found.t[0] == 2.0


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("direction", [-1, 0, 1])
def test_run_ends_on_a_surface(method, direction):
    surface = Level(state=0, level=0.0, direction=direction)
    times = np.linspace(0.1, 30, 300)
    found = integrate(
        Runs(rhs=PENDULUM, start=np.array([1.0, 0.0]), until=np.array([30.0]), surfaces=(surface,), times=times),
        method,
    )
    assert found.met[0] == 0
    assert abs(found.y[0, 0]) < 1e-10
    assert (found.y[0, 1] > 0) == (direction == 1)
    assert found.samples.shape[1] == np.sum(times <= found.t[0])  # nothing is kept for what no run reaches
    assert not np.isnan(found.samples).any()


@pytest.mark.parametrize("method", METHODS)
def test_first_of_two_surfaces_wins(method):
    surfaces = (Level(state=1, level=-0.5), Level(state=0, level=0.9))
    found = integrate(
        Runs(rhs=PENDULUM, start=np.array([1.0, 0.0]), until=np.array([9.0]), surfaces=surfaces, rtol=1e-6),
        method,
    )
    assert found.met[0] == 1
    assert found.y[0, 0] == pytest.approx(0.9, abs=1e-7)


def test_table_of_a_periodic_value_with_a_jump_at_a_kink():
    # torque 1 in the first half turn and -0.5 in the second; the angle runs through 5 turns
    period = 2 * np.pi
    steps = Table(held=0, state=0, polynomials=((np.array([0, np.pi, period]), np.array([[1.0, -0.5]])),))
    kinks = Breaks(state=0, angles=np.array([0.0, np.pi]), period=period)
    system = rhs("jumps", 3, 1, lambda t, y, p: (y[1], p[0], p[0] * y[1]))
    common = dict(rhs=system, start=np.array([0.3, 2.0, 0.0]), until=np.array([12.0]), held=np.zeros((1, 1)))
    found = integrate(Runs(**common, tables=(steps,), kinks=(kinks,), rtol=1e-9, atol=1e-9))
    angle, speed, work = found.y[0]
    turns, rest = divmod(angle, period)
    by_hand = turns * 0.5 * np.pi + min(rest, np.pi) - 0.5 * max(rest - np.pi, 0) - 0.3
    assert turns >= 4
    # every piece is a polynomial of the second degree in time, which the method integrates exactly
    assert work == pytest.approx(by_hand, abs=1e-11)
    assert speed**2 / 2 - 2 == pytest.approx(by_hand, abs=1e-11)
    assert found.rejected[0] == 0


def test_kinks_of_several_angles():
    # three shafts with their own torques, constant in sixths of a turn, two of them in step at the start
    period, edges, rng = 2 * np.pi, np.linspace(0, 2 * np.pi, 7), np.random.default_rng(4)
    torques = rng.uniform(-0.5, 1.0, (3, 6))
    system = rhs("shafts", 9, 3, lambda t, y, p: (*y[3:6], *p, *(p[i] * y[3 + i] for i in range(3))))
    start = np.array([0.0, 0.0, 1.0, 2.0, 2.0, 2.5, 0, 0, 0])
    tables = tuple(Table(held=i, state=i, polynomials=((edges, torques[i : i + 1]),)) for i in range(3))
    kinks = tuple(Breaks(state=i, angles=edges[:-1], period=period) for i in range(3))
    common = dict(rhs=system, until=np.array([9.0]), held=np.zeros((1, 3)), tables=tables, kinks=kinks, rtol=1e-9)
    found = integrate(Runs(start=start, **common))

    def stored(i: int, angle: float) -> float:
        turns, rest = divmod(angle, period)
        full = np.diff(edges) * torques[i]
        inside = np.clip(rest - edges[:-1], 0, np.diff(edges)) * torques[i]
        return turns * full.sum() + inside.sum()

    for i in range(3):
        wanted = stored(i, found.y[0, i]) - stored(i, start[i])
        # between kinks the motion is a parabola, which the method integrates exactly
        assert found.y[0, 6 + i] == pytest.approx(wanted, abs=1e-9)
        assert found.y[0, 3 + i] ** 2 / 2 - start[3 + i] ** 2 / 2 == pytest.approx(wanted, abs=1e-9)
    assert found.rejected[0] == 0
    many = integrate(Runs(start=np.tile(start, (5, 1)), **common), mode="strict")
    np.testing.assert_array_equal(many.y, np.tile(integrate(Runs(start=start, **common), mode="strict").y, (5, 1)))


def test_motion_that_turns_back_over_a_kink():
    # a ball thrown against a floor that pushes harder below 0
    system = rhs("floor", 2, 1, lambda t, y, p: (y[1], p[0]))
    force = Table(held=0, state=0, polynomials=((np.array([-5.0, 0.0, 5.0]), np.array([[40.0, -10.0]])),))
    found = integrate(
        Runs(rhs=system, start=np.array([1.0, 0.0]), until=np.array([5.0]), held=np.zeros((1, 1)), tables=(force,),
             kinks=(Breaks(state=0, angles=np.array([0.0]), period=10.0),), times=np.linspace(0.01, 5, 500))
    )  # fmt: skip
    y, v = found.samples[0].T
    total = v**2 / 2 + np.where(y > 0, 10 * y, -40 * y)
    np.testing.assert_allclose(total, 10.0, atol=1e-11)
    assert (v > 0).any()


def test_smooth_table_follows_any_angle():
    angles = np.linspace(0, 2 * np.pi, 3601)
    spline = CubicSpline(angles, np.r_[np.cos(angles[:-1]), 1.0], bc_type="periodic")
    poly = PPoly(spline.c, spline.x)
    force = Table(held=0, state=0, polynomials=((poly.x, poly.c),))
    found = integrate(
        Runs(rhs=FORCED, start=np.array([-100.0, 9.0]), until=np.array([10.0]), held=np.zeros((1, 1)), tables=(force,))
    )
    wanted = solve_ivp(
        lambda t, y: [y[1], np.cos(y[0]) - np.sin(y[0])],
        (0, 10),
        [-100.0, 9.0],
        method="DOP853",
        rtol=1e-12,
        atol=1e-12,
    ).y[:, -1]
    np.testing.assert_allclose(found.y[0], wanted, rtol=1e-8)


def test_lanes_give_what_single_runs_give():
    count = LANES[-1] + 3
    start = np.stack([np.linspace(0.1, 2.5, count), np.zeros(count)], axis=1)
    until = np.stack([np.full(count, 3.0), np.linspace(4.0, 9.0, count)], axis=1)
    held = np.stack([np.zeros(count), np.linspace(-1, 1, count)], axis=1)[:, :, None]
    surfaces = (Level(state=0, level=np.linspace(-1, -2, count)),)
    times = np.linspace(0.5, 8.5, 17)
    common = dict(rhs=FORCED, times=times)
    found = integrate(
        Runs(**common, start=start, until=until, held=held, surfaces=surfaces), method="dop853", mode="strict"
    )
    for i in range(count):
        level = (Level(state=0, level=surfaces[0].level[i]),)
        alone = integrate(
            Runs(**common, start=start[i], until=until[i], held=held[i], surfaces=level), method="dop853", mode="strict"
        )
        reached = alone.samples.shape[1]
        np.testing.assert_array_equal(found.samples[i, :reached], alone.samples[0])
        assert np.isnan(found.samples[i, reached:]).all()
        np.testing.assert_array_equal(found.y[i], alone.y[0])
        assert (found.t[i], found.met[i], found.steps[i]) == (alone.t[0], alone.met[0], alone.steps[0])


@pytest.mark.parametrize("method", METHODS)
def test_runs_of_functions_that_differ_in_constants(method):
    functions = [rhs("spring", 2, 0, lambda t, y, p, k=k: (y[1], -k * y[0])) for k in (1.3, 2.7, 5.3)]
    found = integrate(Runs(rhs=functions, start=np.array([1.0, 0.0]), until=np.array([3.0])), method)
    np.testing.assert_allclose(found.y[:, 0], np.cos(np.sqrt([1.3, 2.7, 5.3]) * 3), rtol=1e-8)


@pytest.mark.parametrize("method", METHODS)
def test_failures_are_a_status(method):
    explodes = rhs("explodes", 1, 0, lambda t, y, p: (y[0] ** 2,))
    found = integrate(Runs(rhs=explodes, start=np.array([1.0]), until=np.array([2.0])), method)
    assert "step became too small" in STATUS[found.status[0]]
    assert found.t[0] == pytest.approx(1.0, abs=1e-6)
    short = integrate(Runs(rhs=PENDULUM, start=np.array([1.0, 0.0]), until=np.array([1e3]), max_steps=10), method)
    assert "not enough" in STATUS[short.status[0]]


def test_shapes_are_checked():
    with pytest.raises(BadInput, match="2 states and 1 held values"):
        integrate(Runs(rhs=FORCED, start=np.zeros(3), until=np.array([1.0]), held=np.zeros((1, 1))))
    with pytest.raises(BadInput, match="must agree"):
        integrate(Runs(rhs=FORCED, start=np.zeros((3, 2)), until=np.ones((2, 1)), held=np.zeros((1, 1))))
    with pytest.raises(BadInput, match="options are auto, dop853, collocation, adams, gauss"):
        integrate(Runs(rhs=PENDULUM, start=np.zeros(2), until=np.array([1.0])), "euler")
    with pytest.raises(BadInput, match="atol must be above 0"):
        integrate(Runs(rhs=PENDULUM, start=np.zeros(2), until=np.array([1.0]), atol=0.0))
    with pytest.raises(BadInput, match="needs first_step"):
        integrate(Runs(rhs=PENDULUM, start=np.zeros(2), until=np.array([1.0])), "gauss")


@pytest.mark.parametrize("stages", [2, 3, 4])
def test_numbers_of_gauss(stages):
    a, b, c, ahead = gauss_tableau(stages)
    for k in range(2 * stages):
        assert b @ c**k == pytest.approx(1 / (k + 1), abs=1e-15)
    for k in range(stages):
        np.testing.assert_allclose(a @ c**k, c ** (k + 1) / (k + 1), atol=1e-15)
        np.testing.assert_allclose(ahead @ c**k, (1 + c) ** k, rtol=1e-13)


def test_order_of_gauss():
    start, until = np.array([2.0, 0.0]), np.array([10.0])
    exact = integrate(Runs(rhs=PENDULUM, start=start, until=until, rtol=1e-14, atol=1e-14)).y
    errors = []
    for step in (1.0, 0.5, 0.25):
        found = integrate(Runs(rhs=PENDULUM, start=start, until=until, first_step=step), "gauss")
        errors.append(np.max(np.abs(found.y - exact)))
    rates = np.log2(errors[:-1]) - np.log2(errors[1:])
    assert rates[-1] == pytest.approx(8, abs=0.5)


@pytest.mark.parametrize(("method", "order"), [("dop853", 8), ("collocation", 16)])
def test_error_falls_with_the_order_as_steps_get_more(method, order):
    start, until = np.array([2.0, 0.0]), np.array([60.0])
    exact = integrate(Runs(rhs=PENDULUM, start=start, until=until, rtol=1e-14, atol=1e-14)).y
    steps, errors, tolerances = [], [], np.logspace(-4, -11, 8)
    for tolerance in tolerances:
        found = integrate(Runs(rhs=PENDULUM, start=start, until=until, rtol=tolerance, atol=tolerance), method)
        steps.append(found.steps[0])
        errors.append(np.max(np.abs(found.y - exact)))
    assert -np.polyfit(np.log(steps), np.log(errors), 1)[0] == pytest.approx(order, abs=0.15 * order)
    # the tolerance is one of the step; over thirty turns of the pendulum the error may grow
    assert np.all(errors < 1e3 * tolerances)


def test_gauss_ends_steps_at_wanted_times_and_jumps():
    until, held = np.array([0.3, 1.0]), np.array([[2.0], [-1.0]])
    times = np.array([0.1, 0.3, 0.55, 1.0])
    found = integrate(Runs(rhs=CLOCK, start=np.zeros(2), until=until, held=held, times=times, first_step=0.04), "gauss")
    np.testing.assert_allclose(found.samples[0, :, 1], [0.2, 0.6, 0.35, -0.1], atol=1e-15)


@pytest.mark.parametrize("method", METHODS)
def test_start_up_of_the_paper_balances_its_energy(method):
    # torque 1.5 N*m from 1 s on; what it puts in is in the motion and in the twisted shaft
    runs = Runs(
        rhs=flywheel(), start=np.zeros(4), until=np.array([1.0, 100.0]), held=np.array([[0.0], [1.5]]),
        times=np.linspace(1, 100, 200),
    )  # fmt: skip
    found = integrate(runs, method)
    work = 1.5 * found.samples[0, :, 0]
    residual = (work - energy(found.samples[0])) / work[-1]
    assert np.max(np.abs(residual)) < 2e-8
    # a rigid drive reaches this at most
    assert 0.3 * 99 * 1.5 < FLYWHEEL.I0 * found.y[0, 2] + FLYWHEEL.I2 * found.y[0, 3] < 1.001 * 99 * 1.5


@pytest.mark.parametrize("method", METHODS)
def test_tolerance_bounds_the_energy_error(method):
    residuals = []
    for tolerance in (1e-8, 1e-10, 1e-12):
        runs = Runs(rhs=flywheel(), start=np.zeros(4), until=np.array([20.0]), held=np.array([[1.5]]), rtol=tolerance,
                    atol=tolerance)  # fmt: skip
        y = integrate(runs, method).y
        residuals.append(abs(energy(y)[0] / (1.5 * y[0, 0]) - 1))
    assert residuals[0] < 1e-5
    assert residuals[1] < 1e-7
    assert residuals[2] < 1e-9


@pytest.mark.parametrize(("method", "settings", "bound"), [
    ("dop853", {"rtol": 1e-12, "atol": 1e-12}, 1e-9),
    ("collocation", {"rtol": 1e-12, "atol": 1e-12}, 1e-9),
    ("gauss", {"first_step": 2e-3}, 1e-10),
])  # fmt: skip
def test_energy_of_a_conservative_run_of_1000_seconds(method, settings, bound):
    start = np.array([0.1, 0.1, 100.0, 100.0])
    runs = Runs(rhs=flywheel(), start=start, until=np.array([1000.0]), held=np.zeros((1, 1)),
                times=np.linspace(10, 1000, 100), max_steps=10**7, **settings)  # fmt: skip
    found = integrate(runs, method)
    drift = energy(found.samples[0]) / energy(start[None])[0] - 1
    assert found.status[0] == 0
    assert np.max(np.abs(drift)) < bound
