"""A whole run by its equations: in compiled C with jumps, kinks and stops inside, or phase by phase in Python."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from mechsym.errors import BadInput
from mechsym.native import integrate as native
from mechsym.native.compiler import NoCompiler, find
from mechsym.native.runs import STATUS, Breaks, Level, Outcome, Runs, Table
from mechsym.quantities.units import Array, Second
from mechsym.simulate.equations import System, fitted, held, start_of
from mechsym.simulate.phase import Leg, Phase, Raw, ends_watched, watch
from mechsym.simulate.problem import Along, FormulaForce, Periodic, Problem, Steps
from mechsym.simulate.settings import FALLBACK, NATIVE, Settings, backend

_DONE, _MET, _TOO_MANY = 0, 1, 2
_KEEP, _KEPT = 1024, 2**16  # last steps that are kept, at least, and numbers of each term of theirs at most
_SAME = 1e-6  # of the spacing of results: closer than this to the end is the end


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


def integrate(
    problem: Problem,
    equations: System,
    settings: Settings,
    wanted: Second[Array],
    ends: Sequence[Second],
    start: np.ndarray | None = None,
    more: Mapping[str, Level] | None = None,
) -> Raw:
    """A run in C where that is possible, otherwise phase by phase.

    ends: ends of the stretches in which nothing jumps; start: state at the start, of work done before too [SI]; more:
    levels that end the run beside the stops of the problem.
    """
    start, more = start_of(problem, equations) if start is None else start, more or {}
    if settings.backend in NATIVE:
        reason = unsuited(problem)
        if not reason:
            run = runs(problem, equations, settings, wanted, ends)
            run = replace(run, start=start, surfaces=(*run.surfaces, *more.values()))
            try:
                return raw(problem, equations, wanted, native.integrate(run), 0, start, tuple(more))
            except NoCompiler as error:
                reason = str(error)
        if settings.backend == "native":
            raise BadInput(f"backend 'native' cannot take this run: {reason}; or use backend auto")
        settings = replace(settings, backend=FALLBACK)
    return _phase_by_phase(problem, equations, settings, wanted, list(ends), start, more)


def runs(problem: Problem, equations: System, settings: Settings, times: np.ndarray, ends: Sequence[float]) -> Runs:
    """A problem as the native integrator takes it. problem, equations, settings, times, ends: see `integrate` [s]."""
    place = equations.columns.index
    tables, kinks = [], []
    keep = max(_KEEP, min(4 * _KEEP, _KEPT // (2 * equations.size)))
    for i, value in enumerate(equations.values):
        if isinstance(value, Periodic):
            poly = fitted(value)
            tables.append(Table(held=i, state=place(value.coordinate), polynomials=((poly.x, poly.c),)))
    for k in problem.kinks:
        if k.angles:
            kinks.append(Breaks(state=place(k.coordinate), angles=np.array(k.angles), period=k.period))
    return Runs(
        rhs=equations.function,
        start=start_of(problem, equations),
        t=problem.t_start,
        until=np.array(ends),
        held=np.array([held(equations, t) for t in (problem.t_start, *ends[:-1])]),
        times=times,
        tables=tuple(tables),
        surfaces=ends_watched(problem, equations.columns).surfaces,
        kinks=tuple(kinks),
        rtol=settings.tolerance,
        atol=settings.tolerance,
        max_steps=settings.max_steps,
        keep=keep if settings.check != "none" else 0,  # nobody looks into a run that checks another
        kept_states=2 * equations.size,
    )


def raw(
    problem: Problem,
    equations: System,
    times: Second[Array],
    outcome: Outcome,
    index: int,
    start: np.ndarray,
    more: tuple[str, ...] = (),
) -> Raw:
    """One run of an outcome as the result of a simulation takes it.

    times: wanted times; start: its first state [SI]; more: names of the levels beside the stops. Returns raw: series
    with the start, and the end when no wanted time is there.
    """
    t_end, status = float(outcome.t[index]), int(outcome.status[index])
    reached = times[times <= t_end]
    t = np.concatenate([[problem.t_start], reached])
    y = np.empty((len(equations.columns), len(t))).T  # each column in one piece
    y[0], y[1:] = start, outcome.samples[index, : len(reached)]
    if len(reached) and t_end - t[-1] < _SAME * (t[-1] - t[-2]):  # but for rounding the run ends at a wanted time
        t[-1], y[-1] = t_end, outcome.y[index]
    elif t[-1] < t_end:
        t, y = np.append(t, t_end), np.vstack([y, outcome.y[index]])
    failure = "" if status in (_DONE, _MET) else f"stopped at t = {t_end:.6g} s: {STATUS[status]}"
    if status == _TOO_MANY:
        failure = f"stopped at t = {t_end:.6g} s: {int(outcome.steps[index])} steps were not enough"
    names = (*ends_watched(problem, equations.columns).ends, *more)
    end = names[int(outcome.met[index])] if status == _MET else "t_end"
    steps, last = int(outcome.steps[index]), outcome.last[index] if outcome.last else None
    return Raw(t=t, y=y, steps=steps, end="failure" if failure else end, failure=failure, last=last)


def phase_integrator(name: str) -> Callable[[Phase], Leg]:
    """What integrates a phase: C where there is a compiler, else a backend of Python.

    Raises BadInput: C is asked for by name, and there is no compiler.
    """
    if name not in NATIVE:
        return backend(name)
    try:
        find()
    except NoCompiler as error:
        if name == "native":
            raise BadInput(f"backend 'native' cannot take this run: {error}; or use backend auto") from None
        return backend(FALLBACK)
    return partial(_advance, required=name == "native")


def _advance(phase: Phase, required: bool) -> Leg:
    run = Runs(
        rhs=phase.system.function, start=phase.y, t=phase.t_start, until=np.array([phase.t_end]), held=phase.w[None],
        times=phase.times, surfaces=phase.surfaces, rtol=phase.tolerance, atol=phase.tolerance,
        first_step=phase.first_step or 0.0, max_steps=phase.max_steps,
    )  # fmt: skip
    try:
        outcome = native.integrate(run)
    except NoCompiler as error:
        if required:
            raise BadInput(f"backend 'native' cannot take this run: {error}; or use backend auto") from None
        return backend(FALLBACK)(phase)
    status, met = int(outcome.status[0]), int(outcome.met[0])
    failure = "" if status in (_DONE, _MET) else f"stopped at t = {outcome.t[0]:.6g} s: {STATUS[status]}"
    reached = phase.times <= outcome.t[0]
    return Leg(
        t=float(outcome.t[0]), y=outcome.y[0], samples=outcome.samples[0, : reached.sum()], failure=failure,
        steps=int(outcome.steps[0]), met=met if status == _MET else None, step=float(outcome.last_step[0]) or None,
    )  # fmt: skip


def _phase_by_phase(
    problem: Problem,
    equations: System,
    settings: Settings,
    wanted: np.ndarray,
    ends: list[float],
    y: np.ndarray,
    more: Mapping[str, Level],
) -> Raw:
    advance = backend(settings.backend)
    t, step, steps, end, failure = problem.t_start, None, 0, "t_end", ""
    times, states = [np.array([t])], [y[None]]
    while ends and not failure:
        around = watch(problem, equations.columns, y)
        surfaces, names = (*around.surfaces, *more.values()), (*around.ends, *more)
        phase = Phase(
            system=equations, t_start=t, t_end=ends[0], y=y, w=held(equations, t), surfaces=surfaces,
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
        elif names[leg.met]:
            end = names[leg.met]
            break
        else:  # moved by less than the tolerance, the state lies on the surface to the last digit
            y = y.copy()
            y[surfaces[leg.met].state] = surfaces[leg.met].level
    all_times, all_states = np.concatenate(times), np.concatenate(states)
    if all_times[-1] < t:
        all_times, all_states = np.append(all_times, t), np.vstack([all_states, y])
    return Raw(t=all_times, y=all_states, steps=steps, end="failure" if failure else end, failure=failure)
