"""Machines for the tests of forces, from records and numbers, and a gas whose work is known in closed form."""

import math

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import chamber_over
from mechsym.cycle.gas import Gas, pressure_over
from mechsym.forces.turn import CrankDrive, Turn, at, crank_drive


def machine(mechanism, parameters, speed=20.0, **given) -> tuple[CrankDrive, float]:
    """That mechanism and its speed [rad/s]."""
    return crank_drive(mechanism, parameters, **given), speed


def smooth_gas(stroke, bore=0.2, level=30e5, swing=20e5) -> Gas:
    """Pressure level + swing (cos phi + sin phi / 3): smooth, of period 2 pi, and it does work."""
    phi = ca.SX.sym("phi")
    x = stroke / 2 * (1 - ca.cos(phi))
    kinematics = ca.Function("kinematics", [phi], [x, ca.jacobian(x, phi)], ["phi"], ["x", "dx_dphi"])
    room = chamber_over(kinematics, bore, 12.0, 1e5)
    pressure = pressure_over("test", lambda a: level + swing * (np.cos(a) + np.sin(a) / 3), 2 * math.pi, (), room)
    return Gas(pressure=pressure, chamber=room)


def turn_of(machine, gas, n=720) -> Turn:
    """One turn at n even angles."""
    drive, speed = machine
    return at(drive, gas, speed, np.arange(n) * 2 * math.pi / n)
