"""Faults in turn: what a command leaves when the n-th call that changes a file fails, for every n.

`make faults [ONLY="hinge export"]` runs commands into an empty folder and into one that holds an earlier run with
another value. Between Python and the system stands `faults.c`: each open, write, fsync, rename, link, removal and new
folder is counted, those of SQLite too, and so is each process that starts, each compiler and each solver that is
allocated. The n-th of them fails once (`once`), or from it on the disk is full (`full`), or the process is killed
(`kill`) or interrupted (`interrupt`) there. Afterwards the folder holds the old set whole or the new one, summaries
tell of the files that are there, no point of a sweep is lost, the next run leaves no temporary file, and the exit
status is the documented one. A process forks where the fault is to come: what was computed until there is shared. None
forks inside SQLite, whose locks belong to one process; one that does not end in time is killed and told as a hang.
"""

import argparse
import contextlib
import importlib
import io
import itertools
import json
import math
import os
import select
import shutil
import signal
import sys
import tempfile
import threading
import time
import traceback
from collections import Counter
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))

from fault_places import COLD, COMMANDS, Place, alike, mixed  # noqa: E402
from fault_shim import DOES, Faults, patched, preloaded  # noqa: E402

WRONG = ("mixtures", "losses", "hangs", "others")  # of what is wrong
SLACK = 0.05  # to judge what was left, and to begin again [s]
LIMIT = 180  # for what goes on after a fault; the slowest command takes seconds [s]
HUNG = "hangs"  # in the place of an exit status


class Command:
    """A command in its place, run whole or to a fault."""

    def __init__(self, name, faults, place):
        self.text, self.values = (COMMANDS | COLD)[name]
        self.faults, self.place, self.at_end = faults, place, None
        self.tried = set()

    def words(self, value):
        return [part.replace("{}", value) for part in self.text.split()]

    def forked(self, work, at_end=None, limit=LIMIT):
        """What a process says at the end of its `work`, or of what it goes on with; how it ended if it was killed."""
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            os.setpgid(0, 0)
            signal.set_wakeup_fd(-1)  # that of the first process would tell it too
            os.close(reading)
            self.at_end = lambda status, said: tell_all(
                writing, at_end(status, said) if at_end else [status, said, self.faults.kind]
            )
            work()
            return None
        os.close(writing)
        said = heard(reading, limit)
        if said is None:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(child, signal.SIGKILL)
        _, ended = os.waitpid(child, 0)
        if said is None:
            return [HUNG, f"does not end in {limit} s", ""]
        return json.loads(said) if said else [os.waitstatus_to_exitcode(ended), "", ""]

    def run(self, value, tell=None, at_end=None, limit=LIMIT):
        """Run it in a process of its own: exit status, what it said, kind of the call that failed."""
        return self.forked(lambda: self.whole(value, tell), at_end, limit)

    def whole(self, value, tell):
        """Run it in this process, which ends."""
        errors = io.StringIO()
        status = 70
        with contextlib.suppress(BaseException):
            os.chdir(self.place.folder)
            os.environ["XDG_CACHE_HOME"] = str(self.place.folder / "cache" if self.place.cold else WARM_CACHE)
            tempfile.tempdir = str(self.place.folder / "tmp")
            sys.argv = ["mechsym", *self.words(value)]
            os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
            self.faults.tell(tell)
            self.faults.library.faults_begin()
            with contextlib.redirect_stderr(errors):
                status = exit_status()
        self.faults.library.faults_rest()
        self.at_end(status, errors.getvalue()[-3000:])
        os._exit(0)


def heard(pipe, limit):
    """All that comes out of a pipe until it is closed; None where that takes longer."""
    said, until = b"", time.monotonic() + limit
    with os.fdopen(pipe, "rb", buffering=0) as stream:
        while select.select([stream], [], [], max(0.0, until - time.monotonic()))[0]:
            if not (more := stream.read(65536)):
                return said
            said += more
    return None


def tell_all(pipe, value):
    with os.fdopen(pipe, "wb") as stream:
        stream.write(json.dumps(value).encode())


class Runner:
    """A process that runs the command again, as a user would who finds no other process of his alive."""

    def __init__(self, command):
        self.requests, self.answers = os.pipe(), os.pipe()
        self.process = os.fork()
        if self.process == 0:
            from mechsym import transaction

            transaction._lives = lambda process: process == os.getpid()
            os.close(self.requests[1])
            while os.read(self.requests[0], 1):
                os.write(self.answers[1], json.dumps(command.run(command.values[1])).encode() + b"\n")
            os._exit(0)

    def again(self):
        os.write(self.requests[1], b".")
        said = b""
        while not said.endswith(b"\n"):
            said += os.read(self.answers[0], 65536)
        return json.loads(said)

    def end(self):
        os.close(self.requests[1])
        os.waitpid(self.process, 0)


WARM_CACHE = ""


def exit_status():
    from mechsym.cli import main

    try:
        main()
    except SystemExit as end:
        return end.code or 0
    except BaseException:
        sys.stderr.write(traceback.format_exc())
        return 70
    return 0


def calls(command, value):
    """Of each call in turn whether a process may fork there, and when: nothing is half written, no other thread at it.

    The last row is the end.
    """
    seen, temporary = [], command.place.folder / "tmp"

    def tell(count, watching):
        may = watching == 0 and not any(temporary.iterdir()) and is_first_thread()
        seen.append((may, time.monotonic()))

    return command.run(value, tell, lambda *_: [*seen, (False, time.monotonic())])


def is_first_thread():
    return threading.get_native_id() == os.getpid()


def series(command, value, state, asked, judge, new):
    """All faults of a command in turn, by one process that forks at each; rows: calls, number, does, kind, why."""
    place = command.place
    *seen, (_, end) = calls(command, value)
    place.back(state)
    if not seen:  # what is kept of the run before serves this one
        return []
    kinds = asked.does.split(",")
    # a process can go on from where the folder was as it is kept
    ready = [1] + [n for n, (may, _) in enumerate(seen, 1) if may and n > 1]
    after = dict(zip(ready, [*ready[1:], len(seen) + 1], strict=True))
    # every n-th, where all of them from there to the end would take too long
    took = sum((last - n) * (end - seen[n - 1][1] + SLACK) for n, last in after.items())
    every = max(asked.every, math.ceil(len(kinds) * took / asked.most))
    rows, began = [], time.monotonic()

    def tell(count, watching):
        if count not in after or not is_first_thread():
            return
        wanted = [n for n in range(count, after[count]) if n % every == every // 2]
        if not wanted:
            return
        place.keep("here")
        for n, what in itertools.product(wanted, kinds):
            if time.monotonic() - began < asked.most:
                answer = command.forked(lambda n=n, what=what: faulty(n, what))
                if answer is None:
                    return  # in the child, which goes on to its fault
                status, said, kind = answer
                if kind or what == "kill" or status == HUNG:
                    rows.append((n, what, kind, judge(status, said, kind, what)))
                place.back("here")

    def faulty(n, what):
        command.faults.tell(None)
        command.faults.want(n, what)

    answer = command.run(value, tell, lambda *ended: [*rows, ended], asked.most + 3 * LIMIT)
    if answer[0] == HUNG:
        return [(len(seen), 0, "none", "", f"{HUNG}: {answer[1]}")]
    *rows, (status, said) = answer
    now = place.results()
    if now != new:
        other = [name for name in {*now, *new} if now.get(name) != new.get(name)]
        rows.append((0, "none", "", f"a mixture: without a fault other {other}, exit {status} {said[-100:]}"))
    return [(len(seen), *row) for row in rows]


def faults_of(name, scratch, asked):
    """Rows of state of the folder, calls, number, what it does, kind of call, what is wrong (empty: nothing)."""
    faults = Faults()
    place = Place(scratch / name, name in COLD)
    command = Command(name, faults, place)
    first, second = command.values
    if "trace.csv" in command.text:
        shutil.copy(TRACE, place.folder / "trace.csv")
    place.keep("empty")
    command.runner = Runner(command)
    run_well(command, first)
    place.keep("held")
    for state in ("empty", "held"):
        place.back(state)
        old, old_points = place.results(), place.points()
        usual = run_well(command, second)
        new = place.results()
        place.back(state)

        def judge(status, said, kind, what, sets=(old, new), points=old_points, usual=usual):
            return judged(command, (status, said, kind, what), sets, points, usual)

        yield from ((state, *row) for row in series(command, second, state, asked, judge, new))
        place.back(state)
    command.runner.end()


def run_well(command, value):
    status, said, _ = command.run(value)
    if status not in (0, 1):
        raise SystemExit(f"{command.words(value)}: {said}")
    return status


def judged(command, answer, sets, old_points, usual):
    """What is wrong after a fault; empty: nothing."""
    place, (status, said, kind, what), (old, new) = command.place, answer, sets
    now = place.results()
    whole = "new" if now == new else "old" if now == old else ""
    certified = "run/summary.json" in now and not mixed(place.folder)
    if not whole and (place.cold or kind in ("fork", "compile", "solver")) and alike(now, new, certified):
        whole = "new"
    if status == HUNG:
        return f"{HUNG}: {said}"
    if "Traceback" in said:
        return f"traceback: {said.strip()[-300:]}"
    if unsound := place.unsound():
        return f"a loss: the cache holds {unsound[0]}"
    if old_points - place.points():
        return "a loss: points of a sweep"
    strangers = sorted(k for k in now if now[k] not in (old.get(k), new.get(k)))
    if what == "kill":
        if strangers:
            return f"a loss: {', '.join(strangers)}"
        if not whole and certified:
            return "a mixture that its summary certifies"
    else:
        # what a sweep had finished is a set of its own, which says so
        stopped = what == "interrupt" and status == 130 and b'"interrupted": true' in now.get("run/summary.json", b"")
        if not whole and not stopped:
            return f"a mixture: {', '.join(strangers) or 'parts of both sets'} (exit {status})"
        if wrong := mixed(place.folder):
            return f"a mixture: the summary tells of other {', '.join(wrong)}"
        right = (usual, 130) if what == "interrupt" else (usual, 74)
        if status not in right:
            return f"exit {status}: {said[-200:]}"
        if status == usual and whole != "new":
            return "a loss: says done, and holds the old set"
    # what the next run finds; it is tried once of a kind
    left = (
        tuple(name for name in now if now[name] == new.get(name)),
        tuple(now),
        whole,
        bool(place.hidden()),
        place.cold,
    )
    if (place.hidden() or not whole) and left not in command.tried:
        command.tried.add(left)
        again, said, _ = command.runner.again()
        if place.hidden():
            return f"{place.hidden()[0]} stays"
        if "exists; choose another" in said:  # a part of it is there, and `new` writes over nothing
            return ""
        if again != usual or place.results() != new:
            now = place.results()
            other = sorted(name for name in {*now, *new} if now.get(name) != new.get(name))
            return f"a loss: the next run ends with {again}, other {', '.join(other)} {said[-200:]}"
    return ""


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", default=[*COMMANDS, *COLD])
    parser.add_argument("--does", default=",".join(DOES), help="of " + ", ".join(DOES))
    parser.add_argument("--every", type=int, default=1, help="only each so many-th call")
    parser.add_argument("--most", type=float, default=60.0, help="time for one command in one folder [s]")
    asked = parser.parse_args(arguments)
    if "faults" not in os.environ.get("LD_PRELOAD", ""):
        with tempfile.TemporaryDirectory() as folder:
            return preloaded(folder, "-m", "tests.faults", *(sys.argv[1:] if arguments is None else arguments))
    del os.environ["LD_PRELOAD"]  # not for the compilers that are called
    from matrix.__main__ import WARM

    for module in (*WARM, "sympy", "mechsym.derive.files", "mechsym.out.fmi", "mechsym.out.web", "sqlite3"):
        importlib.import_module(module)  # once, not in every process
    global WARM_CACHE, TRACE
    total, bad = Counter(), Counter()
    with tempfile.TemporaryDirectory() as scratch:
        scratch = Path(scratch).resolve()
        WARM_CACHE = scratch / "cache"
        os.environ["MPLCONFIGDIR"] = str(scratch / "matplotlib")
        patched(Faults())
        TRACE = traced(scratch)
        print(f"{'command':14} {'calls':>6} {' '.join([f'{d:>9}' for d in DOES] + [f'{k:>8}' for k in WRONG])}  time/s",
              flush=True)  # fmt: skip
        for name in asked.names:
            began = time.monotonic()
            rows = list(faults_of(name, scratch, asked))
            counts = Counter(what for _, _, _, what, *_ in rows)
            every = sum(dict(row[:2] for row in rows).values())
            wrong = Counter(next((k for k in WRONG if k[:-2] in why), "others") for *_, why in rows if why)
            total.update(counts)
            bad.update(wrong)
            columns = [f"{every:6}", *(f"{counts[d]:9}" for d in DOES)] + [f"{wrong[k]:8}" for k in WRONG]
            print(f"{name:14} {' '.join(columns)}  {time.monotonic() - began:6.0f}", flush=True)
            for state, _, n, what, kind, why in rows:
                if why:
                    print(f"  {state} {what} {n} {kind}: {why}", flush=True)
    print(f"{sum(total.values())} faults injected ({dict(total)}), {dict(bad)}")
    return 1 if sum(bad.values()) else 0


def traced(scratch):
    """A trace for `identify`."""
    place = Place(scratch / "traced", cold=False)
    command = Command("simulate-cold", Faults(), place)
    command.text = "simulate chmielewski --set t_end={} --set simulation.window=1 --out run"
    run_well(command, "3")
    return place.folder / "run" / "series.csv"


if __name__ == "__main__":
    sys.exit(main())
