"""Periodic cubic B-splines for the path of a guide, with a knot at every kink of the torque, as sparse matrices."""

from collections.abc import Sequence

import casadi as ca
import numpy as np
import scipy

from mechsym.quantities import quantity, record

_DEGREE = 3


@record
class Basis:
    """Knots of one period; a spline has as many coefficients as there are knots."""

    knots: np.ndarray  #: shape (m,), ascending in [0, period) [rad]
    period: float = quantity("rad", above=0, about="period of the splines")

    @property
    def count(self) -> int:
        """Number of coefficients."""
        return int(self.knots.size)


def basis(period: float, kinks: Sequence[float], count: int) -> Basis:
    """About `count` even knots over a period [rad]; the nearest one is moved onto each kink [rad]."""
    knots = np.arange(count) * period / count
    moved = np.zeros(count)
    for kink in sorted({float(k % period) for k in kinks}):
        away = np.abs((knots - kink + period / 2) % period - period / 2) + moved
        nearest = int(np.argmin(away))
        knots[nearest], moved[nearest] = kink, np.inf
    return Basis(knots=np.unique(knots), period=period)


def matrices(basis: Basis, phi: np.ndarray) -> tuple[ca.DM, ca.DM, ca.DM]:
    """Sparse matrices of shape (n, m) from coefficients to the value and its first two derivatives at phi [rad]."""
    splines, found = _elements(basis), []
    phi = basis.knots[0] + (phi - basis.knots[0]) % basis.period
    for order in range(3):
        spread = splines.derivative(order)(phi) if order else splines(phi)
        folded = spread[:, : basis.count].copy()
        folded[:, :_DEGREE] += spread[:, basis.count :]
        folded[np.abs(folded) < 1e-14] = 0.0
        found.append(ca.sparsify(ca.DM(folded)))
    return found[0], found[1], found[2]


def curve(basis: Basis, coefficients: np.ndarray) -> "scipy.interpolate.PPoly":
    """The periodic piecewise polynomial of some coefficients, over [0, period) [rad]."""
    t, wrapped = _extended(basis), np.append(coefficients, coefficients[:_DEGREE])
    whole = scipy.interpolate.PPoly.from_spline(scipy.interpolate.BSpline(t, wrapped, _DEGREE))
    inside = [i for i in range(whole.x.size - 1) if whole.x[i + 1] > whole.x[i]]
    first = basis.knots[0]
    inside = [i for i in inside if first - 1e-12 <= whole.x[i] < first + basis.period - 1e-12]
    breaks = np.append(whole.x[inside], first + basis.period)
    return scipy.interpolate.PPoly(whole.c[:, inside], breaks, extrapolate="periodic")


def fitted(basis: Basis, values: np.ndarray, phi: np.ndarray) -> np.ndarray:
    """Coefficients, shape (m,), of the spline nearest to values at phi [rad]."""
    return np.linalg.lstsq(np.asarray(matrices(basis, phi)[0].full()), values, rcond=None)[0]


def _extended(basis: Basis) -> np.ndarray:
    before = basis.knots[-_DEGREE:] - basis.period
    after = basis.knots[: _DEGREE + 1] + basis.period
    return np.concatenate([before, basis.knots, after])


def _elements(basis: Basis) -> "scipy.interpolate.BSpline":
    return scipy.interpolate.BSpline(_extended(basis), np.eye(basis.count + _DEGREE), _DEGREE)
