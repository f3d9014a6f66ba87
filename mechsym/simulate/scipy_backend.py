"""scipy's integrators, step by step, with surfaces met exactly.

A step that crosses a surface is thrown away and made again so that it ends there: no accepted step then uses the
right-hand side on both sides of a kink, and the state at an event comes from a step, not from interpolation.
"""

from collections.abc import Callable
from typing import Any

import numpy as np

from mechsym.simulate.equations import right_side
from mechsym.simulate.phase import Leg, Phase, Surface


def advance(phase: Phase, method: str) -> Leg:
    """Integrate a phase with a class of scipy.integrate.

    Parameters
    ----------
    phase : Phase
        What to integrate
    method : str
        Name of the class, for example `DOP853`

    Returns
    -------
    leg : Leg
        Result
    """
    f = right_side(phase.system, phase.w, phase.t_end)
    solver = _solver(phase, method, f, (phase.t_start, phase.y), phase.t_end, phase.first_step)
    wanted, samples, steps, step, met, failure = phase.times, [phase.y[None][:0]], 0, phase.first_step, None, ""
    while solver.status == "running" and not failure:
        start = solver.t, solver.y
        message = solver.step()
        steps += 1
        if solver.status == "failed" or steps >= phase.max_steps:
            failure = f"stopped at t = {solver.t:.6g} s: {message or f'{phase.max_steps} steps were not enough'}"
        if met is None and phase.surfaces and not failure:
            met, t_met = _first_crossing(phase.surfaces, solver, start[1])
            if met is not None:
                solver = _solver(phase, method, f, start, t_met, t_met - start[0])
                continue
        if met is None:
            step = solver.step_size
        if len(wanted) and wanted[0] <= solver.t:
            due = int(np.searchsorted(wanted, solver.t, side="right"))
            samples.append(solver.dense_output()(wanted[:due]).T)
            wanted = wanted[due:]
    found = np.concatenate(samples)
    return Leg(t=solver.t, y=solver.y.copy(), samples=found, steps=steps, met=met, step=step, failure=failure)


def _solver(
    phase: Phase, method: str, f: Callable[..., Any], start: tuple[float, Any], t_end: float, step: float | None
) -> Any:
    import scipy.integrate

    first = None if step is None else min(step, t_end - start[0])
    cls = getattr(scipy.integrate, method)
    return cls(f, *start, t_end, rtol=phase.tolerance, atol=phase.tolerance, first_step=first)


def _first_crossing(surfaces: tuple[Surface, ...], solver: Any, before: np.ndarray) -> tuple[int | None, float]:
    crossed = [i for i, s in enumerate(surfaces) if _crosses(s, before[s.state], solver.y[s.state])]
    if not crossed:
        return None, solver.t
    dense = solver.dense_output()
    times = [_time(dense, surfaces[i], solver.t_old, solver.t) for i in crossed]
    first = int(np.argmin(times))
    return crossed[first], times[first]


def _crosses(surface: Surface, before: float, after: float) -> bool:
    rising = before < surface.level <= after and surface.direction >= 0
    falling = before > surface.level >= after and surface.direction <= 0
    return rising or falling


def _time(dense: Any, surface: Surface, t_old: float, t: float) -> float:
    from scipy.optimize import brentq

    def distance(t: float) -> float:
        return float(dense(t)[surface.state]) - surface.level

    if distance(t_old) * distance(t) >= 0:
        return t
    return max(float(brentq(distance, t_old, t, xtol=1e-300, rtol=1e-15)), float(np.nextafter(t_old, t)))
