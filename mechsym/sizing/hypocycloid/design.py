"""Sizing of the hypocycloid engine: loads size the parts, the parts' masses change the loads, until nothing changes."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.sizing.bearing_design import check_bearing, choices, choose, seat_diameter
from mechsym.sizing.checks import Check, round_up, weakest
from mechsym.sizing.crank_design import check_crank, size_output
from mechsym.sizing.gear_design import candidates, face_width
from mechsym.sizing.hypocycloid.checks import check_all, check_pinion_shaft
from mechsym.sizing.hypocycloid.engine import (
    PartForces,
    Parts,
    Stock,
    chosen,
    crank_loads,
    cylinder_loads,
    seats,
    shaft_length,
    tooth_loads,
)
from mechsym.sizing.hypocycloid.masses import Moving, PrintedMasses, moving
from mechsym.sizing.piston_design import size_cylinder, size_piston
from mechsym.sizing.wants import GearPart, Wants

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
    loads = cylinder_loads(forces)
    cap = stock.bearing(parts.bearings.rod).outside
    reach = wants.reach - 2 * forces.e - forces.gap / 2 - cap / 2
    piston = size_piston(loads, wants, material["piston"], reach)
    parts = replace(parts, piston=piston, cylinder=size_cylinder(loads, wants, material["cylinder"], piston.height))
    parts = replace(parts, gears=_gears(parts, forces, wants, stock))
    parts = _journals(parts, forces, wants, stock)
    crank = crank_loads(parts, forces, wants, stock)
    output = size_output(crank, wants, material["shaft"], 5e-3)
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
    rows = check_crank(parts.crank, crank_loads(parts, forces, wants, stock), wants, crankshaft)
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
