r"""What a sensor adds slowly inside a cycle, told by two pressures that are known: of the inlet and of the exhaust.

    measured - offset = pressure + d (phi - phi_m) + c s(phi),     s = pressure after half an integration

A cycle ends where it began: what the mean cycle misses of that is drift d. A membrane that gas heats bends with the
temperature of its surface, and that of a thick body is half an integral of the heat; c takes the exhaust stroke to its
pressure where the inlet has its own.
"""

import math

import numpy as np

from mechsym.cycle.measured.smoothing import noise
from mechsym.quantities.units import Array, Pascal

_USUAL = 0.01  # of the swing, assumed: thermal shock is stated as some tenths of a bar
_QUIET = 0.1  # of the swing above the least pressure: cycles differ where more is cut through
_BESIDE = 8  # samples on each side of the cut, under one cubic
_X = np.append(np.arange(-_BESIDE, 0), np.arange(_BESIDE)) + 0.5
_ENDS = np.linalg.pinv(np.column_stack([_X**0, _X, _X**2, _X**3, _X < 0]))[-1]


def closing(mean: Pascal[Array]) -> Pascal:
    """By how much the end of a mean cycle lies above its beginning, under one cubic through both.

    mean: evenly spaced samples of one period, cut where the pressure is smooth.
    """
    return float(_ENDS @ np.append(mean[-_BESIDE:], mean[:_BESIDE]))


def without_drift(rows: Pascal[Array]) -> Pascal[Array]:
    r"""Cycles without the drift that their mean shows, as far as that is more than noise.

    .. math:: d = \frac{s^2}{s^2 + e^2}\,\hat d, \quad s = 0.01\,(p_{max} - p_{min})

    rows: shape (k, n), as long as one period. e is the standard deviation of what the mean cycle misses, by its noise
    or by the scatter of the cycles. Nothing is taken off where the cut goes through compression or combustion.
    """
    mean = rows.mean(axis=0)
    usual, missed = _USUAL * float(np.ptp(mean)), closing(mean)
    if max(mean[0], mean[-1]) - mean.min() > _QUIET / _USUAL * usual or usual == 0.0:
        return rows
    error = noise(mean) * float(np.linalg.norm(_ENDS))
    if len(rows) > 2:
        error = max(error, float(np.std([closing(row) for row in rows], ddof=1)) / math.sqrt(len(rows)))
    kept = usual**2 / (usual**2 + error**2)
    return rows - kept * missed * _ramp(rows.shape[1])


def _ramp(count: int) -> Array:
    return (np.arange(count) + 0.5) / count - 0.5


def half_integral(values: Pascal[Array], periods: int) -> Array:
    r"""A periodic signal after half an integration over the crank angle, its mean taken out [Pa rad^0.5].

    .. math:: s = \sum_k \frac{\hat p_k}{\sqrt{i k/m}}\,e^{i k \varphi/m}

    values: evenly spaced samples of one period; periods: turns m in it.

    Notes
    -----
    Source: temperature of the surface of a semi-infinite body under a periodic heat flux (Carslaw and Jaeger 1959,
    section 2.6), its flux taken as that of the pressure.

    Examples
    --------
    >>> phi = np.arange(8) * np.pi / 4
    >>> float(half_integral(np.cos(phi), 1)[1].round(9))
    1.0
    """
    spectrum, order = np.fft.rfft(values), np.arange(len(values) // 2 + 1) / periods
    spectrum[0], order[0] = 0.0, 1.0
    return np.asarray(np.fft.irfft(spectrum / np.sqrt(1j * order), len(values)))


def without_swing(rows: Pascal[Array], periods: int, low: Array, high: Array, rise: Pascal) -> Pascal[Array]:
    """Cycles without drift and thermal swing.

    rows: shape (k, n); periods: turns in each; low, high: which samples lie where the pressure of the inlet and of the
    exhaust is known, shape (n,) [-]; rise: from the first of these pressures to the second.
    """
    count, mean = rows.shape[1], rows.mean(axis=0)
    slow = closing(mean) * _ramp(count)
    shape = half_integral(mean - slow, periods)
    missed = float((mean - slow)[high].mean() - (mean - slow)[low].mean()) - rise
    return rows - slow - missed / float(shape[high].mean() - shape[low].mean()) * shape
