"""A second run into a folder leaves what it would leave in a new one: nothing of the first is taken for its own."""

import json
import shutil
import sys
from pathlib import Path

import click
import pytest

from mechsym.cli import COMMANDS, main, mechsym

NUNES, MARINE = "nunes-slider-crank", ["--set", "operation.speed=100 rpm"]
#: Command, options of the first run, options of the second; FILE stands for a file in the folder
FAST = {
    "cycle": (["cycle", NUNES], ["--speeds", "1000,2000"], ["--speeds", "3000"]),
    "export": (["export", "moroianu"], ["--to", "c,julia"], ["--to", "c"]),
    "flywheel": (["flywheel", "opposed-pistons"], ["--ripple", "2%"], ["--ripple", "3%"]),
    "sweep": (["sweep", "moroianu", "--of", "cycle"], ["--over", "bore=0.5,0.52"], ["--over", "bore=0.5"]),
}
LONG = {
    "audit": (["audit", "--against", "hypocycloid.x"], ["--formula", "2*e*(1 - cos(theta))"], ["--formula", "2*e"]),
    "codesign": (["codesign", "zotov-89", "--speeds", "89"], ["--ripple", "5%"], ["--ripple", "6%"]),
    "compare": (["compare", NUNES, "nunes-hypocycloid"], ["--speeds", "1000,2000"], ["--speeds", "1000,3000"]),
    "derive": (["derive", "./one.py"], [], []),
    "fmu": (["fmu", "moroianu"], ["--out", "FILE.fmu"], ["--out", "FILE.fmu", *MARINE]),
    "balance": (["balance", "moroianu"], [], ["--shafts", "1,2"]),
    "forces": (["forces", "moroianu"], [], MARINE),
    "hinge": (["hinge", "zotov-89"], [], ["--set", "spring.p0=8 MPa"]),
    "hinge-infeasible": (["hinge", "zotov-89"], [], ["--set", "spring.p0=1 MPa"]),
    "identify": (["identify", "chmielewski", "--trace", "run/series.csv"], ["--free", "I2,k1"], ["--free", "I2"]),
    "optimise": (["optimise", "nunes-hypocycloid"], [], ["--set", "chamber.back_pressure=101325 Pa"]),
    "page": (["page", "zotov-89"], ["--out", "FILE.html"], ["--out", "FILE.html", "--set", "spring.p0=8 MPa"]),
    "report": (["report", "chmielewski"], ["--out", "FILE.html"], ["--out", "FILE.html", "--set", "c1=2"]),
    "prove": (["prove", "chmielewski"], ["--t-end", "0.2 s"], ["--t-end", "0.1 s"]),
    "reproduce": (["reproduce"], ["prymak"], ["moroianu2017"]),
    "simulate": (["simulate", "chmielewski", "--set", "t_end=2"], ["--dampings", "1,2"], ["--set", "c1=2"]),
    "size": (["size", NUNES], [], ["--set", "bore=0.07"]),
    "study": (["study", "study.toml"], [], ["--only", "bore"]),
}
RUNS = FAST | LONG
#: What of a summary differs from run to run: a time of the clock, and where a sweep put the points of the one before;
#: None where a solver on several threads leaves other last digits everywhere
DIFFERS = {"simulate": {"wall_s"}, "codesign": {"wall_s"}, "sweep": {"set_aside"}, "identify": None}
YOKE = Path(__file__).parents[2] / "examples" / "mechanisms" / "scotch_yoke.py"
STUDY = """
title = "Two sizes"
case = "moroianu"
of = "cycle"
[[sweep]]
name = "bore"
over = ["bore=0.5,0.52"]
[[sweep]]
name = "ratio"
over = ["cycle.compression_ratio=12,13"]
"""


def test_every_command_with_out_is_run_again():
    group = click.Context(mechsym)
    writers = {name for name in COMMANDS if any(p.name == "out" for p in mechsym.get_command(group, name).params)}
    # `new` overwrites nothing: tests/cli/test_start.py
    assert {name.partition("-")[0] for name in RUNS} == writers - {"new"}


def run(monkeypatch, folder, argv):
    words = [word.replace("FILE", str(folder / "file")) for word in argv]
    words += [] if "--out" in words else ["--out", str(folder)]
    monkeypatch.setattr(sys, "argv", ["mechsym", *words])
    with pytest.raises(SystemExit) as end:
        main()
    assert end.value.code in (0, 1, None)


def files_in(folder, differs):
    """What is in a folder, without what differs from run to run."""
    found = {}
    for path in sorted(p for p in folder.rglob("*") if p.is_file()):
        data = path.read_bytes()
        if differs is None:
            data = data.count(b"\n")
        elif path.name == "summary.json" and differs:
            numbers = json.loads(data)
            assert differs < numbers.keys()
            numbers["run"].pop("id")  # the digest of these numbers too
            data = {k: v for k, v in numbers.items() if k not in differs}
        stores = path.name.startswith("sweep") and path.suffix == ".db" or path.name == "proof.json"
        if not stores:  # they go on by design
            found[path.relative_to(folder).as_posix()] = data
    return found


def _marks(name):
    return [pytest.mark.slow, *[pytest.mark.heavy] * (name in ("codesign", "identify"))]


@pytest.mark.parametrize("name", [*FAST, *(pytest.param(name, marks=_marks(name)) for name in LONG)])
def test_a_second_run_leaves_what_it_leaves_in_a_new_folder(monkeypatch, tmp_path, name):
    if name in ("page", "fmu"):
        pytest.importorskip("ziglang", reason="the extra web is not installed")
    monkeypatch.chdir(tmp_path)
    (tmp_path / "study.toml").write_text(STUDY)
    (tmp_path / "one.py").write_text(YOKE.read_text())
    if name == "identify":
        run(monkeypatch, tmp_path / "run", ["simulate", "chmielewski", "--set", "t_end=3", "--set", "window=1"])
    command, first, second = RUNS[name]
    out, differs = tmp_path / "out", DIFFERS.get(name, set())
    run(monkeypatch, out, [*command, *first])
    before = files_in(out, differs)
    if name == "derive":
        (tmp_path / "one.py").write_text(YOKE.read_text().replace("crank.at(r)", "crank.at(2 * r)"))
    run(monkeypatch, out, [*command, *second])
    again = files_in(out, differs)
    shutil.rmtree(out)
    run(monkeypatch, out, [*command, *second])
    new = files_in(out, differs)
    assert list(again) == list(new)
    assert [file for file in new if again[file] != new[file]] == []
    assert new != before or differs is None
