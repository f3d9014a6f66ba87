"""The hypocycloid engine as a whole: its parts, the stock they are chosen from, axial places, loads on every part.

Its masses, how they move, and the forces that they make with the gas over speed and angle (`PartForces`). The
crankshaft is reckoned from its sizes; the other parts start from the printed part (its mass stands for what the source
drew and does not print) and change by the volume that the sizes change. A web's mass is split between the crankpin on
the cylinder axis and the shaft at the planet's centre, so that its centre stays where it is.
"""

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.amounts import amount
from mechsym.mechanisms.record import curves, evaluate
from mechsym.mechanisms.roles import PartRoles
from mechsym.quantities import record
from mechsym.quantities.records import Record
from mechsym.quantities.units import Kilogram, Metre
from mechsym.sizing.bearing_design import Choice, Seat
from mechsym.sizing.bearing_design import mass as bearing_mass
from mechsym.sizing.crank_design import CrankLoads, CylinderLoads, Pressures
from mechsym.sizing.gear_design import ToothLoads
from mechsym.sizing.loads import Spans, side_loads, side_vectors, tooth_share_one_end
from mechsym.sizing.rules.bearings import Bearing
from mechsym.sizing.rules.masses import area_and_centre, cylinder_mass, roll_up, web_outline
from mechsym.sizing.rules.materials import Material, get
from mechsym.sizing.rules.turning_shaft import Shaft, moment, outer_shares
from mechsym.sizing.wants import BearingPart, CrankPart, CylinderPart, GearPart, MassPart, PistonPart, Wants


@record
class Parts:
    """Everything that is sized."""

    piston: PistonPart
    cylinder: CylinderPart
    gears: GearPart
    crank: CrankPart
    bearings: BearingPart


@record
class PartForces(CylinderLoads):
    """Forces of one crank over the speeds; arrays of shape (k, n) over 4 pi; `rod` is of the piston's side."""

    net: np.ndarray  #: Net force on the crankpin with all reciprocating mass [N]
    #: Tangential and separating load of all gears of the crank [N]
    tooth: np.ndarray
    radial: np.ndarray
    torque: np.ndarray  #: Torque of the crank [N*m]
    spin: np.ndarray  #: shape (k,): Centrifugal force of the masses at the planet's centre [N]
    e: float  #: Throw [m]

    @cached_property
    def side(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forces on one side of the planet: on the crankpin, from the teeth, from the masses; each (2, k, n) [N]."""
        return side_vectors(self.net, self.tooth, self.radial, self.spin, self.theta)


@record
class Stock:
    """What a design may choose from."""

    materials: Mapping[str, Material]
    bearings: Mapping[str, Bearing]

    def material(self, key: str) -> Material:
        """A material by its key."""
        return get(self.materials, key)

    def bearing(self, designation: str) -> Bearing:
        """A bearing by its designation."""
        if designation not in self.bearings:
            raise BadInput(f"bearing {designation!r} is not known; there are {', '.join(sorted(self.bearings))}")
        return self.bearings[designation]


def chosen(part: BearingPart, stock: Stock) -> dict[str, Choice]:
    """The bearings of each place."""
    counts = {"rod": part.rod_count, "inner": part.inner_count, "outer": part.outer_count}
    return {
        place: Choice(bearing=stock.bearing(getattr(part, place)), count=round(counts.get(place, 1)),
                      ring_off=place == "inner" and part.ring_off == "yes")
        for place in ("rod", "inner", "outer", "main", "outboard")
    }  # fmt: skip


_GAP = 2e-3  # between web, bearings and housing, as in the source's sizes [m]
_END_WALL = 5e-3  # carrier between shaft end and outboard bearing, assumed [m]
# name, place of `side_loads`, turns of a bearing by those of the crank: the planet turns backwards at the crank's
# speed, once against the rod, twice against the carrier
_SEATS = {
    "rod": ("rod bearing", "", 1),
    "inner": ("inner journal", "inner_journal", 2),
    "outer": ("outer journal", "outer_journal", 2),
    "main": ("main bearing", "main", 1),
    "outboard": ("outboard bearing", "outboard", 1),
}


def spans(parts: Parts, stock: Stock) -> Spans:
    """Axial places of one side from the middle of the crankpin; the source's sizes give its 43 mm and 77 mm."""
    places = chosen(parts.bearings, stock)
    width = {name: choice.stack for name, choice in places.items()}
    stack = max(width["inner"], width["main"])
    inner = parts.crank.pin_length / 2 + parts.crank.web + _GAP + stack / 2
    gear = inner + stack / 2 + parts.gears.face / 2
    outer = gear + parts.gears.face / 2 + width["outer"] / 2
    end = outer + width["outer"] / 2 + _GAP
    return Spans(inner=inner, gear=gear, outer=outer, outboard=end + _END_WALL + width["outboard"] / 2)


def shaft_length(parts: Parts, stock: Stock) -> Metre:
    """Length of the shaft from web to end."""
    choice = chosen(parts.bearings, stock)["outer"]
    end = spans(parts, stock).outer + choice.stack / 2 + _GAP
    return end - parts.crank.pin_length / 2 - parts.crank.web


def shaft(parts: Parts, stock: Stock) -> Shaft:
    """Half the crankshaft as a beam. Returns shaft: the seat of the inner journal lies symmetrically about it."""
    z, crank = spans(parts, stock), parts.crank
    seat_end = 2 * z.inner - crank.pin_length / 2 - crank.web
    thin = parts.gears.pinion_bore or crank.shaft
    return Shaft(spans=z, pin=crank.pin, pin_bore=crank.pin_bore, pin_half=crank.pin_length / 2, web=crank.web,
                 seat=crank.shaft, seat_end=min(seat_end, z.gear), thin=thin)  # fmt: skip


def bending_moment(parts: Parts, forces: PartForces, stock: Stock) -> Callable[[float], np.ndarray]:
    """Bending moment along the crankshaft: distance from the crankpin's middle [m] -> moment (2, k, n) [N*m]."""
    force, teeth, centrifugal = forces.side
    z, shares = spans(parts, stock), outer_shares(shaft(parts, stock))
    return lambda place: moment(place, z, shares, force, teeth + centrifugal)


def tooth_loads(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> ToothLoads:
    """Tooth loads of the harder loaded pair: half of the crank's, or what one driving end makes of it."""
    one_end = wants.take_off == "one_end"
    share = tooth_share_one_end(spans(parts, stock), wants.stiffness_ratio) if one_end else 0.5
    return ToothLoads(omega=forces.omega, tooth=share * forces.tooth)


def seats(parts: Parts, forces: PartForces, stock: Stock, wanted: Sequence[str] = tuple(_SEATS)) -> dict[str, Seat]:
    """Loads and speeds of the bearings at the places that are wanted."""
    places = [place for place in (_SEATS[key][1] for key in wanted) if place]
    loads = side_loads(forces.side, spans(parts, stock), outer_shares(shaft(parts, stock)), places)
    loaded = {}
    for key in wanted:
        name, place, turns = _SEATS[key]
        load = loads[place] if place else np.abs(forces.rod)
        loaded[key] = Seat(name=name, omega=forces.omega, load=load, turning=turns * forces.omega)
    return loaded


def crank_loads(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> CrankLoads:
    """Loads of crankpin, web and shafts; the output shaft carries its own torque and, by the belt, the other's."""
    pair = tooth_loads(parts, forces, wants, stock)
    return CrankLoads(
        omega=forces.omega,
        moment=bending_moment(parts, forces, stock),
        turn=-forces.theta,
        along_web=forces.net * np.cos(forces.theta),
        shaft_torque=forces.e * pair.tooth,
        output_torque=2 * forces.torque,
        arm=spans(parts, stock).inner,
    )


_SUPPORT_SHAFT = 0.020  # free length of the support shaft, assumed: the source prints none [m]


@record
class PrintedMasses:
    """The source's parts and their masses, the reference of the mass model."""

    parts: Parts
    masses: MassPart
    bore: float  #: of the cylinder [m]
    e: float  #: Throw of the crank [m]


@record
class Moving:
    """Masses of one crank as the dynamics know them."""

    rod: float  #: On the rod's side of the crankpin: piston with rod, its bearings [kg]
    axis: float  #: All that moves on the cylinder axis: rod side, crankpin, the webs' share [kg]
    planet: float  #: At the planet's centre, both sides: shafts, pinions, the webs' share [kg]
    #: What each shaft set must balance: mass times throw of one side, journal bearings included [kg*m]
    unbalance: float


def moving_printed(printed: PrintedMasses, stock: Stock) -> Moving:
    """Moving masses by the printed ones (erratum E20): 0.579 kg on the axis; the source's dynamics use 0.250 kg."""
    m, places = printed.masses, chosen(printed.parts.bearings, stock)
    density = 6675.0  # the source's Nitralloy N, from which its 90.8 g of shaft follow
    shaft = cylinder_mass(density, printed.parts.crank.shaft, printed.parts.crank.shaft_length)
    rod = m.piston + bearing_mass(places["rod"])
    journals = bearing_mass(places["inner"]) + bearing_mass(places["outer"])
    return Moving(
        rod=rod,
        axis=rod + m.crankshaft - 2 * shaft,
        planet=2 * (shaft + m.pinion),
        unbalance=(shaft + m.pinion + journals) * printed.e,
    )


def moving(parts: Parts, printed: PrintedMasses, wants: Wants, stock: Stock) -> Moving:
    """Moving masses of sized parts. Returns moving: masses that the dynamics must use."""
    part = part_masses(parts, printed, wants, stock)
    pin, web, shaft, outward = _crankshaft(parts, printed.e, wants, stock)
    places = chosen(parts.bearings, stock)
    rod = part["piston"][0] + bearing_mass(places["rod"])
    planet_side = shaft + part["pinion"][0] + web * outward
    journals = bearing_mass(places["inner"]) + bearing_mass(places["outer"])
    return Moving(
        rod=rod,
        axis=rod + pin + 2 * web * (1 - outward),
        planet=2 * planet_side,
        unbalance=(planet_side + journals) * printed.e,
    )


def part_masses(parts: Parts, printed: PrintedMasses, wants: Wants, stock: Stock) -> dict[str, tuple[float, int]]:
    """Mass and number of every part of the engine. Returns masses: part to mass [kg] and number [-]."""
    ref, base, rho = printed.masses, printed.parts, _densities(wants, stock)
    pin, web, shaft, outward = _crankshaft(parts, printed.e, wants, stock)
    places = chosen(parts.bearings, stock)
    printed_density = stock.material("nitralloy-n").density
    pinion = ref.pinion * _pinion_volume(parts) / _pinion_volume(base) * rho["gears"] / printed_density
    planet_side = shaft + pinion + web * outward
    journals = bearing_mass(places["inner"]) + bearing_mass(places["outer"])
    balance = (planet_side + journals) * printed.e / moving_printed(printed, stock).unbalance
    volume = _piston_volume(parts.piston, printed.bore) - _piston_volume(base.piston, printed.bore)
    length = spans(parts, stock).outboard / spans(base, stock).outboard
    return {
        "piston": (ref.piston + rho["piston"] * volume, 2),
        "cylinder": (_cylinder(parts, printed, rho["cylinder"]), 1),
        "pinion": (pinion, 4),
        "ring": (ref.ring * _ring_volume(parts) / _ring_volume(base), 4),
        "crankshaft": (pin + 2 * web + 2 * shaft, 2),
        "output shaft set": (_shaft_set(parts, printed, rho["shaft"], balance, output=True), 2),
        "support shaft set": (_shaft_set(parts, printed, rho["shaft"], balance, output=False), 2),
        "crankcases": (ref.crankcases * length, 2),
        **{f"bearing {key}": (bearing_mass(choice), 4 if key != "rod" else 2) for key, choice in places.items()},
    }


def total_mass(parts: Parts, printed: PrintedMasses, wants: Wants, stock: Stock) -> Kilogram:
    """Mass of the engine without belt drive."""
    return roll_up(part_masses(parts, printed, wants, stock))


def total_mass_printed(printed: PrintedMasses, stock: Stock) -> Kilogram:
    """Mass of the engine from the printed masses. Returns m: 13.4066 kg with the source's numbers."""
    m, places = printed.masses, chosen(printed.parts.bearings, stock)
    counts = {"piston": 2, "cylinder": 1, "pinion": 4, "ring": 4, "crankshaft": 2, "output_set": 2, "support_set": 2,
              "crankcases": 2}  # fmt: skip
    parts = {name: (getattr(m, name), count) for name, count in counts.items()}
    return roll_up(parts | {key: (bearing_mass(c), 2 if key == "rod" else 4) for key, c in places.items()})


def _crankshaft(parts: Parts, e: float, wants: Wants, stock: Stock) -> tuple[float, float, float, float]:
    """Crankpin, one web, one shaft, and the share of a web that moves with the shaft."""
    crank, density = parts.crank, _densities(wants, stock)["crankshaft"]
    margin = max(crank.web_width - min(crank.pin, crank.shaft), 0.0)
    area, centre = area_and_centre(*web_outline(crank.pin + margin, crank.shaft + margin, e))
    seat = spans(parts, stock).inner * 2 - crank.pin_length - 2 * crank.web  # symmetric about the inner journal
    outer = max(shaft_length(parts, stock) - seat, 0.0)
    shaft = cylinder_mass(density, crank.shaft, seat) + cylinder_mass(density, parts.gears.pinion_bore, outer)
    pin = cylinder_mass(density, crank.pin, crank.pin_length, crank.pin_bore)
    return pin, density * area * crank.web, shaft, centre / e


def _shaft_set(parts: Parts, printed: PrintedMasses, density: float, balance: float, output: bool) -> float:
    """A shaft set: its counterweight grows with what it balances, its shaft with the diameter."""
    ref, base = printed.masses, printed.parts.crank.output
    longer = (ref.output_set - ref.support_set) / cylinder_mass(density, base, 1.0)  # the two differ by their shafts
    length = _SUPPORT_SHAFT + (longer if output else 0.0)
    disc = (ref.output_set if output else ref.support_set) - cylinder_mass(density, base, length)
    return disc * balance + cylinder_mass(density, parts.crank.output, length)


def _cylinder(parts: Parts, printed: PrintedMasses, density: float) -> float:
    ref, now, bore = printed.parts.cylinder, parts.cylinder, printed.bore
    wall = cylinder_mass(density, bore + 2 * now.wall, now.length, bore)
    reference = cylinder_mass(density, bore + 2 * ref.wall, now.length, bore)
    return printed.masses.cylinder * now.length / ref.length + wall - reference


def _piston_volume(part: PistonPart, bore: float) -> float:
    barrel = np.pi * (bore - part.barrel) * part.barrel * (part.height - part.head)
    return float(np.pi / 4 * bore**2 * part.head + barrel + np.pi / 4 * part.rod**2 * part.rod_length)


def _pinion_volume(parts: Parts) -> float:
    gears = parts.gears
    return ((gears.module * gears.teeth_pinion) ** 2 - gears.pinion_bore**2) * gears.face


def _ring_volume(parts: Parts) -> float:
    gears = parts.gears
    return (gears.ring_outside**2 - (gears.module * gears.teeth_ring) ** 2) * (gears.face + 1e-3)


def _densities(wants: Wants, stock: Stock) -> dict[str, float]:
    places = ("piston", "cylinder", "gears", "crankshaft", "shaft")
    return {place: stock.material(getattr(wants, place)).density for place in places}


@record
class PlanetDrive:
    """A mechanism with a planet on its crank pin, and the letters of its masses."""

    name: str
    parameters: Record  #: The mechanism's record
    roles: PartRoles

    def size(self, text: Any) -> float:
        """A size that a role gives [unit]."""
        return float(amount(text, dataclasses.asdict(self.parameters)))

    @property
    def e(self) -> float:
        """Throw of the crank [m]."""
        return next(self.size(role.throw) for role in self.roles.bearings if role.throw is not None)

    @property
    def moving(self) -> float:
        """Mass that the case gives to what moves along the cylinder [kg]."""
        return sum(map(self.size, self.roles.pistons[0].masses))


def hypocycloid_forces(gas: Pressures, drive: PlanetDrive) -> Callable[[Moving], PartForces]:
    """Moving masses -> forces over the speeds."""
    roles, e = drive.roles, drive.e
    (planet,), (axis, *others) = (teeth.planet for teeth in roles.teeth), roles.pistons[0].masses
    unbalance = str(roles.rotors[0].unbalance)

    def forces_of(moving: Moving) -> PartForces:
        letters = {str(planet): moving.planet, axis: moving.axis, unbalance: -moving.planet * e}
        masses = dataclasses.replace(drive.parameters, **letters, **dict.fromkeys(others, 0.0))
        out = _reactions(dataclasses.replace(drive, parameters=masses), gas)
        share = moving.rod / moving.axis
        return PartForces(
            **gas.shared(), net=out["pin"], rod=gas.net - share * (gas.net - out["pin"]), tooth=out["tooth"],
            radial=out["radial"], torque=out["torque"], spin=moving.planet * e * gas.omega**2, e=e,
        )  # fmt: skip

    return forces_of


def _reactions(drive: PlanetDrive, gas: Pressures) -> dict[str, np.ndarray]:
    # at constant speed each is a part that follows the net force and one that follows the speed squared, so one turn of
    # each says all of every speed; only the radial force has a sign of its own: the teeth push apart on both flanks
    one, roles = np.ones(gas.theta.size), drive.roles
    mechanism, teeth, piston = mechanisms.build(drive.name, drive.parameters), roles.teeth[0], roles.pistons[0]
    q = mechanism.coordinates[0]
    pushed, turning = (
        evaluate(mechanism, "reactions", **{q: gas.theta, f"{q}d": speed * one, piston.force: force * one})
        for speed, force in ((0.0, 1.0), (1.0, 0.0))
    )
    square = gas.omega[:, None] ** 2

    def over_speeds(name: str) -> np.ndarray:
        return np.asarray(pushed[name] * gas.net + turning[name] * square)

    pin = over_speeds(next(role.reactions[0] for role in roles.bearings if role.at == "piston_pins"))
    tooth, slope = over_speeds(teeth.force), curves(mechanism, gas.theta)[f"d{piston.travel}_d{q}"]
    radial = np.abs(tooth) * math.tan(drive.size(teeth.flank))
    return {"pin": pin, "tooth": tooth, "torque": pin * slope, "radial": radial}
