"""Reactions of every mechanism under the names of its parts, as the roles of its declaration say.

Forces on the crank pin are those of the rod (planet, link) on the crank: radial positive outwards, tangential positive
in the sense of rotation. The side force is that of the guide on the piston or slider. Bearing forces are those on the
crank, in the frame; the same forces turned into the crank give the polar diagram of the pin.
"""

from collections.abc import Mapping

import numpy as np

from mechsym.forces.turn import Turn, main_roles
from mechsym.mechanisms.amounts import amount
from mechsym.quantities import record
from mechsym.quantities.units import Array, Newton, NewtonMetre, Pure


@record
class Pin:
    """A crank pin with what acts on it."""

    name: str  #: `crank_pin`, or `crank_pin_3` of a crank train
    angle: np.ndarray  #: shape (n,): Angle of its crank from the x axis of the frame [rad]
    radius: float  #: Crank radius [m]
    sense: float  #: Sense of rotation, 1 or -1 [-]
    #: shape (n,): Force on the crank pin, in the frame [N]
    x: np.ndarray
    y: np.ndarray


@record
class Loads:
    """The loads that bearings and guides carry."""

    pins: tuple[Pin, ...]
    bearings: Mapping[str, tuple[np.ndarray, np.ndarray]]  #: Main bearings by name: force on the crank in the frame [N]
    guides: Mapping[str, np.ndarray]  #: Side forces by name [N]
    weight_torque: np.ndarray  #: shape (n,): Torque of the crank's own weight [N*m]


def loads(turn: Turn) -> Loads:
    """The loads of a turn."""
    roles, R, letters = turn.drive.roles, turn.reactions, turn.drive.mechanism.parameters
    pins = []
    for role in roles.bearings:
        if role.throw is not None:
            x, y = (-R[name] for name in role.reactions)
            angle = role.sense * (turn.phi + role.phase)
            radius = float(amount(role.throw, letters))
            pins.append(Pin(name=role.name, angle=angle, radius=radius, sense=role.sense, x=x, y=y))
    none = np.zeros_like(turn.phi)
    known = {**letters, turn.drive.mechanism.coordinates[0]: turn.phi}
    mains = main_roles(turn)
    return Loads(
        pins=tuple(pins),
        bearings={role.name: (R[role.reactions[0]], R[role.reactions[1]]) for role in mains},
        guides={role.name: none if role.reaction is None else R[role.reaction] for role in roles.guides if role.at},
        weight_torque=sum((amount(rotor.weight, known) for rotor in roles.rotors), none),
    )


def pin_torque(loads: Loads) -> NewtonMetre[Array]:
    """Torque on the crank from the forces on its pins, together with that of the crank's weight."""
    return loads.weight_torque + sum(pin.radius * tangential(pin) for pin in loads.pins)


def radial(pin: Pin) -> Newton[Array]:
    """Force on a crank pin along its crank. Returns force: positive outwards."""
    return pin.x * np.cos(pin.angle) + pin.y * np.sin(pin.angle)


def tangential(pin: Pin) -> Newton[Array]:
    """Force on a crank pin across its crank. Returns force: positive in the sense of rotation."""
    return pin.sense * (pin.y * np.cos(pin.angle) - pin.x * np.sin(pin.angle))


def power_residual(turn: Turn, loads: Loads) -> Pure:
    """Largest gap between the power from the energies and that from the forces on the crank.

    Returns
    -------
    residual : float
        Relative to the largest power of gas or load; where the declaration names no crank pin, the gap to the power
        that the equations of motion ask for
    """
    size = max(np.abs(turn.gas_power).max(), np.abs(turn.torque * turn.omega).max())
    other = pin_torque(loads) if loads.pins else -turn.driving
    return float(np.abs(other - turn.torque).max() * turn.omega / size) if size > 0 else 0.0


def polar(loads: Loads) -> dict[str, tuple[Newton[Array], Newton[Array]]]:
    """Polar diagrams: loads on the pins in their cranks, on the main bearings in the frame.

    Returns
    -------
    curves : dict of str to (ndarray, ndarray)
        By name: along the crank and across it for a pin, x and y for a bearing; what the shaft presses with is the
        opposite of what it is pressed with
    """
    pins = {pin.name: (radial(pin), tangential(pin)) for pin in loads.pins}
    return pins | {name: (-x, -y) for name, (x, y) in loads.bearings.items()}


def roll_sense(turn: Turn) -> Pure:
    """Sense, 1 or -1, of the shaft end that carries the load: the flywheel stands behind the last throw."""
    mains = main_roles(turn)
    return mains[-1].sense if mains else 1.0
