"""Where a function of one number is zero, without the second that it takes to load scipy's optimizers."""

import math
from collections.abc import Callable

from mechsym.quantities.units import Pure

_ROUNDING = 2.0**-52
_MOST = 200  # of steps; halves alone need sixty


def root(
    function: Callable[[float], float], low: float, high: float, xtol: float = 2e-12, rtol: Pure = 4 * _ROUNDING
) -> float:
    r"""Where a continuous function of a number x crosses zero, by Chandrupatla's method [unit of x].

    .. math:: |x - x_0| \le x_\mathrm{tol} + r_\mathrm{tol} |x|

    Inverse quadratic steps where three points are monotonic enough for them, halves elsewhere. low, high: ends, where
    the function has different signs or is zero. Raises ValueError: it has not, or is not a number. Source: T. R.
    Chandrupatla, Adv. Eng. Software 28 (1997) 145-149.
    """
    a, b = float(low), float(high)
    f_a, f_b = float(function(a)), float(function(b))
    if f_a == 0 or f_b == 0:
        return a if f_a == 0 else b
    if (f_a > 0) == (f_b > 0) or math.isnan(f_a) or math.isnan(f_b):
        raise ValueError(f"the function is {f_a:g} at {a:g} and {f_b:g} at {b:g}: no root is enclosed")
    share = 0.5
    for _ in range(_MOST):
        x = a + share * (b - a)
        f = float(function(x))
        if math.isnan(f):
            raise ValueError(f"the function is not a number at {x:g}")
        if (f > 0) == (f_a > 0):
            c, f_c = a, f_a
        else:
            c, b, f_c, f_b = b, a, f_b, f_a
        a, f_a = x, f
        best, least = (a, f_a) if abs(f_a) < abs(f_b) else (b, f_b)
        tolerance, width = xtol + rtol * abs(best), abs(b - a)
        if least == 0 or width <= tolerance:
            return best
        x_share, f_share = (a - b) / (c - b), (f_a - f_b) / (f_c - f_b)
        share = 0.5
        if 1 - math.sqrt(1 - x_share) < f_share < math.sqrt(x_share):
            share = f_a / (f_b - f_a) * f_c / (f_b - f_c) + (c - a) / (b - a) * f_a / (f_c - f_a) * f_b / (f_c - f_b)
        edge = tolerance / width / 2
        share = min(max(share, edge), 1 - edge)
    return best
