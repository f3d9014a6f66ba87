r"""The guide of an elastic hinge: the path rho(theta) of the roller centres that makes a spring give the wanted torque.

         ___ track ___
       /     _____     \         theta = shaft_ratio * phi: angle of the guide's shaft
      |   .-       -.   |        rho:   shaft axis to roller centre
      |(o)==[spring]==(o)        z:     closing of the spring, z = c (rho0 - rho), c rollers move it
      |   `-_______-'   |        F:     spring force, outwards on each roller
       \ ____     ____ /
             -----

The spring gives the work that the torque takes: U(z) = const - W(phi), so z follows from W alone, and

.. math:: M_\theta = c\,F(z)\,\frac{d\rho}{d\theta} = \frac{M_h}{\text{shaft ratio}}

Source: Zotov et al. (2024), eqs. (9) to (14), for `two_tracks` with the start `as_printed`; the names are explained in
`mechsym.hinge.choices`.

A guide as a function of its spring setting: the pressure p0 of an air spring, the preload F0 of a coil. All laws are
affine in the setting s, so the torque and the work of a guide that stays as it was cut are too:

.. math:: M_h^*(\varphi; s) = M_0 + s\,M_1, \qquad W^*(\varphi; s) = W_0 + s\,W_1

Source: Zotov et al. (2024), eqs. (12) to (14), where M_0 = 0 for the gauge law.
"""

import dataclasses
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import GuideParameters, refuse_open_track
from mechsym.hinge.springs.face import GasTurn, Spring
from mechsym.hinge.torque import Hinge
from mechsym.machine.loads import settle
from mechsym.machine.record import AngleForce, Machine
from mechsym.mechanisms.shaft import with_torque
from mechsym.periodic import even_angles
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.display import quantity_text
from mechsym.quantities.units import Array, Joule, Metre, NewtonMetre, Radian

_POINTS = 1440  # angles of a period at which a gas with a state is followed


@record
class Guide:
    """A guide, or the reason why there is none."""

    parameters: GuideParameters
    spring: Spring  #: Spring in it: the one it was cut for, or another (see `refit`)
    omega: float  #: Crank speed that it was made for [rad/s]
    status: str  #: `cut`, or why not, see `TrackPath`
    reason: str
    rho: PPoly | None  #: Path over the angle theta of the guide's shaft [m]; None unless cut
    closure: float  #: Gap of the path after a period, before it is closed [m]

    @property
    def rollers(self) -> int:
        """Rollers c that move the spring."""
        return self.parameters.rollers


def cut(wanted: Hinge | Balance, spring: Spring, parameters: GuideParameters) -> Guide:
    """Guide that makes a spring give a torque, as the spring says, see `Spring.path`.

    wanted: torque to give with its work: all of it, or the part that was chosen. Returns guide: the path, or status and
    reason. Raises BadInput: the track would not close after a turn of its shaft, or z_margin leaves no spring. Valid:
    massless rollers and spring, no friction.
    """
    refuse_open_track(parameters, wanted.period)
    if parameters.z_margin >= spring.H:
        raise BadInput(f"guide.z_margin = {parameters.z_margin:g} m is not below spring.H = {spring.H:g} m")
    track = spring.path(wanted, parameters)
    return Guide(
        parameters=parameters,
        spring=spring,
        omega=wanted.omega,
        status=track.status,
        reason=track.reason,
        rho=track.rho,
        closure=track.closure,
    )


def refit(guide: Guide, spring: Spring) -> Guide:
    """The same track with another spring in it, or the same one set anew; what it was cut for stays in `omega`."""
    return replace(guide, spring=spring)


def path(guide: Guide) -> PPoly:
    """The path over the angle of the guide's shaft [m]. Raises BadInput: there is none; the message says why."""
    if guide.rho is None:
        raise BadInput(f"there is no guide: {guide.reason}")
    return guide.rho


def closing(guide: Guide, rho: Metre[Array]) -> Metre[Array]:
    r"""Closing of the spring.

    .. math:: z = c\,(\rho_0 - \rho)

    rho: distance of the roller centres.
    """
    return guide.rollers * (guide.parameters.rho0 - rho)


def spring_state(guide: Guide, theta: Radian[Array], z: Metre[Array]) -> tuple[np.ndarray, np.ndarray | None]:
    """Force of the spring on each roller [N] and excess pressure in it [Pa]; a gas with a state runs steadily.

    theta: angle of the guide's shaft, which a spring whose closing says all does not ask for; z: closing.
    """
    warm = warmth(guide)(theta) if guide.spring.state else None
    return guide.spring.force(z, warm), guide.spring.pressure(z, warm)


def gas_turn(guide: Guide) -> GasTurn:
    """Steady turn of a gas with a state at the speed of its guide, at even angles of a period."""
    rho = path(guide)
    period = float(rho.x[-1] - rho.x[0])
    theta = rho.x[0] + np.arange(_POINTS) * period / _POINTS
    omega = guide.omega * guide.parameters.shaft_ratio
    return guide.spring.turn(closing(guide, rho(theta)), np.full(_POINTS, period / _POINTS), omega)


def warmth(guide: Guide) -> PPoly:
    """Its temperature by the wall's [-] over the angle of the guide's shaft."""
    rho, turn = path(guide), gas_turn(guide)
    values = np.append(turn.warmth, turn.warmth[0])
    return PPoly.spline(np.linspace(rho.x[0], rho.x[-1], _POINTS + 1), values, periodic=True)


def kept_torque(guide: Guide) -> float:
    """Mean torque on the crank that a gas keeps as heat, 0 for springs that give all back [N*m]."""
    if not guide.spring.state or guide.rho is None:
        return 0.0
    period = float(guide.rho.x[-1] - guide.rho.x[0])
    return guide.parameters.shaft_ratio * gas_turn(guide).loss / period


def crank_torque(guide: Guide, phi: Radian[Array]) -> NewtonMetre[Array]:
    r"""Torque of a guide on the crank by virtual work, with the spring that is in it.

    .. math:: M_h^* = \text{shaft ratio}\; c\, F(z)\, \frac{d\rho}{d\theta}

    Returns torque: on the crank, positive driving.
    Source: Zotov et al. (2024), eqs. (12) to (14). For the gauge law it is proportional to p0, for the others not.
    """
    rho, ratio = path(guide), guide.parameters.shaft_ratio
    theta = ratio * np.asarray(phi, dtype=float)
    force, _ = spring_state(guide, theta, closing(guide, rho(theta)))
    return ratio * guide.rollers * force * rho.derivative()(theta)


def torque_function(guide: Guide) -> Callable[[float], float]:
    """The same torque as a fast function of one float, for time simulations.

    Returns torque: crank angle, any real number [rad], to torque on the crank [N*m]; about 1.5 microseconds.
    """
    point, force = periodic.scalar(path(guide)), guide.spring.force
    c, rho0, ratio = guide.rollers, guide.parameters.rho0, guide.parameters.shaft_ratio
    if guide.spring.state:
        warm = periodic.scalar(warmth(guide))

        def warm_torque(phi: float) -> float:
            rho, slope = point(ratio * phi)
            return float(ratio * c * force(c * (rho0 - rho), warm(ratio * phi)[0]) * slope)

        return warm_torque

    def torque(phi: float) -> float:
        rho, slope = point(ratio * phi)
        return ratio * c * force(c * (rho0 - rho)) * slope

    return torque


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
    """Torque and work of a guide over a period as functions of its setting, beside what a speed needs."""
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
            # work of a torque at even angles [J], less the share of what the gas keeps: the load is lowered by that
            torque = torques[-1]
            swing = (torque - torque.mean()) * hinge.period / torque.size
            works.append(np.cumsum(swing) - (swing + swing[0]) / 2)
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


def missing_work(parts: Affine, setting: float) -> Joule[Array]:
    """Work that is wanted and missing. setting: p0 [Pa], or F0 of a coil [N]. Returns work: from phi = 0."""
    return parts.work_wanted - parts.work_0 - setting * parts.work_1


def work_swing(parts: Affine, setting: float) -> Joule:
    """Largest minus smallest missing work, convex in the setting: p0 [Pa], or F0 of a coil [N]."""
    return float(np.ptp(missing_work(parts, setting)))


def fitted(machine: Machine, wanted: Hinge, guide: Guide | None = None, lost: NewtonMetre = 0.0) -> Machine:
    """The machine ready to run, with or without hinge.

    wanted: gives the mean torque for a load law without numbers. guide: guide that could be cut, with the spring that
    works in it; none leaves the machine without hinge. lost: mean torque that friction of the hinge takes from such a
    load.
    """
    if guide is None:
        return replace(machine, load=settle(machine.load, wanted.load_torque, machine.omega))
    # a gas with a state runs at the speed of the machine, whatever the guide was cut for
    guide = replace(guide, omega=machine.omega)
    load = settle(machine.load, wanted.load_torque - kept_torque(guide) - lost, machine.omega)
    hinge = AngleForce(
        name="hinge",
        input="M_h",
        role="store",
        value=lambda phi: crank_torque(guide, phi),
        point=torque_function(guide),
    )
    place = with_torque(machine.mechanism, hinge.input)
    return replace(machine, mechanism=place, load=load, forces=(*machine.forces, hinge))
