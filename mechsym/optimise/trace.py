"""A measured run: speeds, and forces or torques that were measured with them, over time, from a CSV file.

# comment lines are kept out
t_s,phi0d_rpm,M [N*m]        units stand in the header; names are the mechanism's own, `speed` is its first velocity
"""

import csv
import re
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from mechsym.errors import BadInput
from mechsym.files.inputs import read_text
from mechsym.files.tables import BEYOND
from mechsym.quantities import record
from mechsym.quantities.units import exponents, scale

_HEADER = re.compile(r"^(?P<name>\w+?)\s*(?:[\[(]\s*(?P<bracketed>[^\])]*?)\s*[\])]|_(?P<plain>rpm|rad_s|s|ms|nm|n))$")
_PLAIN = {"rad_s": "rad/s", "nm": "N*m", "n": "N"}
_FEWEST, _WIDEST_GAP = 50, 5.0
_LARGEST = 20e6  # of a file: half a million samples, read in three seconds
_AROUND = 5  # steps on either side that say how wide a step usually is


@record
class Trace:
    """A measured run, in SI."""

    file: str
    t: np.ndarray  #: shape (n,): Ascending times [s]
    speeds: Mapping[str, np.ndarray]  #: Measured velocities by their names, each of shape (n,) [unit]
    unit: str  #: Of the speeds, rad/s or m/s
    inputs: Mapping[str, np.ndarray]  #: Measured inputs by their names, each of shape (n,) [SI]


def read_trace(path: str | Path, velocities: Mapping[str, str], inputs: Mapping[str, str]) -> Trace:
    """Read a trace and refuse what cannot be trusted.

    path: CSV file, columns divided by commas; velocities, inputs: units of the mechanism's velocities and inputs by
    their names. Raises BadInput: no such file, no column of time or speed, no number, times that do not grow, too few
    samples, a gap.
    """
    header, rows = _table(str(path))
    first, usual = next(iter(velocities.items()))
    units = {**velocities, **inputs, "t": "s", "speed": usual}
    columns: dict[str, np.ndarray] = {}
    for number, title in enumerate(header):
        match = _HEADER.match(title)
        if match is None:
            raise BadInput(
                f"{str(path)}: column {title!r} names no unit; write for example t [s], speed [rpm], M [N*m]"
            )
        plain = match["plain"]
        name, unit = match["name"], match["bracketed"] if plain is None else _PLAIN.get(plain, plain)
        if name not in units:
            continue
        target = first if name == "speed" else name
        if target in columns:
            raise BadInput(f"{path}: column {target} stands twice; keep one")
        try:
            fits = exponents(unit) == exponents(units[name])
        except BadInput:
            fits = False
        if not fits:
            raise BadInput(
                f"{path}: column {title!r} is not in {units[name]}; write for example {name} [{units[name]}]"
            )
        columns[target] = rows[:, number] * scale(unit)
    if "t" not in columns:
        raise BadInput(f"{path}: no column of time; name it t [s]")
    speeds = {name: columns[name] for name in velocities if name in columns}
    if not speeds:
        other = " or speed [rpm]" if usual == "rad/s" else ""
        raise BadInput(f"{path}: no column of a speed; name it {first} [{usual}]{other}")
    if len({velocities[name] for name in speeds}) > 1:
        listed = ", ".join(f"{name} [{velocities[name]}]" for name in speeds)
        raise BadInput(f"{path}: {listed} cannot be weighed against each other; give speeds of one unit")
    _check(str(path), columns["t"], speeds)
    acting = {n: columns[n] for n in inputs if n in columns}
    return Trace(file=str(path), t=columns["t"], speeds=speeds, unit=velocities[next(iter(speeds))], inputs=acting)


def _table(file: str) -> tuple[list[str], np.ndarray]:
    # refuse a file that only its size tells to be too long, before it is read
    size = Path(file).stat().st_size if Path(file).is_file() else 0
    if size > _LARGEST:
        raise BadInput(
            f"{file}: {size / 1e6:.0f} MB; at most {_LARGEST / 1e6:.0f} MB are read: keep every tenth sample, or a "
            "shorter stretch (ten samples a turn or swing are enough)"
        )
    text = read_text(file, way_out="give the path of a CSV file", encoding="utf-8-sig")
    lines = [(n, line) for n, line in enumerate(text.splitlines(), 1) if line.strip() and not line.startswith("#")]
    if len(lines) <= _FEWEST:
        raise BadInput(f"{file}: holds {max(0, len(lines) - 1)} samples; a trace needs {_FEWEST} or more")
    cells = [(n, next(csv.reader([line]))) for n, line in lines]
    header = [title.strip() for title in cells[0][1]]
    rows = np.empty((len(cells) - 1, len(header)))
    for i, (n, row) in enumerate(cells[1:]):
        try:
            rows[i] = [float(cell) for cell in row]
        except ValueError:
            raise BadInput(f"{file}, line {n}: {len(header)} numbers are wanted, one a column; found {row}") from None
        if not (np.abs(rows[i]) < BEYOND).all():
            raise BadInput(
                f"{file}, line {n}: a value is not finite, or no measured one: {', '.join(row)}; leave such samples out"
            )
    return header, rows


def _check(file: str, t: np.ndarray, speeds: Mapping[str, np.ndarray]) -> None:
    steps = np.diff(t)
    if not (steps > 0).all():
        raise BadInput(f"{file}: the times do not grow from sample {int(np.argmin(steps > 0)) + 2} on; sort them")
    # median of the steps around each step [s], shape (n,): a trace may be written more finely at its end
    padded = np.pad(steps, _AROUND, mode="symmetric")
    wide = steps / np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * _AROUND + 1), axis=-1)
    if wide.max() > _WIDEST_GAP:
        i = int(np.argmax(wide))
        gap = f"a gap of {steps[i]:.3g} s after t = {float(t[i]):.6g} s"
        raise BadInput(f"{file}: {gap}; give the stretch before or after it")
    for name, values in speeds.items():
        if not np.ptp(values) > 0:
            raise BadInput(f"{file}: {name} does not change; a speed that stands still tells no parameter")
