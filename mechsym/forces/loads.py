"""Reactions of every mechanism under common names, so that what follows need not know the mechanism.

Forces on the crank pin are those of the rod (planet, link) on the crank: radial positive outwards, tangential positive
in the sense of rotation. The side force is that of the guide on the piston or slider. Bearing forces are those on the
crank, in the frame; the same forces turned into the crank give the polar diagram of the pin.
"""

from collections.abc import Callable, Mapping

import numpy as np

from mechsym.forces.turn import Turn
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.quantities import record


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
    return _LOADS[turn.drive.name](turn)


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


def _crosshead(turn: Turn) -> Loads:
    p, R = turn.drive.mechanism.parameters, turn.reactions
    weight = -p["g"] * p["m1"] * p["r1"] * np.cos(turn.phi + p["axis_tilt"])
    return _single(turn, p["r1"] + p["r2"], (-R["R_x_A"], -R["R_y_A"]), R["R_y_G"], weight)


def _throw(turn: Turn) -> Loads:
    p, R = turn.drive.mechanism.parameters, turn.reactions
    weight = -p["g"] * p["u0"] * np.cos(turn.phi + p["axis_tilt"])
    return _single(turn, p["r"], (-R["R_x_A"], -R["R_y_A"]), R["R_y_G"], weight)


def _single(
    turn: Turn, radius: float, pin: tuple[np.ndarray, np.ndarray], guide: np.ndarray, weight: np.ndarray
) -> Loads:
    R = turn.reactions
    return Loads(
        pins=(Pin(name="crank_pin", angle=turn.phi, radius=radius, sense=1.0, x=pin[0], y=pin[1]),),
        bearings={"main_bearing": (R["R_x_O"], R["R_y_O"])},
        guides={"side_force": guide},
        weight_torque=weight,
    )


def _hypocycloid(turn: Turn) -> Loads:
    R, none = turn.reactions, np.zeros_like(turn.phi)
    x, y = -R["journal_force_x"], -R["journal_force_y"]
    return Loads(
        pins=(Pin(name="crank_pin", angle=turn.phi, radius=turn.drive.mechanism.parameters["e"], sense=1.0, x=x, y=y),),
        bearings={"main_bearing": (R["main_bearing_force_x"], R["main_bearing_force_y"])},
        guides={"side_force": none},
        weight_torque=none,
    )


def _rodless(turn: Turn) -> Loads:
    R = turn.reactions
    x, y = -R["pin_force_x"], -R["pin_force_y"]
    return Loads(
        pins=(Pin(name="crank_pin", angle=turn.phi, radius=turn.drive.mechanism.parameters["r"], sense=1.0, x=x, y=y),),
        bearings={"main_bearing": (R["main_bearing_force_x"], R["main_bearing_force_y"])},
        guides={"side_force_a": R["X_a"], "side_force_b": R["X_b"]},
        weight_torque=np.zeros_like(turn.phi),
    )


def _crank_train(turn: Turn) -> Loads:
    p, R = turn.drive.parameters, turn.reactions
    return Loads(
        pins=tuple(_train_pin(p, R, turn.phi, i) for i in range(len(p.throw))),
        bearings={
            f"main_bearing_{k}": (R[f"main_bearing_force_x_{k}"], R[f"main_bearing_force_y_{k}"])
            for k in sorted(set(p.throw))
        },
        guides={f"side_force_{i + 1}": R[f"side_force_{i + 1}"] for i in range(len(p.throw))},
        weight_torque=_train_weight(p, turn.phi),
    )


def _train_pin(p: CrankTrainParameters, R: Mapping[str, np.ndarray], phi: np.ndarray, i: int) -> Pin:
    sense = each(p, "sense")[p.throw[i] - 1]
    return Pin(
        name=f"crank_pin_{i + 1}",
        angle=sense * (phi + each(p, "phase")[i]),
        radius=each(p, "r")[i],
        sense=sense,
        x=-R[f"pin_force_x_{i + 1}"],
        y=-R[f"pin_force_y_{i + 1}"],
    )


def _train_weight(p: CrankTrainParameters, phi: np.ndarray) -> np.ndarray:
    total = np.zeros_like(phi)
    for u, phase, sense in zip(*(each(p, n) for n in ("u0", "u_phase", "sense")), strict=True):
        total += -p.g * u * sense * np.cos(sense * (phi + phase) + p.axis_tilt)
    return total


_LOADS: dict[str, Callable[[Turn], Loads]] = {
    "crosshead": _crosshead,
    "crank_throw": _throw,
    "hypocycloid": _hypocycloid,
    "rodless": _rodless,
    "crank_train": _crank_train,
}


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
    parameters = turn.drive.parameters
    return each(parameters, "sense")[-1] if isinstance(parameters, CrankTrainParameters) else 1.0
