"""Figures of cycles that need nothing but a cylinder, under the names of `mechsym cycle`."""

import dataclasses
import math
from collections.abc import Mapping
from typing import Any

import numpy as np

from mechsym.cycle.chamber import Chamber, piston_force, travel
from mechsym.cycle.dead_centres import chamber_over
from mechsym.cycle.kinds import KINDS, back_pressure, kind_of
from mechsym.cycle.motion import piston_motion, piston_travel
from mechsym.cycle.pressure import Pressure
from mechsym.errors import BadInput
from mechsym.quantities import RPM, load

_SHARES = ("heat", "work", "exhaust", "unburnt")
_UNKNOWN = ("sfc_g_kwh", "efficiency", "energy_residual", *_SHARES)  # without fuel
_POINTS = 1441


def cylinder_columns(
    cycle: Any,
    name: str,
    parameters: Any,
    omega: np.ndarray,
    guesses: Mapping[str, float] | None = None,
    number: int = 0,
) -> dict[str, Any]:
    """Figures of a cycle that needs nothing but a cylinder, over the speeds.

    Parameters
    ----------
    cycle : record
        Of a kind with figures over the speed; another is refused
    name : str
        Name of a mechanism with one piston, which `parameters` belong to
    omega : ndarray, shape (n,)
        Crank speeds; the algebraic cycle does not depend on them [rad/s]
    guesses : mapping of str to float, optional
        Of coordinates that loops hold [rad] or [m]
    number : int
        Place of the piston's role in the declaration, from 0

    Returns
    -------
    columns : dict
        As `engine.columns`, of one cylinder; consumption, efficiency and shares are nan for the algebraic cycle, which
        knows no fuel
    """
    figures = kind_of(cycle).figures
    if not figures:
        known = sorted(name for name, kind in KINDS.items() if kind.figures or kind.given == "engine")
        raise BadInput(
            f"[cycle] is of no kind with figures over the speed; kinds are {', '.join(known)} and, with --diagram, "
            "diagram"
        )
    moved = piston_travel(name, parameters, guesses, number)
    room = chamber_over(moved, cycle.bore, cycle.compression_ratio, back_pressure(cycle))
    # the same chamber over a piston with its mass, for the largest force
    heavy = dataclasses.replace(room, motion=piston_motion(name, dataclasses.asdict(parameters), guesses, number))
    found = ((*load(figures)(cycle, room, float(speed)), float(speed)) for speed in omega)
    rows = [_at(pressure, fuel, heavy, speed) for pressure, fuel, speed in found]
    columns = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    fractions = {name: columns.pop(name) for name in _SHARES}
    return {"speed_rpm": omega / RPM} | columns | {"fractions": fractions, "loads": {}}


def _at(pressure: Pressure, fuel: dict[str, float], room: Chamber, omega: float) -> dict[str, float]:
    work = pressure.mean_indicated * room.displacement
    phi = np.linspace(-math.pi, math.pi, _POINTS)
    force = piston_force(room, phi, omega, pressure.absolute(phi))
    return {
        "torque_avg": work / (2 * math.pi), "torque_max": float(np.max(force * travel(room.motion, phi)[1])),
        "power_kw": work * omega / (2 * math.pi) / 1e3, "mep_kpa": pressure.mean_indicated / 1e3,
        "p_max_mpa": pressure.p_max / 1e6, "p_max_angle_deg": math.degrees(pressure.phi_p_max),
        "t_max_k": pressure.t_max, "force_max": float(np.max(force)),
    } | (fuel or dict.fromkeys(_UNKNOWN, math.nan))  # fmt: skip
