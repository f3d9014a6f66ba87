"""Every command on linkages of the textbooks: they derive, run, bear forces, leave the tool, and are found again."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym

LINKAGES = Path(__file__).parents[2] / "examples" / "mechanisms" / "linkages.py"
TURN = '[operation]\nspeed = "60 rpm"\n'
SWING = '[motion]\n{q} = "cycloid"\nrise = "{rise}"\nduration = "0.5 s"\n'
# what moves it in forces, the torque of a run and its end, and the letters that identify looks for
TEN = {
    "hoeken": (TURN, 2.0, 1.0, "crank_inertia,coupler_mass"),
    "shaper": (TURN, 2.0, 1.0, "crank_inertia,ram_mass"),
    "toggle": (TURN, 2.0, 1.0, "crank_inertia,ram_mass"),
    "klann": (TURN, 2.0, 1.0, "crank_inertia,leg_mass"),
    "jansen": (TURN, 2.0, 1.0, "crank_inertia,bar_h_mass"),
    "chebyshev": (SWING.format(q="phi", rise="20 deg"), 0.5, 0.25, "crank_inertia,coupler_mass"),
    "peaucellier": (SWING.format(q="phi", rise="20 deg"), 0.5, 0.5, "crank_inertia,l1_mass"),
    "scissor": (SWING.format(q="phi", rise="20 deg"), 20.0, 1.0, "a_inertia,top_mass"),
    "fivebar": (SWING.format(q="a1", rise="20 deg") + 'a2 = "3-4-5"\n', 0.5, 0.4, "one_inertia,left_mass"),
}
EACH = [pytest.param(n, marks=[pytest.mark.slow, pytest.mark.heavy]) for n in TEN]
ANOTHER = 1.1  # times the truth, from which identify starts
NOISE = 1e-4  # rad/s


def run(*words):
    done = CliRunner().invoke(mechsym, [str(w) for w in words])
    assert done.exit_code == 0, (words, done.output[-2000:])
    return done.output


def case_of(name, folder, driven=True):
    """A case that turns, or one that a torque drives; with `driven` false what [motion] says moves it."""
    moves, torque, t_end, _ = TEN[name]
    drive = f'[drive]\ninput = "M1"\ntorque = {torque}\n' if name == "fivebar" else f"[drive]\ntorque = {torque}\n"
    moves, drive = (moves, drive) if "operation" in moves else ("", drive) if driven else (moves, "")
    folder.mkdir(exist_ok=True)
    file = folder / f"{name}.toml"
    file.write_text(
        f'mechanism = "{LINKAGES}:{name}"\n{moves}{drive}[simulation]\nt_end = {t_end}\noutput_step = 0.002\n'
    )
    return file


@pytest.mark.parametrize("name", EACH)
def test_every_command_takes_it(name, tmp_path):
    case, mechanism = case_of(name, tmp_path), f"{LINKAGES}:{name}"
    run("check", case, "--trust")
    assert run("derive", mechanism, "--explain").count("by the pose") >= 1
    run("derive", mechanism, "--draw", "--out", tmp_path)
    assert "trace" in (tmp_path / f"{name}.svg").read_text() or (tmp_path / f"{name}.svg").stat().st_size > 3000
    turned = "phi=0.8" if name == "peaucellier" else "phi=1.2"  # its loop opens at 1.01
    outputs = json.loads(run("eval", mechanism, "--json", *(("--set", turned) if name != "fivebar" else
                             ("--set", "a1=2.0", "--set", "a2=1.0"))))["outputs"]  # fmt: skip
    assert all(v is not None for v in outputs.values())
    told = json.loads(run("simulate", case, "--json", "--out", tmp_path / "run"))
    assert told["status"] == "converged" and abs(told["energy_residual"]) < 1e-10
    moved = case if "motion" not in TEN[name][0] else case_of(name, tmp_path / "moved", driven=False)
    forces = json.loads(run("forces", moved, "--json", "--out", tmp_path / "forces"))
    assert abs(forces["power_residual"]) < 1e-9 and any(n.startswith("R_") for n in forces["max"])
    first, second = TEN[name][3].split(",")
    run("sweep", case, "--over", f"{first}=0.09..0.11:2", "--out", tmp_path / "sweep")
    run("export", case, "--to", "c", "--out", tmp_path / "c")
    run("fmu", case, "--fmi", "2", "--out", tmp_path / "a.fmu")
    run("page", case, "--out", tmp_path / "a.html")
    text = (tmp_path / "a.html").read_text()
    assert '"moves"' in text and text.count(f'"{second}"') >= 2  # a slider and a field
    run("report", case, "--out", tmp_path / "report")


@pytest.mark.parametrize("name", EACH)
def test_two_letters_are_found_again_in_its_own_trace(name, tmp_path):
    case = case_of(name, tmp_path)
    run("simulate", case, "--no-check", "--out", tmp_path / "run")
    with (tmp_path / "run" / "series.csv").open() as file:
        rows = list(csv.DictReader(file))
    speed = next(n for n in rows[0] if n.startswith(("phid [", "a1d [")))
    times, values = (np.array([float(row[n]) for row in rows]) for n in ("t [s]", speed))
    values = values + np.random.default_rng(5).normal(0, NOISE, values.shape)
    trace = tmp_path / "trace.csv"
    np.savetxt(
        trace, np.column_stack([times, values]), delimiter=",", header=f"t [s],{speed}", comments="", fmt="%.12g"
    )
    free = TEN[name][3].split(",")
    listing = json.loads(run("check", case, "--trust", "--json"))
    assert not listing["problems"]
    truth = {n: 10.0 if n == "top_mass" else 1.0 if n.endswith("_mass") else 0.1 for n in free}
    settings = [part for n in free for part in ("--set", f"{n}={ANOTHER * truth[n]!r}")]
    found = json.loads(run("identify", case, "--trace", trace, "--free", ",".join(free), *settings, "--json"))
    for letter, estimate in found["parameters"].items():
        assert estimate["low"] <= truth[letter] <= estimate["high"], (letter, estimate)


@pytest.mark.slow
@pytest.mark.heavy
def test_an_interval_holds_what_lies_behind_a_ridge(tmp_path, monkeypatch):
    """Over 0.4 s the trace fits two starts of the crank nearly alike, and a search may end in the wrong one."""
    moves, torque, _, free = TEN["chebyshev"]
    monkeypatch.setitem(TEN, "chebyshev", (moves, torque, 0.4, free))
    test_two_letters_are_found_again_in_its_own_trace("chebyshev", tmp_path)
