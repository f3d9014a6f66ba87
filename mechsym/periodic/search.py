"""Where a function of one number vanishes or is lowest, by Brent's methods, step by step as scipy takes them."""

import math
from collections.abc import Callable

_EPS = 2.0**-52
_MOST = 100  # steps to a root
_GOLDEN = (3 - math.sqrt(5)) / 2


def root(
    function: Callable[[float], float], low: float, high: float, xtol: float = 2e-12, rtol: float = 4 * _EPS
) -> float:
    """Where a function changes its sign, the same number as `scipy.optimize.brentq`.

    Parameters
    ----------
    function : callable
        Of other signs at `low` and `high`
    low, high : float
        Ends [unit of the argument]
    xtol, rtol : float
        Error of the root [unit of the argument], and as a share of it [-]

    Returns
    -------
    x : float
        [unit of the argument]

    Notes
    -----
    Source: R. P. Brent, Algorithms for Minimization Without Derivatives, chapter 4.

    Examples
    --------
    >>> round(root(lambda x: x**2 - 2, 0.0, 2.0), 12)
    1.414213562373
    """
    before, now = float(low), float(high)
    f_before, f_now = _value(function, before), _value(function, now)
    if f_before == 0 or f_now == 0:
        return before if f_before == 0 else now
    if (f_before < 0) == (f_now < 0):
        raise ValueError(f"f({low}) = {f_before} and f({high}) = {f_now} are of one sign")
    other, f_other, last, step = before, f_before, 0.0, 0.0
    for _ in range(_MOST):
        if f_before and f_now and (f_before < 0) != (f_now < 0):
            other, f_other, last, step = before, f_before, now - before, now - before
        if abs(f_other) < abs(f_now):
            before, now, other = now, other, now
            f_before, f_now, f_other = f_now, f_other, f_now
        least, half = (xtol + rtol * abs(now)) / 2, (other - now) / 2
        if f_now == 0 or abs(half) < least:
            return now
        last, step = _step(half, least, last, step, (before, now, other), (f_before, f_now, f_other))
        before, f_before = now, f_now
        now += step if abs(step) > least else math.copysign(least, half)
        f_now = _value(function, now)
    raise RuntimeError(f"no root within {_MOST} steps")


def _value(function: Callable[[float], float], x: float) -> float:
    f = float(function(x))
    if math.isnan(f):
        raise ValueError(f"f({x}) is not a number")
    return f


def _step(
    half: float, least: float, last: float, step: float, x: tuple[float, float, float], f: tuple[float, float, float]
) -> tuple[float, float]:
    """The step before the next, and the next: by a line or a hyperbola where that converges, else half of the rest."""
    (before, now, other), (f_before, f_now, f_other) = x, f
    if not (abs(last) > least and abs(f_now) < abs(f_before)):
        return half, half
    if before == other:
        wanted = -f_now * (now - before) / (f_now - f_before)
    else:
        by_before, by_other = (f_before - f_now) / (before - now), (f_other - f_now) / (other - now)
        wanted = -f_now * (f_other * by_other - f_before * by_before) / (by_other * by_before * (f_other - f_before))
    return (step, wanted) if 2 * abs(wanted) < min(abs(last), 3 * abs(half) - least) else (half, half)


def lowest(function: Callable[[float], float], low: float, high: float, xatol: float = 1e-5) -> float:
    """Where a function is lowest, the same number as `scipy.optimize.minimize_scalar` with ``method="bounded"``.

    Parameters
    ----------
    function : callable
        With one lowest point between `low` and `high`
    low, high : float
        Ends, which are not tried [unit of the argument]
    xatol : float
        Error of the place [unit of the argument]

    Returns
    -------
    x : float
        [unit of the argument]

    Notes
    -----
    Source: R. P. Brent, Algorithms for Minimization Without Derivatives, chapter 5. Valid: 500 values at most.

    Examples
    --------
    >>> round(lowest(lambda x: (x - 1) ** 2, 0.0, 3.0), 6)
    1.0
    """
    a, b = float(low), float(high)
    best = second = third = a + _GOLDEN * (b - a)
    f_best = f_second = f_third = float(function(best))
    last = step = 0.0
    for _ in range(499):
        middle, least = (a + b) / 2, math.sqrt(2.2e-16) * abs(best) + xatol / 3
        if abs(best - middle) <= 2 * least - (b - a) / 2:
            break
        last, step = _towards((a, b), least, last, step, (best, second, third), (f_best, f_second, f_third))
        x = best + math.copysign(max(abs(step), least), step if step else 1.0)
        f = float(function(x))
        if f <= f_best:
            a, b = (best, b) if x >= best else (a, best)
            third, f_third, second, f_second, best, f_best = second, f_second, best, f_best, x, f
            continue
        a, b = (x, b) if x < best else (a, x)
        if f <= f_second or second == best:
            third, f_third, second, f_second = second, f_second, x, f
        elif f <= f_third or third in (best, second):
            third, f_third = x, f
    return best


def _towards(
    ends: tuple[float, float], least: float, last: float, step: float,
    x: tuple[float, float, float], f: tuple[float, float, float],
) -> tuple[float, float]:  # fmt: skip
    """The step before the next, and the next: to the foot of a parabola that has one inside, else golden section."""
    (a, b), (best, second, third), (f_best, f_second, f_third) = ends, x, f
    middle = (a + b) / 2
    if abs(last) > least:
        r, q = (best - second) * (f_best - f_third), (best - third) * (f_best - f_second)
        p, q = (best - third) * q - (best - second) * r, 2 * (q - r)
        p, q = -p if q > 0 else p, abs(q)
        if abs(p) < abs(0.5 * q * last) and q * (a - best) < p < q * (b - best):
            foot = best + p / q
            near = foot - a < 2 * least or b - foot < 2 * least
            return step, math.copysign(least, middle - best if middle != best else 1.0) if near else p / q
    rest = (a if best >= middle else b) - best
    return rest, _GOLDEN * rest
