r"""Which part of the torque the hinge takes, and the ripple that the rest leaves.

A four-stroke torque repeats every two turns. Two ways out, by name: `whole_cycle` (the track turns on a slower shaft,
once per cycle) and `every_turn` (the track turns with the crank and takes the part that repeats every turn, the mean of
the two turns). For a two-stroke both are the same.

Whatever torque is missing shows as a ripple. With a constant load the kinetic energy gives it exactly:

.. math:: \tfrac12 I(\varphi)\,(\dot\varphi^2 - \omega^2) = c - W_\mathrm{rest}(\varphi)

with c such that the mean speed in time is omega.
"""

import dataclasses
import math

import numpy as np
from scipy.interpolate import PPoly
from scipy.optimize import brentq

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge import Hinge

KINDS = ("whole_cycle", "every_turn")
_TURN = 2 * math.pi
_POINTS = 4096


@dataclasses.dataclass(frozen=True, kw_only=True)
class Balance:
    """The torque that a hinge shall give, and what it leaves.

    Parameters
    ----------
    kind : str
        `whole_cycle` or `every_turn`
    period : float
        Period of the torque that the hinge gives [rad]
    torque, work : PPoly
        That torque [N*m] and its integral from phi = 0 [J]
    rest : PPoly
        Torque that is left over [N*m]
    rest_swing : float
        Largest minus smallest work of the rest [J]
    expected_ripple : float or None
        (omega_max - omega_min) / omega_mean that the rest leaves under constant load; None if the crank would stop [-]
    """

    kind: str
    period: float
    torque: PPoly
    work: PPoly
    rest: PPoly
    rest_swing: float
    expected_ripple: float | None


def build(hinge: Hinge, kind: str) -> Balance:
    """The part of the hinge torque that the hinge takes.

    Parameters
    ----------
    hinge : Hinge
        Torque that would keep the speed constant
    kind : str
        `whole_cycle` or `every_turn`

    Returns
    -------
    balance : Balance
        The torque, the rest and its ripple
    """
    if kind not in KINDS:
        raise BadInput(f"balance = {kind!r} is not an option; options are {', '.join(KINDS)}")
    period = hinge.period if kind == "whole_cycle" else min(hinge.period, _TURN)
    torque = hinge.torque if period == hinge.period else turn_mean(hinge.torque)
    rest = _difference(hinge.torque, torque)
    work_rest = periodic.antiderivative(rest)
    low, _, high, _ = periodic.extremes(work_rest)
    return Balance(
        kind=kind,
        period=period,
        torque=torque,
        work=periodic.antiderivative(torque),
        rest=rest,
        rest_swing=high - low,
        expected_ripple=expected_ripple(work_rest, hinge.inertia, hinge.omega),
    )


def turn_mean(torque: PPoly) -> PPoly:
    r"""Part of a torque that repeats every turn.

    .. math:: \bar M(\varphi) = \frac1k \sum_{i=0}^{k-1} M(\varphi + 2 \pi i)

    Parameters
    ----------
    torque : PPoly
        Torque over k whole turns [N*m]

    Returns
    -------
    mean : PPoly
        Torque of period 2 pi [N*m]
    """
    turns = round(torque.x[-1] / _TURN)
    shifts = _TURN * np.arange(turns)[:, None]
    return periodic.fit(lambda phi: torque(phi + shifts).mean(axis=0), torque.x, _TURN, tol=1e-11)


def speed(work_rest: PPoly, inertia: PPoly, omega: float, phi: np.ndarray) -> np.ndarray | None:
    """Crank speed that a missing torque leaves under constant load, at a given mean speed.

    Parameters
    ----------
    work_rest : PPoly
        Integral of the torque that is wanted and missing [J]
    inertia : PPoly
        Reduced inertia [kg*m^2]
    omega : float
        Mean speed in time [rad/s]
    phi : ndarray, shape (n,)
        Crank angles, even over a period of `work_rest` without its end [rad]

    Returns
    -------
    phid : ndarray, shape (n,), or None
        Speed [rad/s]; None if no motion with that mean speed exists: the crank would stop
    """
    lost, half = work_rest(phi), inertia(phi) / 2

    def squares(c: float) -> np.ndarray:
        return omega**2 + (c - lost) / half

    def excess(c: float) -> float:
        return 1 / float(np.mean(1 / np.sqrt(squares(c)))) - omega

    swing = float(np.ptp(lost))
    least = float(np.max(lost - half * omega**2)) + 1e-9 * swing
    if swing <= 1e-12 * float(half.min()) * omega**2:
        return np.full_like(phi, omega)
    if excess(least) > 0:
        return None
    return np.sqrt(squares(brentq(excess, least, least + 2 * swing + float(half.max()) * omega**2, xtol=1e-9 * swing)))


def expected_ripple(work_rest: PPoly, inertia: PPoly, omega: float) -> float | None:
    """Speed ripple that a missing torque leaves under constant load.

    Parameters
    ----------
    work_rest : PPoly
        Integral of the torque that is wanted and missing [J]
    inertia : PPoly
        Reduced inertia [kg*m^2]
    omega : float
        Mean speed in time [rad/s]

    Returns
    -------
    ripple : float or None
        (omega_max - omega_min) / omega_mean [-]; None if the crank would stop
    """
    phid = speed(work_rest, inertia, omega, np.arange(_POINTS) * work_rest.x[-1] / _POINTS)
    return None if phid is None else float(np.ptp(phid)) / omega


def _difference(torque: PPoly, part: PPoly) -> PPoly:
    if part is torque:
        return PPoly(np.zeros_like(torque.c), torque.x, extrapolate="periodic")
    period = torque.x[-1]
    breaks = np.concatenate([torque.x, part.x, part.x + _TURN])
    return periodic.fit(lambda phi: torque(phi) - part(phi), breaks, period, tol=1e-9)
