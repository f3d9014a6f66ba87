"""Sweeps that end, whatever happens: points kept in a file, processes that die, the same command again."""

import contextlib
import json
import multiprocessing
import os
import signal
import sqlite3
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.sweep import Means, Plan, failures, store, sweep, work, write_table

PLAN = Plan(case="zotov-89", over=("spring.p0=3..8 MPa:5",), analysis="cycle")
COMMAND = [Path(sys.executable).parent / "mechsym", "sweep", "zotov-89", "--over", "spring.p0=4..8 MPa:30"]
RUNS = ["--show", "check.speed_ripple", "--show", "guide.z_max", "--jobs", "2", "--json"]


def stopped_after(count):
    done = []

    def progress(points):
        done.append(points)
        if sum(done) >= count:
            raise KeyboardInterrupt

    return progress


def rows(folder):
    with sqlite3.connect(folder / store.NAME) as connection:
        return connection.execute("select i, seconds, host from point order by i").fetchall()


def finished(folder):
    """Points in a store that another process may be about to make."""
    try:
        return len(rows(folder)) if (folder / store.NAME).exists() else 0
    except sqlite3.OperationalError:
        return 0


def test_the_same_sweep_goes_on_where_it_stopped(tmp_path):
    whole = sweep(PLAN)
    first = sweep(PLAN, stopped_after(2), Means(folder=tmp_path))
    assert (first.interrupted, first.kept, len(failures(first))) == (True, 0, 3)
    assert [r[0] for r in rows(tmp_path)] == [0, 1] and all(r[1] > 0 and r[2] for r in rows(tmp_path))
    counted = []
    again = sweep(PLAN, counted.append, Means(folder=tmp_path))
    assert (again.interrupted, again.kept, counted) == (False, 2, [1, 1, 1, 1, 1])
    files = [write_table(found, tmp_path / name).read_bytes() for name, found in (("a", whole), ("b", again))]
    assert files[0] == files[1]
    assert sweep(PLAN, means=Means(folder=tmp_path)).kept == 5
    assert sweep(PLAN, means=Means(folder=tmp_path, fresh=True)).kept == 0


def test_gaps_are_kept_with_their_reasons(tmp_path):
    plan = Plan(case="zotov-89", over=("operation.speed=-1,9",), analysis="cycle")
    first, again = (sweep(plan, means=Means(folder=tmp_path)) for _ in range(2))
    assert (again.kept, failures(again)) == (2, failures(first)) and list(failures(again)) == [0]
    assert again.outcomes[0] == first.outcomes[0]
    np.testing.assert_equal(again.outcomes[1], first.outcomes[1])


@pytest.mark.parametrize(
    "other",
    [
        {"over": ("spring.p0=3..8 MPa:6",)},
        {"overrides": {"spring.n": "1.3"}},
        {"show": ("power_kw",)},
        {"over": ("spring.p0=3..8 MPa",), "samples": 5},
    ],
)
def test_another_sweep_begins_anew(tmp_path, other):
    sweep(PLAN, means=Means(folder=tmp_path))
    given = {"case": PLAN.case, "over": PLAN.over, "analysis": PLAN.analysis} | other
    assert sweep(Plan(**given), means=Means(folder=tmp_path)).kept == 0


def test_points_of_an_older_version_are_set_aside(tmp_path):
    """Which kept a row a point; whoever goes back to it finds them."""
    with contextlib.closing(sqlite3.connect(tmp_path / store.NAME)) as connection, connection:
        connection.execute("create table about (name text primary key, value text not null)")
        connection.execute("create table input (path text primary key, digest text not null)")
        connection.execute("create table point (i integer primary key, row text, seconds real, host text)")
        connection.execute("insert into about values ('key', 'older')")
        connection.execute("insert into point values (0, '{}', 1.0, 'here')")
    done = sweep(PLAN, means=Means(folder=tmp_path))
    assert done.kept == 0 and len(rows(tmp_path)) == len(done.outcomes)
    with contextlib.closing(sqlite3.connect(done.aside)) as connection:
        assert connection.execute("select row from point").fetchall() == [("{}",)]


def test_the_points_of_another_sweep_are_set_aside_and_found_again(tmp_path):
    first, other = PLAN, Plan(case=PLAN.case, over=("spring.p0=3..8 MPa:6",), analysis="cycle")
    whole = sweep(first, means=Means(folder=tmp_path))
    moved = sweep(other, means=Means(folder=tmp_path))
    assert (whole.aside, moved.kept) == ("", 0)
    with contextlib.closing(sqlite3.connect(moved.aside)) as connection:
        assert connection.execute("select count(*) from point").fetchone() == (5,)
    again = sweep(first, means=Means(folder=tmp_path))
    assert again.kept == 5 and not Path(moved.aside).exists()
    np.testing.assert_equal(list(again.outcomes), list(whole.outcomes))
    assert sweep(other, means=Means(folder=tmp_path, fresh=True)).kept == 0
    assert sorted(p.name for p in tmp_path.iterdir()) == [Path(moved.aside).name, store.NAME]


def test_a_changed_file_begins_anew(tmp_path):
    case = tmp_path / "mine.toml"
    case.write_text(cases.text("zotov-89"), encoding="utf-8")
    plan = Plan(case=str(case), over=PLAN.over, analysis="cycle")
    sweep(plan, means=Means(folder=tmp_path))
    assert sweep(plan, means=Means(folder=tmp_path)).kept == 5
    case.write_text(cases.text("zotov-89") + "\n# another word\n", encoding="utf-8")
    assert sweep(plan, means=Means(folder=tmp_path)).kept == 0


def test_what_is_no_store_is_refused(tmp_path):
    (tmp_path / store.NAME).write_text("no database, but long enough to be read as one" * 20, encoding="utf-8")
    with pytest.raises(BadInput, match="sweep.db: no store of a sweep .* remove it"):
        sweep(PLAN, means=Means(folder=tmp_path))


def test_two_may_not_write_one_store(tmp_path):
    sweep(PLAN, means=Means(folder=tmp_path))
    with store.opened(tmp_path, "key") as held:
        held.connection.execute(
            "update about set value = ? where name = 'writer'", (f"{store.socket.gethostname()} 1",)
        )
        with pytest.raises(BadInput, match="process 1 is writing it"):
            sweep(PLAN, means=Means(folder=tmp_path))
    # a writer that was killed holds nothing
    with sqlite3.connect(tmp_path / store.NAME) as connection:
        connection.execute(
            "insert or replace into about values ('writer', ?)", (f"{store.socket.gethostname()} 4194999",)
        )
    assert sweep(PLAN, means=Means(folder=tmp_path)).kept == 5


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="the state of a process is read from /proc")
def test_a_dead_writer_that_nobody_has_waited_for_holds_nothing(tmp_path):
    sweep(PLAN, means=Means(folder=tmp_path))
    with subprocess.Popen([sys.executable, "-c", ""]) as writer:
        while Path(f"/proc/{writer.pid}/stat").read_text().rpartition(")")[2].split()[0] != "Z":
            time.sleep(0.01)
        with sqlite3.connect(tmp_path / store.NAME) as connection:
            name = f"{store.socket.gethostname()} {writer.pid}"
            connection.execute("insert or replace into about values ('writer', ?)", (name,))
        assert sweep(PLAN, means=Means(folder=tmp_path)).kept == 5


ORDER = work.SweepOrder(case="zotov-89", overrides={}, analysis="cycle", show=())


def chunk(*values):
    return work.Chunk(members=tuple(range(len(values))), heres=tuple({"spring.p0": v} for v in values))


class Deadly:
    """Ends the process that unpacks it."""

    def __reduce__(self):
        return os._exit, (3,)


@pytest.mark.slow
def test_a_point_that_kills_is_a_gap_and_the_others_are_not():
    chunks = [chunk("5 MPa", Deadly(), "6 MPa"), work.Chunk(members=(3,), heres=({"spring.p0": "7 MPa"},))]
    found = {}
    for done in work.on_processes(ORDER, chunks, 2, threading.Event()):
        found |= dict(zip(done.members, done.outcomes, strict=True))
    assert sorted(found) == [0, 1, 2, 3]
    assert found[1].reason == "the process that computed it died twice (exit status 3)" and not found[1].of_input
    alone = {i: work.computed(ORDER, work.route(cases.load("zotov-89"), "cycle"), [{"spring.p0": f"{p} MPa"}])[0]
             for i, p in ((0, 5), (2, 6), (3, 7))}  # fmt: skip
    np.testing.assert_equal({i: found[i] for i in alone}, alone)


@pytest.mark.slow
def test_a_worker_that_is_killed_once_leaves_no_trace():
    plan = Plan(case="zotov-89", over=("spring.p0=4..8 MPa:12",), show=("check.speed_ripple",))
    killed = []

    def progress(points):
        if not killed:
            killed.append(multiprocessing.active_children()[0].pid)
            os.kill(killed[0], signal.SIGKILL)

    found = sweep(plan, progress, Means(jobs=2))
    assert killed and failures(found) == {}
    assert found.outcomes == sweep(plan).outcomes


@pytest.mark.slow
def test_a_script_that_asks_for_no_name_may_sweep(tmp_path):
    script = tmp_path / "mine.py"
    script.write_text("""
from mechsym.sweep import Means, Plan, failures, sweep
found = sweep(Plan(case="zotov-89", over=("spring.p0=3..8 MPa:70",)), means=Means(jobs=2))
print(len(found.outcomes), failures(found))
""")
    done = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert done.stdout == "70 {}\n"


@pytest.mark.slow
def test_a_mistake_in_a_worker_comes_back():
    with pytest.raises(TypeError, match="'int' object") as told:
        list(work.on_processes(ORDER, [work.Chunk(members=(0,), heres=(7,))], 1, threading.Event()))  # type: ignore
    assert "Traceback" in told.value.__notes__[0]


@pytest.mark.slow
def test_kill_9_and_the_same_command_again(tmp_path):
    whole = subprocess.run([*COMMAND, *RUNS, "--out", tmp_path / "whole"], capture_output=True, text=True, check=True)
    with subprocess.Popen([*COMMAND, *RUNS, "--out", tmp_path / "cut"], stdout=subprocess.DEVNULL) as process:
        try:
            while finished(tmp_path / "cut") < 5:
                time.sleep(0.1)
            children = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        finally:
            process.kill()
    end = time.monotonic() + 10
    while any(Path(f"/proc/{child}").exists() for child in children):
        assert time.monotonic() < end, "workers outlive their parent"
        time.sleep(0.1)
    again = subprocess.run([*COMMAND, *RUNS, "--out", tmp_path / "cut"], capture_output=True, text=True, check=True)
    reports = [json.loads(run.stdout) for run in (whole, again)]
    assert reports[0]["kept"] == 0 and 5 <= reports[1]["kept"] < 30
    assert reports[0]["data"] == reports[1]["data"]
    for name in ("sweep.csv", "sweep.nc"):
        assert (tmp_path / "cut" / name).read_bytes() == (tmp_path / "whole" / name).read_bytes()
