"""A measured run: speeds, and forces or torques that were measured with them, over time, from a CSV file.

# comment lines are kept out
t_s,phi0d_rpm,M [N*m]        units stand in the header; names are the mechanism's own, `speed` is its first velocity
"""

import csv
import re
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import exponents, scale

_HEADER = re.compile(r"^(?P<name>\w+?)\s*(?:[\[(]\s*(?P<bracketed>[^\])]*?)\s*[\])]|_(?P<plain>rpm|rad_s|s|ms|nm|n))$")
_PLAIN = {"rad_s": "rad/s", "nm": "N*m", "n": "N"}
_FEWEST, _WIDEST_GAP = 50, 5.0
_AROUND = 5  # steps on either side that say how wide a step usually is


@record
class Trace:
    """A measured run, in SI."""

    file: str
    t: np.ndarray  #: shape (n,): Ascending times [s]
    speeds: Mapping[str, np.ndarray]  #: Measured velocities by their names, each of shape (n,) [rad/s]
    inputs: Mapping[str, np.ndarray]  #: Measured inputs by their names, each of shape (n,) [SI]


def read_trace(path: str | Path, velocities: Sequence[str], inputs: Mapping[str, str]) -> Trace:
    """Read a trace and refuse what cannot be trusted.

    Parameters
    ----------
    path : str or Path
        CSV file, columns divided by commas
    inputs : mapping of str to str
        Units of the mechanism's inputs by their names

    Raises
    ------
    BadInput
        No such file, no column of time or speed, no number, times that do not grow, too few samples, a gap
    """
    header, rows = _table(str(path))
    units = dict.fromkeys(velocities, "rad/s") | dict(inputs) | {"t": "s", "speed": "rad/s"}
    columns: dict[str, np.ndarray] = {}
    for number, title in enumerate(header):
        name, unit = _named(str(path), title)
        if name not in units:
            continue
        target = velocities[0] if name == "speed" else name
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
        raise BadInput(f"{path}: no column of a speed; name it {velocities[0]} [rad/s] or speed [rpm]")
    _check(str(path), columns["t"], speeds)
    return Trace(
        file=str(path), t=columns["t"], speeds=speeds, inputs={n: columns[n] for n in inputs if n in columns}
    )  # fmt: skip


def _table(file: str) -> tuple[list[str], np.ndarray]:
    try:
        text = Path(file).read_text(encoding="utf-8-sig")
    except (OSError, ValueError) as error:
        raise BadInput(f"{file}: cannot be read ({getattr(error, 'strerror', None) or 'not UTF-8 text'}); give the "
                       "path of a CSV file") from None  # fmt: skip
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
        if not np.isfinite(rows[i]).all():
            raise BadInput(f"{file}, line {n}: a value is not finite; leave such samples out")
    return header, rows


def _named(file: str, title: str) -> tuple[str, str]:
    found = _HEADER.match(title)
    if found is None:
        raise BadInput(f"{file}: column {title!r} names no unit; write for example t [s], speed [rpm], M [N*m]")
    plain = found["plain"]
    return found["name"], found["bracketed"] if plain is None else _PLAIN.get(plain, plain)


def _usual_steps(steps: np.ndarray) -> np.ndarray:
    """Median of the steps around each step [s], shape (n,): a trace may be written more finely at its end."""
    padded = np.pad(steps, _AROUND, mode="symmetric")
    return np.median(np.lib.stride_tricks.sliding_window_view(padded, 2 * _AROUND + 1), axis=-1)


def _check(file: str, t: np.ndarray, speeds: Mapping[str, np.ndarray]) -> None:
    steps = np.diff(t)
    if not (steps > 0).all():
        raise BadInput(f"{file}: the times do not grow from sample {int(np.argmin(steps > 0)) + 2} on; sort them")
    wide = steps / _usual_steps(steps)
    if wide.max() > _WIDEST_GAP:
        found = int(np.argmax(wide))
        at = float(t[found])
        raise BadInput(
            f"{file}: a gap of {steps[found]:.3g} s after t = {at:.6g} s; give the stretch before or after it"
        )
    for name, values in speeds.items():
        if not np.ptp(values) > 0:
            raise BadInput(f"{file}: {name} does not change; a speed that stands still tells no parameter")
