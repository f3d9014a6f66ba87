"""Sizing of a slider crank with the same rules: piston, rod, cylinder, crankshaft, bearings, to a fixed point.

The source sizes no slider crank; what a rule needs and no source gives is assumed here and said so. Torque leaves at
one end; a third of the rod counts as reciprocating; counterweights balance the rotating masses.
"""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mechsym.sizing.checks import Check, at_most, unsafe
from mechsym.sizing.hypocycloid.parts import Stock
from mechsym.sizing.parts.bearing_design import Choice, Seat, check_bearing, choices, mass, seat_diameter
from mechsym.sizing.parts.crank_design import CrankLoads, check_crank, check_output, size_output
from mechsym.sizing.parts.piston_design import CylinderLoads, check_cylinder, check_piston, size_cylinder, size_piston
from mechsym.sizing.parts.records import CrankPart
from mechsym.sizing.rounding import at_speed, round_up
from mechsym.sizing.rules import rod as rod_rules
from mechsym.sizing.rules.fatigue import endurance_limit, goodman_factor, stress_cycle
from mechsym.sizing.rules.masses import cylinder_mass
from mechsym.sizing.rules.materials import Material, get
from mechsym.sizing.slider_crank.parts import SliderDesign, SliderForces, SliderParts
from mechsym.sizing.slider_crank.rod_forces import slider_crank_chain
from mechsym.sizing.wants import Wants

_ROUNDS = 40
_GAP = 2e-3  # between web and bearing, as in the hypocycloid [m]
_AXIAL = 0.85  # endurance limit in tension and compression over that in bending (Shigley, eq. 6-26)
_ROD_ENDS = 1.6  # mass of a rod over that of its shank, assumed


def size_slider_crank(
    forces_of: Callable[[float], SliderForces], start: float, wants: Wants, stock: Stock
) -> SliderDesign:
    """Iterate loads and sizes to a fixed point.

    Parameters
    ----------
    forces_of : callable
        Reciprocating mass [kg] -> forces
    start : float
        Mass to begin with [kg]

    Returns
    -------
    design : SliderDesign
        Its checks tell whether it holds
    """
    forces = forces_of(start)
    m, parts = start, size(forces, wants, stock)
    for number in range(2, _ROUNDS + 1):
        m = reciprocating_mass(parts, forces, wants, stock)
        forces = forces_of(m)
        sized = size(forces, wants, stock)
        if sized == parts:
            return SliderDesign(parts=parts, reciprocating=m, forces=forces, rounds=number, converged=True,
                                checks=check_all(parts, forces, wants, stock))  # fmt: skip
        parts = sized
    return SliderDesign(parts=parts, reciprocating=m, forces=forces, rounds=_ROUNDS, converged=False,
                        checks=check_all(parts, forces, wants, stock))  # fmt: skip


def size(forces: SliderForces, wants: Wants, stock: Stock) -> SliderParts:
    """One round: every part for the forces.

    Returns
    -------
    parts : SliderParts
        Sizes; of the bearings the lightest that hold, or the strongest there are
    """
    loads = _cylinder_loads(forces)
    material = {key: get(dict(stock.materials), getattr(wants, key)) for key in ("piston", "cylinder", "shaft")}
    steel = get(dict(stock.materials), wants.crankshaft)
    piston = replace(size_piston(loads, wants, material["piston"], forces.l), rod_length=forces.l)
    piston = replace(piston, rod=_rod_diameter(loads, wants, steel, forces.l))
    cylinder = size_cylinder(loads, wants, material["cylinder"], piston.height)
    rods = _ranked(stock, wants, _rod_seat(forces), (0.02, 0.06))
    mains = _ranked(stock, wants, _main_seat(forces), (0.015, 0.06))
    best, least = None, -np.inf
    for rod_bearing, main_bearing in ((a, b) for a in rods for b in mains):
        crank = _crank(rod_bearing, main_bearing, forces)
        trial = SliderParts(piston=piston, cylinder=cylinder, crank=crank, rod_bearing=rod_bearing,
                            main_bearing=main_bearing)  # fmt: skip
        weakest = min(c.safety_factor / c.wanted for c in check_crank(crank, _loads(trial, forces), wants, steel))
        if weakest > least:
            best, least = trial, weakest
        if weakest >= 1 - 1e-9:
            break
    assert best is not None
    output = size_output(_loads(best, forces), wants, material["shaft"], 5e-3)
    return replace(best, crank=replace(best.crank, output=output))


def check_all(parts: SliderParts, forces: SliderForces, wants: Wants, stock: Stock) -> list[Check]:
    """Every check of a slider crank.

    Returns
    -------
    checks : list of Check
        From the piston to the bearings
    """
    used = {place: get(dict(stock.materials), getattr(wants, place))
            for place in ("piston", "cylinder", "crankshaft", "shaft")}  # fmt: skip
    cylinder, crank = _cylinder_loads(forces), _loads(parts, forces)
    piston = [c for c in check_piston(parts.piston, cylinder, wants, used["piston"]) if c.component != "piston rod"]
    return [
        *piston,
        *_check_rod(parts.piston.rod, cylinder, wants, used["crankshaft"], forces.l),
        *check_cylinder(parts.cylinder, cylinder, wants, used["cylinder"], parts.piston.height),
        *check_crank(parts.crank, crank, wants, used["crankshaft"]),
        *check_output(parts.crank.output, crank, wants, used["shaft"]),
        *check_bearing(parts.rod_bearing, _rod_seat(forces), wants),
        *check_bearing(parts.main_bearing, _main_seat(forces), wants),
    ]


def reciprocating_mass(parts: SliderParts, forces: SliderForces, wants: Wants, stock: Stock) -> float:
    """Mass that goes up and down with the piston.

    Returns
    -------
    m : float
        Piston head and barrel, a steel piston pin of a quarter of the bore (assumed), a third of the rod [kg]
    """
    light = get(dict(stock.materials), wants.piston).density
    steel = get(dict(stock.materials), wants.crankshaft).density
    piston, B = parts.piston, forces.bore
    head = cylinder_mass(light, B, piston.head)
    barrel = cylinder_mass(light, B, piston.height - piston.head, B - 2 * piston.barrel)
    pin = cylinder_mass(steel, B / 4, 0.8 * B, B / 8)
    return head + barrel + pin + _ROD_ENDS * cylinder_mass(steel, piston.rod, forces.l) / 3


def _cylinder_loads(forces: SliderForces) -> CylinderLoads:
    chain = slider_crank_chain(forces.net, forces.theta, forces.r, forces.l)
    return CylinderLoads(omega=forces.omega, dp_max=forces.dp_max, rod=chain["rod"], head_heat=forces.head_heat,
                         bore=forces.bore, stroke=forces.stroke, gap=forces.gap)  # fmt: skip


def _loads(parts: SliderParts, forces: SliderForces) -> CrankLoads:
    chain = slider_crank_chain(forces.net, forces.theta, forces.r, forces.l)
    arm = _arm(parts.crank, parts.main_bearing)
    half = np.array([-forces.net, chain["side"]]) / 2
    return CrankLoads(
        omega=forces.omega, moment=lambda z: half * (arm - z), turn=forces.theta, along_web=chain["radial"],
        shaft_torque=forces.torque, output_torque=2 * forces.torque, arm=arm,
    )  # fmt: skip


def _arm(crank: CrankPart, main: Choice) -> float:
    return crank.pin_length / 2 + crank.web + _GAP + main.count * main.bearing.width / 2


def _crank(rod_bearing: Choice, main: Choice, forces: SliderForces) -> CrankPart:
    pin, shaft = seat_diameter(rod_bearing), seat_diameter(main)
    return CrankPart(pin=pin, pin_length=rod_bearing.count * rod_bearing.bearing.width + 2e-3, web=forces.bore / 4,
                     web_width=min(pin, shaft) + 4e-3, shaft=shaft, shaft_length=main.count * main.bearing.width,
                     output=shaft)  # fmt: skip


def _rod_seat(forces: SliderForces) -> Seat:
    chain = slider_crank_chain(forces.net, forces.theta, forces.r, forces.l)
    return Seat(name="rod bearing", omega=forces.omega, load=np.abs(chain["rod"]), turning=forces.omega)


def _main_seat(forces: SliderForces) -> Seat:
    chain = slider_crank_chain(forces.net, forces.theta, forces.r, forces.l)
    return Seat(name="main bearing", omega=forces.omega, load=np.abs(chain["rod"]) / 2, turning=forces.omega)


def _ranked(stock: Stock, wants: Wants, seat: Seat, shaft: tuple[float, float]) -> list[Choice]:
    """Bearings that hold, the lightest first; when none does, the one that comes nearest."""
    options = [c for c in choices(stock.bearings.values(), shaft, 0.1, most=2) if mass(c) < 0.8]
    holding = [c for c in options if not unsafe(check_bearing(c, seat, wants))]

    def weakest(choice: Choice) -> float:
        return min(c.safety_factor / c.wanted for c in check_bearing(choice, seat, wants))

    return holding or [max(options, key=weakest)]


def _rod_factor(d: float, loads: CylinderLoads, material: Material) -> np.ndarray:
    amplitude, mean = stress_cycle(loads.rod / (np.pi * d**2 / 4))
    S_e = _AXIAL * endurance_limit(material.ultimate, d, "machined")
    return goodman_factor(amplitude, np.abs(mean), S_e, material.ultimate)


def _rod_diameter(loads: CylinderLoads, wants: Wants, material: Material, length: float) -> float:
    d = 6e-3
    peak, strength = np.abs(loads.rod).max(), material.yield_strength or material.ultimate
    while (
        _rod_factor(d, loads, material).min() < wants.rod
        or rod_rules.rod_buckling_load(d, length, material.youngs_modulus, strength) < wants.rod * peak
    ):
        d = round_up(d + 1e-5)
    return d  # fmt: skip


def _check_rod(d: float, loads: CylinderLoads, wants: Wants, material: Material, length: float) -> list[Check]:
    factor = _rod_factor(d, loads, material)
    k, peak = int(np.argmin(factor)), float(np.abs(loads.rod).max())
    strength = material.yield_strength or material.ultimate
    buckling = rod_rules.rod_buckling_load(d, length, material.youngs_modulus, strength)
    return [
        Check(component="connecting rod", quantity="fatigue factor", value=float(factor[k]), limit=1.0, unit="-",
              safety_factor=float(factor[k]), wanted=wants.rod, rule="Goodman", source="Shigley eq. 6-46",
              note=at_speed(loads.omega, k)),
        at_most("connecting rod", "load", peak, buckling, "N", wanted=wants.rod, rule="buckling (Johnson, Euler)",
                source="Shigley eq. 4-42"),
    ]  # fmt: skip
