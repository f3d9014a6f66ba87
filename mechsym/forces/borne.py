"""What bears what: the extremes of every load once, what is equal for all cylinders in one row."""

import re
from typing import Any

from mechsym.forces.summary import quantities
from mechsym.quantities.names import stem_and_unit

# what bears a load, by how its name starts
_BEARS = {
    "p": "gas in the cylinder", "piston_pin": "piston pin, from the rod", "pin_force": "crank pin, from its load",
    "pin_and_guide": "pin and guides together", "crank_pin": "crank pin, in the crank's frame",
    "main_bearing": "main bearing, in the frame", "side_force": "guide of the piston", "F": "piston, from the gas",
    "shaft_torque": "shaft behind the throw", "torque": "load", "roll_moment": "mounts of the frame",
    "tooth": "teeth", "piston_torque": "crank, from the piston", "guide_combination": "guides together",
    "journal": "journal of the planet or slider", "X_": "guide of the slider",
}  # fmt: skip
_RAW = re.compile(r"_force_[xy](_|$)")
_NUMBERED = re.compile(r"(_|^F)(\d+)(?=_|$)")


def borne(report: dict[str, Any]) -> list[dict[str, Any]]:
    """Rows of a name, quantity, of which cylinders or throws, max, min (SI), unit, and what bears it."""
    rows: dict[tuple[str, ...], dict[str, Any]] = {}
    for name in quantities(report):
        number, ends = _NUMBERED.search(name), (report["max"][name], report["min"][name])
        told = tuple(f"{value:.6g}" for value in ends)
        # the same force under the mechanism's own name
        if _RAW.search(name) and any(key[1:] == told and "bearing" in key[0] for key in rows):
            continue
        row = rows.setdefault((_NUMBERED.sub(r"\1*", name), *told), {"names": [], "of": [], "ends": ends})
        row["names"].append(name)
        row["of"] += [number[2]] if number else []
    return [_row(pattern, row) for (pattern, *_), row in rows.items()]


def _row(pattern: str, row: dict[str, Any]) -> dict[str, Any]:
    several, name = len(row["of"]) > 1, row["names"][0]
    return {
        "name": name,
        "quantity": pattern if several else name,
        "of": ", ".join(row["of"]) if several else "",
        "max": row["ends"][0],
        "min": row["ends"][1],
        "unit": stem_and_unit(name)[1],
        "on": _on(pattern),
    }


def _on(pattern: str) -> str:
    fitting = [start for start in _BEARS if pattern.startswith(start)]
    return _BEARS[max(fitting, key=len)] if fitting else ""
