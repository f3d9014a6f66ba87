"""Findings that were recorded earlier, so that a change of a verdict or of a computed value is noticed."""

import json
import math
from collections.abc import Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from mechsym.files import Json, to_json, write_text

_LEAST = 1e-9  # what rounding leaves where a number should be 0 [unit of the number]


def stored(package: str) -> list[Json]:
    """The findings recorded beside a package; empty when there is no record yet."""
    file = resources.files(package) / "findings.json"
    return json.loads(file.read_text(encoding="utf-8")) if file.is_file() else []


def write(package: str, rows: Sequence[Json], keys: Sequence[str]) -> Path:
    """Record findings."""
    path = Path(str(resources.files(package) / "findings.json"))
    return write_text(path, to_json([{k: row[k] for k in keys} for row in rows]) + "\n")


def differences(package: str, rows: Sequence[Json], name: Sequence[str], compared: Sequence[str]) -> list[str]:
    """How findings differ from the recorded ones of the same sources.

    name: keys that name a finding; one of them is `source`; compared: keys whose values must not change; numbers may by
    the recorded `tolerance` of their finding, relative and as small as 1e-9 in any unit, since the last digits belong
    to the processor.
    """
    sources = {row["source"] for row in rows}
    before = {tuple(str(r[k]) for k in name): r for r in stored(package) if r["source"] in sources}
    now = {tuple(str(r[k]) for k in name): r for r in rows}
    lines = [f"{' '.join(key)} is not recorded" for key in now if key not in before]
    lines += [f"{' '.join(key)} is recorded but was not found" for key in before if key not in now]
    for key in now.keys() & before.keys():
        for k in compared:
            value, old = now[key][k], before[key].get(k)
            if _differs(value, old, before[key].get("tolerance", 0.0)):
                lines.append(f"{' '.join(key)}: {k} {value!r}, recorded {old!r}")
    return sorted(lines)


def _differs(now: Any, before: Any, tolerance: float) -> bool:
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in (now, before))
    if not numbers or not tolerance:
        return bool(now != before)
    return not math.isclose(now, before, rel_tol=tolerance, abs_tol=_LEAST)
