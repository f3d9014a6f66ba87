"""The thesis's gear calculation, as it was made, and with its slips removed: tables 4.8 to 4.12.

As made: each member has its own K_v (pitch speed from its own diameter, half the true mesh speed for the pinion) and
its own K_m, the ring's diameter stands in its contact stress, I and J are those of an external pair as printed in table
4.8, 200 stands for 196.85.
Corrected: one mesh, I of the internal pair and J by the formulas of AGMA 908, load and factors of safety as printed.
"""

from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.papers.nunes2017.chapter4 import chapter4
from mechsym.papers.nunes2017.sizing_numbers import GEOMETRY
from mechsym.quantities import RPM
from mechsym.sizing.rules import gear_factors, gears
from mechsym.sizing.rules.gear_bending import bending_geometry_factor
from mechsym.sizing.rules.gear_geometry import Pair, pitting_geometry_factor
from mechsym.sizing.rules.materials import need

D_PINION, D_RING, WIDEST = 0.026, 0.052, 0.052
_Z_E = 187030.0  # table 4.10
_ANGLE = np.radians(25)


def _allowed(field: str) -> float:
    return need(chapter4().material("gears"), field)


def load_distribution_printed(member: int) -> float:
    """K_m of table 4.10.

    Returns
    -------
    K_m : float
        1.2537 and 1.1349 [-]
    """
    d, C_pm = (D_PINION, 1.1) if member == 1 else (D_RING, 1.0)
    return gear_factors.load_distribution_factor(WIDEST, d, C_pm, "extra-precision", 0.8)


def load_distribution_twin_contact() -> float:
    """K_m that table 4.12 uses for the ring in contact: eq. 4.22, meant for 25 mm and less, at 52 mm.

    Returns
    -------
    K_m : float
        1.12185 [-]
    """
    align = gear_factors.mesh_alignment_factor(WIDEST, "extra-precision")
    return 1 + (WIDEST / (10 * D_RING) - 0.025) + 0.8 * align


def dynamic_printed(member: int, rpm: Any, feet: float) -> Any:
    """K_v as the thesis made it.

    Parameters
    ----------
    member : int
        1 pinion, 2 ring: the pitch speed of a wheel of its diameter at the crank's speed
    rpm : float or ndarray
        Crank speed [rpm]
    feet : float
        196.85 in table 4.10, 200 in tables 4.11 and 4.12 [ft*s/(min*m)]

    Returns
    -------
    K_v : float or ndarray
        Dynamic factor [-]
    """
    d = D_PINION if member == 1 else D_RING
    return gear_factors.dynamic_factor(np.pi * d * np.asarray(rpm) / 60, 6.0, feet)


def widths_printed(shift: float, teeth: int, rpm: np.ndarray, tooth: np.ndarray, twin: bool) -> tuple[float, ...]:
    """A line of table 4.11, or of table 4.12 for the twin set.

    Parameters
    ----------
    shift : float
        Addendum modification [-]
    rpm, tooth : ndarray, shape (k,)
        Speeds [rpm] and largest tooth load at each [N]
    twin : bool
        Half the load on each of two sets

    Returns
    -------
    widths : tuple of float
        In the order of the table [m]
    """
    module = D_PINION / teeth
    I, *J = (float(text) for text in GEOMETRY[shift, teeth])
    share, found = 0.5 if twin else 1.0, []
    for member in (1, 2):
        load = share * np.max(tooth * dynamic_printed(member, rpm, 200.0))
        factors = gears.LoadFactors(K_m=load_distribution_printed(member))
        found.append(gears.face_width_bending(load, module, J[member - 1], _allowed("gear_bending"), factors))
    for member, d in ((1, D_PINION), (2, D_RING)):
        load = share * np.max(tooth * dynamic_printed(member, rpm, 200.0))
        ring = twin and member == 2
        factors = gears.LoadFactors(K_m=load_distribution_twin_contact() if ring else load_distribution_printed(member))
        found.append(gears.face_width_contact(load, d, I, _Z_E, _allowed("gear_contact"), factors))
    return tuple(float(b) for b in found)


def widths_corrected(
    shift: float, teeth: int, rpm: np.ndarray, tooth: np.ndarray, limits: Mapping[str, float] | None = None
) -> tuple[float, float, float]:
    """The twin set with the slips removed, at the face width of 52 mm that K_m was taken for.

    Parameters
    ----------
    shift : float
        Addendum modification [-]
    rpm, tooth : ndarray, shape (k,)
        Speeds [rpm] and largest tooth load at each [N]
    limits : mapping, optional
        `bending` and `contact` limit of another material [Pa]

    Returns
    -------
    pinion, ring, contact : float
        Face widths for bending of either and for the contact that they share [m]
    """
    bounds = {"bending": _allowed("gear_bending"), "contact": _allowed("gear_contact")} | dict(limits or {})
    module = D_PINION / teeth
    pair = Pair(kind="internal", module=module, teeth_1=teeth, teeth_2=2 * teeth, pressure_angle=_ANGLE, shift=shift)
    speed = gears.mesh_speed(D_PINION, np.asarray(rpm) * RPM)
    load = 0.5 * np.max(tooth * gear_factors.dynamic_factor(speed, 6.0))
    factors = gears.LoadFactors(K_m=load_distribution_printed(1))
    bend = [gears.face_width_bending(load, module, bending_geometry_factor(pair, m), bounds["bending"], factors)
            for m in (1, 2)]  # fmt: skip
    I = pitting_geometry_factor(pair)
    contact = gears.face_width_contact(load, D_PINION, I, _Z_E, bounds["contact"], factors)
    return float(bend[0]), float(bend[1]), float(contact)
