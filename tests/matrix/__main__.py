"""python -m tests.matrix --write DIR | --compare DIR [PATTERN ..]: every command on every case, recorded or compared.

A pattern is a case, a command or both, with wildcards: `hinge`, `zotov-89`, `zotov-*/cycle*`; without one all but the
heavy ones run, with --all those too. What a tree gave already is not run again: results stand in build/matrix by a hash
of the sources. Exit status 1 where something differs.
"""

import argparse
import hashlib
import importlib
import multiprocessing
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

os.environ |= {"OPENBLAS_NUM_THREADS": "1", "COLUMNS": "120"}
sys.path.insert(0, str(Path(__file__).parents[1]))

from matrix.compare import TOLERANCE, Scales, differences  # noqa: E402
from matrix.entries import ROOT, Entry, entries, prepare  # noqa: E402
from matrix.files import kept, read, write  # noqa: E402
from matrix.record import record  # noqa: E402

SHOWN = 6  # differences of an entry that are printed
WARM = (
    "matplotlib.figure", "matplotlib.backends.backend_svg", "scipy.integrate", "scipy.interpolate", "scipy.optimize",
    "casadi", "mechsym.cli.hinge", "mechsym.cli.cycle", "mechsym.cli.forces", "mechsym.cli.report",
    "mechsym.jobs.hinge", "mechsym.jobs.run", "mechsym.jobs.forces", "mechsym.jobs.cycle",
)  # fmt: skip


def main(arguments: list[str] | None = None) -> int:
    """Record, or compare; 1 where something differs."""
    asked = _asked(arguments)
    heavy = asked.all or (asked.patterns and not asked.light)
    wanted = [e for e in entries() if e.matches(tuple(asked.patterns)) and (heavy or not e.heavy)]
    if not wanted:
        print("no such case or command")
        return 2
    now = ROOT / "build/matrix" / _tree()
    for old in (ROOT / "build/matrix").glob("*"):
        if old != now and old.name.startswith("tree-"):
            shutil.rmtree(old)
    _run([e for e in wanted if asked.fresh or not kept(now, e).exists()], now, asked.jobs)
    if asked.write:
        for entry in wanted:
            write(asked.write, entry, read(now, entry))
        print(f"{len(wanted)} records in {asked.write}")
        return 0
    return _compared(asked.compare, now, wanted, asked.tolerance)


def _asked(arguments: list[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m tests.matrix", description=__doc__)
    parser.add_argument("patterns", nargs="*", metavar="PATTERN")
    way = parser.add_mutually_exclusive_group(required=True)
    way.add_argument("--write", type=Path, metavar="DIR")
    way.add_argument("--compare", type=Path, metavar="DIR")
    parser.add_argument("--all", action="store_true", help="the heavy commands too")
    parser.add_argument("--light", action="store_true", help="no heavy command, whatever a pattern names")
    parser.add_argument("--fresh", action="store_true", help="run again what this tree gave already")
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--tolerance", type=float, default=TOLERANCE, help="of a number, relative")
    return parser.parse_args(arguments)


def _tree() -> str:
    """A name for what the results hang on: the sources, and how they are recorded."""
    digest = hashlib.sha256()
    for folder in ("mechsym", "derivations", "generated", "examples"):
        for path in sorted((ROOT / folder).rglob("*")):
            if path.is_file() and "__pycache__" not in path.parts:
                digest.update(str(path.relative_to(ROOT)).encode() + path.read_bytes())
    digest.update((ROOT / "tests/matrix/record.py").read_bytes())
    return f"tree-{digest.hexdigest()[:16]}"


def _run(wanted: list[Entry], now: Path, jobs: int) -> None:
    """Run what is wanted, each in a process of its own that has the libraries already."""
    for name in WARM:
        importlib.import_module(name)
    context, started = multiprocessing.get_context("fork"), time.monotonic()
    with tempfile.TemporaryDirectory() as folder, context.Pool(jobs, maxtasksperchild=1) as pool:
        prepare(Path(folder, "prepared"))
        orders = [(entry, Path(folder), now) for entry in wanted]
        for done, (entry, seconds) in enumerate(pool.imap_unordered(_one, orders), 1):
            text = (
                f"{done}/{len(wanted)} {entry.name} {seconds:.1f} s of a processor, {time.monotonic() - started:.0f} s"
            )
            print(text, file=sys.stderr, flush=True)


def _one(order: tuple[Entry, Path, Path]) -> tuple[Entry, float]:
    entry, folder, now = order
    own = Path(tempfile.mkdtemp(dir=folder))
    shutil.copytree(folder / "prepared", own, dirs_exist_ok=True)
    write(now, entry, record(entry, own))
    shutil.rmtree(own)
    return entry, time.process_time()


def _compared(before: Path, now: Path, wanted: list[Entry], tolerance: float) -> int:
    differ, missing = 0, 0
    for entry in wanted:
        if not kept(before, entry).exists():
            missing += 1
            continue
        after = read(now, entry)
        scales = Scales(after, entry.line.split()[0])
        found = list(differences(read(before, entry), after, tolerance, scales=scales))
        if found:
            differ += 1
            print(f"{entry.name}: {len(found)} differences", *found[:SHOWN], sep="\n    ")
            print(*(["    .."] if len(found) > SHOWN else []), sep="\n", end="")
    print(f"{len(wanted)} entries: {differ} differ" + (f", {missing} are not in {before}" if missing else ""))
    return int(differ > 0)


if __name__ == "__main__":
    sys.exit(main())
