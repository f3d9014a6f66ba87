"""Geared hypocycloid: parameters and runtime mechanism (Nunes 2017). Drawing and letters: derivations/hypocycloid.py.

The planar mechanism is overconstrained by one; the reactions hold under the assumption of no side force on the piston
(its rod is not guided).
"""

import math

from mechsym import mechanisms
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import quantity, record


@record
class HypocycloidParameters:
    """Crank, planet of half the ring's radius, reciprocating mass."""

    #: Crank throw, the planet's pitch radius; the stroke is 4 e [m]
    e: float = quantity("m", above=0, about="crank throw, pitch radius of the planet")
    I1: float = quantity("kg*m^2", above=0, about="inertia of crank and shaft about the axis")
    #: Unbalance of crank and shaft on the throw's side, negative for a counterweight [kg*m]
    u1: float = quantity("kg*m", default=0.0, about="unbalance of crank and shaft on the throw's side")
    m2: float = quantity("kg", low=0, about="mass at the planet's centre")
    I2: float = quantity("kg*m^2", low=0, about="inertia of the planet about its centre")
    m3: float = quantity("kg", low=0, about="reciprocating mass")
    alpha_n: float = quantity("rad", low=0, below=math.pi / 2, about="pressure angle of the gears")


def build(parameters: HypocycloidParameters) -> Mechanism:
    """The hypocycloid mechanism, with no side force on the piston."""
    return mechanisms.build("hypocycloid", parameters)
