"""Moroianu (2017) prints definitions and nine curves without any data: no number of it can be checked.

The chain is computed with assumed data and drawn as in the source. Only the rule of Terskih, (3), gives numbers of its
own.
"""

from typing import Any

import numpy as np

from mechsym.forces.textbook import terskih
from mechsym.papers.moroianu2017 import SOURCE
from mechsym.papers.moroianu2017.computed import FIGURES, curves
from mechsym.papers.rows import NOT_COMPUTABLE, row
from mechsym.quantities import RPM

_SPEEDS_RPM = (100, 500, 1000)
_MISSING = "no mass, length, speed or diagram is printed; computed: largest value with the assumed case moroianu"
_NO_VALUE = "no value is printed; an empirical rule that knows nothing of the rod itself"


def rows() -> list[dict[str, Any]]:
    """Every figure with curves, and the rule of Terskih."""
    found = curves()[1]
    drawn = [
        _row(f"Fig. {number}: {name} [{unit}]", float(np.abs(getattr(found, field)).max()), _MISSING)
        for number, (field, name, unit) in FIGURES.items()
    ]
    return drawn + [_row(f"(3): L_m/L at {rpm} rpm", terskih(rpm * RPM), _NO_VALUE) for rpm in _SPEEDS_RPM]


def _row(item: str, computed: float, note: str) -> dict[str, Any]:
    return row(SOURCE.stem, item, None, computed, NOT_COMPUTABLE, note)
