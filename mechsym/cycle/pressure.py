r"""Cylinder pressure as a function of the crank angle: the record every cycle ends in, whatever it was made from.

    p |      /\                 phi = 0 at (firing) top dead centre, positive in the sense of rotation
      |     /  \                p is absolute; F = (p - p_back) A pushes the piston away from the head
      |____/    \____           two-stroke: period 2 pi, four-stroke: 4 pi
          0  phi

All pressures are absolute and in pascal; the names of the facts' units say where they are not.

A turn without combustion is the compression line both ways, which never does work:

.. math:: p(\varphi) \to \min[p(\varphi), p(-\varphi)] \quad \text{on the stroke behind firing dead centre}

What expands is what was compressed: n_e = n_c, no fuel. A polytropic expansion with its own n_e < n_c would give work
from nothing (0.4 to 1.5 bar in the built-in cycle); heat loss would take some, and makes a lost combustion worse.
"""

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeAlias

import numpy as np

from mechsym.cycle.chamber import Chamber, travel
from mechsym.quantities.results import quantity, result
from mechsym.quantities.units import Array, Pascal, Radian, Scalar

ATMOSPHERE = 101325.0

# Gauss panels of two degrees with eight nodes: a polytrope is integrated to round-off
_PANEL = math.pi / 90
_LOOKS, _FINER = 6, 16  # at a peak, each so much finer than the one before
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)

#: From and to an angle [rad], and a formula of it for numbers and CasADi symbols
Pieces: TypeAlias = tuple[tuple[float, float, Callable[[Any], Any]], ...]


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
    #: Formulas by which it is made, from angle to angle of a period [rad], each a callable of a CasADi symbol; empty
    #: where a table or an integration makes it
    formulas: Pieces = ()


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
    """Highest pressure and its angle, looked at more and more finely.

    absolute: callable, pressure of the crank angle [Pa]; period: 2 pi or 4 pi; kinks: angles in [0, period) where the
    pressure is not smooth. Returns phi: its angle in (-period/2, period/2].
    """
    phi = np.union1d(np.linspace(-period / 2, period / 2, 2881)[1:], _centred(np.asarray(kinks), period))
    at = phi[int(np.argmax(absolute(phi)))]
    span = period / 2880
    for _ in range(_LOOKS):
        near = at + span * np.linspace(-1, 1, 2 * _FINER + 1)
        at, span = near[int(np.argmax(absolute(near)))], span / _FINER
    return float(absolute(at)), float(_centred(at, period))


def _centred(angle: Scalar, period: float) -> Scalar:
    return period / 2 - np.remainder(period / 2 - angle, period)


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
