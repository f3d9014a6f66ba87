r"""The compression line of a measured diagram: what offset, scale and dead centre are read from.

    p_measured = p_off + C (V / V_bdc)^(-n)        between the closing of the inlet and the start of combustion

    log(p - p_off) |      \          straight, slope -n, when both p_off and the dead centre are right
                   |        \
                   |          \
                   +------------ log V

For a given dead centre and exponent, p_off and C come from a linear least-squares fit. The dead centre is where that
fit is best. Dead centre, exponent and offset cannot all be found from one noisy line (0.05 in n are worth about 2
degrees), so n is assumed and its share in the uncertainty is stated.
"""

import dataclasses
import math

import numpy as np
from scipy.optimize import minimize_scalar

from mechsym.cycle.chamber import Chamber, volume
from mechsym.quantities import record

# How far each assumption is moved to see what the dead centre owes to it
_EXPONENT_SPREAD = 0.05
_FROM_SPREAD = math.radians(10.0)
_TO_SPREAD = math.radians(5.0)
_RAMP = math.radians(5.0)
_REACH = math.radians(15.0)


@record
class Window:
    """Where the charge is compressed without burning, and its exponent."""

    #: Crank angles, both before TDC [rad]
    fit_from: float
    fit_to: float
    n: float  #: Polytropic exponent [-]


@record
class Line:
    """A fitted compression line."""

    p_off: float  #: What the sensor adds to the absolute pressure [Pa]
    p_bdc: float  #: C: the line extrapolated to bottom dead centre [Pa]
    rms: float  #: Root mean square of what the fit leaves [Pa]


def fit_line(phi: np.ndarray, pressure: np.ndarray, cylinder: Chamber, window: Window) -> Line:
    r"""Offset and level of the compression line at a known dead centre.

    .. math:: \min_{p_{off},\,C} \sum_i w_i\,[p_i - p_{off} - C\,(V_i / V_{bdc})^{-n}]^2

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle from firing TDC [rad]
    pressure : ndarray, shape (n,)
        Measured pressure [Pa]
    window : Window
        Angles and exponent; the weights fall off over 5 degrees at both ends
    """
    return _fit(phi, pressure, cylinder, window, shift=0.0)


def find_dead_centre(phi: np.ndarray, pressure: np.ndarray, cylinder: Chamber, window: Window) -> float:
    """The dead centre that makes the compression line straight.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle from a guess of the dead centre, at most about 30 degrees off [rad]
    pressure : ndarray, shape (n,)
        Measured pressure, any offset [Pa]
    window : Window
        Angles and exponent; moves along with the dead centre

    Returns
    -------
    shift : float
        Angle of the dead centre on the scale of phi; nan if the search does not settle [rad]
    """
    centre = 0.0
    for _ in range(40):
        if not _near(phi - centre, window).any():  # the search has walked off the samples
            return math.nan
        best = minimize_scalar(
            lambda shift, c=centre: _fit(phi - c, pressure, cylinder, window, shift=shift).rms,
            bounds=(-_REACH, _REACH),
            method="bounded",
            options={"xatol": 1e-6},
        ).x
        centre += 0.6 * float(best)
        if abs(best) < 1e-5:
            return centre
    return math.nan


def dead_centre_uncertainty(phi: np.ndarray, pressure: np.ndarray, cylinder: Chamber, window: Window) -> float:
    """How far the dead centre moves when its assumptions do.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle from the dead centre found [rad]
    pressure : ndarray, shape (n,)
        Measured pressure [Pa]
    window : Window
        Angles and exponent it was found with

    Returns
    -------
    spread : float
        Root of the summed squares of the half ranges for n +- 0.05, fit_from +- 10 degrees, fit_to +- 5 degrees;
        inf if a search does not settle [rad]
    """
    changes = (("n", _EXPONENT_SPREAD), ("fit_from", _FROM_SPREAD), ("fit_to", _TO_SPREAD))
    total = 0.0
    for name, by in changes:
        ends = [
            find_dead_centre(
                phi, pressure, cylinder, dataclasses.replace(window, **{name: getattr(window, name) + s * by})
            )
            for s in (-1, 1)
        ]
        total += ((ends[1] - ends[0]) / 2) ** 2
    return math.sqrt(total) if math.isfinite(total) else math.inf


def polytropic_exponent(phi: np.ndarray, pressure: np.ndarray, cylinder: Chamber, window: Window) -> float:
    r"""Exponent of an absolute pressure trace between two angles.

    .. math:: n = -\frac{d \log p}{d \log V}

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle from firing TDC [rad]
    pressure : ndarray, shape (n,)
        Absolute pressure, positive [Pa]
    window : Window
        Angles; its exponent is not used

    Returns
    -------
    n : float
        Slope of the least-squares line of log p over log V [-]
    """
    inside = (phi >= window.fit_from) & (phi <= window.fit_to)
    return -float(np.polyfit(np.log(volume(cylinder, phi[inside])), np.log(pressure[inside]), 1)[0])


def free_exponent(phi: np.ndarray, pressure: np.ndarray, cylinder: Chamber, window: Window) -> float:
    """The exponent that the fit with a free offset likes best, at a known dead centre.

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle from firing TDC [rad]
    pressure : ndarray, shape (n,)
        Measured pressure [Pa]
    window : Window
        Angles; its exponent is not used

    Returns
    -------
    n : float
        Between 1.01 and 1.66; a value far from the assumed one tells of sensor drift or a wrong dead centre [-]
    """
    found = minimize_scalar(
        lambda n: fit_line(phi, pressure, cylinder, dataclasses.replace(window, n=n)).rms,
        bounds=(1.01, 1.66),
        method="bounded",
    )
    return float(found.x)


def _fit(phi: np.ndarray, pressure: np.ndarray, cylinder: Chamber, window: Window, shift: float) -> Line:
    # the window stays where it is while the dead centre moves by `shift`: all fits see the same samples
    inside = _near(phi, window)
    at, p = phi[inside], pressure[inside]
    edge = np.minimum(at - window.fit_from, window.fit_to - at)
    weight = np.clip(0.5 + edge / (2 * _RAMP), 0.0, 1.0)
    v = volume(cylinder, at - shift) / (cylinder.clearance * cylinder.compression_ratio)
    shape = v**-window.n
    total = weight.sum()
    p_mean, shape_mean = (weight @ p) / total, (weight @ shape) / total
    level = (weight @ ((p - p_mean) * (shape - shape_mean))) / (weight @ (shape - shape_mean) ** 2)
    left = p - p_mean - level * (shape - shape_mean)
    return Line(
        p_off=float(p_mean - level * shape_mean), p_bdc=float(level), rms=float(np.sqrt(weight @ left**2 / total))
    )


def _near(phi: np.ndarray, window: Window) -> np.ndarray:
    return (phi > window.fit_from - _RAMP) & (phi < window.fit_to + _RAMP)
