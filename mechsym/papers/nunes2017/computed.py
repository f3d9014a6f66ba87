"""What the engine model of the thesis (chapters 2, 3 and 5) gives over the speeds, by its own march and converged."""

import math
from collections.abc import Mapping

import numpy as np

from mechsym.cases import Case, load
from mechsym.cycle.engine import columns, over_speeds
from mechsym.jobs.compare import crossovers
from mechsym.jobs.cycle import engine, speed_range
from mechsym.papers.nunes2017.numbers import Item

_ROD_74 = {"parameters.l1": "37 mm", "parameters.l2": "37 mm"}
ENGINES: dict[str, tuple[str, Mapping[str, str]]] = {
    "slider_crank": ("nunes-slider-crank", {}),
    "slider_crank_74": ("nunes-slider-crank", _ROD_74),
    "hypocycloid": ("nunes-hypocycloid", {}),
}
MODELS: dict[str, Mapping[str, str]] = {
    "printed": {"cycle.method": "nunes2017_printed"},
    "converged": {},
    "corrected": {"cycle.vaporisation": "liquid_energy", "chamber.back_pressure": "101325 Pa"},
}

Curves = Mapping[str, np.ndarray]


def over_printed_speeds() -> dict[str, Curves]:
    """Performance of the three engines over the speeds by the thesis's own march.

    Returns
    -------
    curves : dict of str to mapping
        `slider_crank`, `slider_crank_74` (rod of 74 mm) and `hypocycloid` to their quantities over the speeds
    """
    return curves_of(MODELS["printed"])


def value(item: Item, curves: Mapping[str, Curves]) -> float:
    """What a published number is on the curves of a model.

    Parameters
    ----------
    item : Item
        Engine, quantity, and `at`: a speed in rpm, or `max`, `min`, `max_rpm`, `min_rpm`
    curves : mapping of str to mapping
        Engine to its quantities over the speeds

    Returns
    -------
    value : float
        In the unit of the print [-]
    """
    speed, y = curves[item.engine]["speed_rpm"], curves[item.engine][item.quantity]
    if isinstance(item.at, str):
        k = int(np.argmax(y) if item.at.startswith("max") else np.argmin(y))
        return float(speed[k]) if item.at.endswith("_rpm") else float(y[k])
    return float(y[int(np.argmin(np.abs(speed - item.at)))])


def curves_of(changes: Mapping[str, str]) -> dict[str, Curves]:
    """Performance of the three engines over the speeds, with values of their cases changed."""
    found: dict[str, Curves] = {}
    for name, (case, own) in ENGINES.items():
        loaded: Case = load(case, {**own, **changes})
        table = columns(over_speeds(engine(loaded), speed_range(loaded.need("speeds"))))
        flat = {k: v for k, v in table.items() if k not in ("fractions", "loads")}
        found[name] = (
            flat
            | dict(table["fractions"])
            | dict(table["loads"])
            | {
                "efficiency_percent": 100 * table["efficiency"],
                "power_hp": 1.34102209 * table["power_kw"],  # eq. (2.47)
                "power_to_weight": table["power_kw"] / 13.4066,  # section 5.1.2, engine of 13406.6 g
            }
        )
    return found


def at_crossover(item: Item, curves: Mapping[str, Curves]) -> float:
    """A quantity of an engine where the torque of the hypocycloid overtakes it.

    Returns
    -------
    value : float
        In the unit of the print [-]
    """
    a, b = curves[item.engine], curves["hypocycloid"]
    crossing = crossovers(a["speed_rpm"], a["torque_avg"], b["torque_avg"])
    # the march's saw-tooth could cross more than once; the last crossing decides who wins at high speed
    return float(np.interp(crossing[-1], a["speed_rpm"], a[item.quantity])) if crossing.size else math.nan


def difference(item: Item, curves: Mapping[str, Curves]) -> float:
    """How far the hypocycloid is from an engine, at a speed or at most.

    Returns
    -------
    value : float
        In percent [-]
    """
    a, b = curves[item.engine], curves["hypocycloid"]
    gap = {"speed_rpm": a["speed_rpm"], item.quantity: 100 * np.abs(b[item.quantity] / a[item.quantity] - 1)}
    return value(item, {item.engine: gap})
