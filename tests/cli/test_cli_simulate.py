"""`mechsym simulate`: keys of the interface, files, exit statuses, one-line refusals."""

import json

import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym
from mechsym.errors import BadInput

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


def test_start_up_map_and_pictures(tmp_path):
    arguments = ("chmielewski", "--set", "t_end=3 s", "--set", "output_step=0.01 s", "--dampings", "0.2,5")
    found, status = numbers(*arguments, "--out", str(tmp_path))
    assert status == 0 and [s["c1"] for s in found["start_up"]] == [0.0, 0.2, 5.0]
    assert found["start_up"][0]["criticals"][1]["order"] == 2
    for picture in ("campbell.svg", "startup.svg"):
        assert (tmp_path / picture).read_text().startswith("<svg")
    assert "torque_peak" in run(*arguments).stdout
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
    assert "energy_residual" in result.stdout and "unchecked" in result.stdout and "phi2" in result.stdout


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
