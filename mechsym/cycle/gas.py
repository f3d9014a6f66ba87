r"""The gas of an engine: pressure over the angle, and the chamber it acts in, whatever kind of cycle it comes from.

Cylinder pressure as a function of the crank angle: the record every cycle ends in, whatever it was made from.

    p |      /\                 phi = 0 at (firing) top dead centre, positive in the sense of rotation
      |     /  \                p is absolute; F = (p - p_back) A pushes the piston away from the head
      |____/    \____           two-stroke: period 2 pi, four-stroke: 4 pi
          0  phi

All pressures are absolute and in pascal; the names of the facts' units say where they are not.

The gas in a turn without combustion: the compression line both ways, which never does work.

.. math:: p(\varphi) \to \min[p(\varphi), p(-\varphi)] \quad \text{on the stroke behind firing dead centre}

What expands is what was compressed: n_e = n_c, no fuel. A polytropic expansion with its own n_e < n_c would give work
from nothing (0.4 to 1.5 bar in the built-in cycle); heat loss would take some, and makes a lost combustion worse.
"""

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import casadi as ca
import numpy as np
import scipy
from numpy.polynomial import Chebyshev

from mechsym.cycle.chamber import Chamber, motion_over, travel
from mechsym.cycle.motion import dead_centre
from mechsym.page import Shown
from mechsym.quantities import record
from mechsym.quantities.results import quantity, result
from mechsym.quantities.units import Array, Newton, Pascal, Radian, Scalar

ATMOSPHERE = 101325.0

# Gauss panels of two degrees with eight nodes: a polytrope is integrated to round-off
_PANEL = math.pi / 90
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


@result
class Pressure:
    """Cylinder pressure over one period."""

    kind: str  #: How it was made: `two-stroke-marine`, `diagram`, ...
    period: float  #: 2 pi (two-stroke) or 4 pi (four-stroke) [rad]
    kinks: tuple[float, ...]  #: Crank angles in [0, period) where p is not smooth [rad]
    #: ndarray of crank angles, any real [rad], to absolute pressure of the same shape [Pa]
    absolute: Callable[[Scalar], Scalar]
    p_max: float = quantity("Pa", card="largest pressure")  #: Absolute
    phi_p_max: float = quantity("rad")  #: Crank angle of the peak, in (-period/2, period/2]
    mean_indicated: float = quantity("Pa", card="IMEP net")  #: Net over the period
    #: Highest mean temperature of the gas; None where its mass is not known
    t_max: float | None = quantity("K", default=None, card="peak temperature")
    #: Names and crank angles of the events, for tables and plots [rad]
    phases: Mapping[str, float] = dataclasses.field(default_factory=dict)
    facts: tuple[str, ...] = ()  #: What was assumed and what came out, one sentence each
    doubts: tuple[str, ...] = ()  #: What looks physically implausible, one sentence each; empty if nothing does


def periodic(function: Callable[[Scalar], Scalar], period: Radian, start: Radian = 0.0) -> Callable[[Scalar], Scalar]:
    """The periodic continuation of a function known on one period.

    function: callable, of angles in [start, start + period); period: 2 pi or 4 pi; start: where the known period
    begins. Returns function: callable, of any real angle [rad].
    """

    def continued(phi: Scalar) -> Scalar:
        return function(start + np.remainder(np.asarray(phi, dtype=float) - start, period))

    return continued


def wrapped(angles: Radian[Scalar], period: Radian) -> Radian[Scalar]:
    """Angles moved into [0, period). angles: any real angles; period: 2 pi or 4 pi."""
    inside = np.remainder(angles, period)
    # the remainder of a tiny negative number rounds up to the period itself
    return np.where(inside >= period, 0.0, inside)[()]


def quadrature(period: Radian, kinks: tuple[Radian, ...]) -> tuple[Radian[Array], Radian[Array]]:
    """Nodes and weights that integrate a function with these kinks over one period.

    period: 2 pi or 4 pi; kinks: angles in [0, period) where panels must end. Returns phi, weights: nodes and weights of
    composite Gauss-Legendre panels.
    """
    count = round(period / _PANEL)
    edges = np.union1d(np.linspace(0.0, period, count + 1), kinks)
    half = np.diff(edges) / 2
    phi = (edges[:-1] + half)[:, None] + half[:, None] * _NODES
    return phi.ravel(), (half[:, None] * _WEIGHTS).ravel()


def mean_indicated_pressure(
    absolute: Callable[[Scalar], Scalar], period: Radian, kinks: tuple[Radian, ...], cylinder: Chamber
) -> Pascal:
    r"""Work of the gas over one period, by swept volume.

    .. math:: p_{mi} = \frac{1}{V_d}\oint p\,dV = \frac{1}{s}\int_0^{T} p\,x'(\varphi)\,d\varphi

    absolute: callable, pressure of the crank angle [Pa]. period: T: 2 pi or 4 pi; over 4 pi the gas exchange counts
    (net value). kinks: angles in [0, period) where the pressure is not smooth. Returns p_mi: mean indicated pressure.
    """
    phi, weights = quadrature(period, kinks)
    return float(np.sum(weights * absolute(phi) * travel(cylinder.motion, phi)[1]) / cylinder.stroke)


def pressure_over(
    kind: str,
    absolute: Callable[[Scalar], Scalar],
    period: Radian,
    kinks: tuple[Radian, ...],
    cylinder: Chamber,
    **rest: Any,
) -> Pressure:
    """The record of a pressure, with its peak and its work.

    absolute: callable, pressure of the crank angle [Pa]; period: 2 pi or 4 pi; kinks: angles in [0, period) where the
    pressure is not smooth; rest: keyword arguments, fields `t_max`, `phases`, `facts` and `doubts` of the record, as
    far as there are any.
    """
    p_max, phi_p_max = peak(absolute, period, kinks)
    mean = mean_indicated_pressure(absolute, period, kinks, cylinder)
    return Pressure(
        kind=kind, period=period, kinks=kinks, absolute=absolute, p_max=p_max, phi_p_max=phi_p_max,
        mean_indicated=mean, **rest,
    )  # fmt: skip


def peak(absolute: Callable[[Scalar], Scalar], period: Radian, kinks: tuple[Radian, ...]) -> tuple[Pascal, Radian]:
    """Highest pressure and its angle.

    absolute: callable, pressure of the crank angle [Pa]; period: 2 pi or 4 pi; kinks: angles in [0, period) where the
    pressure is not smooth. Returns phi: its angle in (-period/2, period/2].
    """
    phi = np.union1d(np.linspace(-period / 2, period / 2, 2881)[1:], _centred(np.asarray(kinks), period))
    at = phi[int(np.argmax(absolute(phi)))]
    step = period / 2880
    refined = scipy.optimize.minimize_scalar(
        lambda angle: -float(absolute(angle)), bounds=(at - step, at + step), method="bounded", options={"xatol": 1e-9}
    )
    best = max((float(at), float(refined.x)), key=lambda angle: float(absolute(angle)))
    return float(absolute(best)), float(_centred(best, period))


def _centred(angle: Scalar, period: float) -> Scalar:
    return period / 2 - np.remainder(period / 2 - angle, period)


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


def over_travel(found: Gas, own: ca.Function, other: ca.Function, late: Radian = 0.0) -> Gas:
    r"""The same diagram over a motion that is not even in the angle: equal pressure at equal shares of stroke.

    .. math:: p_{other}(\theta) = p(\varphi), \quad x_{own}(\varphi)/s_{own} = x_{other}(\theta)/s_{other}

    own, other: travels from their top dead centres on. late: of that of the other behind its firing angle. Returns gas:
    its work is that of the first by the ratio of the strokes.
    """
    (forth, _, own_stroke), (_, back_again, other_stroke) = _phases(own), _phases(other)

    def angle(theta: np.ndarray) -> np.ndarray:
        return forth(back_again(theta - late)) + late

    def back(phi: float) -> float:
        return float(scipy.optimize.brentq(lambda theta: float(angle(theta)) - phi, phi - 1.0, phi + 1.0, xtol=1e-14))

    whole = found.pressure
    pressure = dataclasses.replace(
        whole, absolute=lambda theta: whole.absolute(angle(np.asarray(theta, dtype=float))),
        kinks=tuple(sorted(back(kink) % whole.period for kink in whole.kinks)), phi_p_max=back(whole.phi_p_max),
    )  # fmt: skip
    room, ratio = found.chamber, other_stroke / own_stroke
    room = dataclasses.replace(
        room, stroke=ratio * room.stroke, displacement=ratio * room.displacement, clearance=ratio * room.clearance
    )
    return dataclasses.replace(found, pressure=pressure, chamber=room)


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
    by = scipy.interpolate.CubicSpline(ends, beyond, bc_type="periodic")
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


def unfired(force: Callable[[np.ndarray], np.ndarray], period: Radian) -> Callable[[np.ndarray], np.ndarray]:
    """Force on the piston [N] over the crank angle in a turn without combustion, from that with it.

    force: angle from firing dead centre [rad] to net force on the piston, which grows with the pressure [N]; period: of
    the cycle.
    """

    def without(phi: np.ndarray) -> np.ndarray:
        angle = np.asarray(phi, dtype=float) % period
        burning = angle < np.pi
        return np.where(burning, np.minimum(force(angle), force(-angle)), force(angle))

    return without


def unfired_kinks(kinks: Sequence[float], period: float) -> tuple[float, ...]:
    """Angles [rad] where that force is not smooth: the kinks, their mirrors behind firing, dead centres."""
    mirrored = [(-k) % period for k in kinks]
    behind = [m for m in mirrored if m <= np.pi + 1e-12]
    return tuple(sorted({round(float(k % period), 12) for k in (*kinks, *behind, 0.0, np.pi)}))
