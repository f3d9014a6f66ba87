"""Run a problem: split it into smooth phases, integrate each, audit the energy, and check the tolerance."""

import time
from dataclasses import replace
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.record import Mechanism
from mechsym.native.compiler import NoCompiler
from mechsym.simulate import constrained, native_backend
from mechsym.simulate.audit import energies, energies_beside, energy_audit, speed_difference, verdict
from mechsym.simulate.backends import FALLBACK, NATIVE, backend
from mechsym.simulate.equations import System, held, start_of, system
from mechsym.simulate.forecast import TRIAL, refuse_endless, shorter
from mechsym.simulate.opening import ended, posed
from mechsym.simulate.phase import Phase, Raw, Surface
from mechsym.simulate.problem import Problem, Steps, times_of
from mechsym.simulate.result import Event, Result
from mechsym.simulate.settings import Settings
from mechsym.simulate.watch import watch

_TIGHTEST = 3e-14  # below that a double-precision step cannot be controlled


def simulate(problem: Problem, settings: Settings | None = None) -> Result:
    """Integrate a problem and say how far the result can be trusted.

    Parameters
    ----------
    settings : Settings, optional
        Tolerance 1e-10 with check unless given

    Returns
    -------
    result : Result
        Series, energy audit, convergence; a failure is a status with a reason

    Raises
    ------
    BadInput
        The backend cannot take this problem, or its first steps show that it would not end within those allowed
    """
    settings = settings or Settings()
    result = _once(problem, shorter(settings))
    if result.end == "failure" and settings.max_steps > TRIAL:
        refuse_endless(problem, _once(problem, shorter(settings, TRIAL // 2)), result, settings)
        result = _once(problem, settings)
    if result.status == "failed" or settings.check == "none":
        return result
    return checked(problem.mechanism, result, _once(problem, tighter(settings)), settings)


def _once(problem: Problem, settings: Settings) -> Result:
    begin = time.perf_counter()
    if problem.mechanism.dependents:
        equations, raw = constrained.integrate(problem, settings, wanted_times(problem), ends_of(problem))
    else:
        equations = system(problem)
        raw = _integrate(problem, equations, settings)
    return result_of(problem, equations, raw, time.perf_counter() - begin)


def tighter(settings: Settings) -> Settings:
    """Settings of the run that checks another.

    Parameters
    ----------
    settings : Settings
        Of the run to be checked

    Returns
    -------
    settings : Settings
        A hundredth of the tolerance, without a check of its own
    """
    return replace(settings, tolerance=max(settings.tolerance / 100, _TIGHTEST), check="none")


def checked(mechanism: Mechanism, result: Result, check: Result, settings: Settings) -> Result:
    """A result with the verdict of its check.

    Parameters
    ----------
    result, check : Result
        The run, and the run at the tighter tolerance
    """
    if check.status == "failed":
        return replace(result, status="not converged", reason=f"the run at the tighter tolerance {check.reason}")
    if check.end != result.end:
        why = f"ends by {result.end!r}, at the tighter tolerance by {check.end!r}; use a smaller tolerance"
        return replace(result, status="not converged", reason=why)
    t, here, there = _common(result.t, check.t)
    speeds = [f"{q}d" for q in mechanism.coordinates if q not in mechanism.dependents]  # the others follow them
    difference = speed_difference(
        {v: result.columns[v][here] for v in speeds}, {v: check.columns[v][there] for v in speeds}
    )
    residuals = (result.energy.residual, check.energy.residual)
    status, reason = verdict(t, difference, settings.difference_allowed, residuals)
    return replace(result, status=status, reason=reason, tolerance_difference=float(np.max(difference)))


def _common(a: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, Any, Any]:
    """Times that two runs share, and where they stand in each."""
    return (a, slice(None), slice(None)) if np.array_equal(a, b) else np.intersect1d(a, b, return_indices=True)


def _integrate(problem: Problem, equations: System, settings: Settings) -> Raw:
    """A whole run in C where that is possible, otherwise phase by phase."""
    wanted, ends = wanted_times(problem), ends_of(problem)
    if settings.backend in NATIVE:
        reason = native_backend.unsuited(problem)
        if not reason:
            try:
                return native_backend.run(problem, equations, settings, wanted, ends)
            except NoCompiler as error:
                reason = str(error)
        if settings.backend == "native":
            raise BadInput(f"backend 'native' cannot take this run: {reason}; or use backend auto")
        settings = replace(settings, backend=FALLBACK)
    return _phase_by_phase(problem, equations, settings, wanted, ends)


def _phase_by_phase(
    problem: Problem, equations: System, settings: Settings, wanted: np.ndarray, ends: list[float]
) -> Raw:
    advance = backend(settings.backend)
    y = start_of(problem, equations)
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
    return Raw(t=found, y=values, steps=steps, end="failure" if failure else end, failure=failure)


def _beyond(surface: Surface, y: np.ndarray) -> np.ndarray:
    """The state moved by less than the tolerance, so that it lies on the surface to the last digit."""
    moved = y.copy()
    moved[surface.state] = surface.level
    return moved


def wanted_times(problem: Problem) -> np.ndarray:
    """Times at which results are wanted.

    Parameters
    ----------
    problem : Problem
        With a spacing or a list of times

    Returns
    -------
    times : ndarray, shape (n,)
        After the start, ascending [s]
    """
    if not isinstance(problem.output, (int, float)):
        return times_of(problem.output)
    count = int(np.floor((problem.t_end - problem.t_start) / problem.output * (1 + 1e-12)))
    return np.minimum(problem.t_start + problem.output * np.arange(1, count + 1), problem.t_end)


def ends_of(problem: Problem) -> list[float]:
    """Ends of the stretches of time in which nothing jumps.

    Returns
    -------
    ends : list of float
        Ascending; the last is the end of the run [s]
    """
    jumps = [t for p in problem.parts if isinstance(p.value, Steps) for t in p.value.times]
    inside = sorted(t for t in {*problem.breaks, *jumps} if problem.t_start < t < problem.t_end)
    return [*inside, problem.t_end]


def result_of(problem: Problem, equations: System, raw: Raw, wall_s: float) -> Result:
    """A finished run as a result, with its energy audited.

    Parameters
    ----------
    wall_s : float
        Time it took [s]
    """
    n, whole = equations.size, ended(problem.mechanism, raw)
    raw = posed(problem.mechanism, whole)
    columns = dict(zip(equations.columns, raw.y.T, strict=True))
    units = dict(zip(equations.columns, equations.units, strict=True))
    shared = equations.shared or problem.mechanism
    known = energies(shared, raw.y[:, :n].T, raw.y[:, n : 2 * n].T, equations.letters)
    if known is not None:
        columns |= dict(zip(("kinetic_energy", "potential_energy"), known, strict=True))
        units |= {"kinetic_energy": "J", "potential_energy": "J"}
        if beside := energies_beside(problem, columns):
            columns |= beside
            units |= dict.fromkeys(beside, "J")
    heats = tuple(s.name for s in problem.states if s.role == "heat")
    met = raw.end in {constrained.LOCKED, *(s.name for s in problem.stops)}
    state = dict(zip(equations.columns[: 2 * n], whole.y[-1].tolist(), strict=False))
    return Result(
        status="failed" if raw.failure else "unchecked",
        reason=raw.failure or "the tolerance was not checked",
        t=raw.t,
        columns=columns,
        units=units,
        end=raw.end,
        event=Event(name=raw.end, t=float(whole.t[-1]), state=state) if met else None,
        energy=energy_audit({p.name: p.role for p in problem.parts}, columns, heats),
        tolerance_difference=None,
        steps=raw.steps,
        wall_s=wall_s,
    )
