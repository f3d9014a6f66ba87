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

from mechsym.periodic.halving import DEGREE, first_edges, halved


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
    _, left, width, rows = halved(lambda phi, who: function(phi), first_edges(breaks, period), 1, tol)
    return _assembled(left, width, rows, period)


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


def _assembled(left: np.ndarray, width: np.ndarray, rows: np.ndarray, period: float) -> "scipy.interpolate.PPoly":
    # PPoly counts from the left break in radians, not in shares of the piece
    scale = width ** np.arange(DEGREE, -1, -1)[:, None]
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
