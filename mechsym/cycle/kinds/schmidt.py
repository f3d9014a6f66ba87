r"""Isothermal cycle of Schmidt (1871): the gas keeps the temperature of each space of a Stirling engine.

    [expansion space V_e, T_e]--[regenerator V_r, T_r]--[compression space V_c, T_c]     one pressure everywhere

.. math:: p(\varphi) = \frac{C}{V_e/T_e + V_r/T_r + V_c/T_c}, \qquad T_r = \frac{T_e - T_c}{\ln(T_e/T_c)}

C follows from the wanted mean pressure over a turn. Losses of real machines are left out: the work is an upper bound.
"""

import math

import numpy as np

from mechsym.cycle.kinds.stirling_equations import FiveSpaces, evaluated, exchanger_capacity
from mechsym.cycle.kinds.stirling_spaces import StirlingCylinders
from mechsym.cycle.kinds.stirling_turn import StirlingTurn
from mechsym.quantities import record

_POINTS = 1440


@record
class Schmidt(StirlingCylinders):
    """Section `[cycle]`, `kind = "schmidt"`."""


def schmidt_turn(spaces: FiveSpaces) -> StirlingTurn:
    """A turn of the isothermal cycle, whose heats are the works of the two spaces."""
    phi = np.arange(_POINTS + 1) * 2 * math.pi / _POINTS
    volume, slope = evaluated(spaces.volumes, phi)
    T, capacity = (float(spaces.T_h), float(spaces.T_k)), float(exchanger_capacity(spaces))
    inverse = 1 / (volume[0] / T[0] + volume[1] / T[1] + capacity)
    scale = float(spaces.mean_pressure) / inverse[:-1].mean()  # a smooth periodic mean: exact to round-off
    p = scale * inverse
    dp = -p * inverse * (slope[0] / T[0] + slope[1] / T[1])
    flows = [(dp * v + p * s) / (spaces.R * t) for v, s, t in zip(volume, slope, T, strict=True)]
    works = [float((p * s)[:-1].mean() * 2 * math.pi) for s in slope]
    heats = {"Q_h": works[0], "Q_r": 0.0, "Q_k": works[1], "Q_e": 0.0, "Q_c": 0.0}
    return StirlingTurn(
        phi=phi, p=p, dp_dphi=dp, V_e=volume[0], V_c=volume[1], T_e=np.full_like(phi, T[0]),
        T_c=np.full_like(phi, T[1]), flow_e=flows[0], flow_c=flows[1], stored=_stored(spaces, flows, dp, phi),
        mass=float(scale / spaces.R), cuts=np.empty(0), closure=0.0,
        sums=heats | {"W_e": works[0], "W_c": works[1], "p_mean": float(spaces.mean_pressure)},
    )  # fmt: skip


def _stored(spaces: FiveSpaces, flows: list[np.ndarray], dp: np.ndarray, phi: np.ndarray) -> np.ndarray:
    # heat from the matrix: its own gas changes pressure, and what passes is warmed from the cold to the hot side
    cp = spaces.gamma * spaces.R / (spaces.gamma - 1)
    hot = flows[0] + spaces.V_h * dp / (spaces.R * spaces.T_h)
    cold = flows[1] + spaces.V_k * dp / (spaces.R * spaces.T_k)
    rate = spaces.V_r * dp / (spaces.gamma - 1) + cp * (spaces.T_h * hot + spaces.T_k * cold)
    return np.concatenate([[0.0], np.cumsum((rate[1:] + rate[:-1]) / 2 * np.diff(phi))])
