"""The case `generator-breathing`: its figures, its limits, its turbocharger, and what else its pressure drives."""

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.cycle import cycle
from mechsym.jobs.gas import gas

CASE = "generator-breathing"


def shown(*options):
    found = CliRunner().invoke(mechsym, ["cycle", CASE, "--json", *options])
    assert found.exit_code == 0, found.output
    return json.loads(found.stdout)


def figures(overrides=None, rpm=(3000.0,)):
    return cycle(cases.load(CASE, overrides or {}), np.array(rpm) * math.pi / 30)


def test_command_gives_the_figures_of_the_interface():
    found = shown("--speeds", "1500,3000")
    for name in ("torque_avg", "torque_max", "power_kw", "sfc_g_kwh", "efficiency", "p_max_mpa", "brake_power_kw"):
        assert len(found[name]) == 2
        assert all(value > 0 for value in found[name])
    for k in range(2):
        assert sum(values[k] for values in found["fractions"].values()) == pytest.approx(1.0)
        assert found["energy_residual"][k] < 1e-9
        assert found["mass_residual"][k] < 1e-9
        assert 0.5 < found["volumetric_efficiency"][k] < 1.0
    # gas exchange is a part of the mean pressure, and friction of the brake figures only
    assert all(value < 0 for value in found["pumping_mep_kpa"])
    displacement = math.pi / 4 * 0.0677**2 * 0.055
    brake = (found["mep_kpa"][1] - found["friction_mep_kpa"][1]) * 1e3 * displacement * 25 / 1e3
    assert found["brake_power_kw"][1] == pytest.approx(brake, rel=1e-9)
    assert found["doubts"] == []


def test_filling_air_and_fuel_are_one_book():
    found = shown("--speeds", "3059,4000")
    swept, ratio = math.pi / 4 * 0.0677**2 * 0.055, 13.5
    for k, rpm in enumerate(found["speed_rpm"]):
        full = found["p_in_kpa"][k] * 1e3 * swept / (287.0 * found["t_in_k"][k])
        air = found["volumetric_efficiency"][k] * full * ratio / (1 + ratio) * rpm / 120  # kg/s
        assert found["air_kg_h"][k] == pytest.approx(3600 * air, rel=1e-12)
        assert found["sfc_g_kwh"][k] * found["power_kw"][k] == pytest.approx(3.6e6 * air / ratio, rel=1e-12)
        # all that is trapped burns but for the share that the case states
        burnt = found["trapping_efficiency"][k] * 0.9
        assert found["fractions"]["unburnt"][k] == pytest.approx(1 - burnt, abs=1e-4)


@pytest.mark.slow
def test_files_and_text(tmp_path):
    done = CliRunner().invoke(mechsym, ["cycle", CASE, "--speeds", "1500:3000:1500", "--out", str(tmp_path)])
    assert done.exit_code == 0, done.output
    assert "first law" in done.output
    assert {path.name for path in tmp_path.iterdir()} == {
        "performance.csv", "performance.svg", "cycle.csv", "cycle.svg", "summary.json"
    }  # fmt: skip
    curve = np.genfromtxt(tmp_path / "cycle.csv", delimiter=",", names=True, deletechars="")
    names = {name.split("_[")[0]: name for name in curve.dtype.names}
    phi, p, v = (curve[names[key]] for key in ("phi_deg", "p_pa", "v_m3"))
    assert phi[0] == pytest.approx(-180, abs=0.5)
    assert np.all(np.diff(phi) > 0)
    work = float(np.sum((p + np.roll(p, -1)) / 2 * (np.roll(v, -1) - v)))
    assert work == pytest.approx(figures(rpm=[1500.0])["torque_avg"][0] * 4 * math.pi, rel=2e-4)


def test_pressure_drives_the_mechanism_with_the_same_work():
    found = gas(cases.load(CASE))
    wanted = figures(rpm=[3059.0])
    assert found.pressure.period == pytest.approx(4 * math.pi)
    assert found.pressure.mean_indicated / 1e3 == pytest.approx(wanted["mep_kpa"][0], rel=1e-5)
    assert found.pressure.p_max / 1e6 == pytest.approx(wanted["p_max_mpa"][0], rel=1e-6)


@pytest.mark.slow
def test_wide_throats_are_the_ideal_pump():
    wide = {f"breathing.{name}": f"{size} mm" for name, size in (
        ("inlet_diameter", 36), ("inlet_lift", 9), ("exhaust_diameter", 36), ("exhaust_lift", 9),
        ("throttle_diameter", 30), ("tailpipe_diameter", 30))}  # fmt: skip
    tight, loose = figures(), figures(wide)
    assert abs(loose["pumping_mep_kpa"][0]) < 0.2 * abs(tight["pumping_mep_kpa"][0])
    assert loose["volumetric_efficiency"][0] > 0.95


def test_throttle_costs_pumping_work_and_height_costs_power():
    full = figures()
    part = figures({"breathing.throttle_diameter": "8 mm"})
    assert part["power_kw"][0] < 0.7 * full["power_kw"][0]
    assert part["pumping_mep_kpa"][0] / part["mep_kpa"][0] < 1.3 * full["pumping_mep_kpa"][0] / full["mep_kpa"][0]
    assert part["efficiency"][0] < full["efficiency"][0]
    high = figures({"breathing.altitude": "3000 m"})
    # density at 3000 m in the standard atmosphere is 0.742 of that at the sea
    assert high["power_kw"][0] / full["power_kw"][0] == pytest.approx(0.742, abs=0.03)


BOOST = "\n[boost]\nintercooler = 0.7\n"


def boosted(tmp_path, **overrides):
    file = tmp_path / "boosted.toml"
    file.write_text(cases.text(CASE) + BOOST)
    case = cases.load(str(file), {key.replace("__", "."): value for key, value in overrides.items()})
    return cycle(case, np.array([3000.0]) * math.pi / 30)


@pytest.mark.slow
def test_turbocharger_brings_the_height_back_and_dams_up_the_exhaust(tmp_path):
    sea, high = figures(), boosted(tmp_path, breathing__altitude="3000 m")
    assert high["p_in_kpa"][0] == pytest.approx(101.325)
    assert high["p_out_kpa"][0] > 70.1  # the atmosphere at 3000 m
    assert high["power_kw"][0] == pytest.approx(sea["power_kw"][0], rel=0.08)
    more = boosted(tmp_path, boost__pressure="1.6 bar")
    assert more["power_kw"][0] > 1.3 * sea["power_kw"][0]
    assert more["p_max_mpa"][0] > 1.3 * sea["p_max_mpa"][0]
    assert more["energy_residual"][0] < 1e-9


@pytest.mark.parametrize(
    ("options", "words"),
    [
        pytest.param(
            ["--set", "breathing.plenum_volume=1e-9"], "widen the plenum", marks=[pytest.mark.slow, pytest.mark.heavy]
        ),
        (["--set", "breathing.exhaust_opens=30 deg"], "combustion ends"),
        (["--set", "breathing.altitude=20000 m"], "altitude = 20000 m"),
        (["--over", "cycle.gamma=1.3:1.4:0.05"], "--over needs"),
        (["--loop", "10"], "spark-ignition"),
    ],
)
def test_refusals_are_one_line_that_names_the_way_out(options, words):
    done = CliRunner().invoke(mechsym, ["cycle", CASE, *options])
    assert isinstance(done.exception, BadInput)  # which ends the command with 2
    assert words in str(done.exception)


def test_what_no_engine_does_is_doubted():
    # nearly shut: little comes in, and what comes in meets what has stayed
    codes = {doubt["code"] for doubt in shown("--set", "breathing.throttle_diameter=0.8 mm")["doubts"]}
    assert {"filling", "residual_gas"} <= codes


@pytest.mark.slow
def test_a_turbine_too_hot_is_doubted(tmp_path):
    found = shown("--set", "boost.pressure=1.6 bar", "--set", "cycle.ignition=0 deg")
    assert found["t_turbine_k"][0] > 1323
    assert "turbine_temperature" in {doubt["code"] for doubt in found["doubts"]}


@pytest.mark.slow
def test_compressor_map_of_a_case(tmp_path):
    points = """map_flow = [0.002, 0.02, 0.002, 0.02]
map_ratio = [1.0, 1.0, 2.5, 2.5]
map_efficiency = [0.6, 0.7, 0.6, 0.7]
"""
    file = tmp_path / "mapped.toml"
    file.write_text(cases.text(CASE) + BOOST + points)
    found = cycle(cases.load(str(file), {"boost.pressure": "1.6 bar"}), np.array([2000.0, 3500.0]) * math.pi / 30)
    air = found["air_kg_h"] / 3600
    assert found["compressor_efficiency"] == pytest.approx(0.6 + 0.1 * (air - 0.002) / 0.018, rel=1e-6)
    assert found["energy_residual"].max() < 1e-9
