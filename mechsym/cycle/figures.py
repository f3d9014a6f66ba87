"""Figures of the two-stroke cycles, algebraic and integrated, under the names of `mechsym cycle`."""

import dataclasses
import math
from typing import Any

import casadi as ca
import numpy as np

from mechsym.cycle.chamber import Motion, moving_mass, travel
from mechsym.cycle.cylinder import piston_area, swept_volume
from mechsym.cycle.engine import RPM
from mechsym.cycle.kinds import back_pressure, cylinder_pressure
from mechsym.cycle.kinds.two_stroke import TwoStrokeMarine
from mechsym.cycle.kinds.two_stroke_zone import TwoStrokeZone, shares, two_stroke_zone
from mechsym.cycle.motion import motion, piston_travel
from mechsym.errors import BadInput

_SHARES = ("heat", "work", "exhaust", "unburnt")
_POINTS = 1441


def cylinder_columns(cycle: Any, name: str, parameters: Any, omega: np.ndarray) -> dict[str, Any]:
    """Figures of a two-stroke cycle over the speeds.

    Parameters
    ----------
    cycle : TwoStrokeMarine or TwoStrokeZone
        Of another kind it is refused
    name : str
        Name of a mechanism with one piston, which `parameters` belong to
    omega : ndarray, shape (n,)
        Crank speeds; the algebraic cycle does not depend on them [rad/s]

    Returns
    -------
    columns : dict
        As `engine.columns`, of one cylinder; consumption, efficiency and shares are nan for the algebraic cycle, which
        knows no fuel
    """
    if not isinstance(cycle, (TwoStrokeMarine, TwoStrokeZone)):
        raise BadInput(
            "[cycle] is of no kind with figures over the speed; kinds are spark-ignition, "
            "two-stroke-marine, two-stroke-zone and, with --diagram, diagram"
        )
    kinematics, moves = piston_travel(name, parameters), motion(name, dataclasses.asdict(parameters))
    rows = [_at(cycle, kinematics, moves, float(speed)) for speed in omega]
    columns = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    fractions = {name: columns.pop(name) for name in _SHARES}
    return {"speed_rpm": omega / RPM} | columns | {"fractions": fractions, "loads": {}}


def _at(cycle: Any, kinematics: ca.Function, moves: Motion, omega: float) -> dict[str, float]:
    cycle = dataclasses.replace(cycle, speed=omega) if isinstance(cycle, TwoStrokeZone) else cycle
    pressure, cylinder = cylinder_pressure(cycle, kinematics)
    work = pressure.mean_indicated * swept_volume(cylinder)
    torque, force = _extremes(moves, pressure, (piston_area(cylinder.bore), back_pressure(cycle)), omega)
    return {
        "torque_avg": work / (2 * math.pi), "torque_max": torque, "power_kw": work * omega / (2 * math.pi) / 1e3,
        "mep_kpa": pressure.mean_indicated / 1e3, "p_max_mpa": pressure.p_max / 1e6,
        "p_max_angle_deg": math.degrees(pressure.phi_p_max), "force_max": force, **_fuel(cycle, kinematics),
    }  # fmt: skip


def _extremes(moves: Motion, pressure: Any, piston: tuple[float, float], omega: float) -> tuple[float, float]:
    phi = np.linspace(-math.pi, math.pi, _POINTS)
    _, dx, d2x = travel(moves, phi)
    force = (pressure.absolute(phi) - piston[1]) * piston[0] - moving_mass(moves) * d2x * omega**2
    return float(np.max(force * dx)), float(np.max(force))


def _fuel(cycle: Any, kinematics: ca.Function) -> dict[str, float]:
    if not isinstance(cycle, TwoStrokeZone):
        return dict.fromkeys(("sfc_g_kwh", "efficiency", "energy_residual", *_SHARES), math.nan)
    zone = two_stroke_zone(cycle, kinematics)
    found = shares(cycle, zone)
    sfc = 3.6e9 / (found["work"] * cycle.lhv)
    return {
        "sfc_g_kwh": sfc, "efficiency": found["work"], "energy_residual": float(zone.result.residual[0])
    } | found  # fmt: skip
