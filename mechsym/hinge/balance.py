r"""Which part of the torque the hinge takes, and the ripple that the rest leaves.

A four-stroke torque repeats every two turns. Two ways out, by name: `whole_cycle` (the track turns on a slower shaft,
once per cycle) and `every_turn` (the track turns with the crank and takes the part that repeats every turn, the mean of
the two turns). For a two-stroke both are the same.

The crank speed that missing work leaves: closed forms for one rigid coordinate and two load laws, from samples. If the
hinge gives less than the torque M_h that keeps the speed at omega, the missing torque works on E = I (phid^2 - omega^2)
/ 2. With w(phi) the work that is wanted and missing,

.. math:: \frac{dE}{d\varphi} = -\frac{dw}{d\varphi} - \left(M_\mathrm{load} - M_r\right)

Constant load: the bracket is zero and E = c - w; every c is a motion, and c is chosen for the mean speed omega.
Propeller load, M_r (phid/omega)^2: the bracket is a E with a = 2 M_r / (I omega^2), the equation is linear and has one
periodic solution. All arrays are over even crank angles of one period without its end.

These serve the design, which tries hundreds of guides and settings and knows only what work each leaves over. They
know no machine: how an engine with its gas, guide, spring and any load law turns is found by `simulate.steady`, whose
numbers are reported for the engine as built; a test holds the two together.
"""

import functools
import math
from collections.abc import Callable

import numpy as np

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge.choices import BALANCES
from mechsym.hinge.torque import Hinge
from mechsym.periodic import even_angles
from mechsym.periodic.pieces import PPoly
from mechsym.periodic.roots import minimum, root
from mechsym.quantities import record
from mechsym.quantities.units import Array, Inertia, Joule, NewtonMetre, Pure, Radian, RadPerSecond, Scalar
from mechsym.simulate.speed import Speed

_TURN = 2 * math.pi
_FADES = 600.0  # exponents up to which no power overflows [-]


@record
class Balance:
    """The torque that a hinge shall give, and what it leaves."""

    kind: str
    omega: float  #: Crank speed that it is for [rad/s]
    period: float  #: Period of the torque that the hinge gives [rad]
    #: That torque [N*m] and its integral from phi = 0 [J]
    torque: PPoly
    work: PPoly
    rest: PPoly  #: Torque that is left over [N*m]
    rest_swing: float  #: Largest minus smallest work of the rest [J]
    #: Speed ripple that the rest leaves; None if the crank would stop [-]
    ripple_constant_load: float | None
    ripple_propeller_load: float | None


# the springs of a sweep share one torque
@functools.lru_cache(maxsize=8)
def balance(hinge: Hinge, kind: str) -> Balance:
    """The part that the hinge takes of the torque that keeps the speed constant, the rest and its ripple."""
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


def turn_mean(torque: PPoly) -> PPoly:
    r"""Part of a torque that repeats every turn.

    .. math:: \bar M(\varphi) = \frac1k \sum_{i=0}^{k-1} M(\varphi + 2 \pi i)

    torque: torque over k whole turns [N*m]. Returns mean: torque of period 2 pi [N*m].
    """
    turns = round(torque.x[-1] / _TURN)
    shifts = _TURN * np.arange(turns)[:, None]
    return periodic.fit(lambda phi: torque(phi + shifts).mean(axis=0), torque.x, _TURN, tol=1e-11)


def _rest(torque: PPoly, part: PPoly) -> PPoly:
    if part is torque:
        return PPoly(np.zeros_like(torque.c), torque.x, extrapolate="periodic")
    breaks = np.concatenate([torque.x, part.x, part.x + _TURN])
    return periodic.fit(lambda phi: torque(phi) - part(phi), breaks, torque.x[-1], tol=1e-9)


def constant_load_speed(
    missing: Joule[Array], inertia: Inertia[Array], omega: RadPerSecond
) -> RadPerSecond[Array] | None:
    """Crank speed around a period at constant load, for a given mean speed.

    missing: work that is wanted and missing; inertia: reduced inertia; omega: mean speed in time.

    Returns phid: speed; None if no motion with that mean speed exists: the crank would stop, shape (n,).
    Neutrally stable: a run that starts elsewhere keeps another c and another ripple.
    """

    def phid(c: float) -> np.ndarray:
        return np.sqrt(omega**2 + 2 * (c - missing) / inertia)

    def excess(c: float) -> float:
        return mean_speed(phid(c)) - omega

    swing, energy = float(np.ptp(missing)), float(inertia.max()) * omega**2 / 2
    if swing <= 1e-12 * energy:
        return np.full_like(missing, omega)
    # above the rounding of the energy, so that no square is negative
    slowest = float(np.max(missing - inertia * omega**2 / 2)) + max(1e-9 * swing, 1e-14 * energy)
    if excess(slowest) > 0:
        return None
    return phid(root(excess, slowest, float(missing.max()) + energy, xtol=1e-12 * energy))


def propeller_load_speed(
    missing: Joule[Array], inertia: Inertia[Array], omega: RadPerSecond, load_torque: NewtonMetre, period: Radian
) -> RadPerSecond[Array] | None:
    r"""Crank speed around a period when the load grows with the square of the speed.

    .. math:: E = g - w, \qquad g' = a\,(w - g), \qquad a = \frac{2 M_r}{I \omega^2}

    missing: work w that is wanted and missing. inertia: reduced inertia I. omega: speed at which the load takes the
    load torque. load_torque: M_r; where it is not positive a steady torque holds the machine in its place, see
    `settle`. Returns phid: speed of the periodic motion, to which every run settles; None if the crank would stop.
    """
    if load_torque <= 0:
        return constant_load_speed(missing, inertia, omega)
    squares = propeller_load_squares(missing, inertia, omega, load_torque, period)
    return None if squares.min() <= 0 else np.sqrt(squares)


def propeller_load_squares(
    missing: Joule[Array], inertia: Inertia[Array], omega: Scalar, load_torque: Scalar, period: Radian
) -> np.ndarray:
    """Squares of that speed [rad^2/s^2], not positive where the crank would stop, of one motion or of many in rows.

    missing, inertia: shape (..., n); omega [rad/s], load_torque [N*m]: numbers, or of shape (..., 1).
    """
    rate = 2 * load_torque / (inertia * omega**2)
    step = period / missing.shape[-1] * (rate + np.roll(rate, -1, axis=-1)) / 2
    # over one step g relaxes towards the mean of w; -expm1 keeps the digits of short steps
    gain = -np.expm1(-step) * (missing + np.roll(missing, -1, axis=-1)) / 2
    whole, forced = np.zeros((2, *missing.shape[:-1], missing.shape[-1] + 1))
    np.cumsum(step, axis=-1, out=whole[..., 1:])
    if whole.max() < _FADES:
        np.cumsum(np.exp(whole[..., 1:]) * gain, axis=-1, out=forced[..., 1:])
        forced *= np.exp(-whole)
    else:
        decay = np.exp(-step)
        for i in range(missing.shape[-1]):
            forced[..., i + 1] = decay[..., i] * forced[..., i] + gain[..., i]
    g = forced[..., :-1] + np.exp(-whole[..., :-1]) * forced[..., -1:] / -np.expm1(-whole[..., -1:])
    return np.asarray(omega**2 + 2 * (g - missing) / inertia)


def mean_speed(phid: RadPerSecond[Array]) -> RadPerSecond:
    """Mean in time of a speed, not negative, given over even angles: angle over time of a period."""
    # a crank that stands at one angle takes for ever
    return 1 / float(np.mean(1 / phid)) if phid.min() > 0 else 0.0


def ripple(phid: RadPerSecond[Array] | None) -> Pure | None:
    """Speed ripple of a closed form, which knows the speed at its angles only; see `mechsym.simulate.speed.Speed`.

    phid: speed over even angles; None for a crank that stops.
    """
    if phid is None or phid.min() <= 0:
        return None
    return Speed(mean=mean_speed(phid), min=float(phid.min()), max=float(phid.max())).ripple


STOPPED = 10.0  #: Stands for the ripple of a shaft that stops: more than that of any that turns


def or_stopped(ripple: Pure | None, beyond: Pure = 0.0) -> Pure:
    """A ripple to compare with others; of a shaft that stops the more, the more work it misses `beyond` what it has."""
    return STOPPED + beyond if ripple is None else ripple


_LOOKS = 17  # where a search has seen nothing but stops


def least_ripple(ripple: Callable[[Pure], Pure | None], low: Pure, high: Pure) -> tuple[Pure, Pure | None]:
    """Share between two at which the shaft turns most evenly, and its ripple there; None where it stops everywhere."""

    def size(share: float) -> float:
        return or_stopped(ripple(share))

    best, least = minimum(size, low, high, 1e-4)
    if least >= STOPPED:
        shares = np.linspace(low, high, _LOOKS).tolist()
        near, step = min(shares, key=size), shares[1] - shares[0]
        best, least = minimum(size, max(low, near - step), min(high, near + step), 1e-4)
    return best, least if least < STOPPED else None
