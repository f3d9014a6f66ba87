"""The gas of an engine: pressure over the angle, and the chamber it acts in, whatever kind of cycle it comes from."""

import dataclasses
import math

import casadi as ca
import numpy as np
from numpy.polynomial import Chebyshev

from mechsym.cycle.chamber import Chamber
from mechsym.cycle.dead_centres import motion_over
from mechsym.cycle.pressure import Pressure, peak
from mechsym.page import Shown
from mechsym.quantities import record
from mechsym.quantities.units import Newton, Radian, Scalar

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
    def p_back(self) -> float:
        """Absolute pressure on the other side of the piston [Pa]."""
        return self.chamber.back_pressure

    def force(self, phi: Radian[Scalar]) -> Newton[Scalar]:
        r"""Net force on the piston, positive away from the head.

        .. math:: F = (p(\varphi) - p_\mathrm{back})\,A

        phi: angle from firing dead centre. Returns F: force, shape of phi.
        """
        return (self.pressure.absolute(phi) - self.p_back) * self.chamber.area


def at_same_travel(found: Gas, own: ca.Function, other: ca.Function) -> Gas:
    r"""The same indicator diagram over another motion of equal stroke: equal pressure at equal travel, so equal work.

    .. math:: p_{other}(\theta) = p(\varphi), \quad x_{own}(\varphi) = x_{other}(\theta)

    own, other: travels of `travel`, both with dead centres at 0 and pi. Returns gas: over the motion `other`, whose
    kinks are not looked for.
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
