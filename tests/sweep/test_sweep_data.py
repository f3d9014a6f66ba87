"""What a sweep leaves: the labelled data set, CSV, netCDF, the picture, and the command with its exit statuses."""

import contextlib
import csv
import json
import signal
import sqlite3
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner
from pictures import faults

from mechsym import interrupts
from mechsym.cli import main
from mechsym.cli.sweep import sweep as command
from mechsym.cycle.columns import WORDS
from mechsym.errors import MissingExtra
from mechsym.quantities.display import choose, key_words, without_unit
from mechsym.style import svg
from mechsym.sweep import Plan, columns, dataset, failures, main_results, sweep, write_netcdf, write_table
from mechsym.sweep import plots as plots_sweep
from mechsym.sweep.outcomes import flat

SHORT = {"simulation.t_end": "3", "simulation.window": "1"}
SET = [word for key, value in SHORT.items() for word in ("--set", f"{key}={value}")]
CYCLES = Plan(case="nunes-slider-crank", over=("speed_rpm=2000,4000,8000", "cycle.ignition=-200,-20,-10 deg"))


@pytest.fixture(scope="module")
def found():
    """Three dampers and two masses, one of which is impossible."""
    return sweep(Plan(case="chmielewski", over=("c1=0,1,2", "m0=-1,1.1 kg"), overrides=SHORT))


def run(*arguments):
    return CliRunner().invoke(command, list(arguments))


def test_numbers_of_a_nested_result():
    result = {
        "a": 1,
        "b": {"c": 2.5, "d": None},
        "status": "done",
        "reason": "words",
        "guide": {"reason": "kept"},
        "e": [3.0],
        "f": [1, 2],
        "g": True,
        "wall_s": 0.1,
    }
    numbers = flat(result)
    assert np.isnan(numbers.pop("b.d"))
    assert numbers == {"a": 1.0, "b.c": 2.5, "status": "done", "guide.reason": "kept", "e": 3.0, "g": 1.0}


def test_an_event_is_told_by_its_parts():
    stopped = sweep(
        Plan(case="zotov-89", over=("simulation.hinge=designed,none",), overrides={"simulation.turns": "2"},
             analysis="simulate")
    )  # fmt: skip
    data = columns(stopped)
    assert "event" not in data
    assert np.isnan(data["event.t"][0]) and 0 < data["event.t"][1] < 2


def test_every_number_has_its_unit():
    over = ("simulation.hinge=designed,none",)
    plans = [
        CYCLES,
        Plan(case="chmielewski", over=("c1=1",), overrides=SHORT),
        Plan(case="nunes-hypocycloid", over=("speed_rpm=4000",)),
        Plan(case="zotov-89", over=("spring.p0=5 MPa",)),
        Plan(case="zotov-89", over=over, overrides={"simulation.turns": "2"}, analysis="simulate"),
    ]
    for plan in plans:
        swept = sweep(plan)
        data = columns(swept)
        unknown = {name for name, values in data.items() if values.dtype.kind == "f" and not swept.units.get(name)}
        assert unknown <= {axis.key for axis in swept.axes}


def test_data_set(found):
    pytest.importorskip("xarray")
    data = dataset(found)
    assert data["speed_mean"].dims == ("c1", "m0")
    assert data["speed_mean"].shape == (3, 2)
    assert (data["m0"].attrs["units"], data["c1"].attrs["units"]) == ("kg", "N*m*s/rad")
    assert (data["speed_mean"].attrs["units"], data["steps"].attrs["units"]) == ("rad/s", "1")
    assert float(data["speed_mean"].sel(c1=1, m0=1.1)) == columns(found)["speed_mean"][3]
    assert np.isnan(data["speed_mean"].sel(m0=-1)).all()
    assert "m0 = -1 kg" in str(data["failure"].sel(c1=0, m0=-1).values)
    assert data.attrs == {"case": "chmielewski", "analysis": "simulate", "failed": 3, "interrupted": 0}


def test_a_result_with_the_name_of_an_axis(found):
    pytest.importorskip("xarray")
    cycles = dataset(sweep(CYCLES))
    assert "result.speed_rpm" not in cycles and cycles["speed_rpm"].values.tolist() == [2000, 4000, 8000]
    over = ("t_end=1.5,30 s",)
    plan = Plan(case="zotov-89", over=("simulation.turns=1,2",), analysis="simulate")
    assert "result.turns" not in dataset(sweep(plan))
    ends = dataset(sweep(Plan(case="chmielewski", over=over, overrides={"simulation.window": "1"})))
    assert "result.t_end" not in ends and ends["t_end"].attrs["units"] == "s"


def test_netcdf_holds_the_data_set(found, tmp_path):
    xr, _ = pytest.importorskip("xarray"), pytest.importorskip("h5netcdf")
    file = write_netcdf(found, tmp_path)
    assert [f.name for f in tmp_path.iterdir()] == ["sweep.nc"]
    with xr.open_dataset(file, engine="h5netcdf") as stored:
        xr.testing.assert_identical(stored.load(), dataset(found))


def test_netcdf_is_whole_or_not_there(found, tmp_path, monkeypatch):
    pytest.importorskip("xarray"), pytest.importorskip("h5netcdf")
    file = write_netcdf(found, tmp_path)
    before = file.read_bytes()

    def full(*place):
        raise OSError(28, "disk full")

    monkeypatch.setattr("os.posix_fallocate", full)
    with pytest.raises(OSError, match="disk full"):
        write_netcdf(found, tmp_path)
    assert file.read_bytes() == before
    assert [f.name for f in tmp_path.iterdir()] == ["sweep.nc"]


def test_csv_has_a_line_for_each_point(found, tmp_path):
    with write_table(found, tmp_path).open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert [(r["c1 [N*m*s/rad]"], r["m0 [kg]"]) for r in rows] == [(c, m) for c in "012" for m in ("-1", "1.1")]
    assert [r["speed_mean [rad/s]"] == "" for r in rows] == [True, False] * 3
    assert all((r["speed_mean [rad/s]"] == "") == ("m0 = -1" in r["failure"]) for r in rows)
    assert float(rows[1]["speed_mean [rad/s]"]) == pytest.approx(columns(found)["speed_mean"][1], rel=1e-11)


SPEEDS, ANGLES = "speed_rpm=2000..8000:5", "cycle.ignition={}..-5 deg:6"
PICTURES = {
    "lines": Plan(case="chmielewski", over=("c1=0..2:5",), overrides=SHORT),
    "lines with gaps": Plan(case="chmielewski", over=("m0=-1,1,1.1,1.2,1.3", "c1=0,1"), overrides=SHORT),
    "words": Plan(case="chmielewski", over=("simulation.backend=native,scipy-dop853,scipy-rk45",), overrides=SHORT),
    "maps with gaps": Plan(case="nunes-slider-crank", over=(SPEEDS, ANGLES.format(-200))),
    "maps": Plan(case="nunes-slider-crank", over=(SPEEDS, ANGLES.format(-20), "bore=0.08,0.09")),
    "samples": Plan(case="chmielewski", over=("k1=6500+-200", "m0=1..1.2"), samples=20, overrides=SHORT),
    "words and numbers": Plan(
        case="chmielewski", over=("simulation.backend=native,scipy-dop853,scipy-rk45", "c1=0,1"), overrides=SHORT
    ),
    "one shown": Plan(case="chmielewski", over=("c1=0..2:3",), overrides=SHORT, show=("steps",)),
}


def words(name, unit):
    return key_words(name if name in WORDS else without_unit(name, unit), WORDS)


@pytest.mark.parametrize("plan", PICTURES.values(), ids=PICTURES)
def test_pictures(plan):
    result = sweep(plan)
    figure = plots_sweep.picture(result)
    drawn = [axis for axis in figure.axes if axis.get_visible() and axis.has_data()]
    labels = " ".join(axis.get_ylabel() + axis.get_title() + axis.get_xlabel() for axis in drawn)
    shown = [name for name in main_results(result) if words(name, result.units[name]) in labels]
    assert shown == list(plan.show) or len(shown) >= 2
    assert len(svg(figure)) > 5000
    assert ("failed" in figure.get_suptitle()) == bool(failures(result))
    assert faults(figure) == []


def test_axes_of_a_sweep_are_in_the_units_that_were_chosen():
    plan = Plan(case="nunes-slider-crank", over=("speed_rpm=2000,3000,4000",), show=("torque_avg", "p_max_mpa"))
    result = sweep(plan)
    try:
        choose("rad/s, kN*m, bar")
        torque, pressure = (axis for axis in plots_sweep.picture(result).axes if axis.get_visible())
    finally:
        choose(None)
    assert [a.get_ylabel() for a in (torque, pressure)] == ["indicated torque [kN m]", "largest pressure [bar]"]
    assert torque.get_xlabel() == "speed [rad/s]"
    assert torque.lines[0].get_xdata() == pytest.approx(np.array([2000, 3000, 4000]) * np.pi / 30)
    assert torque.lines[0].get_ydata() == pytest.approx(columns(result)["torque_avg"] / 1e3)
    assert pressure.lines[0].get_ydata() == pytest.approx(10 * columns(result)["p_max_mpa"])


def test_a_map_may_be_empty_where_it_is_cut():
    plan = Plan(
        case="nunes-slider-crank", over=(SPEEDS, ANGLES.format(-20), "inlet_closes=-170,-2 deg"), show=("mep_kpa",)
    )
    result = sweep(plan)
    assert len(failures(result)) == 30
    svg(plots_sweep.picture(result))


def test_words_are_colours():
    figure = plots_sweep.picture(sweep(PICTURES["words and numbers"]))
    assert figure.axes[0].get_xlabel() == "c1 [N m s/rad]"
    assert [t.get_text() for t in figure.legends[0].get_texts()][0] == "integrator = native"


def test_pictures_of_nothing():
    assert plots_sweep.picture(sweep(Plan(case="chmielewski", over=("c1=1",), overrides=SHORT))) is None
    assert plots_sweep.picture(sweep(Plan(case="chmielewski", over=("c1=-1,-2,-3",), overrides=SHORT))) is None
    assert plots_sweep.picture(sweep(Plan(case="chmielewski", over=("c1=0,1",), overrides=SHORT))) is None


def test_command(tmp_path):
    arguments = ["chmielewski", "--over", "c1=0,0.5,1", *SET]
    done = run(*arguments, "--json")
    report = json.loads(done.stdout)
    assert (done.exit_code, done.stderr) == (0, "")
    assert (report["dims"], report["shape"], report["failed"]) == ({"c1": 3}, [3], [])
    assert report["axes"] == {"c1": {"unit": "N*m*s/rad", "values": [0.0, 0.5, 1.0]}}
    assert report["units"]["speed_mean"] == "rad/s"
    assert len(report["data"]["speed_mean"]) == 3
    text = run(*arguments, "--out", str(tmp_path / "out"))
    assert "simulate of chmielewski over 3 c1: 0 of 3 failed" in text.output
    written = {line.removeprefix("written: ") for line in text.output.splitlines() if line.startswith("written: ")}
    assert written == {str(f) for f in (tmp_path / "out").iterdir() if f.name != "summary.json"}
    assert {"sweep.csv", "sweep.svg"} <= {Path(f).name for f in written}
    assert text.output.count("mean speed") == 1
    assert "steps" in run(*arguments, "--show", "steps").output


def test_command_tells_where_the_extremes_are():
    lines = run("nunes-slider-crank", "--over", "speed_rpm=2000,8000", "--over", "ignition=-20 deg").output.splitlines()
    (power,) = [line.split() for line in lines if line.startswith("indicated power")]
    assert power[2] == "kW" and power[4] == "speed_rpm=2000," and power[8] == "speed_rpm=8000,"


def test_command_with_samples_and_failures():
    drawn = run("chmielewski", "--samples", "5", "--over", "m0=1.1+-0.05", *SET)
    assert "over 5 sample: 0 of 5 failed" in drawn.output and " std" in drawn.output
    partly = run("chmielewski", "--over", "m0=-1,1.1", *SET, "--json")
    report = json.loads(partly.stdout)
    assert partly.exit_code == 0
    (failed,) = report["failed"]
    assert (failed["index"], failed["at"]) == (0, {"m0": -1.0}) and "m0 = -1" in failed["reason"]
    assert [report["data"][name][0] for name in ("speed_mean", "status")] == [None, None]


def test_all_points_failed_is_status_1(tmp_path):
    done = run("chmielewski", "--over", "m0=-1..-0.1:7", *SET, "--out", str(tmp_path), "--json")
    report = json.loads(done.stdout)
    assert done.exit_code == 1
    assert len(report["failed"]) == 7 and report["data"] == {}
    assert {Path(f).name for f in report["files"]} >= {"sweep.csv"}
    text = run("chmielewski", "--over", "m0=-1..-0.1:7", *SET)
    assert text.exit_code == 1 and "and 2 more" in text.output


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["--over", "c1=1..2 kg:3"], ["--over parameters.c1", "dimension", "N*m*s/rad"]),
        (["--over", "c2=1,2"], ["--over c2", "not known", "section.key"]),
        (["--over", "c1=1,2", "--set", "parameters.c1=3"], ["--set parameters.c1", "--over c1", "keep one"]),
        (["--over", "c1=1..2:9000000"], ["9000000", "1000000"]),
        (["--over", "c1=1..2", "--samples", "0"], ["--samples", "x>=1"]),
        (["--over", "c1=1..2", "--samples", "many"], ["--samples", "integer"]),
        (["--over", "c1=1..2:5", "--samples", "9"], ["--over c1", "a..b"]),
        (["--over", "c1=1..2", "--samples", "9", "--seed", "-1"], ["--seed", "x>=0"]),
        (["--over", "c1=1,two"], ["c1=1,two", "takes numbers"]),
        (["--over", "c1=1,2", "--of", "weigh"], ["--of", "simulate"]),
        (["--over", "c1=1,2", "--out", "/proc/none"], ["/proc/none", "--out"]),
        ([], ["--over", "sweep --help"]),
    ],
)
def test_bad_input_is_one_line(monkeypatch, capsys, arguments, words):
    monkeypatch.setattr("mechsym.sweep.sweep", lambda *_: pytest.fail("ran"))
    monkeypatch.setattr(sys, "argv", ["mechsym", "sweep", "chmielewski", *arguments])
    with pytest.raises(SystemExit) as end:
        main()
    printed = capsys.readouterr()
    assert (end.value.code, printed.out, printed.err.count("\n")) == (2, "", 1)
    assert [word for word in words if word not in printed.err] == [], printed.err


def test_without_netcdf(monkeypatch, tmp_path):
    def missing(found):
        raise MissingExtra("no xarray")

    monkeypatch.setattr("mechsym.sweep.data.dataset", missing)
    done = run("chmielewski", "--over", "c1=0,0.5,1", *SET, "--out", str(tmp_path), "--json")
    assert (done.exit_code, done.stderr) == (0, "no netCDF file: no xarray\n")
    assert {f.name for f in tmp_path.iterdir()} == {"sweep.csv", "sweep.svg", "sweep.db", "summary.json"}
    assert len(json.loads(done.stdout)["files"]) == 3


def test_help_has_examples():
    text = run("--help").output
    assert "mechsym sweep zotov-89 --over" in text and "status 130" in text


def _kept(store):
    """How many points a store has, none while it is being made."""
    with contextlib.suppress(sqlite3.OperationalError), contextlib.closing(sqlite3.connect(store)) as connection:
        return connection.execute("select count(*) from point").fetchone()[0]
    return 0


@pytest.mark.slow
def test_ctrl_c_writes_what_is_finished(tmp_path):
    # a shell lets what it runs in the background ignore interrupts, and children inherit that
    code = ("import signal; signal.signal(signal.SIGINT, signal.default_int_handler); "
            "from mechsym.cli import main; main()")  # fmt: skip
    words = ["sweep", "zotov-89", "--over", "spring.p0=3..8 MPa:800", "--out", str(tmp_path), "--json"]
    process = subprocess.Popen([sys.executable, "-c", code, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                               text=True)  # fmt: skip
    for _ in range(600):  # until some points are done, far from all
        if (tmp_path / "sweep.db").exists() and _kept(tmp_path / "sweep.db"):
            break
        time.sleep(0.1)
    time.sleep(1)
    process.send_signal(signal.SIGINT)
    printed = process.communicate(timeout=60)
    report = json.loads(printed[0])
    assert (process.returncode, report["interrupted"]) == (130, True)
    assert printed[1].strip() in ("", interrupts.WORDS)
    assert 0 < len(report["failed"]) < 800 and {f["reason"] for f in report["failed"]} == {"interrupted"}
    assert (tmp_path / "sweep.csv").read_text(encoding="utf-8").count(",interrupted\n") == len(report["failed"])
