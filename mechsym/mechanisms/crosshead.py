"""Crank, rod, crosshead and elastic hinge: parameters and runtime mechanism (Zotov et al. 2024, section 2)."""

import dataclasses

from mechsym import mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.record import Mechanism
from mechsym.quantities import quantity, record


@record
class CrossheadParameters:
    """Geometry and masses; r = r1 + r2 is the crank radius, l = l1 + l2 the rod's length."""

    r1: float = quantity("m", low=0, about="shaft axis to the crank's centre of mass")
    r2: float = quantity("m", low=0, about="crank's centre of mass to crank pin")
    l1: float = quantity("m", low=0, about="crank pin to the rod's centre of mass")
    l2: float = quantity("m", low=0, about="rod's centre of mass to crosshead pin")
    m1: float = quantity("kg", low=0, about="mass of the crank")
    m2: float = quantity("kg", low=0, about="mass of the rod")
    m3: float = quantity("kg", low=0, about="mass of the crosshead")
    m4: float = quantity("kg", low=0, about="mass of the piston rod")
    m5: float = quantity("kg", low=0, about="mass of the piston")
    I01: float = quantity("kg*m^2", above=0, about="inertia of the crank about the shaft axis")
    IC2: float = quantity("kg*m^2", low=0, about="inertia of the rod about its centre of mass")
    g: float = quantity("m/s^2", default=9.81, low=0, about="acceleration of free fall")
    #: Angle of the cylinder axis against the horizontal, 0 lying, pi/2 upright [rad]
    axis_tilt: float = quantity("rad", default=0.0, about="cylinder axis against the horizontal")

    def __post_init__(self) -> None:
        r, l = self.r1 + self.r2, self.l1 + self.l2
        if r <= 0:
            raise BadInput(f"r1 + r2 = {r:g} m leaves no crank; it must be > 0 m")
        if l <= r:
            raise BadInput(f"rod too short: l1 + l2 = {l:g} m, needs more than r1 + r2 = {r:g} m; lengthen l1 or l2")


def build(parameters: CrossheadParameters) -> Mechanism:
    """The crosshead engine's mechanism.

    Returns
    -------
    mechanism : Mechanism
        Coordinate phi; inputs F, M_r, M_h
    """
    return mechanisms.build("crosshead", parameters)


def with_flywheel(parameters: CrossheadParameters, inertia: float) -> CrossheadParameters:
    """The same engine with a flywheel rigidly on the shaft.

    Parameters
    ----------
    inertia : float
        Inertia of the flywheel about the shaft [kg*m^2]
    """
    return dataclasses.replace(parameters, I01=parameters.I01 + inertia)
