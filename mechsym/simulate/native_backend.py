"""A whole run in compiled C: jumps, kinks and stops are handled inside, so one call takes the place of all phases."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from mechsym.native.compiler import NoCompiler, find
from mechsym.native.integrate import integrate
from mechsym.native.runs import STATUS, Breaks, Level, Outcome, Runs, Table
from mechsym.simulate.equations import System, fitted, held, start_of
from mechsym.simulate.phase import Raw
from mechsym.simulate.problem import Along, FormulaForce, Periodic, Problem, Steps
from mechsym.simulate.settings import Settings
from mechsym.simulate.watch import ends_watched

_DONE, _MET, _TOO_MANY = 0, 1, 2


def unsuited(problem: Problem) -> str:
    """Why a problem cannot be run in C."""
    plain = [p.name for p in problem.parts if not isinstance(p.value, Steps | Periodic | FormulaForce | Along)]
    if plain:
        return f"part {plain[0]!r} is a plain Python callable; give it as FormulaForce, Periodic or Steps"
    try:
        find()
    except NoCompiler as error:
        return str(error)
    return ""


def run(problem: Problem, equations: System, settings: Settings, times: np.ndarray, ends: Sequence[float]) -> Raw:
    """Integrate a problem in C.

    Parameters
    ----------
    times : ndarray, shape (n,)
        Wanted times [s]
    ends : sequence of float
        Ends of the smooth stretches of time [s]
    """
    outcome = integrate(runs(problem, equations, settings, times, ends))
    return raw(problem, equations, times, outcome, 0)


def runs(problem: Problem, equations: System, settings: Settings, times: np.ndarray, ends: Sequence[float]) -> Runs:
    """A problem as the native integrator takes it.

    Parameters
    ----------
    problem, equations, settings, times, ends
        See `run` [s]
    """
    starts = [problem.t_start, *ends[:-1]]
    return Runs(
        rhs=equations.function,
        start=start_of(problem, equations),
        t=problem.t_start,
        until=np.array(ends),
        held=np.array([held(equations, t) for t in starts]),
        times=times,
        tables=tuple(_table(equations, i, v) for i, v in enumerate(equations.values) if isinstance(v, Periodic)),
        surfaces=tuple(
            Level(state=s.state, level=s.level, direction=s.direction)
            for s in ends_watched(problem, equations.columns).surfaces
        ),
        kinks=_kinks(problem, equations),
        rtol=settings.tolerance,
        atol=settings.tolerance,
        max_steps=settings.max_steps,
    )


def raw(problem: Problem, equations: System, times: np.ndarray, outcome: Outcome, index: int) -> Raw:
    """One run of an outcome as the result of a simulation takes it.

    Parameters
    ----------
    times : ndarray, shape (n,)
        Wanted times [s]

    Returns
    -------
    raw : Raw
        Series with the start, and the end when no wanted time is there
    """
    t_end, status = float(outcome.t[index]), int(outcome.status[index])
    reached = times[times <= t_end]
    t = np.concatenate([[problem.t_start], reached])
    y = np.empty((len(equations.columns), len(t))).T  # each column in one piece
    y[0], y[1:] = start_of(problem, equations), outcome.samples[index, : len(reached)]
    if t[-1] < t_end:
        t, y = np.append(t, t_end), np.vstack([y, outcome.y[index]])
    failure = "" if status in (_DONE, _MET) else f"stopped at t = {t_end:.6g} s: {STATUS[status]}"
    if status == _TOO_MANY:
        failure = f"stopped at t = {t_end:.6g} s: {int(outcome.steps[index])} steps were not enough"
    names = (*ends_watched(problem, equations.columns).ends, "margin")  # see constrained.py
    end = names[int(outcome.met[index])] if status == _MET else "t_end"
    return Raw(t=t, y=y, steps=int(outcome.steps[index]), end="failure" if failure else end, failure=failure)


def _table(equations: System, index: int, value: Periodic) -> Table:
    poly: Any = fitted(value)
    state = equations.columns.index(value.coordinate)
    return Table(held=index, state=state, polynomials=((poly.x, poly.c),))


def _kinks(problem: Problem, equations: System) -> tuple[Breaks, ...]:
    return tuple(
        Breaks(state=equations.columns.index(k.coordinate), angles=np.array(k.angles), period=k.period)
        for k in problem.kinks
        if k.angles
    )
