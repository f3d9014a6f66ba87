"""Geared hypocycloid: parameters and runtime mechanism (Nunes 2017). Drawing and letters: derivations/hypocycloid.py.

The planar mechanism is overconstrained by one; the reactions hold under the assumption of no side force on the piston
(its rod is not guided).
"""

import dataclasses
import math

from mechsym import mechanisms
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import check, quantity


@dataclasses.dataclass(frozen=True, kw_only=True)
class HypocycloidParameters:
    """Crank, planet of half the ring's radius, reciprocating mass.

    Parameters
    ----------
    e : float
        Crank throw, the planet's pitch radius; the stroke is 4 e [m]
    I1 : float
        Inertia of crank and shaft about the axis [kg*m^2]
    u1 : float
        Unbalance of crank and shaft on the throw's side, negative for a counterweight [kg*m]
    m2 : float
        Mass at the planet's centre [kg]
    I2 : float
        Inertia of the planet about its centre [kg*m^2]
    m3 : float
        Reciprocating mass [kg]
    alpha_n : float
        Pressure angle of the gears [rad]
    """

    e: float = quantity("m", above=0, about="crank throw, pitch radius of the planet")
    I1: float = quantity("kg*m^2", above=0, about="inertia of crank and shaft about the axis")
    u1: float = quantity("kg*m", default=0.0, about="unbalance of crank and shaft on the throw's side")
    m2: float = quantity("kg", low=0, about="mass at the planet's centre")
    I2: float = quantity("kg*m^2", low=0, about="inertia of the planet about its centre")
    m3: float = quantity("kg", low=0, about="reciprocating mass")
    alpha_n: float = quantity("rad", low=0, below=math.pi / 2, about="pressure angle of the gears")

    def __post_init__(self) -> None:
        check(self)


def build(parameters: HypocycloidParameters) -> Mechanism:
    """The hypocycloid mechanism, with no side force on the piston.

    Parameters
    ----------
    parameters : HypocycloidParameters
        Geometry and masses

    Returns
    -------
    mechanism : Mechanism
        Coordinate theta; inputs F, M
    """
    return mechanisms.build("hypocycloid", parameters)
