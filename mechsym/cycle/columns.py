"""The figures of a cycle over the speeds, and every name that a kind of cycle may tell, with its unit and meaning.

Two engines side by side: where their torque curves cross, and a table of differences.
"""

import dataclasses
from collections.abc import Mapping

import numpy as np

from mechsym.cycle.source import SHARES, GasSource
from mechsym.files import Json
from mechsym.page import Shown, ShownFigures
from mechsym.quantities import results
from mechsym.quantities.display import key_words, without_unit
from mechsym.quantities.results import Columns, part, quantity, result, units_of
from mechsym.quantities.units import Array, Pure

Curve = np.ndarray


@result
class CycleColumns:
    """One value for each speed; a kind of cycle tells those that it knows, of the engine where nothing else is said."""

    speed_rpm: Curve = quantity("rpm", card="speed")  #: Speed of the crank
    torque_avg: Curve = quantity("N*m", card="indicated torque")  #: Mean indicated torque, net
    #: Largest torque on the shaft: of gas and reciprocating mass where the mechanism has one piston, of all that
    #: moves, as the force chain has it, where it has several
    torque_max: Curve = quantity("N*m", card="largest torque")
    power_kw: Curve = quantity("kW", card="indicated power")  #: Indicated power, net
    mep_kpa: Curve = quantity("kPa", card="IMEP net")  #: Indicated mean effective pressure of the whole cycle
    #: Indicated mean effective pressure without the two strokes of gas exchange
    gross_mep_kpa: Curve = quantity("kPa", card="IMEP gross")
    sfc_g_kwh: Curve = quantity("g/(kW*h)", card="ISFC")  #: Indicated fuel consumption
    #: Indicated work by the fuel's heating value, or by the heat of the hot side
    efficiency: Curve = quantity("-", card="indicated efficiency")
    p_max_mpa: Curve = quantity("MPa", card="p_max")  #: Largest pressure in the cylinder, absolute
    p_max_angle_deg: Curve = quantity("deg", card="angle of p_max")  #: Where that is, from firing dead centre
    ca10_deg: Curve = quantity("deg", card="CA10")  #: Where a tenth of the heat is released, from firing dead centre
    ca50_deg: Curve = quantity("deg", card="CA50")  #: Where half of it is
    ca90_deg: Curve = quantity("deg", card="CA90")  #: Where nine tenths of it are
    t_max_k: Curve = quantity("K", card="largest temperature")  #: Largest mean temperature of the gas
    knock: Curve = quantity("-")  #: Integral of the ignition delay of the unburnt gas; from 1 on it knocks
    force_max: Curve = quantity("N")  #: Largest force of gas and inertia on a piston
    friction_mep_kpa: Curve = quantity("kPa", card="FMEP")  #: Friction and auxiliaries as a mean effective pressure
    brake_mep_kpa: Curve = quantity("kPa", card="BMEP")  #: Brake mean effective pressure: IMEP net less FMEP
    brake_torque: Curve = quantity("N*m", card="brake torque")  #: Mean torque after friction
    brake_power_kw: Curve = quantity("kW", card="brake power")  #: Power after friction
    brake_sfc_g_kwh: Curve = quantity("g/(kW*h)", card="BSFC")  #: Fuel consumption after friction
    brake_efficiency: Curve = quantity("-", card="brake efficiency")  #: Brake work by the fuel's heating value
    #: Brake by net indicated work: what friction and auxiliaries leave; pumping is taken off before
    mechanical_efficiency: Curve = quantity("-", card="mechanical efficiency")
    energy_residual: Curve = quantity("-")  #: What the first law leaves open
    mass_residual: Curve = quantity("-")  #: What the balance of mass leaves open
    fractions: Mapping[str, Curve] = quantity("-")  #: Shares of the fuel's heat: walls, work, exhaust, unburnt
    loads: Mapping[str, Curve] = quantity("N")  #: Largest loads that limit a design
    # gas exchange and turbocharger
    #: Work of the two strokes of gas exchange as a mean effective pressure; negative where it is spent
    pumping_mep_kpa: Curve = quantity("kPa", card="PMEP")
    volumetric_efficiency: Curve = quantity(
        "-", card="volumetric efficiency"
    )  #: Fresh gas by what the swept volume holds before the engine
    trapping_efficiency: Curve = quantity("-")  #: Fresh gas that stays in the cylinder by that drawn
    residual_gas: Curve = quantity("-")  #: Share of burnt gas in the charge
    air_kg_h: Curve = quantity("kg/h", card="air")  #: Air that the engine takes
    p_in_kpa: Curve = quantity("kPa", card="inlet pressure")  #: Pressure before the engine, absolute
    t_in_k: Curve = quantity("K", card="inlet temperature")  #: Temperature before the engine
    p_out_kpa: Curve = quantity("kPa", card="exhaust pressure")  #: Pressure behind the engine, absolute
    t_exhaust_k: Curve = quantity("K", card="exhaust temperature")  #: Mean temperature of the exhaust gas
    t_turbine_k: Curve = quantity("K", card="turbine inlet temperature")  #: Temperature before the turbine
    compressor_efficiency: Curve = quantity("-")  #: Of the turbocharger's compressor
    compressor_ratio: Curve = quantity("-")  #: Pressure ratio of the turbocharger's compressor
    t_evc_k: Curve = quantity("K", card="charge temperature")  #: Temperature of the charge as the exhaust closes
    delivery_ratio: Curve = quantity("-")  #: Air of a cycle by what the cylinder holds
    dew_margin_k: Curve = quantity("K")  #: Scavenge air above the dew point
    # Stirling engines
    work_j: Curve = quantity("J")  #: Work of the gas in a turn
    work_hot_j: Curve = quantity("J")  #: Work in the hot space in a turn
    work_cold_j: Curve = quantity("J")  #: Work in the cold space in a turn
    heat_in_j: Curve = quantity("J")  #: Heat from the hot side in a turn
    heat_out_j: Curve = quantity("J")  #: Heat to the cold side in a turn
    heat_regenerator_j: Curve = quantity("J")  #: Heat that the regenerator keeps for a part of the turn
    indicated_efficiency: Curve = quantity("-")  #: Work of the gas by the heat that the ideal exchangers bring
    heat_in_kw: Curve = quantity("kW")  #: Heat from the hot side, losses included
    gas_kg: Curve = quantity("kg")  #: Mass of the gas
    T_e_min_k: Curve = quantity("K")  #: Least temperature of the gas in the hot space
    T_e_max_k: Curve = quantity("K")  #: Largest temperature of the gas in the hot space
    T_c_min_k: Curve = quantity("K")  #: Least temperature of the gas in the cold space
    T_c_max_k: Curve = quantity("K")  #: Largest temperature of the gas in the cold space
    T_h_k: Curve = quantity("K")  #: Temperature of the gas in the heater
    T_k_k: Curve = quantity("K")  #: Temperature of the gas in the cooler
    regenerator_effectiveness: Curve = quantity("-")  #: Heat that the regenerator gives back by what it could
    flow_share: Curve = quantity("-")  #: Work that the pressure drops take, by the work of the gas
    screen_reynolds: Curve = quantity("-")  #: Reynolds number in the regenerator
    seal_reynolds: Curve = quantity("-")  #: Reynolds number in the seal's gap
    losses: Mapping[str, Curve] = quantity("W")  #: What each loss takes, of work or of heat
    # several cylinders
    cylinders: int = quantity("-")  #: How many there are
    each: str = part()  #: What is counted
    #: The figures of one, where they differ from the engine's
    per_cylinder: Mapping[str, Curve] = quantity("of its column")
    #: The figures of each, where pistons move differently
    pistons: Mapping[str, Mapping[str, Curve]] = quantity("of its column")


#: What people call a figure: the word of its field, else its name
WORDS: Mapping[str, str] = {
    field.name: field.metadata.get("card") or key_words(without_unit(field.name, field.metadata["unit"]))
    for field in dataclasses.fields(CycleColumns)
    if "unit" in field.metadata
}
#: What is known of friction only
AFTER_FRICTION = ("friction_mep_kpa", "brake_mep_kpa", "brake_torque", "brake_power_kw", "brake_sfc_g_kwh",
                  "brake_efficiency", "mechanical_efficiency")  # fmt: skip
#: By name, those inside `per_cylinder` and `pistons` too, and of the shares as tables name them
UNITS: Mapping[str, str] = units_of(CycleColumns) | {f"fraction_{name}": "-" for name in SHARES}


class CycleFigures(ShownFigures):
    """Figures of an engine over the speeds, under the names of `mechsym cycle`."""

    units = UNITS
    source: GasSource | None = None  #: What answers for its gas; None where pistons move differently
    apart: float = 0.0  #: By how much strokes differ from that of the cylinder that stands for all [-]


_PEAKS = ("torque_avg", "torque_max", "power_kw", "mep_kpa", "efficiency", "p_max_mpa", "force_max", "brake_torque")
_ALONG = ("torque_avg", "power_kw", "mep_kpa", "sfc_g_kwh", "efficiency", "p_max_mpa", *SHARES)
_UNITS = {**UNITS, **dict.fromkeys(SHARES, UNITS["fractions"])}
_SPEEDS_IN_TABLE = 9


@result
class ComparedValue:
    """A figure of both engines at one speed."""

    quantity: str = part()
    speed_rpm: float | None = results.quantity("rpm")  #: Speed of both
    a: float = results.quantity("@unit")  #: Of the first engine
    b: float = results.quantity("@unit")  #: Of the second engine
    difference: float | None = results.quantity("-")  #: b/a - 1
    unit: str


@result
class ComparedPeak(ComparedValue):
    """The largest value of a figure of either engine, each at its own speed."""

    speed_a_rpm: float = results.quantity("rpm")  #: Where the first engine has it
    speed_b_rpm: float = results.quantity("rpm")  #: Where the second engine has it


@result
class ComparedEngines:
    """Where the curves of two engines cross, and their figures side by side."""

    crossover_rpm: np.ndarray = results.quantity("rpm")  #: Where the curves of the mean torque cross
    brake_crossover_rpm: np.ndarray = results.quantity("rpm")  #: Where those after friction cross
    at_crossover: tuple[Columns, ...] = part()  #: Figures of the first engine where the mean torques cross
    #: First the largest value of each figure, then values at a few speeds
    table: tuple[ComparedValue | ComparedPeak, ...] = part()


@result
class EngineComparison(Shown):
    """Two engines at the same speeds."""

    cases: tuple[str, ...] = part()  #: Names of the engines
    numbers: ComparedEngines = part(inline=True)


def crossovers(speed: Pure[Array], a: Pure[Array], b: Pure[Array]) -> Pure[Array]:
    """Speeds at which two curves cross.

    speed: increasing speeds, any unit; a, b: the curves, any unit. Returns crossings: where a - b changes sign,
    straight between neighbours, unit of `speed`, shape (k,).
    """
    gap = a - b
    k = np.flatnonzero(gap[:-1] * gap[1:] < 0)
    inner = speed[k] + (speed[k + 1] - speed[k]) * gap[k] / (gap[k] - gap[k + 1])
    return np.sort(np.concatenate([inner, speed[gap == 0]]))


def compare(a: Json, b: Json, cases: tuple[str, ...] = ()) -> EngineComparison:
    """Two engines at the same speeds. a, b: `cycle.columns` of each engine; equal `speed_rpm`."""
    speed = np.asarray(a["speed_rpm"])
    flat_a, flat_b = _flat(a), _flat(b)
    crossing = crossovers(speed, flat_a["torque_avg"], flat_b["torque_avg"])
    at = [{k: float(np.interp(s, speed, flat_a[k])) for k in _ALONG} | {"speed_rpm": float(s)} for s in crossing]
    shown = np.unique(np.linspace(0, speed.size - 1, _SPEEDS_IN_TABLE).round().astype(int))
    rows: list[ComparedValue] = [_largest(k, speed, flat_a[k], flat_b[k]) for k in _PEAKS]
    rows += [
        ComparedValue(quantity=k, speed_rpm=float(speed[i]), **_pair(k, flat_a[k][i], flat_b[k][i]))
        for k in _ALONG
        for i in shown
    ]
    numbers = ComparedEngines(
        crossover_rpm=crossing,
        brake_crossover_rpm=crossovers(speed, flat_a["brake_torque"], flat_b["brake_torque"]),
        at_crossover=tuple(Columns(figures, _UNITS) for figures in at),
        table=tuple(rows),
    )
    return EngineComparison(cases=cases, numbers=numbers)


def _flat(figures: Json) -> dict[str, np.ndarray]:
    return {k: np.asarray(v) for k, v in figures.items() if k not in ("fractions", "loads")} | dict(
        figures["fractions"]
    )


def _pair(name: str, a: float, b: float) -> Json:
    return {"a": float(a), "b": float(b), "difference": float(b / a - 1) if a else None, "unit": _UNITS[name]}


def _largest(name: str, speed: np.ndarray, a: np.ndarray, b: np.ndarray) -> ComparedPeak:
    i, j = int(np.nanargmax(a)), int(np.nanargmax(b))
    return ComparedPeak(
        quantity=f"largest {name}",
        speed_rpm=None,
        speed_a_rpm=float(speed[i]),
        speed_b_rpm=float(speed[j]),
        **_pair(name, a[i], b[j]),
    )
