"""One turn of the guide in numbers: path, spring, contact and torque at many angles."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mechsym import periodic
from mechsym.hinge import rollers
from mechsym.hinge.bounds.face import Station
from mechsym.hinge.choices import ROLLERS, GuideParameters
from mechsym.hinge.guide import Guide, path, warmth
from mechsym.hinge.rollers import RollerParameters
from mechsym.hinge.springs.face import Spring
from mechsym.quantities import record
from mechsym.quantities.units import Array, Metre, Pure, Radian, RadPerSecond


@record
class Contact:
    """Arrays of shape (n,) over one period of the track."""

    #: Angle of the guide's shaft and of the crank [rad]
    theta: np.ndarray
    phi: np.ndarray
    #: Path of the roller centres [m], [m/rad], [m/rad^2]
    rho: np.ndarray
    drho: np.ndarray
    d2rho: np.ndarray
    #: Closing [m] and force [N] of the spring
    z: np.ndarray
    force: np.ndarray
    pressure: np.ndarray | None  #: Excess pressure in the spring [Pa]; None without gas
    pressure_angle: np.ndarray  #: Of the path [rad]
    curvature: np.ndarray  #: [1/m]
    #: Contact forces N1 and N2; the second is on the spring seat for `one_roller` [N]
    reaction_1: np.ndarray
    reaction_2: np.ndarray
    hertz_stress: np.ndarray  #: Contact pressure [Pa]
    tilting_couple: np.ndarray  #: Of tracks in offset planes, 0 for other arrangements [N*m]
    #: Radial force for each kilogram that moves with a roller; in the contact forces only with `moving_mass` [N/kg]
    inertia_force: np.ndarray
    #: On the guide's shaft: driving, and lost to rolling resistance of all rollers [N*m]
    torque: np.ndarray
    loss_torque: np.ndarray
    station: Station  #: The same, as limits ask it


def at_angles(guide: Guide, parameters: RollerParameters, theta: Radian[Array]) -> Contact:
    """The turn at given angles, for tables and plots. theta: angles of the guide's shaft."""
    rho = path(guide)
    values = [rho(theta), rho.derivative()(theta), rho.derivative(2)(theta)]
    return _contact(guide, parameters, np.asarray(theta, dtype=float), values)


def at_pieces(guide: Guide, parameters: RollerParameters) -> Contact:
    """The turn at points dense enough for extremes; each kink appears twice, with the values of both its sides.

    Returns contact: arrays of shape (n,), angles not decreasing.
    """
    rho = path(guide)
    theta = periodic.piece_points(rho, 65)
    values = [periodic.piece_values(p, theta).ravel() for p in (rho, rho.derivative(), rho.derivative(2))]
    return _contact(guide, parameters, theta.ravel(), values)


def station_of(
    spring: Spring, choices: GuideParameters, rollers: RollerParameters, omega: RadPerSecond,
    values: Sequence[Metre[Array]], warm: Pure[Array] | None = None,
) -> Station:  # fmt: skip
    """A guide at angles of its track. omega: of the crank. values: path and derivatives. warm: state of the gas."""
    count = ROLLERS[choices.arrangement]
    rho, drho, d2rho = values
    z = count * (choices.rho0 - rho)
    return Station(
        spring=spring, rollers=rollers, count=count, rho0=choices.rho0, omega=omega * choices.shaft_ratio,
        rho=rho, drho=drho, d2rho=d2rho, z=z, force=spring.force(z, warm), warm=warm,
    )  # fmt: skip


def end_stations(along: Station, extremes: Metre[Array]) -> Station:
    """Both ends of the path by its largest and smallest radius; a gas with a state has no force of its closing."""
    z, spring = along.count * (along.rho0 - extremes), along.spring
    force = None if spring.state else spring.force(z)
    return replace(along, rho=extremes, drho=0.0, d2rho=0.0, z=z, force=force, warm=None)


def _contact(guide: Guide, parameters: RollerParameters, theta: np.ndarray, values: Sequence[np.ndarray]) -> Contact:
    rho, drho, d2rho = values
    chosen = guide.parameters
    warm = warmth(guide)(theta) if guide.spring.state else None
    at = station_of(guide.spring, chosen, parameters, guide.omega, values, warm)
    offset = parameters.plane_offset if chosen.arrangement == "two_tracks" else 0.0
    return Contact(
        theta=theta,
        phi=theta / chosen.shaft_ratio,
        rho=rho,
        drho=drho,
        d2rho=d2rho,
        z=at.z,
        force=at.force,
        pressure=at.pressure,
        pressure_angle=at.pressure_angle,
        curvature=at.curvature,
        reaction_1=at.reaction,
        reaction_2=at.force if guide.rollers == 1 else at.reaction,
        hertz_stress=at.hertz_stress,
        tilting_couple=rollers.tilting_couple(at.reaction, offset),
        inertia_force=rollers.inertia_force(rho, d2rho, at.omega),
        torque=guide.rollers * at.force * drho,
        loss_torque=guide.rollers * rollers.loss_torque(at.reaction, rho, drho, parameters),
        station=at,
    )
