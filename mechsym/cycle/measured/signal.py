r"""What a sensor gives: noise, signals that no cylinder makes, and what it adds slowly inside a cycle.

Periodic cubic splines: what is left out is measured against the noise of the samples, and the noise against nothing but
themselves: fourth differences are blind to anything smooth.

Signals that no cylinder makes, refused before anything is read out of them.

sine, square wave     the hump is wider than compression and expansion of this geometry
camshaft degrees      two equal humps in one period, each half as wide
saturated, stuck      the same value again and again where the pressure must change

What a sensor adds slowly inside a cycle, told by two pressures that are known: of the inlet and of the exhaust.

    measured - offset = pressure + d (phi - phi_m) + c s(phi),     s = pressure after half an integration

A cycle ends where it began: what the mean cycle misses of that is drift d. A membrane that gas heats bends with the
temperature of its surface, and that of a thick body is half an integral of the heat; c takes the exhaust stroke to its
pressure where the inlet has its own.
"""

import math

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber, volume
from mechsym.errors import BadInput
from mechsym.periodic.roots import root
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


_DEG = math.radians(1.0)
_NEAR = 60 * _DEG
_NARROWEST, _WIDEST = 0.45, 2.5  # times the motored hump; knock gives 0.6, late burning 1.8
_SECOND = 0.6
_FLAT, _STUCK = 3 * _DEG, 20 * _DEG


def refuse_no_cylinder(
    file: str, angle: Radian[Array], rows: Pascal[Array], cylinder: Chamber, period: Radian, resolution: Pascal
) -> None:
    """Refuse what is no pressure of this cylinder, with the reason and the way out.

    angle: evenly spaced angles of one period; rows: measured pressure of each cycle, shape (k, n); period: 2 pi or 4
    pi; resolution: smallest step between two samples of the record that are not equal.
    """
    _refuse_flat(file, angle, rows, resolution)
    mean, step = rows.mean(axis=0), float(angle[1] - angle[0])
    _refuse_second_hump(file, mean, rows, step, period)
    swing = float(np.ptp(mean))
    wide = float(np.count_nonzero(mean > mean.min() + swing / 2)) * step
    usual = motored_width(cylinder)
    if not _NARROWEST < wide / usual < _WIDEST:
        raise BadInput(
            f"{file}: the pressure stays above half of its swing for {math.degrees(wide):.0f} deg; compression and "
            f"expansion of this cylinder take {math.degrees(usual):.0f} deg, burning 0.6 to 1.8 times that; is it a "
            "cylinder pressure over crank degrees, of this compression_ratio?"
        )


def motored_width(cylinder: Chamber) -> Radian:
    r"""Crank angle over which a motored charge is above half of its peak pressure.

    .. math:: \left(V(\varphi)/V_c\right)^{-1.33} = 1/2

    Returns width: both sides of the dead centre; half a turn where the compression ratio is too low for that.
    """
    v_c, half = float(volume(cylinder, 0.0)), 2 ** (1 / 1.33)
    if cylinder.compression_ratio <= half:
        return math.pi
    return 2 * root(lambda phi: float(volume(cylinder, phi)) / v_c - half, 0.0, math.pi)


def _refuse_second_hump(file: str, mean: np.ndarray, rows: np.ndarray, step: float, period: float) -> None:
    lowest, top = float(mean.min()), int(np.argmax(mean))
    if period > 3 * math.pi:
        other = np.take(
            mean, top + round(2 * math.pi / step) + np.arange(-round(_NEAR / step), round(_NEAR / step)), mode="wrap"
        )
        share = (float(other.max()) - lowest) / (float(mean[top]) - lowest)
        if share > _SECOND:
            raise BadInput(
                f"{file}: two humps in 720 deg, the second with {share:.2f} of the first: are these camshaft degrees "
                "(twice the angle is crank degrees), or is it a two-stroke engine (working_cycle)?"
            )
    elif len(rows) > 1:
        swings = np.ptp(rows, axis=1)
        share = float(np.median(swings[1::2]) / np.median(swings[::2]))
        if not 0.35 < share < 1 / 0.35:
            raise BadInput(
                f"{file}: every second turn swings by {min(share, 1 / share):.2f} of the others: a four-stroke engine; "
                "set working_cycle = 'four-stroke'"
            )


def _refuse_flat(file: str, angle: np.ndarray, rows: np.ndarray, resolution: float) -> None:
    step = float(angle[1] - angle[0])
    reach = np.arange(-round(_NEAR / step), round(_NEAR / step) + 1)
    for number, row in enumerate(rows, start=1):
        top = int(np.argmax(row))
        near = np.take(row, top + reach, mode="wrap")
        # start and number of samples of the longest piece of equal values
        edges = np.flatnonzero(np.concatenate([[True], np.diff(near) != 0, [True]]))
        longest = int(np.argmax(np.diff(edges)))
        first, length = int(edges[longest]), int(edges[longest + 1] - edges[longest])
        flat = length * step
        # a peak is round: beside a flat top that is the sensor's the pressure falls in steps far above the resolution
        ends = np.take(near, [max(first - 1, 0), min(first + length, near.size - 1)])
        clipped = (
            near[first] == row.max()
            and length > 3
            and flat > _FLAT
            and np.abs(ends - near[first]).max() > 4 * resolution
        )
        if clipped or flat > _STUCK:
            what = "saturated" if clipped else "stuck"
            raise BadInput(
                f"{file}: the sensor is {what} at {near[first] / 1e5:.5g} bar for {math.degrees(flat):.1f} deg of "
                f"cycle {number}, where the pressure must change; record again with a wider range, or cut the cycle out"
            )


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

    Source: temperature of the surface of a semi-infinite body under a periodic heat flux (Carslaw and Jaeger 1959,
    section 2.6), its flux taken as that of the pressure.

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
