"""Records of the hypocycloid engine: its parts, the forces on them, and the stock to choose from."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from mechsym.errors import BadInput
from mechsym.sizing.parts.bearing_design import Choice
from mechsym.sizing.parts.records import BearingPart, CrankPart, CylinderPart, GearPart, PistonPart
from mechsym.sizing.rules.bearing_data import Bearing
from mechsym.sizing.rules.materials import Material


@dataclass(frozen=True, kw_only=True)
class Parts:
    """Everything that is sized.

    Parameters
    ----------
    piston, cylinder, gears, crank, bearings
        Records of `parts.py`
    """

    piston: PistonPart
    cylinder: CylinderPart
    gears: GearPart
    crank: CrankPart
    bearings: BearingPart


@dataclass(frozen=True, kw_only=True)
class Forces:
    """Forces of one crank over the speeds; arrays of shape (k, n) over a period of 4 pi.

    Parameters
    ----------
    omega, theta : ndarray, shape (k,), (n,)
        Crank speeds [rad/s], crank angles from firing top dead centre [rad]
    dp_max : ndarray, shape (k,)
        Largest pressure above the surroundings [Pa]
    net, rod : ndarray
        Net force on the crankpin with all reciprocating mass, and with the piston's side only [N]
    tooth, radial : ndarray
        Tangential and separating load of all gears of the crank [N]
    torque : ndarray
        Torque of the crank [N*m]
    spin : ndarray, shape (k,)
        Centrifugal force of the masses at the planet's centre [N]
    e, bore, stroke, gap, head_heat : float
        Throw, bore, stroke of one piston, distance of the heads [m], heat through a head [W]
    """

    omega: np.ndarray
    theta: np.ndarray
    dp_max: np.ndarray
    net: np.ndarray
    rod: np.ndarray
    tooth: np.ndarray
    radial: np.ndarray
    torque: np.ndarray
    spin: np.ndarray
    e: float
    bore: float
    stroke: float
    gap: float
    head_heat: float


@dataclass(frozen=True, kw_only=True)
class Stock:
    """What a design may choose from.

    Parameters
    ----------
    materials : mapping of str to Material
        By key
    bearings : mapping of str to Bearing
        By designation
    """

    materials: Mapping[str, Material]
    bearings: Mapping[str, Bearing]


def bearing(stock: Stock, designation: str) -> Bearing:
    """A bearing by its designation.

    Parameters
    ----------
    stock : Stock
        What there is
    designation : str
        Maker's name

    Returns
    -------
    bearing : Bearing
        Its data

    Raises
    ------
    BadInput
        Not in stock
    """
    if designation not in stock.bearings:
        raise BadInput(f"bearing {designation!r} is not known; there are {', '.join(sorted(stock.bearings))}")
    return stock.bearings[designation]


def chosen(part: BearingPart, stock: Stock) -> dict[str, Choice]:
    """The bearings of each place.

    Parameters
    ----------
    part : BearingPart
        Designations and counts
    stock : Stock
        Bearing data

    Returns
    -------
    choices : dict of str to Choice
        `rod`, `inner`, `outer`, `main`, `outboard`
    """
    counts = {"rod": part.rod_count, "inner": part.inner_count, "outer": part.outer_count}
    return {
        place: Choice(bearing=bearing(stock, getattr(part, place)), count=round(counts.get(place, 1)),
                      ring_off=place == "inner" and part.ring_off == "yes")
        for place in ("rod", "inner", "outer", "main", "outboard")
    }  # fmt: skip
