"""Sweeps: axes as written, grids and samples, gaps with reasons, the data set and its files, and the command."""

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli.sweep import sweep as command
from mechsym.errors import BadInput
from mechsym.runs import problem_of
from mechsym.simulate import Settings, simulate
from mechsym.sweep import Plan, sweep
from mechsym.sweep_axes import Axis, override, parse_axis, points
from mechsym.sweep_data import columns, dataset, failures, flat, write

SHORT = {"simulation.t_end": "3", "simulation.window": "1"}


@pytest.mark.parametrize(
    "text, kind, unit, values",
    [
        ("spring.p0=3..8 MPa:6", "grid", "MPa", (3, 4, 5, 6, 7, 8)),
        ("spring.p0=3..8MPa:2", "grid", "MPa", (3, 8)),
        ("c1=-1e-1..0.1:3", "grid", "", (-0.1, 0, 0.1)),
        ("speed_rpm=89,142", "grid", "", (89, 142)),
        ("p0=3,5,8 MPa", "grid", "MPa", (3, 5, 8)),
        ("simulation.hinge=designed,none", "grid", "", ("designed", "none")),
        ("n=1.2..1.3", "even", "", (1.2, 1.3)),
        ("k1=6500+-200 N*m/rad", "normal", "N*m/rad", (6500, 200)),
    ],
)
def test_axes_as_written(text, kind, unit, values):
    axis = parse_axis(text)
    assert (axis.key, axis.kind, axis.unit) == (text.partition("=")[0], kind, unit)
    assert axis.values == pytest.approx(values) if kind != "grid" or axis.values[0] != "designed" else True
    if axis.values[0] == "designed":
        assert axis.values == values


@pytest.mark.parametrize("text", ["c1", "=1..2:3", "c1=", "p0=3 MPa,5 bar", "c1=1,x", "c1=1..2:0"])
def test_bad_axes_say_how_to_write_them(text):
    with pytest.raises(BadInput, match="--over"):
        parse_axis(text)


def test_values_go_back_with_their_unit():
    axis = parse_axis("p0=0.1..0.3 MPa:3")
    assert [override(axis, v) for v in axis.values] == ["0.1 MPa", "0.2 MPa", "0.3 MPa"]
    assert override(parse_axis("speed_rpm=89,90"), 89.0) == 89.0


def test_grid_runs_the_last_axis_fastest():
    dims, found = points((parse_axis("a=1,2"), parse_axis("b=3..5:3")), None, 0)
    assert dims == {"a": 2, "b": 3}
    assert found == [(1, 3), (1, 4), (1, 5), (2, 3), (2, 4), (2, 5)]


def test_samples_have_the_wanted_distribution():
    axes = (parse_axis("a=2..6"), parse_axis("b=10+-0.5"))
    dims, found = points(axes, 1000, 3)
    a, b = np.array(found).T
    assert dims == {"sample": 1000}
    assert (a.min() > 2, a.max() < 6) == (True, True)
    assert a.mean() == pytest.approx(4, abs=0.01)
    assert (b.mean(), b.std()) == (pytest.approx(10, abs=0.01), pytest.approx(0.5, abs=0.01))
    assert found == points(axes, 1000, 3)[1]
    assert found != points(axes, 1000, 4)[1]
    assert len(points(axes, 1, 0)[1]) == 1


@pytest.mark.parametrize(
    "texts, samples, words",
    [
        (["a=1..2"], None, "say how many"),
        (["a=1..2:5"], 10, "give a range"),
        (["a=1,2", "a=3,4"], None, "each key once"),
        ([], None, "at least one key"),
        (["a=1..2"], 0, "allowed are 1"),
        (["a=0..1:2000", "b=0..1:2000"], None, "4000000 points"),
    ],
)
def test_what_cannot_be_run_over_is_refused(texts, samples, words):
    with pytest.raises(BadInput, match=words):
        points(tuple(parse_axis(t) for t in texts), samples, 0)


def test_simulations_are_those_of_single_runs():
    plan = Plan(case="chmielewski", axes=(parse_axis("c1=0,1"), parse_axis("drive.torque=1.5,3")), overrides=SHORT)
    found = sweep(plan)
    assert (found.analysis, found.dims) == ("simulate", {"c1": 2, "drive.torque": 2})
    data = columns(found)
    for i, (c1, torque) in enumerate(found.points):
        alone = cases.load("chmielewski", {**SHORT, "c1": c1, "drive.torque": torque})
        result = simulate(problem_of(alone), Settings())
        assert data["energy.work.drive"][i] == pytest.approx(result.energy.work["drive"], rel=1e-9)
    assert data["status"].tolist() == ["converged"] * 4
    assert failures(found) == {}


def test_points_that_fail_are_gaps_with_reasons():
    found = sweep(Plan(case="chmielewski", axes=(parse_axis("m0=-1,1.1"),), overrides=SHORT))
    assert list(failures(found)) == [0]
    assert "m0 = -1" in failures(found)[0]
    speed = columns(found)["speed_mean"]
    assert math.isnan(speed[0]) and speed[1] > 0


def test_a_mistake_that_spoils_all_points_is_bad_input():
    with pytest.raises(BadInput, match="no_such_key"):
        sweep(Plan(case="chmielewski", axes=(parse_axis("no_such_key=1,2"),)))
    with pytest.raises(BadInput, match="dimension"):
        sweep(Plan(case="chmielewski", axes=(parse_axis("m0=1..2 m:3"),)))
    with pytest.raises(BadInput, match="options are simulate, hinge, cycle"):
        Plan(case="chmielewski", axes=(), analysis="weigh")


def test_cycles_over_a_design_value():
    axis = parse_axis("cycle.ignition=-20..-5 deg:3")
    found = sweep(Plan(case="nunes-slider-crank", axes=(axis,)))
    assert found.analysis == "cycle"
    pressure = columns(found)["p_max_mpa"]
    # earlier combustion means more pressure
    assert np.all(np.diff(pressure) < 0)


@pytest.mark.slow
def test_hinges_over_the_spring_and_the_speed():
    axes = (parse_axis("spring.p0=5,8 MPa"), parse_axis("speed_rpm=80,89"))
    found = sweep(Plan(case="zotov-89", axes=axes))
    assert found.analysis == "hinge"
    data = columns(found)
    assert np.all(data["check.speed_ripple"] < 1e-6)
    # a stiffer spring needs less stroke for the same work
    assert data["guide.z_max"][2] < data["guide.z_max"][0]


def test_numbers_of_a_nested_result():
    result = {
        "a": 1,
        "b": {"c": 2.5, "d": None},
        "status": "done",
        "reason": "words",
        "e": [3.0],
        "f": [1, 2],
        "g": True,
    }
    found = flat(result)
    assert math.isnan(found.pop("b.d"))
    assert found == {"a": 1.0, "b.c": 2.5, "status": "done", "e": 3.0, "g": 1.0}


def test_data_set_and_files(tmp_path):
    xr = pytest.importorskip("xarray")
    pytest.importorskip("h5netcdf")
    found = sweep(Plan(case="chmielewski", axes=(parse_axis("c1=0,1,2"), parse_axis("m0=1.0,1.1 kg")), overrides=SHORT))
    data = dataset(found)
    assert data["speed_mean"].dims == ("c1", "m0")
    assert data["speed_mean"].shape == (3, 2)
    assert data["m0"].attrs["units"] == "kg"
    assert float(data["speed_mean"].sel(c1=1, m0=1.1)) == columns(found)["speed_mean"][3]
    files = write(found, tmp_path)
    assert [f.name for f in files] == ["sweep.csv", "sweep.nc"]
    lines = files[0].read_text().splitlines()
    assert lines[0].startswith("c1 [SI],m0 [kg],")
    assert len(lines) == 7
    with xr.open_dataset(files[1], engine="h5netcdf") as stored:
        np.testing.assert_array_equal(stored["speed_mean"], data["speed_mean"])


def test_command(tmp_path):
    arguments = ["chmielewski", "--over", "c1=0,1", "--set", "t_end=3", "--set", "simulation.window=1", "--json"]
    done = CliRunner().invoke(command, arguments)
    report = json.loads(done.stdout)
    assert done.exit_code == 0
    assert (report["dims"], report["shape"], report["failed"]) == ({"c1": 2}, [2], [])
    assert len(report["data"]["speed_mean"]) == 2
    text = CliRunner().invoke(command, [*arguments[:-1], "--out", str(tmp_path / "out")])
    assert "simulate of chmielewski over 2 c1: 0 of 2 failed" in text.output
    assert (tmp_path / "out" / "sweep.csv").is_file()


def test_command_with_samples_and_failures():
    options = ["--set", "t_end=2", "--set", "simulation.window=1", "--json"]
    drawn = CliRunner().invoke(command, ["chmielewski", "--samples", "5", "--over", "m0=1.1+-0.05", *options])
    assert json.loads(drawn.stdout)["dims"] == {"sample": 5}
    partly = CliRunner().invoke(command, ["chmielewski", "--over", "m0=-1,1.1", *options])
    assert partly.exit_code == 0
    assert json.loads(partly.stdout)["failed"][0]["index"] == 0
    assert json.loads(partly.stdout)["data"]["speed_mean"][0] is None


def test_axis_is_a_record():
    assert parse_axis("a=1,2") == Axis(key="a", unit="", kind="grid", values=(1.0, 2.0))
