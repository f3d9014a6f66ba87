"""Two engines side by side over the speeds: where their torque curves cross, and a table of differences."""

import numpy as np

from mechsym.cycle.columns import UNITS
from mechsym.files import Json
from mechsym.page import Shown
from mechsym.quantities import results
from mechsym.quantities.results import Columns, part, result
from mechsym.quantities.units import Array, Pure

_PEAKS = ("torque_avg", "torque_max", "power_kw", "mep_kpa", "efficiency", "p_max_mpa", "force_max", "brake_torque")
_SHARES = ("heat", "work", "exhaust", "unburnt")
_ALONG = ("torque_avg", "power_kw", "mep_kpa", "sfc_g_kwh", "efficiency", "p_max_mpa", *_SHARES)
_UNITS = {**UNITS, **dict.fromkeys(_SHARES, UNITS["fractions"])}
_SPEEDS_IN_TABLE = 9


@result
class ComparedValue:
    """A figure of both engines at one speed."""

    quantity: str = part()
    speed_rpm: float | None = results.quantity("rpm")  #: Speed of both
    a: float = results.quantity("@unit")  #: Of the first engine
    b: float = results.quantity("@unit")  #: Of the second engine
    difference: float | None = results.quantity("-")  #: b/a - 1
    unit: str


@result
class ComparedPeak(ComparedValue):
    """The largest value of a figure of either engine, each at its own speed."""

    speed_a_rpm: float = results.quantity("rpm")  #: Where the first engine has it
    speed_b_rpm: float = results.quantity("rpm")  #: Where the second engine has it


@result
class ComparedEngines:
    """Where the curves of two engines cross, and their figures side by side."""

    crossover_rpm: np.ndarray = results.quantity("rpm")  #: Where the curves of the mean torque cross
    brake_crossover_rpm: np.ndarray = results.quantity("rpm")  #: Where those after friction cross
    at_crossover: tuple[Columns, ...] = part()  #: Figures of the first engine where the mean torques cross
    #: First the largest value of each figure, then values at a few speeds
    table: tuple[ComparedValue | ComparedPeak, ...] = part()


@result
class EngineComparison(Shown):
    """Two engines at the same speeds."""

    cases: tuple[str, ...] = part()  #: Names of the engines
    numbers: ComparedEngines = part(inline=True)


def crossovers(speed: Pure[Array], a: Pure[Array], b: Pure[Array]) -> Pure[Array]:
    """Speeds at which two curves cross.

    speed: increasing speeds, any unit; a, b: the curves, any unit. Returns crossings: where a - b changes sign,
    straight between neighbours, unit of `speed`, shape (k,).
    """
    gap = a - b
    k = np.flatnonzero(gap[:-1] * gap[1:] < 0)
    inner = speed[k] + (speed[k + 1] - speed[k]) * gap[k] / (gap[k] - gap[k + 1])
    return np.sort(np.concatenate([inner, speed[gap == 0]]))


def compare(a: Json, b: Json, cases: tuple[str, ...] = ()) -> EngineComparison:
    """Two engines at the same speeds. a, b: `cycle.columns` of each engine; equal `speed_rpm`."""
    speed = np.asarray(a["speed_rpm"])
    flat_a, flat_b = _flat(a), _flat(b)
    crossing = crossovers(speed, flat_a["torque_avg"], flat_b["torque_avg"])
    at = [{k: float(np.interp(s, speed, flat_a[k])) for k in _ALONG} | {"speed_rpm": float(s)} for s in crossing]
    shown = np.unique(np.linspace(0, speed.size - 1, _SPEEDS_IN_TABLE).round().astype(int))
    rows: list[ComparedValue] = [_largest(k, speed, flat_a[k], flat_b[k]) for k in _PEAKS]
    rows += [
        ComparedValue(quantity=k, speed_rpm=float(speed[i]), **_pair(k, flat_a[k][i], flat_b[k][i]))
        for k in _ALONG
        for i in shown
    ]
    numbers = ComparedEngines(
        crossover_rpm=crossing,
        brake_crossover_rpm=crossovers(speed, flat_a["brake_torque"], flat_b["brake_torque"]),
        at_crossover=tuple(Columns(figures, _UNITS) for figures in at),
        table=tuple(rows),
    )
    return EngineComparison(cases=cases, numbers=numbers)


def _flat(found: Json) -> dict[str, np.ndarray]:
    return {k: np.asarray(v) for k, v in found.items() if k not in ("fractions", "loads")} | dict(found["fractions"])


def _pair(name: str, a: float, b: float) -> Json:
    return {"a": float(a), "b": float(b), "difference": float(b / a - 1) if a else None, "unit": _UNITS[name]}


def _largest(name: str, speed: np.ndarray, a: np.ndarray, b: np.ndarray) -> ComparedPeak:
    i, j = int(np.nanargmax(a)), int(np.nanargmax(b))
    return ComparedPeak(
        quantity=f"largest {name}",
        speed_rpm=None,
        speed_a_rpm=float(speed[i]),
        speed_b_rpm=float(speed[j]),
        **_pair(name, a[i], b[j]),
    )
