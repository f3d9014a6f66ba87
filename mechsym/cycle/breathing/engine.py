r"""An engine that breathes: its balance with the turbocharger, pressure over the angle, figures over the speeds.

.. math:: p_{mi} = W/V_d, \quad p_{mp} = W_{exchange}/V_d, \quad p_{me} = p_{mi} - p_{mf}, \quad
          \eta = W/(m_f Q_{HV}), \quad m_f = m_{drawn}/(1 + AFR), \quad \eta_v = m_{drawn} R T_{in}/(p_{in} V_d)

One book of fresh gas: what is drawn gives air, fuel and filling (Heywood 1988, eq. 2.27); of it burns what is trapped,
`trapping_efficiency`, and what is lost through the exhaust is unburnt fuel.

The work of the two strokes of gas exchange is part of the mean indicated pressure (net), and so of all brake figures.
"""

import itertools
import math
from collections.abc import Callable, Mapping, Sequence
from functools import cached_property
from pathlib import Path

import numpy as np

from mechsym.cycle.breathing.flow import PERIOD, Breath, Breathing, GasExchange, HeatSink, Surroundings, charge
from mechsym.cycle.breathing.run import Cylinder, breathe
from mechsym.cycle.breathing.turbocharger import Boost, Boosted, atmosphere, boosted
from mechsym.cycle.chamber import Chamber, ChamberParameters, Motion, chamber, piston_force, travel, volume
from mechsym.cycle.friction import Friction, NoFriction, brake_figures, friction_pressure
from mechsym.cycle.gas import Gas
from mechsym.cycle.heat import Adiabatic, Law
from mechsym.cycle.knock import knock_along
from mechsym.cycle.plots import breathing_picture
from mechsym.cycle.pressure import Pressure, peak, periodic, pressure_over
from mechsym.cycle.source import ENGINE_PAGE, EngineParts, FiguresPage, Progress, otto_bound, unseen
from mechsym.cycle.wiebe import BURNT, burnt_at
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import RPM, record
from mechsym.quantities.display import residual_text
from mechsym.quantities.units import Scalar


@record
class BreathingEngine:
    """An engine of a case: its sections, and the motion of its piston."""

    chamber: ChamberParameters
    motion: Motion
    cycle: GasExchange
    breathing: Breathing
    boost: Boost | None = None
    heat_transfer: Law = Adiabatic()
    friction_pressure: Friction = NoFriction()


@record
class BreathingRun:
    """An engine at its speeds."""

    engine: BreathingEngine
    chamber: Chamber
    breaths: list[Breath]
    around: Surroundings
    boosted: Boosted | None  #: State that the turbocharger leaves, where there is one


def run(engine: BreathingEngine, omega: Sequence[float]) -> BreathingRun:
    """The periodic cycles at crank speeds [rad/s], in balance with the turbocharger."""
    room, b = chamber(engine.chamber, engine.motion), engine.breathing
    _check(engine)
    walls = HeatSink(law=engine.heat_transfer, bore=room.bore, stroke=room.stroke, displacement=room.displacement)
    cylinder = Cylinder(breathing=b, charge=charge(engine.cycle), volume=lambda phi: volume(room, phi), walls=walls)
    outside = atmosphere(b.altitude)
    if engine.boost is None:
        around = _around(b, outside[0], outside[1], outside[0])
        return BreathingRun(
            engine=engine, chamber=room, breaths=breathe(cylinder, around, omega), around=around, boosted=None
        )
    last: list[tuple[Surroundings, list[Breath]]] = []

    air = engine.cycle.air_fuel_ratio / (1 + engine.cycle.air_fuel_ratio)

    def answer(state: Boosted) -> tuple[np.ndarray, np.ndarray]:
        around = _around(b, state.p_2, state.T_2, state.p_3)
        last[:] = [(around, breathe(cylinder, around, omega))]
        drawn = np.array([breath.drawn * breath.omega / PERIOD for breath in last[0][1]])
        return np.array([breath.T_exhaust for breath in last[0][1]]), drawn * air

    state = boosted(engine.boost, outside, answer, len(omega))
    return BreathingRun(engine=engine, chamber=room, breaths=last[0][1], around=last[0][0], boosted=state)


def _around(b: Breathing, p_in: Scalar, T_in: Scalar, p_out: Scalar) -> Surroundings:
    return Surroundings(
        p_in=p_in if b.inlet_pressure is None else b.inlet_pressure,
        T_in=T_in if b.inlet_temperature is None else b.inlet_temperature,
        p_out=p_out if b.exhaust_pressure is None else b.exhaust_pressure,
    )


def _check(engine: BreathingEngine) -> None:
    b, c = engine.breathing, engine.cycle
    given = [
        name for name in ("inlet_pressure", "inlet_temperature", "exhaust_pressure") if getattr(b, name) is not None
    ]
    if engine.boost is not None and given:
        raise BadInput(f"breathing.{given[0]} and [boost] both say what is before the engine; leave one of them out")
    for name, late in (("exhaust", b.exhaust_opens > b.exhaust_closes), ("inlet", b.inlet_opens > b.inlet_closes)):
        if late:
            raise BadInput(f"breathing.{name}_opens is after breathing.{name}_closes; angles count from firing TDC")
    ends, opens = c.ignition + c.duration, b.exhaust_opens
    if ends > opens:
        raise BadInput(
            f"combustion ends at {math.degrees(ends):.1f} deg, after the exhaust opens at {math.degrees(opens):.1f} "
            "deg; change cycle.ignition, cycle.duration or breathing.exhaust_opens"
        )
    if c.ignition + PERIOD < b.inlet_closes:
        raise BadInput("combustion starts before the inlet closes; change cycle.ignition or breathing.inlet_closes")


def pressure(breathed: BreathingRun) -> Pressure:
    """Pressure in the cylinder over the angle, at the first speed."""
    breath, b, c = breathed.breaths[0], breathed.engine.breathing, breathed.engine.cycle
    absolute = _curve(breath)
    events = (b.exhaust_opens, b.exhaust_closes, b.inlet_opens, b.inlet_closes, c.ignition, c.ignition + c.duration)
    kinks = tuple(sorted(float(np.remainder(angle, PERIOD)) for angle in events))
    facts = (
        f"gas exchange at {breath.omega / RPM:.5g} rpm: {100 * breath.volumetric_efficiency:.1f} % of the swept volume "
        f"filled, {100 * breath.residual:.1f} % of the charge is residual gas",
        f"{100 * max(0.0, round(1 - breath.trapping_efficiency, 5)):.2g} % of the fresh gas drawn is lost through the "
        "exhaust",
        f"mass and energy closed to {residual_text(max(breath.mass_residual, breath.energy_residual), 1)}",
    )
    return pressure_over("gas-exchange", absolute, PERIOD, kinks, breathed.chamber, facts=facts)


def _curve(breath: Breath) -> Callable[[Scalar], Scalar]:
    """Pressure in the cylinder at any angle; the cycle repeats but for `closure`, which the last node gives up."""
    p = breath.pressures["cylinder"]
    return periodic(_between(breath, np.append(p[:-1], p[0])), PERIOD, float(breath.phi[0]))


def _between(breath: Breath, values: np.ndarray) -> PPoly:
    # a cubic spline from event to event, so that none rounds off a corner
    parts = [PPoly.spline(breath.phi[a : b + 1], values[a : b + 1]) for a, b in itertools.pairwise(breath.marks)]
    return PPoly(np.concatenate([part.c for part in parts], axis=1), breath.phi)


def figures(breathed: BreathingRun) -> Json:
    """Figures over the speeds under the names of `mechsym cycle`, of one cylinder.

    Returns columns: as `engine.columns`; and the mean pressure of the two strokes of gas exchange, the filling, the
    residual gas, the temperature of the exhaust, and what the turbocharger leaves before and behind the engine, shape
    (n,).
    """
    rows = [_at(breathed, breath) for breath in breathed.breaths]
    columns: Json = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    columns["fractions"] = {name: columns.pop(name) for name in ("heat", "work", "exhaust", "unburnt")}
    n, around = len(rows), breathed.around
    if breathed.boosted is not None:
        columns["t_turbine_k"] = columns["t_exhaust_k"]
        columns["compressor_efficiency"] = breathed.boosted.efficiency
    outside = {"p_in_kpa": np.asarray(around.p_in) / 1e3, "t_in_k": around.T_in,
               "p_out_kpa": np.asarray(around.p_out) / 1e3}  # fmt: skip
    return columns | {name: np.broadcast_to(value, n).astype(float) for name, value in outside.items()} | {"loads": {}}


def _at(breathed: BreathingRun, breath: Breath) -> dict[str, float]:
    engine, room, omega, c = breathed.engine, breathed.chamber, breath.omega, breathed.engine.cycle
    fuel = breath.drawn / (1 + c.air_fuel_ratio)
    energy = fuel * c.heating_value
    p = breath.pressures["cylinder"]
    p_max, phi_max = peak(_curve(breath), PERIOD, ())
    piston_speed = room.stroke * omega / math.pi
    lost = float(friction_pressure(engine.friction_pressure, p_max, piston_speed, omega))
    force = piston_force(room, breath.phi, omega, p)
    per_second, share, unburnt = omega / PERIOD, breath.work / energy, 1 - breath.heat / energy
    return {
        "speed_rpm": omega / RPM, "torque_avg": breath.work / PERIOD,
        "torque_max": float(np.max(force * travel(room.motion, breath.phi)[1])),
        "power_kw": breath.work * per_second / 1e3, "mep_kpa": breath.work / room.displacement / 1e3,
        "gross_mep_kpa": (breath.work - breath.pumping) / room.displacement / 1e3,
        "sfc_g_kwh": 3.6e9 * fuel / breath.work if breath.work > 0 else math.nan, "efficiency": share,
        "p_max_mpa": p_max / 1e6, "p_max_angle_deg": math.degrees(phi_max), "force_max": float(np.max(force)),
        **{name: math.degrees(c.ignition + c.duration * burnt_at(share, c.wiebe_a, c.wiebe_m))
           for name, share in BURNT.items()},
        **brake_figures(breath.work, lost, room.displacement, PERIOD, omega, (fuel, energy)),
        "energy_residual": breath.energy_residual, "mass_residual": breath.mass_residual,
        "pumping_mep_kpa": breath.pumping / room.displacement / 1e3,
        "volumetric_efficiency": breath.volumetric_efficiency, "residual_gas": breath.residual,
        "trapping_efficiency": breath.trapping_efficiency,
        "knock": _knock(breathed, breath),
        "t_max_k": float(breath.temperature.max()), "t_exhaust_k": breath.T_exhaust,
        "air_kg_h": fuel * c.air_fuel_ratio * per_second * 3600,
        "heat": breath.wall_heat / energy, "work": share, "exhaust": 1 - share - unburnt - breath.wall_heat / energy,
        "unburnt": unburnt,
    }  # fmt: skip


def _knock(breathed: BreathingRun, breath: Breath) -> float:
    c, closes = breathed.engine.cycle, breathed.engine.breathing.inlet_closes
    temperature = _between(breath, breath.temperature)
    angles = (closes, PERIOD + c.ignition, PERIOD + c.ignition + c.duration)
    return knock_along((_curve(breath), temperature), angles, breath.omega, (c.gamma - 1) / c.gamma, c.octane)


def curves(breathed: BreathingRun) -> dict[str, np.ndarray]:
    """The cycle at the first speed, curve by curve over the angle from firing top dead centre.

    Returns curves: `phi_deg` from -180 to 540, `p_pa`, `t_k`, `v_m3`, `p_plenum_pa`, `p_manifold_pa`, `force_n` and
    `torque_nm` of one piston, shape (k,).
    """
    breath, room = breathed.breaths[0], breathed.chamber
    phi = np.remainder(breath.phi[:-1] + math.pi, PERIOD) - math.pi
    order = np.argsort(phi)
    force = piston_force(room, phi, breath.omega, breath.pressures["cylinder"][:-1])
    columns = {
        "phi_deg": np.degrees(phi), "p_pa": breath.pressures["cylinder"][:-1], "t_k": breath.temperature[:-1],
        "v_m3": breath.room[:-1], "p_plenum_pa": breath.pressures["plenum"][:-1],
        "p_manifold_pa": breath.pressures["manifold"][:-1], "force_n": force,
        "torque_nm": force * travel(room.motion, phi)[1],
    }  # fmt: skip
    return {name: values[order] for name, values in columns.items()}


def _closing(data: Json) -> str:
    mass, energy = (float(data[f"{name}_residual"].max()) for name in ("mass", "energy"))
    return (
        f"mass closed to {residual_text(mass, 1)} of the charge, first law to {residual_text(energy, 1)} of its energy"
    )


class BreathingGas:
    """Gas of an engine whose gas exchange is followed."""

    page = FiguresPage(
        tables=(
            *ENGINE_PAGE.tables,
            (
                "gas exchange",
                ("speed_rpm", "volumetric_efficiency", "trapping_efficiency", "residual_gas", "air_kg_h", "p_in_kpa",
                 "t_in_k", "p_out_kpa", "t_exhaust_k", "knock"),
            ),
        ),
        closing=_closing,
        peaks=True,
    )  # fmt: skip

    def __init__(self, cycle: GasExchange, parts: EngineParts) -> None:
        self.cycle, self.parts = cycle, parts
        self._runs: dict[tuple[float, ...], BreathingRun] = {}

    @cached_property
    def engine(self) -> BreathingEngine:
        """The engine; without `[heat_transfer]` no heat is lost."""
        return BreathingEngine(
            chamber=self.parts.section("chamber"),
            motion=self.parts.motion,
            cycle=self.cycle,
            breathing=self.parts.section("breathing"),
            boost=self.parts.section("boost"),
            heat_transfer=self.parts.section("heat_transfer", Adiabatic()),
            friction_pressure=self.parts.friction,
        )

    def at(self, omega: float) -> Gas:
        """Gas at a speed [rad/s]."""
        breathed = self._run((omega,))
        return Gas(pressure=pressure(breathed), chamber=breathed.chamber)

    def figures(self, omega: np.ndarray, progress: Progress = unseen) -> Json:
        """Figures of one cylinder over speeds [rad/s]."""
        return figures(self._run(tuple(omega.tolist())))

    def curves(self, omega: np.ndarray, operating: float) -> dict[str, np.ndarray]:
        """The cycle at the first of the speeds [rad/s]."""
        return curves(self._run(tuple(omega.tolist())))

    def picture(self, path: Path, curves: Mapping[str, np.ndarray]) -> Path:
        """Draw the cycle and the lift of its valves."""
        return breathing_picture(path, curves, self.engine.breathing)

    @property
    def bound(self) -> float | None:
        """Efficiency of the Otto cycle with cold air [-]."""
        return otto_bound(self.parts.section("chamber").compression_ratio)

    def _run(self, omega: tuple[float, ...]) -> BreathingRun:
        if omega not in self._runs:
            self._runs[omega] = run(self.engine, omega)
        return self._runs[omega]
