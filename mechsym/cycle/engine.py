"""What an engine does over its speeds and other values, by the method that its cycle names."""

import math
from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import cached_property, partial
from pathlib import Path

import numpy as np

from mechsym.cycle.chamber import Chamber, chamber, piston_force, travel, volume
from mechsym.cycle.closed.model import ClosedEngine, check_blowdown, closed_period, open_period
from mechsym.cycle.closed.performance import Performance, performance
from mechsym.cycle.closed.run import FINE, ClosedCurves, closed_curves, run
from mechsym.cycle.friction import mechanical_efficiency
from mechsym.cycle.gas import Gas
from mechsym.cycle.heat import ConstantGamma
from mechsym.cycle.kinds.printed import marched, performance_printed
from mechsym.cycle.kinds.spark_ignition import SparkIgnition
from mechsym.cycle.pressure import periodic, pressure_over
from mechsym.cycle.source import ENGINE_PAGE, EngineParts, Progress, otto_bound, unseen
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.periodic.pieces import PPoly
from mechsym.periodic.roots import root
from mechsym.quantities import RPM
from mechsym.quantities.display import quantity_text
from mechsym.quantities.units import Array, Radian, RadPerSecond

_BLOCK = 1000
_STEP = math.radians(0.25)  # of the angles at which the highest temperature is looked for


def over_speeds(engine: ClosedEngine, omega: RadPerSecond[Array], progress: Progress = unseen) -> Performance:
    """Figures over the speeds, by the method that the cycle names. progress: called after each block of points."""
    return over_design(engine, {"omega": omega}, progress)


def over_design(engine: ClosedEngine, design: Mapping[str, np.ndarray], progress: Progress = unseen) -> Performance:
    """Figures over any of the engine's values, by the method that the cycle names.

    design: mapping of str to ndarray, shape (n,), operating points, see `model.design_names`; must hold `omega`
    [rad/s]. progress: called with the number of points done after each block of them. Raises BadInput: the printed
    method knows no other variable than the speed.
    """
    printed = engine.cycle.method == "nunes2017_printed"
    if printed and set(design) != {"omega"}:
        raise BadInput("method = 'nunes2017_printed' runs over the speed alone; set cycle.method = 'converged'")
    points = dict(zip(design, np.broadcast_arrays(*(np.atleast_1d(v) for v in design.values())), strict=True))
    parts = []
    # blocks keep the memory of a large map small and cost nothing
    for first in range(0, points["omega"].size, _BLOCK):
        block = {name: values[first : first + _BLOCK] for name, values in points.items()}
        parts.append(performance_printed(engine, block["omega"]) if printed else performance(engine, block))
        progress(block["omega"].size)
    return parts[0] if len(parts) == 1 else _joined(parts)


def _joined(parts: list[Performance]) -> Performance:
    values: Json = {}
    for name in (f.name for f in fields(Performance)):
        curves = [getattr(part, name) for part in parts]
        named = isinstance(curves[0], Mapping)
        values[name] = (
            {k: np.concatenate([c[k] for c in curves]) for k in curves[0]} if named else np.concatenate(curves)
        )
    return Performance(**values)


def columns(result: Performance) -> Json:
    """Figures by names and units of the command line: `speed_rpm`, ...; `fractions` and `loads` are mappings."""
    shares = {name: getattr(result, name) for name in ("heat", "work", "exhaust", "unburnt")}
    return {
        "speed_rpm": result.omega / RPM,
        "torque_avg": result.torque_avg,
        "torque_max": result.torque_max,
        "power_kw": result.power / 1e3,
        "mep_kpa": result.mep / 1e3,
        "gross_mep_kpa": (result.mep - result.pumping_mep) / 1e3,
        "pumping_mep_kpa": result.pumping_mep / 1e3,
        "sfc_g_kwh": result.sfc * 3.6e9,
        "efficiency": result.efficiency,
        "p_max_mpa": result.p_max / 1e6,
        "p_max_angle_deg": np.degrees(result.p_max_angle),
        **result.burnt,
        "t_max_k": result.t_max,
        "knock": result.knock,
        "force_max": result.force_max,
        "fractions": shares,
        "loads": result.loads,
        "friction_mep_kpa": result.friction_mep / 1e3,
        "brake_mep_kpa": (result.mep - result.friction_mep) / 1e3,
        "brake_torque": result.brake_torque,
        "brake_power_kw": result.brake_power / 1e3,
        "brake_sfc_g_kwh": result.brake_sfc * 3.6e9,
        "brake_efficiency": result.brake_efficiency,
        "mechanical_efficiency": mechanical_efficiency(result.brake_power, result.power),
        "energy_residual": result.energy_residual,
    }


def curves(engine: ClosedEngine, omega: RadPerSecond, step: Radian = np.radians(0.5)) -> dict[str, np.ndarray]:
    """The closed period at one speed, curve by curve.

    step: distance of the angles; the printed method keeps its whole degrees. Returns curves: `phi_deg` from firing top
    dead centre, `p_pa`, `t_k`, `v_m3`, `force_n` and `torque_nm` of one piston, shape (k,).
    """
    room = chamber(engine.chamber, engine.motion)
    if engine.cycle.method == "nunes2017_printed":
        result = marched(engine, np.array([omega]))
        phi, p, t = np.radians(result.theta_deg - 360.0), result.p[:, 0], result.t[:, 0]
    else:
        phi, p, t = closed_at(engine, omega).even(step)
    force = piston_force(room, phi, omega, p)
    return {
        "phi_deg": np.degrees(phi),
        "p_pa": p,
        "t_k": t,
        "v_m3": volume(room, phi),
        "force_n": force,
        "torque_nm": force * travel(room.motion, phi)[1],
    }


def closed_at(engine: ClosedEngine, omega: RadPerSecond) -> ClosedCurves:
    """Pressure and temperature of the closed period at one speed."""
    return closed_curves(run(partial(closed_period, engine), {"omega": omega}, FINE))


_PERIOD = 4 * math.pi


def gas_of_engine(engine: ClosedEngine, omega: RadPerSecond) -> Gas:
    """Gas of an engine at one speed."""
    room, charge = chamber(engine.chamber, engine.motion), engine.cycle
    closed, events, warm = _closed_period(engine, omega)
    left, gamma, last, behind = charge.intake_pressure, 1.0, charge.exhaust_opens, None
    fact = "gas exchange takes place at intake pressure: assumed, the cycle models the closed period only"
    if engine.blowdown is not None:
        exchange = open_period(partial(closed_period, engine), {"omega": np.array([omega])}, warm[-1:])
        once = np.append(np.diff(exchange.phi[0]) > 0, True)
        behind = PPoly.spline(exchange.phi[0, once], exchange.p[0, once])
        left, gamma, last = float(exchange.p[0, -1]), float(exchange.gamma[0]), float(exchange.phi[0, -1])
        events = (*events, 2 * math.pi, _drawn_from(room, left / charge.intake_pressure, gamma))
        against, before = (quantity_text(value, "Pa") for value in (engine.blowdown.pressure, charge.intake_pressure))
        fact = f"the exhaust blows down through its valve against {against}; fresh gas comes in at {before}: assumed"

    def cycle(angle: np.ndarray) -> np.ndarray:
        angle = np.asarray(angle, dtype=float)
        # what is left in the clearance expands until fresh gas comes in
        drawn = np.maximum(charge.intake_pressure, left * (room.clearance / np.asarray(volume(room, angle))) ** gamma)
        p = closed(angle) if behind is None else np.where(angle <= charge.exhaust_opens, closed(angle), behind(angle))
        return np.where((angle >= charge.inlet_closes) & (angle <= last), p, drawn)

    absolute = periodic(cycle, _PERIOD, -2 * math.pi)  # from the dead centre of gas exchange on
    # where the pressure jumps, or its slope
    kinks = tuple(sorted(angle % _PERIOD for angle in events))
    pressure = pressure_over("spark-ignition", absolute, _PERIOD, kinks, room, t_max=float(warm.max()), facts=(fact,))
    return Gas(pressure=pressure, chamber=room)


def _closed_period(
    engine: ClosedEngine, omega: RadPerSecond
) -> tuple[Callable[[np.ndarray], np.ndarray], tuple[float, ...], np.ndarray]:
    """Pressure over the angle [Pa], angles of the events [rad], and temperatures on even angles [K]."""
    cycle = engine.cycle
    events = (cycle.exhaust_opens, cycle.inlet_closes)
    if cycle.method == "nunes2017_printed":
        printed = curves(engine, omega)
        phi = np.radians(printed["phi_deg"])
        return lambda angle: np.interp(angle, phi, printed["p_pa"]), events, printed["t_k"]
    whole = closed_at(engine, omega)
    starts = (phase.first for phase in whole.phases[1:])
    return lambda angle: whole.at(angle)[0], (*events, *starts), whole.even(_STEP)[2]


def _drawn_from(room: Chamber, ratio: float, gamma: float) -> float:
    """Angle at which what is left in the clearance has fallen to intake pressure, and fresh gas comes in [rad]."""
    wanted = room.clearance * ratio ** (1 / gamma)
    angle = root(lambda phi: float(volume(room, phi)) - wanted, 0.0, math.pi, xtol=1e-14)
    return float(2 * math.pi + angle)


class SparkGas:
    """Gas of spark ignition, whose closed period is integrated."""

    page = ENGINE_PAGE

    def __init__(self, cycle: SparkIgnition, parts: EngineParts) -> None:
        self.cycle, self.parts = cycle, parts

    @cached_property
    def engine(self) -> ClosedEngine:
        """The engine, for what follows the motion or a design."""
        valve = self.parts.section("blowdown")
        if valve is not None:
            check_blowdown(valve, self.cycle.intake_pressure)
        return ClosedEngine(
            chamber=self.parts.section("chamber"),
            motion=self.parts.motion,
            cycle=self.cycle,
            gas=self.parts.section("gas", ConstantGamma()),
            heat_transfer=self.parts.section("heat_transfer"),
            friction_pressure=self.parts.friction,
            blowdown=valve,
        )

    def at(self, omega: float) -> Gas:
        """Gas at a speed [rad/s]."""
        return gas_of_engine(self.engine, omega)

    def figures(self, omega: np.ndarray, progress: Progress = unseen) -> Json:
        """Figures of one cylinder over speeds [rad/s]."""
        return columns(over_speeds(self.engine, omega, progress))

    def curves(self, omega: np.ndarray, operating: float) -> dict[str, np.ndarray]:
        """The closed period at the speed of operation [rad/s]."""
        return curves(self.engine, operating)

    def picture(self, path: Path, curves: Mapping[str, np.ndarray]) -> Path:
        """Draw the closed period."""
        from mechsym.cycle.plots import cycle_picture  # who draws nothing does not load what draws

        return cycle_picture(path, curves)

    @property
    def bound(self) -> float | None:
        """Efficiency of the Otto cycle with this charge [-]."""
        gas, ratio = self.parts.section("gas", ConstantGamma()), self.parts.section("chamber").compression_ratio
        return otto_bound(ratio, gas.gamma) if isinstance(gas, ConstantGamma) else otto_bound(ratio)
