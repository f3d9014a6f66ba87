"""Sizing of the hypocycloid engine: loads size the parts, the parts' masses change the loads, until nothing changes."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.sizing.checks import Check, unsafe
from mechsym.sizing.hypocycloid.checks import check_all, check_pinion_shaft
from mechsym.sizing.hypocycloid.engine import crank_loads, cylinder_loads, seats, shaft_length, tooth_loads
from mechsym.sizing.hypocycloid.masses import Moving, PrintedMasses, moving
from mechsym.sizing.hypocycloid.parts import PartForces, Parts, Stock, bearing, chosen
from mechsym.sizing.parts.bearing_design import Choice, Seat, check_bearing, choices, choose, seat_diameter
from mechsym.sizing.parts.crank_design import check_crank, size_output
from mechsym.sizing.parts.gear_design import candidates, face_width
from mechsym.sizing.parts.piston_design import size_cylinder, size_piston
from mechsym.sizing.parts.records import BearingPart, GearPart
from mechsym.sizing.rounding import round_up
from mechsym.sizing.rules.materials import get
from mechsym.sizing.wants import Wants

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

    Parameters
    ----------
    forces_of : callable
        Moving masses -> forces over the speeds
    printed : PrintedMasses
        The source's parts: start and reference of the masses
    stock : Stock
        Materials and bearings to choose from

    Returns
    -------
    design : HypocycloidDesign
        Its checks tell whether it holds; nothing is refused here
    """
    parts, masses, seen = printed.parts, start, []
    for number in range(1, _ROUNDS + 1):
        forces = forces_of(masses)
        sized = size(parts, forces, printed, wants, stock)
        if sized == parts and number > 1:
            return HypocycloidDesign(parts=parts, moving=masses, forces=forces, rounds=number, converged=True,
                          checks=check_all(parts, forces, wants, stock))  # fmt: skip
        # two designs that call for each other: keep the heavier one
        parts = max(sized, parts, key=lambda p: moving(p, printed, wants, stock).axis) if sized in seen else sized
        seen.append(sized)
        masses = moving(parts, printed, wants, stock)
    forces = forces_of(masses)
    return HypocycloidDesign(parts=parts, moving=masses, forces=forces, rounds=_ROUNDS, converged=False,
                  checks=check_all(parts, forces, wants, stock))  # fmt: skip


def size(parts: Parts, forces: PartForces, printed: PrintedMasses, wants: Wants, stock: Stock) -> Parts:
    """One round: every part sized for the forces, in the order in which they lean on each other."""
    material = {
        key: get(dict(stock.materials), getattr(wants, key)) for key in ("piston", "cylinder", "gears", "shaft")
    }
    loads = cylinder_loads(forces)
    cap = bearing(stock, parts.bearings.rod).outside
    reach = wants.reach - 2 * forces.e - forces.gap / 2 - cap / 2
    piston = size_piston(loads, wants, material["piston"], reach)
    parts = replace(parts, piston=piston,
                    cylinder=size_cylinder(loads, wants, material["cylinder"], piston.height))  # fmt: skip
    parts = replace(parts, gears=_gears(parts, forces, wants, stock))
    parts = _journals(parts, forces, wants, stock)
    crank = crank_loads(parts, forces, wants, stock)
    output = size_output(crank, wants, material["shaft"], 5e-3)
    parts = _outboard(parts, forces, wants, stock, output)
    return replace(parts, crank=replace(parts.crank, shaft_length=round(shaft_length(parts, stock), 9)))


def _gears(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> GearPart:
    """The narrowest pair that holds; the ring's rim is 1.2 whole depths."""
    material = get(dict(stock.materials), wants.gears)
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
    main = bearing(stock, parts.bearings.main)
    room = main.bore - 2 * forces.e - 2 * wants.carrier_wall
    rod = chosen(parts.bearings, stock)["rod"]
    pin = seat_diameter(rod)
    options = choices(stock.bearings.values(), (parts.gears.pinion_bore, pin), room)
    outer = [c for c in options if not c.ring_off and abs(c.bearing.bore - parts.gears.pinion_bore) < 1e-9]
    best, least = parts, (-np.inf, -np.inf)
    for choice in options:
        trial = _with_inner(parts, choice, pin, rod.count * rod.bearing.width, wants)
        trial = _with_outer(trial, outer, forces, wants, stock)
        weakest = _weakest(trial, forces, wants, stock)
        if weakest > least:
            best, least = trial, weakest
        if weakest[1] >= 1 - 1e-9:
            break
    return best


def _weakest(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> tuple[float, float]:
    """Smallest factor over wanted factor of the inner bearings, at most 1, and then of the crankshaft."""
    inner = chosen(parts.bearings, stock)["inner"]
    crankshaft = get(dict(stock.materials), wants.crankshaft)
    rows = check_bearing(inner, seats(parts, forces, stock, ["inner"])["inner"], wants)
    held = min(c.safety_factor / c.wanted for c in rows)
    if held < 1 - 1e-9:  # the cheap checks first
        return held, 0.0
    rows = check_crank(parts.crank, crank_loads(parts, forces, wants, stock), wants, crankshaft)
    rows += check_pinion_shaft(parts, forces, wants, stock)
    return 1.0, min(c.safety_factor / c.wanted for c in rows)


def _with_inner(parts: Parts, choice: Choice, pin: float, stack: float, wants: Wants) -> Parts:
    shaft = seat_diameter(choice)
    crank = replace(parts.crank, pin=pin, pin_length=stack + 2e-3, pin_bore=wants.pin_bore * pin, shaft=shaft,
                    web_width=min(pin, shaft) + 2 * _BOSS)  # fmt: skip
    bearings = replace(parts.bearings, inner=choice.bearing.designation, inner_count=float(choice.count),
                       ring_off="yes" if choice.ring_off else "no")  # fmt: skip
    return replace(parts, crank=crank, bearings=bearings)


def _with_outer(parts: Parts, options: list[Choice], forces: PartForces, wants: Wants, stock: Stock) -> Parts:
    seat = seats(parts, forces, stock, ["outer"])["outer"]
    found = choose(options, seat, wants) or (options[-1] if options else None)
    if found is None:
        return parts
    bearings: BearingPart = replace(parts.bearings, outer=found.bearing.designation, outer_count=float(found.count))
    return replace(parts, bearings=bearings)


def _outboard(parts: Parts, forces: PartForces, wants: Wants, stock: Stock, output: float) -> Parts:
    """The outboard bearing sits on the output shaft, which takes the bearing's bore."""
    seat = seats(parts, forces, stock, ["outboard"])["outboard"]
    balls = [b for b in stock.bearings.values() if b.kind == "ball" and b.bore <= 0.04]
    options = choices(balls, (output, 0.04), 0.1, most=2)
    single = [c for c in options if c.count == 1]
    found = choose(single, seat, wants) or _longest(single, seat, wants)
    if found is None:
        return replace(parts, crank=replace(parts.crank, output=output))
    crank = replace(parts.crank, output=found.bearing.bore)
    return replace(parts, crank=crank, bearings=replace(parts.bearings, outboard=found.bearing.designation))


def _longest(options: list[Choice], seat: Seat, wants: Wants) -> Choice | None:
    def weakest(choice: Choice) -> float:
        return min(c.safety_factor / c.wanted for c in check_bearing(choice, seat, wants))

    return max(options, key=weakest, default=None)


def failing(found: HypocycloidDesign) -> list[Check]:
    """The checks that a design does not pass."""
    return unsafe(found.checks)
