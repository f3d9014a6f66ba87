"""Ranges by kind of value: beyond the hard one lies nonsense, beyond the usual one a doubt.

The usual ranges are those of reciprocating engines, from large marine two-strokes to models, after Heywood (1988),
Internal combustion engine fundamentals, chapters 2 and 15, and the data sheets of the materials; they are wide on
purpose. The hard ranges are a factor of about three to ten beyond, or a law of physics.

Ranges of what several values say together: one number each, in proportion to the machine. The table is `ranges.csv`;
an angle stands there with `deg`, and an empty limit is none.
"""

import csv
import math
from importlib import resources

from mechsym.quantities import record


@record
class Usual:
    """One kind of value."""

    code: str  #: One word by which a case can accept a doubt
    keys: tuple[str, ...]  #: Names of the values, the last word of a dotted key
    unit: str  #: SI unit of the values, or the unit that a result's name says
    low: float = -math.inf  #: Least usual value [unit]
    high: float = math.inf  #: Largest usual value [unit]
    lowest: float = -math.inf  #: Least possible value [unit]
    highest: float = math.inf  #: Largest possible value [unit]
    why: str
    section: str = ""  #: Section of a case that it is meant for; empty for any


def _limit(text: str, missing: float) -> float:
    """A limit of the table; angles may be given in degrees."""
    if not text:
        return missing
    return math.radians(float(text.removesuffix(" deg"))) if text.endswith(" deg") else float(text)


def _table() -> dict[str, tuple[Usual, ...]]:
    rows: dict[str, list[Usual]] = {"input": [], "result": [], "proportion": []}
    text = resources.files("mechsym.plausible").joinpath("ranges.csv").read_text("utf-8")
    for row in csv.DictReader(text.splitlines()):
        low, lowest = (_limit(row[name], -math.inf) for name in ("low", "lowest"))
        high, highest = (_limit(row[name], math.inf) for name in ("high", "highest"))
        rows[row["table"]].append(
            Usual(
                code=row["code"],
                section=row["section"],
                keys=tuple(row["keys"].split()),
                unit=row["unit"],
                low=low,
                high=high,
                lowest=lowest,
                highest=highest,
                why=row["why"],
            )
        )
    return {name: tuple(found) for name, found in rows.items()}


_ROWS = _table()
INPUTS = _ROWS["input"]  #: Values of a case by their names
RESULTS = _ROWS["result"]  #: Numbers of a report by their names
PROPORTIONS = _ROWS["proportion"]  #: What several values say together, by code
