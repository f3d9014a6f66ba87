"""The gas of an engine: pressure over the angle, and the chamber it acts in, whatever kind of cycle it comes from."""

import dataclasses
import math
from collections.abc import Callable

import casadi as ca
import numpy as np
from numpy.polynomial import Chebyshev

from mechsym.cycle.chamber import Chamber, motion_over
from mechsym.cycle.motion import dead_centre
from mechsym.cycle.pressure import Pieces, Pressure, peak
from mechsym.page import Shown
from mechsym.periodic.pieces import PPoly
from mechsym.periodic.roots import root
from mechsym.quantities import record
from mechsym.quantities.units import Newton, Radian, Scalar

_DEGREE = 60  # round-off for rods down to 1.2 crank radii
_KNOTS = 360  # a half turn


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

    def formulas(self, start: Radian = 0.0) -> Pieces:
        """The same for a CasADi symbol, from angle to angle, of a piston that fires at a start; none without."""
        area = self.chamber.area
        return tuple(
            (a + start, b + start, lambda phi, law=law: (law(phi - start) - self.p_back) * area)
            for a, b, law in self.pressure.formulas
        )


def at_same_travel(gas: Gas, own: ca.Function, other: ca.Function) -> Gas:
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
        return gas.pressure.absolute(np.where(half % 2 == 0, half * math.pi + angle, (half + 1) * math.pi - angle))

    p_max, angle = peak(absolute, gas.pressure.period, ())
    pressure = dataclasses.replace(gas.pressure, absolute=absolute, kinks=(), p_max=p_max, phi_p_max=angle, phases={})
    room = dataclasses.replace(gas.chamber, motion=motion_over(other))
    return dataclasses.replace(gas, pressure=pressure, chamber=room)


def over_travel(gas: Gas, own: ca.Function, other: ca.Function, late: Radian = 0.0) -> Gas:
    r"""The same diagram over a motion that is not even in the angle: equal pressure at equal shares of stroke.

    .. math:: p_{other}(\theta) = p(\varphi), \quad x_{own}(\varphi)/s_{own} = x_{other}(\theta)/s_{other}

    own, other: travels from their top dead centres on. late: of that of the other behind its firing angle. Returns gas:
    its work is that of the first by the ratio of the strokes.
    """
    (forth, _, own_stroke), (_, back_again, other_stroke) = _phases(own), _phases(other)

    def angle(theta: np.ndarray) -> np.ndarray:
        return forth(back_again(theta - late)) + late

    def back(phi: float) -> float:
        return root(lambda theta: float(angle(np.asarray(theta))) - phi, phi - 1.0, phi + 1.0, xtol=1e-14)

    whole = gas.pressure
    pressure = dataclasses.replace(
        whole, absolute=lambda theta: whole.absolute(angle(np.asarray(theta, dtype=float))),
        kinks=tuple(sorted(back(kink) % whole.period for kink in whole.kinks)), phi_p_max=back(whole.phi_p_max),
    )  # fmt: skip
    room, ratio = gas.chamber, other_stroke / own_stroke
    room = dataclasses.replace(
        room, stroke=ratio * room.stroke, displacement=ratio * room.displacement, clearance=ratio * room.clearance
    )
    return dataclasses.replace(gas, pressure=pressure, chamber=room)


_Shift = Callable[[np.ndarray], np.ndarray]


def _phases(motion: ca.Function) -> tuple[_Shift, _Shift, float]:
    """Angle by the phase at which an even motion were, the other way round [rad], and the stroke [m].

    The phase is 2 arcsin of the root of the share of the stroke: smooth through both dead centres.
    """
    bottom = dead_centre(motion, -1.0)
    stroke = float(_travelled(motion, np.array(bottom)))
    middles = (np.arange(_KNOTS) + 0.5) / _KNOTS
    angle = np.concatenate([bottom * middles, bottom + (2 * math.pi - bottom) * middles])
    out = 2 * np.arcsin(np.sqrt(np.clip(_travelled(motion, angle) / stroke, 0.0, 1.0)))
    phase = np.where(angle < bottom, out, 2 * math.pi - out)
    return _shifted(phase, angle), _shifted(angle, phase), stroke


def _shifted(x: np.ndarray, y: np.ndarray) -> _Shift:
    """The function of an angle that goes a turn further where the angle does, through samples of one turn."""
    ends, beyond = np.append(x, x[0] + 2 * math.pi), np.append(y - x, y[0] - x[0])
    by = PPoly.spline(ends, beyond, periodic=True)
    return lambda at: np.asarray(at + by(at))


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
