"""Published numbers of the thesis that lie on curves over the speed, read from `numbers.csv`, and their verdicts."""

import csv
import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from importlib import resources

import numpy as np

from mechsym.cases import Case, load
from mechsym.cycle.chamber import Chamber, chamber, travel
from mechsym.cycle.columns import crossovers
from mechsym.cycle.engine import columns, over_speeds
from mechsym.cycle.kinds.spark_ignition import otto_efficiency
from mechsym.jobs.cycle import engine, speed_range
from mechsym.papers.rows import NOT_REPRODUCED, REPRODUCED, SLIP, OtherModels, Row, last_digit, number
from mechsym.quantities import RPM, record


@record
class Item:
    """One published number."""

    item: str  #: What it is, with its place and the unit
    published: str  #: As printed
    engine: str = "hypocycloid"
    quantity: str = ""
    at: float | str = ""  #: A speed [rpm], max, min (value), max_rpm, min_rpm (speed), or crossover
    slip: str = ""  #: The source's slip that the computation follows
    meant: str = ""  #: What a misprinted number should say
    about: float = 0.0  #: Relative tolerance where the text itself says "about" [-]


def items(table: str) -> list[Item]:
    """Numbers of `numbers.csv`: over the `speeds`; where the torque curves cross, `crossover`; `differences`, section
    5.2 and fig. 5.18: magnitude of (hypocycloid/slider crank - 1) in percent, rod of 90 mm."""
    text = (resources.files("mechsym.papers.nunes2017") / "numbers.csv").read_text(encoding="utf-8")
    items = []
    for line in csv.DictReader(text.splitlines()):
        if line.pop("table") == table:
            at, about = number(line["at"]), float(line["about"] or 0)
            items.append(Item(**line | {"at": line["at"] if at is None else at, "about": about}))
    return items


def verdict(item: Item, computed: float) -> tuple[str, str]:
    """Verdict on one number by its printed digits, and the slip or how far off; `computed` in the print's unit [-]."""
    target = item.meant or item.published
    wanted, unit = float(target), max(last_digit(target), 2 * item.about * abs(float(target)))
    off = abs(computed - wanted) / unit
    # 0.55 for 0.5: T(5400) = 245.03252 is printed 245.032
    rounded = off <= 0.55
    truncated = not item.about and 0 <= abs(computed) - abs(wanted) < unit
    if not (rounded or truncated):
        return NOT_REPRODUCED, "; ".join(filter(None, [item.slip, f"{off:.2f} of the last digit off"]))
    edge = f"{off:.2f} of the last digit off" if 0.5 < off <= 0.55 else ""
    notes = [item.slip, "" if rounded else "truncated in print", edge, "the text says about" if item.about else ""]
    return SLIP if item.slip else REPRODUCED, "; ".join(filter(None, notes))


def item_row(item: Item, models: Mapping[str, float | None], agrees: str = REPRODUCED) -> Row:
    """A row for one number.

    models: what the `printed`, the `converged` and the `corrected` model give, in the unit of the print; agrees: the
    verdict where the number is reproduced.
    """
    computed = models["printed"]
    assert computed is not None
    judged, note = verdict(item, computed)
    outcome = agrees if judged == REPRODUCED else judged
    row = Row(item=item.item, published=item.published, computed=computed, verdict=outcome, note=note)
    others = OtherModels(unit=row.unit, converged=models.get("converged"), corrected=models.get("corrected"))
    return replace(row, models=others)


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


def value(item: Item, curves: Mapping[str, Curves]) -> float:
    """What a published number is on the curves of a model, by engine; in the unit of the print [-]."""
    speed, y = curves[item.engine]["speed_rpm"], curves[item.engine][item.quantity]
    if isinstance(item.at, str):
        k = int(np.argmax(y) if item.at.startswith("max") else np.argmin(y))
        return float(speed[k]) if item.at.endswith("_rpm") else float(y[k])
    return float(y[int(np.argmin(np.abs(speed - item.at)))])


def curves_of(changes: Mapping[str, str]) -> dict[str, Curves]:
    """Performance of the three engines over the speeds, with values of their cases changed."""
    curves: dict[str, Curves] = {}
    for name, (case, own) in ENGINES.items():
        loaded: Case = load(case, {**own, **changes})
        table = columns(over_speeds(engine(loaded), speed_range(loaded.need("speeds"))))
        curves[name] = {
            **{k: v for k, v in table.items() if k not in ("fractions", "loads")},
            **table["fractions"],
            **table["loads"],
            "efficiency_percent": 100 * table["efficiency"],
            "power_hp": 1.34102209 * table["power_kw"],  # eq. (2.47)
            "power_to_weight": table["power_kw"] / 13.4066,  # section 5.1.2, engine of 13406.6 g
        }
    return curves


def at_crossover(item: Item, curves: Mapping[str, Curves]) -> float:
    """A quantity of an engine where the torque of the hypocycloid overtakes it [-]."""
    a, b = curves[item.engine], curves["hypocycloid"]
    crossing = crossovers(a["speed_rpm"], a["torque_avg"], b["torque_avg"])
    # the march's saw-tooth could cross more than once; the last crossing decides who wins at high speed
    return float(np.interp(crossing[-1], a["speed_rpm"], a[item.quantity])) if crossing.size else math.nan


def difference(item: Item, curves: Mapping[str, Curves]) -> float:
    """How far the hypocycloid is from an engine, at a speed or at most [-]."""
    a, b = curves[item.engine], curves["hypocycloid"]
    gap = {"speed_rpm": a["speed_rpm"], item.quantity: 100 * np.abs(b[item.quantity] / a[item.quantity] - 1)}
    return value(item, {item.engine: gap})


TOP_SPEED = 8000 * RPM
_G = 9.81
# table 3.1, columns exchanged as the values demand: speed [rpm], start and duration of combustion [deg]
TIMINGS = np.array([
    (1200, 352, 32), (2400, 348, 41), (3600, 350, 39), (4800, 349, 44), (6000, 346, 44), (7600, 349, 51),
    (9200, 347, 56),
], float)  # fmt: skip

Fact = Callable[[Mapping[str, Case]], float]


def _chamber(cases: Mapping[str, Case], name: str) -> Chamber:
    machine = engine(cases[name])
    return chamber(machine.chamber, machine.motion)


def _largest(name: str, derivative: int) -> Fact:
    def fact(cases: Mapping[str, Case]) -> float:
        moved = travel(_chamber(cases, name).motion, np.radians(np.arange(361.0)))[derivative]
        return float(np.abs(moved).max() * TOP_SPEED**derivative)

    return fact


def _of_chamber(evaluate: Callable[[Chamber], float]) -> Fact:
    return lambda cases: float(evaluate(_chamber(cases, "slider_crank")))


def _line(column: int, power: int) -> Fact:
    return lambda _: float(np.polyfit(TIMINGS[:, 0], TIMINGS[:, column], 1)[1 - power])


def _ratio(cases: Mapping[str, Case]) -> float:
    return 100 * (1 - _largest("hypocycloid", 2)(cases) / _largest("slider_crank", 2)(cases))


def _fact(item: str, published: str, slip: str = "", meant: str = "") -> Item:
    return Item(item=item, published=published, engine="slider_crank", slip=slip, meant=meant)


_SWAPPED = "the columns of table 3.1 are exchanged"

FACTS: list[tuple[Item, Fact]] = [
    (_fact("ideal Otto efficiency at CR = 10 [%]", "60.19"), lambda _: 100 * otto_efficiency(10.0, 1.4)),
    (_fact("ideal Otto efficiency at CR = 10, section 5.1.1 [%]", "60.2"), lambda _: 100 * otto_efficiency(10.0, 1.4)),
    (_fact("piston area [m^2]", "0.02827", "0.02827 printed for 0.002827", "0.002827"), _of_chamber(lambda c: c.area)),
    (_fact("displacement, table 3.2 [m^3]", "2.9405e-4"), _of_chamber(lambda c: c.displacement)),
    (
        _fact("displacement, section 3.1.1 [m^3]", "2.9405e-5", "exponent -5 printed for -4", "2.9405e-4"),
        _of_chamber(lambda c: c.displacement),
    ),
    (_fact("clearance volume [m^3]", "3.2673e-5"), _of_chamber(lambda c: c.clearance)),
    (_fact("bore over half-stroke", "1.154"), _of_chamber(lambda c: c.bore / c.stroke)),
    (_fact("bore over stroke", "0.577"), _of_chamber(lambda c: c.bore / (2 * c.stroke))),
    (_fact("start of combustion, constant of eq. (3.1) [deg]", "350.93", _SWAPPED), _line(1, 0)),
    (_fact("start of combustion, slope of eq. (3.1) [deg/rpm]", "-0.0004", _SWAPPED), _line(1, 1)),
    (_fact("duration of combustion, constant of eq. (3.2) [deg]", "30.663", _SWAPPED), _line(2, 0)),
    (_fact("duration of combustion, slope of eq. (3.2) [deg/rpm]", "0.0027", _SWAPPED), _line(2, 1)),
    (_fact("OPSCE largest piston velocity [m/s]", "22.7"), _largest("slider_crank", 1)),
    (_fact("OPGHE largest piston velocity [m/s]", "21.8"), _largest("hypocycloid", 1)),
    (_fact("OPSCE largest piston acceleration [m/s^2]", "23519.4"), _largest("slider_crank", 2)),
    (_fact("OPSCE largest piston acceleration [g]", "2397.5"), lambda c: _largest("slider_crank", 2)(c) / _G),
    (_fact("OPGHE largest piston acceleration [m/s^2]", "18247.8"), _largest("hypocycloid", 2)),
    (_fact("OPGHE largest piston acceleration [g]", "1860.1"), lambda c: _largest("hypocycloid", 2)(c) / _G),
    (_fact("reduction of the largest acceleration [%]", "22.4"), _ratio),
]
