"""Laws by which something rises from 0 to 1 over the share x of its angle or time: of cams and of driven motions.

A modified sine joins quarter waves of the periods 1/2 and 3/2 so that the acceleration is continuous; a trapezium of
acceleration has ramps and rests of constant acceleration in the proportion 1 : 2 : 1 in each half. Each law takes the
functions of whoever asks, sympy or CasADi, and gives its value piece by piece with the end of each in eighths of x.
"""

from collections.abc import Callable, Mapping
from typing import Any

Number = Any  # of sympy or of CasADi
Functions = Any  # what has sin, cos and pi
Pieces = list[tuple[Number, int]]


def _modified_sine(x: Number, f: Functions) -> Pieces:
    whole, ends = 4 + f.pi, f.sin(4 * f.pi * x) / 4
    middle = 2 + f.pi * x - 9 * f.sin(4 * f.pi * x / 3 + f.pi / 3) / 4
    return [((f.pi * x - ends) / whole, 1), (middle / whole, 7), ((4 + f.pi * x - ends) / whole, 8)]


def _trapezium(x: Number, f: Functions) -> Pieces:
    y = 1 - x
    ramps, rests = [64 * z**3 / 9 for z in (x, y)], [(192 * z**2 - 24 * z + 1) / 72 for z in (x, y)]
    middle = (-128 * x**3 + 192 * x**2 - 60 * x + 7) / 18
    return [(ramps[0], 1), (rests[0], 3), (middle, 5), (1 - rests[1], 7), (1 - ramps[1], 8)]


RISES: Mapping[str, Callable[[Number, Functions], Pieces]] = {
    "harmonic": lambda x, f: [((1 - f.cos(f.pi * x)) / 2, 8)],
    "cycloid": lambda x, f: [(x - f.sin(2 * f.pi * x) / (2 * f.pi), 8)],
    "3-4-5": lambda x, f: [(10 * x**3 - 15 * x**4 + 6 * x**5, 8)],
    "4-5-6-7": lambda x, f: [(35 * x**4 - 84 * x**5 + 70 * x**6 - 20 * x**7, 8)],
    "modified sine": _modified_sine,
    "trapezium": _trapezium,
}
