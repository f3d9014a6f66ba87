"""Loops closed by constraint in time: against the closed form, long runs, changes of the choice, a singular pose."""

from pathlib import Path

import linkages
import numpy as np
import pytest

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


@pytest.mark.parametrize("backend", ["auto", "scipy-dop853"])
def test_a_parallelogram_that_falls_flat_is_locked(backend):
    mechanism = four_bar(0.2, 0.4, 0.2, 0.4, weight=0.0)
    problem = Problem(mechanism=mechanism, parts=(), q0=(1.0, 0.0, 1.0), u0=(-3.0, 0.0, 0.0), t_end=20.0)
    result = simulate(problem, Settings(backend=backend))
    assert result.end == "locked"
    assert result.event.t == pytest.approx(1 / 3, abs=1e-5)  # turns evenly until then: translation of the coupler
    assert result.event.state["phi"] == pytest.approx(0.0, abs=3e-5)
