"""Machines for the tests of forces: a case without a file, and a gas whose work is known in closed form."""

import math

import numpy as np

from mechsym.cases import Case
from mechsym.cases.settings import Operation
from mechsym.cycle.on_pistons import Gas
from mechsym.forces.turn import Turn, at, one_coordinate


def machine(mechanism, parameters, speed=20.0, **sections) -> Case:
    """A case of that mechanism."""
    head = {"name": "small", "file": "test", "source": "", "about": ""}
    given = {"parameters": parameters, "operation": Operation(speed=speed), **sections}
    return Case(mechanism=mechanism, sections=given, **head)


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


def turn_of(case, gas, n=720) -> Turn:
    """One turn at n even angles."""
    phi = np.arange(n) * 2 * math.pi / n
    return at(case, one_coordinate(case), gas, case.need("operation").speed, phi)
