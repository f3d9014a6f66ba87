"""Two engines side by side over the speeds: where their torque curves cross, and a table of differences."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.page import ShownFigures
from mechsym.quantities.names import stem_and_unit

_PEAKS = ("torque_avg", "torque_max", "power_kw", "mep_kpa", "efficiency", "p_max_mpa", "force_max", "brake_torque")
_ALONG = ("torque_avg", "power_kw", "mep_kpa", "sfc_g_kwh", "efficiency", "p_max_mpa", "heat", "work", "exhaust",
          "unburnt")  # fmt: skip
_SHARES = ("heat", "work", "exhaust", "unburnt")  # of the fuel, not joules
_SPEEDS_IN_TABLE = 9


class EngineComparison(ShownFigures):
    """Two engines at the same speeds, under the names of `mechsym compare`."""


def crossovers(speed: np.ndarray, a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Speeds at which two curves cross.

    Parameters
    ----------
    speed : ndarray, shape (n,)
        Increasing speeds, any unit [-]
    a, b : ndarray, shape (n,)
        The curves, any unit [-]

    Returns
    -------
    crossings : ndarray, shape (k,)
        Where a - b changes sign, straight between neighbours, unit of `speed` [-]
    """
    gap = a - b
    k = np.flatnonzero(gap[:-1] * gap[1:] < 0)
    inner = speed[k] + (speed[k + 1] - speed[k]) * gap[k] / (gap[k] - gap[k + 1])
    return np.sort(np.concatenate([inner, speed[gap == 0]]))


def compare(a: Mapping[str, Any], b: Mapping[str, Any]) -> EngineComparison:
    """Two engines at the same speeds.

    Parameters
    ----------
    a, b : mapping
        `cycle.columns` of each engine; equal `speed_rpm`

    Returns
    -------
    comparison : EngineComparison
        `crossover_rpm` (of the mean torque), `brake_crossover_rpm` (after friction), `at_crossover` (figures of the
        first engine there) and `table`, rows of `quantity`, `speed_rpm`, `a`, `b`, `difference` (b/a - 1); first the
        largest value of each quantity with its speed for either engine, then values at a few speeds
    """
    speed = np.asarray(a["speed_rpm"])
    flat_a, flat_b = _flat(a), _flat(b)
    crossing = crossovers(speed, flat_a["torque_avg"], flat_b["torque_avg"])
    at = [{k: float(np.interp(s, speed, flat_a[k])) for k in _ALONG} | {"speed_rpm": float(s)} for s in crossing]
    shown = np.unique(np.linspace(0, speed.size - 1, _SPEEDS_IN_TABLE).round().astype(int))
    rows = [_largest(k, speed, flat_a[k], flat_b[k]) for k in _PEAKS]
    rows += [_row(k, float(speed[i]), flat_a[k][i], flat_b[k][i]) for k in _ALONG for i in shown]
    brake = crossovers(speed, flat_a["brake_torque"], flat_b["brake_torque"])
    told = {"crossover_rpm": crossing, "brake_crossover_rpm": brake, "at_crossover": at, "table": rows}
    return EngineComparison(told)


def _flat(found: Mapping[str, Any]) -> dict[str, np.ndarray]:
    return {k: np.asarray(v) for k, v in found.items() if k not in ("fractions", "loads")} | dict(found["fractions"])


def _row(quantity: str, speed: float | None, a: float, b: float) -> dict[str, Any]:
    difference = float(b / a - 1) if a else None
    return {"quantity": quantity, "speed_rpm": speed, "a": float(a), "b": float(b), "difference": difference}


def unit_of(quantity: str) -> str:
    """Unit of a row of the table."""
    name = quantity.rpartition(" ")[2]
    return "-" if name in _SHARES else stem_and_unit(name)[1] or "-"


def _largest(quantity: str, speed: np.ndarray, a: np.ndarray, b: np.ndarray) -> dict[str, Any]:
    i, j = int(np.nanargmax(a)), int(np.nanargmax(b))
    row = _row(f"largest {quantity}", None, a[i], b[j])
    return row | {"speed_a_rpm": float(speed[i]), "speed_b_rpm": float(speed[j])}
