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
from mechsym.cycle.closed.run import at_angles, run
from mechsym.cycle.measured.fits import fit_double_wiebe, fit_wiebe, least_squares_fit
from mechsym.cycle.measured.heat_release import (
    Walls,
    burn_angles,
    burnt_fraction,
    combustion,
    cumulative,
    heat_release,
)
from mechsym.cycle.measured.identify import identify
from mechsym.cycle.wiebe import double_wiebe
from mechsym.errors import BadInput
from mechsym.jobs.cycle import engine
from mechsym.jobs.machine import machine
from mechsym.quantities import RPM

DEG = math.pi / 180
OMEGA = 3000 * RPM
TDC_ERROR = 0.5 * DEG
NOISE, OFFSET = 2000.0, 5000.0  # 0.02 bar of noise, 0.05 bar of unknown offset


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
    phi, p, t = at_angles(result, 0.5 * DEG)
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


def test_noise_tdc_error_and_offset_are_taken_apart_again(rng):
    machine = engine(load("nunes-slider-crank"))
    result = run(partial(closed_period, machine), {"omega": OMEGA}, steps=960)
    phi, p, _ = at_angles(result, 0.25 * DEG)
    angles = np.arange(-150.0, 150.0, 0.5) * DEG
    measured = np.interp(angles - TDC_ERROR, phi, p) + OFFSET + rng.normal(0, NOISE, angles.size)
    begin = {
        "cycle.ignition": (-5 * DEG, 2 * DEG, -9.07 * DEG), "cycle.duration": (40 * DEG, 5 * DEG, 30.663 * DEG),
        "cycle.wiebe_m": (1.5, 0.3, 2.0), "cycle.combustion_efficiency_max": (0.8, 0.05, 0.9),
        "cycle.intake_pressure": (98e3, 3e3, 101325.0), "tdc": (0.0, 0.5 * DEG, TDC_ERROR),
        "offset": (0.0, 5e3, OFFSET),
    }  # fmt: skip
    start, scale = ({k: v[i] for k, v in begin.items()} for i in (0, 1))
    fit = identify(machine, OMEGA, angles, measured, start, scale)
    found, half = (dict(zip(fit.names, row, strict=True)) for row in (fit.values, fit.confidence))
    assert fit.rms == pytest.approx(NOISE, rel=0.1)
    assert found["tdc"] == pytest.approx(TDC_ERROR, abs=0.05 * DEG)
    assert found["cycle.ignition"] == pytest.approx(-9.07 * DEG, abs=0.1 * DEG)
    assert found["cycle.duration"] == pytest.approx(30.663 * DEG, abs=0.2 * DEG)
    assert found["cycle.wiebe_m"] == pytest.approx(2.0, abs=0.02)
    assert found["cycle.combustion_efficiency_max"] == pytest.approx(0.9, rel=0.005)  # the heat released
    assert found["cycle.intake_pressure"] == pytest.approx(101325.0, rel=0.005)  # the trapped mass
    # the confidence intervals are honest: none of the seven errors is far outside, and none is absurdly wide
    errors = [abs(found[k] - v[2]) / half[k] for k, v in begin.items()]
    assert max(errors) < 2 and half["tdc"] < 0.1 * DEG


def test_a_dead_centre_that_is_left_alone_spoils_the_combustion(rng):
    machine = engine(load("nunes-slider-crank"))
    phi, p, _ = at_angles(run(partial(closed_period, machine), {"omega": OMEGA}, steps=960), 0.25 * DEG)
    angles = np.arange(-150.0, 150.0, 0.5) * DEG
    measured = np.interp(angles - TDC_ERROR, phi, p) + rng.normal(0, NOISE, angles.size)
    start, scale = {"cycle.ignition": -9 * DEG, "cycle.wiebe_m": 2.0}, {"cycle.ignition": 2 * DEG, "cycle.wiebe_m": 0.3}
    fit = identify(machine, OMEGA, angles, measured, start, scale)
    assert fit.rms > 5 * NOISE


def test_angles_outside_the_closed_period_are_refused(synthetic):
    machine, _, phi, p = synthetic
    with pytest.raises(BadInput, match="leave the closed period"):
        identify(machine, OMEGA, phi + 1.0, p, {"cycle.wiebe_m": 2.0}, {"cycle.wiebe_m": 0.3})


def test_double_wiebe_comes_back(rng):
    phi = np.linspace(-30, 90, 481) * DEG
    y = (phi + 5 * DEG) / (60 * DEG)
    shares = double_wiebe(y, 5.0, 2.0, 5.0, 1.0, 0.0), double_wiebe(y / 2, 5.0, 2.0, 5.0, 1.0, 0.0)
    burnt = 0.6 * shares[0] + 0.4 * shares[1]
    fit = fit_double_wiebe(phi, burnt + rng.normal(0, 1e-3, phi.size))
    rebuilt = dict(zip(fit.names, fit.values, strict=True))
    assert fit.rms < 1.2e-3 and rebuilt["start"] == pytest.approx(-5 * DEG, abs=4 * DEG)
    assert fit.rms < 0.5 * fit_wiebe(phi, burnt).rms


def test_confidence_covers_what_it_says(rng):
    x, inside = np.linspace(0, 1, 100), 0
    for _ in range(200):
        y = 2.0 * x + 1.0 + rng.normal(0, 0.1, x.size)
        box = (np.full(2, -np.inf), np.full(2, np.inf))
        fit = least_squares_fit(lambda k, y=y: k[0] * x + k[1] - y, ("a", "b"), np.zeros(2), box)
        inside += abs(fit.values[0] - 2.0) < fit.confidence[0]
    assert 180 <= inside <= 200


def test_an_undetermined_parameter_has_no_confidence():
    x = np.linspace(0, 1, 50)
    box = (np.full(2, -np.inf), np.full(2, np.inf))
    fit = least_squares_fit(lambda k: (k[0] + k[1]) * x - x + 0.01 * np.sin(9 * x), ("a", "b"), np.zeros(2), box)
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
    assert machine(load("generator")).omega == pytest.approx(3000 * RPM, rel=1e-3)
    assert machine(load("generator", {"speed_rpm": "2500"})).omega == pytest.approx(2500 * RPM)
