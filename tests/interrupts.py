"""Ctrl-C at random times: each command ends within a second, says so, and keeps what is finished.

`make interrupts [ONLY="sweep study"] [TIMES=20]` starts each command TIMES times, interrupts it somewhere between the
start of Python and its usual end, and prints a table: the latest end after the interrupt, and what was wrong.
"""

import argparse
import contextlib
import json
import os
import random
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from mechsym import files

ROOT = Path(__file__).parents[1]
LATEST = 1.0  # from the interrupt to the end of the process [s]
START = 0.2  # of Python itself, which the package has no part in [s]
#: words of commands, OUT a folder for files; each does its own work long enough to be met by an interrupt
COMMANDS = {
    "app": "app zotov-89 --check",
    "audit": "audit --source zotov2024",
    "cases": "cases",
    "check": "check zotov-89 --json",
    "codesign": "codesign zotov-89 --ripple 3% --speeds 75,89,105 --out OUT",
    "compare": "compare nunes-slider-crank nunes-hypocycloid --out OUT",
    "cycle": "cycle generator-breathing --speeds 2000,3000 --out OUT",
    "derive": "derive FILE --check",
    "eval": "eval crosshead --case zotov-89 --set phi=1",
    "export": "export zotov-89 --to c,julia --out OUT",
    "flywheel": "flywheel zotov-89 --ripple 2% --out OUT",
    "fmu": "fmu chmielewski --out OUT.fmu",
    "forces": "forces zotov-89 --out OUT",
    "guide": "guide zotov-89 --sheet OUT.svg",
    "hinge": "hinge zotov-89 --loads 0.5,1 --out OUT",
    "identify": "identify chmielewski --trace TRACE --free I2,k1 --out OUT",
    "mechanisms": "mechanisms",
    "native": "native --info",
    "new": "new engine --kind inline --bore 86mm --stroke 86mm --out OUT",
    "optimise": "optimise nunes-hypocycloid --out OUT",
    "page": "page zotov-89 --out OUT.html",
    "report": "report zotov-89 --out OUT.html",
    "prove": "prove crosshead --samples 100000",
    "prove-motion": "prove chmielewski --t-end 2 --out OUT",
    "reproduce": "reproduce zotov2024 --out OUT",
    "sections": "sections --schema",
    "simulate": "simulate chmielewski --dampings 1,5 --out OUT",
    "size": "size nunes-slider-crank --out OUT",
    "study": "study nunes2017-chapter-6 --only compression --only boost --out OUT",
    "sweep": "sweep zotov-89 --of hinge --over spring.p0=3..8MPa:60 --jobs 1 --out OUT",
    "sweep-jobs": "sweep zotov-89 --of hinge --over spring.p0=3..8MPa:60 --jobs 2 --out OUT",
    "sweep-runs": "sweep zotov-89 --over spring.p0=3..8MPa:20 --show retune --jobs 1 --out OUT",
}


def start(words, folder):
    # a shell lets what it runs in the background ignore interrupts, and children inherit that
    usual = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        return subprocess.Popen(
            [sys.executable, "-m", "mechsym", *words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
            text=True, start_new_session=True, env=os.environ | {"PYTHONPATH": str(ROOT)},
        )  # fmt: skip
    finally:
        signal.signal(signal.SIGINT, usual)


def prepare(folder):
    """What commands read: a mechanism of one's own, and a trace with noise."""
    shutil.copy(ROOT / "examples/mechanisms/v_twin.py", folder / "own.py")
    words = "simulate chmielewski --set simulation.t_end=3s --set simulation.window=1s --out traced".split()
    with start(words, folder) as traced:
        traced.communicate()
    if traced.returncode:
        raise SystemExit("no trace to identify")


def words_of(name):
    return [{"FILE": "own.py", "TRACE": "traced/series.csv"}.get(word, word.replace("OUT", "run"))
            for word in COMMANDS[name].split()]  # fmt: skip


def points(folder):
    """Finished points by store."""
    counts = {}
    for store in Path(folder).rglob("sweep.db"):
        with contextlib.suppress(sqlite3.OperationalError), contextlib.closing(sqlite3.connect(store)) as connection:
            (counts[store],) = connection.execute("select count(*) from point").fetchone()
    return counts


def of_session(session):
    """Processes of a session that still run."""
    alive = []
    for stat in Path("/proc").glob("[0-9]*/stat"):
        with contextlib.suppress(OSError):
            state, _, _, of = stat.read_text().rpartition(")")[2].split()[:4]
            alive += [int(stat.parent.name)] if int(of) == session and state != "Z" else []
    return alive


def interrupted(name, folder, after):
    """Interrupt a command after so many seconds; seconds to its end (None: it had ended), what is wrong."""
    for left in folder.glob("run*"):
        shutil.rmtree(left) if left.is_dir() else left.unlink()
    process = start(words_of(name), folder)
    with contextlib.suppress(subprocess.TimeoutExpired):
        process.communicate(timeout=after)
        return None, []
    before = points(folder)
    sent = time.monotonic()
    process.send_signal(signal.SIGINT)
    try:
        process.wait(timeout=30)
        late = time.monotonic() - sent
        said = process.communicate(timeout=30)[1]  # of its workers too, which end when it has ended
    except subprocess.TimeoutExpired:
        process.kill()
        return 30.0, ["does not end"]
    wrong = [f"exit status {process.returncode}"] if process.returncode not in (130, 0) else []
    wrong += [f"ends after {late:.1f} s"] if late > LATEST else []
    wrong += [f"says {said.strip()[-200:]!r}"] if "Traceback" in said or "ignored" in said else []
    time.sleep(0.1)
    wrong += ["processes stay"] if of_session(process.pid) else []
    now = points(folder)
    wrong += [f"forgets points of {path.parent.name}" for path, count in before.items() if now.get(path, 0) < count]
    wrong += [f"leaves {p.name}" for p in folder.rglob(".*") if p.is_file()]
    return late, wrong + mixtures(folder)


def mixtures(folder):
    """Summaries that tell of other files than there are."""
    wrong = []
    for path in Path(folder).glob("run*/**/summary.json"):
        listed = json.loads(path.read_bytes())["run"]["files"]
        wrong += [f"{path} and {n} differ" for n, said in listed.items()
                  if files.digest((path.parent / n).read_bytes()) != said]  # fmt: skip
    return wrong


def times(name, folder, count, seed=0):
    """A row of the table: usual seconds, ends after the interrupts [s], what was wrong."""
    began = time.monotonic()
    process = start(words_of(name), folder)
    said = process.communicate(timeout=600)[1]
    usual = time.monotonic() - began
    wrong = [f"fails by itself: {said[-300:]}"] if process.returncode not in (0, 1) else []
    draw, ends = random.Random(f"{name} {seed}"), []
    for _ in range(count):
        after = START + draw.random() * max(usual - START, 0.05)
        late, faults = interrupted(name, folder, after)
        ends += [] if late is None else [late]
        wrong += [f"at {after:.2f} of {usual:.2f} s: {fault}" for fault in faults]
    return usual, ends, wrong


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", default=list(COMMANDS))
    parser.add_argument("--times", type=int, default=20)
    parser.add_argument("--seed", type=int, default=0)
    asked = parser.parse_args(arguments)
    bad = total = 0
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch).resolve()
        prepare(folder)
        for name in asked.names:
            usual, ends, wrong = times(name, folder, asked.times, asked.seed)
            total, bad = total + len(ends), bad + len(wrong)
            print(f"{name:11} {usual:6.1f} s  {len(ends):3} interrupts, latest end {max(ends, default=0):.2f} s, "
                  f"wrong {len(wrong)}", flush=True)  # fmt: skip
            print("".join(f"  {line}\n" for line in wrong), end="", flush=True)
    print(f"{total} interrupts, {bad} wrong")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
