"""Reading a measured indicator diagram: a CSV file with a crank angle and a pressure column.

    # comment lines are kept
    crank_angle_deg,time_s,pressure_bar        units stand in the header: name_unit, name [unit] or name (unit)
    0,0.012470,1.5591
    ...

The angle may go on over the cycles or start again each turn or cycle; any spacing, any start. A file that cannot be
trusted is refused with its line, the reason and the way out; nothing is repaired silently.
"""

import math
import re
from pathlib import Path

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import parse, record
from mechsym.quantities.units import Radian, RadPerSecond
from mechsym.tables import numbers_of, split_table, text_of

# Units of a pressure and of an angle; `rad` and `Pa` are the SI units they become
_UNITS = {
    "rad": ("rad", "deg", "rev"),
    "Pa": ("Pa", "kPa", "MPa", "bar"),
    "s": ("s", "ms", "us"),
}
_HEADER = re.compile(r"^(?P<name>.*?)(?:_(?P<plain>[A-Za-z]+)|\s*[\[(]\s*(?P<bracketed>[^\])]*?)\s*[\])])$")
_ALIASES = {
    "°": "deg", "degCA": "deg", "CAD": "deg", "°CA": "deg", "°KW": "deg", "DEG": "deg", "Bar": "bar", "BAR": "bar",
}  # fmt: skip
_COARSEST = math.radians(15.0)
_RISING = 0.9  # share of the steps: a pressure falls in more than a third of them


@record
class Recording:
    """What stands in a diagram file, in SI, the angle made continuous."""

    file: str
    angle: np.ndarray  #: shape (n,): Ascending angle, its zero as in the file [rad]
    pressure: np.ndarray  #: shape (n,): Pressure as measured, offset unknown [Pa]
    lines: np.ndarray  #: shape (n,): Line of each sample in the file [-]
    comments: tuple[str, ...]
    columns: tuple[str, str]  #: Headers of the angle and the pressure column
    time: np.ndarray | None  #: shape (n,): Time of each sample; None when the file has no column of it [s]


def read_diagram(
    path: str | Path, period: Radian, angle_column: str = "", pressure_column: str = "",
    omega: RadPerSecond | None = None,
) -> Recording:  # fmt: skip
    """Read a diagram file and refuse what cannot be trusted.

    path: CSV file; columns divided by comma, semicolon or tab. period: 2 pi or 4 pi: how far at least the angle must
    go. angle_column, pressure_column: header of the column to take when several carry such a unit. omega: speed
    of a file that has times and no angles.
    """
    comments, header, rows = split_table(str(path), text_of(path))
    names, clock = header[1], _clock(header[1])
    by_time = omega is not None and clock and not any(_unit(name) in _UNITS["rad"] for name in names)
    angle_at, angle_unit = clock[0] if by_time else _column(str(path), header, "rad", angle_column)
    pressure_at, pressure_unit = _column(str(path), header, "Pa", pressure_column)
    lines = np.array([line for line, _ in rows])
    values = numbers_of(str(path), rows, names, (angle_at, pressure_at, *(at for at, _ in clock)))
    pressure = values[:, 1] * parse(f"1 {pressure_unit}", "Pa")
    _refuse_swapped(str(path), pressure, names[pressure_at])
    turned = omega * parse(f"1 {angle_unit}", "s") if by_time and omega else parse(f"1 {angle_unit}", "rad")
    angle = _continuous(str(path), values[:, 0] * turned, lines)
    _check_steps(str(path), angle, lines, names[angle_at])
    _check_span(str(path), angle, period, names[angle_at])
    _check_pressure(str(path), pressure, names[pressure_at])
    return Recording(
        file=str(path),
        angle=angle,
        pressure=pressure,
        lines=lines,
        comments=tuple(comments),
        columns=(names[angle_at], names[pressure_at]),
        time=_rising(str(path), values[:, 2] * parse(f"1 {clock[0][1]}", "s"), lines) if clock else None,
    )


def has_angles(path: str | Path) -> bool:
    """Whether a file has a column of crank angles; else it has times at best."""
    _, (_, names), _ = split_table(str(path), text_of(path))
    return any(_unit(name) in _UNITS["rad"] for name in names)


def _refuse_swapped(file: str, pressure: np.ndarray, name: str) -> None:
    if len(pressure) > 1 and np.mean(np.diff(pressure) > 0) > _RISING:
        raise BadInput(
            f"{file}: {name} rises from nearly every row to the next, as an angle or a time does and no pressure; are "
            "two columns swapped? exchange their headings, or name the right ones with angle_column and pressure_column"
        )


def _clock(names: list[str]) -> list[tuple[int, str]]:
    """The column of the time and its unit, if there is one."""
    return [(i, _unit(n)) for i, n in enumerate(names) if _unit(n) in _UNITS["s"] and n.lower().startswith("t")][:1]


def _rising(file: str, time: np.ndarray, lines: np.ndarray) -> np.ndarray:
    bad = np.flatnonzero(np.diff(time) <= 0)
    if bad.size:
        i = int(bad[0])
        raise BadInput(
            f"{file}, line {lines[i + 1]}: time {time[i + 1]:.9g} s does not rise from line {lines[i]} "
            f"({time[i]:.9g} s); time must rise row by row; mend it or leave the column out"
        )
    return time


def _column(file: str, header: tuple[int, list[str]], si: str, wanted: str) -> tuple[int, str]:
    line, names = header
    what, key = ("crank angle", "angle_column") if si == "rad" else ("pressure", "pressure_column")
    if wanted and wanted not in names:
        raise BadInput(f"{file}, line {line}: no column {wanted!r}; columns are {', '.join(names)}; change {key}")
    found = [(i, _unit(n)) for i, n in enumerate(names) if _unit(n) in _UNITS[si] and wanted in ("", n)]
    if len(found) == 1:
        return found[0]
    if found:
        choices = ", ".join(names[i] for i, _ in found)
        raise BadInput(f"{file}, line {line}: several {what} columns ({choices}); name one with {key}")
    raise BadInput(
        f"{file}, line {line}: no column has the unit of a {what} ({', '.join(_UNITS[si])}); columns are "
        f"{', '.join(names)}; write the unit into the name, for example "
        f"{'crank_angle_deg, or give the speed of a file of times' if si == 'rad' else 'pressure_bar'}"
    )


def _unit(name: str) -> str:
    match = _HEADER.match(name)
    unit = (match["plain"] or match["bracketed"] or "") if match else ""
    return _ALIASES.get(unit, unit)


def _continuous(file: str, angle: np.ndarray, lines: np.ndarray) -> np.ndarray:
    # an encoder starts again each turn or each cycle: a fall by whole turns, less one step, is no fault
    steps = np.diff(angle)
    turns = np.where(steps < -math.pi, np.ceil(-steps / (2 * math.pi)), 0.0)
    steps = steps + 2 * math.pi * turns
    bad = np.flatnonzero(steps <= 1e-9)
    if bad.size:
        i = int(bad[0])
        what = "repeats the angle of" if abs(steps[i]) <= 1e-9 else "falls behind"
        raise BadInput(
            f"{file}, line {lines[i + 1]}: angle {math.degrees(angle[i + 1]):.6g} deg {what} line {lines[i]} "
            f"({math.degrees(angle[i]):.6g} deg); angles must rise row by row and start again only after whole turns"
        )
    return angle[0] + np.concatenate([[0.0], np.cumsum(steps)])


def _check_steps(file: str, angle: np.ndarray, lines: np.ndarray, name: str) -> None:
    steps = np.diff(angle)
    usual = float(np.median(steps)) if steps.size else 0.0
    even = steps.size > 20 and float(np.mean(np.abs(steps - usual) < 0.05 * usual)) > 0.9
    limit = min(_COARSEST, 1.5 * usual) if even else _COARSEST
    bad = np.flatnonzero(steps > limit * (1 + 1e-9))
    if bad.size == 0:
        return
    i = int(bad[0])
    if usual > _COARSEST:
        raise BadInput(
            f"{file}, line {lines[i + 1]}: {math.degrees(usual):.4g} deg from row to row is too coarse, at most "
            f"{math.degrees(_COARSEST):g} deg are allowed; is the unit of {name} right?"
        )
    raise BadInput(
        f"{file}, line {lines[i + 1]}: gap of {math.degrees(steps[i]):.4g} deg after line {lines[i]} "
        f"(usual step {math.degrees(usual):.4g} deg); fill in the missing samples or cut the record there"
    )


def _check_span(file: str, angle: np.ndarray, period: float, name: str) -> None:
    # the step that closes the period may be as wide as the widest of the record
    widest = float(np.diff(angle).max()) if angle.size > 1 else 0.0
    span = float(angle[-1] - angle[0])
    if span + 1.001 * widest < period:
        raise BadInput(
            f"{file}: {name} covers {math.degrees(span):.6g} deg, not a full period of {math.degrees(period):g} deg; "
            "give a longer record, the right unit, or the right working_cycle"
        )


def _check_pressure(file: str, pressure: np.ndarray, name: str) -> None:
    swing = float(np.ptp(pressure))
    if not 0.5e5 <= swing <= 500e5:
        raise BadInput(
            f"{file}: {name} swings by {swing / 1e5:.4g} bar, no cylinder does (0.5 to 500 bar); "
            "is its unit right, and was the sensor connected?"
        )
