"""Published numbers of the thesis's chapters 2 and 3 that follow from its data without a cycle."""

from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from mechsym.cases import Case
from mechsym.cycle.chamber import Chamber, chamber, travel
from mechsym.cycle.kinds.ideal import otto_efficiency
from mechsym.jobs.cycle import engine
from mechsym.papers.nunes2017.numbers import Item
from mechsym.quantities import RPM

_TOP_SPEED = 8000 * RPM
_G = 9.81
# table 3.1, columns exchanged as the values demand: speed [rpm], start and duration of combustion [deg]
_TIMINGS = np.array([
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
        return float(np.abs(moved).max() * _TOP_SPEED**derivative)

    return fact


def _of_chamber(evaluate: Callable[[Chamber], Any]) -> Fact:
    return lambda cases: float(evaluate(_chamber(cases, "slider_crank")))


def _line(column: int, power: int) -> Fact:
    return lambda _: float(np.polyfit(_TIMINGS[:, 0], _TIMINGS[:, column], 1)[1 - power])


def _ratio(cases: Mapping[str, Case]) -> float:
    return 100 * (1 - _largest("hypocycloid", 2)(cases) / _largest("slider_crank", 2)(cases))


def _fact(item: str, published: str, slip: str = "", meant: str = "", about: float = 0.0) -> Item:
    return Item(item, published, "slider_crank", "", "", slip, meant, about)


_SWAPPED = "the columns of table 3.1 are exchanged"

FACTS: list[tuple[Item, Fact]] = [
    (_fact("ideal Otto efficiency at CR = 10 [%]", "60.19"), lambda _: 100 * otto_efficiency(10.0, 1.4)),
    (_fact("ideal Otto efficiency at CR = 10, section 5.1.1 [%]", "60.2"), lambda _: 100 * otto_efficiency(10.0, 1.4)),
    (_fact("piston area [m^2]", "0.02827", "0.02827 printed for 0.002827", "0.002827"), _of_chamber(lambda c: c.area)),
    (_fact("displacement, table 3.2 [m^3]", "2.9405e-4"), _of_chamber(lambda c: c.displacement)),
    (_fact("displacement, section 3.1.1 [m^3]", "2.9405e-5", "exponent -5 printed for -4", "2.9405e-4"),
     _of_chamber(lambda c: c.displacement)),
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
]  # fmt: skip
