r"""A torque on the shaft from a table in place of the gas of a cycle: pumps, compressors, presses.

    phi [deg], torque [N*m], speed [rpm], load [-]       a row a sample; speed and load may be left out
    0,         -12.5,        900,         1

Positive drives the shaft. The heading says whether inertia is in it: `torque` is what works on the shaft without the
moving masses; `torque_with_inertia` was taken at the shaft at constant speed, and the share of the mechanism's masses
goes out of it at each speed of the file,

.. math:: M = M_\mathrm{file} + \tfrac12\,I'(\varphi)\,\omega^2

Over the angle it is joined by periodic cubics, between speeds and between loads by straight lines.
"""

import math
from collections.abc import Callable, Mapping
from functools import lru_cache

import numpy as np

from mechsym.errors import BadInput, suggest
from mechsym.files.tables import numbers_of, split_table, text_of
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import parse, quantity, record, reference
from mechsym.quantities.units import Pure, RadPerSecond

Function = Callable[[np.ndarray], np.ndarray]

_TURN = 2 * math.pi
_HEADS = {"phi": "rad", "torque": "N*m", "torque_with_inertia": "N*m", "speed": "rad/s", "load": "-"}
_CLOSED = 1e-6  # how near the last angle is to the end of the period where it repeats the first [rad]
_GAP = math.radians(15.0)  # widest step of the angle [rad]


@record
class TorqueCurve:
    """Section `[torque]`: a torque on the shaft over the angle, positive driving, in place of a cycle."""

    file: str = reference("file")  #: CSV: phi [deg], torque [N*m], speed [rpm], load [-]
    load: float = quantity("-", default=1.0, about="load, where the file has several")


@record
class TorqueTable:
    """What stands in the file of a torque curve."""

    file: str
    period: float  #: [rad]
    with_inertia: bool  #: Whether the moving masses are in it
    speeds: tuple[float, ...]  #: Ascending; empty where the file has none [rad/s]
    loads: tuple[float, ...]  #: Ascending [-]
    curves: Mapping[tuple[float, float], Function]  #: by speed [rad/s] and load [-]: phi [rad] to torque [N*m]
    angles: Mapping[tuple[float, float], np.ndarray]  #: by speed [rad/s] and load [-]: phi of its rows [rad]

    @property
    def kinks(self) -> tuple[float, ...]:
        """Where the third derivative jumps, at its rows, within a period [rad]."""
        return tuple(sorted({float(phi) % self.period for rows in self.angles.values() for phi in rows}))


def read_torque(path: str) -> TorqueTable:
    """Read a file of torque curves. Raises BadInput: it cannot be read, lacks a column, or leaves a gap."""
    return _parsed(path, text_of(path))


@lru_cache(maxsize=8)
def _parsed(path: str, text: str) -> TorqueTable:
    _, (line, names), rows = split_table(path, text)
    heads = _heads(path, line, names)
    values = numbers_of(path, rows, names, tuple(range(len(names))))
    factors = [1.0 if unit == "-" else parse(f"1 {unit}", _HEADS[head]) for head, unit in heads.items()]
    columns = dict(zip(heads, (values * factors).T, strict=True))
    torque = columns.get("torque", columns.get("torque_with_inertia"))
    assert torque is not None
    none = np.zeros(len(rows))
    places = np.column_stack([columns.get("speed", none), columns.get("load", none + 1.0)])
    pairs = sorted({(float(s), float(q)) for s, q in places})
    one = {p: np.all(places == p, axis=1) for p in pairs}
    period = _period(path, [columns["phi"][rows_of] for rows_of in one.values()])
    if "torque_with_inertia" in heads and "speed" not in heads:
        raise BadInput(f"{path}: torque_with_inertia depends on the speed; add the column speed [rpm]")
    speeds, loads = (tuple(sorted({p[k] for p in pairs})) for k in (0, 1))
    if missing := [(s, q) for s in speeds for q in loads if (s, q) not in one]:
        s, q = missing[0]
        raise BadInput(f"{path}: no rows for speed = {s:g} rad/s with load = {q:g}; give every load at every speed")
    return TorqueTable(
        file=path,
        period=period,
        with_inertia="torque_with_inertia" in heads,
        loads=loads,
        speeds=speeds if "speed" in heads else (),
        curves={p: _spline(path, columns["phi"][r], torque[r], period) for p, r in one.items()},
        angles={p: columns["phi"][r] for p, r in one.items()},
    )


def _heads(path: str, line: int, names: list[str]) -> dict[str, str]:
    heads: dict[str, str] = {}
    for name in names:
        head, _, unit = name.partition("[")
        if head.strip() not in _HEADS:
            raise BadInput(f"{path}, line {line}: column {name!r} is not known; {suggest(head.strip(), _HEADS)}")
        heads[head.strip()] = unit.rstrip("] ").strip() or _HEADS[head.strip()]
    if "phi" not in heads or len({"torque", "torque_with_inertia"} & set(heads)) != 1:
        raise BadInput(
            f"{path}, line {line}: a torque curve has the columns phi [deg] and either torque [N*m] or, where inertia "
            f"is in it, torque_with_inertia [N*m]; there are {', '.join(names)}"
        )
    return heads


def _period(path: str, angles: list[np.ndarray]) -> float:
    for phi in angles:
        if np.any(np.diff(phi) <= 0):
            raise BadInput(f"{path}: phi must rise row by row within one speed and load; sort the rows")
    span = max(float(np.ptp(phi)) for phi in angles)
    period = _TURN if span < _TURN + _CLOSED else 2 * _TURN
    for phi in angles:
        widest = max(float(np.diff(phi).max(initial=0.0)), period - float(np.ptp(phi)))
        if widest > _GAP + 1e-9 or np.ptp(phi) > period + _CLOSED:
            raise BadInput(
                f"{path}: phi leaves a gap of {math.degrees(widest):.4g} deg in {math.degrees(period):g} deg; at most "
                f"{math.degrees(_GAP):g} deg are allowed, over one turn or two"
            )
    return period


def _spline(path: str, phi: np.ndarray, torque: np.ndarray, period: float) -> Function:
    if np.ptp(phi) > period - _CLOSED:
        if abs(torque[-1] - torque[0]) > 1e-6 * float(np.abs(torque).max()):
            raise BadInput(f"{path}: the torque does not repeat: {torque[0]:g} N*m, a period later {torque[-1]:g} N*m")
        phi, torque = phi[:-1], torque[:-1]
    knots = np.append(phi, phi[0] + period)
    return PPoly.spline(knots, np.append(torque, torque[0]), periodic=True)


def torque_at(table: TorqueTable, omega: RadPerSecond, load: Pure, dinertia: Function) -> Function:
    """The torque without inertia at a speed and a load.

    load: in the file's measure; dinertia: angle [rad] to the slope of the mechanism's inertia [kg*m^2/rad]. Returns
    torque: angle [rad] to torque, positive driving [N*m]. Raises BadInput: Speed or load lie outside the file.
    """
    speeds = _shares(table, "speed", "rad/s", table.speeds, omega) if table.speeds else {0.0: 1.0}
    loads = _shares(table, "load", "", table.loads, load)

    def torque(phi: np.ndarray) -> np.ndarray:
        total = np.zeros_like(np.asarray(phi, dtype=float))
        for speed, of_speed in speeds.items():
            curve = sum(of_load * table.curves[speed, q](phi) for q, of_load in loads.items())
            total = total + of_speed * (curve + (dinertia(phi) * speed**2 / 2 if table.with_inertia else 0.0))
        return total

    return torque


def _shares(table: TorqueTable, what: str, unit: str, known: tuple[float, ...], wanted: float) -> dict[float, float]:
    """The one or two known values about the wanted one, each with its share."""
    size = max(abs(known[0]), abs(known[-1]))
    if len(known) == 1 and what == "speed" and not table.with_inertia:
        return {known[0]: 1.0}
    if not known[0] - 1e-9 * size <= wanted <= known[-1] + 1e-9 * size:
        behind = f" {unit}" if unit else ""
        allowed = f"{known[0]:g}" if len(known) == 1 else f"{known[0]:g} to {known[-1]:g}"
        why = f"{what} = {wanted:g}{behind} is outside the file's {allowed}{behind}"
        raise BadInput(f"{table.file}: {why}; add rows at that {what}, or change it")
    if len(known) == 1:
        return {known[0]: 1.0}
    k = min(max(int(np.searchsorted(known, wanted)), 1), len(known) - 1)
    share = min(max((wanted - known[k - 1]) / (known[k] - known[k - 1]), 0.0), 1.0)
    return {known[k - 1]: 1 - share, known[k]: share}
