"""The numbers of a run that are reported: speeds over a window at the end, audit, convergence, event."""

from typing import Any

import numpy as np

from mechsym.simulate.result import Result


def summary(
    result: Result, coordinates: tuple[str, ...], window: float | None, period: float = 2 * np.pi
) -> dict[str, Any]:
    """The reported numbers of a run.

    Parameters
    ----------
    coordinates : tuple of str
        Names of the coordinates; `speed_mean` and the others are those of the first
    window : float or None
        Stretch at the end over which speeds are summed up; None takes the last period of the first coordinate [s]
    period : float
        A turn, or two for a four-stroke engine [rad]

    Returns
    -------
    summary : dict
        Keys of `mechsym simulate` in the interface, and more
    """
    since = last_period(result, coordinates[0], period) if window is None else max(result.t[-1] - window, result.t[0])
    speeds = {c: speed_over(result, c, since) for c in coordinates}
    first = speeds[coordinates[0]]
    event = result.event
    return {
        "t_end": float(result.t[-1]),
        "speed_mean": first["mean"],
        "speed_min": first["min"],
        "speed_max": first["max"],
        "energy_residual": result.energy.residual,
        "tolerance_difference": result.tolerance_difference,
        "steps": result.steps,
        "wall_s": result.wall_s,
        "event": None if event is None else {"name": event.name, "t": event.t, **event.state},
        "end": result.end,
        "status": result.status,
        "reason": result.reason,
        "window": float(result.t[-1] - since),
        "speeds": speeds,
        "energy": {
            "work": dict(result.energy.work),
            "work_in": result.energy.work_in,
            "dissipation": result.energy.dissipation,
            "change": result.energy.change,
        },
    }


def speed_over(result: Result, coordinate: str, since: float) -> dict[str, float]:
    """Mean, least and greatest speed of a coordinate from a time to the end.

    Parameters
    ----------
    since : float
        From when [s]

    Returns
    -------
    speed : dict of str to float
        Keys mean (advance by time), min, max [rad/s]
    """
    keep = result.t >= since - 1e-12 * max(1.0, abs(since))
    t, q, u = (v[keep] for v in (result.t, result.columns[coordinate], result.columns[f"{coordinate}d"]))
    mean = (q[-1] - q[0]) / (t[-1] - t[0]) if len(t) > 1 else u[-1]
    return {"mean": float(mean), "min": float(u.min()), "max": float(u.max())}


def last_period(result: Result, coordinate: str, period: float = 2 * np.pi) -> float:
    """When the last period of a coordinate began.

    Parameters
    ----------
    period : float
        A turn, or two for a four-stroke engine [rad]

    Returns
    -------
    t : float
        The sample nearest before; the start of a run shorter than that [s]
    """
    q = result.columns[coordinate]
    before = np.flatnonzero(q <= q[-1] - period * (1 - 1e-9))
    return float(result.t[before[-1]]) if len(before) else float(result.t[0])


def speed_ripple(result: Result, coordinate: str, period: float = 2 * np.pi) -> float:
    r"""Ripple of the last period.

    .. math:: (\omega_\max - \omega_\min) / \omega_\mathrm{mean}

    Parameters
    ----------
    result : Result
        A run of at least a period, in steady state for the number to mean what it says
    period : float
        Period of the torques [rad]

    Returns
    -------
    ripple : float
        From the samples of the last period [-]
    """
    speed = speed_over(result, coordinate, last_period(result, coordinate, period))
    return (speed["max"] - speed["min"]) / speed["mean"]
