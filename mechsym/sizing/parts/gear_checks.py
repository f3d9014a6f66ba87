"""The checks of a gear pair of the hypocycloid."""

import numpy as np

from mechsym.sizing.checks import Check, at_least, at_most
from mechsym.sizing.parts.gear_design import ToothLoads, pair_of, rating
from mechsym.sizing.parts.records import GearPart
from mechsym.sizing.rounding import at_speed
from mechsym.sizing.rules import gear_factors, gears
from mechsym.sizing.rules.gear_geometry import contact_ratio
from mechsym.sizing.rules.gear_interference import interference_margins, top_land, undercut_shift
from mechsym.sizing.rules.materials import Material
from mechsym.sizing.wants import Wants


def check_gears(
    part: GearPart, loads: ToothLoads, wants: Wants, material: Material, kind: str = "internal"
) -> list[Check]:
    """Strength, proportions and mesh of one pair.

    Parameters
    ----------
    kind : str
        Basis of I: `internal`, or `external` as in the source

    Returns
    -------
    checks : list of Check
        Factors of bending hold against the load, that of pitting against the stress as in AGMA
    """
    found, rows = rating(part, loads, wants, material, kind), []
    for name, widths, wanted, power in (
        ("pinion, bending", found.pinion_bending, wants.gear_bending, 1.0),
        ("ring, bending", found.ring_bending, wants.gear_bending, 1.0),
        (f"mesh, pitting (I of the {kind} pair)", found.contact, wants.gear_contact, 0.5),
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
    B = gear_factors.accuracy_exponent(wants.accuracy)
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
