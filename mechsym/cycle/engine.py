"""What an engine does over its speeds and other values, by the method that its cycle names."""

from collections.abc import Callable, Mapping
from dataclasses import fields
from functools import partial
from typing import Any

import numpy as np

from mechsym.cycle.chamber import chamber, piston_force, travel, volume
from mechsym.cycle.closed.model import ClosedEngine, closed_period
from mechsym.cycle.closed.performance import Performance, performance
from mechsym.cycle.closed.run import at_angles, run
from mechsym.cycle.kinds.printed import marched, performance_printed
from mechsym.errors import BadInput
from mechsym.quantities import RPM

Progress = Callable[[int], Any]
_BLOCK = 1000


def over_speeds(engine: ClosedEngine, omega: np.ndarray, progress: Progress = lambda count: None) -> Performance:
    """Figures over the speeds, by the method that the cycle names.

    Parameters
    ----------
    omega : ndarray, shape (n,)
        Crank speeds [rad/s]
    progress : callable, optional
        Called with the number of points done after each block of them
    """
    return over_design(engine, {"omega": omega}, progress)


def over_design(
    engine: ClosedEngine, design: Mapping[str, Any], progress: Progress = lambda count: None
) -> Performance:
    """Figures over any of the engine's values, by the method that the cycle names.

    Parameters
    ----------
    design : mapping of str to ndarray, shape (n,)
        Operating points, see `model.design_names`; must hold `omega` [rad/s]
    progress : callable, optional
        Called with the number of points done after each block of them

    Raises
    ------
    BadInput
        The printed method knows no other variable than the speed
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
    names = [f.name for f in fields(Performance) if f.name != "loads"]
    values = {name: np.concatenate([getattr(part, name) for part in parts]) for name in names}
    loads = {name: np.concatenate([part.loads[name] for part in parts]) for name in parts[0].loads}
    return Performance(**values, loads=loads)


def columns(found: Performance) -> dict[str, Any]:
    """Figures under the names and units of the command line.

    Returns
    -------
    columns : dict
        `speed_rpm`, `torque_avg`, ...; `fractions` and `loads` are mappings
    """
    shares = {name: getattr(found, name) for name in ("heat", "work", "exhaust", "unburnt")}
    return {
        "speed_rpm": found.omega / RPM,
        "torque_avg": found.torque_avg,
        "torque_max": found.torque_max,
        "power_kw": found.power / 1e3,
        "mep_kpa": found.mep / 1e3,
        "sfc_g_kwh": found.sfc * 3.6e9,
        "efficiency": found.efficiency,
        "p_max_mpa": found.p_max / 1e6,
        "p_max_angle_deg": np.degrees(found.p_max_angle),
        "t_max_k": found.t_max,
        "knock": found.knock,
        "force_max": found.force_max,
        "fractions": shares,
        "loads": found.loads,
        "friction_mep_kpa": found.friction_mep / 1e3,
        "brake_torque": found.brake_torque,
        "brake_power_kw": found.brake_power / 1e3,
        "brake_sfc_g_kwh": found.brake_sfc * 3.6e9,
        "brake_efficiency": found.brake_efficiency,
        "energy_residual": found.energy_residual,
    }


def curves(engine: ClosedEngine, omega: float, step: float = np.radians(0.5)) -> dict[str, np.ndarray]:
    """The closed period at one speed, curve by curve.

    Parameters
    ----------
    omega : float
        Crank speed [rad/s]
    step : float
        Distance of the angles; the printed method keeps its whole degrees [rad]

    Returns
    -------
    curves : dict of str to ndarray, shape (k,)
        `phi_deg` from firing top dead centre, `p_pa`, `t_k`, `v_m3`, `force_n` and `torque_nm` of one piston
    """
    room = chamber(engine.chamber, engine.motion)
    if engine.cycle.method == "nunes2017_printed":
        result = marched(engine, np.array([omega]))
        phi, p, t = np.radians(result.theta_deg - 360.0), result.p[:, 0], result.t[:, 0]
    else:
        phi, p, t = at_angles(run(partial(closed_period, engine), {"omega": omega}), step)
    force = piston_force(room, phi, omega, p)
    return {
        "phi_deg": np.degrees(phi),
        "p_pa": p,
        "t_k": t,
        "v_m3": volume(room, phi),
        "force_n": force,
        "torque_nm": force * travel(room.motion, phi)[1],
    }
