"""Rounding up to what a workshop makes, and naming the worst speed."""

import math

import numpy as np

from mechsym.quantities import RPM


def round_up(size: float, step: float = 0.5e-3) -> float:
    """The next larger multiple of a step.

    Parameters
    ----------
    size : float
        Size needed [m]
    step : float
        Step of the sizes made [m]

    Returns
    -------
    size : float
        Size made, never smaller than needed beyond the last digits of a float [m]

    Examples
    --------
    >>> round_up(0.02629), round_up(0.0265)
    (0.0265, 0.0265)
    """
    return round(math.ceil(size / step - 1e-9) * step, 12)


def at_speed(omega: np.ndarray, index: int) -> str:
    """The speed at which a check is worst, in words.

    Parameters
    ----------
    omega : ndarray, shape (k,)
        Crank speeds [rad/s]

    Examples
    --------
    >>> at_speed(np.array([8000 * np.pi / 30]), 0)
    'worst at 8000 rpm'
    """
    return f"worst at {float(omega[index]) / RPM:.0f} rpm"
