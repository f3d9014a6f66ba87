"""scipy's integrators, step by step, with surfaces met exactly.

A step that crosses a surface is thrown away and made again so that it ends there: no accepted step then uses the
right-hand side on both sides of a kink, and the state at an event comes from a step, not from interpolation.
"""

from collections.abc import Callable

import numpy as np
import scipy

from mechsym.native.integrate import Level
from mechsym.simulate.equations import right_side
from mechsym.simulate.phase import Leg, Phase, Span

_CLOSE = 0.02  # a kink nearer than this share of a usual step is met by the next step, others by a step to just before


def advance(phase: Phase, method: str) -> Leg:
    """Integrate a phase with a class of scipy.integrate. method: name of the class, for example `DOP853`."""
    f = right_side(phase.system, phase.w, phase.t_end, phase.spans)
    solver = _solver(phase, method, f, (phase.t_start, phase.y), phase.t_end, phase.first_step)
    wanted, samples, steps, step, met, failure = phase.times, [phase.y[None][:0]], 0, phase.first_step, None, ""
    while solver.status == "running" and not failure:
        start = solver.t, solver.y
        limited = met is None and _slow_down(phase, solver, step)
        message = solver.step()
        steps += 1
        if solver.status == "failed" or steps >= phase.max_steps:
            failure = f"stopped at t = {solver.t:.6g} s: {message or f'{phase.max_steps} steps were not enough'}"
        if met is None and phase.surfaces and not failure:
            met, t_met = _first_crossing(phase.surfaces, solver, start[1])
            if met is not None:
                solver = _solver(phase, method, f, start, t_met, t_met - start[0])
                continue
        if met is None and not limited:
            step = solver.step_size
        if len(wanted) and wanted[0] <= solver.t:
            due = int(np.searchsorted(wanted, solver.t, side="right"))
            samples.append(solver.dense_output()(wanted[:due]).T)
            wanted = wanted[due:]
    rows = np.concatenate(samples)
    return Leg(t=solver.t, y=solver.y.copy(), samples=rows, steps=steps, met=met, step=step, failure=failure)


def _solver(
    phase: Phase,
    method: str,
    f: Callable[[float, np.ndarray], np.ndarray],
    start: tuple[float, np.ndarray],
    t_end: float,
    step: float | None,
) -> "scipy.integrate.OdeSolver":
    first = None if step is None else min(step, t_end - start[0])
    cls = getattr(scipy.integrate, method)
    return cls(f, *start, t_end, rtol=phase.tolerance, atol=phase.tolerance, first_step=first)


def _slow_down(phase: Phase, solver: "scipy.integrate.OdeSolver", usual: float | None) -> bool:
    """Keep the next step from reaching far across a kink, where it would be rejected; whether it was limited."""
    if not phase.spans or not hasattr(solver, "h_abs"):  # LSODA chooses its steps out of sight
        return False
    rates = solver.f if hasattr(solver, "f") else solver.fun(solver.t, solver.y)  # BDF does not keep them
    arrival = min(_arrival(span, solver, rates, phase.system.size) for span in phase.spans)
    close = usual is not None and arrival < _CLOSE * usual
    solver.max_step = arrival * (1 + 1e-5 if close else 1 - _CLOSE / 2)
    return solver.h_abs > solver.max_step


def _arrival(span: Span, solver: "scipy.integrate.OdeSolver", rates: np.ndarray, size: int) -> float:
    """Estimated time until a coordinate leaves its interval."""
    speed, rate = float(rates[span.state]), float(rates[span.state + size])
    if speed == 0.0:
        return np.inf
    way = max(abs((span.high if speed > 0 else span.low) - float(solver.y[span.state])), 1e-12)
    first = way / abs(speed)
    mean = abs(speed) + np.sign(speed) * rate * first / 2
    return way / mean if mean > 0 else np.inf


def _first_crossing(
    surfaces: tuple[Level, ...], solver: "scipy.integrate.OdeSolver", before: np.ndarray
) -> tuple[int | None, float]:
    crossed = []
    for i, s in enumerate(surfaces):
        was, now = before[s.state], solver.y[s.state]
        if was < s.level <= now and s.direction >= 0 or was > s.level >= now and s.direction <= 0:
            crossed.append(i)
    if not crossed:
        return None, solver.t
    dense = solver.dense_output()
    times = [_time(dense, surfaces[i], solver.t_old, solver.t) for i in crossed]
    first = int(np.argmin(times))
    return crossed[first], times[first]


def _time(dense: "scipy.integrate.DenseOutput", surface: Level, t_old: float, t: float) -> float:
    def distance(t: float) -> float:
        return float(dense(t)[surface.state] - surface.level)

    if distance(t_old) * distance(t) >= 0:
        return t
    return max(float(scipy.optimize.brentq(distance, t_old, t, xtol=1e-300, rtol=1e-15)), float(np.nextafter(t_old, t)))
