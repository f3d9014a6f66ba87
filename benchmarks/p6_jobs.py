"""P6: whole commands as a user types them, start of Python and imports included: processor seconds."""

import resource
import statistics
import subprocess
import sys
import tempfile

from benchmarks.measure import Row

_ROUNDS = 3
_SPRINGS = ["sweep", "zotov-89", "--over", "spring.p0=3..8MPa:1000", "--jobs", "1", "--json"]
JOBS: dict[str, list[str]] = {
    "eval": ["eval", "crosshead", "--case", "zotov-89", "--set", "phi=1"],
    "hinge --json": ["hinge", "zotov-89", "--json"],
    "hinge --out": ["hinge", "zotov-89", "--out", "."],
    "simulate": ["simulate", "chmielewski", "--json"],
    "size": ["size", "nunes-slider-crank", "--json"],
    "1000 guides": [*_SPRINGS, "--of", "guides"],
    "1000 hinges": _SPRINGS,
    "1000 start-ups": ["sweep", "chmielewski", "--over", "drive.torque=1..2:1000", "--jobs", "1", "--json"],
}


def rows(skipped: list[str]) -> list[Row]:
    """Processor seconds of each command, after one run that fills the caches.

    Parameters
    ----------
    skipped : list of str
        Nothing is skipped

    Returns
    -------
    rows : list of Row
        Time of one command with its children
    """
    found = []
    for name, words in JOBS.items():
        times = sorted([_seconds(words) for _ in range(_ROUNDS + 1)][1:])
        found.append(
            Row(problem="P6 whole jobs", case=name, route="mechsym", median_s=statistics.median(times),
                best_s=times[0], error=None)
        )  # fmt: skip
    return found


def _seconds(words: list[str]) -> float:
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "mechsym", *words]
        subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime
