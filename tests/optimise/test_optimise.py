"""Derivatives of the cycle, and designs found with them."""

import dataclasses
import json

import casadi as ca
import numpy as np
import pytest
from click.testing import CliRunner
from pictures import drawn, faults

from mechsym.cases import load, text
from mechsym.cli.optimise import optimise
from mechsym.cycle.closed.performance import SCALAR_UNITS, design_function, performance
from mechsym.cycle.plots import pareto_picture
from mechsym.errors import BadInput
from mechsym.jobs.cycle import engine
from mechsym.optimise.solver import Optimise, pareto, problem, solve
from mechsym.quantities import RPM

NAMES = ["omega", "cycle.ignition", "chamber.compression_ratio", "parameters.e", "chamber.bore"]
UNITS = {"efficiency": "-", "p_max": "Pa", "cycle.ignition": "rad"}
POINT = np.array([4000 * RPM, np.radians(-9.07), 10.0, 0.013, 0.06])


@pytest.fixture(scope="module")
def machine():
    return engine(load("nunes-hypocycloid"))


def task(machine, variables, constraints=None, **more):
    return problem(machine, 4000 * RPM, Optimise(variables=variables, constraints=constraints or {}, **more))


IGNITION = {"cycle.ignition": {"low": "-40 deg", "high": "5 deg"}}
RATIO = {"chamber.compression_ratio": {"low": 8, "high": 14}}


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("figure", ["efficiency", "power"])
def test_derivatives_are_finite_differences(machine, name, figure):
    z = ca.MX.sym("z", len(NAMES))
    value = design_function(machine, NAMES).call({"design": z})[figure]
    gradient = ca.Function("gradient", [z], [ca.gradient(value, z)])
    function = ca.Function("value", [z], [value])
    k = NAMES.index(name)
    h = 1e-3 * POINT[k]

    def at(steps):
        return float(function(POINT + h * steps * np.eye(len(NAMES))[k]))

    fourth_order = (8 * (at(1) - at(-1)) - (at(2) - at(-2))) / (12 * h)
    assert float(gradient(POINT)[k]) == pytest.approx(fourth_order, rel=1e-6)


def test_figures_are_those_of_the_performance_map(machine):
    found = design_function(machine, ["omega"]).call({"design": 4000 * RPM})
    expected = performance(machine, {"omega": np.array([4000 * RPM])})
    for name in ("efficiency", "power", "torque_avg", "mep", "brake_efficiency", "sfc"):
        assert float(found[name]) == pytest.approx(getattr(expected, name)[0], rel=1e-12)
    for name in ("p_max", "force_max", "torque_max"):
        assert float(ca.mmax(found[name])) == pytest.approx(getattr(expected, name)[0], rel=2e-3)
    assert set(SCALAR_UNITS) < set(found)


def test_best_spark_timing_is_that_of_a_fine_grid(machine):
    found = solve(task(machine, IGNITION))
    grid = np.radians(np.linspace(-40, 5, 451))
    efficiency = performance(machine, {"omega": 4000 * RPM, "cycle.ignition": grid}).efficiency
    assert found.status == "optimal" and not found.active
    assert found.variables["cycle.ignition"] == pytest.approx(grid[np.argmax(efficiency)], abs=np.radians(0.06))
    assert found.objective >= efficiency.max()


@pytest.mark.slow
def test_active_limits_and_their_multipliers(machine):
    limits = {"p_max": {"high": "8 MPa"}}
    found = solve(task(machine, IGNITION | RATIO, limits))
    assert found.status == "optimal"
    assert {row.name for row in found.active} == {"p_max", "chamber.compression_ratio"}
    assert found.figures["p_max"] == pytest.approx(8e6, rel=1e-7)
    step = 5e4
    ends = [solve(task(machine, IGNITION | RATIO, {"p_max": {"high": 8e6 + s}})).objective for s in (-step, step)]
    assert found.multipliers["p_max"] == pytest.approx((ends[1] - ends[0]) / (2 * step), rel=1e-3)
    wider = [
        solve(task(machine, IGNITION | {"chamber.compression_ratio": {"low": 8, "high": 14 + s}}, limits)).objective
        for s in (-0.05, 0.05)
    ]
    assert found.multipliers["chamber.compression_ratio"] == pytest.approx((wider[1] - wider[0]) / 0.1, rel=1e-3)
    assert "would change efficiency by +" in found.active[0].meaning


def test_a_limit_that_is_met_with_room_costs_nothing(machine):
    found = solve(task(machine, IGNITION, {"p_max": {"high": "20 MPa"}}))
    assert found.multipliers["p_max"] == 0.0 and not found.active


def test_a_peak_as_objective(machine):
    ratio = {"chamber.compression_ratio": {"low": 8, "high": 14}}
    found = solve(task(machine, IGNITION | ratio, {"efficiency": {"low": 0.43}}, objective="p_max", goal="minimise"))
    assert found.status == "optimal" and found.figures["efficiency"] == pytest.approx(0.43, rel=1e-7)
    row = next(row for row in found.active if row.name == "efficiency")
    looser = solve(task(machine, IGNITION | ratio, {"efficiency": {"low": 0.431}}, objective="p_max", goal="minimise"))
    assert row.multiplier == pytest.approx((looser.objective - found.objective) / 0.001, rel=0.05)


@pytest.mark.slow
def test_pareto_front_trades_one_figure_for_the_other(machine):
    front = pareto(task(machine, IGNITION | RATIO, {"p_max": {"high": "8 MPa"}}), "p_max", "minimise", 5)
    assert [p.status for p in front] == ["optimal"] * 5
    assert np.all(np.diff([p.figures["p_max"] for p in front]) < 0)
    assert np.all(np.diff([p.objective for p in front]) < 0)


def test_what_cannot_be_met_is_a_result(machine):
    found = solve(task(machine, IGNITION, {"p_max": {"high": "1 bar"}}))
    assert found.status != "optimal" and found.reason


@pytest.mark.parametrize(
    "section, reason",
    [
        ({"variables": {}}, "variables is empty"),
        ({"variables": {"cycle.spark": {"low": 0, "high": 1}}}, "cycle.spark is not known; names are omega"),
        ({"variables": {"cycle.ignition": {"low": 0}}}, "leaves no room"),
        ({"variables": {"cycle.ignition": {"low": 1, "high": 0}}}, "leaves no room"),
        ({"variables": {"cycle.ignition": {"low": "1 m", "high": "2 m"}}}, "wrong dimension"),
        ({"variables": IGNITION, "objective": "beauty"}, "beauty.*is not a figure"),
        ({"variables": IGNITION, "constraints": {"p_max": {"low": 1e6}}}, "can only be bounded from above"),
        ({"variables": IGNITION, "constraints": {"p_max": 5}}, "is no limit"),
        ({"variables": IGNITION, "goal": "ignore"}, "options are maximise, minimise"),
    ],
)
def test_bad_problems_are_refused(machine, section, reason):
    with pytest.raises(BadInput, match=reason):
        problem(machine, 4000 * RPM, Optimise(**section))


def test_a_front_is_drawn_in_units_for_people_without_texts_on_each_other(tmp_path, monkeypatch):
    found = drawn(monkeypatch)
    columns = {"efficiency": [0.40, 0.44, 0.47], "p_max": [4.85e6, 5.9e6, 8e6], "cycle.ignition": [0.0, 0.0, -0.078]}
    pareto_picture(tmp_path / "f.svg", columns, "efficiency", "p_max", UNITS)
    assert "p_max [MPa]" in (tmp_path / "f.svg").read_text(encoding="utf-8")
    assert [axis.get_ylabel() for axis in found[0].axes] == ["efficiency [-]", "cycle.ignition [deg]"]
    assert not faults(found[0])


@pytest.mark.slow
def test_command(tmp_path):
    arguments = ["nunes-hypocycloid", "--set", "optimise.against=p_max", "--set", "optimise.points=3"]
    result = CliRunner().invoke(optimise, [*arguments, "--json", "--out", str(tmp_path)], catch_exceptions=False)
    found = json.loads(result.stdout)
    assert result.exit_code == 0 and found["status"] == "optimal" and len(found["pareto"]) == 3
    assert found.keys() >= {"variables", "objective", "active", "multipliers", "status"}
    assert {p.name for p in tmp_path.iterdir()} == {"optimum.json", "pareto.csv", "pareto.svg", "summary.json"}
    head = (tmp_path / "pareto.csv").read_text(encoding="utf-8").splitlines()[0]
    assert "p_max [Pa]" in head and "cycle.ignition [rad]" in head


@pytest.mark.slow
def test_command_ends_with_1_where_nothing_is_feasible(tmp_path):
    case = tmp_path / "impossible.toml"
    case.write_text(text("nunes-hypocycloid").replace('"8 MPa"', '"1 bar"'))
    result = CliRunner().invoke(optimise, [str(case), "--json"])
    assert result.exit_code == 1 and json.loads(result.stdout)["status"] != "optimal"
    with pytest.raises(BadInput, match="is no table"):
        load("nunes-hypocycloid", {"optimise.constraints": "p_max < 1"})


def test_speed_may_be_a_variable(machine):
    found = solve(task(machine, {"omega": {"low": "2000 rpm", "high": "8000 rpm"}}, objective="power"))
    assert found.variables["omega"] == pytest.approx(8000 * RPM)
    assert dataclasses.asdict(found)["active"][0]["name"] == "omega"
