"""The hypocycloid engine sized: loads make parts, their masses the loads, until nothing changes; all its checks."""

import dataclasses
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import Array, Kilogram, Pure, Watt
from mechsym.sizing import crank_design
from mechsym.sizing.bearing_design import Choice, check_bearing, choices, choose, seat_diameter
from mechsym.sizing.checks import Check, at_least, at_most, at_speed, round_up, unsafe, weakest
from mechsym.sizing.gear_design import candidates, check_gears, face_width
from mechsym.sizing.hypocycloid.engine import (
    Moving,
    PartForces,
    Parts,
    PrintedMasses,
    Stock,
    bending_moment,
    chosen,
    crank_loads,
    moving,
    part_masses,
    seats,
    shaft,
    shaft_length,
    spans,
    tooth_loads,
)
from mechsym.sizing.rows import SizeRow, fact, size_rows
from mechsym.sizing.rules.masses import power_to_weight
from mechsym.sizing.rules.turning_shaft import Section, endurance_limit, fatigue_factor, inner_slope
from mechsym.sizing.wants import GearPart, Wants

_PLAY = 1e-6  # what a pitch radius may be off [m]


def check_all(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> list[Check]:
    """Every check of the engine. Returns checks: from the piston to the bearings."""
    used = {
        place: stock.material(getattr(wants, place)) for place in ("piston", "cylinder", "gears", "crankshaft", "shaft")
    }
    crank = crank_loads(parts, forces, wants, stock)
    teeth = tooth_loads(parts, forces, wants, stock)
    places = chosen(parts.bearings, stock)
    return [
        *crank_design.check_piston(parts.piston, forces, wants, used["piston"]),
        *crank_design.check_cylinder(parts.cylinder, forces, wants, used["cylinder"], parts.piston.height),
        *check_gears(parts.gears, teeth, wants, used["gears"]),
        *_check_pitch(parts.gears, forces.e),
        *crank_design.check_crank(parts.crank, crank, wants, used["crankshaft"]),
        *check_pinion_shaft(parts, forces, wants, stock),
        *crank_design.check_output(parts.crank.output, crank, wants, used["shaft"]),
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
    """Shaft under the pinion, where that has a bore: bending between two journals, and the tooth's torque."""
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
    """Whether all factors are reached at each speed by itself, shape (k,)."""
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
    """Speeds at which these parts may run at full load after all. power: crank speed [rad/s] -> power [W]."""
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


_ROUNDS = 40
_BOSS = 2e-3  # material of a web around pin and shaft, assumed [m]


@record
class HypocycloidDesign:
    """A sized engine."""

    parts: Parts
    moving: Moving  #: Masses that the loads were computed with: those of the parts when `converged`
    forces: PartForces
    checks: list[Check]
    rounds: int
    converged: bool


def size_hypocycloid(
    forces_of: Callable[[Moving], PartForces], printed: PrintedMasses, start: Moving, wants: Wants, stock: Stock
) -> HypocycloidDesign:
    """Iterate loads and sizes to a fixed point.

    forces_of: moving masses -> forces over the speeds. printed: the source's parts: start and reference of the masses.
    stock: materials and bearings to choose from. Returns design: its checks tell whether it holds; nothing is refused
    here.
    """
    parts, masses, seen = printed.parts, start, list[Parts]()
    rounds, converged = 0, False
    forces = forces_of(masses)
    while not converged and rounds < _ROUNDS:
        rounds += 1
        sized = size(parts, forces, printed, wants, stock)
        converged = sized == parts and rounds > 1
        if not converged:
            # two designs that call for each other: keep the heavier one
            parts = max(sized, parts, key=lambda p: moving(p, printed, wants, stock).axis) if sized in seen else sized
            seen.append(sized)
            masses = moving(parts, printed, wants, stock)
            forces = forces_of(masses)
    checks = check_all(parts, forces, wants, stock)
    return HypocycloidDesign(
        parts=parts, moving=masses, forces=forces, checks=checks, rounds=rounds, converged=converged
    )


def size(parts: Parts, forces: PartForces, printed: PrintedMasses, wants: Wants, stock: Stock) -> Parts:
    """One round: every part sized for the forces, in the order in which they lean on each other."""
    material = {key: stock.material(getattr(wants, key)) for key in ("piston", "cylinder", "gears", "shaft")}
    cap = stock.bearing(parts.bearings.rod).outside
    reach = wants.reach - 2 * forces.e - forces.gap / 2 - cap / 2
    piston = crank_design.size_piston(forces, wants, material["piston"], reach)
    parts = replace(
        parts, piston=piston, cylinder=crank_design.size_cylinder(forces, wants, material["cylinder"], piston.height)
    )
    parts = replace(parts, gears=_gears(parts, forces, wants, stock))
    parts = _journals(parts, forces, wants, stock)
    crank = crank_loads(parts, forces, wants, stock)
    output = crank_design.size_output(crank, wants, material["shaft"], 5e-3)
    parts = _outboard(parts, forces, wants, stock, output)
    return replace(parts, crank=replace(parts.crank, shaft_length=round(shaft_length(parts, stock), 9)))


def _gears(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> GearPart:
    """The narrowest pair that holds; the ring's rim is 1.2 whole depths."""
    material = stock.material(wants.gears)
    loads, old, best = tooth_loads(parts, forces, wants, stock), parts.gears, None
    for part in candidates(2 * forces.e, old.pressure_angle, old):
        rim = (part.teeth_ring / 2 + 1.35 + part.shift + 1.2 * 2.35) * part.module
        part = replace(part, ring_outside=round_up(2 * rim))
        try:
            part = replace(part, face=round_up(face_width(part, loads, wants, material)))
        except BadInput:  # wider than the pinion bears: another module or shift may do
            continue
        if part.face <= 2 * part.module * part.teeth_pinion and (best is None or part.face < best.face):
            best = part
    return best if best is not None else replace(old, face=2 * old.module * old.teeth_pinion)


def _journals(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> Parts:
    """Inner and outer journals: the lightest bearings that hold and leave the shaft strong enough."""
    main = stock.bearing(parts.bearings.main)
    room = main.bore - 2 * forces.e - 2 * wants.carrier_wall
    rod = chosen(parts.bearings, stock)["rod"]
    pin = seat_diameter(rod)
    options = choices(stock.bearings.values(), (parts.gears.pinion_bore, pin), room)
    outer = [c for c in options if not c.ring_off and abs(c.bearing.bore - parts.gears.pinion_bore) < 1e-9]
    best, least = parts, (-np.inf, -np.inf)
    for choice in options:
        shaft = seat_diameter(choice)
        web = min(pin, shaft) + 2 * _BOSS
        crank = replace(
            parts.crank, pin=pin, pin_length=rod.stack + 2e-3, pin_bore=wants.pin_bore * pin, shaft=shaft, web_width=web
        )
        ring_off = "yes" if choice.ring_off else "no"
        bearings = replace(
            parts.bearings, inner=choice.bearing.designation, inner_count=float(choice.count), ring_off=ring_off
        )
        trial = replace(parts, crank=crank, bearings=bearings)
        seat = seats(trial, forces, stock, ["outer"])["outer"]
        if around := choose(outer, seat, wants) or (outer[-1] if outer else None):
            name, count = around.bearing.designation, float(around.count)
            trial = replace(trial, bearings=replace(bearings, outer=name, outer_count=count))
        shares = _shares(trial, forces, wants, stock)
        if shares > least:
            best, least = trial, shares
        if shares[1] >= 1 - 1e-9:
            break
    return best


def _shares(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> tuple[float, float]:
    """Smallest factor over wanted factor of the inner bearings, at most 1, and then of the crankshaft."""
    inner = chosen(parts.bearings, stock)["inner"]
    crankshaft = stock.material(wants.crankshaft)
    rows = check_bearing(inner, seats(parts, forces, stock, ["inner"])["inner"], wants)
    share = weakest(rows)
    if share < 1 - 1e-9:  # the cheap checks first
        return share, 0.0
    rows = crank_design.check_crank(parts.crank, crank_loads(parts, forces, wants, stock), wants, crankshaft)
    rows += check_pinion_shaft(parts, forces, wants, stock)
    return 1.0, weakest(rows)


def _outboard(parts: Parts, forces: PartForces, wants: Wants, stock: Stock, output: float) -> Parts:
    """The outboard bearing sits on the output shaft, which takes the bearing's bore."""
    seat = seats(parts, forces, stock, ["outboard"])["outboard"]
    balls = [b for b in stock.bearings.values() if b.kind == "ball" and b.bore <= 0.04]
    options = choices(balls, (output, 0.04), 0.1, most=2)
    single = [c for c in options if c.count == 1]
    if not single:
        return replace(parts, crank=replace(parts.crank, output=output))
    choice = choose(single, seat, wants) or max(single, key=lambda c: weakest(check_bearing(c, seat, wants)))
    crank = replace(parts.crank, output=choice.bearing.bore)
    return replace(parts, crank=crank, bearings=replace(parts.bearings, outboard=choice.bearing.designation))
