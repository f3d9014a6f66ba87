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
