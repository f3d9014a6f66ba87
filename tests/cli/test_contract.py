"""What the command line owes its caller: 74 where the system fails, --out tried first, files that appear together."""

import errno
import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import click
import pytest

from mechsym import cases, files
from mechsym.cli import COMMANDS, main, mechsym

MECHSYM = Path(sys.executable).parent / "mechsym"
CYCLE = ["cycle", "nunes-slider-crank"]


def ended(monkeypatch, capsys, argv):
    monkeypatch.setattr(sys, "argv", ["mechsym", *argv])
    with pytest.raises(SystemExit) as end:
        main()
    printed = capsys.readouterr()
    assert printed.err.count("\n") <= 1
    return end.value.code, printed.out, printed.err


@pytest.mark.parametrize("argv", [["cases", "--json"], ["--help"], ["eval", "--help"]], ids=" ".join)
def test_full_device(argv):
    with open("/dev/full", "w") as full:
        done = subprocess.run([MECHSYM, *argv], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 74
    assert done.stderr == "mechsym: the system failed: [Errno 28] No space left on device\n"


@pytest.mark.parametrize("argv", [["cases", "--json"], ["--help"]], ids=" ".join)
def test_broken_pipe(argv):
    reader, writer = os.pipe()
    os.close(reader)
    done = subprocess.run([MECHSYM, *argv], stdout=writer, stderr=subprocess.PIPE, text=True, check=False)
    os.close(writer)
    assert done.returncode == 74
    assert done.stderr == "mechsym: the system failed: [Errno 32] Broken pipe\n"


def test_no_way_to_say_anything():
    with open("/dev/full", "w") as full:
        done = subprocess.run([MECHSYM, "cases"], stdout=full, stderr=full, check=False)
    assert done.returncode == 74


def disk_full_after(monkeypatch, count):
    """The disk takes `count` files and no more."""
    taken = []

    def fsync(handle):
        if len(taken) == count:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        taken.append(handle)

    monkeypatch.setattr(files.os, "fsync", fsync)


@pytest.mark.parametrize("count", [0, 1, 2])
def test_full_disk_leaves_no_part_of_a_run(monkeypatch, capsys, tmp_path, count):
    disk_full_after(monkeypatch, count)
    code, out, err = ended(monkeypatch, capsys, [*CYCLE, "--out", str(tmp_path)])
    assert (code, out) == (74, "")
    assert "No space left" in err
    assert list(tmp_path.iterdir()) == []


AFTER_WORK = {
    "study": ["study", "nunes2017-chapter-6", "--only", "rod", "--out", "RUN"],
    "page": ["page", "zotov-89", "--out", "RUN/engine.html"],
    "report": ["report", "chmielewski", "--out", "RUN/report.html"],
}


@pytest.mark.slow
@pytest.mark.parametrize("name", AFTER_WORK)
def test_full_disk_after_long_work(monkeypatch, capsys, tmp_path, name):
    if name == "page":
        pytest.importorskip("ziglang", reason="the extra web is not installed")
    disk_full_after(monkeypatch, 0)
    code, _, err = ended(monkeypatch, capsys, [word.replace("RUN", str(tmp_path)) for word in AFTER_WORK[name]])
    assert code == 74
    assert "No space left" in err
    # a study keeps the points that it has computed: the same command goes on from them
    assert [p.name for p in tmp_path.rglob("*") if p.is_file() and p.name != "sweep.db"] == []


def test_a_run_that_fails_leaves_the_last_run_as_it_was(monkeypatch, capsys, tmp_path):
    assert ended(monkeypatch, capsys, [*CYCLE, "--out", str(tmp_path)])[0] in (0, None)
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    assert len(before) == 4
    disk_full_after(monkeypatch, 2)
    assert ended(monkeypatch, capsys, [*CYCLE, "--set", "bore=0.05", "--out", str(tmp_path)])[0] == 74
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before


#: Every command that writes into --out, with what it needs before the case is looked at
WRITERS = {
    "audit": ["audit"], "balance": ["balance", "none"],
    "codesign": ["codesign", "none"], "compare": ["compare", "none", "none"],
    "cycle": ["cycle", "none"], "derive": ["derive", "./none.py"], "export": ["export", "none", "--to", "c"],
    "flywheel": ["flywheel", "none", "--ripple", "2%"], "fmu": ["fmu", "none"], "forces": ["forces", "none"],
    "hinge": ["hinge", "none"], "new": ["new", "mechanism", "press"], "optimise": ["optimise", "none"],
    "page": ["page", "none"], "prove": ["prove", "none.toml"], "reproduce": ["reproduce"], "report": ["report", "none"],
    "simulate": ["simulate", "none"], "size": ["size", "none"],
    "identify": ["identify", "none", "--trace", "none.csv", "--free", "I1"],
    "study": ["study", "none"], "sweep": ["sweep", "none", "--over", "m3=1..2:2"],
}  # fmt: skip
FILES = ("fmu", "page", "report")


def test_no_writer_is_left_out():
    group = click.Context(mechsym)
    writers = {name for name in COMMANDS if any(p.name == "out" for p in mechsym.get_command(group, name).params)}
    assert writers == set(WRITERS)


@pytest.mark.parametrize("command", WRITERS)
@pytest.mark.parametrize("place", ["taken/below", "taken", "/dev/full", "/proc/none"])
def test_out_is_tried_before_the_case_is_even_read(monkeypatch, capsys, tmp_path, command, place):
    (tmp_path / "taken").write_text("")
    target = str(tmp_path / place)
    if command in FILES:
        target = str(Path(target) / "file")
    code, out, err = ended(monkeypatch, capsys, [*WRITERS[command], "--out", target])
    assert (code, out) == (2, "") and str(tmp_path / place) in err and "--out" in err
    assert (tmp_path / "taken").read_text() == "" and len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("kind", ["dxf", "step"])
def test_drawings_are_tried_too(monkeypatch, capsys, tmp_path, kind):
    (tmp_path / "taken").write_text("")
    file = tmp_path / "taken" / f"file.{kind}"
    code, _, err = ended(monkeypatch, capsys, ["guide", "no-such-case", f"--{kind}", str(file)])
    assert code == 2 and "taken" in err and "cannot be written" in err


def test_trying_leaves_no_folder(monkeypatch, capsys, tmp_path):
    code, _, err = ended(monkeypatch, capsys, ["cycle", "no-such-case", "--out", str(tmp_path / "a" / "b")])
    assert code == 2 and "no-such-case" in err
    assert list(tmp_path.iterdir()) == []


#: A quick run of every command that leaves a summary
RUNS = {
    "balance": ["balance", "moroianu"],
    "forces": ["forces", "moroianu"], "cycle": ["cycle", "nunes-slider-crank"], "size": ["size", "nunes-slider-crank"],
    "compare": ["compare", "nunes-slider-crank", "nunes-hypocycloid", "--speeds", "1000,2000"],
    "flywheel": ["flywheel", "opposed-pistons", "--ripple", "2%"], "export": ["export", "hypocycloid", "--to", "julia"],
    "simulate": ["simulate", "chmielewski", "--set", "t_end=2", "--set", "simulation.window=1"],
    "study": ["study", "nunes2017-chapter-6", "--only", "compression"],
    "sweep": ["sweep", "moroianu", "--over", "operation.speed=80,85 rpm"],
}  # fmt: skip
#: The others, whose runs are long or need a case of their own: `audit` and `reproduce` write all of their papers
LONG = {
    "hinge": ["hinge", "zotov-89", "--set", "trials.turns=4"],
    "codesign": ["codesign", "zotov-89", "--speeds", "89", "--ripple", "5%"],
    "optimise": ["optimise", "nunes-hypocycloid"],
    "audit": ["audit", "--formula", "2*e*(1 - cos(theta))", "--against", "hypocycloid.x"],
    "prove": ["prove", "chmielewski", "--t-end", "0.1 s"], "reproduce": ["reproduce", "prymak"],
}  # fmt: skip
SLOW = [pytest.param(name, marks=pytest.mark.slow) for name in LONG]


@pytest.mark.parametrize("command", [*RUNS, *SLOW])
def test_the_summary_tells_the_files_of_its_run(monkeypatch, capsys, tmp_path, command):
    code, _, err = ended(monkeypatch, capsys, [*(RUNS | LONG)[command], "--out", str(tmp_path)])
    assert code in (0, None), err
    numbers = json.loads((tmp_path / "summary.json").read_text())
    files_ = {p.relative_to(tmp_path).as_posix(): p for p in tmp_path.rglob("*") if p.is_file()}
    at = {name: hashlib.sha256(p.read_bytes()).hexdigest() for name, p in files_.items()}
    store = {"sweep.db", "proof.json"}  # they grow from run to run
    assert numbers["run"]["files"] == {n: d for n, d in at.items() if n != "summary.json" and Path(n).name not in store}
    assert len(at) > 1 and len(numbers["run"]["id"]) == 16 and "doubts" in numbers


def test_writers_leave_a_summary():
    sources = {"derive", "new"}  # code with stamps, and text to begin with: no run
    measured = {"identify"}  # wants a measured trace: tests/optimise/test_identify.py
    assert set(RUNS) | set(LONG) == set(WRITERS) - set(FILES) - sources - measured


@pytest.mark.slow
def test_the_id_of_a_run_is_that_of_what_is_in_it(monkeypatch, capsys, tmp_path):
    def run(*more):
        ended(monkeypatch, capsys, ["forces", "moroianu", *more, "--out", str(tmp_path)])
        return json.loads((tmp_path / "summary.json").read_text())["run"]["id"]

    first = run()
    assert run() == first
    assert run("--set", "operation.speed=90 rpm") != first


TOO_MUCH = [
    (["simulate", "chmielewski", "--set", "output_step=1e-7"], ["output_step = 1e-07 s", "1e+09", "0.0001 s"]),
    (["simulate", "zotov-89", "--set", "simulation.turns=1e9"], ["turns = 1e+09", "3.6e+11", "2777 turns"]),
    (["simulate", "alpha-stirling", "--set", "simulation.turns=1e9"], ["turns = 1e+09", "3.6e+11", "2777 turns"]),
    (["simulate", "nunes-slider-crank", "--set", "simulation.turns=1e9"], ["turns = 1e+09", "3.6e+11", "2777 turns"]),
    (["simulate", "chmielewski", "--set", "t_end=1e9", "--set", "output_step=1e4"], ["t_end = 1e+09 s", "e+18 steps"]),
    (["cycle", "nunes-slider-crank", "--speeds", "1000:8000:0.01"], ["700001 values", "1 to 20000"]),
    (["hinge", "zotov-89", "--loads", "0.1..1:101"], ["101 values", "1 to 100"]),
    (["simulate", "chmielewski", "--dampings", "0.1..1:1001"], ["1001 values", "1 to 1000"]),
    (["hinge", "zotov-89", "--set", "trials.turns=1e4"], ["turns = 10000", "<= 1000"]),
    (["codesign", "zotov-89", "--speeds", "60..142:101"], ["101 values", "1 to 100"]),
    (["codesign", "zotov-89", "--speeds", "60..142:20", "--loads", "0.5..1:20"], ["400 points", "1 to 100"]),
    (["sweep", "zotov-89", "--over", "spring.p0=1e6..2e6:100000000"], ["100000000 values", "1000000"]),
    (["sweep", "zotov-89", "--of", "size", "--over", "m3=1..2:1000"], ["1000 points, about 33 minutes", "give --out"]),
    (["sweep", "zotov-89", "--over", "m3=1..2:9999", "--over", "r1=1..2:9999"], ["99980001 points", "20000000"]),
]


@pytest.mark.parametrize(("argv", "words"), TOO_MUCH, ids=[" ".join(row[0][:2]) for row in TOO_MUCH])
def test_what_would_not_fit_is_refused_first(monkeypatch, capsys, argv, words):
    code, out, err = ended(monkeypatch, capsys, argv)
    assert (code, out) == (2, "")
    assert all(word in err for word in words), err


def test_gas_in_the_loop_is_counted_by_time_too(monkeypatch, capsys, tmp_path):
    (tmp_path / "long.toml").write_text(cases.text("nunes-slider-crank") + "\n[simulation]\nt_end = 1e6\n")
    code, _, err = ended(monkeypatch, capsys, ["simulate", str(tmp_path / "long.toml")])
    assert code == 2 and "simulation.t_end = 1e+06 s asks for" in err and "give at most 20.8 s" in err


def test_memory_used_up(monkeypatch, capsys):
    def hungry(*_):
        raise MemoryError

    monkeypatch.setattr("mechsym.cli.catalogue.emit", hungry)
    code, out, err = ended(monkeypatch, capsys, ["cases"])
    assert (code, out, err) == (74, "", "mechsym: the system failed: memory is used up\n")


#: Values that only the run asks for, of an engine that is usual at its own speed
UNUSUAL = [
    (["cycle", "nunes-slider-crank", "--speeds", "6000,42982"], "piston_speed"),
    (["cycle", "nunes-slider-crank", "--speeds", "3000", "--over", "compression_ratio=9,50"], "compression_ratio"),
    (["compare", "nunes-slider-crank", "nunes-hypocycloid", "--speeds", "1000,40000"], "piston_speed"),
    (["sweep", "nunes-slider-crank", "--over", "speed_rpm=6000,42982"], "piston_speed"),
    (["sweep", "nunes-slider-crank", "--over", "compression_ratio=9,50"], "compression_ratio"),
]


@pytest.mark.parametrize(("argv", "code"), UNUSUAL, ids=[f"{a[0]}-{a[-2]}" for a, _ in UNUSUAL])
def test_what_a_run_asks_for_is_judged_as_the_case_is(monkeypatch, capsys, argv, code):
    status, out, _ = ended(monkeypatch, capsys, [*argv, "--json"])
    assert status in (0, None)
    assert code in {doubt["code"] for doubt in json.loads(out)["doubts"]}


@pytest.mark.parametrize("command", ["cycle", "sweep"])
def test_usual_ranges_of_an_engine_raise_no_doubt(monkeypatch, capsys, command):
    over = ["--speeds", "1000:8000:1000"] if command == "cycle" else ["--over", "speed_rpm=1000..8000:8"]
    _, out, _ = ended(monkeypatch, capsys, [command, "nunes-slider-crank", *over, "--json"])
    assert json.loads(out)["doubts"] == []


def test_a_speed_beyond_all_engines_is_refused(monkeypatch, capsys):
    code, out, err = ended(monkeypatch, capsys, ["cycle", "nunes-slider-crank", "--speeds", "6000,142982"])
    assert (code, out) == (2, "") and "possible is at most 100 m/s" in err


#: Commands that read a file which the user names, with FILE in its place
READERS = {
    "case": ["cycle", "FILE"], "check": ["check", "FILE"], "diagram": ["cycle", "generator", "--diagram", "FILE"],
    "motored": ["cycle", "generator", "--motored", "FILE"],
    "torque": ["cycle", "moroianu", "--torque", "FILE", "--noise", "1"], "formulas": ["audit", "--file", "FILE"],
    "paper": ["audit", "FILE"], "theory": ["audit", "--formula", "r", "--against", "a.x", "--theory", "FILE"],
    "points": ["codesign", "zotov-89", "--curve", "FILE"],
    "materials": ["size", "nunes-hypocycloid", "--set", "sizing.materials_file=FILE"],
    "bearings": ["size", "nunes-hypocycloid", "--set", "sizing.bearings_file=FILE"],
    "code": ["audit", "--code", "FILE::f", "--against", "crosshead.x"],
}  # fmt: skip


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("failure", [errno.EACCES, errno.EIO])
def test_a_file_that_the_system_does_not_give(monkeypatch, capsys, tmp_path, reader, failure):
    file = tmp_path / {"paper": "a.tex", "case": "a.toml", "theory": "a.toml", "code": "a.py"}.get(reader, "a.csv")
    file.write_text("")
    given = Path.read_bytes

    def read_bytes(self):
        if self == file:
            raise OSError(failure, os.strerror(failure))
        return given(self)

    monkeypatch.setattr(Path, "read_bytes", read_bytes)
    code, out, err = ended(monkeypatch, capsys, [word.replace("FILE", str(file)) for word in READERS[reader]])
    assert (code, out) == (74, "")
    assert err == f"mechsym: the system failed: [Errno {failure}] {os.strerror(failure)}: '{file}'\n"


@pytest.mark.parametrize("reader", READERS)
@pytest.mark.parametrize("made", ["folder", "binary", "nothing"])
def test_a_path_that_names_no_text(monkeypatch, capsys, tmp_path, reader, made):
    file = tmp_path / "a.tex"
    if made == "folder":
        file.mkdir()
    elif made == "binary":
        file.write_bytes(b"\xff\xfe\x00")
    code, out, err = ended(monkeypatch, capsys, [word.replace("FILE", str(file)) for word in READERS[reader]])
    assert (code, out) == (2, "")
    assert str(file) in err
