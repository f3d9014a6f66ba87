"""Piecewise polynomials without the quarter of a second that it takes to load scipy's, whose face this one has."""

import math
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from mechsym.quantities.units import Scalar


class PPoly:
    r"""A piecewise polynomial, exact in its values, derivatives and integrals.

    .. math:: f(x) = \sum_{j=0}^{k-1} c_{j,i}\,(x - x_i)^{k-1-j}, \qquad x_i \le x < x_{i+1}

    c: coefficients, highest power first, shape (k, m, ...) [any unit]; x: breaks, ascending, shape (m + 1,).
    extrapolate: whether the outer pieces go on beyond the ends (else there is no number there), or "periodic".
    """

    __slots__ = ("c", "extrapolate", "x")

    def __init__(self, c: ArrayLike, x: ArrayLike, extrapolate: bool | Literal["periodic"] = True) -> None:
        self.c = np.ascontiguousarray(c, dtype=float)
        self.x = np.ascontiguousarray(x, dtype=float)
        self.extrapolate = extrapolate

    @classmethod
    def hermite(cls, x: np.ndarray, y: np.ndarray, slope: np.ndarray) -> "PPoly":
        """Cubics through values y [any unit] with slopes [its unit by that of x] at breaks x, shape (m + 1,) each."""
        width, mean = np.diff(x), np.diff(y) / np.diff(x)
        bend = (slope[:-1] + slope[1:] - 2 * mean) / width
        return cls(np.stack([bend / width, (mean - slope[:-1]) / width - bend, slope[:-1], y[:-1]]), x)

    @classmethod
    def spline(cls, x: np.ndarray, y: np.ndarray, periodic: bool = False) -> "PPoly":
        """The cubic spline through values y [any unit] at breaks x, shape (m + 1,) each.

        The first two pieces are one cubic and so are the last two; of two or three points it is a line or a parabola.
        periodic: y ends as it begins, and so do slope and curvature; at least four points.
        """
        width = np.diff(x)
        mean = np.diff(y) / width
        if periodic:
            before, left = np.roll(width, 1), np.roll(mean, 1)
            slope = _around(width, 2 * (before + width), before, 3 * (width * left + before * mean))
            return cls(cls.hermite(x, y, np.append(slope, slope[0])).c, x, "periodic")
        if len(x) < 4:
            inner = (width[1:] * mean[:-1] + width[:-1] * mean[1:]) / (width[:-1] + width[1:])
            beside = inner if inner.size else mean
            return cls.hermite(x, y, np.concatenate([2 * mean[:1] - beside, inner, 2 * mean[-1:] - beside]))
        ends = []
        for h, s in ((width, mean), (width[::-1], mean[::-1])):
            both = h[0] + h[1]
            ends.append((h[1], both, ((h[0] + 2 * both) * h[1] * s[0] + h[0] ** 2 * s[1]) / both))
        (first, above, start), (last, below, end) = ends
        inner = 3 * (width[1:] * mean[:-1] + width[:-1] * mean[1:])
        slope = _tridiagonal(
            np.append(width[1:], below), np.concatenate([[first], 2 * (width[:-1] + width[1:]), [last]]),
            np.append(above, width[:-1]), np.concatenate([[start], inner, [end]]),
        )  # fmt: skip
        return cls.hermite(x, y, slope)

    def __call__(self, x: Scalar, nu: int = 0) -> np.ndarray:
        """Values at any numbers, or those of the derivative of an order nu; shape of x, then what c has beyond two."""
        x = np.asarray(x, dtype=float)
        points = x.ravel()
        start, end = self.x[0], self.x[-1]
        if self.extrapolate == "periodic":
            points = start + (points - start) % (end - start)
        at = np.searchsorted(self.x[1:-1], points, side="right")
        rest = self.c.shape[2:]
        rows = self.c if nu == 0 else self.derivative(nu).c
        u = (points - self.x[at]).reshape((-1,) + (1,) * len(rest))
        values = rows[0].take(at, axis=0)
        for of_power in rows[1:].take(at, axis=1):
            values *= u
            values += of_power
        if self.extrapolate is False:
            values[(points < start) | (points > end)] = np.nan
        return values.reshape(x.shape + rest)

    def derivative(self, nu: int = 1) -> "PPoly":
        """Derivative of an order nu of at least 1."""
        if nu >= len(self.c):
            return PPoly(np.zeros_like(self.c[:1]), self.x, self.extrapolate)
        count = len(self.c) - nu
        return PPoly(self.c[:count] * _column(_falling(count, nu), self.c), self.x, self.extrapolate)

    def antiderivative(self) -> "PPoly":
        """Integral from the first break on; that of a periodic one does not go on beyond its period."""
        c = np.zeros((len(self.c) + 1, *self.c.shape[1:]))
        c[:-1] = self.c / _column(_falling(len(self.c), 1), self.c)
        width = np.diff(self.x).reshape((-1,) + (1,) * (c.ndim - 2))
        whole = c[0] * width
        for row in c[1:-1]:
            whole = (whole + row) * width
        np.cumsum(whole[:-1], axis=0, out=c[-1, 1:])
        return PPoly(c, self.x, False if self.extrapolate == "periodic" else self.extrapolate)

    def zeros(self) -> np.ndarray:
        """Where values of shape (n,) are zero, piece by piece [unit of x]; a piece that is zero throughout has none."""
        width = np.diff(self.x)
        scaled = self.c * width ** np.arange(len(self.c) - 1, -1, -1)[:, None]
        near = np.flatnonzero(np.abs(scaled[-1]) <= np.abs(scaled[:-1]).sum(axis=0))
        return np.concatenate([np.empty(0), *(self.x[k] + width[k] * zeros_of_piece(scaled[:, k]) for k in near)])


def zeros_of_piece(scaled: np.ndarray) -> np.ndarray:
    """Zeros in [0, 1] of a polynomial, whose coefficients stand highest power first."""
    roots = np.roots(scaled)
    return roots.real[(np.abs(roots.imag) < 1e-6) & (roots.real >= 0) & (roots.real <= 1)]


def _falling(count: int, nu: int) -> np.ndarray:
    """Factors of the nu-th derivative of so many coefficients, highest power first."""
    return np.array([math.perm(power + nu, nu) for power in range(count - 1, -1, -1)], dtype=float)


def _column(factors: np.ndarray, c: np.ndarray) -> np.ndarray:
    return factors.reshape((-1,) + (1,) * (c.ndim - 1))


def _tridiagonal(below: np.ndarray, middle: np.ndarray, above: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Solution of a system with three diagonals, by Thomas' elimination without pivots."""
    share, value = [above[0] / middle[0]], [right[0] / middle[0]]
    # in floats: numpy's numbers cost ten times as much
    rows = (below.tolist(), middle[1:].tolist(), [*above[1:].tolist(), 0.0], right[1:].tolist())
    for b, m, a, r in zip(*rows, strict=True):
        pivot = m - b * share[-1]
        share.append(a / pivot)
        value.append((r - b * value[-1]) / pivot)
    for i in range(len(value) - 2, -1, -1):
        value[i] -= share[i] * value[i + 1]
    return np.array(value)


def _around(below: np.ndarray, middle: np.ndarray, above: np.ndarray, right: np.ndarray) -> np.ndarray:
    """The same where the first row and the last are neighbours too, by the formula of Sherman and Morrison."""
    corner = -middle[0]
    column = np.zeros_like(right)
    column[0], column[-1] = corner, above[-1]
    inner = middle.copy()
    inner[0] -= corner
    inner[-1] -= below[0] * above[-1] / corner
    one, other = (_tridiagonal(below[1:], inner, above[:-1], r) for r in (right, column))
    tail = below[0] / corner
    return np.asarray(one - other * (one[0] + tail * one[-1]) / (1 + other[0] + tail * other[-1]))
