r"""A turbocharger of fixed efficiencies or with a compressor map, its intercooler, and the atmosphere at a height.

    ambient p_1, T_1 --[compressor]-- p_2 --[intercooler]-- T_2 -> engine -> p_3, T_3 --[turbine]-- p_1

The wanted boost pressure sets the compressor's work; the balance of the shaft says to which pressure the exhaust must
be dammed up before the turbine, and so what the boost costs in pumping. Pressures are absolute. A map holds points of
corrected flow and pressure ratio, between which the efficiency is linear.
"""

from collections.abc import Callable, Sequence

import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Array, Kelvin, MassFlow, Metre, Pascal, Pure, Scalar

_T, _P = 288.15, 101325.0  # state that a map's flow is corrected to [K, Pa]


def corrected_flow(flow: MassFlow[Array], p: float, T: float) -> MassFlow[Array]:
    r"""Flow through a compressor as its map counts it.

    .. math:: \dot m_{corr} = \dot m\,\frac{\sqrt{T/288.15\,\mathrm{K}}}{p/101325\,\mathrm{Pa}}

    p, T: state before the compressor [Pa, K]. Returns flow: corrected flow, shape of `flow`.
    Source: similarity of Mach numbers; SAE J1826. Valid: the gas of the map, Reynolds number without effect.

    >>> round(float(corrected_flow(np.array(0.1), 101325.0, 288.15)), 3)
    0.1
    """
    return flow * np.sqrt(T / _T) / (p / _P)


def map_efficiency(points: Sequence[Sequence[float]], flow: MassFlow[Array], ratio: Pure) -> Pure[Array]:
    """Isentropic efficiency at a pressure ratio.

    points: corrected flows [kg/s], pressure ratios and efficiencies [-] of the map's points; flow: corrected flow.
    Raises BadInput: a point outside the map: surge on its left, choke on its right.
    Source: planes through each three neighbouring points of the map (Delaunay), flow and ratio by their largest. Valid
    between the points that the maker measured.

    >>> points = ([0.1, 0.3, 0.1, 0.3], [1.0, 1.0, 3.0, 3.0], [0.6, 0.7, 0.6, 0.7])
    >>> round(float(map_efficiency(points, np.array([0.2]), 2.0)[0]), 9)
    0.65
    """
    flows, ratios, values = (np.asarray(p, float) for p in points)
    scale = np.array([flows.max(), ratios.max()])
    surface = scipy.interpolate.LinearNDInterpolator(np.column_stack([flows, ratios]) / scale, values)
    efficiency = np.asarray(surface(np.column_stack([flow, np.full(len(flow), ratio)]) / scale))
    if np.isnan(efficiency).any():
        out = float(flow[int(np.argmax(np.isnan(efficiency)))])
        raise BadInput(
            f"boost.map_flow: the engine asks for {out:.4g} kg/s at a pressure ratio of {ratio:.3g}, outside the map "
            f"(flows {flows.min():.4g} to {flows.max():.4g} kg/s, ratios {ratios.min():.3g} to {ratios.max():.3g}): "
            "surge or choke; change boost.pressure, boost.cylinders or the compressor"
        )
    return efficiency


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


def atmosphere(altitude: Metre) -> tuple[Pascal, Kelvin]:
    r"""International standard atmosphere.

    .. math:: T = 288.15 - 0.0065\,h, \qquad p = 101325\,(T/288.15)^{5.25588}

    altitude: height h above the sea. Returns p: absolute pressure.
    Source: ISO 2533:1975. Valid: troposphere, -500 m to 11 km.

    >>> p, T = atmosphere(5000.0)
    >>> round(p), round(T, 2)
    (54020, 255.65)
    """
    T = 288.15 - 0.0065 * altitude
    return 101325.0 * (T / 288.15) ** 5.25588, T


def compressor_temperature(
    T: Kelvin, ratio: Pure, efficiency: Pure[Scalar], gamma: Pure = _GAMMA_AIR
) -> Kelvin[Scalar]:
    r"""Temperature behind a compressor.

    .. math:: T_2 = T_1\left(1 + \frac{\pi^{(\gamma - 1)/\gamma} - 1}{\eta_c}\right)

    T: temperature before it; ratio: pressure ratio, at least 1; efficiency: isentropic efficiency; gamma: ratio of the
    heat capacities. Source: Heywood (1988), eq. (6.42). Valid: constant heat capacities, no heat to the surroundings.

    >>> round(compressor_temperature(288.15, 2.0, 0.72), 1)
    375.8
    """
    return T * (1 + (ratio ** ((gamma - 1) / gamma) - 1) / efficiency)


def turbine_ratio(
    boost: Boost, T_1: Kelvin, T_3: Kelvin[Scalar], ratio: Pure, efficiency: Pure[Scalar] = None
) -> Pure[Scalar]:
    r"""Expansion ratio of the turbine that drives the compressor.

    .. math:: \pi_t^{-(\gamma_e - 1)/\gamma_e} = 1 - \frac{c_p T_1 (\pi_c^{(\gamma - 1)/\gamma} - 1)}
              {\eta_c \eta_t \eta_m (1 + 1/AFR)\,c_{p,e} T_3}

    T_1: temperature before the compressor; T_3: temperature before the turbine; ratio: pressure ratio of the
    compressor; efficiency: isentropic efficiency of the compressor, else that of the record. Returns ratio: pressure
    before the turbine by that behind it. Source: balance of the shaft's powers, Heywood (1988), eq. (6.50). Valid:
    whole flow through the turbine, steady flow, cp 1005 and 1130 J/(kg K), gamma 1.4 and 1.34.

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

    outside: pressure [Pa] and temperature [K] of the atmosphere.

    engine: state before and behind the engine to the temperature of its exhaust [K] and the air that a cylinder draws
    [kg/s], each of shape (n,).
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
        demand, air = engine(state)
        better = _efficiency(boost, corrected_flow(air * boost.cylinders, p_1, T_1), ratio)
        if np.all(np.abs(demand - T_3) <= _SETTLED * T_3) and np.all(np.abs(better - efficiency) <= _SETTLED):
            return state
        T_3, efficiency = demand, better
    raise BadInput("the exhaust's temperature and the turbocharger do not settle; lower boost.pressure")


def _efficiency(boost: Boost, flow: np.ndarray, ratio: float) -> np.ndarray:
    if not boost.map_flow:
        return np.full(len(flow), boost.compressor_efficiency)
    return map_efficiency((boost.map_flow, boost.map_ratio, boost.map_efficiency), flow, ratio)
