"""Sizes, checks and headline figures as the rows that the command line prints and writes."""

import dataclasses
from typing import Any

from mechsym.sizing.checks import Check, holds

COLUMNS = ("component", "quantity", "value", "unit", "limit", "safety_factor", "rule", "source", "wanted", "holds",
           "note")  # fmt: skip


def fact(component: str, quantity: str, value: float, unit: str, rule: str, source: str = "", note: str = "") -> dict:
    """A row for a figure that no limit belongs to.

    Parameters
    ----------
    value : float
        The figure [unit]

    Returns
    -------
    row : dict
        Keys of `COLUMNS`; limit, factor, wanted and holds are None
    """
    row: dict[str, Any] = dict.fromkeys(COLUMNS)
    return row | {"component": component, "quantity": quantity, "value": float(value), "unit": unit, "rule": rule,
                  "source": source, "note": note}  # fmt: skip


def size_rows(component: str, part: Any, rule: str) -> list[dict]:
    """One row for each size of a part."""
    found = []
    for field in dataclasses.fields(part):
        if "unit" in field.metadata:
            value, unit = getattr(part, field.name), field.metadata["unit"]
            found.append(fact(component, field.metadata["about"] or field.name, value, unit, rule))
    return found


def check_rows(checks: list[Check]) -> list[dict]:
    """One row for each check."""
    return [{name: getattr(check, name, None) for name in COLUMNS} | {"holds": holds(check)} for check in checks]
