"""Combustion out of pressure: a synthetic diagram taken apart again, and the measured one."""

import dataclasses
import json
import math
from functools import partial

import numpy as np
import pytest
import shipped_record
from click.testing import CliRunner

from mechsym.cases import load, text
from mechsym.cli.cycle import cycle as cycle_command
from mechsym.cycle.chamber import chamber
from mechsym.cycle.closed.model import closed_period
from mechsym.cycle.closed.run import closed_curves, run
from mechsym.cycle.measured.checks import _EXPANSION_TOLD
from mechsym.cycle.measured.combustion import fit_double_wiebe, fit_wiebe, least_squares_fit
from mechsym.cycle.measured.heat_release import (
    Walls,
    burn_angles,
    burnt_fraction,
    combustion,
    cumulative,
    heat_release,
)
from mechsym.cycle.wiebe import double_wiebe
from mechsym.jobs.cycle import engine
from mechsym.jobs.flywheel import flywheel
from mechsym.jobs.machine import machine, turn
from mechsym.jobs.problem import problem_of
from mechsym.quantities import RPM

DEG = math.pi / 180
OMEGA = 3000 * RPM


def one_piston(**changes):
    machine = engine(load("nunes-slider-crank", {"chamber.pistons": "1"}))
    return dataclasses.replace(machine, cycle=dataclasses.replace(machine.cycle, **changes))


def cylinder_of(machine):
    return chamber(machine.chamber, machine.motion)


@pytest.fixture(scope="module")
def synthetic():
    """Engine, its run, and its pressure every half degree."""
    machine = one_piston(vaporisation="none")
    result = run(partial(closed_period, machine), {"omega": OMEGA}, steps=960)
    phi, p, t = closed_curves(result).even(0.5 * DEG)
    return machine, result.scalars, phi, p


def test_gross_heat_release_gives_the_model_s_heat_back(synthetic):
    machine, scalars, phi, p = synthetic
    walls = Walls(law=machine.heat_transfer, mass=scalars["mass"][0], gas_constant=287.0, omega=OMEGA)
    q = heat_release(phi, p, cylinder_of(machine), 1.4, walls)
    assert q[-1] == pytest.approx(scalars["heat_released"][0], rel=2e-4)
    assert np.abs(q[phi < -12 * DEG]).max() < 1e-3 * q[-1]  # nothing is released before ignition
    net = heat_release(phi, p, cylinder_of(machine), 1.4)
    assert q[-1] - net[-1] == pytest.approx(scalars["wall_heat"][0], rel=1e-3)


def test_wiebe_function_and_burn_points_come_back(synthetic):
    machine, scalars, phi, p = synthetic
    walls = Walls(law=machine.heat_transfer, mass=scalars["mass"][0], gas_constant=287.0, omega=OMEGA)
    burnt = burnt_fraction(phi, heat_release(phi, p, cylinder_of(machine), 1.4, walls))
    start, end = scalars["starts"][0], scalars["ends"][0]
    fit = fit_wiebe(phi[np.abs(phi) < 1], burnt[np.abs(phi) < 1])
    assert fit.names == ("start", "duration", "m")
    assert np.abs(np.array(fit.values) - [start, end - start, 2.0]) == pytest.approx([0, 0, 0], abs=0.02)
    y = np.array([-math.log(1 - x * (1 - math.exp(-5))) / 5 for x in (0.1, 0.5, 0.9)]) ** (1 / 3)
    assert np.array(burn_angles(phi, burnt)) == pytest.approx(start + y * (end - start), abs=0.1 * DEG)


@pytest.mark.parametrize(("rpm", "more"), [(300, 0.20), (8000, 0.08)])
def test_the_walls_raise_the_expansion_as_the_limit_allows(rpm, more):
    """The limit of the expansion that is told: burnt gas, 1.3, and what the walls of a small slow engine take."""
    machine = engine(load("nunes-slider-crank"))
    phi, p, _ = closed_curves(run(partial(closed_period, machine), {"omega": rpm * RPM})).even(0.5 * DEG)
    found = combustion(phi, p, cylinder_of(machine), 1.32, (phi[0], phi[-1]))
    assert found.n_expansion - machine.gas.gamma == pytest.approx(more, abs=0.01)
    assert 1.3 + more <= _EXPANSION_TOLD[1] + 0.01


def test_double_wiebe_comes_back(rng):
    phi = np.linspace(-30, 90, 481) * DEG
    y = (phi + 5 * DEG) / (60 * DEG)
    shares = double_wiebe(y, 5.0, 2.0, 5.0, 1.0, 0.0), double_wiebe(y / 2, 5.0, 2.0, 5.0, 1.0, 0.0)
    burnt = 0.6 * shares[0] + 0.4 * shares[1]
    fit = fit_double_wiebe(phi, burnt + rng.normal(0, 1e-3, phi.size))
    rebuilt = dict(zip(fit.names, fit.values, strict=True))
    assert fit.rms < 1.2e-3 and rebuilt["start"] == pytest.approx(-5 * DEG, abs=4 * DEG)
    assert fit.rms < 0.5 * fit_wiebe(phi, burnt).rms


@pytest.mark.parametrize("late", [0.02, 0.1, 0.9])
def test_the_shorter_part_is_the_premixed_one(late):
    phi = np.linspace(-30, 120, 481) * DEG
    parts = [double_wiebe((phi + 6 * DEG) / d, 5.0, m, 5.0, 1.0, 0.0) for d, m in ((50 * DEG, 3.0), (60 * DEG, 0.3))]
    fit = fit_double_wiebe(phi, (1 - late) * parts[0] + late * parts[1])
    wanted = {"start": -6 * DEG, "duration_p": 50 * DEG, "duration_d": 60 * DEG, "m_p": 3.0, "m_d": 0.3, "b": late}
    assert dict(zip(fit.names, fit.values, strict=True)) == pytest.approx(wanted, abs=1e-3)


def test_confidence_covers_what_it_says(rng):
    x, inside = np.linspace(0, 1, 100), 0
    for _ in range(200):
        y = 2.0 * x + 1.0 + rng.normal(0, 0.1, x.size)
        box = (np.full(2, -np.inf), np.full(2, np.inf))
        fit = least_squares_fit(lambda k, y=y: k[0] * x + k[1] - y, {"a": "-", "b": "-"}, np.zeros(2), box)
        inside += abs(fit.values[0] - 2.0) < fit.confidence[0]
    assert 180 <= inside <= 200


def test_an_undetermined_parameter_has_no_confidence():
    x = np.linspace(0, 1, 50)
    box = (np.full(2, -np.inf), np.full(2, np.inf))
    fit = least_squares_fit(
        lambda k: (k[0] + k[1]) * x - x + 0.01 * np.sin(9 * x), {"a": "-", "b": "-"}, np.zeros(2), box
    )
    assert not np.isfinite(fit.confidence[0])


def test_burn_points_that_are_not_reached_are_nan():
    phi = np.linspace(0, 1, 11)
    assert np.isnan(burn_angles(phi, 0.8 * phi)[2]) and burn_angles(phi, phi)[1] == pytest.approx(0.5)
    assert cumulative(phi, np.ones(11))[-1] == pytest.approx(1.0)


def test_work_of_a_closed_loop_is_that_of_the_model(synthetic):
    machine, scalars, phi, p = synthetic
    whole = np.arange(-180.0, 180.0, 0.5) * DEG
    found = combustion(whole, np.interp(whole, phi, p), cylinder_of(machine), 1.4, (-3.0, 3.0))
    assert found.work == pytest.approx(scalars["work"][0], rel=1e-3)
    assert found.n_compression == pytest.approx(1.37, abs=0.03)


def measured(data, *more):
    file = str(data / "generator-half-load.csv")
    arguments = ["generator", "--diagram", file, "--json", *more]
    result = CliRunner().invoke(cycle_command, arguments, catch_exceptions=False)
    return json.loads(result.stdout)


def test_measured_diagram_cycle_by_cycle(measured_data, tmp_path):
    found = measured(measured_data, "--out", str(tmp_path))
    cycles = found["cycles"]
    assert len(cycles) == 12 and found["weak_cycles"] == [12]
    sound = [c for c in cycles if not c["weak"]]
    assert all(3.0 < c["mep_bar"] < 4.8 and 9 < c["p_max_bar"] < 18 for c in sound)
    assert all(5 < c["burn_10_deg"] < c["burn_50_deg"] < c["burn_90_deg"] < 60 for c in sound)
    misfire = cycles[11]
    assert misfire["mep_bar"] < 0.65 * np.median([c["mep_bar"] for c in cycles]) and misfire["burn_50_deg"] > 45
    # one degree of dead centre is worth several per cent of work and heat
    assert 0.02 < abs(found["per_degree"]["work"]) < 0.05 and 0.02 < abs(found["per_degree"]["heat"]) < 0.05
    spread = found["tdc_uncertainty_deg"]
    assert found["uncertainty"]["work"] == pytest.approx(abs(found["per_degree"]["work"]) * spread, rel=1e-12)
    assert found["double_wiebe"]["rms"] < found["wiebe"]["rms"] < 0.01
    assert (tmp_path / "combustion.csv").read_text().count("\n") == 13


def test_a_diagram_beside_its_case_is_found_from_anywhere(tmp_path, monkeypatch):
    record = "\n".join(shipped_record.text().splitlines())
    (tmp_path / "engine.toml").write_text(text("generator").replace("generator-synthetic.csv", "mine.csv"))
    (tmp_path / "mine.csv").write_text(record)
    monkeypatch.chdir(tmp_path.parent)
    assert load(str(tmp_path / "engine.toml")).need("cycle").file == str(tmp_path / "mine.csv")


def test_the_shipped_record_is_what_its_simulation_gives():
    assert shipped_record.PATH.read_text(encoding="utf-8") == shipped_record.text()


def test_generator_runs_from_the_package_alone():
    arguments = ["generator", "--json"]
    found = json.loads(CliRunner().invoke(cycle_command, arguments, catch_exceptions=False).stdout)
    low, high = found["dead_centre"]["interval_deg"]
    assert low < shipped_record.TRUE_DEAD_CENTRE - 360 < high and found["doubts"] == []
    assert found["speed_rpm"] == pytest.approx(3000, abs=1) and 3 < found["mep_bar"] < 5
    assert found["read_and_used"].startswith("peak ")


def test_a_machine_turns_at_the_speed_of_its_record():
    for changes, rpm in (({}, 3000), ({"speed_rpm": "2500"}, 2500)):
        case = load("generator", changes)
        (started,) = problem_of(case).u0
        speeds = machine(case).omega, turn(case).omega, started, flywheel(case, 0.02).steady.speed_mean
        assert speeds == pytest.approx(np.full(4, rpm * RPM), rel=1e-3)


def test_an_expansion_with_hardly_any_exponent_is_doubted(tmp_path):
    """A record that goes on burning: its gas takes heat in up to the exhaust, as one at light load does."""
    lines = [line for line in shipped_record.text().splitlines() if not line.startswith("#")]
    angle, time, signal = np.array([[float(x) for x in line.split(",")] for line in lines[1:]]).T
    phi = np.remainder(angle - shipped_record.TRUE_DEAD_CENTRE + 360, 720) * DEG - 2 * math.pi
    travel = 0.0275 * (1 - np.cos(phi)) + 0.0842 - np.sqrt(0.0842**2 - (0.0275 * np.sin(phi)) ** 2)
    room = 0.055 / 7.5 + travel
    late = (phi > 60 * DEG) & (phi < 125 * DEG)
    burning = np.where(late, (room / room[late].min()) ** 0.37, 1.0)
    signal = 2 + (signal - 2) * burning  # the sensor adds 2 bar
    rows = [f"{a:g},{t:.6f},{s:.3f}" for a, t, s in zip(angle, time, signal, strict=True)]
    (tmp_path / "late.csv").write_text("\n".join([lines[0], *rows]))
    arguments = ["generator", "--diagram", str(tmp_path / "late.csv"), "--json"]
    found = json.loads(CliRunner().invoke(cycle_command, arguments, catch_exceptions=False).stdout)
    assert found["n_expansion"] < 1.0
    (doubt,) = (d for d in found["doubts"] if d["code"] == "expansion_exponent")
    assert doubt["value"] == found["n_expansion"] and doubt["usual"] == "1.15 to 1.5"
