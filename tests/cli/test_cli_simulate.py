"""`mechsym simulate`: keys of the interface, files, exit statuses, one-line refusals."""

import csv
import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"

KEYS = {
    "t_end", "speed_mean", "speed_min", "speed_max", "energy_residual", "tolerance_difference", "steps", "wall_s",
    "event",
}  # fmt: skip


def run(*arguments):
    return CliRunner().invoke(mechsym, ["simulate", *arguments])


def numbers(*arguments):
    result = run(*arguments, "--json")
    return json.loads(result.stdout), result.exit_code


def test_start_up_keys_and_files(tmp_path):
    found, status = numbers("chmielewski", "--set", "t_end=3 s", "--out", str(tmp_path))
    assert set(found) >= KEYS and status == 0
    assert found["t_end"] == 3.0 and found["event"] is None and found["status"] == "converged"
    assert abs(found["energy_residual"]) < 1e-8
    assert found["speed_min"] <= found["speed_mean"] <= found["speed_max"]
    assert (
        (tmp_path / "series.csv")
        .read_text()
        .startswith("t [s],phi0 [rad],phi2 [rad],phi0d [rad/s],phi2d [rad/s],work_drive [J]")
    )
    assert any("natural frequency 30.28 Hz bare" in line for line in found["findings"])
    assert found["files"][0].endswith("series.csv")


def test_a_shaft_without_stiffness_runs_its_crank_alone():
    free = ("k1=0", "c1=0", "m0=0", "t_end=3 s", "window=0.5 s", "output_step=0.05 s")
    found, status = numbers("chmielewski", *(word for key in free for word in ("--set", key)))
    given = cases.load("chmielewski")
    speed = given.need("drive").torque * (3 - given.need("drive").time) / given.need("parameters").I0
    assert status == 0 and found["final_state"]["phi0d"] == pytest.approx(speed, rel=1e-9)


def test_start_up_map_and_pictures(tmp_path):
    arguments = ("chmielewski", "--set", "t_end=3 s", "--set", "output_step=0.01 s", "--dampings", "0.2,5")
    found, status = numbers(*arguments, "--out", str(tmp_path))
    assert status == 0 and [s["c1"] for s in found["start_up"]] == [0.0, 0.2, 5.0]
    assert found["start_up"][0]["criticals"][1]["order"] == 2
    for picture in ("campbell.svg", "startup.svg"):
        assert (tmp_path / picture).read_text().startswith("<svg")
    assert "largest torque" in run(*arguments).stdout
    short, _ = numbers("chmielewski", "--set", "t_end=0.5 s", "--set", "window=0.1 s")
    assert short["start_up"] == [] and short["findings"] == []


def test_engine_with_hinge_keeps_its_speed():
    found, status = numbers("zotov-89", "--set", "simulation.turns=3")
    assert status == 0 and found["end"] == "turns"
    assert (found["speed_max"] - found["speed_min"]) / found["speed_mean"] < 1e-6
    assert abs(found["energy_residual"]) < 1e-8


def test_engine_ends_at_t_end_or_after_its_turns_whichever_comes_first():
    found, status = numbers("zotov-89", "--set", "simulation.turns=3", "--set", "simulation.t_end=1 s")
    assert status == 0 and found["end"] == "t_end" and found["t_end"] == 1.0
    later, _ = numbers("zotov-89", "--set", "simulation.turns=3", "--set", "simulation.t_end=1000 s")
    assert later["end"] == "turns" and later["t_end"] < 3.0


def test_engine_without_hinge_stalls_and_that_is_no_failure():
    found, status = numbers("zotov-89", "--set", "simulation.hinge=none")
    assert status == 0 and found["end"] == "stall"
    assert found["event"]["name"] == "stall" and found["event"]["t"] == found["t_end"]


@pytest.mark.slow
def test_exit_status_of_a_run_that_does_not_converge():
    found, status = numbers("chmielewski", "--set", "t_end=60 s", "--tolerance", "1e-3", "--backend", "scipy-rk45")
    assert status == 1 and found["status"] == "not converged" and found["reason"]


def test_text_for_people():
    result = run("chmielewski", "--set", "t_end=3 s", "--no-check")
    assert result.exit_code == 0
    assert "energy residual" in result.stdout and "not checked" in result.stdout and "phi2" in result.stdout


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["chmielewski", "--backend", "euler"], "options are auto"),
        (["chmielewski", "--tolerance", "tiny"], "tolerance"),
        (["chmielewski", "--set", "t_end=-3 s"], "t_end"),
        (["chmielewski", "--set", "drive.input=X"], "part names 'X'"),
        (["chmielewski", "--set", "window=5 bar"], "wrong dimension"),
        (["zotov-89", "--backend", "sundials"], "knows no events"),
        (["zotov-89", "--set", "simulation.turns=1", "--dampings", "1"], "needs a start-up case"),
        (["chmielewski", "--set", "t_end=3 s", "--dampings", "1 bar"], "--dampings"),
        (["nowhere"], "neither built in"),
    ],
)
def test_bad_input_is_refused(arguments, words):
    result = run(*arguments)
    assert isinstance(result.exception, BadInput)
    assert words in str(result.exception)


def test_help_has_an_example():
    assert "Example: mechsym simulate chmielewski" in run("--help").stdout


def test_the_final_state_is_the_last_row_of_the_series(tmp_path):
    found, _ = numbers(
        "chmielewski", "--set", "t_end=0.5 s", "--set", "window=0.1 s", "--no-check", "--out", str(tmp_path)
    )
    heads, *rows = csv.reader((tmp_path / "series.csv").read_text().splitlines())
    last = dict(zip((head.partition(" [")[0] for head in heads), map(float, rows[-1]), strict=True))
    assert found["final_state"] == pytest.approx({name: last[name] for name in ("phi0", "phi0d", "phi2", "phi2d")})
    assert json.loads((tmp_path / "summary.json").read_text())["final_state"] == found["final_state"]
    assert numbers("nunes-hypocycloid", "--set", "simulation.turns=1", "--no-check")[0]["final_state"].keys() == {
        "theta",
        "thetad",
    }


def ends(case, seconds, *words):
    return numbers(str(EXAMPLES / case), "--set", f"t_end={seconds} s", "--no-check", *words)[0]["final_state"]


@pytest.mark.parametrize(
    "case, more, names",
    [
        ("atkinson.toml", (), {}),
        (
            "scotch-yoke.toml",
            ("simulation.hinge=none",),
            {"phi": "simulation.phi_start", "phid": "simulation.speed_start"},
        ),
    ],
)
def test_a_run_goes_on_from_where_another_ended(case, more, names):
    """[start] of one's own mechanism takes the final state as it is, an engine's [simulation] its angle and speed."""
    words = [word for one in more for word in ("--set", one)]
    first, whole = (ends(case, seconds, *words) for seconds in (0.2, 0.3))
    start = [word for key, value in first.items() for word in ("--set", f"{names.get(key, f'start.{key}')}={value!r}")]
    assert ends(case, 0.1, *words, *start) == pytest.approx(whole, rel=1e-7, abs=1e-7)
    assert ends(case, 0.1, *words) != pytest.approx(whole, rel=1e-2)
