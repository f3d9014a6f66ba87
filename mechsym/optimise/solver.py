r"""The design problem as a nonlinear programme for IPOPT, with exact first and second derivatives.

Variables run from 0 to 1 over their range, figures are divided by the size of their limit. A limit on a peak is a
limit on every value along the cycle; a peak as objective is the smallest bound that all values obey. The multiplier of
a limit, turned back into SI, is what it costs: the change of the objective by the change of the limit.
"""

import dataclasses
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import casadi as ca
import numpy as np

from mechsym.cycle.closed.differentiable import SCALAR_UNITS, design_function
from mechsym.cycle.closed.model import ClosedEngine, at_design
from mechsym.optimise.problem import Limit, Programme
from mechsym.quantities import record
from mechsym.quantities.display import quantity_text

_STATUS = {"Solve_Succeeded": "optimal", "Infeasible_Problem_Detected": "infeasible"}
_ACTIVE = 1e-6  # a limit counts as met this closely, in units of its own size or range
_OPTIONS: dict[str, Any] = {
    "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-10, "max_iter": 300},
    "print_time": False,
}
_MARGIN = 0.01  # the start keeps off the bounds of the variables


@record
class Optimum:
    """What the solver found."""

    #: `optimal`, `infeasible` or `not converged`, and the solver's own words
    status: str
    reason: str
    variables: Mapping[str, float]
    objective: float  #: [SI]
    figures: Mapping[str, float]  #: All figures at the design; of peaks the largest value at the ends of the steps
    #: dJ/d(limit) of each variable's and each figure's bound, 0 where it is not active, SI
    multipliers: Mapping[str, float]
    active: tuple[dict[str, Any], ...]  #: Active limits: name, side, limit, unit, multiplier, meaning
    iterations: int


class _Block(NamedTuple):
    """One limit in the programme: expression and bounds divided by `scale`."""

    limit: Limit
    scale: float
    expression: Any


def solve(task: Programme) -> Optimum:
    """Solve a design problem.

    Returns
    -------
    optimum : Optimum
        With status and reason; where there is no feasible design, the last one that was tried
    """
    low, high = _bounds(task.variables)
    figures = _function(task)
    z = ca.MX.sym("z", low.size)
    values = dict(zip(figures.name_out(), figures.call([low + z * (high - low)]), strict=True))
    blocks = [_block(limit, values[limit.name]) for limit in task.constraints]
    size = _size(task, figures)
    free, goal, rows = z, -task.sign * values[task.objective] / size, [b.expression for b in blocks]
    if task.objective not in SCALAR_UNITS:
        goal = ca.MX.sym("peak")
        free, rows = ca.vertcat(z, goal), [*rows, values[task.objective] / size - goal]
    programme = {"x": free, "f": goal, "g": ca.vertcat(*rows)}
    solver = ca.nlpsol("design", "ipopt", programme, _OPTIONS)
    found = solver(x0=_start(task, free.numel()), **_programme_bounds(blocks, rows, low.size, free.numel()))
    return _optimum(task, figures, solver.stats(), found, blocks, size)


def pareto(
    task: Any, against: str, goal: str, points: int, one: Callable[[Any], Optimum] | None = None
) -> list[Optimum]:
    """Best values of the objective for given values of a second figure.

    Parameters
    ----------
    task : Programme or FigureProgramme
        What is solved by `one`, which is `solve` where it is left out

    Returns
    -------
    front : list of Optimum
        From the optimum of the objective alone to that of the second figure alone; figures tell both values
    """
    sign = 1.0 if goal == "maximise" else -1.0
    one = one or solve
    ends = [one(task), one(dataclasses.replace(task, objective=against, sign=sign))]
    if any(end.status != "optimal" for end in ends):
        return ends
    front = [ends[0]]
    for value in np.linspace(ends[0].figures[against], ends[1].figures[against], points)[1:]:
        low, high = (float(value), np.inf) if sign > 0 else (-np.inf, float(value))
        limit = Limit(name=against, unit=task.units[against], low=low, high=high)
        front.append(one(dataclasses.replace(task, constraints=(*task.constraints, limit))))
    return front


def _bounds(limits: Sequence[Limit]) -> tuple[np.ndarray, np.ndarray]:
    return np.array([v.low for v in limits]), np.array([v.high for v in limits])


def _function(task: Programme) -> ca.Function:
    names = [v.name for v in task.variables]
    z = ca.MX.sym("z", len(names))
    if "omega" in names:
        return design_function(task.engine, names)
    whole = design_function(task.engine, ["omega", *names])
    return ca.Function("figures", [z], whole.call([ca.vertcat(task.omega, z)]), ["design"], whole.name_out())


def _block(limit: Limit, expression: Any) -> _Block:
    finite = [abs(b) for b in (limit.low, limit.high) if np.isfinite(b) and b != 0]
    scale = max(finite, default=1.0)
    return _Block(limit, scale, expression / scale)


def _start(task: Programme, count: int) -> np.ndarray:
    low, high = _bounds(task.variables)
    inside = np.clip((_nominal(task) - low) / (high - low), _MARGIN, 1 - _MARGIN)
    return np.concatenate([inside, np.ones(count - inside.size)])


def _nominal(task: Programme) -> np.ndarray:
    return np.array([task.omega if v.name == "omega" else _value(task.engine, v.name) for v in task.variables])


def _value(engine: ClosedEngine, name: str) -> float:
    section, _, key = name.partition(".")
    here = at_design(engine, {})
    return here.motion.parameters[key] if section == "parameters" else getattr(getattr(here, section), key)


def _size(task: Programme, figures: ca.Function) -> float:
    return abs(_largest(figures, _nominal(task))[task.objective]) or 1.0


def _largest(figures: ca.Function, design: Any) -> dict[str, float]:
    values = figures.call([design])
    return {name: float(ca.mmax(v)) for name, v in zip(figures.name_out(), values, strict=True)}


def _programme_bounds(blocks: Sequence[_Block], rows: Sequence[Any], variables: int, count: int) -> dict[str, Any]:
    peak = count - variables  # 1 when a peak is minimised: one more unknown, one more group of rows
    ends = [(b.limit.low / b.scale, b.limit.high / b.scale) for b in blocks] + [(-np.inf, 0.0)] * peak
    low, high = ([ca.repmat(e[k], r.numel(), 1) for e, r in zip(ends, rows, strict=True)] for k in (0, 1))
    return {
        "lbx": [0.0] * variables + [-np.inf] * peak, "ubx": [1.0] * variables + [np.inf] * peak,
        "lbg": ca.vertcat(*low), "ubg": ca.vertcat(*high),
    }  # fmt: skip


def _optimum(
    task: Programme, figures: ca.Function, stats: Any, found: Any, blocks: Sequence[_Block], size: float
) -> Optimum:
    low, high = _bounds(task.variables)
    share = np.asarray(found["x"]).ravel()[: low.size]
    design = np.clip(low + share * (high - low), low, high)  # IPOPT relaxes bounds by 1e-8
    values = _largest(figures, design)
    # IPOPT minimises -sign J/size, or the peak itself; its multipliers are -d(minimum)/d(bound)
    factor = size * (task.sign if task.objective in SCALAR_UNITS else -1.0)
    lam_x = factor * np.asarray(found["lam_x"]).ravel()[: low.size] / (high - low)
    lam_g, costs, at = factor * np.asarray(found["lam_g"]).ravel(), {}, 0
    for block in blocks:
        n = block.expression.numel()
        costs[block.limit.name] = float(lam_g[at : at + n].sum() / block.scale)
        at += n
    status = stats["return_status"]
    multipliers = {v.name: float(m) for v, m in zip(task.variables, lam_x, strict=True)} | costs
    variables = {v.name: float(d) for v, d in zip(task.variables, design, strict=True)}
    named = task.objective
    active = [active_limit(named, v, variables[v.name], v.high - v.low, multipliers) for v in task.variables]
    active += [active_limit(named, b.limit, values[b.limit.name], b.scale, multipliers) for b in blocks]
    met = [row for row in active if row]
    return Optimum(
        status=_STATUS.get(status, "not converged"), reason=status, variables=variables,
        objective=values[task.objective], figures=values, active=tuple(met), iterations=int(stats["iter_count"]),
        multipliers={n: m if n in {row["name"] for row in met} else 0.0 for n, m in multipliers.items()},
    )  # fmt: skip


def active_limit(
    objective: str, limit: Limit, value: float, scale: float, costs: Mapping[str, float]
) -> dict[str, Any]:
    """What an active limit costs, in words too; empty where it is not met.

    Parameters
    ----------
    value : float
        Of the variable or figure [unit of the limit]
    scale : float
        Its range or size [unit of the limit]
    costs : mapping of str to float
        Change of the objective by that of each limit [SI]
    """
    for side, bound in (("low", limit.low), ("high", limit.high)):
        if abs(value - bound) < _ACTIVE * scale:
            cost, step = costs[limit.name], abs(bound) / 100 or scale / 100
            meaning = (
                f"{quantity_text(step, limit.unit, 4)} more there (1 %) would change {objective} by {cost * step:+.4g}"
            )
            name = "equal" if limit.low == limit.high else side
            row = {"name": limit.name, "side": name, "limit": bound, "unit": limit.unit}
            return row | {"multiplier": cost, "meaning": meaning}
    return {}
