"""Faults in turn: what a command leaves when the n-th call that changes a file fails, for every n.

`make faults [ONLY="hinge export"]` runs commands into an empty folder and into one that holds an earlier run with
another value. Between Python and the system stands `faults.c`: each open, write, fsync, rename, link, removal and new
folder is counted, those of SQLite too, and so is each process that starts, each compiler and each solver that is
allocated. The n-th of them fails once (`once`), or from it on the disk is full (`full`), or the process is killed
(`kill`) or interrupted (`interrupt`) there. Afterwards the folder holds the old set whole or the new one, summaries
tell of the files that are there, no point of a sweep is lost, the next run leaves no temporary file, and the exit
status is the documented one. A process forks where the fault is to come: what was computed until there is shared.
"""

import argparse
import contextlib
import ctypes
import errno
import importlib
import io
import itertools
import json
import os
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import traceback
from collections import Counter
from pathlib import Path

from mechsym import files

ROOT = Path(__file__).parents[1]
SOURCE = Path(__file__).with_name("faults.c")
DOES = ("once", "full", "kill", "interrupt")
WRONG = ("mixtures", "losses", "others")  # of what is wrong
#: words of a command, with {} for the value that an earlier run has otherwise: its two values
COMMANDS = {
    "audit": ("audit --formula {} --against hypocycloid.x --out run", ("2*e*(1-cos(theta))", "2*e*(1-sin(theta))")),
    "balance": ("balance opposed-pistons --set operation.speed={} --out run", ("2000rpm", "2100rpm")),
    "compare": ("compare nunes-slider-crank nunes-hypocycloid --speeds {} --out run", ("2000,4000", "2000,5000")),
    "cycle": ("cycle zotov-89 --set operation.speed={} --out run", ("80rpm", "89rpm")),
    "derive": ("derive ./v_twin.py --out run", ("", "")),
    "export-others": ("export zotov-89 --set parameters.r1={} --to modelica,matlab --out run", ("0.3", "0.31")),
    "export": ("export zotov-89 --set parameters.r1={} --to c,julia --out run", ("0.3", "0.31")),
    "flywheel": ("flywheel zotov-89 --ripple {} --out run", ("3%", "2%")),
    "fmu": ("fmu chmielewski --set parameters.k1={} --platforms none --out run.fmu", ("8000", "9000")),
    "forces": ("forces zotov-89 --set operation.speed={} --out run", ("80rpm", "89rpm")),
    "guide": ("guide zotov-89 --set spring.p0={} --sheet run.svg", ("8MPa", "8.1MPa")),
    "hinge": ("hinge zotov-89 --set spring.p0={} --set trials.turns=4 --out run", ("8MPa", "8.1MPa")),
    "new": ("new engine {} --kind inline --bore 86mm --stroke 86mm --out run", ("mine", "yours")),
    "new-mechanism": ("new mechanism {} --out run", ("press", "lever")),
    "page": ("page chmielewski --set parameters.k1={} --out run.html", ("8000", "9000")),
    "report": ("report chmielewski --set parameters.k1={} --out run.html", ("8000", "9000")),
    "reproduce": ("reproduce prymak --out run", ("", "")),
    "simulate": ("simulate zotov-89 --set simulation.turns={} --out run", ("1", "2")),
    "size": ("size nunes-slider-crank --set operation.speed={} --out run", ("2000rpm", "2100rpm")),
    "study": ("study {}.toml --jobs 1 --out run", ("first", "second")),
    "sweep": ("sweep zotov-89 --of cycle --over spring.p0={} --jobs 1 --out run", ("8,8.1MPa", "8.2,8.3MPa")),
    "optimise": ("optimise nunes-hypocycloid --set operation.speed={} --out run", ("3000rpm", "3100rpm")),
    "identify": ("identify chmielewski --trace trace.csv --free {} --out run", ("I2", "k1")),
    "codesign": ("codesign zotov-89 --ripple {} --speeds 89 --losses none --out run", ("5%", "6%")),
}
#: the same with nothing in the cache, where what is compiled and derived is kept
COLD = {
    "eval": ("eval ./v_twin.py --case v-twin.toml", ("", "")),
    "flywheel-cold": COMMANDS["flywheel"],
    "simulate-cold": ("simulate chmielewski --set t_end={} --set simulation.window=1 --out run", ("2", "3")),
}
STUDY = """title = "Two"
case = "zotov-89"
of = "cycle"
[[sweep]]
name = "pressure"
over = ["spring.p0=VALUE"]
[[sweep]]
name = "speed"
over = ["operation.speed=80,89rpm"]
"""


class Faults:
    """The library between Python and the system."""

    def __init__(self):
        self.library = ctypes.CDLL(None)
        self.library.faults_kind.restype = ctypes.c_char_p
        self.tell_type = ctypes.CFUNCTYPE(None, ctypes.c_long, ctypes.c_int)
        self.told = None

    def tell(self, function):
        self.told = self.tell_type(function) if function else None  # kept alive
        self.library.faults_tell(self.told)

    def want(self, at, does):
        self.library.faults_want(ctypes.c_long(at), DOES.index(does))

    @property
    def kind(self):
        return self.library.faults_kind().decode() if self.library.faults_fired() else ""

    def asks(self, word):
        return bool(self.library.faults_ask(word.encode()))


def preloaded(folder, *words):
    """Python with the library loaded before all others."""
    library = Path(folder) / "faults.so"
    subprocess.run(["gcc", "-O1", "-shared", "-fPIC", str(SOURCE), "-o", str(library), "-ldl"], check=True)
    environment = {"LD_PRELOAD": str(library), "PYTHONDONTWRITEBYTECODE": "1", "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.run([sys.executable, *words], cwd=ROOT, check=False, env=os.environ | environment).returncode


def patched(faults):
    """Let processes, compilers and solvers fail in their turn too."""
    import casadi
    import scipy.integrate
    import scipy.sparse.linalg

    from mechsym.native import compiler

    def failing(owner, name, word, error):
        function = getattr(owner, name)

        def shim(*args, **options):
            if faults.asks(word):
                raise error()
            return function(*args, **options)

        setattr(owner, name, shim)

    def broken(command, what, target, folder=None, call=compiler.call):
        call(command, what, target, folder)
        if faults.asks("compile"):
            target.write_bytes(target.read_bytes()[:100])

    compiler.call = broken
    failing(subprocess.Popen, "__init__", "fork", lambda: OSError(errno.EAGAIN, os.strerror(errno.EAGAIN)))
    for owner, name in ((casadi, "nlpsol"), (casadi, "qpsol"), (casadi, "conic"), (casadi, "rootfinder"),
                        (casadi, "integrator"), (scipy.sparse.linalg, "splu"),
                        (scipy.integrate.OdeSolver, "__init__")):  # fmt: skip
        failing(owner, name, "solver", MemoryError)


class Place:
    """A folder with what a command reads and leaves, its cache and its temporary files."""

    def __init__(self, folder, cold):
        self.folder, self.cold = folder, cold
        folder.mkdir()
        for name in ("v_twin.py", "v-twin.toml"):
            shutil.copy(ROOT / "examples/mechanisms" / name, folder)
        (folder / "tmp").mkdir()
        for name, value in (("first", "8,8.1MPa"), ("second", "8.2,8.3MPa")):
            (folder / f"{name}.toml").write_text(STUDY.replace("VALUE", value))

    def keep(self, name):
        """Keep the folder as it is under a name."""
        kept = self.folder.with_name(f"{self.folder.name}-{name}")
        shutil.rmtree(kept, ignore_errors=True)
        shutil.copytree(self.folder, kept)

    def back(self, name):
        """The folder as it was kept."""
        for path in self.folder.iterdir():
            shutil.rmtree(path) if path.is_dir() else path.unlink()
        shutil.copytree(self.folder.with_name(f"{self.folder.name}-{name}"), self.folder, dirs_exist_ok=True)

    def results(self):
        """Files that a command has left, by name; of a store of points nothing, see `points`."""
        return {p.relative_to(self.folder).as_posix(): lasting(p) for p in sorted(self.folder.rglob("*"))
                if p.is_file() and p.relative_to(self.folder).parts[0].startswith(("run", "trace"))
                and not p.name.startswith(".") and ".db" not in p.name}  # fmt: skip

    def points(self):
        """Finished points of all stores."""
        rows = set()
        for store in self.folder.glob("run/**/*.db"):
            with (
                contextlib.closing(sqlite3.connect(store)) as connection,
                contextlib.suppress(sqlite3.OperationalError),
            ):
                rows |= set(connection.execute("select i, row from point").fetchall())
        return rows

    def hidden(self):
        return [p.name for p in self.folder.rglob(".*") if p.is_file()] + [
            p.name for p in self.folder.rglob(".*") if p.is_dir()
        ]

    def unsound(self):
        """Files of the cache whose name tells of another content; what is still being built is hidden."""
        cache = self.folder / "cache"
        every = [p for p in cache.rglob("*") if p.suffix in (".so", ".json")]
        kept = [p for p in every if not any(part.startswith(".") for part in p.relative_to(cache).parts)]
        return [p.name for p in kept if not files.digest(p.read_bytes()).startswith(p.stem.rpartition("-")[2])]


def lasting(path):
    """What is in a file; of a summary the numbers that do not differ from run to run."""
    if path.name != "summary.json":
        return path.read_bytes()
    from matrix.record import rounded

    return json.dumps(rounded(json.loads(path.read_bytes())), sort_keys=True).encode()


_NUMBER = re.compile(rb"-?\d+\.?\d*(?:e[-+]?\d+)?")


def alike(one, other):
    """Whether two sets of files tell the same, their numbers but for round-off: another way computed them."""
    if one.keys() != other.keys():
        return False
    for name, text in one.items():
        a, b = (_NUMBER.sub(b"#", _HASH.sub(b"", t)) for t in (text, other[name]))
        x, y = (list(map(float, _NUMBER.findall(_HASH.sub(b"", t)))) for t in (text, other[name]))
        if a != b or any(abs(u - v) > 1e-6 * max(abs(u), abs(v), 1e-3) for u, v in zip(x, y, strict=True)):
            return False
    return True


_HASH = re.compile(rb"[0-9a-f]{16,}")


def mixed(folder):
    """Files of which a summary tells otherwise."""
    wrong = []
    for summary in Path(folder).glob("run/**/summary.json"):
        listed = json.loads(summary.read_bytes()).get("run", {}).get("files", {})
        wrong += [n for n, said in listed.items() if not (summary.parent / n).is_file()
                  or files.digest((summary.parent / n).read_bytes()) != said]  # fmt: skip
    return wrong


class Command:
    """A command in its place, run whole or to a fault."""

    def __init__(self, name, faults, place):
        self.text, self.values = (COMMANDS | COLD)[name]
        self.faults, self.place, self.at_end = faults, place, None
        self.tried = set()

    def words(self, value):
        return [part.replace("{}", value) for part in self.text.split()]

    def forked(self, work, at_end=None):
        """What a process says at the end of its `work`, or of what it goes on with; how it ended if it was killed."""
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            signal.set_wakeup_fd(-1)  # that of the first process would tell it too
            os.close(reading)
            self.at_end = lambda status, said: tell_all(
                writing, at_end(status, said) if at_end else [status, said, self.faults.kind]
            )
            work()
            return None
        os.close(writing)
        with os.fdopen(reading, "rb") as pipe:
            said = pipe.read()
        _, ended = os.waitpid(child, 0)
        return json.loads(said) if said else [os.waitstatus_to_exitcode(ended), "", ""]

    def run(self, value, tell=None, at_end=None):
        """Run it in a process of its own: exit status, what it said, kind of the call that failed."""
        return self.forked(lambda: self.whole(value, tell), at_end)

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
    """Of each call in turn whether a file or a temporary folder is in use."""
    seen, temporary = [], command.place.folder / "tmp"
    return command.run(
        value, lambda count, watching: seen.append(watching > 0 or any(temporary.iterdir())), lambda *_: seen
    )


def series(command, value, state, asked, judge, new):
    """All faults of a command in turn, by one process that forks at each; rows of number, does, kind, why."""
    place = command.place
    seen = calls(command, value)
    place.back(state)
    # a process can go on from where the folder was as it is kept, and no file half written
    ready = [1] + [n for n, watching in enumerate(seen, 1) if not watching and n > 1]
    after = dict(zip(ready, [*ready[1:], len(seen) + 1], strict=True))
    rows, began = [], time.monotonic()

    def tell(count, watching):
        if count not in after:
            return
        wanted = [n for n in range(count, after[count]) if n % asked.every == 0]
        if not wanted:
            return
        place.keep("here")
        for n, what in itertools.product(wanted, asked.does.split(",")):
            if time.monotonic() - began < asked.most:
                answer = command.forked(lambda n=n, what=what: faulty(n, what))
                if answer is None:
                    return  # in the child, which goes on to its fault
                status, said, kind = answer
                if kind or what == "kill":
                    rows.append((n, what, kind, judge(status, said, kind, what)))
                place.back("here")

    def faulty(n, what):
        command.faults.tell(None)
        command.faults.want(n, what)

    *rows, (status, said) = command.run(value, tell, lambda *ended: [*rows, ended])
    now = place.results()
    if now != new:
        other = [name for name in {*now, *new} if now.get(name) != new.get(name)]
        rows.append((0, "none", "", f"a mixture: without a fault other {other}, exit {status} {said[-100:]}"))
    return rows


def faults_of(name, scratch, asked):
    """Rows of state of the folder, number, what it does, kind of call, what is wrong (empty: nothing)."""
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
    if not whole and (place.cold or kind in ("fork", "compile", "solver")) and alike(now, new):
        whole = "new"
    if "Traceback" in said:
        return f"traceback: {said.strip().splitlines()[-1][:200]}"
    if unsound := place.unsound():
        return f"a loss: the cache holds {unsound[0]}"
    if old_points - place.points():
        return "a loss: points of a sweep"
    strangers = sorted(k for k in now if now[k] not in (old.get(k), new.get(k)))
    if what == "kill":
        if strangers:
            return f"a loss: {', '.join(strangers)}"
        if not whole and "run/summary.json" in now and not mixed(place.folder):
            return "a mixture that its summary certifies"
    else:
        if not whole:
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
            return f"a loss: the next run ends with {again} {said[-200:]}"
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
    sys.path.insert(0, str(Path(__file__).parent))
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
        print(f"{'command':14} {' '.join([f'{d:>9}' for d in DOES] + [f'{k:>8}' for k in WRONG])}  time/s", flush=True)
        for name in asked.names:
            began = time.monotonic()
            rows = list(faults_of(name, scratch, asked))
            counts = Counter(what for _, _, what, _, _ in rows)
            wrong = Counter(next((k for k in WRONG if k[:-2] in why), "others") for *_, why in rows if why)
            total.update(counts)
            bad.update(wrong)
            columns = [f"{counts[d]:9}" for d in DOES] + [f"{wrong[k]:8}" for k in WRONG]
            print(f"{name:14} {' '.join(columns)}  {time.monotonic() - began:6.0f}", flush=True)
            for state, n, what, kind, why in rows:
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
