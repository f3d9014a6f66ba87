"""A periodic function of the angle as piecewise polynomials, for integrators that ask for one angle at a time.

Vectorised numpy functions cost 20 to 100 microseconds a call; a polynomial found by bisection and Horner's rule costs
one. The stand-in is used only if it agrees with the function to round-off, otherwise the function itself is kept.
"""

from bisect import bisect_right
from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

_DEGREE = 11
_DEEPEST = 12


def scalar(
    function: Callable[[np.ndarray], np.ndarray],
    period: float,
    kinks: tuple[float, ...] = (),
    tolerance: float = 1e-12,
) -> Callable[[float], float]:
    """A function of one float that equals a vectorised periodic function.

    Parameters
    ----------
    function : callable
        phi, ndarray (n,), to values (n,)
    period : float
        Period [rad]
    kinks : tuple of float
        Where it is not smooth, in [0, period) [rad]
    tolerance : float
        Largest difference, relative to the largest value, for a stand-in by polynomials [-]

    Returns
    -------
    scalar : callable
        phi to value: polynomials, or the function itself when these do not reach the tolerance
    """
    ends = np.unique([0.0, *(k % period for k in kinks), period])
    edges = np.unique(np.concatenate([np.linspace(a, b, 5) for a, b in zip(ends, ends[1:], strict=False)]))
    scale = float(np.max(np.abs(function(np.linspace(0.0, period, 721))))) or 1.0
    found = _fit(function, edges, tolerance * scale)
    if found is None:
        return lambda phi: float(function(np.array([phi]))[0])
    starts, widths, rows = found

    def value(phi: float) -> float:
        phi = phi % period
        i = bisect_right(starts, phi) - 1
        x, total = 2 * (phi - starts[i]) / widths[i] - 1, 0.0
        for coefficient in rows[i]:
            total = total * x + coefficient
        return total

    return value


def _fit(
    function: Callable[[np.ndarray], np.ndarray], edges: np.ndarray, allowed: float
) -> tuple[list[float], list[float], list[list[float]]] | None:
    """Halve the panels that miss the tolerance; None when the narrowest still do."""
    x = np.cos(np.pi * (np.arange(_DEGREE + 1) + 0.5) / (_DEGREE + 1))
    to_coefficients = np.linalg.inv(chebyshev.chebvander(x, _DEGREE))
    between = np.linspace(-0.97, 0.97, 7)
    todo = np.column_stack([edges[:-1], edges[1:]])
    panels: list[tuple[float, float, list[float]]] = []
    for _ in range(_DEEPEST):
        middle, half = todo.mean(axis=1)[:, None], np.diff(todo, axis=1) / 2
        coefficients = _values(function, middle + half * x) @ to_coefficients.T
        error = np.abs(chebyshev.chebval(between, coefficients.T) - _values(function, middle + half * between))
        good = error.max(axis=1) <= allowed
        for (a, b), row in zip(todo[good], coefficients[good], strict=True):
            panels.append((float(a), float(b - a), chebyshev.cheb2poly(row)[::-1].tolist()))
        todo = todo[~good]
        if not len(todo):
            panels.sort()
            return [p[0] for p in panels], [p[1] for p in panels], [p[2] for p in panels]
        todo = np.concatenate([np.column_stack([todo[:, 0], todo.mean(axis=1)]), np.column_stack([todo.mean(axis=1), todo[:, 1]])])
    return None


def _values(function: Callable[[np.ndarray], np.ndarray], phi: np.ndarray) -> np.ndarray:
    return np.asarray(function(phi.ravel()), dtype=float).reshape(phi.shape)
