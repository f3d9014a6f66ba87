"""The backends: scipy's integrators, step by step, with surfaces met exactly; CVODES inside CasADi, and heyoka.

Those two take the equations as one expression. They know steps in time, which the caller splits, but no surfaces and no
plain Python callables. With scipy a step that crosses a surface is thrown away and made again so that it ends there: no
accepted step then uses the right-hand side on both sides of a kink, and the state at an event comes from a step, not
from interpolation.
"""

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np
import scipy

from mechsym.errors import BadInput, MissingExtra
from mechsym.native.runs import Level
from mechsym.periodic.roots import root
from mechsym.simulate.equations import right_side
from mechsym.simulate.phase import Leg, Phase, Span
from mechsym.simulate.problem import Steps

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
    return max(root(distance, t_old, t, xtol=1e-300, rtol=1e-15), float(np.nextafter(t_old, t)))


def advance_sundials(phase: Phase) -> Leg:
    """Integrate a phase with CVODES, Adams formulas and functional iteration (the motion is not stiff)."""
    _refuse(phase, "sundials")
    t, y, w = (ca.SX.sym(n, s) for n, s in (("t", 1), ("y", len(phase.y)), ("w", len(phase.w))))
    dae = {"t": t, "x": y, "p": w, "ode": phase.system.function(t, y, w)}
    options: dict[str, float | str] = {
        "abstol": phase.tolerance,
        "reltol": phase.tolerance,
        "linear_multistep_method": "adams",
        "nonlinear_solver_iteration": "functional",
        "max_num_steps": phase.max_steps,
    }
    grid = _grid(phase)
    integrator = ca.integrator("phase", "cvodes", dae, phase.t_start, grid.tolist(), options)
    try:
        states = np.asarray(integrator(x0=phase.y, p=phase.w)["xf"]).T
    except RuntimeError as error:
        return _failed(phase, str(error).strip().splitlines()[-1])
    steps = int(integrator.stats().get("nsteps", 0))
    return Leg(t=phase.t_end, y=states[-1], samples=states[: len(phase.times)], steps=steps)


def advance_heyoka(phase: Phase) -> Leg:
    """Integrate a phase with heyoka's adaptive Taylor method."""
    _refuse(phase, "heyoka")
    try:
        import heyoka as hy
    except ImportError:
        raise MissingExtra(
            "backend 'heyoka' needs the package heyoka; install it with pip install 'mechsym[heyoka]', or use "
            "scipy-dop853"
        ) from None
    names = [f"y{i}" for i in range(len(phase.y))]
    variables = hy.make_vars(*names)
    rates = _heyoka_expressions(hy, phase.system.function, variables)
    solver = hy.taylor_adaptive(
        list(zip(variables, rates, strict=True)),
        phase.y.tolist(),
        time=phase.t_start,
        pars=phase.w.tolist(),
        tol=phase.tolerance,
    )
    outcome, _, _, steps, _, states = solver.propagate_grid(np.concatenate([[phase.t_start], _grid(phase)]))
    if outcome != hy.taylor_outcome.time_limit:
        return _failed(phase, f"heyoka ended with {outcome}")
    states = np.asarray(states)[1:]
    return Leg(t=phase.t_end, y=states[-1], samples=states[: len(phase.times)], steps=int(steps))


def _refuse(phase: Phase, name: str) -> None:
    if phase.surfaces:
        raise BadInput(f"backend {name!r} knows no events, kinks or turns; give a t_end only, or use scipy-dop853")
    if not all(isinstance(v, Steps) for v in phase.system.values):
        raise BadInput(f"backend {name!r} takes Steps and Formula parts only, not plain callables; use scipy-dop853")


def _grid(phase: Phase) -> np.ndarray:
    ends_there = len(phase.times) and phase.times[-1] == phase.t_end
    return phase.times if ends_there else np.append(phase.times, phase.t_end)


def _failed(phase: Phase, reason: str) -> Leg:
    empty = np.empty((0, len(phase.y)))
    return Leg(
        t=phase.t_start, y=phase.y, samples=empty, steps=0, failure=f"stopped after t = {phase.t_start:g} s: {reason}"
    )


def _heyoka_expressions(hy: Any, function: ca.Function, variables: list[Any]) -> list[Any]:
    """The tape of an SX function, instruction by instruction, as heyoka expressions."""
    operations = {
        ca.OP_ADD: lambda a, b: a + b, ca.OP_SUB: lambda a, b: a - b, ca.OP_MUL: lambda a, b: a * b,
        ca.OP_DIV: lambda a, b: a / b, ca.OP_NEG: lambda a: -a, ca.OP_SQ: lambda a: a * a,
        ca.OP_TWICE: lambda a: 2.0 * a, ca.OP_INV: lambda a: 1.0 / a, ca.OP_SQRT: hy.sqrt, ca.OP_SIN: hy.sin,
        ca.OP_COS: hy.cos, ca.OP_TAN: hy.tan, ca.OP_ASIN: hy.asin, ca.OP_ACOS: hy.acos, ca.OP_ATAN: hy.atan,
        ca.OP_EXP: hy.exp, ca.OP_LOG: hy.log, ca.OP_POW: lambda a, b: a**b, ca.OP_CONSTPOW: lambda a, b: a**b,
        ca.OP_ASSIGN: lambda a: a,
    }  # fmt: skip
    inputs = [[hy.time], variables, [hy.par[i] for i in range(function.size1_in(2))]]
    work: dict[int, Any] = {}
    results: list[Any] = [hy.expression(0.0)] * function.size1_out(0)
    rows = function.sparsity_out(0).row()
    for k in range(function.n_instructions()):
        op, to, of = function.instruction_id(k), function.instruction_output(k), function.instruction_input(k)
        if op == ca.OP_CONST:
            work[to[0]] = hy.expression(function.instruction_constant(k))
        elif op == ca.OP_INPUT:
            work[to[0]] = inputs[of[0]][of[1]]
        elif op == ca.OP_OUTPUT:
            results[rows[to[1]]] = work[of[0]]
        elif op in operations:
            work[to[0]] = operations[op](*(work[i] for i in of))
        else:
            raise BadInput(f"backend 'heyoka' cannot take operation {op} of the equations; use scipy-dop853")
    return results
