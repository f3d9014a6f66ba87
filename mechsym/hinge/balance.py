"""Which part of the torque the hinge takes, and the ripple that the rest leaves.

A four-stroke torque repeats every two turns. Two ways out, by name: `whole_cycle` (the track turns on a slower shaft,
once per cycle) and `every_turn` (the track turns with the crank and takes the part that repeats every turn, the mean of
the two turns). For a two-stroke both are the same.
"""

import functools
import math

import numpy as np
import scipy

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge.choices import BALANCES
from mechsym.hinge.ripple import constant_load_speed, propeller_load_speed, ripple
from mechsym.hinge.torque import Hinge
from mechsym.periodic import even_angles
from mechsym.quantities import record

_TURN = 2 * math.pi


@record
class Balance:
    """The torque that a hinge shall give, and what it leaves."""

    kind: str
    omega: float  #: Crank speed that it is for [rad/s]
    period: float  #: Period of the torque that the hinge gives [rad]
    #: That torque [N*m] and its integral from phi = 0 [J]
    torque: "scipy.interpolate.PPoly"
    work: "scipy.interpolate.PPoly"
    rest: "scipy.interpolate.PPoly"  #: Torque that is left over [N*m]
    rest_swing: float  #: Largest minus smallest work of the rest [J]
    #: Speed ripple that the rest leaves; None if the crank would stop [-]
    ripple_constant_load: float | None
    ripple_propeller_load: float | None


# the springs of a sweep share one torque
@functools.lru_cache(maxsize=8)
def balance(hinge: Hinge, kind: str) -> Balance:
    """The part of the hinge torque that the hinge takes.

    hinge: torque that would keep the speed constant. Returns balance: the torque, the rest and its ripple.
    """
    if kind not in BALANCES:
        raise BadInput(f"balance = {kind!r} is not an option; options are {', '.join(BALANCES)}")
    period = hinge.period if kind == "whole_cycle" else min(hinge.period, _TURN)
    torque = hinge.torque if period == hinge.period else turn_mean(hinge.torque)
    rest = _rest(hinge.torque, torque)
    work_rest = periodic.antiderivative(rest)
    low, _, high, _ = periodic.extremes(work_rest)
    phi = even_angles(hinge.period)
    missing, inertia = work_rest(phi), hinge.inertia(phi)
    return Balance(
        kind=kind,
        omega=hinge.omega,
        period=period,
        torque=torque,
        work=periodic.antiderivative(torque),
        rest=rest,
        rest_swing=abs(high - low),
        ripple_constant_load=ripple(constant_load_speed(missing, inertia, hinge.omega)),
        ripple_propeller_load=ripple(
            propeller_load_speed(missing, inertia, hinge.omega, hinge.load_torque, hinge.period)
        ),
    )


def turn_mean(torque: "scipy.interpolate.PPoly") -> "scipy.interpolate.PPoly":
    r"""Part of a torque that repeats every turn.

    .. math:: \bar M(\varphi) = \frac1k \sum_{i=0}^{k-1} M(\varphi + 2 \pi i)

    torque: torque over k whole turns [N*m]. Returns mean: torque of period 2 pi [N*m].
    """
    turns = round(torque.x[-1] / _TURN)
    shifts = _TURN * np.arange(turns)[:, None]
    return periodic.fit(lambda phi: torque(phi + shifts).mean(axis=0), torque.x, _TURN, tol=1e-11)


def _rest(torque: "scipy.interpolate.PPoly", part: "scipy.interpolate.PPoly") -> "scipy.interpolate.PPoly":
    if part is torque:
        return scipy.interpolate.PPoly(np.zeros_like(torque.c), torque.x, extrapolate="periodic")
    breaks = np.concatenate([torque.x, part.x, part.x + _TURN])
    return periodic.fit(lambda phi: torque(phi) - part(phi), breaks, torque.x[-1], tol=1e-9)
