"""Records of the hypocycloid engine: its parts, the forces on them, and the stock to choose from."""

from collections.abc import Mapping
from functools import cached_property

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.sizing.loads import side_vectors
from mechsym.sizing.parts.bearing_design import Choice
from mechsym.sizing.parts.records import BearingPart, CrankPart, CylinderPart, GearPart, PistonPart
from mechsym.sizing.rules.bearing_data import Bearing
from mechsym.sizing.rules.materials import Material


@record
class Parts:
    """Everything that is sized."""

    piston: PistonPart
    cylinder: CylinderPart
    gears: GearPart
    crank: CrankPart
    bearings: BearingPart


@record
class PartForces:
    """Forces of one crank over the speeds; arrays of shape (k, n) over a period of 4 pi."""

    #: shape (k,), (n,): Crank speeds [rad/s], crank angles from firing top dead centre [rad]
    omega: np.ndarray
    theta: np.ndarray
    dp_max: np.ndarray  #: shape (k,): Largest pressure above the surroundings [Pa]
    #: Net force on the crankpin with all reciprocating mass, and with the piston's side only [N]
    net: np.ndarray
    rod: np.ndarray
    #: Tangential and separating load of all gears of the crank [N]
    tooth: np.ndarray
    radial: np.ndarray
    torque: np.ndarray  #: Torque of the crank [N*m]
    spin: np.ndarray  #: shape (k,): Centrifugal force of the masses at the planet's centre [N]
    #: Throw, bore, stroke of one piston, distance of the heads [m], heat through a head [W]
    e: float
    bore: float
    stroke: float
    gap: float
    head_heat: float

    @cached_property
    def side(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Forces on one side of the planet: on the crankpin, from the teeth, from the masses; each (2, k, n) [N]."""
        return side_vectors(self.net, self.tooth, self.radial, self.spin, self.theta)


@record
class Stock:
    """What a design may choose from."""

    materials: Mapping[str, Material]
    bearings: Mapping[str, Bearing]


def bearing(stock: Stock, designation: str) -> Bearing:
    """A bearing by its designation."""
    if designation not in stock.bearings:
        raise BadInput(f"bearing {designation!r} is not known; there are {', '.join(sorted(stock.bearings))}")
    return stock.bearings[designation]


def chosen(part: BearingPart, stock: Stock) -> dict[str, Choice]:
    """The bearings of each place."""
    counts = {"rod": part.rod_count, "inner": part.inner_count, "outer": part.outer_count}
    return {
        place: Choice(bearing=bearing(stock, getattr(part, place)), count=round(counts.get(place, 1)),
                      ring_off=place == "inner" and part.ring_off == "yes")
        for place in ("rod", "inner", "outer", "main", "outboard")
    }  # fmt: skip
