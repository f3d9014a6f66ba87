"""python -m benchmarks [--out FOLDER] [P1 P2 P3 P4 P5 P6]"""

import importlib
import sys
import time
from pathlib import Path

from benchmarks.report import table, write

_PROBLEMS = {"P1": "p1_derive", "P2": "p2_evaluate", "P3": "p3_simulate", "P4": "p4_optimise", "P5": "p5_cycle",
             "P6": "p6_jobs"}  # fmt: skip


def main(arguments: list[str]) -> int:
    """Run the problems that are named, or all.

    Parameters
    ----------
    arguments : list of str
        Names of problems, and perhaps `--out FOLDER`

    Returns
    -------
    status : int
        0, or 2 for a name that is not known
    """
    folder = Path(__file__).parent
    if "--out" in arguments[:-1]:
        place = arguments.index("--out")
        folder = Path(arguments[place + 1])
        arguments = arguments[:place] + arguments[place + 2 :]
    unknown = [a for a in arguments if a not in _PROBLEMS]
    if unknown:
        print(f"no problem {', '.join(unknown)}; there are {', '.join(_PROBLEMS)}", file=sys.stderr)
        return 2
    begin, skipped, rows = time.perf_counter(), [], []
    for name in arguments or _PROBLEMS:
        print(f"{name} ..", file=sys.stderr, flush=True)
        rows += importlib.import_module(f"benchmarks.{_PROBLEMS[name]}").rows(skipped)
    seconds = time.perf_counter() - begin
    print(table(rows, skipped))
    if not arguments:
        print(f"\n{seconds:.0f} s; wrote {', '.join(map(str, write(folder, rows, skipped, seconds)))}")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
