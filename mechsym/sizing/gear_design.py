"""The hypocycloid's gears: face width over the speeds, checks, and the search for module, teeth and shift.

One pair on each side of the crank; the planet's pitch diameter is half the ring's (2:1), so module times teeth is fixed
by the stroke. Named bases for the factor I: `internal` (AGMA 908 for the pair that runs) and `external` (the source's).

The checks of a gear pair of the hypocycloid.
"""

from collections.abc import Iterator
from dataclasses import replace
from functools import cache

import numpy as np

from mechsym.errors import BadInput
from mechsym.periodic.roots import root
from mechsym.quantities import record
from mechsym.quantities.units import Metre, Radian
from mechsym.sizing.checks import Check, at_least, at_most, at_speed
from mechsym.sizing.loads import reversed_tooth_load
from mechsym.sizing.rules import gears
from mechsym.sizing.rules.gear_bending import bending_geometry_factor
from mechsym.sizing.rules.gear_geometry import (
    Pair,
    contact_ratio,
    interference_margins,
    pitting_geometry_factor,
    top_land,
    undercut_shift,
)
from mechsym.sizing.rules.materials import Material, need
from mechsym.sizing.wants import GearPart, Wants, cycles

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
    """Geometry in the tool form of the source. kind: `internal`, or `external` for the source's stand-in."""
    return Pair(kind=kind, module=part.module, teeth_1=part.teeth_pinion, teeth_2=part.teeth_ring,
                pressure_angle=part.pressure_angle, shift=part.shift)  # fmt: skip


def rating(part: GearPart, loads: ToothLoads, wants: Wants, material: Material, kind: str = "internal") -> Rating:
    """Face widths that the load at each speed asks for, with the factors of the part's own face width.

    part: sizes; its face width enters the load distribution factor. kind: basis of I: `internal` or `external`.
    """
    pair, d = pair_of(part, kind), part.module * part.teeth_pinion
    K_v = gears.dynamic_factor(gears.mesh_speed(d, loads.omega), wants.accuracy)
    K_m = gears.load_distribution_factor(part.face, d, wants.C_pm, wants.enclosure, wants.C_e)
    K_R = gears.reliability_factor(wants.gear_reliability)
    times = np.clip(cycles(wants.life, loads.omega, 0.5), 1e4, 1e10)
    Y_N = np.array([gears.life_factor_bending(n) for n in times])
    Z_N = np.array([gears.life_factor_contact(n) for n in times])
    bears = gears.bending_limit(need(material, "gear_bending"), K_R=K_R)
    widths = []
    for member, returns in ((1, 4), (2, 2)):
        factors = gears.LoadFactors(K_m=K_m, K_B=_rim_factor(part, member))
        per_load = gears.face_width_bending(1.0, part.module, _bending_factor(pair, member), bears, factors)
        widths.append(per_load * reversed_tooth_load(loads.tooth, returns) * K_v / Y_N)
    Z_E = gears.elastic_coefficient(*(material.youngs_modulus, material.poisson) * 2)
    bears = gears.contact_limit(need(material, "gear_contact"), K_R=K_R)
    I = pitting_geometry_factor(pair)
    per_load = gears.face_width_contact(1.0, d, I, Z_E, bears, gears.LoadFactors(K_m=K_m))
    contact = per_load * np.abs(loads.tooth).max(axis=1) * K_v / Z_N**2
    return Rating(pinion_bending=widths[0], ring_bending=widths[1], contact=contact)


def face_width(part: GearPart, loads: ToothLoads, wants: Wants, material: Material, kind: str = "internal") -> Metre:
    """Face width that satisfies every limit with its own load distribution; that of `part` does not matter."""
    most = 2 * part.module * part.teeth_pinion

    def short(b: float) -> float:
        trial = replace(part, face=b)
        needs = rating(trial, loads, wants, material, kind)
        bending = max(float(needs.pinion_bending.max()), float(needs.ring_bending.max())) * wants.gear_bending
        return max(bending, float(needs.contact.max()) * wants.gear_contact**2) - b

    if short(most) > 0:
        raise BadInput(
            f"face width: {1e3 * (short(most) + most):.1f} mm are needed, the pinion bears {1e3 * most:.1f} mm"
        )
    return root(short, 1e-4, most, xtol=1e-9) if short(1e-4) > 0 else 1e-4


def candidates(d: Metre, pressure_angle: Radian, base: GearPart) -> Iterator[GearPart]:
    """Pairs of the source's modules and shifts that fit the pitch diameter and mesh without fault.

    d: pitch diameter of the planet.

    Yields part: with whole teeth, no undercut, no pointed tip, no interference, contact ratio of at least 1.2.
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
    pair, reasons = pair_of(part), []
    if undercut_shift(pair) > part.shift:
        reasons.append("pinion undercut")
    if top_land(pair) < _LEAST_TOP_LAND:
        reasons.append("pinion pointed")
    reasons += [f"{name} interference" for name, margin in interference_margins(pair).items() if margin <= 0]
    if not reasons and not _LEAST_CONTACT_RATIO <= contact_ratio(pair) < 2:
        reasons.append("contact ratio outside 1.2 to 2")
    return reasons


def _rim_factor(part: GearPart, member: int) -> float:
    pair = pair_of(part)
    if member == 1:
        depth = pair.whole_depth - (1 + part.shift)
        rim = (part.teeth_pinion / 2 - depth) * part.module - part.pinion_bore / 2
        if part.pinion_bore == 0:  # without bore there is no rim that could bend
            return 1.0
    else:
        depth = pair.whole_depth - (1 - part.shift)
        rim = part.ring_outside / 2 - (part.teeth_ring / 2 + depth) * part.module
    return gears.rim_factor(rim, pair.whole_depth * part.module)


@cache
def _bending_factor(pair: Pair, member: int) -> float:
    return bending_geometry_factor(pair, member)


def check_gears(
    part: GearPart, loads: ToothLoads, wants: Wants, material: Material, kind: str = "internal"
) -> list[Check]:
    """Strength, proportions and mesh of one pair.

    kind: basis of I: `internal`, or `external` as in the source. Returns checks: factors of bending hold against the
    load, that of pitting against the stress as in AGMA.
    """
    needs, rows = rating(part, loads, wants, material, kind), []
    for name, widths, wanted, power in (
        ("pinion, bending", needs.pinion_bending, wants.gear_bending, 1.0),
        ("ring, bending", needs.ring_bending, wants.gear_bending, 1.0),
        (f"mesh, pitting (I of the {kind} pair)", needs.contact, wants.gear_contact, 0.5),
    ):
        k = int(np.argmax(widths))
        factor = float((part.face / widths[k]) ** power)
        rows.append(
            Check(component=f"gears: {name}", quantity="face width", value=part.face, limit=float(widths[k]), unit="m",
                  safety_factor=factor, wanted=wanted, rule="AGMA 2101", source="eqs. 2.76 to 2.79",
                  note=at_speed(loads.omega, k))
        )  # fmt: skip
    return [*rows, *_proportions(part, loads, wants)]


def _proportions(part: GearPart, loads: ToothLoads, wants: Wants) -> list[Check]:
    pair, d = pair_of(part), part.module * part.teeth_pinion
    B = gears.accuracy_exponent(wants.accuracy)
    fastest = (50.0 + 56.0 * (1.0 - B) + 14.0 - wants.accuracy) ** 2 / 200.0
    speed = float(gears.mesh_speed(d, loads.omega).max())
    margin = min(interference_margins(pair).values())
    return [
        at_most("gears", "face width over pitch diameter", part.face / d, 2.0, "-", rule="AGMA 2101",
                source="ch. 4.4.2", wanted=1.0),
        at_most("gears", "mesh speed", speed, fastest, "m/s", rule="accuracy grade", source="eq. 4.29",
                note="of the planet against its carrier", wanted=1.0),
        at_least("gears", "contact ratio", contact_ratio(pair), 1.2, "-", rule="AGMA 908", source="section 4",
                 wanted=1.0),
        at_least("gears", "top land of the pinion in modules", top_land(pair), 0.3, "-", rule="AGMA 908",
                 source="section 7", wanted=1.0),
        Check(component="gears", quantity="undercut: shift beyond the least", value=part.shift - undercut_shift(pair),
              limit=0.0, unit="-", safety_factor=1.0 if part.shift >= undercut_shift(pair) else 0.0, wanted=1.0,
              rule="rack generation", source="AGMA 908, section 7"),
        Check(component="gears", quantity="interference: least margin", value=float(margin), limit=0.0, unit="-",
              safety_factor=1.0 if margin > 0 else 0.0, wanted=1.0, rule="involute, tip, base circle",
              source="SDP/SI eqs. 5-3 to 5-7"),
    ]  # fmt: skip
