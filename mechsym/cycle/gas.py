"""Gas pressure on the pistons, whatever kind of cycle it comes from."""

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
from numpy.polynomial import Chebyshev
from scipy.integrate import trapezoid

from mechsym.cycle.chamber import chamber, travel
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.cylinder import piston_area
from mechsym.cycle.engine import curves
from mechsym.cycle.kinds import back_pressure, cylinder_pressure
from mechsym.cycle.kinds.schmidt import Schmidt, schmidt_pressure
from mechsym.cycle.pressure import Pressure, periodic, piston_force
from mechsym.errors import BadInput
from mechsym.mechanisms.crank_train import build_rigid
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.quantities import record

_STEP = math.radians(0.25)  # of the tabulated cycle
_DEGREE = 60  # round-off for rods down to 1.2 crank radii


@record
class Gas:
    """Pressure on one piston over the angle from its firing dead centre, the cylinder it acts in, the other side."""

    pressure: Pressure
    p_back: float  #: Absolute pressure on the other side of the piston [Pa]
    bore: float  #: Of one piston [m]
    stroke: float  #: [m]
    compression_ratio: float  #: Largest over smallest volume of one cylinder [-]
    shared: bool = False  #: Whether all pistons of a machine share it, over the angle of the shaft

    # a gas is itself: what is computed of it is kept by identity
    __hash__ = object.__hash__

    @property
    def area(self) -> float:
        """Area of one piston [m^2]."""
        return piston_area(self.bore)

    @property
    def period(self) -> float:
        """Period of the pressure, 2 pi or 4 pi [rad]."""
        return self.pressure.period

    @property
    def kinks(self) -> tuple[float, ...]:
        """Angles in [0, period) where the pressure is not smooth; empty where none are known [rad]."""
        return self.pressure.kinks

    @property
    def facts(self) -> tuple[str, ...]:
        """What was assumed, one sentence each."""
        return self.pressure.facts

    def absolute(self, phi: Any) -> Any:
        """Absolute pressure.

        Parameters
        ----------
        phi : float or ndarray
            Angle from firing dead centre [rad]

        Returns
        -------
        p : float or ndarray
            Shape of phi [Pa]
        """
        return self.pressure.absolute(phi)

    def force(self, phi: Any) -> Any:
        """Net force on the piston, positive away from the head.

        Parameters
        ----------
        phi : float or ndarray
            Angle from firing dead centre [rad]

        Returns
        -------
        F : float or ndarray
            Shape of phi [N]
        """
        return piston_force(self.pressure, self.p_back, self.area, phi)


def gas_in_cylinder(cycle: Any, kinematics: ca.Function) -> Gas:
    """Gas of a cycle that needs nothing but a cylinder.

    Parameters
    ----------
    kinematics : casadi.Function
        One input, the crank angle [rad]; named outputs `x` [m] and `dx_dphi` [m/rad]
    """
    pressure, cylinder = cylinder_pressure(cycle, kinematics)
    return Gas(
        pressure=pressure,
        p_back=back_pressure(cycle),
        bore=cylinder.bore,
        stroke=cylinder.stroke,
        compression_ratio=cylinder.compression_ratio,
    )


def gas_of_engine(engine: ClosedEngine, omega: float) -> Gas:
    """Gas of an engine at one speed.

    Parameters
    ----------
    omega : float
        Crank speed [rad/s]
    """
    found, room, charge = curves(engine, omega, _STEP), chamber(engine.chamber, engine.motion), engine.cycle
    phi = np.radians(found["phi_deg"])

    def closed_or_open(angle: np.ndarray) -> np.ndarray:
        return np.interp(angle, phi, found["p_pa"], left=charge.intake_pressure, right=charge.intake_pressure)

    # gas exchange at intake pressure gives back what the closed period took at that pressure
    work = trapezoid(found["p_pa"] - charge.intake_pressure, np.asarray(travel(engine.motion, phi)[0]).ravel())
    top = int(np.argmax(found["p_pa"]))
    pressure = Pressure(
        kind="spark-ignition",
        period=4 * math.pi,
        kinks=(),
        absolute=periodic(closed_or_open, 4 * math.pi, -2 * math.pi),
        p_max=float(found["p_pa"][top]),
        phi_p_max=float(phi[top]),
        mean_indicated=float(work / room.stroke),
        facts=("gas exchange takes place at intake pressure: assumed, the cycle models the closed period only",),
    )
    return Gas(
        pressure=pressure,
        p_back=room.back_pressure,
        bore=room.bore,
        stroke=float(room.stroke),
        compression_ratio=engine.chamber.compression_ratio,
    )


def gas_of_train(cycle: Schmidt, train: CrankTrainParameters) -> Gas:
    """Gas that the two cylinders of a crank train share, hot and cold."""
    if not isinstance(train, CrankTrainParameters) or len(train.throw) != 2:
        raise BadInput("[cycle] of kind 'schmidt' needs a crank_train with two cylinders, hot and cold")
    kinematics, phi = build_rigid(train).functions["kinematics"], ca.SX.sym("phi")
    found = dict(zip(kinematics.name_out(), kinematics(phi), strict=True))
    travels = [_vectorised(ca.Function("x", [phi], [found[f"x_{i}"]])) for i in (1, 2)]
    pressure = schmidt_pressure(cycle, *travels)
    stroke = 2 * each(train, "r")[0]
    area = piston_area(cycle.bore)
    return Gas(
        pressure=pressure,
        p_back=cycle.p_back,
        bore=cycle.bore,
        stroke=stroke,
        compression_ratio=1 + area * stroke / cycle.dead_hot if cycle.dead_hot else math.inf,
        shared=True,
    )


def _vectorised(function: ca.Function) -> Callable[[np.ndarray], np.ndarray]:
    return lambda phi: np.asarray(function(np.reshape(phi, (1, -1)))).reshape(np.shape(phi))


def at_same_travel(found: Gas, own: ca.Function, other: ca.Function) -> Gas:
    r"""The same indicator diagram over another motion of equal stroke: equal pressure at equal travel, so equal work.

    .. math:: p_{other}(\theta) = p(\varphi), \quad x_{own}(\varphi) = x_{other}(\theta)

    Parameters
    ----------
    own, other : casadi.Function
        Travels of `travel`, both with dead centres at 0 and pi

    Returns
    -------
    gas : Gas
        Over the motion `other`, whose kinks are not looked for
    """

    # travel is even in the angle, so one cosine is a smooth function of the other: a polynomial found once
    cosine = Chebyshev.interpolate(lambda c: np.cos(_angle_at(own, _travelled(other, np.arccos(c)))), _DEGREE)

    def absolute(theta: np.ndarray) -> np.ndarray:
        theta = np.asarray(theta, dtype=float)
        half = np.ceil(theta / math.pi) - 1  # a valve that opens at the dead centre opens after it
        angle = np.arccos(np.clip(cosine(np.cos(theta)), -1.0, 1.0))
        return found.absolute(np.where(half % 2 == 0, half * math.pi + angle, (half + 1) * math.pi - angle))

    return dataclasses.replace(found, pressure=dataclasses.replace(found.pressure, absolute=absolute, kinks=()))


def _travelled(motion: ca.Function, phi: np.ndarray) -> np.ndarray:
    return np.asarray(motion(phi.reshape(1, -1))[0]).reshape(phi.shape)


def _angle_at(motion: ca.Function, x: np.ndarray) -> np.ndarray:
    # between the dead centres the travel only grows: bisection to the last digit, with no slope to divide by
    low, high = np.zeros_like(x), np.full_like(x, math.pi)
    for _ in range(54):
        middle = (low + high) / 2
        short = _travelled(motion, middle) < x
        low, high = np.where(short, middle, low), np.where(short, high, middle)
    return (low + high) / 2
