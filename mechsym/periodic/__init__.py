"""Periodic piecewise polynomials: a torque or a guide as pieces that break at the kinks of the cycle.

The pressure of an engine cycle is smooth between its kinks and only finitely smooth at some of them: a Wiebe function
starts like y**(m + 1) with m between 0.7 and 2.2. A spline with even knots loses most of its accuracy there. `fit` puts
breaks at the kinks and halves a piece until its polynomial is right, so pieces grow away from a kink:

       kink                       kink
    ----|-|--|----|--------|----|--|-|-|--|----> phi
        0                                period

What it returns is a `PPoly` with ``extrapolate="periodic"``: it takes any real angle, and
derivative and antiderivative are exact. `scalar` makes the fast function of one float that a time simulation needs.

pieces.py  piecewise polynomials
rises.py   laws by which something rises from 0 to 1: of cams and of driven motions
roots.py   where a function of one number is zero
"""

import math
from bisect import bisect_right
from collections.abc import Callable, Iterable

import numpy as np
from numpy.polynomial import chebyshev

from mechsym.errors import BadInput
from mechsym.periodic.pieces import PPoly, zeros_of_piece
from mechsym.quantities.units import Array, Pure, Radian

DEGREE = 9
_FIRST_PIECES = 12  # evenly over the period, so that no narrow feature hides between the first check points
_LEVELS = 44  # halvings of a piece; beyond that the angle itself is not resolved
_OPEN = 4096  # pieces open at once; a kink opens a few, only noise opens them all
_NOISE = 1e-9  # of the largest value: rounding that the function may bring itself


_CHEBYSHEV = (1 + np.cos(math.pi * (np.arange(DEGREE + 1) + 0.5) / (DEGREE + 1))) / 2
_BETWEEN = (1 + np.cos(math.pi * np.arange(DEGREE + 2) / (DEGREE + 1))) / 2
# the outermost check points stay off the breaks, where the function may have two values
_POINTS = np.concatenate([_CHEBYSHEV, np.clip(_BETWEEN, 1e-3, 1 - 1e-3)])
_NODES, _CHECKS = slice(0, DEGREE + 1), slice(DEGREE + 1, None)


def _to_chebyshev() -> np.ndarray:
    n = DEGREE + 1
    matrix = 2 / n * np.cos(math.pi * np.arange(n)[:, None] * (np.arange(n) + 0.5) / n)
    matrix[0] /= 2
    return matrix


def _to_powers() -> np.ndarray:
    # columns: powers of u in [0, 1], highest first, of the shifted Chebyshev polynomials; whole numbers, so exact
    matrix = np.zeros((DEGREE + 1, DEGREE + 1))
    for k in range(DEGREE + 1):
        basis = chebyshev.Chebyshev.basis(k, domain=[0, 1]).convert(kind=np.polynomial.Polynomial)
        matrix[DEGREE - k :, k] = np.round(basis.coef[::-1])
    return matrix


_TO_CHEBYSHEV, _TO_POWERS = _to_chebyshev(), _to_powers()
_CHECK_POWERS = np.vander(_POINTS[_CHECKS], DEGREE + 1)


def first_edges(breaks: Iterable[float], period: float) -> np.ndarray:
    """Edges of pieces that no kink lies inside of, from 0 to the period [rad]."""
    even = np.linspace(0, period, _FIRST_PIECES + 1)
    kinks = np.unique([b % period for b in breaks])
    near = period / _FIRST_PIECES / 4
    # an even edge beside a kink would only make a short piece
    free = [e for e in even[1:-1] if kinks.size == 0 or np.abs(kinks - e).min() > near]
    edges = np.unique(np.concatenate([[0.0, period], kinks, free]))
    return edges[np.concatenate([np.diff(edges) > 1e-12 * period, [True]])]


def halved(
    function: Callable[[np.ndarray, np.ndarray], np.ndarray], edges: Radian[Array], count: int, tol: Pure = 1e-12
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Pieces of several functions that begin with the same edges, each halved until it is right; see `fit`.

    function: angles of shape (n,) [rad] and the index of the function (n,) to values of shape (n,), or (parts, n);
    edges: see `first_edges`; tol: largest error of each function, as a share of its largest value.

    Returns who, left, width, rows: function (n,), left edge (n,) [rad], width (n,) [rad], and coefficients (10, n, ..)
    over the share of the piece, highest power first [unit of the values]; in no order.
    """
    who, scale = np.repeat(np.arange(count), edges.size - 1), np.zeros(count)
    left, width = np.tile(edges[:-1], count), np.tile(np.diff(edges), count)
    done = []
    for _ in range(_LEVELS):
        values = _sampled(function, left, width, who)
        np.maximum.at(scale, who, np.abs(values).max(axis=(0, *range(2, values.ndim))))
        # two steps: one product of both matrices would lose five digits to its large entries
        rows = np.tensordot(_TO_POWERS, np.tensordot(_TO_CHEBYSHEV, values[_NODES], 1), 1)
        error = np.abs(np.tensordot(_CHECK_POWERS, rows, 1) - values[_CHECKS])
        noisy = left.size >= _OPEN * count
        good = error.max(axis=(0, *range(2, error.ndim))) <= (max(tol, _NOISE) if noisy else tol) * scale[who]
        done.append((who[good], left[good], width[good], rows[:, good]))
        if good.all():
            first, *others = zip(*done, strict=True)
            return np.concatenate(first), *(np.concatenate(o, axis=int(o[0].ndim > 1)) for o in others)  # type: ignore
        if noisy and np.mean(good) < 0.5:
            raise BadInput(
                f"the function is noise of {error.max() / scale.max():.2g} of its peak near {left[0]:.9g} rad; smooth "
                "it"
            )
        half = width[~good] / 2
        left, width = np.concatenate([left[~good], left[~good] + half]), np.concatenate([half, half])
        who = np.concatenate([who[~good], who[~good]])
    raise BadInput(f"the function jumps near {left[0]:.9g} rad: list that angle among the kinks, or smooth it")


def _sampled(
    function: Callable[[np.ndarray, np.ndarray], np.ndarray], left: np.ndarray, width: np.ndarray, who: np.ndarray
) -> np.ndarray:
    phi = left + width * _POINTS[:, None]
    values = np.asarray(function(phi.ravel(), np.tile(who, len(phi))), dtype=float)
    if not np.isfinite(values).all():
        bad = phi.ravel()[~np.isfinite(values).reshape(-1, phi.size).all(axis=0)][0]
        raise BadInput(f"the function is not finite at {bad:.9g} rad; it must have a value at every angle")
    return np.moveaxis(values.reshape(*values.shape[:-1], *phi.shape), (-2, -1), (0, 1))


def even_angles(period: Radian, count: int = 4096) -> Radian[Array]:
    """Even crank angles over a period, without its end. Returns phi: angles, shape (count,)."""
    return np.arange(count) * period / count


def fit(
    function: Callable[[np.ndarray], np.ndarray], breaks: Iterable[Radian], period: Radian, tol: Pure = 1e-12
) -> PPoly:
    """Periodic piecewise polynomial that follows a function within a tolerance.

    function: vectorised: angles of shape (n,) [rad] to values of shape (n,), or (parts, n) for several functions at
    once. breaks: angles where the function is not smooth, any real numbers. tol: largest error, as a share of the
    largest value of all parts. Returns poly: breaks from 0 to `period`; values of shape (n,), or (n, parts). Raises
    BadInput: the function is not finite, jumps at an angle that is not among the breaks, or is noisy beyond 1e-9.
    Degree 9 through Chebyshev nodes; none lies on a break, so a jump at a break does no harm. The error is measured at
    other points than the nodes. Where the function is rounded more coarsely than `tol`, halving stops at its noise.
    """
    _, left, width, rows = halved(lambda phi, who: function(phi), first_edges(breaks, period), 1, tol)
    # PPoly counts from the left break in radians, not in shares of the piece
    scale = width ** np.arange(DEGREE, -1, -1)[:, None]
    rows = rows / scale.reshape(scale.shape + (1,) * (rows.ndim - 2))
    order = np.argsort(left)
    return PPoly(rows[:, order], np.append(left[order], period), extrapolate="periodic")


def mean(poly: PPoly) -> float:
    """Mean over a period [unit of the values]."""
    return float(_integral(poly)(poly.x[-1]) / (poly.x[-1] - poly.x[0]))


def antiderivative(poly: PPoly) -> PPoly:
    """Periodic integral of f - mean(f), exact, 0 at the first break: without the drift of a mean."""
    level = PPoly(poly.c.copy(), poly.x, extrapolate="periodic")
    level.c[-1] -= mean(poly)
    integral = _integral(level)
    return PPoly(integral.c, integral.x, extrapolate="periodic")


def scalar(poly: PPoly) -> Callable[[float], tuple[float, float]]:
    """Fast evaluation for one float at a time: the value and its derivative.

    poly: periodic piecewise polynomial with values of shape (n,). Returns function: phi, any real number [rad] ->
    (value, derivative). Bisection and Horner's rule in plain Python, about 1 microsecond; scipy needs about 15 for a
    single number.
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


def extremes(poly: PPoly) -> tuple[float, float, float, float]:
    """Smallest and largest value over a period and where they are.

    poly: periodic piecewise polynomial with values of shape (n,). Returns low, phi_low, high, phi_high: smallest value
    and its angle [rad], largest value and its angle [rad].
    """
    low, phi_low = _smallest(poly.c, poly.x)
    high, phi_high = _smallest(-poly.c, poly.x)
    return low, phi_low, -high, phi_high


def piece_points(poly: PPoly, count: int = 17) -> Radian[Array]:
    """Angles on every piece with both of its ends, denser towards them, shape (pieces, count)."""
    u = (1 - np.cos(np.linspace(0, math.pi, count))) / 2
    return poly.x[:-1, None] + np.diff(poly.x)[:, None] * u


def piece_values(poly: PPoly, phi: Radian[Array]) -> np.ndarray:
    """Values that take each break from the piece the point belongs to, so that both sides of a jump are seen.

    poly: periodic piecewise polynomial with values of shape (n,); phi: angles made by `piece_points` of a polynomial
    with the same breaks, shape (pieces, count). Returns values: [unit of the values], shape (pieces, count).
    """
    u = phi - poly.x[:-1, None]
    values = np.zeros_like(u)
    for c in poly.c:
        values = values * u + c[:, None]
    return values


def _integral(poly: PPoly) -> PPoly:
    return PPoly(poly.c, poly.x, extrapolate=False).antiderivative()


def _smallest(rows: np.ndarray, x: np.ndarray) -> tuple[float, float]:
    width, powers = np.diff(x), np.arange(len(rows) - 1, -1, -1)[:, None]
    scaled = rows * width**powers
    phi = piece_points(PPoly(rows, x))
    lowest = piece_values(PPoly(rows, x), phi).min(axis=1)
    # between two of its points a piece dips by less than gap**2 / 8 of its largest second derivative
    dip = (math.pi / 2 / (phi.shape[1] - 1)) ** 2 / 8 * (powers * (powers - 1) * np.abs(scaled)).sum(axis=0)
    pieces = np.flatnonzero(lowest - dip <= lowest.min())
    least = [_smallest_of_piece(scaled[:, k], (phi[k] - x[k]) / width[k]) for k in pieces]
    value, u, k = min((value, u, k) for (value, u), k in zip(least, pieces, strict=True))
    return value, float(x[k] + width[k] * u)


def _smallest_of_piece(scaled: np.ndarray, points: np.ndarray) -> tuple[float, float]:
    """Smallest value over u in [0, 1] and its u; `points` are tried beside the roots of the derivative."""
    u = np.concatenate([zeros_of_piece(np.polyder(scaled)), points])
    values = np.polyval(scaled, u)
    return float(values.min()), float(u[values.argmin()])
