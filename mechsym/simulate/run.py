"""Run a problem: split it into smooth phases, integrate each, audit the energy, and check the tolerance."""

import time
from dataclasses import dataclass, replace

import numpy as np

from mechsym.mechanism import velocities
from mechsym.simulate.audit import energies, energy_audit, speed_difference, verdict
from mechsym.simulate.backends import backend
from mechsym.simulate.equations import System, held, system
from mechsym.simulate.phase import Phase, Surface
from mechsym.simulate.problem import Problem, Steps
from mechsym.simulate.result import Event, Result
from mechsym.simulate.settings import Settings
from mechsym.simulate.watch import watch

_TIGHTEST = 3e-14  # below that a double-precision step cannot be controlled


@dataclass(frozen=True, kw_only=True)
class _Raw:
    t: np.ndarray
    y: np.ndarray
    steps: int
    end: str
    failure: str


def simulate(problem: Problem, settings: Settings | None = None) -> Result:
    """Integrate a problem and say how far the result can be trusted.

    Parameters
    ----------
    problem : Problem
        What to run
    settings : Settings, optional
        Tolerance 1e-10 with check unless given

    Returns
    -------
    result : Result
        Series, energy audit, convergence; a failure is a status with a reason

    Raises
    ------
    BadInput
        The backend cannot take this problem
    """
    settings = settings or Settings()
    equations = system(problem)
    begin = time.perf_counter()
    raw = _integrate(problem, equations, settings)
    result = _result(problem, equations, raw, time.perf_counter() - begin)
    if raw.failure or settings.check == "none":
        return result
    tighter = replace(settings, tolerance=max(settings.tolerance / 100, _TIGHTEST), check="none")
    check = _result(problem, equations, _integrate(problem, equations, tighter), 0.0)
    return _checked(problem, result, check, settings)


def _checked(problem: Problem, result: Result, check: Result, settings: Settings) -> Result:
    if check.status == "failed":
        return replace(result, status="not converged", reason=f"the run at the tighter tolerance {check.reason}")
    if check.end != result.end:
        why = f"ends by {result.end!r}, at the tighter tolerance by {check.end!r}; use a smaller tolerance"
        return replace(result, status="not converged", reason=why)
    t, here, there = np.intersect1d(result.t, check.t, return_indices=True)
    speeds = velocities(problem.mechanism)
    difference = speed_difference(
        {v: result.columns[v][here] for v in speeds}, {v: check.columns[v][there] for v in speeds}
    )
    residuals = (result.energy.residual, check.energy.residual)
    status, reason = verdict(t, difference, settings.difference_allowed, residuals)
    return replace(result, status=status, reason=reason, tolerance_difference=float(np.max(difference)))


def _integrate(problem: Problem, equations: System, settings: Settings) -> _Raw:
    advance = backend(settings.backend)
    wanted = _times(problem)
    ends = [*_breaks(problem), problem.t_end]
    y = np.concatenate([problem.q0, problem.u0, np.zeros(len(equations.columns) - 2 * equations.size)])
    t, step, steps, end, failure = problem.t_start, None, 0, "t_end", ""
    times, states = [np.array([t])], [y[None]]
    while ends and not failure:
        around = watch(problem, equations.columns, y)
        phase = Phase(
            system=equations, t_start=t, t_end=ends[0], y=y, w=held(equations, t), surfaces=around.surfaces,
            spans=around.spans, times=wanted[(wanted > t) & (wanted <= ends[0])],
            tolerance=settings.tolerance, first_step=step, max_steps=settings.max_steps,
        )  # fmt: skip
        leg = advance(phase)
        times.append(phase.times[: len(leg.samples)])
        states.append(leg.samples)
        t, y, step, steps, failure = leg.t, leg.y, leg.step, steps + leg.steps, leg.failure
        if leg.met is None:
            ends.pop(0)
            step = None
        elif around.ends[leg.met]:
            end = around.ends[leg.met]
            break
        else:
            y = _beyond(around.surfaces[leg.met], y)
    found, values = np.concatenate(times), np.concatenate(states)
    if found[-1] < t:
        found, values = np.append(found, t), np.vstack([values, y])
    return _Raw(t=found, y=values, steps=steps, end="failure" if failure else end, failure=failure)


def _beyond(surface: Surface, y: np.ndarray) -> np.ndarray:
    """The state moved by less than the tolerance, so that it lies on the surface to the last digit."""
    moved = y.copy()
    moved[surface.state] = surface.level
    return moved


def _times(problem: Problem) -> np.ndarray:
    if not isinstance(problem.output, (int, float)):
        return np.asarray(problem.output, dtype=float)
    count = int(np.floor((problem.t_end - problem.t_start) / problem.output * (1 + 1e-12)))
    return np.minimum(problem.t_start + problem.output * np.arange(1, count + 1), problem.t_end)


def _breaks(problem: Problem) -> list[float]:
    jumps = [t for p in problem.parts if isinstance(p.value, Steps) for t in p.value.times]
    return sorted(t for t in {*problem.breaks, *jumps} if problem.t_start < t < problem.t_end)


def _result(problem: Problem, equations: System, raw: _Raw, wall_s: float) -> Result:
    n = equations.size
    columns = dict(zip(equations.columns, raw.y.T, strict=True))
    units = dict(zip(equations.columns, equations.units, strict=True))
    known = energies(problem.mechanism, raw.y[:, :n].T, raw.y[:, n : 2 * n].T)
    if known is not None:
        columns |= dict(zip(("kinetic_energy", "potential_energy"), known, strict=True))
        units |= {"kinetic_energy": "J", "potential_energy": "J"}
    met = raw.end in {s.name for s in problem.stops}
    state = dict(zip(equations.columns[: 2 * n], raw.y[-1].tolist(), strict=False))
    return Result(
        status="failed" if raw.failure else "unchecked",
        reason=raw.failure or "the tolerance was not checked",
        t=raw.t,
        columns=columns,
        units=units,
        end=raw.end,
        event=Event(name=raw.end, t=float(raw.t[-1]), state=state) if met else None,
        energy=energy_audit(problem, columns),
        tolerance_difference=None,
        steps=raw.steps,
        wall_s=wall_s,
    )
