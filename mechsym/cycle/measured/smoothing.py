"""Periodic cubic splines through noisy, evenly spaced samples.

What is left out is measured against the noise of the samples, and the noise against nothing but themselves: fourth
differences are blind to anything smooth.
"""

import math

import numpy as np
import scipy

from mechsym.quantities.units import Array, Pascal, Radian

# Standard deviation of a fourth difference of white noise of deviation 1, and a median turned into a deviation
_FOURTH = math.sqrt(70.0)
_MEDIAN = 0.6745


def noise(values: np.ndarray) -> float:
    """Standard deviation of the white noise on a smooth periodic curve.

    values: evenly spaced samples of one period [unit of the samples]. Returns sigma: from the median of the fourth
    differences, blind to anything smooth [unit of the samples].
    """
    around = np.concatenate([values, values[:4]])
    return float(np.median(np.abs(np.diff(around, 4))) / _MEDIAN / _FOURTH)


def smooth(
    phi: Radian[Array], values: Pascal[Array], period: Radian, method: str
) -> "scipy.interpolate.BSpline | scipy.interpolate.CubicSpline":
    """A periodic cubic spline through, or near, evenly spaced samples.

    period: 2 pi or 4 pi. method: `interpolate`, or `spline`: its squared residuals sum up to n times the squared noise.
    Returns spline: on [phi[0], phi[0] + period], twice continuously differentiable, also where the period closes.
    """
    closed_phi, closed = np.append(phi, phi[0] + period), np.append(values, values[0])
    sigma = noise(values)
    if method == "interpolate" or sigma < 1e-9 * float(np.ptp(values)):
        return scipy.interpolate.CubicSpline(closed_phi, closed, bc_type="periodic")
    return scipy.interpolate.BSpline(
        *scipy.interpolate.splrep(closed_phi, closed, s=values.size * sigma**2, per=True), extrapolate="periodic"
    )
