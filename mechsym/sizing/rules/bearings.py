"""Rolling bearings: equivalent load, rating life, rating of a set, static factor.

Source: ISO 281 and ISO 76; worked examples from Budynas and Nisbett, Shigley's Mechanical Engineering Design, ch. 11.

The bearings that a design may choose from: the source's four, a few that fit its engine, and the user's own.

`bearings.csv` names the origin of every line; more bearings come from a CSV file of the same columns. A bearing used
without its inner ring runs on a shaft of diameter `raceway`.
"""

import csv
from collections.abc import Mapping
from dataclasses import fields
from importlib import resources
from pathlib import Path
from typing import Annotated

import numpy as np

from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.files.inputs import read_text
from mechsym.quantities import RPM, choice, parse, quantity, record
from mechsym.quantities.units import Array, Newton, Pure, Radian, RadPerSecond, Scalar
from mechsym.sizing.checks import require

_UNITS = {"_mm": ("m", 1e-3), "_N": ("N", 1.0), "_rpm": ("rad/s", RPM), "_kg": ("kg", 1.0)}


@record
class Bearing:
    """A rolling bearing."""

    designation: str  #: Maker's name
    kind: str = choice("ball", "roller", "drawn-cup", about="rolling elements; drawn-cup: needles")
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
    source: str = ""  #: Where the data come from

    def __post_init__(self) -> None:
        if self.outside <= self.bore:
            raise BadInput(f"bearing {self.designation}: outside {self.outside:g} m must be larger than bore")


def catalogue(extra: str | Path | None = None) -> dict[str, Bearing]:
    """The built-in bearings, and those of a CSV file with the same columns.

    extra: file with more bearings; a designation that exists already is replaced. Raises BadInput: file not readable, a
    column missing or not known, a value out of range. Source: Nunes (2017), table 4.16, and what `bearings.csv` names.

    >>> catalogue()["6013 M"].C
    31900.0
    """
    built_in = (resources.files("mechsym.sizing.rules") / "bearings.csv").read_text(encoding="utf-8")
    bearings = _read(built_in, "bearings.csv")
    if extra is not None:
        bearings |= _read(read_text(extra, "bearings", "name a CSV file"), str(extra))
    return bearings


def _read(text: str, file: str) -> dict[str, Bearing]:
    rows = list(csv.DictReader(text.splitlines()))
    return {row["designation"]: _bearing(row, file) for row in rows if row.get("designation")}


def _bearing(row: Mapping[str, str], file: str) -> Bearing:
    values: Json = {key: row.get(key) or "" for key in ("designation", "kind", "source")}
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


_RELIABILITY = {0.90: 1.0, 0.95: 0.64, 0.96: 0.55, 0.97: 0.47, 0.98: 0.37, 0.99: 0.25}


def life_exponent(kind: str) -> Pure:
    """Exponent of the life equation.

    Returns p: 3 for balls, 10/3 for rollers. Source: ISO 281.

    >>> life_exponent("ball")
    3.0
    """
    return 3.0 if kind == "ball" else 10 / 3


def equivalent_load(F: Newton[Array], kind: str, turns: Radian[Array] | None = None) -> Newton[Array]:
    r"""Constant load with the same life as a load history.

    .. math:: P = \left(\frac{\int |F|^p\,\mathrm{d}\varphi}{\int \mathrm{d}\varphi}\right)^{1/p}

    F: radial load at equal steps over a period, shape (..., n); turns: turning of the bearing in each step, equal when
    not given. Returns P: equivalent dynamic load, shape (...). Source: ISO 281 with the linear damage rule. Valid: pure
    radial load. Half of the turns at 8 kN, half unloaded, in a ball bearing: 8 / 2^(1/3).

    >>> f"{equivalent_load(np.array([8000.0, 0.0]), 'ball'):.0f}"
    '6350'
    """
    p = life_exponent(kind)
    weights = np.ones(np.shape(F)[-1]) if turns is None else np.asarray(turns, dtype=float)
    require("turns", weights, "rad", low=0)
    return (np.sum(np.abs(F) ** p * weights, axis=-1) / weights.sum()) ** (1 / p)


def set_rating(C: Newton, count: int, kind: str) -> Newton:
    r"""Dynamic rating of equal bearings side by side.

    .. math:: C_i = i^{7/9}\,C \quad\text{(rollers)}, \qquad i^{0.7}\,C \quad\text{(balls)}

    C: rating of one bearing. Returns C_i: rating of the set.
    Source: ISO 281, clauses 5.1.2 and 7.1.2. Print: Nunes (2017), ch. 4.8, adds the dynamic ratings (30.2 kN for two).

    >>> f"{set_rating(15100.0, 2, 'drawn-cup'):.0f}"
    '25889'
    """
    require("count", count, "-", low=1, high=8)
    return C * count ** (0.7 if kind == "ball" else 7 / 9)


def life_revolutions(C: Newton, P: Newton[Scalar], kind: str, reliability: Pure = 0.9) -> Pure[Scalar]:
    r"""Rating life in revolutions.

    .. math:: L = a_1\left(\frac{C}{P}\right)^p 10^6

    C: dynamic rating; P: equivalent load, at most C / 2 for the life to be meant literally; reliability: 0.90, 0.95,
    0.96, 0.97, 0.98 or 0.99. Returns L: revolutions that this share of bearings survives. Source: ISO 281:2007, table
    12 for a_1. Shigley, problem 11-3 (8th ed.): 10.279 kN for 1440e6 revolutions needs C = 91.1 kN in a roller bearing.

    >>> f"{life_revolutions(91.1e3, 10.279e3, 'roller'):.3g}"
    '1.44e+09'
    """
    require("rating C and load P", np.append(np.atleast_1d(P), C), "N", above=0)
    if reliability not in _RELIABILITY:
        raise BadInput(f"reliability = {reliability} is not an option; options are {list(_RELIABILITY)}")
    return _RELIABILITY[reliability] * (C / P) ** life_exponent(kind) * 1e6


def required_rating(P: Newton, revolutions: Pure, kind: str) -> Newton:
    r"""Dynamic rating for a wanted life.

    .. math:: C = P\,(L/10^6)^{1/p}

    P: equivalent load. Source: ISO 281.

    >>> f"{required_rating(10.279e3, 1440e6, 'roller') / 1e3:.1f}"  # Shigley, problem 11-3 (8th ed.)
    '91.1'
    """
    require("load P", P, "N", low=0)
    require("wanted life", revolutions, "-", above=0)
    return P * (revolutions / 1e6) ** (1 / life_exponent(kind))


def life_hours(revolutions: Pure[Scalar], omega: RadPerSecond[Scalar]) -> Annotated[Scalar, "h"]:
    r"""Life in hours at constant speed.

    .. math:: L_h = \frac{2\pi L}{3600\,|\omega|}

    omega: speed of one ring relative to the other. Source: ISO 281.

    >>> f"{life_hours(540e6, 300 * 2 * np.pi / 60):.0f}"  # Shigley, problem 11-1 (8th ed.): 30000 h
    '30000'
    """
    require("speed omega", np.abs(omega), "rad/s", above=0)
    return 2 * np.pi * revolutions / (3600 * np.abs(omega))
