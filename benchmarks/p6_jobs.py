"""P6: whole commands as a user types them, start of Python and imports included, beside Python and its libraries."""

import functools
import subprocess
import sys
import tempfile
from pathlib import Path

from benchmarks.measure import PAIRS, Route, Row, take_turns

_ROUNDS = min(PAIRS, 7)
STARTED = "python -c 'import numpy, casadi'"
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
_LONG = ("1000 hinges", "1000 start-ups")  # five seconds and more each

_ENGINE = ["new", "engine", "--kind", "inline", "--bore", "86 mm", "--stroke", "86 mm", "--cylinders", "6", "--out"]
_RUNS = ["--of", "simulate", "--over", "parameters.I_f=0.12..0.18:64", "--jobs", "1", "--json"]


def rows(skipped: list[str]) -> list[Row]:
    """Processor time of each command, after one run that fills the caches.

    Parameters
    ----------
    skipped : list of str
        Nothing is skipped

    Returns
    -------
    rows : list of Row
        Of one command with its children, and of the start of Python
    """
    found = []
    with tempfile.TemporaryDirectory() as place:
        engine = str(Path(place, "six.toml"))
        _mechsym([*_ENGINE, engine])
        for name, words in {**JOBS, "64 engine runs": ["sweep", engine, *_RUNS]}.items():
            call = functools.partial(_mechsym, words)
            call()
            rounds = min(_ROUNDS, 3) if name in _LONG else _ROUNDS
            started = Route(name=STARTED, call=_started, rounds=rounds)
            found += take_turns("P6 whole jobs", name, [Route(name="mechsym", call=call, rounds=rounds), started])
    return found


def _mechsym(words: list[str]) -> None:
    _called(["-m", "mechsym", *words])


def _started() -> None:
    _called(["-c", "import numpy, casadi"])


def _called(words: list[str]) -> None:
    with tempfile.TemporaryDirectory() as folder:
        quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
        subprocess.run([sys.executable, *words], cwd=folder, check=True, **quiet)
