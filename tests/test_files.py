"""Files: written together or not at all, nothing older read or left in their place."""

import csv
import errno
import hashlib
import io
import json
import multiprocessing
import os
import shutil
import stat
import subprocess
import sys
import threading
from pathlib import Path

import fault_shim
import faults
import numpy as np
import pytest

from mechsym import files, transaction
from mechsym.errors import BadInput
from mechsym.files import inputs

ERRORS = [BadInput, OSError, MemoryError, ValueError, RuntimeError, SystemExit, KeyboardInterrupt]


def names(folder):
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*"))


def test_files_appear_at_the_end_of_a_block_and_others_at_once(tmp_path):
    run, other = tmp_path / "run", tmp_path / "other"
    with files.together(run):
        files.write_text(run / "a.txt", "1")
        files.write_text(run / "below" / "a.txt", "2")
        files.write_text(run / "a.txt", "3")
        files.write_text(other / "a.txt", "4")
        assert not (run / "a.txt").exists() and (other / "a.txt").read_text() == "4"
    assert (run / "a.txt").read_text() == "3" and (run / "below" / "a.txt").read_text() == "2"
    assert names(run) == ["a.txt", "below", "below/a.txt"]


@pytest.mark.parametrize("error", ERRORS)
def test_any_exception_drops_what_waits_and_keeps_what_was_published(tmp_path, error):
    with pytest.raises(error), files.together(tmp_path / "run"):
        files.write_text(tmp_path / "run" / "below" / "a.txt", "1")
        raise error
    assert names(tmp_path) == []
    with pytest.raises(error), files.together(tmp_path / "run"):
        files.write_text(tmp_path / "run" / "whole.txt", "1")
        files.publish()
        files.write_text(tmp_path / "run" / "below" / "a.txt", "1")
        raise error
    assert names(tmp_path) == ["run", "run/whole.txt"]


def test_an_inner_block_gives_its_files_to_the_outer_one(tmp_path):
    outer, inner = tmp_path / "outer", tmp_path / "inner"
    with files.together(outer):
        files.write_text(outer / "a.txt", "1")
        with files.together(inner):
            files.write_text(inner / "b.txt", "2")
            files.write_text(outer / "c.txt", "3")
            files.publish()
        assert [p for p in names(tmp_path) if p.endswith("txt") and "/." not in p] == []
    assert names(tmp_path) == ["inner", "inner/b.txt", "outer", "outer/a.txt", "outer/c.txt"]


def test_an_inner_block_that_fails_drops_its_own_files_only(tmp_path):
    with files.together(tmp_path):
        files.write_text(tmp_path / "a.txt", "1")
        with pytest.raises(ValueError), files.together(tmp_path / "inner"):
            files.write_text(tmp_path / "inner" / "b.txt", "2")
            raise ValueError
    assert names(tmp_path) == ["a.txt"]


def test_an_outer_block_that_fails_drops_the_files_of_the_inner_one(tmp_path):
    with pytest.raises(ValueError), files.together(tmp_path / "outer"):
        with files.together(tmp_path / "inner"):
            files.write_text(tmp_path / "inner" / "b.txt", "2")
        raise ValueError
    assert names(tmp_path) == []


def test_a_block_is_of_one_thread(tmp_path):
    inside, written = threading.Event(), threading.Event()

    def run():
        with files.together(tmp_path):
            files.write_text(tmp_path / "waits.txt", "1")
            inside.set()
            written.wait(10)

    thread = threading.Thread(target=run)
    thread.start()
    inside.wait(10)
    files.write_text(tmp_path / "at-once.txt", "2")
    with pytest.raises(ValueError), files.together(tmp_path):
        raise ValueError  # drops nothing of the other thread's
    assert [name for name in names(tmp_path) if name[0] != "."] == ["at-once.txt"]
    written.set()
    thread.join()
    assert names(tmp_path) == ["at-once.txt", "waits.txt"]


@pytest.mark.skipif(os.name != "posix", reason="modes of files are POSIX")
@pytest.mark.parametrize("mask", [0o022, 0o077, 0o002])
@pytest.mark.parametrize("waits", [False, True])
def test_who_may_read_is_for_the_umask_to_say(tmp_path, mask, waits):
    before = os.umask(mask)
    try:
        with files.together(tmp_path if waits else tmp_path / "other"):
            files.write_text(tmp_path / "a.txt", "1")
    finally:
        os.umask(before)
    assert stat.S_IMODE((tmp_path / "a.txt").stat().st_mode) == 0o666 & ~mask


def test_a_file_that_waits_is_not_read_from_the_disk(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    files.write_text(tmp_path / "a.txt", "of the run before")
    with files.together(tmp_path):
        assert inputs.read_text("a.txt") == "of the run before"
        files.write_text(tmp_path / "a.txt", "new")
        for name in (tmp_path / "a.txt", "a.txt", tmp_path / "none" / ".." / "a.txt"):
            with pytest.raises(RuntimeError, match=r"a.txt waits to appear"):
                inputs.read_text(name)
        with files.together(tmp_path / "inner"), pytest.raises(RuntimeError):
            inputs.read_text("a.txt")
        files.publish()
        assert inputs.read_text("a.txt") == "new"


def test_names_are_on_the_disk_before_the_summary_tells_of_them(tmp_path, monkeypatch):
    done, replace, fsync = [], Path.replace, os.fsync

    def replaced(self, target):
        done.append(Path(target).name)
        return replace(self, target)

    def synced(handle):
        done.append("folder" if stat.S_ISDIR(os.fstat(handle).st_mode) else "data")
        fsync(handle)

    monkeypatch.setattr(Path, "replace", replaced)
    monkeypatch.setattr(os, "fsync", synced)
    with files.together(tmp_path):
        files.write_text(tmp_path / "summary.json", "{}")
        files.write_text(tmp_path / "a.csv", "1")
        files.write_summary(tmp_path, {}, "hinge", {})
    assert done == ["data", "data", "data", "a.csv", "folder", "summary.json", "folder"]


def test_a_folder_in_the_place_of_a_file_is_refused_before_anything_appears(tmp_path):
    (tmp_path / "b.txt").mkdir()
    with pytest.raises(BadInput, match=r"b.txt: cannot be written .*--out"), files.together(tmp_path):
        files.write_text(tmp_path / "a.txt", "1")
        files.write_text(tmp_path / "b.txt", "2")
    assert names(tmp_path) == ["b.txt"]


def run(folder, command, texts):
    with files.together(folder):
        for name, text in texts.items():
            files.write_text(folder / name, text)
        files.write_summary(folder, {}, command, {"mine.toml": "12", "none.csv": ""})
    return json.loads((folder / "summary.json").read_text())["run"]


def test_what_a_run_before_left_goes_with_it(tmp_path):
    run(tmp_path, "hinge", {"report.html": "1", "guide.csv": "1", "below/guide.csv": "1"})
    (tmp_path / "mine.txt").write_text("kept")
    run(tmp_path, "hinge", {"report.html": "2"})
    assert names(tmp_path) == ["mine.txt", "report.html", "summary.json"]


def test_what_somebody_has_changed_since_stays(tmp_path):
    run(tmp_path, "hinge", {"report.html": "1", "guide.csv": "1"})
    (tmp_path / "guide.csv").write_text("mended by hand")
    run(tmp_path, "hinge", {"report.html": "2"})
    assert names(tmp_path) == ["guide.csv", "report.html", "summary.json"]


def test_files_of_another_command_stay_and_are_told(tmp_path):
    run(tmp_path, "hinge", {"report.html": "1", "guide.csv": "1"})
    other = run(tmp_path, "forces", {"report.html": "2", "forces.csv": "1"})
    assert list(other["beside"]) == ["hinge"] and list(other["beside"]["hinge"]) == ["guide.csv"]
    assert names(tmp_path) == ["forces.csv", "guide.csv", "report.html", "summary.json"]
    again = run(tmp_path, "hinge", {"report.html": "3"})
    assert list(again["beside"]) == ["forces"]
    assert names(tmp_path) == ["forces.csv", "report.html", "summary.json"]


def _slow_run(folder, claimed, until):
    with files.together(folder):
        files.write_text(folder / "a.txt", "theirs")
        files.write_text(folder / "b.txt", "theirs")
        files.write_summary(folder, {}, "hinge", {})
        claimed.set()
        until.wait(60)


@pytest.mark.skipif(sys.platform == "win32", reason="folders cannot be locked there")
def test_two_processes_write_into_a_folder_in_turn(tmp_path):
    """What a summary tells of a folder holds when its files appear: nobody else has written there in between."""
    context = multiprocessing.get_context("spawn")
    claimed, until = context.Event(), context.Event()
    other = context.Process(target=_slow_run, args=(tmp_path, claimed, until))
    other.start()
    assert claimed.wait(60)
    ours = threading.Timer(0.2, until.set)
    ours.start()
    mine = run(tmp_path, "forces", {"a.txt": "ours"})
    assert until.is_set()
    assert list(mine["beside"]["hinge"]) == ["b.txt"]
    assert (tmp_path / "a.txt").read_text() == "ours"
    other.join()
    ours.join()
    assert other.exitcode == 0
    assert names(tmp_path) == ["a.txt", "b.txt", "summary.json"]


def test_a_run_that_fails_removes_nothing(tmp_path):
    run(tmp_path, "hinge", {"guide.csv": "1"})
    with pytest.raises(ValueError), files.together(tmp_path):
        files.write_summary(tmp_path, {}, "hinge", {})
        raise ValueError
    assert names(tmp_path) == ["guide.csv", "summary.json"]


FOREIGN = ["", "[]", "{}", '{"run": 1}', '{"run": {"command": "hinge", "files": ["a.txt"]}}',
           '{"run": {"command": "hinge", "files": {"../a.txt": "DIGEST", "/a.txt": 1}}}']  # fmt: skip


@pytest.mark.parametrize("text", FOREIGN)
def test_a_summary_of_somebody_else_removes_nothing(tmp_path, text):
    folder = tmp_path / "run"
    folder.mkdir()
    for file in (tmp_path / "a.txt", folder / "a.txt"):
        file.write_text("1")
    (folder / "summary.json").write_text(text.replace("DIGEST", hashlib.sha256(b"1").hexdigest()))
    run(folder, "hinge", {})
    assert names(tmp_path) == ["a.txt", "run", "run/a.txt", "run/summary.json"]


def test_a_disk_that_fills_drops_all(tmp_path, monkeypatch):
    def full(handle):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(OSError, match="No space left"):
        run(tmp_path / "run", "hinge", {"a.txt": "1"})
    assert names(tmp_path) == []


def written(folder, value):
    """A run of three files, of which the one before had another third."""
    with files.together(folder):
        for name in ("a.csv", "below/b.svg", f"only-{value}.txt"):
            files.write_text(folder / name, f"{name} {value}")
        files.write_summary(folder, {"value": value}, "hinge", {})


def held(folder):
    return {p.relative_to(folder).as_posix(): p.read_text() for p in folder.rglob("*") if p.is_file()}


# run in a process of its own, in which each call that changes a file fails in its turn
TURNS = """
import contextlib, sys
from pathlib import Path
sys.path.insert(0, "tests")
from fault_shim import Faults
from test_files import held, written
folder, before, does, calls = Path(sys.argv[1]), sys.argv[2] == "held", sys.argv[3], Faults()
old, new = folder / "old", folder / "new"
written(old, 1), written(new, 2)
count = 0
for at in range(1, 60):
    run = folder / f"run{at}"
    run.mkdir()
    if before:
        written(run, 1)
    calls.library.faults_begin()
    calls.want(at, does)
    with contextlib.suppress(Exception):
        written(run, 2)
    calls.library.faults_rest()
    count += bool(calls.kind)
    left = {name: text for name, text in held(run).items() if not Path(name).name.startswith(".")}
    assert left in (held(old) if before else {}, held(new)), (at, calls.kind, sorted(left))
assert count > (15 if does == "once" else 8) and not calls.kind
"""


@pytest.mark.skipif(sys.platform != "linux" or not shutil.which("gcc"), reason="libc is stood before by gcc on Linux")
@pytest.mark.parametrize("before", ["empty", "held"])
@pytest.mark.parametrize("does", ["once", "full"])
def test_a_fault_at_any_call_leaves_the_old_files_or_the_new_ones(tmp_path, before, does):
    (tmp_path / "runs").mkdir()
    assert fault_shim.preloaded(tmp_path, "-c", TURNS, str(tmp_path / "runs"), before, does) == 0


@pytest.mark.slow
@pytest.mark.heavy
@pytest.mark.skipif(sys.platform != "linux" or not shutil.which("gcc"), reason="libc is stood before by gcc on Linux")
def test_faults_of_commands_in_turn():
    assert faults.main(["new", "flywheel", "flywheel-cold", "eval", "sweep", "--most", "20"]) == 0


def test_what_a_killed_process_left_is_swept_up(tmp_path):
    child = subprocess.Popen([sys.executable, "-c", ""])
    child.wait()
    for process, stays in ((child.pid, False), (os.getpid(), True)):
        left = tmp_path / f".a.csv.{transaction._machine()}-{process}-0123abcd"
        left.write_text("half")
        files.write_text(tmp_path / "a.csv", "1")
        assert left.exists() == stays
    other = tmp_path / f".a.csv.ffff-{child.pid}-0123abcd"  # of another machine, which may share the folder
    other.write_text("half")
    written(tmp_path, 1)
    assert other.exists()


def test_a_table_in_pieces_is_that_of_csv(tmp_path, monkeypatch):
    monkeypatch.setattr(files, "_ROWS", 3)
    rng = np.random.default_rng(3)
    numbers = rng.standard_normal(11) * 10.0 ** rng.integers(-20, 20, 11)
    gaps = np.where(np.arange(11) % 4 == 1, np.nan, numbers)
    words = ["", "plain", "a, b", 'a "b"', "two\nlines", "é", "", "", "", "", "last"]
    table = {"x [m]": numbers, "y, as told": gaps, "whole": np.arange(11), "words": words, "never": np.full(11, np.nan)}
    written = files.write_csv(tmp_path / "table.csv", table).read_text(encoding="utf-8")
    expected = io.StringIO()
    rows = zip(numbers, gaps, np.arange(11), words, strict=True)
    csv.writer(expected, lineterminator="\n").writerows(
        [[*table], *([f"{x:.12g}", "" if y != y else f"{y:.12g}", k, w, ""] for x, y, k, w in rows)]
    )
    assert written == expected.getvalue()
    for count in (0, 1):
        alone = files.write_csv(tmp_path / "one.csv", {"words": [""] * count}).read_text(encoding="utf-8")
        assert alone == "words\n" + '""\n' * count
    with pytest.raises(ValueError, match="rows"):
        files.write_csv(tmp_path / "two.csv", {"a": [1.0], "b": [1.0, 2.0]})
