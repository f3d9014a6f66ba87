r"""One explicit Runge-Kutta method of order eight as a table, and one function that folds it over equal steps.

The engine's differential equation is integrated with steps that are fixed beforehand, in a variable in which it is
smooth: the result is then a differentiable function of every parameter, and all speeds run through the same
operations. Accuracy is checked afterwards (first law), and steps are added where it is wanting.

Source: Cooper and Verner (1972), "Some explicit Runge-Kutta methods of high order", SIAM J. Numer. Anal. 9;
eleven stages, order 8, nodes of the Lobatto quadrature.
"""

from collections.abc import Callable

import casadi as ca

from mechsym.native.fold import Method
from mechsym.quantities.units import Pure, Scalar

_S = 21**0.5
_A: tuple[dict[int, float], ...] = (
    {},
    {0: 1 / 2},
    {0: 1 / 4, 1: 1 / 4},
    {0: 1 / 7, 1: (-7 - 3 * _S) / 98, 2: (21 + 5 * _S) / 49},
    {0: (11 + _S) / 84, 2: (18 + 4 * _S) / 63, 3: (21 - _S) / 252},
    {0: (5 + _S) / 48, 2: (9 + _S) / 36, 3: (-231 + 14 * _S) / 360, 4: (63 - 7 * _S) / 80},
    {0: (10 - _S) / 42, 2: (-432 + 92 * _S) / 315, 3: (633 - 145 * _S) / 90, 4: (-504 + 115 * _S) / 70,
     5: (63 - 13 * _S) / 35},
    {0: 1 / 14, 4: (14 - 3 * _S) / 126, 5: (13 - 3 * _S) / 63, 6: 1 / 9},
    {0: 1 / 32, 4: (91 - 21 * _S) / 576, 5: 11 / 72, 6: (-385 - 75 * _S) / 1152, 7: (63 + 13 * _S) / 128},
    {0: 1 / 14, 4: 1 / 9, 5: (-733 - 147 * _S) / 2205, 6: (515 + 111 * _S) / 504, 7: (-51 - 11 * _S) / 56,
     8: (132 + 28 * _S) / 245},
    {4: (-42 + 7 * _S) / 18, 5: (-18 + 28 * _S) / 45, 6: (-273 - 53 * _S) / 72, 7: (301 + 53 * _S) / 72,
     8: (28 - 28 * _S) / 45, 9: (49 - 7 * _S) / 18},
)  # fmt: skip
_B = {0: 1 / 20, 7: 49 / 180, 8: 16 / 45, 9: 49 / 180, 10: 1 / 20}
METHOD = Method(rows=_A, weights=_B)


def step(rate: Callable[[Scalar, Scalar], Scalar], s: Pure[Scalar], y: Scalar, ds: Pure[Scalar]) -> Scalar:
    """One step of the method.

    s: independent variable at the start; y: state at the start [unit of the state]; ds: length of the step. Returns y:
    state at s + ds, shape (n,) [unit of the state].
    """
    slopes: list[Scalar] = []
    for row in METHOD.rows:
        shifted = y + ds * sum((a * slopes[j] for j, a in row.items()), 0 * y) if row else y
        slopes.append(rate(s + sum(row.values()) * ds, shifted))
    return y + ds * sum((b * slopes[j] for j, b in METHOD.weights.items()), 0 * y)


def fold(rate: ca.Function, steps: int) -> ca.Function:
    """Integration over s from 0 to 1: (y at 0, z) -> y at the ends of equal steps, shape (states, steps)."""
    s, y, z = (ca.SX.sym(name, rate.numel_in(i)) for i, name in enumerate("syz"))
    one = ca.Function("step", [y, s, z], [step(lambda s, y: rate(s, y, z), s, y, 1 / steps)])
    start, data = ca.MX.sym("y", rate.numel_in(1)), ca.MX.sym("z", rate.numel_in(2))
    starts = ca.DM([k / steps for k in range(steps)]).T
    history = one.mapaccum("steps", steps)(start, starts, ca.repmat(data, 1, steps))
    return ca.Function("fold", [start, data], [history])
