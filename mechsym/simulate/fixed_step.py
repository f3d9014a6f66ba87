"""Fixed steps, as block-diagram programs take them by default: only to show what they do to a result.

Runge-Kutta formulas of order 3 (Bogacki and Shampine) and 4 (classical). Without error control they damp or feed an
oscillation by an amount that depends on the step, so a resonance may be held for ever or end at a false amplitude.
"""

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities.units import Array, Second
from mechsym.simulate.equations import held, right_side, system
from mechsym.simulate.problem import Problem, Steps

# nodes and the matrix of a formula below its diagonal; the last row are the weights
_FORMULAS = {
    3: ((0.0, 0.5, 0.75), ((0.5,), (0.0, 0.75), (2 / 9, 1 / 3, 4 / 9))),
    4: ((0.0, 0.5, 0.5, 1.0), ((0.5,), (0.0, 0.5), (0.0, 0.0, 1.0), (1 / 6, 1 / 3, 1 / 3, 1 / 6))),
}


def fixed_step(problem: Problem, step: Second, order: int) -> tuple[Second[Array], np.ndarray]:
    """Integrate a problem with one step throughout, jumps in time not split.

    problem: parts that are `Steps` or `Formula`; stops, turns and kinks are not heeded. Returns y: states as in
    `equations.system`; rows after an overflow are left out [SI, by column], shape (n, m).
    """
    if order not in _FORMULAS:
        raise BadInput(f"order = {order} is not an option; options are {', '.join(map(str, _FORMULAS))}")
    equations = system(problem)
    if not all(isinstance(v, Steps) for v in equations.values):
        raise BadInput("fixed_step takes Steps and Formula parts only; give the callable as a Formula")
    count = round((problem.t_end - problem.t_start) / step)
    t = problem.t_start + step * np.arange(count + 1)
    y = np.zeros((count + 1, len(equations.columns)))
    y[0, : 2 * equations.size] = [*problem.q0, *problem.u0]
    nodes, rows = _FORMULAS[order]
    w, f = None, right_side(equations, held(equations, t[0]), np.inf)
    for i in range(count):
        values = held(equations, t[i])
        if w is None or not np.array_equal(values, w):
            w, f = values, right_side(equations, values, np.inf)
        slopes = [f(t[i], y[i])]
        for node, row in zip(nodes[1:], rows[:-1], strict=True):
            slopes.append(f(t[i] + node * step, y[i] + step * sum(a * k for a, k in zip(row, slopes, strict=False))))
        y[i + 1] = y[i] + step * sum(b * k for b, k in zip(rows[-1], slopes, strict=True))
        if not np.all(np.abs(y[i + 1]) < 1e9):
            return t[: i + 1], y[: i + 1]
    return t, y
