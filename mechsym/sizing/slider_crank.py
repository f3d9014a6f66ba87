r"""Sizing of a slider crank with the same rules: piston, rod, cylinder, crankshaft, bearings, to a fixed point.

The source sizes no slider crank; what a rule needs and no source gives is assumed here and said so. Torque leaves at
one end; a third of the rod counts as reciprocating; counterweights balance the rotating masses.

A crosshead drive held against its rules: pins, film, shoes, piston rod, web, and where it wears.

    piston rod --[crosshead pin, shoes on the guide]-- connecting rod --[crank pin]-- web -- main journal

The crosshead pin only swings, and in a two-stroke engine its load never turns round: what carries it is the film that
the load squeezes and the swing renews. The piston rod's buckling is in `rules.piston`.
"""

import itertools
from collections.abc import Callable, Mapping
from dataclasses import replace

import numpy as np

from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.record import Mechanism, curves
from mechsym.mechanisms.roles import PartRoles
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Kilogram
from mechsym.sizing.bearing_design import Choice, Seat, check_bearing, choices, mass, seat_diameter
from mechsym.sizing.checks import Check, at_least, at_most, at_speed, round_up, unsafe, weakest
from mechsym.sizing.crank_design import (
    CrankLoads,
    CylinderLoads,
    Pressures,
    check_crank,
    check_cylinder,
    check_output,
    check_piston,
    size_cylinder,
    size_output,
    size_piston,
)
from mechsym.sizing.hypocycloid.engine import Stock
from mechsym.sizing.rules.crankshaft import (
    rectangle_stress,
    slider_crank_chain,
    specific_pressure,
    squeeze_time,
    wear_index,
)
from mechsym.sizing.rules.masses import cylinder_mass
from mechsym.sizing.rules.materials import Material
from mechsym.sizing.rules.piston import rod_buckling_load
from mechsym.sizing.rules.turning_shaft import endurance_limit, goodman_factor, stress_cycle
from mechsym.sizing.wants import CrankPart, CylinderPart, PistonPart, Wants

_ROUNDS = 40
_GAP = 2e-3  # between web and bearing, as in the hypocycloid [m]
_AXIAL = 0.85  # endurance limit in tension and compression over that in bending (Shigley, eq. 6-26)
_ROD_ENDS = 1.6  # mass of a rod over that of its shank, assumed


@record
class SliderForces(CylinderLoads):
    """Forces of one slider crank; arrays of shape (k, n) over a period of 4 pi."""

    net: np.ndarray  #: Force on the piston pin, reciprocating mass included [N]
    torque: np.ndarray  #: Torque of the crank [N*m]
    chain: dict[str, np.ndarray]  #: Forces along the rod and at the crank by name [N]
    #: Crank radius, rod length [m]
    r: float
    l: float


@record
class SliderParts:
    """Parts of one slider crank."""

    piston: PistonPart  #: Piston; `rod` is the diameter of the connecting rod's shank
    cylinder: CylinderPart
    crank: CrankPart
    #: Bearings of the crankpin and of one side of the crankshaft
    rod_bearing: Choice
    main_bearing: Choice


@record
class SliderDesign:
    """A sized slider crank."""

    parts: SliderParts
    reciprocating: float  #: Mass that the loads were computed with [kg]
    forces: SliderForces
    checks: list[Check]
    rounds: int
    converged: bool


def slider_crank_forces(gas: Pressures, mechanism: Mechanism, roles: PartRoles) -> Callable[[float], SliderForces]:
    """Reciprocating mass [kg] -> forces over the speeds."""
    moved, q, x = curves(mechanism, gas.theta), mechanism.coordinates[0], roles.pistons[0].travel
    r, l = (float(amount(size, mechanism.parameters)) for size in (roles.rods[0].throw, roles.rods[0].length))

    def forces_of(mass: float) -> SliderForces:
        force = gas.net - mass * moved[f"d2{x}_d{q}2"] * gas.omega[:, None] ** 2
        chain = slider_crank_chain(force, gas.theta, r, l)
        torque = force * moved[f"d{x}_d{q}"]
        return SliderForces(**gas.shared(), net=force, torque=torque, chain=chain, rod=chain["rod"], r=r, l=l)

    return forces_of


def size_slider_crank(
    forces_of: Callable[[float], SliderForces], start: Kilogram, wants: Wants, stock: Stock
) -> SliderDesign:
    """Iterate loads and sizes to a fixed point.

    forces_of: reciprocating mass [kg] -> forces; start: mass to begin with. Returns design: its checks tell whether it
    holds.
    """
    forces = forces_of(start)
    m, parts = start, size(forces, wants, stock)
    rounds, converged = 1, False
    while not converged and rounds < _ROUNDS:
        rounds += 1
        m = reciprocating_mass(parts, forces, wants, stock)
        forces = forces_of(m)
        sized = size(forces, wants, stock)
        converged, parts = sized == parts, sized
    checks = check_all(parts, forces, wants, stock)
    return SliderDesign(parts=parts, reciprocating=m, forces=forces, rounds=rounds, converged=converged, checks=checks)


def size(forces: SliderForces, wants: Wants, stock: Stock) -> SliderParts:
    """One round: sizes of every part for the forces; bearings the lightest that hold, or the strongest there are."""
    material = {key: stock.material(getattr(wants, key)) for key in ("piston", "cylinder", "shaft")}
    steel = stock.material(wants.crankshaft)
    piston = replace(size_piston(forces, wants, material["piston"], forces.l), rod_length=forces.l)
    d = 6e-3
    peak, strength = np.abs(forces.rod).max(), steel.yield_strength or steel.ultimate
    while (
        _rod_factor(d, forces, steel).min() < wants.rod
        or rod_buckling_load(d, forces.l, steel.youngs_modulus, strength) < wants.rod * peak
    ):
        d = round_up(d + 1e-5)
    piston = replace(piston, rod=d)
    cylinder = size_cylinder(forces, wants, material["cylinder"], piston.height)
    rod_seat, main_seat = _seats(forces)
    rods = _ranked(stock, wants, rod_seat, (0.02, 0.06))
    mains = _ranked(stock, wants, main_seat, (0.015, 0.06))
    best, least = None, -np.inf
    for rod_bearing, main_bearing in itertools.product(rods, mains):
        pin, shaft = seat_diameter(rod_bearing), seat_diameter(main_bearing)
        crank = CrankPart(
            pin=pin,
            pin_length=rod_bearing.stack + 2e-3,
            web=forces.bore / 4,
            web_width=min(pin, shaft) + 4e-3,
            shaft=shaft,
            shaft_length=main_bearing.stack,
            output=shaft,
        )
        trial = SliderParts(
            piston=piston, cylinder=cylinder, crank=crank, rod_bearing=rod_bearing, main_bearing=main_bearing
        )
        share = weakest(check_crank(crank, _loads(trial, forces), wants, steel))
        if share > least:
            best, least = trial, share
        if share >= 1 - 1e-9:
            break
    assert best is not None
    output = size_output(_loads(best, forces), wants, material["shaft"], 5e-3)
    return replace(best, crank=replace(best.crank, output=output))


def check_all(parts: SliderParts, forces: SliderForces, wants: Wants, stock: Stock) -> list[Check]:
    """Every check of a slider crank. Returns checks: from the piston to the bearings."""
    used = {place: stock.material(getattr(wants, place)) for place in ("piston", "cylinder", "crankshaft", "shaft")}
    crank = _loads(parts, forces)
    rod_seat, main_seat = _seats(forces)
    piston = [c for c in check_piston(parts.piston, forces, wants, used["piston"]) if c.component != "piston rod"]
    return [
        *piston,
        *_check_rod(parts.piston.rod, forces, wants, used["crankshaft"], forces.l),
        *check_cylinder(parts.cylinder, forces, wants, used["cylinder"], parts.piston.height),
        *check_crank(parts.crank, crank, wants, used["crankshaft"]),
        *check_output(parts.crank.output, crank, wants, used["shaft"]),
        *check_bearing(parts.rod_bearing, rod_seat, wants),
        *check_bearing(parts.main_bearing, main_seat, wants),
    ]


def reciprocating_mass(parts: SliderParts, forces: SliderForces, wants: Wants, stock: Stock) -> Kilogram:
    """Mass that goes up and down with the piston.

    Returns m: piston head and barrel, a steel piston pin of a quarter of the bore (assumed), a third of the rod.
    """
    light = stock.material(wants.piston).density
    steel = stock.material(wants.crankshaft).density
    piston, B = parts.piston, forces.bore
    head = cylinder_mass(light, B, piston.head)
    barrel = cylinder_mass(light, B, piston.height - piston.head, B - 2 * piston.barrel)
    pin = cylinder_mass(steel, B / 4, 0.8 * B, B / 8)
    return head + barrel + pin + _ROD_ENDS * cylinder_mass(steel, piston.rod, forces.l) / 3


def _loads(parts: SliderParts, forces: SliderForces) -> CrankLoads:
    arm = parts.crank.pin_length / 2 + parts.crank.web + _GAP + parts.main_bearing.stack / 2
    half = np.array([-forces.net, forces.chain["side"]]) / 2
    return CrankLoads(
        omega=forces.omega, moment=lambda z: half * (arm - z), turn=forces.theta, along_web=forces.chain["radial"],
        shaft_torque=forces.torque, output_torque=2 * forces.torque, arm=arm,
    )  # fmt: skip


def _seats(forces: SliderForces) -> tuple[Seat, Seat]:
    """Of the bearings of the crankpin, and of those beside it, which share the load."""
    load = np.abs(forces.chain["rod"])
    return (
        Seat(name="rod bearing", omega=forces.omega, load=load, turning=forces.omega),
        Seat(name="main bearing", omega=forces.omega, load=load / 2, turning=forces.omega),
    )


def _ranked(stock: Stock, wants: Wants, seat: Seat, shaft: tuple[float, float]) -> list[Choice]:
    """Bearings that hold, the lightest first; when none does, the one that comes nearest."""
    options = [c for c in choices(stock.bearings.values(), shaft, 0.1, most=2) if mass(c) < 0.8]
    holding = [c for c in options if not unsafe(check_bearing(c, seat, wants))]
    return holding or [max(options, key=lambda c: weakest(check_bearing(c, seat, wants)))]


def _rod_factor(d: float, loads: CylinderLoads, material: Material) -> np.ndarray:
    amplitude, mean = stress_cycle(loads.rod / (np.pi * d**2 / 4))
    S_e = _AXIAL * endurance_limit(material.ultimate, d, "machined")
    return goodman_factor(amplitude, np.abs(mean), S_e, material.ultimate)


def _check_rod(d: float, loads: CylinderLoads, wants: Wants, material: Material, length: float) -> list[Check]:
    factor = _rod_factor(d, loads, material)
    k, peak = int(np.argmin(factor)), float(np.abs(loads.rod).max())
    strength = material.yield_strength or material.ultimate
    buckling = rod_buckling_load(d, length, material.youngs_modulus, strength)
    return [
        Check(component="connecting rod", quantity="fatigue factor", value=float(factor[k]), limit=1.0, unit="-",
              safety_factor=float(factor[k]), wanted=wants.rod, rule="Goodman", source="Shigley eq. 6-46",
              note=at_speed(loads.omega, k)),
        at_most("connecting rod", "load", peak, buckling, "N", wanted=wants.rod, rule="buckling (Johnson, Euler)",
                source="Shigley eq. 4-42"),
    ]  # fmt: skip


_MARINE = "Woodyard (2009), ch. 9"


@record
class CrossheadPart:
    """Section `[part_crosshead]`: sizes of a crosshead drive, and what its materials and oil stand."""

    pin_diameter: float = quantity("m", above=0, about="diameter of the crosshead pin")
    pin_length: float = quantity("m", above=0, about="carrying length of the crosshead pin")
    pin_arc: float = quantity("rad", default=2.0, above=0, below=np.pi, about="angle of the shell that carries")
    crank_pin_diameter: float = quantity("m", above=0, about="diameter of the crank pin")
    crank_pin_length: float = quantity("m", above=0, about="carrying length of the crank pin")
    shoe_width: float = quantity("m", above=0, about="width of the guide shoes of one side")
    shoe_length: float = quantity("m", above=0, about="length of the guide shoes")
    rod_diameter: float = quantity("m", above=0, about="diameter of the piston rod")
    rod_length: float = quantity("m", above=0, about="length of the piston rod between its ends")
    web_width: float = quantity("m", above=0, about="width of the crank web")
    web_thickness: float = quantity("m", above=0, about="thickness of the crank web along the shaft")
    web_arm: float = quantity("m", above=0, about="from the middle of the main journal to that of the web")
    oil: float = quantity("Pa*s", default=0.03, above=0, about="viscosity of the oil in the bearings")
    film_start: float = quantity("m", default=50e-6, above=0, about="film that the swing leaves at its turning points")
    film_least: float = quantity("m", default=3e-6, above=0, about="film that keeps the surfaces apart")
    pin_pressure: float = quantity("Pa", default=20e6, above=0, about="allowed on the crosshead pin")
    crank_pin_pressure: float = quantity("Pa", default=15e6, above=0, about="allowed on the crank pin")
    shoe_pressure: float = quantity("Pa", default=0.6e6, above=0, about="allowed on the guide shoes")
    web_fatigue: float = quantity("Pa", default=120e6, above=0, about="fatigue strength of the web's material")
    youngs_modulus: float = quantity("Pa", default=206e9, above=0, about="Young's modulus of the piston rod")
    yield_strength: float = quantity("Pa", default=350e6, above=0, about="yield strength of the piston rod")
    wanted: float = quantity("-", default=1.0, above=0, about="safety factor of pins, shoes and film")
    wanted_web: float = quantity("-", default=2.0, above=0, about="safety factor of the web, notches included")
    wanted_buckling: float = quantity("-", default=4.0, above=0, about="safety factor of the piston rod")


@record
class CrossheadLoads:
    """One cycle at constant speed; all arrays of shape (n,), the first angle again at the end."""

    phi: np.ndarray  #: Crank angle [rad]
    omega: float  #: Crank speed [rad/s]
    #: Along the piston rod, positive where it is pressed; at the crosshead pin; at the crank pin; on the guide [N]
    rod: np.ndarray
    pin: np.ndarray
    crank_pin: np.ndarray
    side: np.ndarray
    dx_dphi: np.ndarray  #: Travel of the crosshead by the angle [m/rad]
    dpsi_dphi: np.ndarray  #: Swing of the connecting rod by the angle [-]


def checks(part: CrossheadPart, loads: CrossheadLoads) -> list[Check]:
    """Every rule with its factor of safety."""
    pin, crank_pin, side = (float(np.abs(a).max()) for a in (loads.pin, loads.crank_pin, loads.side))
    thrust = float(loads.rod.max())
    # the swing turns round twice a turn: for half of it the film is squeezed by the mean load and not renewed
    half = np.pi / loads.omega
    mean = float(np.trapezoid(np.abs(loads.pin), loads.phi) / (loads.phi[-1] - loads.phi[0]))
    lasts = squeeze_time(
        mean, part.pin_length, part.pin_diameter, part.pin_arc, part.oil, part.film_start, part.film_least
    )
    return [
        _pressure(part, "crosshead pin", pin, (part.pin_length, part.pin_diameter), part.pin_pressure),
        _pressure(part, "crank pin", crank_pin, (part.crank_pin_length, part.crank_pin_diameter),
                  part.crank_pin_pressure),
        _pressure(part, "guide shoe", side, (part.shoe_length, part.shoe_width), part.shoe_pressure),
        at_least("crosshead pin", "time of the squeezed film", lasts, half, "s", wanted=part.wanted,
                    rule="squeeze film of parallel plates with open ends", source="Hays (1961)",
                    note="mean load over half a turn"),
        at_least("piston rod", "buckling load", rod_buckling_load(
            part.rod_diameter, part.rod_length, part.youngs_modulus, part.yield_strength), thrust, "N",
            wanted=part.wanted_buckling, rule="Euler or Johnson", source="Shigley, ch. 4"),
        at_most("crank web", "stress", rectangle_stress(thrust / 2 * part.web_arm, thrust / 2, part.web_width,
                part.web_thickness), part.web_fatigue, "Pa", wanted=part.wanted_web, rule="bending and pressure",
                source="Khurmi and Gupta (2005), ch. 32", note="at the largest thrust, half on each web"),
    ]  # fmt: skip


def wear(part: CrossheadPart, loads: CrossheadLoads) -> Mapping[str, float]:
    """Mean pressure times sliding speed of pin, crank pin and shoe [Pa*m/s]."""
    pin = loads.pin / (part.pin_length * part.pin_diameter)
    crank_pin = loads.crank_pin / (part.crank_pin_length * part.crank_pin_diameter)
    shoe = loads.side / (part.shoe_length * part.shoe_width)
    swing = loads.dpsi_dphi * part.pin_diameter / 2 * loads.omega
    turning = (1 + loads.dpsi_dphi) * part.crank_pin_diameter / 2 * loads.omega
    return {
        "crosshead pin": wear_index(pin, swing, loads.phi),
        "crank pin": wear_index(crank_pin, turning, loads.phi),
        "guide shoe": wear_index(shoe, loads.dx_dphi * loads.omega, loads.phi),
    }


def _pressure(part: CrossheadPart, name: str, F: float, sizes: tuple[float, float], limit: float) -> Check:
    return at_most(name, "specific pressure", specific_pressure(F, *sizes), limit, "Pa", wanted=part.wanted,
                   rule="load by projected area", source=_MARINE)  # fmt: skip
