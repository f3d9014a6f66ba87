"""Reactions of every mechanism under common names, so that what follows need not know the mechanism.

Forces on the crank pin are those of the rod (planet, link) on the crank: radial positive outwards, tangential positive
in the sense of rotation. The side force is that of the guide on the piston or slider. Bearing forces are those on the
crank, in the frame; the same forces turned into the crank give the polar diagram of the pin.
"""

import numpy as np

from mechsym.forces.turn import Turn, chain_of
from mechsym.mechanisms.chain import Loads, Pin


def loads(turn: Turn) -> Loads:
    """The loads of a turn."""
    return chain_of(turn.drive).loads(turn)


def pin_torque(found: Loads) -> np.ndarray:
    """Torque on the crank from the forces on its pins.

    Returns
    -------
    torque : ndarray, shape (n,)
        Together with the torque of the crank's weight [N*m]
    """
    return found.weight_torque + sum(pin.radius * tangential(pin) for pin in found.pins)


def radial(pin: Pin) -> np.ndarray:
    """Force on a crank pin along its crank.

    Returns
    -------
    force : ndarray, shape (n,)
        Positive outwards [N]
    """
    return pin.x * np.cos(pin.angle) + pin.y * np.sin(pin.angle)


def tangential(pin: Pin) -> np.ndarray:
    """Force on a crank pin across its crank.

    Returns
    -------
    force : ndarray, shape (n,)
        Positive in the sense of rotation [N]
    """
    return pin.sense * (pin.y * np.cos(pin.angle) - pin.x * np.sin(pin.angle))


def power_residual(turn: Turn, found: Loads) -> float:
    """Largest gap between the power from the energies and the power from the forces on the crank.

    Returns
    -------
    residual : float
        Relative to the largest power of gas or load [-]
    """
    size = max(np.abs(turn.gas_power).max(), np.abs(turn.torque * turn.omega).max())
    return float(np.abs(pin_torque(found) - turn.torque).max() * turn.omega / size) if size > 0 else 0.0


def polar(turn: Turn, found: Loads) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Polar diagrams: loads on the pins in their cranks, on the main bearings in the frame.

    Returns
    -------
    curves : dict of str to (ndarray, ndarray)
        By name: along the crank and across it for a pin, x and y for a bearing; what the shaft presses with is the
        opposite of what it is pressed with [N]
    """
    pins = {pin.name: (radial(pin), tangential(pin)) for pin in found.pins}
    return pins | {name: (-x, -y) for name, (x, y) in found.bearings.items()}


def roll_sense(turn: Turn) -> float:
    """Sense of rotation of the shaft end that carries the load: the flywheel stands behind the last throw.

    Returns
    -------
    sense : float
        1 or -1 [-]
    """
    return chain_of(turn.drive).sense(turn.drive.parameters)
