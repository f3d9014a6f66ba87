"""What the command line owes its caller: 74 where the system fails, --out tried first, files that appear together."""

import errno
import hashlib
import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

from mechsym import files
from mechsym.cli import main
from mechsym.errors import BadInput

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


def test_a_run_that_fails_leaves_the_last_run_as_it_was(monkeypatch, capsys, tmp_path):
    assert ended(monkeypatch, capsys, [*CYCLE, "--out", str(tmp_path)])[0] in (0, None)
    before = {p.name: p.read_bytes() for p in tmp_path.iterdir()}
    assert len(before) == 3
    disk_full_after(monkeypatch, 2)
    assert ended(monkeypatch, capsys, [*CYCLE, "--set", "bore=0.05", "--out", str(tmp_path)])[0] == 74
    assert {p.name: p.read_bytes() for p in tmp_path.iterdir()} == before


def test_files_appear_at_the_end_of_a_run_and_others_at_once(tmp_path):
    run, other = tmp_path / "run", tmp_path / "other"
    with files.together(run):
        files.write_text(run / "a.txt", "1")
        files.write_text(run / "below" / "a.txt", "2")
        files.write_text(run / "a.txt", "3")
        files.write_text(other / "a.txt", "4")
        assert not (run / "a.txt").exists() and (other / "a.txt").read_text() == "4"
    assert (run / "a.txt").read_text() == "3" and (run / "below" / "a.txt").read_text() == "2"
    assert len([p for p in run.rglob("*") if p.is_file()]) == 2


@pytest.mark.parametrize(("error", "kept"), [(BadInput, False), (OSError, False), (KeyboardInterrupt, True)])
def test_what_is_kept(tmp_path, error, kept):
    with pytest.raises(error), files.together(tmp_path):
        files.write_text(tmp_path / "a.txt", "1")
        raise error
    assert [p.name for p in tmp_path.iterdir()] == (["a.txt"] if kept else [])


@pytest.mark.parametrize("command", ["forces", "simulate", "size", "cycle", "optimise", "flywheel", "hinge"])
def test_out_is_tried_before_the_case_is_even_read(monkeypatch, capsys, tmp_path, command):
    (tmp_path / "taken").write_text("")
    folder = str(tmp_path / "taken" / "below")
    code, _, err = ended(monkeypatch, capsys, [command, "no-such-case", "--out", folder])
    assert code == 2 and folder in err and "--out" in err


@pytest.mark.parametrize("command", ["page", "fmu"])
def test_a_file_is_tried_too(monkeypatch, capsys, tmp_path, command):
    (tmp_path / "taken").write_text("")
    code, _, err = ended(monkeypatch, capsys, [command, "no-such-case", "--out", str(tmp_path / "taken" / "file")])
    assert code == 2 and "taken" in err and "--out" in err


@pytest.mark.parametrize("option", ["--dxf", "--sheet"])
def test_drawings_are_tried_too(monkeypatch, capsys, tmp_path, option):
    (tmp_path / "taken").write_text("")
    code, _, err = ended(monkeypatch, capsys, ["guide", "no-such-case", option, str(tmp_path / "taken" / "file.dxf")])
    assert code == 2 and "taken" in err and "cannot be written" in err


def test_trying_leaves_no_folder(monkeypatch, capsys, tmp_path):
    code, _, err = ended(monkeypatch, capsys, ["cycle", "no-such-case", "--out", str(tmp_path / "a" / "b")])
    assert code == 2 and "no-such-case" in err
    assert list(tmp_path.iterdir()) == []


def test_the_summary_tells_the_files_of_its_run(monkeypatch, capsys, tmp_path):
    def run(*more):
        ended(monkeypatch, capsys, ["forces", "moroianu", *more, "--out", str(tmp_path)])
        numbers = json.loads((tmp_path / "summary.json").read_text())
        of = numbers.pop("run")
        at = {p.name: hashlib.sha256(p.read_bytes()).hexdigest() for p in tmp_path.iterdir() if p.is_file()}
        assert of["files"] == {name: digest for name, digest in at.items() if name != "summary.json"}
        assert len(of["files"]) > 3 and numbers["doubts"] == []
        return of["id"]

    first = run()
    assert run() == first and len(first) == 16
    assert run("--set", "operation.speed=90 rpm") != first


TOO_MUCH = [
    (["simulate", "chmielewski", "--set", "output_step=1e-7"], ["output_step = 1e-07 s", "1e+09", "0.0001 s"]),
    (["simulate", "zotov-89", "--set", "simulation.turns=1e9"], ["turns = 1e+09", "3.6e+11", "2777 turns"]),
    (["simulate", "alpha-stirling", "--set", "simulation.turns=1e9"], ["turns = 1e+09", "3.6e+11", "2777 turns"]),
    (["cycle", "nunes-slider-crank", "--speeds", "1000:8000:0.01"], ["700001 values", "1 to 20000"]),
    (["hinge", "zotov-89", "--loads", "0.1..1:101"], ["101 values", "1 to 100"]),
    (["simulate", "chmielewski", "--dampings", "0.1..1:1001"], ["1001 values", "1 to 1000"]),
    (["sweep", "zotov-89", "--over", "m3=1..2:9999", "--over", "r1=1..2:9999"], ["99980001 points", "1000000"]),
]


@pytest.mark.parametrize(("argv", "words"), TOO_MUCH, ids=[" ".join(row[0][:2]) for row in TOO_MUCH])
def test_what_would_not_fit_is_refused_first(monkeypatch, capsys, argv, words):
    code, out, err = ended(monkeypatch, capsys, argv)
    assert (code, out) == (2, "")
    assert all(word in err for word in words), err


def test_memory_used_up(monkeypatch, capsys):
    def hungry(*_):
        raise MemoryError

    monkeypatch.setattr("mechsym.cli.catalogue.emit", hungry)
    code, out, err = ended(monkeypatch, capsys, ["cases"])
    assert (code, out, err) == (74, "", "mechsym: the system failed: memory is used up\n")
