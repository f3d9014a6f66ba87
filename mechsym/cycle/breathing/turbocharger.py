r"""A turbocharger of fixed efficiencies or with a compressor map, its intercooler, and the atmosphere at a height.

    ambient p_1, T_1 --[compressor]-- p_2 --[intercooler]-- T_2 -> engine -> p_3, T_3 --[turbine]-- p_1

The wanted boost pressure sets the compressor's work; the balance of the shaft says to which pressure the exhaust must
be dammed up before the turbine, and so what the boost costs in pumping. Pressures are absolute.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from mechsym.cycle.breathing.compressor_map import corrected_flow, map_efficiency
from mechsym.errors import BadInput
from mechsym.quantities import quantity, record

_GAMMA_AIR, _CP_AIR = 1.4, 1005.0
_GAMMA_EXHAUST, _CP_EXHAUST = 1.34, 1130.0
_ROUNDS, _SETTLED = 60, 1e-8


@record
class Boost:
    """Section `[boost]`: turbocharger, whose heights and surroundings are those of `[breathing]`."""

    pressure: float | None = quantity("Pa", default=None, above=0, about="absolute boost pressure; else sea level's")
    compressor_efficiency: float = quantity("-", default=0.72, above=0, high=1, about="isentropic, of the compressor")
    turbine_efficiency: float = quantity("-", default=0.68, above=0, high=1, about="isentropic, of the turbine")
    shaft_efficiency: float = quantity("-", default=0.97, above=0, high=1, about="mechanical, of the shaft")
    intercooler: float = quantity("-", default=0.0, low=0, below=1, about="effectiveness against ambient air")
    air_fuel_ratio: float = quantity("-", default=15.0, above=1, about="air over fuel by mass through the turbine")
    cylinders: float = quantity("-", default=1.0, low=1, high=24, about="cylinders that it serves, for the map's flow")
    #: Points of the compressor's map, in place of `compressor_efficiency`
    map_flow: tuple[float, ...] = quantity("kg/s", default=(), above=0, about="corrected to 288.15 K and 101325 Pa")
    map_ratio: tuple[float, ...] = quantity("-", default=(), low=1, about="pressure ratio of each point")
    map_efficiency: tuple[float, ...] = quantity("-", default=(), above=0, high=1, about="efficiency of each point")

    def __post_init__(self) -> None:
        if len({len(self.map_flow), len(self.map_ratio), len(self.map_efficiency)}) > 1 or 0 < len(self.map_flow) < 4:
            raise BadInput(
                f"map_flow, map_ratio and map_efficiency have {len(self.map_flow)}, {len(self.map_ratio)} and "
                f"{len(self.map_efficiency)} values; give each point of the map all three, four points at least"
            )


@record
class Boosted:
    """State before and behind the engine that the turbocharger leaves."""

    #: Atmosphere: absolute pressure [Pa] and temperature [K]
    p_1: float
    T_1: float
    p_2: float  #: Behind the compressor [Pa]
    T_2: np.ndarray  #: Behind the intercooler, one value for each speed [K]
    efficiency: np.ndarray  #: Of the compressor, at each speed [-]
    #: Before the turbine, one value for each speed [Pa, K]
    p_3: np.ndarray
    T_3: np.ndarray


def atmosphere(altitude: float) -> tuple[float, float]:
    r"""International standard atmosphere.

    .. math:: T = 288.15 - 0.0065\,h, \qquad p = 101325\,(T/288.15)^{5.25588}

    Parameters
    ----------
    altitude : float
        Height h above the sea [m]

    Returns
    -------
    p : float
        Absolute pressure [Pa]
    T : float
        Temperature [K]

    Notes
    -----
    Source: ISO 2533:1975. Valid: troposphere, -500 m to 11 km.

    Examples
    --------
    >>> p, T = atmosphere(5000.0)
    >>> round(p), round(T, 2)
    (54020, 255.65)
    """
    T = 288.15 - 0.0065 * altitude
    return 101325.0 * (T / 288.15) ** 5.25588, T


def compressor_temperature(T: float, ratio: float, efficiency: Any, gamma: float = _GAMMA_AIR) -> Any:
    r"""Temperature behind a compressor.

    .. math:: T_2 = T_1\left(1 + \frac{\pi^{(\gamma - 1)/\gamma} - 1}{\eta_c}\right)

    Parameters
    ----------
    T : float
        Temperature before it [K]
    ratio : float
        Pressure ratio, at least 1 [-]
    efficiency : float or ndarray
        Isentropic efficiency [-]
    gamma : float
        Ratio of the heat capacities [-]

    Returns
    -------
    T_2 : same kind as `efficiency`
        Temperature [K]

    Notes
    -----
    Source: Heywood (1988), eq. (6.42). Valid: constant heat capacities, no heat to the surroundings.

    Examples
    --------
    >>> round(compressor_temperature(288.15, 2.0, 0.72), 1)
    375.8
    """
    return T * (1 + (ratio ** ((gamma - 1) / gamma) - 1) / efficiency)


def turbine_ratio(boost: Boost, T_1: float, T_3: Any, ratio: float, efficiency: Any = None) -> Any:
    r"""Expansion ratio of the turbine that drives the compressor.

    .. math:: \pi_t^{-(\gamma_e - 1)/\gamma_e} = 1 - \frac{c_p T_1 (\pi_c^{(\gamma - 1)/\gamma} - 1)}
              {\eta_c \eta_t \eta_m (1 + 1/AFR)\,c_{p,e} T_3}

    Parameters
    ----------
    T_1 : float
        Temperature before the compressor [K]
    T_3 : float or ndarray
        Temperature before the turbine [K]
    ratio : float
        Pressure ratio of the compressor [-]
    efficiency : float or ndarray, optional
        Isentropic efficiency of the compressor, else that of the record [-]

    Returns
    -------
    ratio : same kind as `T_3`
        Pressure before the turbine by that behind it [-]

    Notes
    -----
    Source: balance of the shaft's powers, Heywood (1988), eq. (6.50). Valid: whole flow through the turbine, steady
    flow, cp 1005 and 1130 J/(kg K), gamma 1.4 and 1.34.

    Examples
    --------
    >>> round(turbine_ratio(Boost(), 288.15, 1000.0, 2.0), 3)
    1.589
    """
    work = _CP_AIR * T_1 * (ratio ** ((_GAMMA_AIR - 1) / _GAMMA_AIR) - 1)
    share = (
        (boost.compressor_efficiency if efficiency is None else efficiency)
        * boost.turbine_efficiency
        * boost.shaft_efficiency
    )
    rest = 1 - work / (share * (1 + 1 / boost.air_fuel_ratio) * _CP_EXHAUST * T_3)
    if np.any(rest <= 0):
        raise BadInput(
            f"boost.pressure: a pressure ratio of {ratio:.3g} asks for more than the exhaust of {np.min(T_3):.0f} K "
            "holds; lower boost.pressure or breathing.altitude, or raise the efficiencies"
        )
    return rest ** (-_GAMMA_EXHAUST / (_GAMMA_EXHAUST - 1))


def boosted(
    boost: Boost,
    outside: tuple[float, float],
    engine: Callable[[Boosted], tuple[np.ndarray, np.ndarray]],
    n: int,
) -> Boosted:
    """The engine and its turbocharger in balance at n speeds.

    Parameters
    ----------
    outside : tuple of float
        Pressure [Pa] and temperature [K] of the atmosphere
    engine : callable
        State before and behind the engine to the temperature of its exhaust [K] and the air that a cylinder draws
        [kg/s], each of shape (n,)
    """
    p_1, T_1 = outside
    p_2 = atmosphere(0.0)[0] if boost.pressure is None else boost.pressure
    ratio = p_2 / p_1
    if ratio < 1 - 1e-12:
        raise BadInput(
            f"boost.pressure = {p_2:.6g} Pa is below the atmosphere's {p_1:.6g} Pa; raise it, or leave out [boost]"
        )
    T_3, efficiency = np.full(n, 1000.0), np.full(n, boost.compressor_efficiency)
    for _ in range(_ROUNDS):
        hot = compressor_temperature(T_1, ratio, efficiency)
        state = Boosted(
            p_1=p_1, T_1=T_1, p_2=p_2, T_2=hot - boost.intercooler * (hot - T_1), efficiency=efficiency,
            p_3=p_1 * turbine_ratio(boost, T_1, T_3, ratio, efficiency), T_3=T_3,
        )  # fmt: skip
        found, air = engine(state)
        better = _efficiency(boost, corrected_flow(air * boost.cylinders, p_1, T_1), ratio)
        if np.all(np.abs(found - T_3) <= _SETTLED * T_3) and np.all(np.abs(better - efficiency) <= _SETTLED):
            return state
        T_3, efficiency = found, better
    raise BadInput("the exhaust's temperature and the turbocharger do not settle; lower boost.pressure")


def _efficiency(boost: Boost, flow: np.ndarray, ratio: float) -> np.ndarray:
    if not boost.map_flow:
        return np.full(len(flow), boost.compressor_efficiency)
    return map_efficiency((boost.map_flow, boost.map_ratio, boost.map_efficiency), flow, ratio)
