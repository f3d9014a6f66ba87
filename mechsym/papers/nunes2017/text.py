"""What the text of Nunes (2017) says of its figures in words or with "about", beside the thesis's own march."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.cases import load
from mechsym.cycle.chamber import chamber, travel
from mechsym.jobs.cycle import engine
from mechsym.papers.nunes2017 import SOURCE
from mechsym.papers.nunes2017.computed import Curves, over_printed_speeds, value
from mechsym.papers.nunes2017.numbers import Item
from mechsym.papers.rows import NOT_REPRODUCED, REPRODUCED, row

_LOWEST_RPM = 10
_ABOUT = 0.1
_CASES = {"OPSCE": "nunes-slider-crank", "OPGHE": "nunes-hypocycloid"}
_SC, _HY, _SC74 = "slider_crank", "hypocycloid", "slider_crank_74"
# sections 5.1.1 and 5.1.2, the beginning of the curves
_BEGINNINGS = [
    Item("OPSCE heat share at the lowest speed, about", "0.65", _SC, "heat", _LOWEST_RPM, about=_ABOUT),
    Item("OPSCE work share at the lowest speed, about", "0.15", _SC, "work", _LOWEST_RPM, about=_ABOUT),
    Item("OPSCE thermal efficiency at the lowest speed, about [%]", "15", _SC74, "efficiency_percent", _LOWEST_RPM,
         about=_ABOUT),
    Item("OPGHE heat share at the lowest speed, about", "0.65", _HY, "heat", _LOWEST_RPM, about=_ABOUT),
    Item("OPGHE work share at the lowest speed, about", "0.15", _HY, "work", _LOWEST_RPM, about=_ABOUT),
    Item("OPGHE thermal efficiency at the lowest speed, about [%]", "15", _HY, "efficiency_percent", _LOWEST_RPM,
         about=_ABOUT),
]  # fmt: skip


def rows() -> list[dict[str, Any]]:
    """Statements about the curves."""
    curves = over_printed_speeds()
    found = []
    for item in _BEGINNINGS:
        computed, published = value(item, curves), float(item.published)
        off = computed / published - 1
        found.append(_claim(item.item, item.published, computed, abs(off) <= item.about, f"{100 * off:+.0f} %"))
    return found + _variation(curves) + _near_top() + _sinusoidal()


def _claim(item: str, published: str, computed: float, holds: bool, note: str = "") -> dict[str, Any]:
    return row(SOURCE.stem, item, published, computed, REPRODUCED if holds else NOT_REPRODUCED, note)


def _variation(curves: Mapping[str, Curves]) -> list[dict[str, Any]]:
    unburnt = curves[_SC]["unburnt"]
    varied = float(100 * np.ptp(unburnt) / unburnt.max())
    return [
        _claim(
            "section 5.2: variation of the unburnt share, about [%]", "2.5", varied, abs(varied / 2.5 - 1) < _ABOUT,
            "largest over smallest; the thesis takes it for no difference of the engines",
        )
    ]  # fmt: skip


def _moved(case: str) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    machine = engine(load(case))
    room = chamber(machine.chamber, machine.motion)
    x, dx, d2x = travel(room.motion, np.linspace(0, 2 * np.pi, 3601)[:-1])
    return np.asarray(x), np.asarray(dx), np.asarray(d2x)


def _near_top() -> list[dict[str, Any]]:
    shares = {name: float(np.mean(_moved(case)[0] < 0.1 * 0.052)) for name, case in _CASES.items()}
    return [
        _claim(
            "Figs. 3.1, 3.6: OPGHE stays near top dead centre for longer, share of the turn in its tenth of the stroke "
            "over the OPSCE's", "> 1", shares["OPGHE"] / shares["OPSCE"], shares["OPGHE"] > shares["OPSCE"],
            f"{shares['OPGHE']:.3f} against {shares['OPSCE']:.3f}",
        )
    ]  # fmt: skip


def _sinusoidal() -> list[dict[str, Any]]:
    second = {}
    for name, case in _CASES.items():
        spectrum = np.abs(np.fft.rfft(_moved(case)[2]))
        second[name] = float(spectrum[2:].max() / spectrum[1])
    return [
        _claim(
            "Figs. 3.2 to 3.5: OPGHE moves sinusoidally, largest higher order of the acceleration", "sinusoidal",
            second["OPGHE"], second["OPGHE"] < 1e-12, f"OPSCE {second['OPSCE']:.3f}",
        )
    ]  # fmt: skip
