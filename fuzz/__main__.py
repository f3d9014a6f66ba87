"""python -m fuzz [COUNT [SEED [printed]]]: machine-made inputs against the command line; finds go to tests/corpus.

COUNT is 10,000 or the environment's FUZZ, SEED 1; `printed` makes formulas of texts with changes, and nothing else.
"""

import importlib
import json
import os
import sys
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from fuzz.judge import answer, judged
from fuzz.mutators import Input, make

CORPUS = Path(__file__).parent.parent / "tests" / "corpus"
STEP = 100  # inputs from one line of figures to the next: nothing is lost where the run is cut
# imported once, so that a forked process starts at once
WARM = (
    "scipy.optimize", "scipy.integrate", "scipy.interpolate", "sympy", "mechsym.audit.hosts.formula",
    "mechsym.cli.audit",
    "mechsym.cli.cycle", "mechsym.cli.flywheel", "mechsym.cli.forces",
    "mechsym.cli.hinge", "mechsym.cli.simulate", "mechsym.cli.size", "mechsym.cli.sweep",
    "mechsym.codesign.task", "mechsym.jobs.cycle",
    "mechsym.jobs.forces", "mechsym.jobs.hinge", "mechsym.jobs.run", "mechsym.jobs.size", "mechsym.jobs.flywheel",
    "mechsym.jobs.measured", "mechsym.generated.crosshead", "mechsym.generated.hypocycloid",
    "mechsym.generated.crank_throw", "mechsym.mechanisms.rodless", "mechsym.optimise.solver",
)  # fmt: skip


def main(arguments: list[str]) -> int:
    """Run; 0 when every answer was as the interface says, else 1."""
    count = int(arguments[0] if arguments else os.environ.get("FUZZ", 10_000))
    seed = int(arguments[1]) if len(arguments) > 1 else 1
    only = arguments[2] if len(arguments) > 2 else ""
    from mechsym import cases

    texts = {name: cases.text(name) for name in cases.names()}
    for name in WARM:
        importlib.import_module(name)
    codes: Counter[str] = Counter()
    faults: dict[str, str] = {}
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        found = pool.map(lambda i: _one(make(seed, i, texts, only)), range(count))
        for done, (made, code, fault) in enumerate(found, 1):
            codes[str(code)] += 1
            if fault is not None:
                file = _keep(made, fault, f"{seed}-{done - 1}")
                faults[file] = fault
                print(f"{file}: {fault}", flush=True)
            if done % STEP == 0 or done == count:
                ended = ", ".join(f"{code}: {n}" for code, n in sorted(codes.items()))
                print(f"{done} inputs of seed {seed}; exit status {ended}; {len(faults)} faults", flush=True)
    return 1 if faults else 0


def _one(made: Input) -> tuple[Input, int | None, str | None]:
    got = answer(made)
    return made, got.code, judged(made["argv"], got)  # type: ignore[arg-type]


def _keep(made: Input, fault: str, name: str) -> str:
    CORPUS.mkdir(exist_ok=True)
    file = CORPUS / f"fuzz-{name}.json"
    file.write_text(json.dumps({"fault": fault, **made}, indent=1) + "\n", encoding="utf-8")
    return file.name


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
