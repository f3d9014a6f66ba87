"""Pieces of functions, halved until a polynomial of degree 9 follows each of them."""

import math
from collections.abc import Callable, Iterable

import numpy as np
from numpy.polynomial import chebyshev

from mechsym.errors import BadInput

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
    function: Callable[[np.ndarray, np.ndarray], np.ndarray], edges: np.ndarray, count: int, tol: float = 1e-12
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Pieces of several functions that begin with the same edges, each halved until it is right; see `fit`.

    Parameters
    ----------
    function : callable
        Angles of shape (n,) [rad] and the index of the function (n,) to values of shape (n,), or (parts, n)
    edges : ndarray
        See `first_edges` [rad]
    tol : float
        Largest error of each function, as a share of its largest value [-]

    Returns
    -------
    who, left, width, rows : ndarray
        Function (n,), left edge (n,) [rad], width (n,) [rad], and coefficients (10, n, ..) over the share of the piece,
        highest power first [unit of the values]; in no order
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
