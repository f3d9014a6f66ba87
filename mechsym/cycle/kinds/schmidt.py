r"""Isothermal cycle of Schmidt (1871) for two cylinders that share one gas: the alpha arrangement of a Stirling engine.

    [hot cylinder V_e, T_e]--[regenerator V_r, T_r]--[cold cylinder V_c, T_c]     one pressure everywhere

.. math:: p(\varphi) = \frac{C}{V_e/T_e + V_r/T_r + V_c/T_c}, \qquad T_r = \frac{T_e - T_c}{\ln(T_e/T_c)}

C follows from the wanted mean pressure over a turn. Losses of real machines are left out: the work is an upper bound.
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from mechsym.cycle.chamber import piston_area
from mechsym.cycle.pressure import Pressure
from mechsym.errors import BadInput
from mechsym.quantities import quantity, record

_POINTS = 1440


@record
class Schmidt:
    """Section `[cycle]`, `kind = "schmidt"`."""

    bore: float = quantity("m", above=0, about="bore of both cylinders")
    dead_hot: float = quantity("m^3", low=0, about="dead volume of the hot cylinder")
    dead_cold: float = quantity("m^3", low=0, about="dead volume of the cold cylinder")
    dead_regenerator: float = quantity("m^3", above=0, about="volume of the regenerator")
    T_e: float = quantity("K", above=0, about="temperature of the hot gas")
    T_c: float = quantity("K", above=0, about="temperature of the cold gas")
    #: Absolute pressure, mean over a turn [Pa]
    mean_pressure: float = quantity("Pa", above=0, about="absolute mean pressure")
    #: Absolute pressure on the other side of the pistons [Pa]
    p_back: float = quantity("Pa", low=0, about="absolute pressure behind the pistons")

    def __post_init__(self) -> None:
        if self.T_e <= self.T_c:
            raise BadInput(f"T_e = {self.T_e:g} K must be above T_c = {self.T_c:g} K; else the machine is a heat pump")


def schmidt_pressure(cycle: Schmidt, x_hot: Callable[[Any], Any], x_cold: Callable[[Any], Any]) -> Pressure:
    """Pressure over the shaft angle.

    Parameters
    ----------
    x_hot, x_cold : callable
        Shaft angle, ndarray [rad], to the travel of each piston from top dead centre [m]

    Returns
    -------
    pressure : Pressure
        Period 2 pi, no kinks; phi is the shaft angle
    """
    area, T_r = piston_area(cycle.bore), (cycle.T_e - cycle.T_c) / math.log(cycle.T_e / cycle.T_c)

    def inverse(phi: np.ndarray) -> np.ndarray:
        hot = (cycle.dead_hot + area * x_hot(phi)) / cycle.T_e
        cold = (cycle.dead_cold + area * x_cold(phi)) / cycle.T_c
        return 1 / (hot + cycle.dead_regenerator / T_r + cold)

    turn = np.arange(_POINTS) * 2 * math.pi / _POINTS
    scale = cycle.mean_pressure / inverse(turn).mean()  # a smooth periodic mean: exact to round-off
    p = scale * inverse(turn)
    # both pistons do work; the mean is over the swept volume of the two
    swept = area * (np.ptp(x_hot(turn)) + np.ptp(x_cold(turn)))
    volume = area * (x_hot(turn) + x_cold(turn))
    slope = np.fft.irfft(1j * np.arange(_POINTS // 2 + 1) * np.fft.rfft(volume), _POINTS)
    best = int(np.argmax(p))
    return Pressure(
        kind="schmidt",
        period=2 * math.pi,
        kinks=(),
        absolute=lambda phi: scale * inverse(np.asarray(phi, dtype=float)),
        p_max=float(p[best]),
        phi_p_max=float(math.remainder(turn[best], 2 * math.pi)),
        mean_indicated=float((p * slope).mean() * 2 * math.pi / swept),
        facts=("the gas is isothermal in each space (Schmidt); losses are left out, the work is an upper bound",),
    )
