"""Cases of the engine cycle: what is read, what is refused, and the three commands on them."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cases import load
from mechsym.cli.common import parse_speeds
from mechsym.cli.compare import compare
from mechsym.cli.cycle import cycle
from mechsym.cycle.closed.model import at_design, design_names
from mechsym.cycle.columns import crossovers
from mechsym.cycle.engine import curves, over_speeds
from mechsym.cycle.motion import piston_motion
from mechsym.errors import BadInput
from mechsym.jobs.cycle import engine, speed_range
from mechsym.quantities import RPM

KEYS = {"speed_rpm", "torque_avg", "torque_max", "power_kw", "mep_kpa", "sfc_g_kwh", "efficiency", "p_max_mpa",
        "fractions", "energy_residual"}  # fmt: skip


def run_json(command, *arguments):
    result = CliRunner().invoke(command, [*arguments, "--json"], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return json.loads(result.output)


@pytest.mark.parametrize("case", ["nunes-slider-crank", "nunes-hypocycloid"])
@pytest.mark.parametrize("method", ["converged", "nunes2017_printed"])
def test_cycle_command(case, method):
    found = run_json(cycle, case, "--speeds", "1000:3000:500", "--set", f"cycle.method={method}")
    assert found.keys() >= KEYS and found["speed_rpm"] == pytest.approx([1000, 1500, 2000, 2500, 3000])
    assert all(len(found[key]) == 5 for key in KEYS - {"fractions"})
    assert found["fractions"].keys() == {"heat", "work", "exhaust", "unburnt"}
    shares = np.sum([found["fractions"][k] for k in found["fractions"]], axis=0)
    assert shares == pytest.approx(np.ones(5), abs=1e-10)


def test_cycle_command_writes_its_files(tmp_path):
    result = CliRunner().invoke(cycle, ["nunes-hypocycloid", "--speeds", "1000,2000", "--out", str(tmp_path)])
    assert result.exit_code == 0 and "first law closed" in result.output
    files = {"performance.csv", "cycle.csv", "cycle.svg", "performance.svg", "summary.json"}
    assert {p.name for p in tmp_path.iterdir()} == files
    assert "tooth_force" in (tmp_path / "performance.csv").read_text().splitlines()[0]


def test_two_files_of_one_name_are_two_engines(tmp_path):
    """They were one by their name, held against itself without a word."""
    paths = [tmp_path / folder / "mine.toml" for folder in "ab"]
    for path, name in zip(paths, ("nunes-slider-crank", "nunes-hypocycloid"), strict=True):
        path.parent.mkdir()
        path.write_text(cases.text(name), encoding="utf-8")
    mine = run_json(compare, *map(str, paths), "--speeds", "2000,5000")
    theirs = run_json(compare, "nunes-slider-crank", "nunes-hypocycloid", "--speeds", "2000,5000")
    assert mine["cases"] == ["a/mine", "b/mine"]
    assert mine["table"] == theirs["table"]
    assert any(row["difference"] for row in mine["table"])


def test_compare_command(tmp_path):
    arguments = ("nunes-slider-crank", "nunes-hypocycloid", "--speeds", "6000:7000:100", "--out", str(tmp_path))
    found = run_json(compare, *arguments)
    assert found["crossover_rpm"] == pytest.approx([6475], abs=2)
    assert {"quantity", "a", "b", "difference"} <= found["table"][0].keys()
    assert (tmp_path / "comparison.svg").exists() and (tmp_path / "comparison.csv").exists()


def test_crossovers_of_lines():
    x = np.array([0.0, 1.0, 2.0, 3.0])
    assert crossovers(x, x, 1.5 + 0 * x) == pytest.approx([1.5])
    assert crossovers(x, x, 2.0 + 0 * x) == pytest.approx([2.0])
    assert crossovers(x, x, x - 1).size == 0


def test_speeds_are_read():
    assert np.array(parse_speeds("500:8000:1500")) / RPM == pytest.approx(np.arange(500, 8001, 1500))
    assert len(parse_speeds("10:8000:10")) == 800
    for text in ("500:100:10", "1:2", "a:b:c", "-5", "1:1e9:1", "10:20:0"):
        with pytest.raises(BadInput, match="--speeds"):
            parse_speeds(text)


@pytest.mark.parametrize(
    "key, value, reason",
    [
        ("chamber.compression_ratio", "1", "compression_ratio = 1 is out of range; it must be > 1"),
        ("chamber.compression_ratio", "0.5", "must be > 1"),
        ("chamber.bore", "-60 mm", "bore = -0.06 m is out of range"),
        ("chamber.pistons", "3", "options are 1"),
        ("cycle.intake_pressure", "-1 bar", "intake_pressure = -100000 Pa is out of range"),
        ("cycle.intake_temperature", "-5 K", "intake_temperature"),
        ("cycle.air_fuel_ratio", "16", "leaner than stoichiometric.*vaporisation"),
        ("cycle.air_fuel_ratio", "25", "holds from 0.75 to 1.2"),
        ("cycle.vaporisation", "maybe", "options are latent_heat, liquid_energy, none"),
        ("gas.gamma", "1", "must be > 1"),
        ("heat_transfer.wall_temperature", "0 K", "must be > 0"),
        ("cycle.duration", "0 deg", "must be > 0"),
    ],
)
def test_impossible_engines_are_refused_with_the_reason(key, value, reason):
    with pytest.raises(BadInput, match=reason):
        load("nunes-slider-crank", {key: value})


def test_ignition_after_the_exhaust_opens_is_refused_by_the_command():
    arguments = ["nunes-slider-crank", "--set", "cycle.ignition_slope=0.1 deg/rpm", "--speeds", "2000"]
    with pytest.raises(BadInput, match="ignition is after the exhaust opens: 19.*deg against 180.00 deg"):
        CliRunner().invoke(cycle, arguments, catch_exceptions=False)


def test_lean_mixture_is_taken_without_vaporisation():
    lean = load("nunes-slider-crank", {"cycle.air_fuel_ratio": "16", "cycle.vaporisation": "none"})
    assert lean.need("cycle").air_fuel_ratio == 16


def test_a_case_without_a_spark_ignition_cycle_is_refused():
    with pytest.raises(BadInput, match="spark-ignition"):
        engine(load("zotov-89"))


def test_a_mechanism_without_a_piston_is_refused():
    with pytest.raises(BadInput, match="no piston"):
        piston_motion("crankshaft_flywheel", {})


def test_designs_know_the_engine_s_names():
    machine = engine(load("nunes-hypocycloid"))
    names = design_names(machine)
    assert {"omega", "parameters.e", "chamber.bore", "cycle.ignition", "heat_transfer.a"} <= set(names)
    assert at_design(machine, {"parameters.e": 0.02}).motion.parameters["e"] == 0.02
    for name in ("cycle.colour", "chamber", "motion.name", "parameters.r"):
        with pytest.raises(BadInput, match="not a number of the engine"):
            at_design(machine, {name: 1.0})


def test_curves_of_both_methods_agree():
    converged, printed = (
        curves(engine(load("nunes-slider-crank", {"cycle.method": method})), 3000 * RPM, np.radians(1.0))
        for method in ("converged", "nunes2017_printed")
    )
    assert converged["phi_deg"] == pytest.approx(printed["phi_deg"])
    assert converged["p_pa"] == pytest.approx(printed["p_pa"], rel=0.02)


def test_speed_range_of_a_case():
    speeds = speed_range(load("nunes-slider-crank").need("speeds"))
    assert speeds.size == 800 and speeds[[0, -1]] / RPM == pytest.approx([10, 8000])
    with pytest.raises(BadInput, match="below lowest"):
        load("nunes-slider-crank", {"speeds.highest": "5 rpm"})


def test_a_map_over_another_value_than_the_speed():
    found = run_json(cycle, "nunes-slider-crank", "--over", "cycle.ignition=-30 deg:0 deg:10 deg", "--speeds", "4000")
    assert found["cycle.ignition"] == pytest.approx(np.radians([-30, -20, -10, 0]))
    assert np.argmax(found["efficiency"]) == 2 and np.all(np.diff(found["p_max_mpa"]) < 0)
    bare = run_json(cycle, "nunes-slider-crank", "--over", "ignition=-30 deg:0 deg:10 deg", "--speeds", "4000")
    assert bare == found


def test_text_names_units_gaps_and_what_is_left_out():
    def text(*arguments):
        return CliRunner().invoke(cycle, arguments, catch_exceptions=False).output

    assert "cycle.ignition [deg]" in text("nunes-slider-crank", "--over", "ignition=-0.3:-0.1:0.1")
    assert "20 of 800 points shown" in text("nunes-slider-crank", "--speeds", "10:8000:10")
    assert "nan" not in text("zotov-89")  # an algebraic cycle knows no fuel


@pytest.mark.parametrize(
    "arguments, reason",
    [
        (["--over", "chamber.compression_ratio=1:3:1"], "compression_ratio = 1 is out of range; it must be > 1"),
        (["--over", "chamber.colour=1:3:1"], "chamber.colour' is not known"),
        (["--over", "chamber.bore=1:3"], "takes numbers"),
        (["--over", "chamber.bore=1 s:3 s:1 s"], "wrong dimension"),
        (["--over", "gas.gamma=1.3:1.4:0.1", "--speeds", "1000:2000:1000"], "runs at one speed"),
        (["--over", "gas.gamma=1.3:1.4:0.1", "--set", "cycle.method=nunes2017_printed"], "speed alone"),
    ],
)
def test_bad_maps_are_refused(arguments, reason):
    with pytest.raises(BadInput, match=reason):
        CliRunner().invoke(cycle, ["nunes-slider-crank", *arguments], catch_exceptions=False)


def test_large_maps_are_made_in_blocks():
    machine, done = engine(load("nunes-hypocycloid", {"cycle.method": "nunes2017_printed"})), []
    omega = np.linspace(1000, 8000, 2300) * RPM
    found = over_speeds(machine, omega, done.append)
    assert done == [1000, 1000, 300] and found.loads["tooth_force"].shape == omega.shape
    assert found.torque_avg[1500] == pytest.approx(over_speeds(machine, omega[1500:1501]).torque_avg[0], rel=1e-14)


@pytest.mark.slow
def test_friction_of_the_mechanism_makes_brake_figures():
    case = {"friction_pressure.law": "mechanism"}
    rod, planet = (engine(load(f"nunes-{name}", case)) for name in ("slider-crank", "hypocycloid"))
    found = [over_speeds(machine, np.array([2000.0, 8000.0]) * RPM) for machine in (rod, planet)]
    for one in found:
        assert np.all((0.5e4 < one.friction_mep) & (one.friction_mep < 3e5))
        assert one.brake_torque == pytest.approx(one.torque_avg - one.friction_mep * 2.94053e-4 / (4 * np.pi), rel=1e-5)
    assert np.all(found[0].brake_efficiency < found[0].efficiency)


@pytest.mark.parametrize("choice", ["heat_transfer.law=woschni", "heat_transfer.law=hohenberg", "gas.model=nasa",
                                    "friction_pressure.law=chen_flynn"])  # fmt: skip
def test_another_law_is_one_setting_away(choice):
    plain, other = (run_json(cycle, "nunes-slider-crank", *more) for more in ([], ["--set", choice]))
    figure = "brake_efficiency"
    assert other[figure][0] != pytest.approx(plain[figure][0], rel=1e-3)
    assert abs(other["energy_residual"][0]) < 1e-10


def test_a_setting_of_the_old_law_is_refused_with_the_new_one():
    with pytest.raises(BadInput, match="heat_transfer.a is not known"):
        load("nunes-slider-crank", {"heat_transfer.law": "woschni", "heat_transfer.a": "0.3"})
