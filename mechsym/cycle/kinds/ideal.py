r"""Ideal air-standard cycles: what the cycle models come to when combustion is instant and nothing is lost.

p |  2'--3          Seiliger (dual): heat at constant volume 2-2', then at constant pressure 2'-3
  |  |    \         Otto: only 2-2'     Diesel: only 2-3
  |  2     \        compression 1-2 and expansion 3-4 isentropic, heat rejected at constant volume 4-1
  |   `-._  4
  |       `-1
  +----------- V
"""

import math

from mechsym.cycle.values import Value
from mechsym.errors import BadInput
from mechsym.quantities import record


@record
class IdealCycle:
    """States and energies of an ideal cycle, per mass of gas."""

    #: At the points 1, 2, 2', 3, 4, each over the value at point 1 [-]
    pressure: tuple[float, ...]
    temperature: tuple[float, ...]
    volume: tuple[float, ...]
    #: Heat taken in and work done, over c_v T_1 [-]
    heat: float
    work: float
    efficiency: float  #: Work over heat [-]


def otto_efficiency(compression_ratio: Value, gamma: Value) -> Value:
    r"""Efficiency of the Otto cycle.

    .. math:: \eta = 1 - CR^{1-\gamma}

    Parameters
    ----------
    compression_ratio : float or ndarray
        Largest over smallest volume [-]
    gamma : float or ndarray
        Ratio of heat capacities [-]

    Returns
    -------
    eta : float or ndarray
        Efficiency [-]

    Notes
    -----
    Source: Nunes (2017), eq. (2.3).
    """
    return 1 - compression_ratio ** (1 - gamma)


def diesel_efficiency(compression_ratio: Value, gamma: Value, cutoff: Value) -> Value:
    r"""Efficiency of the Diesel cycle.

    .. math:: \eta = 1 - CR^{1-\gamma}\,\frac{\rho^\gamma - 1}{\gamma(\rho - 1)}

    Parameters
    ----------
    compression_ratio : float or ndarray
        Largest over smallest volume [-]
    gamma : float or ndarray
        Ratio of heat capacities [-]
    cutoff : float or ndarray
        Volume at the end over volume at the start of heat addition, rho > 1 [-]

    Returns
    -------
    eta : float or ndarray
        Efficiency [-]
    """
    return 1 - compression_ratio ** (1 - gamma) * (cutoff**gamma - 1) / (gamma * (cutoff - 1))


def seiliger(compression_ratio: float, gamma: float, pressure_ratio: float, cutoff: float) -> IdealCycle:
    r"""States and efficiency of the Seiliger cycle.

    .. math:: \eta = 1 - CR^{1-\gamma}\,\frac{\xi\rho^\gamma - 1}{\xi - 1 + \gamma\xi(\rho - 1)}

    Parameters
    ----------
    compression_ratio : float
        Largest over smallest volume, CR > 1 [-]
    gamma : float
        Ratio of heat capacities, > 1 [-]
    pressure_ratio : float
        Rise of pressure at constant volume, xi >= 1; 1 gives the Diesel cycle [-]
    cutoff : float
        Rise of volume at constant pressure, 1 <= rho < CR; 1 gives the Otto cycle [-]

    Returns
    -------
    cycle : IdealCycle
        States at 1, 2, 2', 3, 4

    Raises
    ------
    BadInput
        A ratio is out of range, or no heat is added at all
    """
    _check(compression_ratio, gamma, pressure_ratio, cutoff)
    t2 = compression_ratio ** (gamma - 1)
    t2x, p2 = pressure_ratio * t2, compression_ratio**gamma
    t3 = cutoff * t2x
    t4 = t3 * (cutoff / compression_ratio) ** (gamma - 1)
    heat = (t2x - t2) + gamma * (t3 - t2x)
    v2 = 1 / compression_ratio
    return IdealCycle(
        pressure=(1.0, p2, pressure_ratio * p2, pressure_ratio * p2, t4),
        temperature=(1.0, t2, t2x, t3, t4),
        volume=(1.0, v2, v2, cutoff * v2, 1.0),
        heat=heat, work=heat - (t4 - 1), efficiency=1 - (t4 - 1) / heat,
    )  # fmt: skip


def _check(compression_ratio: float, gamma: float, pressure_ratio: float, cutoff: float) -> None:
    ranges = (
        ("compression_ratio", compression_ratio, compression_ratio > 1, "> 1"),
        ("gamma", gamma, gamma > 1, "> 1"),
        ("pressure_ratio", pressure_ratio, pressure_ratio >= 1, ">= 1"),
        ("cutoff", cutoff, 1 <= cutoff < compression_ratio, ">= 1 and below compression_ratio"),
    )
    for name, value, good, allowed in ranges:
        if not (math.isfinite(value) and good):
            raise BadInput(f"{name} = {value:g} is out of range; it must be {allowed}")
    if pressure_ratio == 1 and cutoff == 1:
        raise BadInput("pressure_ratio = cutoff = 1 adds no heat; raise one of them above 1")
