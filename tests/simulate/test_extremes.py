"""Least and greatest speed are those of the motion, wherever results were asked for: closed forms, finer sampling."""

import json
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import scipy
from click.testing import CliRunner
from simulated import shaft

from mechsym import cases
from mechsym.cases.settings import settings_of
from mechsym.cli import mechsym
from mechsym.jobs.run import run, run_of
from mechsym.machine.loads import ConstantLoad
from mechsym.simulate import Part, Problem, Settings, simulate
from mechsym.simulate.angle import ReducedMachine, tabulate
from mechsym.simulate.between import between
from mechsym.simulate.problem import FormulaForce, Kinks, Periodic
from mechsym.simulate.result import extremes_of, last_period, speed_ripple, speeds_over, summary
from mechsym.simulate.steady import steady_state

ATKINSON = Path(__file__).parents[2] / "examples" / "mechanisms" / "atkinson.toml"


def turning(speed=10.0, output=0.5, **changes):
    """A shaft without load."""
    values = {"mechanism": shaft(), "parts": (), "q0": (0.0,), "u0": (speed,), "t_end": 4.0, "output": output}
    return Problem(**(values | changes))


@pytest.mark.parametrize("backend", ["auto", "scipy-dop853", "scipy-rk45"])
def test_rotor_driven_by_a_sine_in_time(backend):
    # I u' = A cos(w t): u = u0 + A/(I w) sin(w t), sampled twice in a cycle where the sine is nought
    amplitude, frequency = 6.0, 2 * np.pi
    import casadi as ca

    force = FormulaForce(function=lambda t, q, u: amplitude * ca.cos(frequency * t))
    result = simulate(
        turning(parts=(Part(name="drive", input="M", value=force),)),
        Settings(tolerance=1e-11, backend=backend, check="none"),
    )
    assert np.ptp(result.columns["phid"]) < 1e-8
    found = speeds_over(result, ("phi",), 0.0)["phi"]
    swing = amplitude / (3.0 * frequency)
    assert (found.min, found.max) == pytest.approx((10.0 - swing, 10.0 + swing), abs=1e-9)
    assert found.ripple == pytest.approx(2 * swing / 10.0, rel=1e-8)


@pytest.mark.parametrize("backend", ["auto", "scipy-dop853"])
def test_extremes_at_kinks_of_a_torque(backend):
    # torque of +- A over half a turn each: the energy is a triangle, its corners lie at the kinks
    torque, kinks, output = 20.0, (0.7, 0.7 + np.pi), 0.4711
    square = Periodic(
        coordinate="phi", period=2 * np.pi, kinks=kinks,
        value=lambda phi: np.where((np.asarray(phi) - 0.7) % (2 * np.pi) < np.pi, torque, -torque),
    )  # fmt: skip
    result = simulate(
        turning(
            parts=(Part(name="drive", input="M", value=square),), output=output,
            kinks=(Kinks(coordinate="phi", angles=kinks, period=2 * np.pi),),
        ),
        Settings(tolerance=1e-11, backend=backend, check="none"),
    )  # fmt: skip
    found = speeds_over(result, ("phi",), last_period(result, "phi"))["phi"]
    start = 10.0**2 - 2 * torque * 0.7 / 3.0  # at the first kink, where the energy is least
    assert found.min == pytest.approx(np.sqrt(start), rel=1e-9)
    assert found.max == pytest.approx(np.sqrt(start + 2 * torque * np.pi / 3.0), rel=1e-9)


@pytest.mark.parametrize("way", [1.0, -1.0])
def test_a_shaft_that_turns_backwards_has_the_ripple_of_one_that_turns_forwards(way):
    # a weight on the rim: I u^2/2 = I u0^2/2 - w (1 - cos phi), so the period and the extremes are closed forms
    result = simulate(turning(way * 10.0, mechanism=shaft(3.0, 20.0)), Settings(tolerance=1e-11))
    slowest = np.sqrt(10.0**2 - 4 * 20.0 / 3.0)
    duration = scipy.integrate.quad(lambda a: 1 / np.sqrt(100.0 - 40.0 / 3.0 * (1 - np.cos(a))), 0, 2 * np.pi)[0]
    assert result.t[-1] - last_period(result, "phi") == pytest.approx(duration, rel=1e-8)
    assert speed_ripple(result, "phi") == pytest.approx((10.0 - slowest) / (2 * np.pi / duration), rel=1e-8)
    told = summary(result, ("phi",), None)
    assert np.sign(told.speed_mean) == way and told.window == pytest.approx(duration, rel=1e-8)
    assert (told.speed_min, told.speed_max) == pytest.approx(
        (slowest, 10.0) if way > 0 else (-10.0, -slowest), rel=1e-9
    )


def test_steady_motion_over_the_angle():
    # no load and a torque A sin(phi - 1): the energy swings by A about its middle; mean by quadrature
    middle, swing, inertia = 150.0, 12.0, 3.0
    panels = tabulate(ReducedMachine(
        inertia=lambda phi: np.full_like(phi, inertia), torque=lambda phi: swing * np.sin(phi - 1.0),
        load=ConstantLoad(torque=0.0),
    ))  # fmt: skip
    low, high = (np.sqrt(2 * (middle + side * swing) / inertia) for side in (-1.0, 1.0))
    slow = scipy.integrate.quad(lambda a: 1 / np.sqrt(2 * (middle - swing * np.cos(a)) / inertia), 0, 2 * np.pi)[0]
    mean = 2 * np.pi / slow
    assert steady_state(panels, mean).speed_ripple == pytest.approx((high - low) / mean, rel=1e-10)


def test_the_command_says_the_same_however_rarely_results_are_asked_for():
    told = []
    for step in ("10 ms", "0.1 ms"):  # 36 degrees, and 100 times as many
        asked = ["simulate", str(ATKINSON), "--set", f"simulation.output_step={step}", "--json"]
        told.append(json.loads(CliRunner().invoke(mechsym, asked).output))
    for key in ("speed_mean", "speed_min", "speed_max"):
        assert told[0][key] == pytest.approx(told[1][key], rel=1e-8)


def swung(h, end=6.0, lead=0.01, amplitude=0.02, w=50.0):
    """Samples of a swing, each h apart by its phase."""
    t = np.arange(0, end, h / w)
    return t, {"q": lead + amplitude * np.sin(w * t), "qd": amplitude * w * np.cos(w * t)}


@pytest.mark.parametrize("h", [0.1, 0.5, 1.0])
def test_between_three_samples_lies_what_they_tell(h):
    t, columns = swung(h)
    times = np.linspace(t[0], t[-1], 7001)
    there = between(t, columns)(times)
    assert np.abs(there["q"] - 0.01 - 0.02 * np.sin(50.0 * times)).max() <= 0.02 * (2.1e-4 * h**6 + 1e-14)
    assert np.abs(there["qd"] - np.cos(50.0 * times)).max() <= 2e-3 * h**5 + 1e-12


def test_a_polynomial_of_degree_five_is_met_exactly():
    t = np.array([0.0, 0.3, 0.5, 1.1, 1.2])
    q = np.polynomial.Polynomial([1.0, -2.0, 0.5, 3.0, -1.0, 0.7])
    times = np.linspace(0, 1.2, 50)
    there = between(t, {"q": q(t), "qd": q.deriv()(t)})(times)
    assert there["q"] == pytest.approx(q(times), abs=1e-12)
    assert there["qd"] == pytest.approx(q.deriv()(times), abs=1e-11)


def run_with(t, columns, dense=None):
    return SimpleNamespace(t=t, columns=columns, dense=dense, steps=100)


def both(columns):
    return np.array([columns["q"], 3.0 * columns["q"] + 0.1 * columns["qd"]])


def test_extremes_lie_between_samples_that_tell_each_other():
    least, greatest = extremes_of(run_with(*swung(0.9)), both)
    lead, swing = np.array([0.01, 0.03]), np.array([0.02, np.hypot(0.06, 0.1)])
    assert least == pytest.approx(lead - swing, rel=3e-4) and greatest == pytest.approx(lead + swing, rel=3e-4)


def test_samples_that_tell_nothing_of_each_other_are_looked_between():
    t, columns = swung(2.2)
    assert extremes_of(run_with(t, columns), both)[1][0] == columns["q"].max()  # nobody knows more
    dense = lambda times: {"q": 0.01 + 0.02 * np.sin(50.0 * times), "qd": np.cos(50.0 * times)}  # noqa: E731
    least, greatest = extremes_of(run_with(t, columns, dense), both)
    assert (least[0], greatest[0]) == pytest.approx((-0.01, 0.03), abs=1e-12)
    late = extremes_of(run_with(t, columns, dense), both, since=5.9)[0][0]  # of less than a swing
    assert late == pytest.approx(dense(np.linspace(t[t >= 5.9][0], t[-1], 10_001))["q"].min(), abs=1e-12)


def test_nothing_is_told_across_a_blow():
    # a ball that springs back: between the samples before and after there is no smooth curve
    t = np.concatenate([np.linspace(0, 1, 40), np.linspace(1, 2, 40)])
    columns = {"q": np.abs(1.0 - t), "qd": np.where(np.arange(80) < 40, -1.0, 1.0)}
    least, greatest = extremes_of(run_with(t, columns), lambda at: np.array([at["q"]]))
    assert (least[0], greatest[0]) == (0.0, 1.0)


@pytest.mark.parametrize("step", ["10 ms", "37 ms"])
def test_outputs_of_a_run_are_those_of_the_motion(step):
    # the rocker of a Whitworth drive swings by asin(r/h) either way
    case = cases.load(str(ATKINSON.with_name("whitworth.toml")), {"simulation.output_step": step})
    r, h = case.need("parameters").r, case.need("parameters").h
    angle = run(case, check="none").outputs["rocker_angle"]
    assert (angle["min"], angle["max"]) == pytest.approx((-np.arcsin(r / h), np.arcsin(r / h)), rel=1e-8)


def test_a_run_that_cannot_be_taken_up_again_tells_what_its_samples_do():
    # a start-up of a huge machine: no work is done yet where a second run would begin, and the power is 1e18 W
    case = cases.load("chmielewski", {
        "parameters.I0": "2.6e9 kg*m^2", "parameters.I2": "5.8e9 kg*m^2", "parameters.r": "6 m", "parameters.l": "26 m",
        "parameters.m0": "1.1e6 kg", "parameters.k1": "6.5e17 N*m/rad", "drive.torque": "1.5e14 N*m",
        "drive.time": "0.01 s", "simulation.t_end": "0.2 s", "simulation.output_step": "0.05 ms",
        "simulation.window": "0.02 s",
    })  # fmt: skip
    found = run_of(case, replace(settings_of(case), check="none"))[1]
    assert np.isfinite(list(found.speeds["phi0"].values())).all() and found.speeds["phi0"]["max"] > 0


def test_what_is_constant_is_told_by_its_samples_and_a_single_one_by_itself():
    t, columns = swung(0.3)
    fixed = {"q": np.full_like(t, 0.7), "qd": 0 * t}
    asked = []
    run = run_with(t, fixed, dense=lambda times: asked.append(times))
    assert extremes_of(run, lambda at: at["q"][None])[1][0] == pytest.approx(0.7, abs=1e-15) and not asked
    assert extremes_of(run_with(t, columns), both, since=t[-1])[0][0] == columns["q"][-1]
