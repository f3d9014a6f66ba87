"""The bearings that a design may choose from: the source's four, a few that fit its engine, and the user's own.

`bearings.csv` names the origin of every line; more bearings come from a CSV file of the same columns. A bearing used
without its inner ring runs on a shaft of diameter `raceway`.
"""

import csv
from dataclasses import fields
from importlib import resources
from pathlib import Path

from mechsym.errors import BadInput
from mechsym.files import read_text
from mechsym.quantities import RPM, choice, parse, quantity, record

_UNITS = {"_mm": ("m", 1e-3), "_N": ("N", 1.0), "_rpm": ("rad/s", RPM), "_kg": ("kg", 1.0)}


@record
class Bearing:
    """A rolling bearing."""

    designation: str  #: Maker's name; `ball`, `roller` or `drawn-cup` (needles); where the data come from
    #: Maker's name; `ball`, `roller` or `drawn-cup` (needles); where the data come from
    kind: str = choice("ball", "roller", "drawn-cup", about="rolling elements")
    bore: float = quantity("m", above=0, about="bore")
    outside: float = quantity("m", above=0, about="outside diameter")
    width: float = quantity("m", above=0, about="width")
    C: float = quantity("N", above=0, about="dynamic load rating")
    C0: float = quantity("N", above=0, about="static load rating")
    limiting: float = quantity("rad/s", above=0, about="limiting speed")
    mass: float = quantity("kg", above=0, about="mass")
    #: Diameter of the shaft that replaces the inner ring; None when there is none [m]
    raceway: float | None = quantity("m", default=None, above=0, about="shaft without inner ring")
    reference: float | None = quantity("rad/s", default=None, above=0, about="reference speed")
    source: str = ""  #: Maker's name; `ball`, `roller` or `drawn-cup` (needles); where the data come from

    def __post_init__(self) -> None:
        if self.outside <= self.bore:
            raise BadInput(f"bearing {self.designation}: outside {self.outside:g} m must be larger than bore")


def catalogue(extra: str | Path | None = None) -> dict[str, Bearing]:
    """The built-in bearings, and those of a CSV file with the same columns.

    Parameters
    ----------
    extra : str or Path, optional
        File with more bearings; a designation that exists already is replaced

    Raises
    ------
    BadInput
        File not readable, a column missing or not known, a value out of range

    Notes
    -----
    Source: Nunes (2017), table 4.16, and what `bearings.csv` names.

    Examples
    --------
    >>> catalogue()["6013 M"].C
    31900.0
    """
    built_in = (resources.files("mechsym.sizing.rules") / "bearings.csv").read_text(encoding="utf-8")
    found = _read(built_in, "bearings.csv")
    if extra is not None:
        found |= _read(read_text(extra, "bearings", "name a CSV file"), str(extra))
    return found


def _read(text, file):
    rows = list(csv.DictReader(text.splitlines()))
    return {row["designation"]: _bearing(row, file) for row in rows if row.get("designation")}


def _bearing(row, file):
    values = {key: row.get(key) or "" for key in ("designation", "kind", "source")}
    known = {f.name for f in fields(Bearing)}
    for column, text in row.items():
        stem, _, unit = (column or "").rpartition("_")
        if column in values or not text:
            continue
        if stem not in known or f"_{unit}" not in _UNITS:
            raise BadInput(f"{file}: column {column!r} is not known; the columns are those of mechsym's bearings.csv")
        values[stem] = parse(text, "-", f"{row['designation']}.{column}") * _UNITS[f"_{unit}"][1]
    try:
        return Bearing(**values)
    except (BadInput, TypeError) as error:
        raise BadInput(f"{file}: bearing {row['designation']!r}: {error}") from None
