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
        0; 1 where a problem failed, whose rows are missing; 2 for a name that is not known
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
    begin, skipped, rows, failed = time.perf_counter(), [], [], []
    for name in arguments or _PROBLEMS:
        print(f"{name} ..", file=sys.stderr, flush=True)
        try:
            rows += importlib.import_module(f"benchmarks.{_PROBLEMS[name]}").rows(skipped)
        except Exception as error:  # the others took minutes: what they found is shown all the same
            failed.append(f"{name} failed: {type(error).__name__}: {error}")
    seconds = time.perf_counter() - begin
    print(table(rows, skipped))
    if not arguments and not failed:
        print(f"\n{seconds:.0f} s; wrote {', '.join(map(str, write(folder, rows, skipped, seconds)))}")
    print(*failed, sep="\n", end="\n" if failed else "", file=sys.stderr)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
