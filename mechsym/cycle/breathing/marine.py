r"""Mean values of a turbocharged two-stroke engine: the scavenge pressure at which its turbocharger runs steadily.

.. math:: \dot m_a = \dot m(A; p_s, T_s \to p_r), \quad \dot m_a + \dot m_f = \dot m(A_T; p_r, T_r \to p_b), \quad
          \eta_m P_T = P_C

          \dot m_a c_p T_s + \dot m_f H (1 - q) - P_i + \ldots = (\dot m_a + \dot m_f)\,c_{p,e} T_r

Enthalpies of gas count from 298.15 K, at which the heating value H is measured. p_s, p_r, T_r and T_evc are found
together; of several balances the highest that comes back after a disturbance is taken.
"""

import dataclasses
import functools
import math
from typing import NamedTuple

import numpy as np

from mechsym.cycle.breathing.flow import Scavenging, dew_point, flow_area, orifice_flow, remaining, trapped_temperature
from mechsym.cycle.breathing.turbocharger import atmosphere, compressor_temperature
from mechsym.cycle.chamber import Chamber, chamber_over, volume
from mechsym.cycle.kinds.two_stroke import (
    TwoStrokeMarine,
    absolute_pressure,
    back_pressure,
    burnt_angles,
    kinks,
    scavenging_pressure,
    solve,
    two_stroke_pressure,
)
from mechsym.cycle.pressure import Pressure, mean_indicated_pressure
from mechsym.cycle.source import CylinderGas, EngineParts
from mechsym.errors import BadInput
from mechsym.periodic.roots import root
from mechsym.quantities import record
from mechsym.quantities.display import quantity_text
from mechsym.quantities.units import RadPerSecond

_GAMMA, _CP = 1.4, 1005.0
_GAMMA_E, _CP_E = 1.34, 1130.0
_R, _R_E = _CP * (_GAMMA - 1) / _GAMMA, _CP_E * (_GAMMA_E - 1) / _GAMMA_E
_T_0 = 298.15
_HIGHEST, _TRIALS = 12e5, 33
_HOTTEST = 799.0  # trapped temperature above which there is no fresh charge to speak of [K]


@record
class ScavengeState:
    """Steady running of engine and turbocharger, of one cylinder."""

    #: Ambient air, air in the scavenge box, gas before the turbine: absolute pressure [Pa] and temperature [K]
    p_1: float
    T_1: float
    p_s: float
    T_s: float
    p_r: float
    T_r: float
    p_b: float  #: Behind the turbine [Pa]
    T_evc: float  #: When the exhaust closes [K]
    ratio: float  #: Pressure ratio of the compressor [-]
    #: Mass flows of air and fuel [kg/s]
    air: float
    fuel: float
    delivery: float  #: Delivery ratio [-]
    residual: float  #: Share of gas that stays in the cylinder, by volume [-]
    #: Indicated work, compressor, turbine, blower [W]; heat out of the cooler and into the engine's coolant [W]
    indicated: float
    compressor: float
    turbine: float
    blower: float
    cooler: float
    walls: float
    heat: float  #: Of the fuel [W]
    mass_residual: float  #: What turbine and engine disagree about, by the flow [-]
    #: Of the whole engine, ambient air and fuel to exhaust, by the fuel's heat [-]
    energy_residual: float
    dew: float | None  #: Dew point in the scavenge box; None for dry air [K]


class _Charge(NamedTuple):
    """What a scavenge pressure means for the cycle and the air, before the flow is known."""

    p_s: float
    ratio: float
    T_2: float  # behind the compressor [K]
    T_s: float
    lift: float  # rise of temperature in the blower [K]
    rise: float  # burnt gas at scavenge pressure by the trapped temperature [-]
    # rise of temperature that the mean pressure needs: by the trapped temperature [-], times the trapped mass [kg K]
    heating: float
    needed: float
    filling: float  # p_evc V_evc [J]


class _Flow(NamedTuple):
    """Flows [kg/s] and temperatures [K] at a pressure before the turbine."""

    air: float
    fuel: float
    through: float  # what the turbine takes [kg/s]
    T_r: float
    T_evc: float
    delivery: float


class _Engine(NamedTuple):
    s: Scavenging
    cycle: TwoStrokeMarine
    room: Chamber
    omega: float
    area: float
    ambient: tuple[float, float]
    #: Mean pressure, and pressure when the exhaust opens, by p_evc: without fuel, and slope over T_ref/T_comp [-]
    mean: tuple[float, float]
    release: tuple[float, float]

    @property
    def rate(self) -> float:
        """Cycles in a second [1/s]."""
        return self.omega / (2 * math.pi)

    @property
    def indicated(self) -> float:
        """Indicated power [W]."""
        return self.cycle.mean_indicated_pressure * float(self.room.displacement) * self.rate

    @property
    def behind(self) -> float:
        """Pressure behind the turbine [Pa]."""
        return self.ambient[0] + self.s.stack_loss


def scavenge(s: Scavenging, cycle: TwoStrokeMarine, room: Chamber, omega: RadPerSecond) -> ScavengeState:
    """The steady balance of a cylinder and its share of the turbocharger.

    Raises BadInput: the exhaust does not drive the turbocharger at any scavenge pressure, or does so at every one.
    """
    p_1, T_1 = atmosphere(s.altitude)
    ambient = (p_1, T_1 if s.ambient_temperature is None else s.ambient_temperature)
    area = flow_area(s, (cycle.evo, cycle.evc, cycle.spo), room)
    engine = _Engine(s, cycle, room, omega, area, ambient, *_by_pressure(cycle, room))
    lowest = p_1 - s.cooler_loss + s.blower_pressure
    trials = lowest + np.geomspace(2e-3, 1.0, _TRIALS) * (_HIGHEST - lowest)
    surplus = [_surplus(engine, float(p)) for p in trials]
    stable = [i for i in range(_TRIALS - 1) if surplus[i] > 0 >= surplus[i + 1]]
    if not stable:
        raise BadInput(_no_balance(engine, surplus))
    at = stable[-1]
    p_s = root(lambda p: _surplus(engine, p), trials[at], trials[at + 1], xtol=1e-9, rtol=1e-14)
    return _state(engine, _charge(engine, p_s))


def _no_balance(engine: _Engine, surplus: list[float]) -> str:
    if surplus[-1] > 0:
        return (f"scavenging.turbine_area: the turbocharger has power to spare up to {_HIGHEST / 1e5:g} bar; widen "
                "turbine_area, or lower the efficiencies")  # fmt: skip
    return (
        f"scavenging: the exhaust drives the turbocharger at no scavenge pressure at "
        f"{engine.omega * 30 / math.pi:.4g} rpm and {engine.cycle.mean_indicated_pressure / 1e5:.3g} bar; narrow "
        "turbine_area, widen ports and valve, raise blower_pressure or the efficiencies"
    )


def _charge(engine: _Engine, p_s: float) -> _Charge:
    s, cycle, (p_1, T_1) = engine.s, engine.cycle, engine.ambient
    before = p_s - s.blower_pressure
    ratio = (before + s.cooler_loss) / p_1
    T_2 = compressor_temperature(T_1, ratio, s.compressor_efficiency, _GAMMA)
    cold = T_2 - s.intercooler * (T_2 - s.coolant_temperature)
    T_s = compressor_temperature(cold, p_s / before, s.blower_efficiency, _GAMMA)
    v_evc, v_evo = (float(volume(engine.room, a)) for a in (cycle.evc, cycle.evo))
    p_evc = scavenging_pressure(p_s)
    hotter = (cycle.mean_indicated_pressure / p_evc - engine.mean[0]) / engine.mean[1]  # T_ref/T_comp - 1
    p_evo = engine.release[0] + engine.release[1] * hotter  # by p_evc
    heating = (v_evc / float(engine.room.clearance)) ** (cycle.n_c - 1) * hotter
    filling = p_evc * v_evc
    return _Charge(
        p_s=p_s, ratio=ratio, T_2=T_2, T_s=T_s, lift=T_s - cold, heating=heating, filling=filling,
        rise=p_evo * v_evo / v_evc * p_evo ** (-(_GAMMA_E - 1) / _GAMMA_E), needed=filling / cycle.R * heating,
    )  # fmt: skip


def _by_pressure(cycle: TwoStrokeMarine, room: Chamber) -> tuple[tuple[float, float], tuple[float, float]]:
    """The pressures of the cycle are all proportional to p_evc, and linear in the temperature of the expansion."""
    solve(cycle, room)  # what is wrong with the cycle itself is said in its own words
    p_evc, rows = scavenging_pressure(cycle.p_s), []
    for ratio in (1.0, 2.0):
        p = absolute_pressure(cycle, room, ratio)
        mean = mean_indicated_pressure(p, 2 * math.pi, kinks(cycle), room)
        rows.append((mean / p_evc, float(p(cycle.evo)) / p_evc))
    (mean_1, evo_1), (mean_2, evo_2) = rows
    return (mean_1, mean_2 - mean_1), (evo_1, evo_2 - evo_1)


def _flow(engine: _Engine, c: _Charge, p_r: float) -> _Flow:
    s = engine.s
    air = float(orifice_flow(engine.area, (c.p_s, c.T_s), (p_r, c.T_s), _GAMMA, _R))
    delivery = air / engine.rate * _R * c.T_s / c.filling
    stays = remaining(delivery, s.displaced)
    mixed = trapped_temperature(c.T_s + s.warming, stays, c.rise) if stays < 1 else math.inf
    T_evc, cycle = min(mixed, _HOTTEST), engine.cycle
    # as the cycle counts it: m_f = m c_v dT/(lhv - c_v dT)
    fuel = engine.rate * c.needed * cycle.c_v / max(cycle.lhv - cycle.c_v * c.heating * T_evc, 1.0)
    heat = fuel * cycle.lhv * (1 - s.heat_share) - engine.indicated
    T_r = _T_0 + (heat + air * _CP * (c.T_s - _T_0)) / ((air + fuel) * _CP_E)
    through = float(orifice_flow(s.turbine_area, (p_r, T_r), (engine.behind, T_r), _GAMMA_E, _R_E)) if T_r > 0 else 0.0
    return _Flow(air, fuel, through, T_r, T_evc, delivery)


def _receiver(engine: _Engine, c: _Charge) -> float | None:
    """Pressure before the turbine that lets through what the engine gives [Pa]; None where nothing is scavenged."""
    low, high = engine.behind, c.p_s * (1 - 1e-9)

    def rest(p_r: float) -> float:
        flow = _flow(engine, c, p_r)
        return flow.air + flow.fuel - flow.through

    return root(rest, low, high, xtol=1e-9, rtol=1e-15) if low < high and rest(high) < 0 else None


def _surplus(engine: _Engine, p_s: float) -> float:
    """Power of turbine less compressor at a scavenge pressure [W]."""
    c = _charge(engine, p_s)
    p_r = _receiver(engine, c) if c.needed > 0 else None  # a cycle that needs no fuel gives none to the turbine
    if p_r is None:
        return -1.0
    flow = _flow(engine, c, p_r)
    return engine.s.shaft_efficiency * _turbine(engine, p_r, flow) - flow.air * _CP * (c.T_2 - engine.ambient[1])


def _turbine(engine: _Engine, p_r: float, flow: _Flow) -> float:
    drop = 1 - (engine.behind / p_r) ** ((_GAMMA_E - 1) / _GAMMA_E)
    return flow.through * _CP_E * flow.T_r * engine.s.turbine_efficiency * drop


def _state(engine: _Engine, c: _Charge) -> ScavengeState:
    s, (p_1, T_1), p_r = engine.s, engine.ambient, _receiver(engine, c)
    assert p_r is not None
    flow, lhv = _flow(engine, c, p_r), engine.cycle.lhv
    if flow.T_evc >= _HOTTEST:
        raise BadInput(
            f"scavenging: {flow.delivery:.2g} times the cylinder's volume of air goes through it in a turn, which "
            "leaves it full of burnt gas; widen port_width, valve_diameter or valve_lift, or the turbine"
        )
    cold = c.T_s - c.lift
    state = ScavengeState(
        p_1=p_1, T_1=T_1, p_s=c.p_s, T_s=c.T_s, p_r=p_r, T_r=flow.T_r, p_b=engine.behind, T_evc=flow.T_evc,
        ratio=c.ratio, air=flow.air, fuel=flow.fuel, delivery=flow.delivery,
        residual=remaining(flow.delivery, s.displaced),
        indicated=engine.indicated, compressor=flow.air * _CP * (c.T_2 - T_1), turbine=_turbine(engine, p_r, flow),
        blower=flow.air * _CP * c.lift, cooler=flow.air * _CP * (c.T_2 - cold), 
        walls=s.heat_share * flow.fuel * lhv,
        heat=flow.fuel * lhv, mass_residual=abs(1 - (flow.air + flow.fuel) / flow.through),
        energy_residual=0.0, dew=dew_point(c.p_s, engine.ambient, s.humidity) if s.humidity > 0 else None,
    )  # fmt: skip
    return dataclasses.replace(state, energy_residual=_left_over(state, s.shaft_efficiency))


def _left_over(state: ScavengeState, shaft: float) -> float:
    """What the balance from ambient air and fuel to the exhaust behind the turbine leaves over, by the heat [-]."""
    flow = state.air + state.fuel
    T_4 = state.T_r - state.turbine / (flow * _CP_E)
    given = state.air * _CP * (state.T_1 - _T_0) + state.heat + state.blower
    taken = state.indicated + state.walls + state.cooler + (1 - shaft) * state.turbine + flow * _CP_E * (T_4 - _T_0)
    return abs(given - taken) / state.heat


class MarineGas(CylinderGas):
    """Gas of the two-stroke marine cycle; where `[scavenging]` has a turbocharger, at the charge that it gives."""

    def charged(self, omega: float) -> tuple[TwoStrokeMarine, ScavengeState | None]:
        """The cycle with p_s and T_evc from its turbocharger at a speed [rad/s]. Raises BadInput: no balance."""
        section: Scavenging | None = self.parts.section("scavenging")
        if section is None or section.source != "turbocharger":
            return self.cycle, None
        state = _balance(section, self.cycle, self.parts, omega)
        return dataclasses.replace(self.cycle, p_s=state.p_s, T_evc=state.T_evc), state

    def p_back(self, omega: float) -> float:
        """Absolute pressure under the piston [Pa] at a speed [rad/s]."""
        return back_pressure(self.charged(omega)[0])

    def pressure(self, room: Chamber, omega: float) -> tuple[Pressure, dict[str, float]]:
        """Pressure at a speed [rad/s], the fuel that its heat asks for, and what the turbocharger does."""
        cycle, state = self.charged(omega)
        pressure = two_stroke_pressure(cycle, room)
        burnt = burnt_angles(cycle, math.inf)
        if state is None:  # the fuel that the temperature rise asks for
            closed = solve(cycle, room)
            work = cycle.mean_indicated_pressure * room.displacement
            return pressure, burnt | {"sfc_g_kwh": 3.6e9 * closed.fuel / work, "efficiency": closed.efficiency}
        return dataclasses.replace(pressure, facts=(*pressure.facts, *_facts(state))), burnt | _columns(state)


@functools.lru_cache(maxsize=64)
def _balance(section: Scavenging, cycle: TwoStrokeMarine, parts: EngineParts, omega: float) -> ScavengeState:
    return scavenge(section, cycle, chamber_over(parts.travel, cycle.bore, cycle.compression_ratio), omega)


def _facts(state: ScavengeState) -> tuple[str, ...]:
    """How the turbocharger runs, in sentences."""
    return (
        f"turbocharger: scavenge air {quantity_text(state.p_s, 'Pa', 4)} and {state.T_s:.0f} K, before the turbine "
        f"{quantity_text(state.p_r, 'Pa', 4)} and {state.T_r:.0f} K, compressor ratio {state.ratio:.2f}",
        f"scavenging: {state.delivery:.2f} times the cylinder's volume of air, {100 * state.residual:.0f} % stays "
        f"burnt gas; the exhaust closes on {state.T_evc:.0f} K",
        f"mean-value balance: mass closed to {state.mass_residual:.1g}, energy to {state.energy_residual:.1g}",
    )


def _columns(s: ScavengeState) -> dict[str, float]:
    heat, work = s.walls / s.heat, s.indicated / s.heat
    row = {
        "sfc_g_kwh": 3.6e9 * s.fuel / s.indicated, "efficiency": work, "heat": heat, "work": work,
        "exhaust": 1 - heat - work, "unburnt": 0.0, "p_in_kpa": s.p_s / 1e3, "t_in_k": s.T_s,
        "p_out_kpa": s.p_r / 1e3, "t_turbine_k": s.T_r, "t_evc_k": s.T_evc, "delivery_ratio": s.delivery,
        "residual_gas": s.residual, "compressor_ratio": s.ratio, "air_kg_h": s.air * 3600,
        "energy_residual": s.energy_residual, "mass_residual": s.mass_residual,
    }  # fmt: skip
    return row if s.dew is None else row | {"dew_margin_k": s.T_s - s.dew}
