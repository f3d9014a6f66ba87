"""The hypocycloid engine as a whole: its parts, the stock they are chosen from, axial places, loads on every part.

Forces come from outside as arrays over speed and angle (`PartForces`).
"""

from collections.abc import Callable, Mapping, Sequence
from functools import cached_property

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import Metre
from mechsym.sizing.bearing_design import Choice, Seat
from mechsym.sizing.crank_design import CrankLoads, CylinderLoads
from mechsym.sizing.gear_design import ToothLoads
from mechsym.sizing.loads import Spans, side_loads, side_vectors, tooth_share_one_end
from mechsym.sizing.rules.bearings import Bearing
from mechsym.sizing.rules.materials import Material, get
from mechsym.sizing.rules.turning_shaft import Shaft, moment, outer_shares
from mechsym.sizing.wants import BearingPart, CrankPart, CylinderPart, GearPart, PistonPart, Wants


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
