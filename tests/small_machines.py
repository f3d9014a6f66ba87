"""Machines for the tests of forces, from records and numbers, and a gas whose work is known in closed form."""

import math

import numpy as np

from mechsym.cycle.gas import Gas
from mechsym.forces.turn import CrankDrive, Turn, at, crank_drive


def machine(mechanism, parameters, speed=20.0, **given) -> tuple[CrankDrive, float]:
    """That mechanism and its speed [rad/s]."""
    return crank_drive(mechanism, parameters, **given), speed


def smooth_gas(stroke, bore=0.2, level=30e5, swing=20e5) -> Gas:
    """Pressure level + swing (cos phi + sin phi / 3): smooth, of period 2 pi, and it does work."""
    return Gas(
        absolute=lambda phi: level + swing * (np.cos(phi) + np.sin(phi) / 3),
        p_back=1e5,
        period=2 * math.pi,
        bore=bore,
        area=math.pi / 4 * bore**2,
        stroke=stroke,
        compression_ratio=12.0,
        facts=(),
    )


def turn_of(machine, gas, n=720) -> Turn:
    """One turn at n even angles."""
    drive, speed = machine
    return at(drive, gas, speed, np.arange(n) * 2 * math.pi / n)
