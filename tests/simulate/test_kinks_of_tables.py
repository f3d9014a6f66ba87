"""A torque from a table: its rows are kinks, which no step crosses; and runs that only a tighter tolerance tells."""

import dataclasses
import math

import numpy as np
import pytest
import scipy.integrate
import scipy.interpolate
from simulated import double_pendulum, shaft

from mechsym import cases
from mechsym.jobs.run import run
from mechsym.machine.torque_curve import read_torque
from mechsym.simulate.many import simulate_many
from mechsym.simulate.problem import Part, Problem
from mechsym.simulate.run import simulate
from mechsym.simulate.settings import Settings

DECLARATION = """
from mechsym.derive import Mechanism

def disc():
    m = Mechanism("disc", about="A disc.")
    phi = m.coordinates("phi")
    m.pin("O", m.frame, m.link("disc", turns=phi, mass="20 kg", inertia="0.475 kg*m^2"))
    T = m.inputs("T", "N*m")
    m.rotor("disc", angle=phi, load=T)
    m.torque(-T, along=phi)
    return m
"""
CASE = """
mechanism = "./disc.py"
[operation]
speed = "180 rpm"
[torque]
file = "press.csv"
[simulation]
turns = 20
"""
INERTIA, START = 0.475, 180 * math.pi / 30


@pytest.fixture
def press(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    phi = np.arange(0, 360, 5)
    torque = -32 - 720 * np.exp(-(((phi - 260) / 12) ** 2))
    rows = [f"{a}, {t:.6f}" for a, t in zip(phi, torque, strict=True)]
    (tmp_path / "press.csv").write_text("\n".join(["phi [deg], torque [N*m]", *rows]) + "\n")
    (tmp_path / "disc.py").write_text(DECLARATION)
    (tmp_path / "case.toml").write_text(CASE)
    return np.radians(phi), np.array([float(row.split(",")[1]) for row in rows])


def test_a_press_without_a_flywheel_runs_as_its_energy_says(press):
    phi, torque = press
    result = run(cases.load("case.toml")).result
    # I omega^2 / 2 at an angle is that of the start and what torque and its mean, which the drive gives, have done
    spline = scipy.interpolate.CubicSpline(np.append(phi, 2 * np.pi), np.append(torque, torque[0]), bc_type="periodic")
    mean = spline.integrate(0, 2 * np.pi) / (2 * np.pi)
    fine = np.linspace(0, 2 * np.pi, 72 * 200 + 1)
    omega = np.sqrt(START**2 + 2 / INERTIA * (spline.antiderivative()(fine) - mean * fine))
    period = scipy.integrate.simpson(1 / omega, x=fine)
    assert result.status == "converged" and result.tolerance_difference < 1e-6
    assert result.t[-1] == pytest.approx(20 * period, rel=1e-8)
    assert result.columns["phid"].min() == pytest.approx(omega.min(), rel=1e-3)


def test_the_rows_of_a_table_are_its_kinks(press):
    assert np.array(read_torque("press.csv").kinks) == pytest.approx(press[0], abs=1e-12)


def test_kinks_that_nobody_tells_are_no_chaos(press):
    """The check at a hundredth of the tolerance becomes the run, where one at a ten-thousandth agrees with it."""
    phi, torque = press
    spline = scipy.interpolate.CubicSpline(np.append(phi, 2 * np.pi), np.append(torque, torque[0]), bc_type="periodic")
    mean = spline.integrate(0, 2 * np.pi) / (2 * np.pi)
    acts = Part(name="press", input="M", value=lambda t, q, u: float(spline(q[0])) - mean)
    problem = Problem(mechanism=shaft(INERTIA), parts=(acts,), q0=(0.0,), u0=(START,), t_end=9.0, output=0.02)
    settings = Settings(backend="scipy-dop853", tolerance=1e-10, difference_allowed=1e-5)
    result = simulate(problem, settings)
    assert result.status == "converged" and result.tolerance == pytest.approx(1e-12)
    assert "at the tolerance 1e-12: 1e-10 was not enough" in result.reason
    alone = simulate(problem, dataclasses.replace(settings, tolerance=1e-12))
    assert alone.tolerance is None and alone.t[-1] == result.t[-1]
    assert alone.tolerance_difference == result.tolerance_difference < 1e-5


def test_an_ensemble_and_a_single_run_give_one_verdict():
    """Two pendulums of a chaotic and a calm start together: what is said of each is what is said of it alone."""
    settings = Settings(tolerance=1e-10)
    calm = Problem(mechanism=double_pendulum(), parts=(), q0=(0.1, 0.1), u0=(0.0, 0.0), t_end=60.0, output=0.05)
    problems = [dataclasses.replace(calm, q0=(2.5, 2.0)), calm]
    together, alone = simulate_many(problems, settings), [simulate(one, settings) for one in problems]
    assert [one.status for one in together] == [one.status for one in alone] == ["chaotic", "converged"]
    assert [one.tolerance for one in together] == [None, None]
