r"""Orders of a periodic force or torque.

.. math:: M(\varphi) = M_0 + \sum_k a_k \cos(k\varphi - \delta_k)

An order k counts oscillations per turn of the crank; a four-stroke cycle has half orders too.
"""

import math

import numpy as np

from mechsym.quantities import record


@record
class Harmonics:
    """Harmonics of one quantity, arrays of shape (m,)."""

    order: np.ndarray  #: Oscillations per turn, 0 first [-]
    amplitude: np.ndarray  #: a_k; the mean for order 0, with its sign [unit of the quantity]
    phase: np.ndarray  #: delta_k, where the oscillation has its crest [rad]


def orders(values: np.ndarray, period: float, highest: float = 12.0) -> Harmonics:
    """Harmonics of a quantity given at evenly spaced angles.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Over one period, without its end, in any unit [-]
    period : float
        Period, 2 pi or 4 pi [rad]
    highest : float
        Highest order wanted [-]
    """
    n = len(values)
    spectrum = np.fft.rfft(values) / n
    order = np.arange(len(spectrum)) * 2 * math.pi / period
    wanted = order <= highest + 1e-9
    amplitude = 2 * np.abs(spectrum)
    amplitude[0] = spectrum[0].real
    return Harmonics(order=order[wanted], amplitude=amplitude[wanted], phase=-np.angle(spectrum[wanted]))


def whole(found: Harmonics, order: int) -> complex:
    """One whole order as a complex amplitude.

    Returns
    -------
    amplitude : complex
        a exp(-i delta), so that the quantity is Re(a exp(i (k phi - delta)))
    """
    at = int(np.argmin(np.abs(found.order - order)))
    return complex(found.amplitude[at] * np.exp(-1j * found.phase[at]))
