r"""Fits to measured pressure with confidence: the compression line in log p - log V, and Wiebe functions.

    log p |  \            slope -n; a wrong dead centre bends it, because V(phi) is then wrong most near top dead
          |    \          centre, where V'/V is large and changes sign
          |      \
          +--------- log V

Confidence is 95 % from the covariance of the least-squares fit, widened where neighbouring residuals hang together: n
correlated residuals tell as much as n (1 - r)/(1 + r) independent ones, r their lag-one correlation. It holds for the
model fitted, not for what the model leaves out.
"""

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import Annotated

import numpy as np
import scipy

from mechsym.cycle.wiebe import wiebe
from mechsym.quantities import record
from mechsym.quantities.results import Columns
from mechsym.quantities.units import Array, Kelvin, Kilogram, Pascal, Pure, Radian, Volume

_Z = 1.959963984540054  # 95 % of a normal distribution
_DOUBLE_STARTS = ((0.3, 1.0, 0.5), (0.6, 2.0, 0.7), (0.7, 1.0, 1.5))  # b, m_p, m_d to begin with


@record
class Fit:
    """A least-squares fit."""

    names: tuple[str, ...]
    units: tuple[str, ...]  #: SI, of the values
    #: Their values and the half width of their 95 % confidence intervals [units]
    values: tuple[float, ...]
    confidence: tuple[float, ...]
    rms: float  #: Root mean square of the residuals [unit of the data]
    unit: str = "-"  #: Of the data

    @property
    def columns(self) -> Columns:
        """`rms`, and each value with its confidence by its name."""
        pairs = zip(self.names, self.values, self.confidence, strict=True)
        values = {name: {"value": value, "confidence": half} for name, value, half in pairs}
        units = {"rms": self.unit, **dict(zip(self.names, self.units, strict=True))}
        return Columns({"rms": self.rms, **values}, units)


def least_squares_fit(
    residuals: Callable[[np.ndarray], np.ndarray], names: Mapping[str, str], start: np.ndarray, bounds: object
) -> Fit:
    """Fit parameters to residuals and say how well they are known.

    names: names of the parameters with their units; start: where to begin [units of the parameters], shape (k,).
    Returns fit: values with confidence; a parameter that the data do not determine has infinite confidence.
    """
    found = scipy.optimize.least_squares(
        residuals, start, "3-point", bounds, x_scale="jac", xtol=1e-12, ftol=1e-12, gtol=1e-12
    )
    left, freedom = found.fun, max(found.fun.size - found.x.size, 1)
    centred = left - left.mean()
    power = float(centred @ centred)
    r = min(max(float(centred[:-1] @ centred[1:]) / power, 0.0), 0.999) if power > 0 else 0.0
    spread = np.sqrt(_variances(found.jac) * (left @ left) / freedom * (1 + r) / (1 - r))
    return Fit(
        names=tuple(names), units=tuple(names.values()), values=tuple(float(v) for v in found.x),
        confidence=tuple(float(_Z * s) for s in spread), rms=float(np.sqrt(np.mean(left**2))),
    )  # fmt: skip


def trapped_mass(
    pressure: Pascal, v: Volume, temperature: Kelvin, gas_constant: Annotated[float, "J/(kg*K)"]
) -> Kilogram:
    """Mass of gas from the compression line.

    .. math:: m = p V/(R T)

    pressure: on the line, where the inlet closes. temperature: assumed temperature there; the mass is as uncertain as
    this. gas_constant: specific gas constant. Returns mass: trapped mass.
    """
    return pressure * v / (gas_constant * temperature)


def fit_wiebe(phi: Radian[Array], burnt: Pure[Array], a: Pure = 5.0) -> Fit:
    r"""Single Wiebe function through a burnt fraction.

    .. math:: X = \frac{1 - e^{-a y^{m+1}}}{1 - e^{-a}}, \quad y = (\varphi - \varphi_s)/\Delta\varphi \le 1

    burnt: burnt fraction, 0 to 1; a: completeness, which the duration cannot be told apart from. Returns fit: `start`,
    `duration` [rad], `m` [-]; rms [-].
    """

    def residuals(x: np.ndarray) -> np.ndarray:
        y = np.minimum((phi - x[0]) / x[1], 1.0)
        return wiebe(y, a, x[2]) / (1 - math.exp(-a)) - burnt

    first, last = phi[np.argmax(burnt > 0.02)], phi[np.argmax(burnt > 0.98)]
    start = np.array([first, max(last - first, 0.05), 1.5])
    bounds = (np.array([phi[0], 0.01, 0.0]), np.array([phi[-1], phi[-1] - phi[0], 15.0]))
    return least_squares_fit(residuals, {"start": "rad", "duration": "rad", "m": "-"}, start, bounds)


def fit_double_wiebe(phi: Radian[Array], burnt: Pure[Array], a: Pure = 5.0) -> Fit:
    r"""Double Wiebe function through a burnt fraction; of its two parts the shorter one is p, the premixed.

    .. math:: X = (1-b)\{1 - e^{-a y_p^{m_p+1}}\} + b\{1 - e^{-a y_d^{m_d+1}}\}, \; y = (\varphi-\varphi_s)/\Delta

    burnt: burnt fraction, 0 to 1; a: completeness of both parts, which their durations cannot be told apart from.
    Returns fit: `start`, `duration_p`, `duration_d` [rad], `m_p`, `m_d`, `b` [-]; rms [-].
    """

    def residuals(x: np.ndarray) -> np.ndarray:
        start, d_p, d_d, m_p, m_d, b = x
        parts = (1 - b) * wiebe((phi - start) / d_p, a, m_p) + b * wiebe((phi - start) / d_d, a, m_d)
        return parts - burnt

    single = fit_wiebe(phi, burnt)
    start, duration, _ = single.values
    bounds = (np.array([phi[0], 0.01, 0.01, 0.0, 0.0, 0.0]), np.array([phi[-1], 6.0, 6.0, 15.0, 15.0, 1.0]))
    names = dict.fromkeys(("start", "duration_p", "duration_d"), "rad") | dict.fromkeys(("m_p", "m_d", "b"), "-")
    tries = [
        least_squares_fit(residuals, names, np.array([start, 0.5 * duration, duration, m_p, m_d, b]), bounds)
        for b, m_p, m_d in _DOUBLE_STARTS
    ]
    best = min(tries, key=lambda fit: fit.rms)
    return best if best.values[1] <= best.values[2] else _exchanged(best)


def _exchanged(fit: Fit) -> Fit:
    """The same double Wiebe function with its parts p and d by each other's names."""
    start, d_p, d_d, m_p, m_d, b = fit.values
    of_p, of_d, m_of_p, m_of_d = fit.confidence[1:5]
    confidence = (fit.confidence[0], of_d, of_p, m_of_d, m_of_p, fit.confidence[5])
    return replace(fit, values=(start, d_d, d_p, m_d, m_p, 1 - b), confidence=confidence)


def _variances(jacobian: np.ndarray) -> np.ndarray:
    # diagonal of (J'J)^-1 by the singular values of J with columns of length one, so that units do not matter
    size = np.linalg.norm(jacobian, axis=0)
    if not np.all(size > 0):
        return np.full(size.size, np.inf)
    _, singular, vt = np.linalg.svd(jacobian / size, full_matrices=False)
    if singular[-1] < 1e-7 * singular[0]:
        return np.full(size.size, np.inf)
    return np.sum((vt.T / singular) ** 2, axis=1) / size**2
