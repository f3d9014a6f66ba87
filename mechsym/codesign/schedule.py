"""Pressure of the spring over speed and load, and the ripple that it keeps.

The wanted work is affine in omega^2 at a given load: a few loads are enough for a whole map.
"""

from collections.abc import Callable, Sequence

import numpy as np
import scipy

from mechsym.codesign.points import Point
from mechsym.codesign.running import added_inertia
from mechsym.codesign.task import CoDesign
from mechsym.errors import BadInput
from mechsym.hinge.springs.face import affine_energy
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pascal, RadPerSecond

_ANGLES = 180
_GOLDEN = (5**0.5 - 1) / 2
_STEPS = 30  # of the golden section
_FAR = (0.4, 2.5)  # pressures that are tried, by the ratio of the works
_STOPPED = 2.0


@record
class RippleMap:
    """The best pressure of one spring over speed and load."""

    omega: np.ndarray  #: shape (m,) [rad/s]
    load: np.ndarray  #: mean indicated pressure, shape (n,) [Pa]
    p0: np.ndarray  #: shape (m, n) [Pa]
    ripple: np.ndarray  #: shape (m, n); 2 where the shaft stops [-]


def ripple_map(found: CoDesign, loads: Sequence[Point], omega: RadPerSecond[Array], load: Pascal[Array]) -> RippleMap:
    """Ripple and pressure of a design with one spring under propeller load, for all pairs of speed and load.

    loads: the machine at ascending loads, at any speed; omega: speeds, shape (m,); load: mean indicated pressures,
    within those of the points.
    """
    if len(found.tracks) != 1:
        raise BadInput("the map is that of one spring; a design with several has a schedule for its points")
    (track,), period = found.tracks, loads[0].period
    phi = np.arange(_ANGLES) * period / _ANGLES
    inertia = loads[0].inertia(phi)
    gas = scipy.interpolate.PchipInterpolator([p.load for p in loads],
                            [p.work(phi) - p.omega**2 / 2 * p.inertia(phi) for p in loads])(load)  # fmt: skip
    torque = scipy.interpolate.PchipInterpolator([p.load for p in loads], [p.load_torque for p in loads])(load)
    rollers = added_inertia(track, phi)
    total = inertia + rollers + found.flywheel
    square = omega[:, None, None] ** 2
    wanted = (gas[None] + square / 2 * (inertia + rollers)).reshape(-1, _ANGLES)
    fixed, by_p0 = affine_energy(track.hardware.spring, track.z(phi))
    speeds, torques = np.repeat(omega, load.size), np.tile(torque, omega.size)
    guess = np.ptp(wanted, axis=1) / np.ptp(by_p0)

    def ripple(p0: np.ndarray) -> np.ndarray:
        return _ripples(wanted + fixed + p0[:, None] * by_p0, total, speeds, torques, period)

    p0 = _golden(ripple, _FAR[0] * guess, _FAR[1] * guess)
    shape = (omega.size, load.size)
    return RippleMap(omega=omega, load=load, p0=p0.reshape(shape), ripple=ripple(p0).reshape(shape))


def _ripples(
    missing: np.ndarray, inertia: np.ndarray, omega: np.ndarray, torque: np.ndarray, period: float
) -> np.ndarray:
    """Ripple of many motions at once under propeller load; the closed form of `mechsym.hinge.ripple`, row by row."""
    count = missing.shape[1]
    rate = 2 * torque[:, None] / (inertia * omega[:, None] ** 2)
    step = period / count * (rate + np.roll(rate, -1, axis=1)) / 2
    decay, gain = np.exp(-step), -np.expm1(-step) * (missing + np.roll(missing, -1, axis=1)) / 2
    g, forced = np.zeros(missing.shape[0]), np.empty_like(missing)
    for i in range(count):
        forced[:, i] = g
        g = decay[:, i] * g + gain[:, i]
    faded = np.exp(-np.cumsum(step, axis=1) + step)
    g0 = g / -np.expm1(-step.sum(axis=1))
    squares = 1 + 2 * (forced + faded * g0[:, None] - missing) / (inertia * omega[:, None] ** 2)
    u = np.sqrt(np.maximum(squares, 1e-12))
    lowest, weak = squares.min(axis=1), np.ptp(u, axis=1) * np.mean(1 / u, axis=1)
    return np.where(lowest <= 0, _STOPPED - lowest, weak)


def _golden(function: Callable[[np.ndarray], np.ndarray], low: np.ndarray, high: np.ndarray) -> np.ndarray:
    """Where many functions of one number each are smallest."""
    a, b = low.copy(), high.copy()
    c, d = b - _GOLDEN * (b - a), a + _GOLDEN * (b - a)
    fc, fd = function(c), function(d)
    for _ in range(_STEPS):
        left = fc < fd
        a, b = np.where(left, a, c), np.where(left, d, b)
        c, d = np.where(left, b - _GOLDEN * (b - a), d), np.where(left, c, a + _GOLDEN * (b - a))
        fc, fd = np.where(left, function(c), fd), np.where(left, fc, function(d))
    return (a + b) / 2
