"""All checks of the hypocycloid engine, the speeds at which they hold, and its rows."""

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from mechsym.quantities.units import Array, Kilogram, Pure, Watt
from mechsym.sizing.bearing_design import Choice, check_bearing
from mechsym.sizing.checks import Check, at_least, at_most, at_speed, unsafe
from mechsym.sizing.crank_design import check_crank, check_output
from mechsym.sizing.gear_design import check_gears
from mechsym.sizing.hypocycloid.engine import (
    PartForces,
    Parts,
    Stock,
    bending_moment,
    chosen,
    crank_loads,
    cylinder_loads,
    seats,
    shaft,
    spans,
    tooth_loads,
)
from mechsym.sizing.hypocycloid.masses import Moving, PrintedMasses, part_masses
from mechsym.sizing.piston_design import check_cylinder, check_piston
from mechsym.sizing.rows import SizeRow, fact, size_rows
from mechsym.sizing.rules.fatigue import endurance_limit
from mechsym.sizing.rules.masses import power_to_weight
from mechsym.sizing.rules.turning_shaft import Section, fatigue_factor, inner_slope
from mechsym.sizing.wants import GearPart, Wants

_PLAY = 1e-6  # what a pitch radius may be off [m]


def check_all(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> list[Check]:
    """Every check of the engine. Returns checks: from the piston to the bearings."""
    used = {
        place: stock.material(getattr(wants, place)) for place in ("piston", "cylinder", "gears", "crankshaft", "shaft")
    }
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

    Returns checks: one, or none when the pinion has no bore.
    """
    d, material = parts.gears.pinion_bore, stock.material(wants.crankshaft)
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


def holding(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> Pure[Array]:
    """Speeds at which every check holds by itself.

    Returns held: whether all factors are reached at each speed, shape (k,).
    """
    arrays = ("omega", "dp_max", "net", "rod", "tooth", "radial", "torque", "spin")
    held = []
    for k in range(forces.omega.size):
        one = replace(forces, **{name: getattr(forces, name)[k : k + 1] for name in arrays})
        held.append(not unsafe(check_all(parts, one, wants, stock)))
    return np.array(held)


def fastest_run(held: Pure[Array]) -> tuple[int, int]:
    """First and last index of the last run of true values.

    held: True at least once, shape (k,).

    >>> fastest_run(np.array([True, True, False, True, False]))
    (3, 3)
    """
    edges = np.flatnonzero(np.diff(np.concatenate([[0], held.astype(int), [0]])))
    return int(edges[-2]), int(edges[-1]) - 1


def part_rows(parts: Parts, rule: str) -> list[SizeRow]:
    """Every size of every part."""
    return [
        row for field in dataclasses.fields(parts) for row in size_rows(field.name, getattr(parts, field.name), rule)
    ]


def mass_rows(parts: Parts, printed: PrintedMasses, wants: Wants, stock: Stock) -> list[SizeRow]:
    """The mass of one of each part."""
    return [
        fact(part, "mass of one", m, "kg", "mass model", note=f"{n} in the engine")
        for part, (m, n) in part_masses(parts, printed, wants, stock).items()
    ]


def engine_rows(
    parts: Parts,
    forces: PartForces,
    moving: Moving,
    mass: Kilogram,
    power: Watt,
    wants: Wants,
    stock: Stock,
    reciprocating: Kilogram,
) -> list[SizeRow]:
    """The headline figures.

    mass: of the whole engine; power: at the highest speed; reciprocating: mass on the cylinder axis that the case
    gives.
    """
    steel = stock.material(wants.crankshaft)
    slope = inner_slope(shaft(parts, stock), steel.youngs_modulus, bending_moment(parts, forces, stock))
    return [
        fact("engine", "moving mass on the cylinder axis", moving.axis, "kg", "mass model",
             note=f"the case has {reciprocating:.3f} kg"),
        fact("engine", "largest force on a piston rod", float(np.abs(forces.rod).max()), "N", "force chain"),
        fact("engine", "largest tooth load of a crank", float(np.abs(forces.tooth).max()), "N", "force chain"),
        fact("engine", "slope at the inner journal", float(slope.max()), "rad", "beam, not rated",
             "Shigley table 7-2", "0.0008 to 0.0012 are usual for rollers under a steady load"),
        fact("engine", "mass without belt", mass, "kg", "mass roll-up", "ch. 5.1.2"),
        fact("engine", "power at the highest speed", power, "W", "cycle", "eq. 2.46"),
        fact("engine", "power to weight", power_to_weight(power, mass), "W/kg", "mass roll-up", "fig. 5.13"),
    ]  # fmt: skip


def nearest_rows(
    parts: Parts, forces: PartForces, wants: Wants, stock: Stock, power: Callable[[float], float]
) -> list[SizeRow]:
    """Speeds at which these parts may run at full load, when they may not at all.

    power: crank speed [rad/s] -> power of the engine [W].
    """
    held = holding(parts, forces, wants, stock)
    if not held.any():
        return []
    low, high = fastest_run(held)
    at = "full load only inside this range; the nearest engine that holds"
    return [
        fact("engine", "lowest speed at full load", forces.omega[low], "rad/s", "all checks", note=at),
        fact("engine", "highest speed", forces.omega[high], "rad/s", "all checks", note=at),
        fact("engine", "power at that speed", power(forces.omega[high]), "W", "cycle", note=at),
    ]
