"""Load torque of the driven machine as a law of the shaft speed. Each law is a record; one function evaluates them all.

The torque opposes the motion: positive values brake a shaft that turns forwards. A constant load leaves the mean speed
of an engine undetermined; one that grows with speed brings it back.
"""

from dataclasses import replace
from functools import lru_cache
from typing import Annotated

import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.quantities import quantity, record
from mechsym.quantities.units import NewtonMetre, RadPerSecond, Scalar


@record
class ConstantLoad:
    """The same torque at every speed."""

    #: Load torque; None takes the mean torque of the engine cycle [N*m]
    torque: float | None = quantity("N*m", default=None, about="load torque; without it the cycle's mean torque")


@record
class PropellerLoad:
    """Torque that grows with the square of the speed."""

    #: Torque at the reference speed; None takes the mean torque of the engine cycle [N*m]
    torque: float | None = quantity("N*m", default=None, low=0, about="torque at the reference speed")
    #: Reference speed; None takes the speed of operation [rad/s]
    speed: float | None = quantity("rad/s", default=None, low=0.1, about="reference speed")


@record
class TableLoad:
    """Torque over speed from a table, joined without overshoot by cubics (PCHIP), constant beyond its ends."""

    #: Ascending speeds, at least two [rad/s]
    speeds: tuple[float, ...] = quantity("rad/s", about="ascending speeds")
    torques: tuple[float, ...] = quantity("N*m", about="torque at each speed")

    def __post_init__(self) -> None:
        if len(self.speeds) < 2 or len(self.speeds) != len(self.torques):
            raise BadInput(
                f"load table has {len(self.speeds)} speeds and {len(self.torques)} torques; it needs as many of each, "
                "at least two"
            )
        if not np.all(np.isfinite([*self.speeds, *self.torques])) or np.any(np.diff(self.speeds) <= 0):
            raise BadInput("load table: speeds must ascend and all values be finite; sort the table by speed")


@lru_cache(maxsize=16)
def _curve(speeds: tuple[float, ...], torques: tuple[float, ...]) -> "scipy.interpolate.PchipInterpolator":
    return scipy.interpolate.PchipInterpolator(speeds, torques)


Load = ConstantLoad | PropellerLoad | TableLoad


def settle(load: Load, torque: NewtonMetre, speed: RadPerSecond) -> Load:
    """The law with its blanks filled in from the engine's own operation.

    load: a law, perhaps without torque or speed; torque: mean torque of the engine cycle. Returns load: the same law
    with numbers everywhere; where the machine takes work, a steady torque that drives it in place of a propeller.
    """
    match load:
        case ConstantLoad(torque=None):
            return replace(load, torque=torque)
        case PropellerLoad(torque=None) if torque < 0:
            return ConstantLoad(torque=torque)  # a compressor takes work: a steady torque drives it
        case PropellerLoad():
            return replace(
                load,
                torque=torque if load.torque is None else load.torque,
                speed=speed if load.speed is None else load.speed,
            )
    return load


def load_torque(load: Load, omega: RadPerSecond[Scalar]) -> NewtonMetre[Scalar]:
    r"""Load torque at a shaft speed.

    .. math:: M_r = M, \qquad M_r = M \frac{\omega |\omega|}{\omega_0^2}, \qquad M_r = \text{table}(\omega)

    omega: shaft speed; symbols are taken by the constant and the propeller law. Returns torque: torque against forward
    motion.
    """
    match load:
        case ConstantLoad():
            if load.torque is None:
                raise BadInput("constant load without torque; give it, or settle it with the engine's own")
            return load.torque + 0 * omega
        case PropellerLoad():
            return propeller_torque(omega, *reference(load))
        case TableLoad():
            return _curve(load.speeds, load.torques)(np.clip(omega, load.speeds[0], load.speeds[-1]))


def propeller_torque(
    omega: RadPerSecond[Scalar], torque: NewtonMetre[Scalar], speed: RadPerSecond[Scalar]
) -> NewtonMetre[Scalar]:
    r"""Torque of a propeller, for numbers and symbols alike.

    .. math:: M_r = M \frac{\omega |\omega|}{\omega_0^2}

    omega, speed: shaft speed, and the speed of reference; torque: torque at the speed of reference. Returns torque:
    against forward motion.

    >>> propeller_torque(-2.0, 3.0, 1.0)
    -12.0
    """
    return torque / speed**2 * omega * abs(omega)


def reference(load: PropellerLoad) -> tuple[NewtonMetre, RadPerSecond]:
    """Torque and speed of reference. Raises BadInput: one of them is not settled."""
    if load.torque is None or load.speed is None:
        raise BadInput("propeller load without torque or speed; give both, or settle it with the engine's own")
    return load.torque, load.speed


def load_slope(load: Load, omega: RadPerSecond[Scalar]) -> Annotated[Scalar, "N*m*s/rad"]:
    r"""Slope of the load torque over speed.

    .. math:: \mathrm{d}M_r / \mathrm{d}\omega

    Returns slope: 0 for a constant load and beyond the ends of a table.
    """
    match load:
        case ConstantLoad():
            return 0 * omega
        case PropellerLoad():
            return 2 * propeller_torque(1.0, *reference(load)) * abs(omega)
        case TableLoad():
            inside = (omega >= load.speeds[0]) & (omega <= load.speeds[-1])
            return np.where(inside, _curve(load.speeds, load.torques)(omega, 1), 0.0)
