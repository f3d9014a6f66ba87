"""Records of a sized slider crank."""

import numpy as np

from mechsym.quantities import record
from mechsym.sizing.checks import Check
from mechsym.sizing.parts.bearing_design import Choice
from mechsym.sizing.parts.records import CrankPart, CylinderPart, PistonPart


@record
class SliderForces:
    """Forces of one slider crank; arrays of shape (k, n) over a period of 4 pi."""

    #: shape (k,), (n,): Crank speeds [rad/s], crank angles from firing top dead centre [rad]
    omega: np.ndarray
    theta: np.ndarray
    dp_max: np.ndarray  #: shape (k,): Largest pressure above the surroundings [Pa]
    net: np.ndarray  #: Force on the piston pin, reciprocating mass included [N]
    torque: np.ndarray  #: Torque of the crank [N*m]
    #: Crank radius, rod length, bore, stroke, distance of the heads [m], heat through a head [W]
    r: float
    l: float
    bore: float
    stroke: float
    gap: float
    head_heat: float


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
