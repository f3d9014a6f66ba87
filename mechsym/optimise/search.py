r"""The design problem where figures come from a cycle that is solved, without derivatives: sequential quadratic steps.

.. math:: \nabla J = \sum_i \lambda_i \nabla g_i \quad\text{over the active limits}, \qquad
          \lambda_i = \frac{dJ}{d\,\mathrm{limit}_i}

Gradients are differences of the figures, over a thousandth of a range, or more where a cycle in fixed steps gives
figures that jump as a timing passes from one step to the next. A design counts as an optimum where that sum
holds and no limit pulls the wrong way; it is the best one nearby.
"""

import math
import time
from collections.abc import Callable, Mapping

import numpy as np
from scipy.optimize import minimize

from mechsym import budget
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.optimise.fit import unit_columns
from mechsym.optimise.solver import DesignTask, Limit, Optimum, optimum_of
from mechsym.quantities import record

_STEP = 1e-3  # of a variable's range, for differences
_MARGIN = 0.01  # the start keeps off the bounds of the variables
_STEPS, _STILL = 60, 1e-8  # steps at most, and the change of the objective by its size at the last one
_MET, _BALANCED = 1e-6, 2e-3  # a limit, and the first-order conditions by the objective's gradient


@record
class FigureProgramme(DesignTask):
    """A design problem whose figures are computed one design at a time."""

    figures: Callable[[np.ndarray], Mapping[str, float]]  #: Variables (k,) [SI] to figures [SI]; may refuse a design
    start: np.ndarray  #: shape (k,) [SI]
    noise: float = 0.0  #: By which a figure of a cycle in fixed steps may be off, by its size [-]

    @property
    def step(self) -> float:
        """Of a variable's range, for differences [-]."""
        return max(_STEP, 2 * math.sqrt(self.noise))


class _Figures:
    """Figures over shares of the variables' ranges, each computed once."""

    def __init__(self, task: FigureProgramme) -> None:
        self.low, self.high = (np.array([getattr(v, side) for v in task.variables]) for side in ("low", "high"))
        self.task, self.known = task, {}  # type: ignore[var-annotated]

    def design(self, z: np.ndarray) -> np.ndarray:
        return np.asarray(self.low + np.clip(z, 0, 1) * (self.high - self.low))

    def __call__(self, z: np.ndarray) -> Mapping[str, float]:
        key = np.asarray(z, float).tobytes()
        if key not in self.known:
            self.known[key] = self.task.figures(self.design(z))
        return self.known[key]

    def slopes(self, z: np.ndarray, names: list[str]) -> np.ndarray:
        """Differences of figures, shape (figures, variables), of second order at the ends of a range too."""
        slopes, width = np.empty((len(names), len(z))), self.task.step
        for k in range(len(z)):
            step = np.zeros(len(z))
            step[k] = width
            if width <= z[k] <= 1 - width:
                points, weights = (z + step, z - step), (0.5, -0.5)
            else:
                step = step if z[k] < 0.5 else -step
                points = (z, z + step, z + 2 * step)  # type: ignore[assignment]
                weights = tuple(w * np.sign(step[k]) for w in (-1.5, 2.0, -0.5))
            values = [self(point) for point in points]
            slopes[:, k] = [sum(w * v[n] for w, v in zip(weights, values, strict=True)) / width for n in names]
        return slopes


def search(task: FigureProgramme) -> Optimum:
    """Solve a design problem by its figures; the last design tried where none is feasible, with the reason."""
    figures = _Figures(task)
    z = np.clip((task.start - figures.low) / (figures.high - figures.low), _MARGIN, 1 - _MARGIN)
    began = time.process_time()
    size = abs(figures(z)[task.objective]) or 1.0
    points = _STEPS * (2 * len(z) + 1)  # as many figures as a search takes at most
    seconds = (time.process_time() - began) * points
    budget.require(f"a search over {len(z)} variables, {points} points", seconds, 0.0, "free fewer variables")
    try:
        result = minimize(
            lambda u: -task.sign * figures(u)[task.objective] / size,
            z,
            method="SLSQP",
            bounds=[(0, 1)] * len(z),
            jac=lambda u: -task.sign * figures.slopes(u, [task.objective])[0] / size,
            constraints=[row for limit in task.constraints for row in _rows(limit, figures)],
            options={"maxiter": _STEPS, "ftol": max(_STILL, task.noise / 4)},
        )
    except BadInput as error:
        return _optimum(task, figures, z, f"a design on the way is refused: {error}", 0)
    end = np.clip(result.x, 0, 1)
    return _optimum(task, figures, end, "" if result.success else str(result.message), int(result.nit))


def _scale(limit: Limit) -> float:
    return max((abs(b) for b in (limit.low, limit.high) if math.isfinite(b) and b), default=1.0)


def _rows(limit: Limit, figures: _Figures) -> list[Json]:
    """A limit in the words of the solver, divided by its size."""
    scale, equal = _scale(limit), limit.low == limit.high
    sides = [(limit.low, 1.0), (limit.high, -1.0)][: 1 if equal else 2]
    return [
        {
            "type": "eq" if equal else "ineq",
            "fun": lambda u, bound=bound, sign=sign: sign * (figures(u)[limit.name] - bound) / scale,
            "jac": lambda u, sign=sign: sign * figures.slopes(u, [limit.name])[0] / scale,
        }
        for bound, sign in sides
        if math.isfinite(bound)
    ]


def _optimum(task: FigureProgramme, figures: _Figures, z: np.ndarray, trouble: str, steps: int) -> Optimum:
    design, values = figures.design(z), figures(z)
    variables = {v.name: float(d) for v, d in zip(task.variables, design, strict=True)}
    missed = max((_missed(limit, values[limit.name]) for limit in task.constraints), default=0.0)
    at_ends = [v for v, share in zip(task.variables, z, strict=True) if min(share, 1 - share) < _MET]
    met = [c for c in task.constraints if abs(_missed(c, values[c.name])) < _MET]
    costs, left = (dict.fromkeys([v.name for v in task.variables], 0.0), 0.0)
    if not trouble:
        costs, left = _multipliers(task, figures, z, at_ends, met)
    status, reason = "optimal", f"first-order conditions hold to {left:.1e}"
    if missed > _MET:
        status, reason = "infeasible", f"no design nearby keeps all limits; the worst is missed by {missed:.2g} of it"
    elif trouble or left > max(_BALANCED, math.sqrt(task.noise)):
        status, reason = "not converged", trouble or f"first-order conditions are missed by {left:.1e}"
    limits = [(v, variables[v.name], v.high - v.low) for v in task.variables]
    limits += [(c, values[c.name], _scale(c)) for c in met if c.name in costs]
    every = {limit.name: costs.get(limit.name, 0.0) for limit in (*task.variables, *task.constraints)}
    return optimum_of(task, status, reason, variables, values, limits, every, steps)


def _missed(limit: Limit, value: float) -> float:
    """How far a value lies beyond the nearer limit, by its size; below 0 inside."""
    return max(limit.low - value, value - limit.high) / _scale(limit)


def _multipliers(
    task: FigureProgramme, figures: _Figures, z: np.ndarray, ends: list[Limit], met: list[Limit]
) -> tuple[dict[str, float], float]:
    """Change of the objective by that of each active limit, and what the first-order conditions leave over."""
    slopes = figures.slopes(z, [task.objective, *(limit.name for limit in met)])
    spans = figures.high - figures.low
    names = [v.name for v in task.variables]
    unit = np.eye(len(names))[[names.index(v.name) for v in ends]] * spans  # of the variables at their ends
    columns = np.vstack([unit.reshape(-1, len(names)), slopes[1:]]).T
    units, width = unit_columns(columns)
    factors = np.linalg.lstsq(units, slopes[0], rcond=1e-9)[0] / width if columns.size else np.zeros(0)
    size = max(abs(figures(z)[task.objective]), float(np.abs(slopes[0]).max()), 1e-300)
    left = float(np.abs(slopes[0] - columns @ factors).max()) / size
    active = [limit.name for limit in (*ends, *met)]
    costs = dict.fromkeys(names, 0.0) | dict(zip(active, factors.tolist(), strict=True))
    wrong = [_wrong(task, figures, z, limit, costs[limit.name]) / size for limit in (*ends, *met)]
    return costs, max([left, *wrong])


def _wrong(task: FigureProgramme, figures: _Figures, z: np.ndarray, limit: Limit, cost: float) -> float:
    """What a limit gains that pulls the wrong way: a wider one must not make the design worse."""
    if limit.low == limit.high:
        return 0.0
    names = [v.name for v in task.variables]
    if limit.name in names:
        at_high, scale = z[names.index(limit.name)] > 0.5, limit.high - limit.low
    else:
        value, scale = figures(z)[limit.name], _scale(limit)
        at_high = abs(value - limit.high) <= abs(value - limit.low)
    better = task.sign * cost * (1.0 if at_high else -1.0)
    return max(0.0, -better * scale)
