"""The hypocycloid's gears: face width over the speeds, checks, and the search for module, teeth and shift.

One pair on each side of the crank; the planet's pitch diameter is half the ring's (2:1), so module times teeth is fixed
by the stroke. Named bases for the factor I: `internal` (AGMA 908 for the pair that runs) and `external` (the source's).
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.sizing.loads import reversed_tooth_load
from mechsym.sizing.parts.records import GearPart
from mechsym.sizing.rules import gear_factors, gear_life, gears
from mechsym.sizing.rules.gear_bending import bending_geometry_factor
from mechsym.sizing.rules.gear_geometry import Pair, contact_ratio, pitting_geometry_factor
from mechsym.sizing.rules.gear_interference import interference_margins, top_land, undercut_shift
from mechsym.sizing.rules.materials import Material, need
from mechsym.sizing.wants import Wants, cycles

MODULES = (0.5e-3, 0.8e-3, 1e-3, 1.25e-3, 1.5e-3, 2e-3, 2.5e-3, 3e-3, 4e-3)  # the source's list of usual modules
SHIFTS = (0.0, 0.25, 0.5)  # the source's three
_LEAST_CONTACT_RATIO, _LEAST_TOP_LAND, _LEAST_TEETH = 1.2, 0.3, 12


@record
class ToothLoads:
    """Tooth loads of one gear pair."""

    omega: np.ndarray  #: shape (k,): Crank speeds [rad/s]
    tooth: np.ndarray  #: shape (k, n): Tangential load of one pair over a period of 4 pi [N]


@record
class Rating:
    """What a pair needs at each speed; face widths in m, shape (k,)."""

    #: shape (k,): Face width that each limit asks for at safety factor 1 [m]
    pinion_bending: np.ndarray
    ring_bending: np.ndarray
    contact: np.ndarray


def pair_of(part: GearPart, kind: str = "internal") -> Pair:
    """The pair's geometry.

    Parameters
    ----------
    kind : str
        `internal`, or `external` for the source's stand-in

    Returns
    -------
    pair : Pair
        Geometry in the tool form of the source
    """
    return Pair(kind=kind, module=part.module, teeth_1=part.teeth_pinion, teeth_2=part.teeth_ring,
                pressure_angle=part.pressure_angle, shift=part.shift)  # fmt: skip


def rating(part: GearPart, loads: ToothLoads, wants: Wants, material: Material, kind: str = "internal") -> Rating:
    """Face widths that the load at each speed asks for, with the factors of the part's own face width.

    Parameters
    ----------
    part : GearPart
        Sizes; its face width enters the load distribution factor
    kind : str
        Basis of I: `internal` or `external`
    """
    pair, d = pair_of(part, kind), part.module * part.teeth_pinion
    K_v = gear_factors.dynamic_factor(gears.mesh_speed(d, loads.omega), wants.accuracy)
    K_m = gear_factors.load_distribution_factor(part.face, d, wants.C_pm, wants.enclosure, wants.C_e)
    K_R = gear_life.reliability_factor(wants.gear_reliability)
    times = np.clip(cycles(wants.life, loads.omega, 0.5), 1e4, 1e10)
    Y_N = np.array([gear_life.life_factor_bending(n) for n in times])
    Z_N = np.array([gear_life.life_factor_contact(n) for n in times])
    bears = gears.bending_limit(need(material, "gear_bending"), K_R=K_R)
    widths = []
    for member, returns in ((1, 4), (2, 2)):
        factors = gears.LoadFactors(K_m=K_m, K_B=_rim_factor(part, member))
        per_load = gears.face_width_bending(1.0, part.module, _bending_factor(pair, member), bears, factors)
        widths.append(per_load * reversed_tooth_load(loads.tooth, returns) * K_v / Y_N)
    Z_E = gear_factors.elastic_coefficient(*(material.youngs_modulus, material.poisson) * 2)
    bears = gears.contact_limit(need(material, "gear_contact"), K_R=K_R)
    I = pitting_geometry_factor(pair)
    per_load = gears.face_width_contact(1.0, d, I, Z_E, bears, gears.LoadFactors(K_m=K_m))
    contact = per_load * np.abs(loads.tooth).max(axis=1) * K_v / Z_N**2
    return Rating(pinion_bending=widths[0], ring_bending=widths[1], contact=contact)


def face_width(part: GearPart, loads: ToothLoads, wants: Wants, material: Material, kind: str = "internal") -> float:
    """Face width that satisfies every limit with the load distribution of that width.

    Parameters
    ----------
    part : GearPart
        Sizes; its own face width does not matter

    Returns
    -------
    b : float
        Face width [m]
    """
    most = 2 * part.module * part.teeth_pinion

    def short(b: float) -> float:
        trial = replace(part, face=b)
        return _needed(rating(trial, loads, wants, material, kind), wants) - b

    if short(most) > 0:
        raise BadInput(
            f"face width: {1e3 * (short(most) + most):.1f} mm are needed, the pinion bears {1e3 * most:.1f} mm"
        )
    return float(scipy.optimize.brentq(short, 1e-4, most, xtol=1e-9)) if short(1e-4) > 0 else 1e-4


def candidates(d: float, pressure_angle: float, base: GearPart) -> Iterator[GearPart]:
    """Pairs of the source's modules and shifts that fit the pitch diameter and mesh without fault.

    Parameters
    ----------
    d : float
        Pitch diameter of the planet [m]
    pressure_angle : float
        Pressure angle [rad]

    Yields
    ------
    part : GearPart
        With whole teeth, no undercut, no pointed tip, no interference, contact ratio of at least 1.2
    """
    for module in MODULES:
        teeth = round(d / module)
        if abs(teeth * module - d) > 1e-9 or teeth < _LEAST_TEETH:
            continue
        for shift in SHIFTS:
            part = replace(base, module=module, teeth_pinion=teeth, teeth_ring=2 * teeth, shift=shift,
                           pressure_angle=pressure_angle)  # fmt: skip
            if not faults(part):
                yield part


def faults(part: GearPart) -> list[str]:
    """What keeps a pair from running, in words."""
    pair, found = pair_of(part), []
    if undercut_shift(pair) > part.shift:
        found.append("pinion undercut")
    if top_land(pair) < _LEAST_TOP_LAND:
        found.append("pinion pointed")
    found += [f"{name} interference" for name, margin in interference_margins(pair).items() if margin <= 0]
    if not found and not _LEAST_CONTACT_RATIO <= contact_ratio(pair) < 2:
        found.append("contact ratio outside 1.2 to 2")
    return found


def _needed(found: Rating, wants: Wants) -> float:
    return max(
        float(found.pinion_bending.max()) * wants.gear_bending,
        float(found.ring_bending.max()) * wants.gear_bending,
        float(found.contact.max()) * wants.gear_contact**2,
    )


def _rim_factor(part: GearPart, member: int) -> float:
    pair = pair_of(part)
    depth = pair.whole_depth - (1 + part.shift if member == 1 else 1 - part.shift)
    pitch = part.teeth_pinion if member == 1 else part.teeth_ring
    if member == 1:
        rim = (pitch / 2 - depth) * part.module - part.pinion_bore / 2
        # a pinion without bore has no rim that could bend
        return gear_factors.rim_factor(rim, pair.whole_depth * part.module) if part.pinion_bore > 0 else 1.0
    return gear_factors.rim_factor(part.ring_outside / 2 - (pitch / 2 + depth) * part.module,
                                   pair.whole_depth * part.module)  # fmt: skip


@cache
def _bending_factor(pair: Pair, member: int) -> float:
    return bending_geometry_factor(pair, member)
