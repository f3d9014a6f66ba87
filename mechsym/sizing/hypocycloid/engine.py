"""The hypocycloid engine as a whole: axial places and loads on every part.

Forces come from outside as arrays over speed and angle (`parts.PartForces`).
"""

from collections.abc import Callable

import numpy as np

from mechsym.sizing.hypocycloid.parts import PartForces, Parts, Stock, chosen
from mechsym.sizing.loads import Spans, side_loads, side_vectors, tooth_share_one_end
from mechsym.sizing.parts.bearing_design import Seat
from mechsym.sizing.parts.crank_design import CrankLoads
from mechsym.sizing.parts.gear_design import ToothLoads
from mechsym.sizing.parts.piston_design import CylinderLoads
from mechsym.sizing.rules.shaft_beam import Shaft, moment, outer_shares
from mechsym.sizing.wants import Wants

_GAP = 2e-3  # between web, bearings and housing, as in the source's sizes [m]
_END_WALL = 5e-3  # carrier between shaft end and outboard bearing, assumed [m]


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


def vectors(forces: PartForces) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Forces on one side of the planet.

    Returns
    -------
    vectors : tuple of ndarray, shape (2, k, n)
        On the crankpin, from the teeth, from the masses [N]
    """
    return side_vectors(forces.net, forces.tooth, forces.radial, forces.spin, forces.theta)


def bending_moment(parts: Parts, forces: PartForces, stock: Stock) -> Callable[[float], np.ndarray]:
    """Bending moment along the crankshaft.

    Returns
    -------
    moment : callable
        Distance from the middle of the crankpin [m] -> moment (2, k, n) [N*m]
    """
    force, teeth, centrifugal = vectors(forces)
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


def seats(parts: Parts, forces: PartForces, stock: Stock) -> dict[str, Seat]:
    """Loads and speeds of the bearings."""
    loads = side_loads(vectors(forces), spans(parts, stock), outer_shares(shaft(parts, stock)))
    w = forces.omega
    # the planet turns backwards at the crank's speed: once against the rod, twice against the carrier
    places = {
        "rod": ("rod bearing", np.abs(forces.rod), w),
        "inner": ("inner journal", loads["inner_journal"], 2 * w),
        "outer": ("outer journal", loads["outer_journal"], 2 * w),
        "main": ("main bearing", loads["main"], w),
        "outboard": ("outboard bearing", loads["outboard"], w),
    }
    return {key: Seat(name=name, omega=w, load=load, turning=turning) for key, (name, load, turning) in places.items()}


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
