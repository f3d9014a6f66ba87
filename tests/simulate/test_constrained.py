"""Loops closed by constraint in time: against the closed form, long runs, changes of the choice, a singular pose."""

from pathlib import Path

import linkages
import numpy as np
import pytest
import scipy

from mechsym.derive import Mechanism, derive
from mechsym.derive.emit import module_text
from mechsym.mechanisms.own import _module
from mechsym.mechanisms.record import bind, bind_module
from mechsym.simulate import Part, Problem, Settings, Steps, simulate

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"
DRIVE = (Part(name="drive", input="M", role="drive", value=Steps(times=(0.5,), values=(2.0, 0.0))),)


def bound(declaration, values):
    return bind_module(_module(Path("linkage.py"), module_text(derive(declaration), "linkage.py", "0" * 16)), values)


def four_bar(a, b, c, d, weight=9.81):
    m = Mechanism("four_bar")
    phi = m.coordinates("phi")
    theta2, theta3 = m.dependents("theta2 theta3")
    M, g = m.inputs("M", "N*m"), m.parameters("g", "m/s^2")
    A, B, C, D = m.parameters("a b c d", "m", above=0)
    mass, inertia = m.parameters("m", "kg"), m.parameters("I", "kg*m^2")
    crank = m.link("crank", turns=phi, inertia=4 * inertia)
    rod = m.link("rod", turns=theta2, mass=mass, centre=(B / 2, 0), inertia=inertia)
    rocker = m.link("rocker", turns=theta3, mass=mass, centre=(C / 2, 0), inertia=inertia)
    m.pin("O", m.frame, crank)
    m.pin("B", crank.at(A), rod)
    m.pin("D", m.frame.at(D), rocker)
    m.pin("C", rod.at(B), rocker.at(C))
    m.weight(0, -g)
    m.torque(M, along=phi)
    return bound(m, {"a": a, "b": b, "c": c, "d": d, "m": 0.8, "I": 0.01, "g": weight})


def closure(mechanism, result):
    q = [result.columns[n][None, :] for n in mechanism.coordinates]
    u = [result.columns[f"{n}d"][None, :] for n in mechanism.coordinates]
    return np.abs(np.asarray(mechanism.functions["constraints"](*q, *u)[0])).max()


@pytest.mark.slow
@pytest.mark.parametrize("name", ["rrr", "rrp"])
def test_the_run_is_that_of_the_closed_form(name):
    closed, held = (bound(linkages.ALL[name](by), linkages.VALUES) for by in (False, True))
    settings = Settings(backend="scipy-dop853", tolerance=1e-11)
    runs = []
    for mechanism in (closed, held):
        n = len(mechanism.coordinates)
        guesses = [mechanism.dependents.get(q, 0.0) for q in mechanism.coordinates]
        guesses[0] = 0.3
        problem = Problem(mechanism=mechanism, parts=DRIVE, q0=tuple(guesses), u0=(12.0, *[0.0] * (n - 1)), t_end=2.0)
        runs.append(simulate(problem, settings))
    one, other = runs
    assert [r.status for r in runs] == ["converged"] * 2
    np.testing.assert_allclose(one.columns["phi"], other.columns["phi"], rtol=1e-8)
    assert closure(held, other) < 1e-12
    assert abs(other.energy.residual) < 1e-8


def six_bar(turns, backend="auto"):
    values = {
        "r": 0.1, "l2": 0.3, "l3": 0.25, "l4": 0.42, "l5": 0.33, "x_D": 0.28, "y_D": 0.0, "x_F": 0.55, "y_F": 0.05,
        "u_E": 0.15, "v_E": 0.12, "m2": 0.6, "m3": 0.5, "m4": 0.4, "m5": 0.5, "I1": 0.05, "I2": 0.006, "I3": 0.004,
        "I4": 0.004, "I5": 0.005, "g": 9.81,
    }  # fmt: skip
    mechanism = bind(str(EXAMPLES / "watt_six_bar.py"), values)
    q0 = tuple(mechanism.dependents.get(q, 0.0) for q in mechanism.coordinates)
    problem = Problem(
        mechanism=mechanism, parts=DRIVE, q0=q0, u0=(20.0, 0.0, 0.0, 0.0, 0.0), t_end=1e4, turns=turns, output=0.05
    )
    return mechanism, simulate(problem, Settings(backend=backend))


def test_the_six_bar_runs_a_thousand_turns():
    mechanism, result = six_bar(1000.0)
    assert (result.status, result.end) == ("converged", "turns")
    assert closure(mechanism, result) < 1e-10
    assert abs(result.energy.residual) < 1e-8


def test_another_integrator_runs_the_six_bar_alike():
    (_, one), (_, other) = six_bar(3.0), six_bar(3.0, "scipy-dop853")
    assert one.columns["phid"][-1] == pytest.approx(other.columns["phid"][-1], rel=1e-8)


def test_a_linkage_swings_through_the_dead_centres_of_its_crank():
    # no Grashof chain: the crank turns back where coupler and rocker are in line, and another coordinate takes over
    mechanism = four_bar(0.3, 0.2, 0.28, 0.45)
    problem = Problem(mechanism=mechanism, parts=(), q0=(0.6, -0.5, 1.8), u0=(2.0, 0.0, 0.0), t_end=10.0)
    result = simulate(problem)
    assert result.status == "converged"
    assert np.ptp(result.columns["phi"]) > 2.5
    turning = result.columns["theta2"] - result.columns["theta3"]
    assert turning.min() < -np.pi < turning.max()  # in line on the way
    energy = result.columns["kinetic_energy"] + result.columns["potential_energy"]
    assert np.ptp(energy) < 1e-8 * np.abs(energy).max()
    assert closure(mechanism, result) < 1e-12


def by_multipliers(sizes, q0, u0, t):
    """Poses over time of crank, rod and rocker from [M J'; J 0], with the weight along y; starts with closed loops."""
    a, b, c, d, m, inertia, g = sizes

    def rates(_, y):
        (s1, s2, s3), (c1, c2, c3) = np.sin(y[:3]), np.cos(y[:3])
        # the rod's middle is a e1 + b/2 e2, the rocker's d + c/2 e3; loop a e1 + b e2 = d + c e3
        M = np.array([
            [4 * inertia + m * a * a, m * a * b / 2 * np.cos(y[0] - y[1]), 0],
            [m * a * b / 2 * np.cos(y[0] - y[1]), inertia + m * b * b / 4, 0],
            [0, 0, inertia + m * c * c / 4],
        ])  # fmt: skip
        J = np.array([[-a * s1, -b * s2, c * s3], [a * c1, b * c2, -c * c3]])
        u = y[3:]
        gamma = np.array([-a * c1, -a * s1]) * u[0] ** 2 + np.array([-b * c2, -b * s2]) * u[1] ** 2
        gamma += np.array([c * c3, c * s3]) * u[2] ** 2
        turn = m * a * b / 2 * np.sin(y[0] - y[1])
        Q = np.array([-turn * u[1] ** 2 - m * g * a * c1, turn * u[0] ** 2 - m * g * b / 2 * c2, -m * g * c / 2 * c3])
        whole = np.block([[M, J.T], [J, np.zeros((2, 2))]])
        return np.concatenate([u, np.linalg.solve(whole, np.concatenate([Q, -gamma]))[:3]])

    run = scipy.integrate.solve_ivp(rates, (0, t), [*q0, *u0], method="DOP853", rtol=1e-13, atol=1e-14)
    return run.y[:3, -1]


@pytest.mark.slow
def test_dead_points_of_the_crank_are_told_and_passed_as_by_multipliers():
    mechanism = four_bar(0.3, 0.2, 0.28, 0.45)
    problem = Problem(mechanism=mechanism, parts=(), q0=(0.6, -0.5, 1.8), u0=(2.0, 0.0, 0.0), t_end=14.0)
    result = simulate(problem, Settings(tolerance=1e-13, check="none"))
    told = [e for e in result.happened.events if e.kind == "dead_point"]
    assert len(told) >= 20 and {e.name for e in told} == {"phi"}
    assert abs(result.energy.residual) < 1e-10
    first = [result.columns[n][0] for n in ("phi", "theta2", "theta3", "phid", "theta2d", "theta3d")]
    last = [result.columns[n][-1] for n in ("phi", "theta2", "theta3")]
    exact = by_multipliers((0.3, 0.2, 0.28, 0.45, 0.8, 0.01, 9.81), first[:3], first[3:], 14.0)
    np.testing.assert_allclose(last, exact, rtol=0, atol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(("backend", "t_end"), [("auto", 8.0), ("scipy-dop853", 0.6)])
def test_a_parallelogram_goes_on_through_its_flat_poses(backend, t_end):
    mechanism = four_bar(0.2, 0.4, 0.2, 0.4)
    problem = Problem(mechanism=mechanism, parts=(), q0=(1.0, 0.0, 1.0), u0=(-6.0, 0.0, 0.0), t_end=t_end)
    result = simulate(problem, Settings(backend=backend, tolerance=1e-12, check="none"))
    # the rod only moves along: a pendulum of crank, rocker and the rod's mass on the crank pin
    inertia, arm = 4 * 0.01 + 0.8 * 0.2**2 + 0.01 + 0.8 * 0.1**2, 0.8 * 0.2 + 0.8 * 0.1

    def swings(_, y):
        return [y[1], -9.81 * arm / inertia * np.cos(y[0])]

    exact = scipy.integrate.solve_ivp(
        swings, (0, t_end), [1.0, -6.0], method="DOP853", rtol=1e-13, atol=1e-13, t_eval=result.t,
        events=lambda t, y: np.sin(y[0]),
    )  # fmt: skip
    np.testing.assert_allclose(result.columns["phi"], exact.y[0], rtol=0, atol=1e-9)
    np.testing.assert_allclose(result.columns["theta2"], 0, atol=1e-11)
    assert abs(result.energy.residual) < 1e-10
    met = [e.t for e in result.happened.events if e.kind == "bifurcation"]
    assert len(met) > (20 if t_end > 1 else 1)
    np.testing.assert_allclose(met, exact.t_events[0], rtol=0, atol=1e-9)


def test_where_no_motion_goes_on_the_run_is_locked():
    # rod and rocker can only just reach the crank's pin, which no torque moves: one pose, and none beside it
    mechanism = four_bar(0.2, 0.15, 0.1, 0.45, weight=0.0)
    problem = Problem(mechanism=mechanism, parts=(), q0=(0.0, 0.0, np.pi), u0=(1.0, 0.0, 0.0), t_end=1.0)
    result = simulate(problem, Settings())
    assert (result.end, result.event.t) == ("locked", 0.0)
