"""Moroianu (2017) prints definitions and nine curves without any data: no number of it can be checked.

The chain is computed with assumed data and drawn as in the source. Only the rule of Terskih, (3), gives numbers of its
own.
"""

from functools import cache

import numpy as np

from mechsym.audit.read.algebra import FLOATS
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import complete
from mechsym.cases import load
from mechsym.forces.textbook import Chain, chain, terskih
from mechsym.forces.turn import Turn
from mechsym.jobs.machine import turn
from mechsym.papers.rows import NOT_COMPUTABLE, Row, row
from mechsym.papers.sources import Weighed, weighed
from mechsym.quantities import RPM

CASE = "moroianu"
_SPEEDS_RPM = (100, 500, 1000)
_MISSING = "no mass, length, speed or diagram is printed; computed: largest value with the assumed case moroianu"
_NO_VALUE = "no value is printed; an empirical rule that knows nothing of the rod itself"
# number of the figure: (field of the chain, its name in the source, unit)
FIGURES = {
    "1": ("F_p", "pressure force", "N"), "3": ("F_it", "inertia force", "N"), "4": ("F", "total force", "N"),
    "6": ("B", "longitudinal force", "N"), "7": ("N", "normal force", "N"), "9": ("Z_B", "radial force", "N"),
    "10": ("T", "tangential force", "N"), "11": ("Z", "total radial force", "N"), "12": ("M", "driving moment", "N*m"),
}  # fmt: skip


@cache
def curves() -> tuple[Turn, Chain]:
    """The chain over a turn, with the assumed data; the rod as two masses, its centre of mass after Terskih."""
    one = turn(load(CASE))
    return one, chain(one, terskih(one.omega))


def rows() -> list[Row]:
    """Every figure with curves, and the rule of Terskih."""
    chain = curves()[1]
    drawn = [
        row(f"Fig. {number}: {name} [{unit}]", None, np.abs(getattr(chain, field)).max(), NOT_COMPUTABLE, _MISSING)
        for number, (field, name, unit) in FIGURES.items()
    ]
    return drawn + [
        row(f"(3): L_m/L at {rpm} rpm", None, terskih(rpm * RPM), NOT_COMPUTABLE, _NO_VALUE) for rpm in _SPEEDS_RPM
    ]


def two_masses() -> Weighed:
    """What the two-mass rod leaves out, for the rod of source 000."""
    rod = theory("two_mass_rod")
    names = {k: letter.value for k, letter in rod.letters.items()}
    complete(rod, names, rod.results, FLOATS)
    missing, own = float(names["inertia_missing"]), float(names["I_C"])
    return weighed(False, -missing / own, left=own - missing, own=own)
