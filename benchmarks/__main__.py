"""`python -m benchmarks [P2 P5 ...]`: run problems, print times and ratios of this run, write benchmarks.json."""

import json
import platform
import sys
from dataclasses import asdict
from importlib import import_module
from importlib.metadata import version
from itertools import groupby
from pathlib import Path

from benchmarks.measure import Row

PROBLEMS = {"P2": "p2_evaluate", "P3": "p3_simulate", "P4": "p4_optimise", "P5": "p5_cycle"}


def main(chosen: list[str]) -> int:
    unknown = [name for name in chosen if name not in PROBLEMS]
    if unknown:
        print(f"no problem is called {', '.join(unknown)}; there are {', '.join(PROBLEMS)}", file=sys.stderr)
        return 2
    found: list[Row] = []
    skipped: list[str] = []
    for name in chosen or PROBLEMS:
        rows = import_module(f"benchmarks.{PROBLEMS[name]}").rows(skipped)
        print("\n".join(table(rows)), flush=True)
        found += rows
    for line in sorted(set(skipped)):
        print(f"skipped: {line}")
    packages = {p: version(p) for p in ("casadi", "numpy", "scipy", "sympy")}
    record = {"processor": platform.processor() or platform.machine(), "python": platform.python_version(), **packages}
    Path("out").mkdir(exist_ok=True)
    Path("out/benchmarks.json").write_text(json.dumps({**record, "rows": [asdict(r) for r in found]}, indent=1) + "\n")
    print("wrote out/benchmarks.json")
    return 0


def table(rows: list[Row]) -> list[str]:
    """One line a route, with its time and how often that is of the fastest route of the same case."""
    lines = []
    for (problem, case), group in groupby(rows, key=lambda r: (r.problem, r.case)):
        routes = list(group)
        fastest = min(r.median_s for r in routes)
        lines.append(f"{problem} {case}")
        for r in routes:
            error = "" if r.error is None else f"   error {r.error:.1e}"
            lines.append(f"  {r.route:44s} {r.median_s * 1e9:14.1f} ns {r.median_s / fastest:10.2f} x{error}")
    return lines


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
