"""Findings that were recorded earlier, so that a change of a verdict or of a computed value is noticed."""

import json
import math
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import Any

from mechsym.files import to_json, write_text

_LEAST = 1e-9  # what rounding leaves where a number should be 0 [unit of the number]


def stored(package: str) -> list[dict[str, Any]]:
    """The findings recorded beside a package.

    Returns
    -------
    findings : list of dict
        Empty when there is no record yet
    """
    file = resources.files(package) / "findings.json"
    return json.loads(file.read_text(encoding="utf-8")) if file.is_file() else []


def write(package: str, rows: Sequence[Mapping[str, Any]], keys: Sequence[str]) -> Path:
    """Record findings."""
    path = Path(str(resources.files(package) / "findings.json"))
    return write_text(path, to_json([{k: row[k] for k in keys} for row in rows]) + "\n")


def differences(
    package: str, rows: Sequence[Mapping[str, Any]], name: Sequence[str], compared: Sequence[str]
) -> list[str]:
    """How findings differ from the recorded ones of the same sources.

    Parameters
    ----------
    name : sequence of str
        Keys that name a finding; one of them is `source`
    compared : sequence of str
        Keys whose values must not change; numbers may by the recorded `tolerance` of their finding, relative and as
        small as 1e-9 in any unit, since the last digits belong to the processor
    """
    sources = {row["source"] for row in rows}
    before = {_name(r, name): r for r in stored(package) if r["source"] in sources}
    now = {_name(r, name): r for r in rows}
    lines = [f"{' '.join(key)} is not recorded" for key in now if key not in before]
    lines += [f"{' '.join(key)} is recorded but was not found" for key in before if key not in now]
    for key in now.keys() & before.keys():
        changed = [k for k in compared if _differs(now[key][k], before[key].get(k), before[key].get("tolerance", 0.0))]
        lines += [f"{' '.join(key)}: {k} {now[key][k]!r}, recorded {before[key].get(k)!r}" for k in changed]
    return sorted(lines)


def _differs(now: Any, before: Any, tolerance: float) -> bool:
    numbers = all(isinstance(v, int | float) and not isinstance(v, bool) for v in (now, before))
    if not numbers or not tolerance:
        return bool(now != before)
    return not math.isclose(now, before, rel_tol=tolerance, abs_tol=_LEAST)


def _name(row: Mapping[str, Any], keys: Sequence[str]) -> tuple[str, ...]:
    return tuple(str(row[k]) for k in keys)
