"""All checks of the hypocycloid engine, and the speeds at which they hold."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from mechsym.sizing.checks import Check, at_least, at_most, unsafe
from mechsym.sizing.hypocycloid.engine import bending_moment, crank_loads, cylinder_loads, seats, spans, tooth_loads
from mechsym.sizing.hypocycloid.parts import PartForces, Parts, Stock, chosen
from mechsym.sizing.parts.bearing_design import Choice, check_bearing
from mechsym.sizing.parts.crank_design import check_crank, check_output
from mechsym.sizing.parts.gear_checks import check_gears
from mechsym.sizing.parts.piston_design import check_cylinder, check_piston
from mechsym.sizing.parts.records import GearPart
from mechsym.sizing.rounding import at_speed
from mechsym.sizing.rules.fatigue import endurance_limit
from mechsym.sizing.rules.materials import get
from mechsym.sizing.rules.turning_shaft import Section, fatigue_factor
from mechsym.sizing.wants import Wants

_PLAY = 1e-6  # what a pitch radius may be off [m]


def check_all(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> list[Check]:
    """Every check of the engine.

    Returns
    -------
    checks : list of Check
        From the piston to the bearings
    """
    used = {place: get(dict(stock.materials), getattr(wants, place))
            for place in ("piston", "cylinder", "gears", "crankshaft", "shaft")}  # fmt: skip
    cylinder = cylinder_loads(forces)
    crank = crank_loads(parts, forces, wants, stock)
    teeth = tooth_loads(parts, forces, wants, stock)
    places = chosen(parts.bearings, stock)
    return [
        *check_piston(parts.piston, cylinder, wants, used["piston"]),
        *check_cylinder(parts.cylinder, cylinder, wants, used["cylinder"], parts.piston.height),
        *check_gears(parts.gears, teeth, wants, used["gears"]),
        *_check_pitch(parts.gears, forces.e),
        *check_crank(parts.crank, crank, wants, used["crankshaft"]),
        *check_pinion_shaft(parts, forces, wants, stock),
        *check_output(parts.crank.output, crank, wants, used["shaft"]),
        *[c for key, seat in seats(parts, forces, stock).items() for c in check_bearing(places[key], seat, wants)],
        _check_room(parts, wants, forces.e, places),
    ]


def _check_pitch(gears: GearPart, e: float) -> list[Check]:
    """The pinion rolls in the ring with the pitch radius e [m]; a row only where the pair has another."""
    off = abs(gears.module * gears.teeth_pinion / 2 - e)
    if off <= _PLAY:
        return []
    return [at_most("gears", "pitch radius of the pinion off e", off, _PLAY, "m", wanted=1.0, rule="pure rolling",
                    source="geometry", note="no pair of the modules at hand fits; choose another e")]  # fmt: skip


def _check_room(parts: Parts, wants: Wants, e: float, places: Mapping[str, Choice]) -> Check:
    largest = max(places["inner"].bearing.outside, places["outer"].bearing.outside)
    wall = places["main"].bearing.bore / 2 - e - largest / 2
    return at_least("carrier", "wall between journal and main bearing", wall, wants.carrier_wall, "m", wanted=1.0,
                    rule="room in the main bearing's bore", source="geometry")  # fmt: skip


def check_pinion_shaft(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> list[Check]:
    """Shaft under the pinion: bending between two journals, and the tooth's torque.

    Returns
    -------
    checks : list of Check
        One, or none when the pinion has no bore
    """
    d, material = parts.gears.pinion_bore, get(dict(stock.materials), wants.crankshaft)
    if d <= 0:
        return []
    M_x, M_y = bending_moment(parts, forces, stock)(spans(parts, stock).gear)
    torque = forces.e * tooth_loads(parts, forces, wants, stock).tooth
    section = Section(d=d, S_e=endurance_limit(material.ultimate, d, wants.surface), S_ut=material.ultimate)
    factor = fatigue_factor(section, M_x, M_y, -forces.theta, torque)
    k = int(np.argmin(factor))
    return [
        Check(component="shaft, under the pinion", quantity="fatigue factor", value=float(factor[k]), limit=1.0,
              unit="-", safety_factor=float(factor[k]), wanted=wants.fatigue, rule="Goodman, fibre by fibre",
              source="Shigley eq. 7-7", note=at_speed(forces.omega, k))
    ]  # fmt: skip


def holding(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> np.ndarray:
    """Speeds at which every check holds by itself.

    Returns
    -------
    held : ndarray, shape (k,)
        Whether all factors are reached at each speed [-]
    """
    arrays = ("omega", "dp_max", "net", "rod", "tooth", "radial", "torque", "spin")
    held = []
    for k in range(forces.omega.size):
        one = replace(forces, **{name: getattr(forces, name)[k : k + 1] for name in arrays})
        held.append(not unsafe(check_all(parts, one, wants, stock)))
    return np.array(held)


def fastest_run(held: np.ndarray) -> tuple[int, int]:
    """First and last index of the last run of true values.

    Parameters
    ----------
    held : ndarray, shape (k,)
        True at least once [-]

    Examples
    --------
    >>> fastest_run(np.array([True, True, False, True, False]))
    (3, 3)
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[0], held.astype(int), [0]])))
    return int(edges[-2]), int(edges[-1]) - 1
