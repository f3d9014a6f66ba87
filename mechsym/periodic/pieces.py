"""Piecewise polynomials by numpy alone: what `scipy.interpolate.PPoly` gives, bit for bit.

The import of scipy takes longer than most commands work.
"""

import math
from typing import Any

import numpy as np


class Pieces:
    """A piecewise polynomial; what is not here is asked of a `scipy.interpolate.PPoly` of the same pieces.

    Parameters
    ----------
    c : array_like, shape (k, m, ...)
        Coefficients by the distance from the left break, highest power first [unit of the values]
    x : array_like, shape (m + 1,)
        Breaks, rising [rad]
    extrapolate : bool or "periodic"
        What holds beyond the breaks: the outer pieces, nothing (NaN), or the same again
    """

    def __init__(self, c: Any, x: Any, extrapolate: bool | str = True) -> None:
        self.c, self.x = np.ascontiguousarray(c, dtype=float), np.ascontiguousarray(x, dtype=float)
        self.extrapolate = extrapolate
        fits = self.c.ndim > 1 and len(self.c) > 0 and self.x.shape == (self.c.shape[1] + 1,)
        if not fits or (np.diff(self.x) < 0).any():
            raise ValueError(f"coefficients of shape {self.c.shape} do not fit {self.x.shape} rising breaks")

    def __call__(self, at: Any, nu: int = 0) -> np.ndarray:
        """Values, or the derivative of order `nu`, at angles [rad] of any shape."""
        if nu:
            return self.derivative(nu)(at)
        at, first, last = np.asarray(at, dtype=float), self.x[0], self.x[-1]
        if self.extrapolate == "periodic":
            at = first + (at - first) % (last - first)
        piece = np.clip(np.searchsorted(self.x, at, side="right") - 1, 0, len(self.x) - 2)
        far = (at - self.x[piece]).reshape(at.shape + (1,) * (self.c.ndim - 2))
        values, power = self.c[-1].take(piece, axis=0), far
        for row in self.c[-2::-1]:
            values = values + row.take(piece, axis=0) * power
            power = power * far
        if self.extrapolate is False:
            values = np.where(((at < first) | (at > last)).reshape(far.shape), np.nan, values)
        return np.asarray(values)

    def derivative(self, nu: int = 1) -> "Pieces":
        """Derivative, piece by piece."""
        rows = self.c[: max(len(self.c) - nu, 0)]
        if not len(rows):
            return Pieces(np.zeros_like(self.c[:1]), self.x, self.extrapolate)
        factors = [float(math.perm(power, nu)) for power in range(len(self.c) - 1, nu - 1, -1)]
        return Pieces(rows * np.reshape(factors, (-1, *(1,) * (rows.ndim - 1))), self.x, self.extrapolate)

    def antiderivative(self) -> "Pieces":
        """Integral from the first break; that of a periodic one holds between the breaks only."""
        count, inner = len(self.c), (1,) * (self.c.ndim - 2)
        rows = np.concatenate([self.c, np.zeros_like(self.c[:1])])
        rows[:-1] /= np.arange(count, 0.0, -1.0).reshape(-1, 1, *inner)
        powers = np.cumprod(np.broadcast_to(np.diff(self.x).reshape(-1, *inner), self.c.shape), axis=0)
        # what each power adds to the value at the left break, piece after piece
        steps = np.moveaxis(rows[-2::-1] * powers, 0, 1).reshape(-1, *self.c.shape[2:])
        rows[-1, 1:] = np.cumsum(steps, axis=0)[count - 1 : -count : count]
        return Pieces(rows, self.x, False if self.extrapolate == "periodic" else self.extrapolate)

    def __getattr__(self, name: str) -> Any:
        if name.startswith("_") or name in ("c", "x", "extrapolate"):
            raise AttributeError(name)
        import scipy

        return getattr(scipy.interpolate.PPoly(self.c, self.x, self.extrapolate), name)
