"""The hypocycloid engine as a whole: axial places and loads on every part.

Forces come from outside as arrays over speed and angle (`parts.PartForces`).
"""

from collections.abc import Callable, Sequence

import numpy as np

from mechsym.sizing.hypocycloid.parts import PartForces, Parts, Stock, chosen
from mechsym.sizing.loads import Spans, side_loads, tooth_share_one_end
from mechsym.sizing.parts.bearing_design import Seat
from mechsym.sizing.parts.crank_design import CrankLoads
from mechsym.sizing.parts.gear_design import ToothLoads
from mechsym.sizing.parts.piston_design import CylinderLoads
from mechsym.sizing.rules.shaft_beam import Shaft, moment, outer_shares
from mechsym.sizing.wants import Wants

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
    """Axial places of one side; with the source's sizes they give its 43 mm and its 77 mm of shaft.

    Returns
    -------
    spans : Spans
        From the middle of the crankpin
    """
    places = chosen(parts.bearings, stock)
    width = {name: choice.count * choice.bearing.width for name, choice in places.items()}
    stack = max(width["inner"], width["main"])
    inner = parts.crank.pin_length / 2 + parts.crank.web + _GAP + stack / 2
    gear = inner + stack / 2 + parts.gears.face / 2
    outer = gear + parts.gears.face / 2 + width["outer"] / 2
    end = outer + width["outer"] / 2 + _GAP
    return Spans(inner=inner, gear=gear, outer=outer, outboard=end + _END_WALL + width["outboard"] / 2)


def shaft_length(parts: Parts, stock: Stock) -> float:
    """Length of the shaft from web to end.

    Returns
    -------
    length : float
        Length [m]
    """
    choice = chosen(parts.bearings, stock)["outer"]
    end = spans(parts, stock).outer + choice.count * choice.bearing.width / 2 + _GAP
    return end - parts.crank.pin_length / 2 - parts.crank.web


def shaft(parts: Parts, stock: Stock) -> Shaft:
    """Half the crankshaft as a beam.

    Returns
    -------
    shaft : Shaft
        The seat of the inner journal lies symmetrically about it
    """
    z, crank = spans(parts, stock), parts.crank
    seat_end = 2 * z.inner - crank.pin_length / 2 - crank.web
    thin = parts.gears.pinion_bore or crank.shaft
    return Shaft(spans=z, pin=crank.pin, pin_bore=crank.pin_bore, pin_half=crank.pin_length / 2, web=crank.web,
                 seat=crank.shaft, seat_end=min(seat_end, z.gear), thin=thin)  # fmt: skip


def bending_moment(parts: Parts, forces: PartForces, stock: Stock) -> Callable[[float], np.ndarray]:
    """Bending moment along the crankshaft.

    Returns
    -------
    moment : callable
        Distance from the middle of the crankpin [m] -> moment (2, k, n) [N*m]
    """
    force, teeth, centrifugal = forces.side
    z, shares = spans(parts, stock), outer_shares(shaft(parts, stock))
    return lambda place: moment(place, z, shares, force, teeth + centrifugal)


def tooth_loads(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> ToothLoads:
    """Tooth loads of the harder loaded pair.

    Returns
    -------
    loads : ToothLoads
        Half of the crank's tooth load, or what one driving end makes of it
    """
    one_end = wants.take_off == "one_end"
    share = tooth_share_one_end(spans(parts, stock), wants.stiffness_ratio) if one_end else 0.5
    return ToothLoads(omega=forces.omega, tooth=share * forces.tooth)


def seats(parts: Parts, forces: PartForces, stock: Stock, wanted: Sequence[str] = tuple(_SEATS)) -> dict[str, Seat]:
    """Loads and speeds of the bearings at the places that are wanted."""
    places = [place for place in (_SEATS[key][1] for key in wanted) if place]
    loads = side_loads(forces.side, spans(parts, stock), outer_shares(shaft(parts, stock)), places)
    found = {}
    for key in wanted:
        name, place, turns = _SEATS[key]
        load = loads[place] if place else np.abs(forces.rod)
        found[key] = Seat(name=name, omega=forces.omega, load=load, turning=turns * forces.omega)
    return found


def crank_loads(parts: Parts, forces: PartForces, wants: Wants, stock: Stock) -> CrankLoads:
    """Loads of crankpin, web and shafts.

    Returns
    -------
    loads : CrankLoads
        The output shaft carries both cranks' torque: its own and, through the belt, the other one's
    """
    pair = tooth_loads(parts, forces, wants, stock)
    return CrankLoads(
        omega=forces.omega, moment=bending_moment(parts, forces, stock), turn=-forces.theta,
        along_web=forces.net * np.cos(forces.theta), shaft_torque=forces.e * pair.tooth,
        output_torque=2 * forces.torque, arm=spans(parts, stock).inner,
    )  # fmt: skip


def cylinder_loads(forces: PartForces) -> CylinderLoads:
    """Loads of piston and cylinder."""
    return CylinderLoads(omega=forces.omega, dp_max=forces.dp_max, rod=forces.rod, head_heat=forces.head_heat,
                         bore=forces.bore, stroke=forces.stroke, gap=forces.gap)  # fmt: skip
