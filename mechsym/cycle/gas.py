"""The gas of an engine: pressure over the angle, and the chamber it acts in, whatever kind of cycle it comes from."""

import dataclasses
import math
from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
from numpy.polynomial import Chebyshev

from mechsym.cycle.chamber import Chamber, chamber, piston_area
from mechsym.cycle.closed.model import ClosedEngine
from mechsym.cycle.dead_centres import motion_over
from mechsym.cycle.engine import curves
from mechsym.cycle.kinds import cylinder_pressure
from mechsym.cycle.kinds.stirling import StirlingEngine, stirling_engine, stirling_pressure
from mechsym.cycle.kinds.stirling_second_order import StirlingLosses
from mechsym.cycle.kinds.stirling_spaces import StirlingCylinders, areas
from mechsym.cycle.pressure import Pressure, peak, periodic, pressure_over
from mechsym.errors import BadInput
from mechsym.mechanisms.crank_train import build_rigid
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.mechanisms.traits import is_train, name_of, with_trait
from mechsym.page import Shown
from mechsym.quantities import record

_STEP = math.radians(0.25)  # of the tabulated cycle
_DEGREE = 60  # round-off for rods down to 1.2 crank radii


@record
class Gas(Shown):
    """Gas on a piston, over the angle from its firing dead centre."""

    pressure: Pressure
    chamber: Chamber
    #: Areas by which a gas that all pistons of a machine share pushes each of them, over the angle of the shaft; empty
    #: where each piston has a gas of its own [m^2]
    pistons: tuple[float, ...] = ()

    # a gas is itself: what is computed of it is kept by identity
    __hash__ = object.__hash__

    @property
    def on_shaft(self) -> bool:
        """Whether its force is a torque, of which no compression line about angle 0 is known."""
        return False

    @property
    def has_pressure(self) -> bool:
        """Whether a pressure is known that gives its force."""
        return True

    @property
    def p_back(self) -> float:
        """Absolute pressure on the other side of the piston [Pa]."""
        return self.chamber.back_pressure

    def force(self, phi: Any) -> Any:
        r"""Net force on the piston, positive away from the head.

        .. math:: F = (p(\varphi) - p_\mathrm{back})\,A

        Parameters
        ----------
        phi : float or ndarray
            Angle from firing dead centre [rad]

        Returns
        -------
        F : float or ndarray
            Force, shape of phi [N]
        """
        return (self.pressure.absolute(phi) - self.p_back) * self.chamber.area


def gas_in_cylinder(cycle: Any, kinematics: ca.Function) -> Gas:
    """Gas of a cycle that needs nothing but a cylinder.

    Parameters
    ----------
    kinematics : casadi.Function
        One input, the crank angle [rad]; named outputs `x` [m] and `dx_dphi` [m/rad]
    """
    pressure, room = cylinder_pressure(cycle, kinematics)
    return Gas(pressure=pressure, chamber=room)


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

    facts = ("gas exchange takes place at intake pressure: assumed, the cycle models the closed period only",)
    absolute = periodic(closed_or_open, 4 * math.pi, -2 * math.pi)
    pressure = pressure_over(
        "spark-ignition", absolute, 4 * math.pi, (), room, t_max=float(found["t_k"].max()), facts=facts
    )
    return Gas(pressure=pressure, chamber=room)


def gas_of_train(
    cycle: StirlingCylinders, train: CrankTrainParameters, omega: float, losses: StirlingLosses | None = None
) -> Gas:
    """Gas that the two cylinders of a crank train share; its chamber is the hot one.

    Parameters
    ----------
    omega : float
        Shaft speed, for a cycle that depends on it [rad/s]
    """
    return gas_of_engine_on(engine_of_train(cycle, train, omega, losses), cycle, train)


def gas_of_engine_on(engine: StirlingEngine, cycle: StirlingCylinders, train: CrankTrainParameters) -> Gas:
    """Gas of a Stirling engine whose turn is known, on its crank train."""
    kinematics, phi = build_rigid(train).functions["kinematics"], ca.SX.sym("phi")
    found = dict(zip(kinematics.name_out(), kinematics(phi), strict=True))
    hot = ca.Function("hot", [phi], [found["x_1"], found["dx_1_dphi"]], ["phi"], ["x", "dx_dphi"])
    area, stroke = piston_area(cycle.bore), 2 * each(train, "r")[0]
    room = Chamber(
        motion=motion_over(hot), pistons=1, bore=cycle.bore, area=area, stroke=stroke, clearance=cycle.dead_hot,
        displacement=area * stroke, back_pressure=cycle.p_back,
        compression_ratio=1 + area * stroke / cycle.dead_hot if cycle.dead_hot else math.inf,
    )  # fmt: skip
    pistons = areas(cycle).sum(axis=0).tolist()
    return Gas(pressure=stirling_pressure(engine), chamber=room, pistons=tuple(pistons))


def engine_of_train(
    cycle: StirlingCylinders, train: CrankTrainParameters, omega: float, losses: StirlingLosses | None = None
) -> StirlingEngine:
    """The Stirling engine on a crank train.

    Parameters
    ----------
    omega : float
        Shaft speed, for a cycle that depends on it [rad/s]
    """
    if not is_train(name_of(type(train))) or len(train.throw) != 2:
        trains = " or ".join(with_trait(lambda known: known.assembled))
        raise BadInput(f"[cycle] of a Stirling engine needs a {trains} with two cylinders, hot and cold")
    kinematics = build_rigid(train).functions["kinematics"]

    def travel(name: str) -> Callable[[Any], Any]:
        return lambda phi: kinematics.call([phi])[kinematics.name_out().index(name)]

    return stirling_engine(cycle, (travel("x_1"), travel("x_2")), omega, losses)


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
        return found.pressure.absolute(np.where(half % 2 == 0, half * math.pi + angle, (half + 1) * math.pi - angle))

    p_max, angle = peak(absolute, found.pressure.period, ())
    pressure = dataclasses.replace(found.pressure, absolute=absolute, kinks=(), p_max=p_max, phi_p_max=angle, phases={})
    room = dataclasses.replace(found.chamber, motion=motion_over(other))
    return dataclasses.replace(found, pressure=pressure, chamber=room)


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
