"""Records of a sized slider crank."""

from dataclasses import dataclass

import numpy as np

from mechsym.sizing.checks import Check
from mechsym.sizing.parts.bearing_design import Choice
from mechsym.sizing.parts.records import CrankPart, CylinderPart, PistonPart


@dataclass(frozen=True, kw_only=True)
class SliderForces:
    """Forces of one slider crank; arrays of shape (k, n) over a period of 4 pi.

    Parameters
    ----------
    omega, theta : ndarray, shape (k,), (n,)
        Crank speeds [rad/s], crank angles from firing top dead centre [rad]
    dp_max : ndarray, shape (k,)
        Largest pressure above the surroundings [Pa]
    net : ndarray
        Force on the piston pin, reciprocating mass included [N]
    torque : ndarray
        Torque of the crank [N*m]
    r, l, bore, stroke, gap, head_heat : float
        Crank radius, rod length, bore, stroke, distance of the heads [m], heat through a head [W]
    """

    omega: np.ndarray
    theta: np.ndarray
    dp_max: np.ndarray
    net: np.ndarray
    torque: np.ndarray
    r: float
    l: float
    bore: float
    stroke: float
    gap: float
    head_heat: float


@dataclass(frozen=True, kw_only=True)
class SliderParts:
    """Parts of one slider crank.

    Parameters
    ----------
    piston : PistonPart
        Piston; `rod` is the diameter of the connecting rod's shank
    cylinder : CylinderPart
        Cylinder
    crank : CrankPart
        Crankshaft
    rod_bearing, main_bearing : Choice
        Bearings of the crankpin and of one side of the crankshaft
    """

    piston: PistonPart
    cylinder: CylinderPart
    crank: CrankPart
    rod_bearing: Choice
    main_bearing: Choice


@dataclass(frozen=True, kw_only=True)
class SliderDesign:
    """A sized slider crank.

    Parameters
    ----------
    parts : SliderParts
        Sizes
    reciprocating : float
        Mass that the loads were computed with [kg]
    forces : SliderForces
        Forces over the speeds
    checks : list of Check
        All checks
    rounds : int
        Rounds of loads and sizes
    converged : bool
        Whether the sizes repeat themselves
    """

    parts: SliderParts
    reciprocating: float
    forces: SliderForces
    checks: list[Check]
    rounds: int
    converged: bool
