"""What the command line owes whatever it is given; the rule that `make fuzz` and the replay of its finds hold."""

import json
import multiprocessing
import os
import resource
import signal
import sys
import tempfile
import time
import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import Any

LIMIT = 30.0  # time of a processor that an input may take [s]
PATIENCE = 40.0  # times the limit by the clock: other work may share the processor
ALLOWED = (0, 1, 2, 3)
# what an answer may say without a doubt, by the name of its key: laws of physics, and engines that were built; written
# down here again, since the ranges of the package would prove nothing about themselves
POSSIBLE = {
    "efficiency": (0, 1), "mechanical_efficiency": (0, 1), "power_residual": (-0.01, 0.01),
    "energy_residual": (-1e-3, 1e-3), "p_max_bar": (1, 400), "p_max_mpa": (0.1, 40), "mep_bar": (-10, 60),
    "mep_kpa": (-1000, 6000), "speed_rpm": (-2e4, 1e5), "sfc_g_kwh": (25, 1e6), "misfire_speed_share": (0, 1),
    "twist_peak": (-1, 1),
}  # fmt: skip
# a design, a run or a claim may fail; everything else that goes wrong is bad input
MAY_FAIL = ("hinge", "size", "forces", "simulate", "audit", "reproduce", "derive", "codesign", "check", "sweep")
ASKED = "failed"  # tells points of a sweep that gave no answer


@dataclass(frozen=True)
class Answer:
    """What came of an input."""

    code: int | None  # None when it was stopped at the limit; negative for a signal
    out: str
    err: str
    seconds: float  # by the clock


def judged(argv: list[str], answer: Answer) -> str | None:
    """What is wrong with an answer; None when it is as the interface says."""
    lines = answer.err.splitlines()
    if answer.code in (None, -signal.SIGXCPU):
        return f"took more than {LIMIT:g} s"
    if "Traceback" in answer.err or answer.code not in ALLOWED:
        return f"exit {answer.code}: {lines[-1] if lines else 'nothing said'}"
    if any("Warning" in line for line in lines):
        return f"a warning of Python: {next(line for line in lines if 'Warning' in line)}"
    if answer.code == 1 and argv[0] not in MAY_FAIL:
        return f"exit 1 of {argv[0]}"
    if answer.code == 2:
        if len(lines) != 1 or not lines[0].startswith("mechsym: "):
            return f"{len(lines)} lines of error"
        return "output beside an error" if answer.out else None
    return _json_fault(answer.out, answer.err) if "--json" in argv else None


def _json_fault(text: str, err: str) -> str | None:
    def refuse(word: str) -> None:
        raise ValueError(f"{word} in JSON")

    try:
        found = json.loads(text, parse_constant=refuse)
    except ValueError as error:
        return str(error)
    # a list has no place for doubts: they stand in standard error
    told = bool(found.get("doubts") or found.get("accepted")) if isinstance(found, dict) else "doubt: " in err
    return None if told else impossible(found)


def impossible(found: Any, name: str = "") -> str | None:
    """The first number of an answer that no engine shows; such a number must not come without a doubt."""
    if isinstance(found, dict):
        shares = found.get("fractions")
        if isinstance(shares, dict) and (off := _shares_off(shares)) is not None:
            return f"shares of the heat add up to {off:g}, and no doubt"
        told = ((key, value) for key, value in found.items() if key != ASKED)
        return next((fault for key, value in told if (fault := impossible(value, key))), None)
    if isinstance(found, list):
        return next((fault for value in found if (fault := impossible(value, name))), None)
    if isinstance(found, bool) or not isinstance(found, int | float) or name not in POSSIBLE:
        return None
    low, high = POSSIBLE[name]
    return None if low <= found <= high else f"{name} = {found:g} and no doubt"


def _shares_off(shares: dict[str, list[float]]) -> float | None:
    """What the shares of the heat add up to where that is not 1."""
    sums = [sum(at) for at in zip(*shares.values(), strict=True) if None not in at]
    return next((total for total in sums if abs(total - 1) > 1e-3), None)


def answer(made: dict[str, Any], limit: float = LIMIT * PATIENCE) -> Answer:
    """Give an input to the command line in a process of its own, forked off this one, in an empty folder."""
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        for name, text in made["files"].items():
            (place / name).write_text(text, encoding="utf-8")
        began = time.monotonic()
        child = multiprocessing.get_context("fork").Process(target=_child, args=(made["argv"], folder))
        child.start()
        child.join(limit)
        code = child.exitcode
        if code is None:
            child.kill()
            child.join()
        out, err = ((place / name).read_text("utf-8", "replace") for name in (".out", ".err"))
        return Answer(code, out, err, time.monotonic() - began)


def _child(argv: list[str], folder: str) -> None:
    resource.setrlimit(resource.RLIMIT_CPU, (int(LIMIT), int(LIMIT) + 5))
    os.chdir(folder)
    for handle, name in ((1, ".out"), (2, ".err")):
        os.dup2(os.open(name, os.O_WRONLY | os.O_CREAT | os.O_TRUNC), handle)
    sys.stdout, sys.stderr = (open(handle, "w", encoding="utf-8", closefd=False) for handle in (1, 2))
    sys.argv = ["mechsym", *argv]
    from mechsym.cli import main

    code: Any = 0
    try:
        main()
    except SystemExit as ended:
        code = ended.code or 0
    except BaseException:
        traceback.print_exc()
        code = 70
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
