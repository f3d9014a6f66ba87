r"""Cylinder pressure as a function of the crank angle: the record every cycle ends in, whatever it was made from.

    p |      /\                 phi = 0 at (firing) top dead centre, positive in the sense of rotation
      |     /  \                p is absolute; F = (p - p_back) A pushes the piston away from the head
      |____/    \____           two-stroke: period 2 pi, four-stroke: 4 pi
          0  phi

All pressures are absolute and in pascal; the names of the facts' units say where they are not.
"""

import dataclasses
import math
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber, travel
from mechsym.quantities import record

ATMOSPHERE = 101325.0

# Gauss panels of two degrees with eight nodes: a polytrope is integrated to round-off
_PANEL = math.pi / 90
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


@record
class Pressure:
    """Cylinder pressure over one period."""

    kind: str  #: How it was made: `two-stroke-marine`, `diagram`, ...
    period: float  #: 2 pi (two-stroke) or 4 pi (four-stroke) [rad]
    kinks: tuple[float, ...]  #: Crank angles in [0, period) where p is not smooth [rad]
    #: ndarray of crank angles, any real [rad], to absolute pressure of the same shape [Pa]
    absolute: Callable[[Any], Any]
    #: Highest pressure [Pa] and its crank angle in (-period/2, period/2] [rad]
    p_max: float
    phi_p_max: float
    mean_indicated: float  #: Mean indicated pressure, net over the period [Pa]
    t_max: float | None = None  #: Highest mean temperature of the gas; None where its mass is not known [K]
    #: Names and crank angles of the events, for tables and plots [rad]
    phases: Mapping[str, float] = dataclasses.field(default_factory=dict)
    facts: tuple[str, ...] = ()  #: What was assumed and what came out, one sentence each
    doubts: tuple[str, ...] = ()  #: What looks physically implausible, one sentence each; empty if nothing does


def periodic(function: Callable[[Any], Any], period: float, start: float = 0.0) -> Callable[[Any], Any]:
    """The periodic continuation of a function known on one period.

    Parameters
    ----------
    function : callable
        Of angles in [start, start + period)
    period : float
        2 pi or 4 pi [rad]
    start : float
        Where the known period begins [rad]

    Returns
    -------
    function : callable
        Of any real angle [rad]
    """

    def continued(phi: Any) -> Any:
        return function(start + np.remainder(np.asarray(phi, dtype=float) - start, period))

    return continued


def wrapped(angles: Any, period: float) -> Any:
    """Angles moved into [0, period).

    Parameters
    ----------
    angles : float or ndarray
        Any real angles [rad]
    period : float
        2 pi or 4 pi [rad]

    Returns
    -------
    angles : float or ndarray
        The same angles in [0, period) [rad]
    """
    inside = np.remainder(angles, period)
    # the remainder of a tiny negative number rounds up to the period itself
    return np.where(inside >= period, 0.0, inside)[()]


def quadrature(period: float, kinks: tuple[float, ...]) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights that integrate a function with these kinks over one period.

    Parameters
    ----------
    period : float
        2 pi or 4 pi [rad]
    kinks : tuple of float
        Angles in [0, period) where panels must end [rad]

    Returns
    -------
    phi, weights : ndarray, shape (n,)
        Nodes and weights of composite Gauss-Legendre panels [rad]
    """
    count = round(period / _PANEL)
    edges = np.union1d(np.linspace(0.0, period, count + 1), kinks)
    half = np.diff(edges) / 2
    phi = (edges[:-1] + half)[:, None] + half[:, None] * _NODES
    return phi.ravel(), (half[:, None] * _WEIGHTS).ravel()


def mean_indicated_pressure(
    absolute: Callable[[Any], Any], period: float, kinks: tuple[float, ...], cylinder: Chamber
) -> float:
    r"""Work of the gas over one period, by swept volume.

    .. math:: p_{mi} = \frac{1}{V_d}\oint p\,dV = \frac{1}{s}\int_0^{T} p\,x'(\varphi)\,d\varphi

    Parameters
    ----------
    absolute : callable
        Pressure of the crank angle [Pa]
    period : float
        T: 2 pi or 4 pi; over 4 pi the gas exchange counts (net value) [rad]
    kinks : tuple of float
        Angles in [0, period) where the pressure is not smooth [rad]

    Returns
    -------
    p_mi : float
        Mean indicated pressure [Pa]
    """
    phi, weights = quadrature(period, kinks)
    return float(np.sum(weights * absolute(phi) * travel(cylinder.motion, phi)[1]) / cylinder.stroke)


def pressure_over(
    kind: str, absolute: Callable[[Any], Any], period: float, kinks: tuple[float, ...], cylinder: Chamber, **rest: Any
) -> Pressure:
    """The record of a pressure, with its peak and its work.

    Parameters
    ----------
    absolute : callable
        Pressure of the crank angle [Pa]
    period : float
        2 pi or 4 pi [rad]
    kinks : tuple of float
        Angles in [0, period) where the pressure is not smooth [rad]
    rest : keyword arguments
        Fields `t_max`, `phases`, `facts` and `doubts` of the record, as far as there are any
    """
    p_max, phi_p_max = peak(absolute, period, kinks)
    mean = mean_indicated_pressure(absolute, period, kinks, cylinder)
    return Pressure(
        kind=kind, period=period, kinks=kinks, absolute=absolute, p_max=p_max, phi_p_max=phi_p_max,
        mean_indicated=mean, **rest,
    )  # fmt: skip


def peak(absolute: Callable[[Any], Any], period: float, kinks: tuple[float, ...]) -> tuple[float, float]:
    """Highest pressure and its angle.

    Parameters
    ----------
    absolute : callable
        Pressure of the crank angle [Pa]
    period : float
        2 pi or 4 pi [rad]
    kinks : tuple of float
        Angles in [0, period) where the pressure is not smooth [rad]

    Returns
    -------
    p_max : float
        Highest pressure [Pa]
    phi : float
        Its angle in (-period/2, period/2] [rad]
    """
    phi = np.union1d(np.linspace(-period / 2, period / 2, 2881)[1:], _centred(np.asarray(kinks), period))
    at = phi[int(np.argmax(absolute(phi)))]
    step = period / 2880
    refined = scipy.optimize.minimize_scalar(
        lambda angle: -float(absolute(angle)), bounds=(at - step, at + step), method="bounded", options={"xatol": 1e-9}
    )
    best = max((float(at), float(refined.x)), key=lambda angle: float(absolute(angle)))
    return float(absolute(best)), float(_centred(best, period))


def _centred(angle: Any, period: float) -> Any:
    return period / 2 - np.remainder(period / 2 - angle, period)
