"""One turn of the guide in numbers: path, spring, contact and torque at many angles."""

import dataclasses
from collections.abc import Sequence

import numpy as np

from mechsym import periodic
from mechsym.hinge import rollers
from mechsym.hinge.guide import Guide, closing, path, spring_state
from mechsym.hinge.rollers import RollerParameters
from mechsym.quantities import record


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


def at_angles(guide: Guide, parameters: RollerParameters, theta: np.ndarray) -> Contact:
    """The turn at given angles, for tables and plots.

    Parameters
    ----------
    theta : ndarray, shape (n,)
        Angles of the guide's shaft [rad]
    """
    rho = path(guide)
    values = [rho(theta), rho.derivative()(theta), rho.derivative(2)(theta)]
    return _contact(guide, parameters, np.asarray(theta, dtype=float), values)


def at_pieces(guide: Guide, parameters: RollerParameters) -> Contact:
    """The turn at points dense enough for extremes; each kink appears twice, with the values of both its sides.

    Returns
    -------
    contact : Contact
        Arrays of shape (n,), angles not decreasing
    """
    rho = path(guide)
    theta = periodic.piece_points(rho, 65)
    values = [periodic.piece_values(p, theta).ravel() for p in (rho, rho.derivative(), rho.derivative(2))]
    return _contact(guide, parameters, theta.ravel(), values)


def columns(contact: Contact) -> dict[str, np.ndarray]:
    """The turn as columns of a CSV file.

    Returns
    -------
    columns : dict of str to ndarray
        By field name; the pressure only of a gas spring
    """
    values = {field.name: getattr(contact, field.name) for field in dataclasses.fields(contact)}
    return {name: value for name, value in values.items() if value is not None}


def _contact(guide: Guide, parameters: RollerParameters, theta: np.ndarray, values: Sequence[np.ndarray]) -> Contact:
    rho, drho, d2rho = values
    chosen, z = guide.parameters, closing(guide, rho)
    force, pressure = spring_state(guide, theta, z)
    kappa = rollers.curvature(rho, drho, d2rho)
    inertia_force = rollers.inertia_force(rho, d2rho, guide.omega * chosen.shaft_ratio)
    # rollers that turn with the shaft are pressed outwards by their own mass too
    reaction = rollers.reaction(force + parameters.moving_mass * inertia_force, rho, drho)
    offset = parameters.plane_offset if chosen.arrangement == "two_tracks" else 0.0
    return Contact(
        theta=theta,
        phi=theta / chosen.shaft_ratio,
        rho=rho,
        drho=drho,
        d2rho=d2rho,
        z=z,
        force=force,
        pressure=pressure,
        pressure_angle=rollers.pressure_angle(rho, drho),
        curvature=kappa,
        reaction_1=reaction,
        reaction_2=force if guide.rollers == 1 else reaction,
        hertz_stress=rollers.hertz_stress(reaction, kappa, parameters),
        tilting_couple=rollers.tilting_couple(reaction, offset),
        inertia_force=inertia_force,
        torque=guide.rollers * force * drho,
        loss_torque=guide.rollers * rollers.loss_torque(reaction, rho, drho, parameters),
    )
