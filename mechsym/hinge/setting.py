r"""A guide as a function of its spring setting: the pressure p0 of an air spring, the preload F0 of a coil.

All laws are affine in the setting s, so the torque and the work of a guide that stays as it was cut are too:

.. math:: M_h^*(\varphi; s) = M_0 + s\,M_1, \qquad W^*(\varphi; s) = W_0 + s\,W_1

Source: Zotov et al. (2024), eqs. (12) to (14), where M_0 = 0 for the gauge law.
"""

import dataclasses

import numpy as np

from mechsym.hinge.guide import Guide, closing, crank_torque, path, refit
from mechsym.hinge.springs.face import Spring
from mechsym.hinge.torque import Hinge
from mechsym.periodic import even_angles
from mechsym.quantities import record
from mechsym.quantities.display import quantity_text
from mechsym.quantities.units import Array, Joule


@record
class Affine:
    """Torque and work of a guide as offset + setting * slope, beside what is wanted; arrays over even crank angles."""

    omega: float  #: Wanted speed [rad/s]
    period: float  #: [rad]
    load_torque: float  #: [N*m]
    inertia: np.ndarray  #: shape (n,): Reduced inertia [kg*m^2]
    #: shape (n,): Hinge torque at that speed, and the guide's at setting 0 [N*m]
    torque_wanted: np.ndarray
    torque_0: np.ndarray
    torque_1: np.ndarray  #: shape (n,): Change of the guide's torque per unit of setting [N*m/Pa], of a coil [N*m/N]
    #: shape (n,): integrals of the torques from phi = 0 [J], of `torque_1` [J/Pa] or [J/N]
    work_wanted: np.ndarray
    work_0: np.ndarray
    work_1: np.ndarray


def setting_of(spring: Spring) -> float:
    """The value that retuning changes. Returns setting: p0 [Pa], or F0 of a coil [N]."""
    return float(getattr(spring, spring.setting[0]))


def setting_text(spring: Spring, setting: float) -> str:
    """A setting with its unit, for people, four digits. setting: p0 [Pa], or F0 of a coil [N]."""
    return quantity_text(setting, spring.setting[1], 4)


def with_setting(spring: Spring, setting: float) -> Spring:
    """The same spring with another setting. setting: p0 [Pa], or F0 of a coil [N]."""
    return dataclasses.replace(spring, **{spring.setting[0]: setting})


def affine(guide: Guide, hinge: Hinge) -> Affine:
    """Torque and work of a guide as functions of its spring setting, beside what a speed needs.

    Returns parts: arrays over one period of the hinge.
    """
    phi = even_angles(hinge.period)
    rho, ratio = path(guide), guide.parameters.shaft_ratio
    z = closing(guide, rho(ratio * np.append(phi, 0.0)))
    # two settings fix a straight line; the second is far enough from the first to lose no digits
    first = setting_of(guide.spring)
    second = 2 * first if first > 0 else float(guide.spring.force(guide.spring.H))
    torques, works = [], []
    for spring in (guide.spring, with_setting(guide.spring, second)):
        torques.append(crank_torque(refit(guide, spring), phi))
        if spring.state:
            works.append(_work(torques[-1], hinge.period))
        else:
            energy = spring.energy(z)
            works.append(energy[-1] - energy[:-1])
    torque_1, work_1 = ((values[1] - values[0]) / (second - first) for values in (torques, works))
    return Affine(
        omega=hinge.omega,
        period=hinge.period,
        load_torque=hinge.load_torque,
        inertia=hinge.inertia(phi),
        torque_wanted=hinge.torque(phi),
        torque_0=torques[0] - first * torque_1,
        torque_1=torque_1,
        work_wanted=hinge.work(phi),
        work_0=works[0] - first * work_1,
        work_1=work_1,
    )


def _work(torque: np.ndarray, period: float) -> np.ndarray:
    """Work of a torque at even angles [J], less the share of what the gas keeps: the load is lowered by that."""
    swing = (torque - torque.mean()) * period / torque.size
    return np.cumsum(swing) - (swing + swing[0]) / 2


def missing_work(parts: Affine, setting: float) -> Joule[Array]:
    """Work that is wanted and missing. setting: p0 [Pa], or F0 of a coil [N]. Returns work: from phi = 0."""
    return parts.work_wanted - parts.work_0 - setting * parts.work_1


def work_swing(parts: Affine, setting: float) -> Joule:
    """Largest minus smallest missing work.

    setting: p0 [Pa], or F0 of a coil [N]. Returns swing: convex in the setting.
    """
    return float(np.ptp(missing_work(parts, setting)))
