"""python -m fuzz.nearby [CASE..]: what is doubted when one value of a built-in case stands 5 % up or down.

Every number of every case, alone, through the commands that the case is for; each doubt that the case as shipped does
not have is a line, with the reason that the command gives, and so is each refusal.
"""

import importlib
import json
import os
import sys
import tomllib
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from typing import Any

from fuzz.__main__ import WARM
from fuzz.judge import answer

FACTORS = (0.95, 1.05)
_NAMES = ("doubts", "part_bearings")  # whose texts are names, a bearing "6013 M" too
# runs are short: what a doubt needs is the start of a run and its last turns
COMMANDS: dict[str, tuple[tuple[str, ...], ...]] = {
    "alpha-stirling": (("cycle",), ("forces",), ("simulate", "--no-check", "--set", "simulation.turns=6")),
    "balandin": (("forces",),),
    "chmielewski": (("simulate", "--no-check"),),
    "generator": (("hinge",), ("forces",)),
    "generator-breathing": (("cycle", "--speeds", "3000"),),
    "moroianu": (("cycle",), ("forces",), ("size",)),
    "nunes-hypocycloid": (("cycle", "--speeds", "8000"), ("forces",), ("size",)),
    "nunes-slider-crank": (("cycle", "--speeds", "8000"), ("forces",), ("size",)),
    "opposed-pistons": (("cycle",), ("forces",), ("simulate", "--no-check", "--set", "simulation.turns=6")),
    "zotov-142": (("cycle",), ("forces",), ("hinge",)),
    "zotov-89": (("cycle",), ("forces",), ("hinge",)),
}  # fmt: skip


def main(names: list[str]) -> int:
    """Run and print; 0, since a doubt is no fault."""
    from mechsym import cases

    for name in WARM:
        importlib.import_module(name)
    wanted = names or sorted(COMMANDS)
    asked = [(n, c, key, value) for n in wanted for c in COMMANDS[n] for key, value in _changed(cases.text(n))]
    shipped = {(n, c): _told(n, c, "", "") for n in wanted for c in COMMANDS[n]}
    doubted = 0
    with ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool:
        for at, told in zip(asked, pool.map(lambda one: _told(*one), asked), strict=True):
            name, command, key, value = at
            new = [f"{code}: {why}" for code, why in told.items() if code not in shipped[name, command]]
            doubted += bool(new)
            if new:
                print(f"{name} {command[0]} {key}={value}  {'; '.join(new)}", flush=True)
    print(f"{len(asked)} runs with one value 5 % up or down: {doubted} say what the case as shipped does not")
    return 0


def _changed(text: str) -> Iterator[tuple[str, str]]:
    """Dotted key and changed value of every number of a case file, units kept."""
    for section, table in tomllib.loads(text).items():
        for key, value in table.items() if isinstance(table, dict) and section not in _NAMES else ():
            number, _, unit = value.partition(" ") if isinstance(value, str) else (value, "", "")
            try:
                size = float(number) if not isinstance(number, bool) else 0.0
            except (TypeError, ValueError):
                continue
            if size and not isinstance(value, int):  # whole numbers are counts
                yield from ((f"{section}.{key}", f"{size * factor:.10g} {unit}".strip()) for factor in FACTORS)


def _told(name: str, command: tuple[str, ...], key: str, value: str) -> dict[str, str]:
    """Doubts by code with their reason; a refusal or another exit status is one, too."""
    given = ["--set", f"{key}={value}"] if key else []
    # what the command shortens itself is not changed
    if any(option.startswith(f"{key}=") for option in command if key):
        return {}
    got = answer({"argv": [command[0], name, *command[1:], *given, "--json"], "files": {}})
    if got.code == 2:
        return {"refused": got.err.strip()}
    found: Any = json.loads(got.out) if got.out else {}
    doubts = found.get("doubts", []) if isinstance(found, dict) else []
    told = {d["code"]: f"{d['quantity']} = {d['value']:.4g}, usual is {d['usual']}" for d in doubts}
    lines = [line for line in got.err.splitlines() if line.startswith("doubt: ")]
    told |= {line.split()[1]: line for line in lines}
    return told | ({f"exit {got.code}": "a design, a run or a check that fails"} if got.code else {})


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
