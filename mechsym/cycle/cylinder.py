"""Gas of cycles to which a cylinder is enough: the force on its piston at a speed, figures over the speeds."""

import dataclasses
import functools
import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import Chamber, Motion, chamber_over, piston_force, travel
from mechsym.cycle.friction import NoFriction, brake_figures, friction_pressure
from mechsym.cycle.gas import Gas, Pressure
from mechsym.cycle.source import EngineParts, FiguresPage, Progress, unseen
from mechsym.files import Json
from mechsym.quantities import RPM
from mechsym.quantities.display import ratio_text

_SHARES = ("heat", "work", "exhaust", "unburnt")
_UNKNOWN = dict.fromkeys(("sfc_g_kwh", "efficiency", "energy_residual", *_SHARES), math.nan)  # without fuel
_POINTS = 1441
_COLD_AIR = 1.4  # no mixture of air, fuel and products has more


def _closing(found: Json) -> str:
    worst = abs(found["energy_residual"]).max()
    if worst != worst:
        known = np.isfinite(found["sfc_g_kwh"]).all()
        fuel = "fuel as the temperature rise asks for, without heat to the walls" if known else "no fuel is known"
        return f"an algebraic cycle: {fuel}, no first law to close"
    return f"first law closed to {ratio_text(worst, 1)} of the fuel's heating value"


BRAKE = ("speed_rpm", "brake_mep_kpa", "brake_sfc_g_kwh", "brake_power_kw", "brake_torque", "brake_efficiency",
         "mechanical_efficiency")  # fmt: skip
INDICATED = ("speed_rpm", "mep_kpa", "gross_mep_kpa", "pumping_mep_kpa", "friction_mep_kpa", "sfc_g_kwh", "power_kw",
             "torque_avg", "efficiency")  # fmt: skip
IN_CYLINDER = ("speed_rpm", "p_max_mpa", "p_max_angle_deg", "ca10_deg", "ca50_deg", "ca90_deg", "torque_max")
ENGINE_PAGE = FiguresPage(
    tables=(("brake", BRAKE), ("indicated", INDICATED), ("combustion, and largest torque", IN_CYLINDER)),
    closing=_closing,
    peaks=True,
)


def otto_bound(compression_ratio: float, gamma: float = _COLD_AIR) -> float:
    r"""Efficiency of the Otto cycle [-], by default with the most that a gas can have.

    .. math:: \eta = 1 - \varepsilon^{1-\gamma}
    """
    return float(1 - compression_ratio ** (1 - gamma))


class CylinderGas:
    """Gas of a cycle to which a cylinder is enough: a kind says `pressure`, and what else differs.

    cycle: with `bore`, `compression_ratio` and `p_back`; moved: crank angle [rad] to `x` [m] and `dx_dphi` [m/rad] of a
    piston, in place of that of the parts.
    """

    page = ENGINE_PAGE

    def __init__(self, cycle: Any, parts: EngineParts, moved: ca.Function | None = None) -> None:
        self.cycle, self.parts, self._moved = cycle, parts, moved

    def pressure(self, room: Chamber, omega: float) -> tuple[Pressure, dict[str, float]]:
        """Pressure at a speed [rad/s], and by the names of the columns what is known of the fuel."""
        raise NotImplementedError

    def p_back(self, omega: float) -> float:
        """Absolute pressure behind the piston [Pa] at a speed [rad/s]."""
        return float(self.cycle.p_back)

    @functools.cached_property
    def travel(self) -> ca.Function:
        """Travel of the piston."""
        return self.parts.travel if self._moved is None else self._moved

    def at(self, omega: float) -> Gas:
        """Gas at a speed [rad/s]."""
        room = self._room(omega)
        return Gas(pressure=self.pressure(room, omega)[0], chamber=room)

    def figures(self, omega: np.ndarray, progress: Progress = unseen) -> Json:
        """Figures of one cylinder over speeds [rad/s]; nan of the fuel where the cycle knows none."""
        rows = []
        for speed in map(float, omega):
            rows.append(self._row(speed))
            progress(1)
        columns = {key: np.array([row[key] for row in rows]) for key in rows[0]}
        fractions = {name: columns.pop(name) for name in _SHARES}
        return {"speed_rpm": omega / RPM} | columns | {"fractions": fractions, "loads": {}}

    def curves(self, omega: np.ndarray, operating: float) -> dict[str, np.ndarray]:
        """None at any speed [rad/s]: the gas tells its pressure itself."""
        return {}

    def picture(self, path: Path, curves: Mapping[str, np.ndarray]) -> Path:
        """Nothing is drawn without curves."""
        raise NotImplementedError

    @property
    def bound(self) -> float | None:
        """Efficiency that no such cycle exceeds [-]."""
        return otto_bound(self.cycle.compression_ratio)

    def _room(self, omega: float) -> Chamber:
        return chamber_over(self.travel, self.cycle.bore, self.cycle.compression_ratio, self.p_back(omega))

    def _row(self, omega: float) -> Json:
        room = self._room(omega)
        pressure, fuel = self.pressure(room, omega)
        work = pressure.mean_indicated * room.displacement
        phi = np.linspace(-math.pi, math.pi, _POINTS)
        # the same chamber over a piston with its mass, for the largest force
        heavy = dataclasses.replace(room, motion=self._motion)
        force = piston_force(heavy, phi, omega, pressure.absolute(phi))
        row = {
            "torque_avg": work / (2 * math.pi), "torque_max": float(np.max(force * travel(heavy.motion, phi)[1])),
            "power_kw": work * omega / (2 * math.pi) / 1e3, "mep_kpa": pressure.mean_indicated / 1e3,
            "p_max_mpa": pressure.p_max / 1e6, "p_max_angle_deg": math.degrees(pressure.phi_p_max),
            "t_max_k": pressure.t_max, "force_max": float(np.max(force)),
        } | _UNKNOWN | fuel  # fmt: skip
        law = self.parts.friction
        if isinstance(law, NoFriction):
            return row
        lost = float(friction_pressure(law, pressure.p_max, room.stroke * omega / math.pi, omega))
        burnt = (row["sfc_g_kwh"] * work / 3.6e9, work / row["efficiency"])
        return row | brake_figures(work, lost, room.displacement, 2 * math.pi, omega, burnt)

    @functools.cached_property
    def _motion(self) -> Motion:
        return self.parts.motion
