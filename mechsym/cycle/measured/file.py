r"""Reading a measured indicator diagram: a CSV file with a crank angle and a pressure column.

    # comment lines are kept
    crank_angle_deg,time_s,pressure_bar        units stand in the header: name_unit, name [unit] or name (unit)
    0,0.012470,1.5591
    ...

The angle may go on over the cycles or start again each turn or cycle; any spacing, any start. A file that cannot be
trusted is refused with its line, the reason and the way out; nothing is repaired silently.

A recording cut into cycles on one grid of angles.

    recording  |--------x--------x--------x-----|       x: cuts, one period apart, never through compression,
    cycles          k=0      k=1      k=2                   combustion or expansion

The cut is the record's own start where that is harmless, so that no cycle is lost; else it moves on to 120 degrees
behind the pressure peak.

Speed of a measured record from its times, and how far angles are off that were spread evenly over each turn.

time |        . '   by teeth: bent, the shaft slows down in compression and speeds up behind combustion
     |   . '
     | '_____|_____ angle     spread evenly: straight between two marks, with a kink at every mark
"""

import math
import re
from pathlib import Path

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber, dvolume_dphi
from mechsym.cycle.measured.diagram import Diagram, period_of
from mechsym.errors import BadInput
from mechsym.files.tables import numbers_of, split_table, text_of
from mechsym.quantities import parse, record
from mechsym.quantities.units import Array, Pascal, Radian, RadPerSecond

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
    columns = [(i, _unit(n)) for i, n in enumerate(names) if _unit(n) in _UNITS[si] and wanted in ("", n)]
    if len(columns) == 1:
        return columns[0]
    if columns:
        choices = ", ".join(names[i] for i, _ in columns)
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


# The cut may not lie between these angles from the pressure peak
_BEFORE, _AFTER = math.radians(-140.0), math.radians(80.0)
_CUT = math.radians(120.0)
_FEWEST, _MOST_SAMPLES = 720, 7200


def cut_cycles(recording: Recording, period: Radian) -> tuple[Radian[Array], Pascal[Array]]:
    """Cut a recording into whole cycles.

    period: 2 pi or 4 pi. Returns angle: evenly spaced angles of the first cycle, zero as in the file; cycles: pressure
    of each cycle, shape (k, n). An even record whose step divides the period is taken sample by sample; another one is
    interpolated with a monotone cubic (PCHIP) to steps no wider than its own. A record of a single cycle is continued
    periodically.
    """
    start = float(recording.angle[0])
    angle, cycles = _cut(recording.angle, recording.pressure, start, period)
    top = angle[int(np.argmax(cycles.mean(axis=0)))]
    behind = math.remainder(start - top, period)
    if not _BEFORE < behind < _AFTER:
        return angle, cycles
    wanted = start + (top + _CUT - start) % period
    if recording.angle[-1] - wanted >= period - 1.5 * (angle[1] - angle[0]):
        return _cut(recording.angle, recording.pressure, wanted, period)
    twice = np.concatenate([angle, angle + period])
    angle, cycles = _cut(twice, np.tile(cycles[0], 2), wanted, period)
    return angle, cycles[:1]


def _cut(angle: np.ndarray, pressure: np.ndarray, start: float, period: float) -> tuple[np.ndarray, np.ndarray]:
    steps = np.diff(angle)
    step, widest = float(np.median(steps)), float(steps.max())
    first = int(np.searchsorted(angle, start - 1e-3 * step))
    count = math.floor((angle[-1] - angle[first] + 1.001 * widest) / period)
    per_period = round(period / step)
    if bool(np.all(np.abs(steps - step) < 1e-3 * step)) and abs(per_period * step - period) < 1e-3 * step:
        cycles = pressure[first : first + count * per_period].reshape(count, per_period)
        return angle[first] + period / per_period * np.arange(per_period), cycles
    samples = int(np.clip(math.ceil(period / float(steps.min())), _FEWEST, _MOST_SAMPLES))
    grid = angle[first] + period / samples * np.arange(samples)
    at = grid + period * np.arange(count)[:, None]
    if at[-1, -1] > angle[-1]:
        # the last cycle closes on the pressure it began with
        pressure = np.append(pressure, np.interp(at[-1, 0], angle, pressure))
        angle = np.append(angle, at[-1, 0] + period)
    return grid, scipy.interpolate.PchipInterpolator(angle, pressure)(at)


_TURN = 2 * math.pi
_STRAIGHT = math.radians(0.1)
_KINK = 1e-3
_UNKNOWN = math.radians(1.5)  # where the speeds of the turns do not tell: usual for one cylinder
_LARGEST_ERROR = math.radians(4.0)


def cycle_speeds(recording: Recording, start: Radian, period: Radian, count: int) -> RadPerSecond[Array] | None:
    """Mean speed of every cycle.

    start: angle at which the first cycle begins; period: 2 pi or 4 pi. Returns omega: from the first to the last sample
    of each cycle; None without times, shape (k,).
    """
    if recording.time is None:
        return None
    at = np.searchsorted(recording.angle, start + period * np.arange(count + 1) - 1e-9)
    first, last = at[:-1], np.minimum(at[1:], recording.angle.size - 1)
    return (recording.angle[last] - recording.angle[first]) / (recording.time[last] - recording.time[first])


def recorded_speed(recording: Recording) -> RadPerSecond | None:
    """Mean speed of a whole record. Returns omega: None without times."""
    if recording.time is None:
        return None
    return float((recording.angle[-1] - recording.angle[0]) / (recording.time[-1] - recording.time[0]))


def speed_of(diagram: Diagram) -> RadPerSecond | None:
    """Speed that the file of a diagram tells by its times; None without them."""
    if not diagram.file:
        return None
    columns = diagram.angle_column, diagram.pressure_column
    return recorded_speed(read_diagram(diagram.file, period_of(diagram), *columns, diagram.recorded_speed))


def turn_speeds(recording: Recording) -> RadPerSecond[Array] | None:
    """Mean speed of every whole turn between two zeros of the encoder, where the angles are spread evenly over them.

    Returns omega: None without times, with fewer than three turns, or where the angles follow the shaft inside a turn,
    shape (k,).
    """
    if recording.time is None:
        return None
    turn = np.floor(recording.angle / _TURN + 1e-9)
    whole = [t for t in np.unique(turn) if np.count_nonzero(turn == t) > 20][1:-1]
    speeds = []
    for number in whole:
        angle, time = recording.angle[turn == number], recording.time[turn == number]
        slope, level = np.polyfit(time - time[0], angle, 1)
        if np.abs(level + slope * (time - time[0]) - angle).max() > _STRAIGHT:
            return None
        speeds.append(slope)
    by_turn = np.array(speeds)
    kinked = by_turn.size >= 3 and float(np.median(np.abs(np.diff(by_turn)) / by_turn.mean())) > _KINK
    return by_turn if kinked else None


def spread_error(
    turns: RadPerSecond[Array], phi: Radian[Array], p: Pascal[Array], cylinder: Chamber, zero: Radian
) -> Radian:
    r"""How far angles are off that were spread evenly over each turn.

    .. math:: \frac{\Delta\omega}{\omega} = \frac{1}{J\omega^2} \int (M - \bar M)\,d\varphi, \quad
        e = \int_{turn} \left(\frac{\Delta\omega}{\omega} - \overline{\frac{\Delta\omega}{\omega}}\right) d\varphi

    turns: speed of successive turns, shape (k,); phi: evenly spaced crank angles of one period, from firing TDC; p:
    absolute pressure of the mean cycle; zero: crank angle at which a turn of the encoder begins.

    Returns error: largest error over the period, from the gas torque M and the inertia J that explains by how much the
    speeds of successive turns differ; 1.5 degrees where they cannot tell.
    """
    step, count = float(phi[1] - phi[0]), round(phi.size * float(phi[1] - phi[0]) / _TURN)
    torque = p * dvolume_dphi(cylinder, phi)
    wave = np.cumsum(torque - torque.mean()) * step
    from_mark = np.argsort(np.remainder(phi - zero, phi.size * step))
    halves = np.array_split(wave[from_mark], count)
    differ = float(np.ptp([half.mean() for half in halves]))
    if count < 2 or differ < 0.02 * float(np.ptp(wave)):
        return _UNKNOWN
    seen = float(np.mean(np.abs(np.diff(turns)))) / float(turns.mean())
    error = np.concatenate([np.cumsum(half - half.mean()) for half in halves]) * step
    return min(float(np.abs(error).max()) * seen / differ, _LARGEST_ERROR)
