"""Where a function of one number is zero or least, without the time that it takes to load scipy's optimizers."""

import math
from collections.abc import Callable

from mechsym.quantities.units import Pure

_ROUNDING = 2.0**-52
_FLAT = math.sqrt(2.2e-16)  # of a number: nearer than that a least value does not change
_GOLDEN = (3 - math.sqrt(5)) / 2
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


def minimum(function: Callable[[float], float], low: float, high: float, xtol: float = 1e-5) -> tuple[float, float]:
    r"""Where a function of a number x is least between two ends, and its value, by Brent's method [unit of x, of f].

    Steps to the vertex of a parabola through the three best points where they shrink fast enough, golden sections
    elsewhere; the ends themselves are never asked. xtol: how near, beside the rounding that a least value leaves,

    .. math:: |x - x_0| \le x_\mathrm{tol} + 3 \sqrt{\epsilon}\,|x|

    Valid: one minimum between the ends; of several it gives one. Source: R. P. Brent, Algorithms for Minimization
    without Derivatives, Prentice-Hall 1973, chapter 5.
    """
    x = second = third = low + _GOLDEN * (high - low)
    f = f_second = f_third = float(function(x))
    step = before = 0.0
    for _ in range(_MOST):
        middle, near = (low + high) / 2, _FLAT * abs(x) + xtol / 3
        if abs(x - middle) <= 2 * near - (high - low) / 2:
            break
        r, q = (x - second) * (f - f_third), (x - third) * (f - f_second)
        p, q = (x - third) * q - (x - second) * r, 2 * (q - r)
        p, q = (-p if q > 0 else p), abs(q)
        last, before = before, step
        if abs(last) > near and abs(p) < abs(q * last / 2) and q * (low - x) < p < q * (high - x):
            step = p / q
            if min(x + step - low, high - x - step) < 2 * near:  # not right beside an end
                step = math.copysign(near, middle - x)
        else:
            before = (low if x >= middle else high) - x
            step = _GOLDEN * before
        u = x + (step if abs(step) > near else math.copysign(near, step))
        f_u = float(function(u))
        if f_u <= f:
            low, high = (x, high) if u >= x else (low, x)
            third, f_third, second, f_second, x, f = second, f_second, x, f, u, f_u
            continue
        low, high = (u, high) if u < x else (low, u)
        if f_u <= f_second or second == x:
            third, f_third, second, f_second = second, f_second, u, f_u
        elif f_u <= f_third or third in (x, second):
            third, f_third = u, f_u
    return x, f
