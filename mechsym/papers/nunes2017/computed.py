"""Every number of the thesis's engine model (chapters 2, 3 and 5) beside what its own method gives, and beside the
converged and the corrected cycle.

`printed` is the thesis's one-degree march (`cycle.method = "nunes2017_printed"`), `converged` the same equations
integrated until they no longer change, `corrected` the converged cycle with the errors of the model removed: vapour
arrives with the internal energy of the liquid, the piston feels the atmosphere on its back.
"""

import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.cases import Case, load
from mechsym.jobs.compare import crossovers
from mechsym.jobs.cycle import columns, engine, over_speeds, speed_range
from mechsym.papers.nunes2017.facts import FACTS
from mechsym.papers.nunes2017.numbers import CROSSOVER, DIFFERENCES, OVER_SPEEDS, Item
from mechsym.papers.rows import last_digit

SOURCE = "004_e00ef50339108dab"
_ROD_74 = {"parameters.l1": "37 mm", "parameters.l2": "37 mm"}
_ENGINES: dict[str, tuple[str, Mapping[str, str]]] = {
    "slider_crank": ("nunes-slider-crank", {}),
    "slider_crank_74": ("nunes-slider-crank", _ROD_74),
    "hypocycloid": ("nunes-hypocycloid", {}),
}
_MODELS: dict[str, Mapping[str, str]] = {
    "printed": {"cycle.method": "nunes2017_printed"},
    "converged": {},
    "corrected": {"cycle.vaporisation": "liquid_energy", "chamber.back_pressure": "101325 Pa"},
}

Curves = Mapping[str, np.ndarray]


def rows() -> list[dict[str, Any]]:
    """The thesis's published numbers with their verdicts: engine model, then component sizing.

    Returns
    -------
    rows : list of dict
        Keys source, item, published, computed, rel_error, verdict, note, and converged, corrected (None where the
        models do not differ)
    """
    from mechsym.papers.nunes2017 import sizing as nunes2017_sizing

    return engine_rows() + nunes2017_sizing.rows()


def engine_rows() -> list[dict[str, Any]]:
    """The published numbers of chapters 2, 3 and 5."""
    models = {name: _curves(changes) for name, changes in _MODELS.items()}
    found = [_row(item, {name: value(item, curves) for name, curves in models.items()}) for item in OVER_SPEEDS]
    for items, evaluate in ((CROSSOVER, _at_crossover), (DIFFERENCES, _difference)):
        found += [_row(item, {name: evaluate(item, curves) for name, curves in models.items()}) for item in items]
    return found + facts()


def over_printed_speeds() -> dict[str, Curves]:
    """Performance of the three engines over the speeds by the thesis's own march.

    Returns
    -------
    curves : dict of str to mapping
        `slider_crank`, `slider_crank_74` (rod of 74 mm) and `hypocycloid` to their quantities over the speeds
    """
    return _curves(_MODELS["printed"])


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


def verdict(item: Item, computed: float) -> tuple[str, str]:
    """Verdict on one number by its printed digits.

    Parameters
    ----------
    item : Item
        The number as printed, and the source's slip if there is one
    computed : float
        The number as computed in the unit of the print [-]

    Returns
    -------
    verdict : str
        `reproduced`, `reproduced with the source's slip` or `not reproduced`
    note : str
        The slip, or how far off; empty when rounding gives the print
    """
    target = item.meant or item.published
    wanted, unit = float(target), max(last_digit(target), 2 * item.about * abs(float(target)))
    off = abs(computed - wanted) / unit
    # 0.55 for 0.5: T(5400) = 245.03252 is printed 245.032
    rounded = off <= 0.55
    truncated = not item.about and 0 <= abs(computed) - abs(wanted) < unit
    if not (rounded or truncated):
        return "not reproduced", "; ".join(filter(None, [item.slip, f"{off:.2f} of the last digit off"]))
    edge = f"{off:.2f} of the last digit off" if 0.5 < off <= 0.55 else ""
    notes = [item.slip, "" if rounded else "truncated in print", edge, "the text says about" if item.about else ""]
    return "reproduced with the source's slip" if item.slip else "reproduced", "; ".join(filter(None, notes))


def facts() -> list[dict[str, Any]]:
    """Published numbers that no cycle is needed for."""
    cases = {name: load(case, changes) for name, (case, changes) in _ENGINES.items()}
    return [_row(item, {"printed": fact(cases)}) for item, fact in FACTS]


def _curves(changes: Mapping[str, str]) -> dict[str, Curves]:
    found: dict[str, Curves] = {}
    for name, (case, own) in _ENGINES.items():
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


def _at_crossover(item: Item, curves: Mapping[str, Curves]) -> float:
    a, b = curves[item.engine], curves["hypocycloid"]
    crossing = crossovers(a["speed_rpm"], a["torque_avg"], b["torque_avg"])
    # the march's saw-tooth could cross more than once; the last crossing decides who wins at high speed
    return float(np.interp(crossing[-1], a["speed_rpm"], a[item.quantity])) if crossing.size else math.nan


def _difference(item: Item, curves: Mapping[str, Curves]) -> float:
    a, b = curves[item.engine], curves["hypocycloid"]
    gap = {"speed_rpm": a["speed_rpm"], item.quantity: 100 * np.abs(b[item.quantity] / a[item.quantity] - 1)}
    return value(item, {item.engine: gap})


def _row(item: Item, values: Mapping[str, float]) -> dict[str, Any]:
    computed = values["printed"]
    judged, note = verdict(item, computed)
    return {
        "source": SOURCE,
        "item": item.item,
        "published": item.published,
        "computed": computed,
        "rel_error": computed / float(item.published) - 1 if float(item.published) else None,
        "verdict": judged,
        "note": note,
        "converged": values.get("converged"),
        "corrected": values.get("corrected"),
    }
