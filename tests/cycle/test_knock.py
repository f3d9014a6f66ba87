"""The knock integral against its closed forms, fine quadrature, and the derivative by differences."""

import json
from functools import partial

import casadi as ca
import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import quad

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.closed.performance import design_function
from mechsym.cycle.closed.run import closed_curves, run, steps_of
from mechsym.cycle.heat import ConstantGamma
from mechsym.cycle.knock import ATM, end_gas_temperature, ignition_delay, knock_along, knock_of_runs, share_of_delay
from mechsym.jobs.cycle import engine
from mechsym.jobs.optimise import optimise
from mechsym.optimise.solver import Optimise, problem, solve

OMEGA = 300.0


def pressure(s):
    return 20e5 * (1 + 1.5 * s**2)


def integrand(s, octane=95.0):
    p = pressure(s)
    return 1.2 * s**3 / (OMEGA * ignition_delay(p, end_gas_temperature(p, 20e5, 700.0, 0.27), octane))


@pytest.mark.parametrize("count", [37, 49, 60])  # even and odd numbers of steps
def test_against_fine_quadrature(count):
    s = np.linspace(0, 1, count)
    p = pressure(s)
    found = share_of_delay(1.2 * s**3, p, end_gas_temperature(p, 20e5, 700.0, 0.27), OMEGA, 95.0)
    assert found == pytest.approx(quad(integrand, 0, 1, epsrel=1e-12)[0], rel=2e-5)


def test_numbers_and_expressions_agree_and_differentiate():
    s = np.linspace(0, 1, 41)
    octane = ca.MX.sym("octane")
    p = ca.DM(pressure(s)).T
    k = share_of_delay(ca.DM(1.2 * s**3).T, p, end_gas_temperature(p, 20e5, 700.0, 0.27), OMEGA, octane)
    f = ca.Function("k", [octane], [k, ca.jacobian(k, octane)])
    numbers = share_of_delay(1.2 * s**3, pressure(s), end_gas_temperature(pressure(s), 20e5, 700.0, 0.27), OMEGA, 95.0)
    assert float(f(95.0)[0]) == pytest.approx(numbers, rel=1e-12)
    assert float(f(95.0)[1]) == pytest.approx(-3.402 / 95.0 * numbers, rel=1e-12)  # closed form of the octane's power


def test_a_state_that_rests_knocks_as_long_as_it_rests():
    """Pressure and temperature constant: (ends - closes) / (omega tau), along curves and of nodes alike."""
    p, T, octane, closes, starts, ends = 40 * ATM, 850.0, 95.0, -2.1, -0.3, 0.6
    wanted = (ends - closes) / (OMEGA * ignition_delay(p, T, octane))
    along = knock_along((lambda a: p + 0 * a, lambda a: T + 0 * a), (closes, starts, ends), OMEGA, 0.27, octane)
    assert along == pytest.approx(wanted, rel=1e-12)
    nodes = {"p": np.full((2, 303), p), "t": np.full((2, 303), T)}
    angles = {"closes": closes, "starts": starts, "ends": ends, "omega": OMEGA}
    runs = knock_of_runs(nodes | {k: np.full(2, v) for k, v in angles.items()}, ConstantGamma(gamma=1.3), octane)
    assert runs == pytest.approx([wanted, wanted], rel=1e-6)


def test_constant_state_is_time_by_delay():
    for p, T, octane in [(20 * ATM, 800.0, 90.0), (60 * ATM, 950.0, 100.0)]:
        tau = ignition_delay(p, T, octane)
        n = np.ones(12)
        assert share_of_delay(OMEGA * tau / 3 * n, p * n, T * n, OMEGA, octane) == pytest.approx(1 / 3, rel=1e-13)


def test_delay_at_the_fits_reference():
    # the printed law at 1 atm and octane 100 is its factor times exp(3800/T)
    assert ignition_delay(ATM, 3800.0, 100.0) == pytest.approx(17.68e-3 * np.e, rel=1e-14)
    assert ignition_delay(2 * ATM, 900.0, 95.0) / ignition_delay(ATM, 900.0, 95.0) == pytest.approx(2**-1.7)


def test_end_gas_keeps_its_entropy():
    T = end_gas_temperature(80e5, 20e5, 700.0, 2 / 7)
    assert T ** (7 / 2) / 80e5 == pytest.approx(700.0 ** (7 / 2) / 20e5, rel=1e-12)


def test_integral_of_an_engine_is_that_of_its_curves():
    case = cases.load("nunes-hypocycloid")
    machine, omega = engine(case), 2000 * np.pi / 30
    k = float(design_function(machine, ["omega"]).call({"design": omega})["knock"])
    result = run(partial(closed_period, machine), {"omega": np.array([omega])})
    phi, p, t = closed_curves(result).even(np.radians(0.02))
    starts, ends = float(result.scalars["starts"][0]), float(result.scalars["ends"][0])
    first = np.searchsorted(phi, starts)
    T = np.where(phi < starts, t, end_gas_temperature(p, p[first], t[first], 2 / 7))
    till = phi <= ends
    rate = 1 / ignition_delay(p, T, machine.cycle.octane) / omega
    assert k == pytest.approx(np.trapezoid(rate[till], phi[till]), rel=3e-3)


def test_optimum_with_a_limit_on_knock_leaves_its_bound():
    """Without it the compression ratio of such a task ends at its bound of 14."""
    machine = engine(cases.load("nunes-hypocycloid"))
    variables = {
        "cycle.ignition": {"low": "-40 deg", "high": "0 deg"},
        "chamber.compression_ratio": {"low": 8, "high": 14},
    }

    def best(constraints):
        wanted = Optimise(variables=variables, constraints=constraints)
        return solve(problem(machine, 4000 * np.pi / 30, wanted))

    free, limited = best({}), best({"knock": {"high": 1.0}})
    assert free.variables["chamber.compression_ratio"] == pytest.approx(14.0, rel=1e-3)
    assert limited.status == "optimal"
    assert limited.figures["knock"] == pytest.approx(1.0, rel=1e-6)
    assert limited.variables["chamber.compression_ratio"] == pytest.approx(11.62, abs=0.02)
    assert limited.figures["efficiency"] < free.figures["efficiency"] - 0.03


def cycled(*words):
    done = CliRunner().invoke(mechsym, ["cycle", *words, "--json"])
    assert done.exit_code == 0, done.output
    return json.loads(done.stdout)


def test_command_shows_what_the_optimiser_holds():
    machine = engine(cases.load("nunes-hypocycloid"))
    speeds = np.array([2000.0, 6000.0]) * np.pi / 30
    found = cycled("nunes-hypocycloid", "--speeds", "2000:6000:4000")["knock"]
    function = design_function(machine, ["omega"])
    assert found == pytest.approx([float(function.call({"design": w})["knock"]) for w in speeds], rel=1e-6)
    # Douaud and Eyzat's power of the octane number
    better = cycled("nunes-hypocycloid", "--set", "cycle.octane=105", "--speeds", "2000")["knock"][0]
    assert better == pytest.approx(found[0] * (95 / 105) ** 3.402, rel=1e-9)


def test_integral_along_curves_is_that_of_a_closed_form():
    # constant state before combustion, constant pressure during it: both stretches are time by delay
    tau = ignition_delay(30e5, 800.0, 95.0)
    found = knock_along((lambda a: 30e5 + 0 * a, lambda a: 800.0 + 0 * a), (0.0, 0.5, 1.25), 100.0, 0.25, 95.0)
    assert found == pytest.approx(1.25 / (100.0 * tau), rel=1e-12)


def test_gas_exchange_knows_its_octane():
    low, high = (cycled("generator-breathing", "--set", f"cycle.octane={o}")["knock"][0] for o in (90, 100))
    assert low / high == pytest.approx((100 / 90) ** 3.402, rel=1e-9)


def test_in_the_loop_the_integral_is_that_of_the_speed_it_runs_at():
    """With a flywheel the loop turns evenly, and its cycles are those of the map at that speed."""
    heavy = ("--set", "flywheel.inertia=100")
    found = cycled("nunes-hypocycloid", "--loop", "2", *heavy)["cycles"][-1]
    case = cases.load("nunes-hypocycloid")
    omega = found["speed_rpm"] * np.pi / 30
    usual = float(design_function(engine(case), ["omega"]).call({"design": omega})["knock"])
    assert found["knock"] == pytest.approx(usual, rel=1e-3)


@pytest.mark.slow
def test_limits_of_the_user_are_doubts_and_constraints(tmp_path):
    text = cases.text("nunes-hypocycloid") + '\n[gas_limits]\npeak_pressure = "6 MPa"\nknock = 0.3\n'
    file = tmp_path / "own.toml"
    file.write_text(text)
    found = {d["code"]: d for d in cycled(str(file))["doubts"]}
    assert set(found) == {"limit_peak_pressure", "limit_knock"}
    assert found["limit_peak_pressure"]["value"] > 6 and found["limit_peak_pressure"]["usual"] == "at most 6"
    free = cycled(str(file), "--set", "gas_limits.peak_pressure=20 MPa", "--set", "gas_limits.knock=5")["doubts"]
    assert free == []
    best = optimise(cases.load(str(file), {"gas_limits.knock": 1.0})).best
    assert best.status == "optimal"
    assert best.figures["p_max"] <= 8e6 * (1 + 1e-6)  # [optimise] names its own limit
    assert best.figures["knock"] <= 1 + 1e-6


@pytest.mark.parametrize("value", ["-1 MPa", "0", "1 K", "nan"])
def test_limits_that_are_none_are_refused(value):
    done = CliRunner().invoke(mechsym, ["cycle", "nunes-hypocycloid", "--set", f"gas_limits.peak_pressure={value}"])
    assert done.exit_code != 0 and "Traceback" not in done.output


def test_the_end_gas_starts_where_combustion_does():
    """At one pressure it keeps the temperature of the last node before, however hot what burns is."""
    steps, p, T, octane = 60, 40 * ATM, 850.0, 95.0
    first = steps_of("before", steps) + 1
    nodes = {"p": np.full((1, steps + 3), p), "t": np.where(np.arange(steps + 3) < first, T, 2500.0)[None, :]}
    angles = {"closes": np.array([-2.1]), "starts": np.array([-0.3]), "ends": np.array([0.6])}
    gas = ConstantGamma(gas_constant=287.0, gamma=1.35)
    share = knock_of_runs({**nodes, **angles, "omega": np.array([OMEGA])}, gas, np.array([octane]))
    assert share[0] == pytest.approx(2.7 / (OMEGA * ignition_delay(p, T, octane)), rel=1e-9)
