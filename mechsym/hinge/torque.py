r"""The elastic hinge: the torque that keeps a crank turning at constant speed.

    frame ==[ hinge: M_h(phi) ]== crank --- engine: I(phi), F dx/dphi, gravity --- load: M_r

phi = 0 at (firing) top dead centre, positive in the sense of rotation. M_h > 0 drives the crank, M_r opposes it. The
motion of one degree of freedom is

.. math:: I \ddot\varphi + \tfrac12 I' \dot\varphi^2 = F x' - M_r + M_h + M_g

with M_g the generalised force of gravity; a constant speed omega asks for the M_h that `torque` returns. A spring can
give that torque only if it takes as much work as it gives: the mean of M_h over a period must vanish.

Source: Zotov et al. (2024), eqs. (3) to (8). `papers/zotov2024/equations_printed.py` has equation (8) as printed.
"""

import dataclasses
import functools
from collections.abc import Callable, Sequence

import numpy as np

from mechsym import periodic
from mechsym.machine.loads import ConstantLoad
from mechsym.machine.record import Machine, kinks_of, period_of, shaft_torque
from mechsym.mechanisms.record import curves, evaluate
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.units import Pure, RadPerSecond

_MEAN_TOLERANCE = 1e-9  # of the peak torque; what rounding leaves is far below

Function = Callable[[np.ndarray], np.ndarray]


@record
class EngineTorques:
    """What the hinge has to balance, as functions of the crank angle."""

    #: phi of shape (n,) [rad] to reduced inertia [kg*m^2] and its derivative [kg*m^2/rad]
    inertia: Function
    dinertia_dphi: Function
    gas_torque: Function  #: phi to the sum of F dx/dphi, F positive away from the head, and drives [N*m]
    gravity_torque: Function  #: phi to the generalised force of gravity M_g [N*m]
    kinks: Sequence[float]  #: Angles where a function is not smooth [rad]
    period: float  #: 2 pi for a two-stroke, 4 pi for a four-stroke cycle [rad]


@record
class Hinge:
    """The hinge torque and its parts; the piecewise polynomials take any crank angle [rad]."""

    omega: float  #: Crank speed [rad/s]
    period: float  #: of the torque [rad]
    load_torque: float  #: Constant torque M_r that the engine can drive, the mean of F dx/dphi [N*m]
    torque: PPoly  #: M_h, the sum of the three parts [N*m]
    inertia_part: PPoly  #: omega^2 I'/2 [N*m]
    gas_part: PPoly  #: M_r - F x' [N*m]
    gravity_part: PPoly  #: -M_g [N*m]
    inertia: PPoly  #: I [kg*m^2]
    work: PPoly  #: W, integral of M_h from phi = 0 [J]
    mean_torque: float  #: Mean of M_h over a period [N*m]
    exists: bool  #: The mean is zero within 1e-9 of the peak, so that a spring can give the torque
    torque_min: float  #: Lowest M_h, with its sign [N*m]
    torque_max: float  #: Highest M_h [N*m]
    work_min: float  #: Lowest W, with its sign [J]
    work_max: float  #: Highest W [J]


def engine_torques(machine: Machine) -> EngineTorques:
    """What the gas, the inertia and the weights of a machine ask of its hinge."""
    # springs and loads are no part of it: what is tried with many of them is fitted once
    return _torques(dataclasses.replace(machine, load=ConstantLoad(), omega=0.0))


@functools.lru_cache(maxsize=8)
def _torques(machine: Machine) -> EngineTorques:
    mechanism = machine.mechanism
    (q,) = mechanism.coordinates

    def gravity_torque(phi: np.ndarray) -> np.ndarray:
        # at rest and without inputs weights and springs are the only generalised force
        own = evaluate(mechanism, "dynamics", **{q: phi})["generalized_force"]
        return np.asarray(own + shaft_torque(machine, "store", phi))

    return EngineTorques(
        inertia=lambda phi: curves(mechanism, phi)["inertia"],
        dinertia_dphi=lambda phi: curves(mechanism, phi)[f"dinertia_d{q}"],
        gas_torque=lambda phi: shaft_torque(machine, "drive", phi),
        gravity_torque=gravity_torque,
        kinks=kinks_of(machine),
        period=period_of(machine),
    )


def torque(machine: Machine, tol: Pure = 1e-12) -> Hinge:
    r"""Hinge torque that keeps the crank speed constant, with its parts and its work.

    .. math:: M_h = \tfrac12 \omega^2 I'(\varphi) - F x'(\varphi) + M_r - M_g(\varphi), \qquad
              M_r = \frac1T \int_0^T F x' d\varphi, \qquad W(\varphi) = \int_0^\varphi M_h\,d\varphi

    machine: engine with gas, one coordinate, and its speed of operation; tol: error of the piecewise polynomials, as a
    share of the largest part. Returns hinge: torque, parts, work, existence and extremes.
    Source: Zotov et al. (2024), eqs. (4), (5) and (8), with the exact kinematics. Valid: rigid links, one degree of
    freedom, constant speed. The mean of M_h is not set to zero: it is what quadrature leaves, and it is checked.
    """
    return hinge_of(engine_torques(machine), machine.omega, tol)


# the springs of a sweep share one engine, and so its hinge torque
@functools.lru_cache(maxsize=8)
def hinge_of(torques: EngineTorques, omega: RadPerSecond, tol: Pure = 1e-12) -> Hinge:
    """The same from what has to be balanced. tol: error of the piecewise polynomials by the largest part."""
    parts = periodic.fit(
        lambda phi: np.stack(
            [omega**2 / 2 * torques.dinertia_dphi(phi), -torques.gas_torque(phi), -torques.gravity_torque(phi)]
        ),
        torques.kinks,
        torques.period,
        tol,
    )
    inertia_part, gas_part, gravity_part = (
        PPoly(parts.c[..., i].copy(), parts.x, extrapolate="periodic") for i in range(3)
    )
    load_torque = -periodic.mean(gas_part)
    if abs(load_torque) <= tol * float(np.abs(parts.c[-1]).max()):  # what no gas drives has no load, only rounding
        load_torque = 0.0
    gas_part.c[-1] += load_torque
    total = PPoly(inertia_part.c + gas_part.c + gravity_part.c, parts.x, extrapolate="periodic")
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


def exists(torque: PPoly) -> bool:
    """Whether a spring can give a periodic torque [N*m]: its mean is below 1e-9 of the peak."""
    low, _, high, _ = periodic.extremes(torque)
    return abs(periodic.mean(torque)) <= _MEAN_TOLERANCE * max(abs(low), abs(high))
