"""Periodic piecewise polynomials: a torque or a guide as pieces that break at the kinks of the cycle.

The pressure of an engine cycle is smooth between its kinks and only finitely smooth at some of them: a Wiebe function
starts like y**(m + 1) with m between 0.7 and 2.2. A spline with even knots loses most of its accuracy there. `fit` puts
breaks at the kinks and halves a piece until its polynomial is right, so pieces grow away from a kink:

       kink                       kink
    ----|-|--|----|--------|----|--|-|-|--|----> phi
        0                                period

What it returns is a `scipy.interpolate.PPoly` with ``extrapolate="periodic"``: it takes any real angle, and
derivative and antiderivative are exact. `scalar` makes the fast function of one float that a time simulation needs.
"""

import math
from bisect import bisect_right
from collections.abc import Callable, Iterable

import numpy as np
import scipy
from numpy.polynomial import chebyshev

from mechsym.errors import BadInput

_DEGREE = 9
_FIRST_PIECES = 12  # evenly over the period, so that no narrow feature hides between the first check points
_LEVELS = 44  # halvings of a piece; beyond that the angle itself is not resolved
_OPEN = 4096  # pieces open at once; a kink opens a few, only noise opens them all
_NOISE = 1e-9  # of the largest value: rounding that the function may bring itself


def even_angles(period: float, count: int = 4096) -> np.ndarray:
    """Even crank angles over a period, without its end.

    Parameters
    ----------
    period : float
        Period [rad]

    Returns
    -------
    phi : ndarray, shape (count,)
        Angles [rad]
    """
    return np.arange(count) * period / count


def fit(
    function: Callable[[np.ndarray], np.ndarray], breaks: Iterable[float], period: float, tol: float = 1e-12
) -> "scipy.interpolate.PPoly":
    """Periodic piecewise polynomial that follows a function within a tolerance.

    Parameters
    ----------
    function : callable
        Vectorised: angles of shape (n,) [rad] to values of shape (n,), or (parts, n) for several functions at once
    breaks : iterable of float
        Angles where the function is not smooth, any real numbers [rad]
    period : float
        Period of the function [rad]
    tol : float
        Largest error, as a share of the largest value of all parts [-]

    Returns
    -------
    poly : scipy.interpolate.PPoly
        Breaks from 0 to `period`; values of shape (n,), or (n, parts)

    Raises
    ------
    BadInput
        The function is not finite, jumps at an angle that is not among the breaks, or is noisy beyond 1e-9

    Notes
    -----
    Degree 9 through Chebyshev nodes; none lies on a break, so a jump at a break does no harm. The error is measured at
    other points than the nodes. Where the function is rounded more coarsely than `tol`, halving stops at its noise.
    """
    edges = _first_edges(breaks, period)
    left, width = edges[:-1], np.diff(edges)
    done, scale = [], 0.0
    for _ in range(_LEVELS):
        values = _sampled(function, left, width)
        scale = max(scale, float(np.abs(values).max()))
        # two steps: one product of both matrices would lose five digits to its large entries
        rows = np.tensordot(_TO_POWERS, np.tensordot(_TO_CHEBYSHEV, values[_NODES], 1), 1)
        error = np.abs(np.tensordot(_CHECK_POWERS, rows, 1) - values[_CHECKS])
        good = error.max(axis=(0, *range(2, error.ndim))) <= (tol if left.size < _OPEN else max(tol, _NOISE)) * scale
        done.append((left[good], width[good], rows[:, good]))
        if good.all():
            return _assembled(done, period)
        if left.size >= _OPEN and np.mean(good) < 0.5:
            raise BadInput(
                f"the function is noise of {error.max() / scale:.2g} of its peak near {left[0]:.9g} rad; smooth it"
            )
        half = width[~good] / 2
        left, width = np.concatenate([left[~good], left[~good] + half]), np.concatenate([half, half])
    raise BadInput(f"the function jumps near {left[0]:.9g} rad: list that angle among the kinks, or smooth it")


def mean(poly: "scipy.interpolate.PPoly") -> float:
    """Mean over a period.

    Returns
    -------
    mean : float
        [unit of the values]
    """
    return float(_integral(poly)(poly.x[-1]) / (poly.x[-1] - poly.x[0]))


def antiderivative(poly: "scipy.interpolate.PPoly") -> "scipy.interpolate.PPoly":
    """Exact integral from the first break, without the drift that a mean would bring.

    Returns
    -------
    integral : scipy.interpolate.PPoly
        Periodic: integral of f - mean(f), 0 at the first break
    """
    level = scipy.interpolate.PPoly(poly.c.copy(), poly.x, extrapolate="periodic")
    level.c[-1] -= mean(poly)
    integral = _integral(level)
    return scipy.interpolate.PPoly(integral.c, integral.x, extrapolate="periodic")


def scalar(poly: "scipy.interpolate.PPoly") -> Callable[[float], tuple[float, float]]:
    """Fast evaluation for one float at a time: the value and its derivative.

    Parameters
    ----------
    poly : scipy.interpolate.PPoly
        Periodic piecewise polynomial with values of shape (n,)

    Returns
    -------
    function : callable
        phi, any real number [rad] -> (value, derivative)

    Notes
    -----
    Bisection and Horner's rule in plain Python, about 1 microsecond; scipy needs about 15 for a single number.
    """
    start, period = float(poly.x[0]), float(poly.x[-1] - poly.x[0])
    lefts, inner = poly.x[:-1].tolist(), poly.x[1:-1].tolist()
    rows = [tuple(row) for row in poly.c.T.tolist()]

    def value_and_slope(phi: float) -> tuple[float, float]:
        phi = (phi - start) % period + start
        i = bisect_right(inner, phi)
        u = phi - lefts[i]
        value = slope = 0.0
        for c in rows[i]:
            slope = slope * u + value
            value = value * u + c
        return value, slope

    return value_and_slope


def extremes(poly: "scipy.interpolate.PPoly") -> tuple[float, float, float, float]:
    """Smallest and largest value over a period and where they are.

    Parameters
    ----------
    poly : scipy.interpolate.PPoly
        Periodic piecewise polynomial with values of shape (n,)

    Returns
    -------
    low, phi_low, high, phi_high : float
        Smallest value and its angle [rad], largest value and its angle [rad]
    """
    low, phi_low = _smallest(poly.c, poly.x)
    high, phi_high = _smallest(-poly.c, poly.x)
    return low, phi_low, -high, phi_high


def piece_points(poly: "scipy.interpolate.PPoly", count: int = 17) -> np.ndarray:
    """Angles on every piece, both of its ends included, denser towards the ends.

    Returns
    -------
    phi : ndarray, shape (pieces, count)
        Angles [rad]
    """
    u = (1 - np.cos(np.linspace(0, math.pi, count))) / 2
    return poly.x[:-1, None] + np.diff(poly.x)[:, None] * u


def piece_values(poly: "scipy.interpolate.PPoly", phi: np.ndarray) -> np.ndarray:
    """Values that take each break from the piece the point belongs to, so that both sides of a jump are seen.

    Parameters
    ----------
    poly : scipy.interpolate.PPoly
        Periodic piecewise polynomial with values of shape (n,)
    phi : ndarray, shape (pieces, count)
        Angles made by `piece_points` of a polynomial with the same breaks [rad]

    Returns
    -------
    values : ndarray, shape (pieces, count)
        [unit of the values]
    """
    u = phi - poly.x[:-1, None]
    values = np.zeros_like(u)
    for c in poly.c:
        values = values * u + c[:, None]
    return values


_CHEBYSHEV = (1 + np.cos(math.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))) / 2
_BETWEEN = (1 + np.cos(math.pi * np.arange(_DEGREE + 2) / (_DEGREE + 1))) / 2
# the outermost check points stay off the breaks, where the function may have two values
_POINTS = np.concatenate([_CHEBYSHEV, np.clip(_BETWEEN, 1e-3, 1 - 1e-3)])
_NODES, _CHECKS = slice(0, _DEGREE + 1), slice(_DEGREE + 1, None)


def _to_chebyshev() -> np.ndarray:
    n = _DEGREE + 1
    matrix = 2 / n * np.cos(math.pi * np.arange(n)[:, None] * (np.arange(n) + 0.5) / n)
    matrix[0] /= 2
    return matrix


def _to_powers() -> np.ndarray:
    # columns: powers of u in [0, 1], highest first, of the shifted Chebyshev polynomials; whole numbers, so exact
    matrix = np.zeros((_DEGREE + 1, _DEGREE + 1))
    for k in range(_DEGREE + 1):
        basis = chebyshev.Chebyshev.basis(k, domain=[0, 1]).convert(kind=np.polynomial.Polynomial)
        matrix[_DEGREE - k :, k] = np.round(basis.coef[::-1])
    return matrix


_TO_CHEBYSHEV, _TO_POWERS = _to_chebyshev(), _to_powers()
_CHECK_POWERS = np.vander(_POINTS[_CHECKS], _DEGREE + 1)


def _first_edges(breaks: Iterable[float], period: float) -> np.ndarray:
    even = np.linspace(0, period, _FIRST_PIECES + 1)
    kinks = np.unique([b % period for b in breaks])
    near = period / _FIRST_PIECES / 4
    # an even edge beside a kink would only make a short piece
    free = [e for e in even[1:-1] if kinks.size == 0 or np.abs(kinks - e).min() > near]
    edges = np.unique(np.concatenate([[0.0, period], kinks, free]))
    return edges[np.concatenate([np.diff(edges) > 1e-12 * period, [True]])]


def _sampled(function: Callable[[np.ndarray], np.ndarray], left: np.ndarray, width: np.ndarray) -> np.ndarray:
    phi = left + width * _POINTS[:, None]
    values = np.asarray(function(phi.ravel()), dtype=float)
    if not np.isfinite(values).all():
        bad = phi.ravel()[~np.isfinite(values).reshape(-1, phi.size).all(axis=0)][0]
        raise BadInput(f"the function is not finite at {bad:.9g} rad; it must have a value at every angle")
    return np.moveaxis(values.reshape(*values.shape[:-1], *phi.shape), (-2, -1), (0, 1))


def _assembled(done: list[tuple[np.ndarray, np.ndarray, np.ndarray]], period: float) -> "scipy.interpolate.PPoly":
    left, width = (np.concatenate([d[i] for d in done]) for i in (0, 1))
    rows = np.concatenate([d[2] for d in done], axis=1)
    # PPoly counts from the left break in radians, not in shares of the piece
    scale = width ** np.arange(_DEGREE, -1, -1)[:, None]
    rows = rows / scale.reshape(scale.shape + (1,) * (rows.ndim - 2))
    order = np.argsort(left)
    return scipy.interpolate.PPoly(rows[:, order], np.append(left[order], period), extrapolate="periodic")


def _integral(poly: "scipy.interpolate.PPoly") -> "scipy.interpolate.PPoly":
    return scipy.interpolate.PPoly(poly.c, poly.x, extrapolate=False).antiderivative()


def _smallest(rows: np.ndarray, x: np.ndarray) -> tuple[float, float]:
    width, powers = np.diff(x), np.arange(len(rows) - 1, -1, -1)[:, None]
    scaled = rows * width**powers
    phi = piece_points(scipy.interpolate.PPoly(rows, x))
    lowest = piece_values(scipy.interpolate.PPoly(rows, x), phi).min(axis=1)
    # between two of its points a piece dips by less than gap**2 / 8 of its largest second derivative
    dip = (math.pi / 2 / (phi.shape[1] - 1)) ** 2 / 8 * (powers * (powers - 1) * np.abs(scaled)).sum(axis=0)
    pieces = np.flatnonzero(lowest - dip <= lowest.min())
    found = [_smallest_of_piece(scaled[:, k], (phi[k] - x[k]) / width[k]) for k in pieces]
    value, u, k = min((value, u, k) for (value, u), k in zip(found, pieces, strict=True))
    return value, float(x[k] + width[k] * u)


def _smallest_of_piece(scaled: np.ndarray, points: np.ndarray) -> tuple[float, float]:
    """Smallest value over u in [0, 1] and its u; `points` are tried beside the roots of the derivative."""
    roots = np.roots(np.polyder(scaled))
    inside = roots.real[(np.abs(roots.imag) < 1e-6) & (roots.real > 0) & (roots.real < 1)]
    u = np.concatenate([inside, points])
    values = np.polyval(scaled, u)
    return float(values.min()), float(u[values.argmin()])
