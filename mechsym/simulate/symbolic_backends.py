"""Backends that take the equations as one expression: CVODES inside CasADi, and heyoka's Taylor method.

Both know steps in time, which the caller splits, but no surfaces and no plain Python callables.
"""

from typing import Any

import casadi as ca
import numpy as np

from mechsym.errors import BadInput, MissingExtra
from mechsym.simulate.phase import Leg, Phase
from mechsym.simulate.problem import Steps


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
