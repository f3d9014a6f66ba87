"""The table of a turn that `forces.csv` holds, and what is largest and smallest in it."""

import math
from collections.abc import Mapping

import numpy as np

from mechsym.forces.loads import Loads, radial, roll_sense, tangential
from mechsym.forces.turn import Turn


def extremes(columns: Mapping[str, np.ndarray]) -> tuple[dict[str, float], dict[str, float]]:
    """Largest and smallest value of every column."""
    return {k: float(np.max(v)) for k, v in columns.items()}, {k: float(np.min(v)) for k, v in columns.items()}


def columns(turn: Turn, found: Loads) -> dict[str, np.ndarray]:
    """The table of a turn: angle, gas, motion, loads, torque, SI units unless the name says otherwise.

    Returns
    -------
    columns : dict of str to ndarray, shape (n,)
        `phi_deg` first, then `p`, gas forces, pins, bearings, guides, reactions, `torque`
    """
    table: dict[str, np.ndarray] = {"phi_deg": np.degrees(turn.phi)}
    if turn.gas is not None:
        table["p"] = turn.gas.pressure.absolute(turn.phi)
    table |= dict(turn.inputs) | {n: v for n, v in turn.kinematics.items() if n.startswith(("x", "psi"))}
    for pin in found.pins:
        table |= {f"{pin.name}_radial": radial(pin), f"{pin.name}_tangential": tangential(pin)}
        table[f"{pin.name}_load"] = np.hypot(pin.x, pin.y)
    for name, (x, y) in found.bearings.items():
        table |= {f"{name}_x": x, f"{name}_y": y, f"{name}_load": np.hypot(x, y)}
    table |= dict(found.guides) | {n: v for n, v in turn.reactions.items() if n not in table}
    roll = -(turn.momentum["angular_momentum_rate"] + roll_sense(turn) * turn.torque)
    return table | {"torque": turn.torque, "roll_moment": roll}


def angle_of_largest(phi: np.ndarray, values: np.ndarray) -> float:
    """Crank angle at which a column is largest.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Angles [rad]
    values : ndarray, shape (n,)
        Column, in any unit [-]

    Returns
    -------
    angle : float
        Within a period, in degrees [deg]
    """
    return math.degrees(phi[int(np.argmax(values))])
