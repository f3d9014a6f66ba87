"""A loop's result under the names and units of the command line."""

from typing import Any

import numpy as np

from mechsym.quantities import RPM
from mechsym.simulate.loop.run import LoopResult
from mechsym.simulate.loop.system import Loop


def summary(loop: Loop, result: LoopResult) -> dict[str, Any]:
    """What a loop did, in numbers.

    Returns
    -------
    summary : dict
        `status`, `reason`; over the last two turns `speed_mean_rpm`, `speed_min_rpm`, `speed_max_rpm`, `speed_ripple`
        of the loaded shaft; `cycles`, rows of cylinder (from 1), t_s, speed_rpm, work, wall_heat, energy_residual,
        knock; `energy_residual` of the whole run
    """
    u = result.u[:, loop.mechanism.coordinates.index(loop.load_coordinate)]
    q = result.q[:, 0]
    last = u[q > q[-1] - 4 * np.pi]
    rows = [
        {"cylinder": c.cylinder + 1, "t_s": c.time, "speed_rpm": c.speed / RPM, "work": c.work,
         "wall_heat": c.wall_heat, "energy_residual": c.residual,
         "knock": c.knock}
        for c in result.cycles
    ]  # fmt: skip
    mean = float(last.mean())
    return {
        "status": result.status, "reason": result.reason, "t_end": float(result.t[-1]),
        "speed_mean_rpm": mean / RPM, "speed_min_rpm": float(last.min()) / RPM,
        "speed_max_rpm": float(last.max()) / RPM, "speed_ripple": float(np.ptp(last)) / mean,
        "p_max_mpa": float(result.p.max()) / 1e6, "cycles": rows, "energy_residual": result.energy_residual,
    }  # fmt: skip


def series(loop: Loop, result: LoopResult) -> dict[str, np.ndarray]:
    """Time series of a loop.

    Returns
    -------
    columns : dict of str to ndarray
        `t` [s], coordinates [rad], velocities [rad/s], `p_1`, `p_2`, .. [Pa]
    """
    names = loop.mechanism.coordinates
    columns = {"t": result.t}
    columns |= {name: result.q[:, k] for k, name in enumerate(names)}
    columns |= {f"{name}d": result.u[:, k] for k, name in enumerate(names)}
    return columns | {f"p_{k + 1}": result.p[:, k] for k in range(result.p.shape[1])}
