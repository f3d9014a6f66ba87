"""Targets, table, JSON and chart of a run."""

import dataclasses
import datetime
import platform
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.measure import Row, ratio
from benchmarks.p6_jobs import STARTED
from mechsym.files import to_json, write_text
from mechsym.native.cache import info


@dataclasses.dataclass(frozen=True, kw_only=True)
class Target:
    """A ratio that is wanted.

    Parameters
    ----------
    problem, case : str
        Where it is measured
    ours, theirs : str
        Routes whose medians are compared
    limit : float
        Largest ratio ours / theirs that passes [-]
    """

    problem: str
    case: str
    ours: str
    theirs: str
    limit: float


_FAST = "mechsym (fast)"
TARGETS = (
    Target(problem="P1 derive + callable", case="N = 12", ours="mechsym (warm)",
           theirs="sympy LagrangesMethod + lambdify", limit=0.02),
    *(Target(problem="P1 derive + callable", case=f"N = {n}", ours="mechsym (warm)",
             theirs="casadi autodiff, interpreted", limit=1.0) for n in (1, 12, 96)),
    Target(problem="P1 compile time", case="N = 12 / N = 1", ours="N = 12", theirs="N = 1", limit=1.5),
    *(Target(problem="P2 batch", case=case, ours=_FAST, theirs=theirs, limit=limit)
      for case in ("1-DOF", "N = 6")
      for theirs, limit in (("hand-written C", 1.25), ("heyoka", 0.6), ("numba on lambdify", 1 / 20),
                            ("casadi map, compiled", 1 / 20))),
    *(Target(problem="P2 batch", case=f"{case}, {points}", ours=_FAST, theirs="hand-written C", limit=1.25)
      for case in ("1-DOF", "N = 6") for points in (256, 2048, 1_000_000)),
    *(Target(problem="P2 scalar", case=case, ours=_FAST, theirs=theirs, limit=limit)
      for case in ("1-DOF", "2-DOF", "N = 6")
      for theirs, limit in (("sympy lambdify (numpy, cse)", 1 / 50), ("casadi call", 1 / 100))),
    *(Target(problem="P3 single run", case="1e-08", ours=_FAST, theirs=theirs, limit=limit)
      for theirs, limit in (("hand-written C DOP853", 1.1), ("heyoka", 1 / 4), ("scipy DOP853 + lambdify", 1 / 100))),
    *(Target(problem="P3 ensemble of 16", case=tolerance, ours=_FAST, theirs="heyoka batch", limit=1 / 4)
      for tolerance in ("1e-08", "1e-10", "1e-12")),
    *(Target(problem="P4 repeated solve", case="200 nodes", ours="mechsym (all compiled)", theirs=theirs, limit=limit)
      for theirs, limit in (("casadi interpreted (map)", 1 / 2), ("opty", 0.35))),
    *(Target(problem="P5 cycle map", case="800 speeds", ours=_FAST, theirs=theirs, limit=limit)
      for theirs, limit in (("hand-written C", 1.1), ("numpy over speeds", 1 / 5))),
    Target(problem="P5 cycle map", case="800 speeds", ours="mechsym (strict)", theirs="hand-written C", limit=1.5),
    *(Target(problem="P6 whole jobs", case=case, ours="mechsym", theirs=STARTED, limit=limit)
      for case, limit in (("eval", 1.5), ("hinge --json", 4.0), ("hinge --out", 10.0), ("simulate", 3.0), ("size", 4.0),
                          ("1000 guides", 20.0), ("1000 hinges", 20.0), ("1000 start-ups", 30.0),
                          ("64 engine runs", 10.0))),  # of 10 ms each
)  # fmt: skip


def judged(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """Every target with its ratio.

    Parameters
    ----------
    rows : sequence of Row
        Measured routes

    Returns
    -------
    verdicts : list of dict
        problem, case, theirs, ratio, limit and verdict: `pass`, `short` or `not measured`
    """
    measured = {(r.problem, r.case, r.route): r for r in [*rows, *_compile_times(rows)]}
    found = []
    for t in TARGETS:
        ours = measured.get((t.problem, t.case, t.ours))
        theirs = measured.get((t.problem, t.case, t.theirs))
        pair = None if ours is None or theirs is None else ratio(ours, theirs)
        verdict = "not measured" if pair is None else "pass" if pair.median <= t.limit else "short"
        found.append({"problem": t.problem, "case": t.case, "against": t.theirs, "ratio": pair and pair.median,
                      "low": pair and pair.low, "high": pair and pair.high, "target": t.limit,
                      "verdict": verdict})  # fmt: skip
    return found


def _compile_times(rows: Sequence[Row]) -> list[Row]:
    """What compiling adds to the warm route."""
    times = {(r.case, r.route): r.median_s for r in rows if r.problem == "P1 derive + callable"}
    added = []
    for c in ("N = 1", "N = 12"):
        if (c, "mechsym (compiling)") in times:
            took = times[c, "mechsym (compiling)"] - times[c, "mechsym (warm)"]
            added.append(
                Row(problem="P1 compile time", case="N = 12 / N = 1", route=c, median_s=took, best_s=took, error=None)
            )
    return added


def table(rows: Sequence[Row], skipped: Sequence[str]) -> str:
    """Times, then targets, as text.

    Parameters
    ----------
    rows : sequence of Row
        Measured routes
    skipped : sequence of str
        Alternatives that are not installed

    Returns
    -------
    text : str
        Where and when, then two tables
    """
    lines = [where(), "", f"{'problem':<22}{'case':<16}{'route':<34}{'median':>12}{'best':>12}  error"]
    for r in rows:
        error = "" if r.error is None else f"{r.error:.1e}"
        lines.append(f"{r.problem:<22}{r.case:<16}{r.route:<34}{_time(r.median_s):>12}{_time(r.best_s):>12}  {error}")
    lines += [
        "",
        f"{'target':<22}{'case':<16}{'against':<34}{'ratio':>9}  {'19 times in 20':<18}{'wanted':>7}  verdict",
    ]
    for v in judged(rows):
        middle = "-" if v["ratio"] is None else f"{v['ratio']:.3g}"
        within = "" if v["low"] is None else f"{v['low']:.3g} to {v['high']:.3g}"
        lines.append(
            f"{v['problem']:<22}{v['case']:<16}{v['against']:<34}{middle:>9}  {within:<18}{v['target']:>7.3g}  "
            f"{v['verdict']}"
        )
    if skipped:
        lines += ["", f"not installed, skipped: {', '.join(sorted(set(skipped)))}"]
    return "\n".join(lines)


def _time(seconds: float) -> str:
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6)):
        if seconds >= size:
            return f"{seconds / size:.3g} {unit}"
    return f"{seconds / 1e-9:.3g} ns"


def where() -> str:
    """Processor, compiler and date of a run, in one line."""
    native = info()
    return f"{native.processor}, {native.version}, {datetime.date.today().isoformat()}"


def versions() -> dict[str, Any]:
    """What was compared, and on what.

    Returns
    -------
    versions : dict
        Packages, compiler, options, processor
    """
    from importlib import metadata

    found = {}
    for name in ("numpy", "scipy", "casadi", "sympy", "numba", "heyoka", "opty"):
        try:
            found[name] = metadata.version(name)
        except metadata.PackageNotFoundError:
            found[name] = None
    native = info()
    return {
        "python": sys.version.split()[0],
        "packages": found,
        "compiler": native.version,
        # where Python.h lies is this machine's own business
        "flags": {mode: [f for f in flags if not f.startswith("-I")] for mode, flags in native.flags.items()},
        "processor": native.processor,
        "platform": platform.platform(),
    }


def write(folder: Path, rows: Sequence[Row], skipped: Sequence[str], seconds: float) -> list[Path]:
    """Write JSON and chart.

    Parameters
    ----------
    folder : Path
        Where to
    rows : sequence of Row
        Measured routes
    skipped : sequence of str
        Alternatives that are not installed
    seconds : float
        Time the run took [s]

    Returns
    -------
    files : list of Path
        Written
    """
    from benchmarks.chart import chart

    record = {
        "where": where(),
        "versions": versions(),
        "seconds": seconds,
        "skipped": sorted(set(skipped)),
        "targets": judged(rows),
        "rows": [dataclasses.asdict(r) for r in rows],
    }
    return [write_text(folder / "results.json", to_json(record) + "\n"), chart(folder / "chart.svg", rows, where())]
