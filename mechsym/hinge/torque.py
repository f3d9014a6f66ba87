r"""The elastic hinge: the torque that keeps a crank turning at constant speed.

    frame ==[ hinge: M_h(phi) ]== crank --- engine: I(phi), F dx/dphi, gravity --- load: M_r

phi = 0 at (firing) top dead centre, positive in the sense of rotation. M_h > 0 drives the crank, M_r opposes it. The
motion of one degree of freedom is

.. math:: I \ddot\varphi + \tfrac12 I' \dot\varphi^2 = F x' - M_r + M_h + M_g

with M_g the generalised force of gravity; a constant speed omega asks for the M_h that `torque` returns. A spring can
give that torque only if it takes as much work as it gives: the mean of M_h over a period must vanish.

Source: Zotov et al. (2024), eqs. (3) to (8). `papers/zotov2024/hinge_printed.py` has equation (8) as printed.
"""

import functools
import math
from collections.abc import Callable, Sequence

import numpy as np
import scipy

from mechsym import periodic
from mechsym.cycle.gas import Gas
from mechsym.machine.record import Machine, gas_of
from mechsym.mechanisms.record import Mechanism, curves, evaluate
from mechsym.quantities import record

_MEAN_TOLERANCE = 1e-9  # of the peak torque; what rounding leaves is far below

Function = Callable[[np.ndarray], np.ndarray]


@record
class EngineTorques:
    """What the hinge has to balance, as functions of the crank angle."""

    #: phi of shape (n,) [rad] to reduced inertia [kg*m^2] and its derivative [kg*m^2/rad]
    inertia: Function
    dinertia_dphi: Function
    gas_torque: Function  #: phi to F dx/dphi, F positive away from the head [N*m]
    gravity_torque: Function  #: phi to the generalised force of gravity M_g [N*m]
    kinks: Sequence[float]  #: Angles where a function is not smooth [rad]
    period: float  #: 2 pi for a two-stroke, 4 pi for a four-stroke cycle [rad]


@record
class Hinge:
    """The hinge torque and its parts; the piecewise polynomials take any crank angle [rad]."""

    #: Crank speed [rad/s] and period of the torque [rad]
    omega: float
    period: float
    load_torque: float  #: Constant torque M_r that the engine can drive, the mean of F dx/dphi [N*m]
    torque: "scipy.interpolate.PPoly"  #: M_h, the sum of the three parts [N*m]
    #: omega^2 I'/2, M_r - F x' and -M_g [N*m]
    inertia_part: "scipy.interpolate.PPoly"
    gas_part: "scipy.interpolate.PPoly"
    gravity_part: "scipy.interpolate.PPoly"
    inertia: "scipy.interpolate.PPoly"  #: I [kg*m^2]
    work: "scipy.interpolate.PPoly"  #: W, integral of M_h from phi = 0 [J]
    mean_torque: float  #: Mean of M_h over a period [N*m]
    exists: bool  #: The mean is zero within 1e-9 of the peak, so that a spring can give the torque
    torque_min: float  #: Signed extremes [N*m], [J]
    torque_max: float  #: Signed extremes [N*m], [J]
    work_min: float  #: Signed extremes [N*m], [J]
    work_max: float  #: Signed extremes [N*m], [J]


def engine_torques(machine: Machine) -> EngineTorques:
    """What the gas, the inertia and the weights of a machine ask of its hinge."""
    return _torques(machine.mechanism, gas_of(machine))


@functools.lru_cache(maxsize=8)
def _torques(mechanism: Mechanism, gas: Gas) -> EngineTorques:
    (q,) = mechanism.coordinates

    def gravity_torque(phi: np.ndarray) -> np.ndarray:
        # at rest and without inputs gravity is the only generalised force
        return evaluate(mechanism, "dynamics", **{q: phi})["generalized_force"]

    return EngineTorques(
        inertia=lambda phi: curves(mechanism, phi)["inertia"],
        dinertia_dphi=lambda phi: curves(mechanism, phi)[f"dinertia_d{q}"],
        gas_torque=lambda phi: gas.force(phi) * curves(mechanism, phi)[f"dx_d{q}"],
        gravity_torque=gravity_torque,
        kinks=gas.pressure.kinks,
        period=gas.pressure.period,
    )


def torque(machine: Machine, tol: float = 1e-12) -> Hinge:
    r"""Hinge torque that keeps the crank speed constant, with its parts and its work.

    .. math:: M_h = \tfrac12 \omega^2 I'(\varphi) - F x'(\varphi) + M_r - M_g(\varphi), \qquad
              M_r = \frac1T \int_0^T F x' d\varphi, \qquad W(\varphi) = \int_0^\varphi M_h\,d\varphi

    Parameters
    ----------
    machine : Machine
        Engine with gas, one coordinate, and its speed of operation
    tol : float
        Error of the piecewise polynomials, as a share of the largest part [-]

    Returns
    -------
    hinge : Hinge
        Torque, parts, work, existence and extremes

    Notes
    -----
    Source: Zotov et al. (2024), eqs. (4), (5) and (8), with the exact kinematics. Valid: rigid links, one degree of
    freedom, constant speed. The mean of M_h is not set to zero: it is what quadrature leaves, and it is checked.
    """
    return hinge_of(engine_torques(machine), machine.omega, tol)


# the springs of a sweep share one engine, and so its hinge torque
@functools.lru_cache(maxsize=8)
def hinge_of(torques: EngineTorques, omega: float, tol: float = 1e-12) -> Hinge:
    """The same from what has to be balanced, wherever that comes from.

    Parameters
    ----------
    omega : float
        Crank speed [rad/s]
    tol : float
        Error of the piecewise polynomials, as a share of the largest part [-]
    """
    parts = periodic.fit(
        lambda phi: np.stack(
            [omega**2 / 2 * torques.dinertia_dphi(phi), -torques.gas_torque(phi), -torques.gravity_torque(phi)]
        ),
        torques.kinks,
        torques.period,
        tol,
    )
    inertia_part, gas_part, gravity_part = (_part(parts, i) for i in range(3))
    load_torque = -periodic.mean(gas_part)
    gas_part.c[-1] += load_torque
    total = scipy.interpolate.PPoly(inertia_part.c + gas_part.c + gravity_part.c, parts.x, extrapolate="periodic")
    work = periodic.antiderivative(total)
    low, _, high, _ = periodic.extremes(total)
    work_low, _, work_high, _ = periodic.extremes(work)
    return Hinge(
        omega=omega,
        period=torques.period,
        load_torque=load_torque,
        torque=total,
        inertia_part=inertia_part,
        gas_part=gas_part,
        gravity_part=gravity_part,
        inertia=periodic.fit(torques.inertia, torques.kinks, torques.period, tol),
        work=work,
        mean_torque=periodic.mean(total),
        exists=exists(total),
        torque_min=low,
        torque_max=high,
        work_min=work_low,
        work_max=work_high,
    )


def exists(torque: "scipy.interpolate.PPoly") -> bool:
    """Whether a spring can give a torque: its work over a period vanishes.

    Parameters
    ----------
    torque : PPoly
        Periodic torque [N*m]

    Returns
    -------
    exists : bool
        The mean is below 1e-9 of the peak
    """
    low, _, high, _ = periodic.extremes(torque)
    return abs(periodic.mean(torque)) <= _MEAN_TOLERANCE * max(abs(low), abs(high))


def harmonics(torque: "scipy.interpolate.PPoly", count: int = 24) -> tuple[np.ndarray, np.ndarray]:
    """Amplitudes of a torque by order of the crank speed.

    Parameters
    ----------
    torque : PPoly
        Periodic torque, period 2 pi or 4 pi [N*m]
    count : int
        Number of harmonics of the period

    Returns
    -------
    orders, amplitudes : ndarray, shape (count,)
        Orders [-] (1 is once a turn) and amplitudes [N*m]
    """
    n = 4096
    period = torque.x[-1]
    amplitudes = np.abs(np.fft.rfft(torque(np.arange(n) * period / n))) * 2 / n
    return np.arange(1, count + 1) * (2 * math.pi / period), amplitudes[1 : count + 1]


def odd_share(torque: "scipy.interpolate.PPoly") -> float:
    """Share of the root mean square in odd orders of the period; a track of half that period cannot give it.

    Parameters
    ----------
    torque : PPoly
        Periodic torque of zero mean [N*m]

    Returns
    -------
    share : float
        Between 0 and 1 [-]
    """
    phi = np.arange(4096) * torque.x[-1] / 4096
    odd = (torque(phi) - torque(phi + torque.x[-1] / 2)) / 2
    return float(np.sqrt(np.mean(odd**2) / np.mean(torque(phi) ** 2)))


def _part(parts: "scipy.interpolate.PPoly", i: int) -> "scipy.interpolate.PPoly":
    return scipy.interpolate.PPoly(parts.c[..., i].copy(), parts.x, extrapolate="periodic")
