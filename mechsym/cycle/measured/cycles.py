"""A recording cut into cycles on one grid of angles.

    recording  |--------x--------x--------x-----|       x: cuts, one period apart, never through compression,
    cycles          k=0      k=1      k=2                   combustion or expansion

The cut is the record's own start where that is harmless, so that no cycle is lost; else it moves on to 120 degrees
behind the pressure peak.
"""

import math

import numpy as np
import scipy

from mechsym.cycle.measured.file import Recording
from mechsym.quantities.units import Array, Pascal, Radian

# The cut may not lie between these angles from the pressure peak
_BEFORE, _AFTER = math.radians(-140.0), math.radians(80.0)
_CUT = math.radians(120.0)
_FEWEST, _MOST = 720, 7200


def cut_cycles(recording: Recording, period: Radian) -> tuple[Radian[Array], Pascal[Array]]:
    """Cut a recording into whole cycles.

    period: 2 pi or 4 pi. Returns angle: evenly spaced angles of the first cycle, zero as in the file; cycles: pressure
    of each cycle, shape (k, n). An even record whose step divides the period is taken sample by sample; another one is
    interpolated with a monotone cubic (PCHIP) to steps no wider than its own. A record of a single cycle is continued
    periodically.
    """
    start = float(recording.angle[0])
    angle, cycles = _cut(recording.angle, recording.pressure, start, period)
    top = angle[int(np.argmax(cycles.mean(axis=0)))]
    behind = math.remainder(start - top, period)
    if not _BEFORE < behind < _AFTER:
        return angle, cycles
    wanted = start + (top + _CUT - start) % period
    if recording.angle[-1] - wanted >= period - 1.5 * (angle[1] - angle[0]):
        return _cut(recording.angle, recording.pressure, wanted, period)
    twice = np.concatenate([angle, angle + period])
    angle, cycles = _cut(twice, np.tile(cycles[0], 2), wanted, period)
    return angle, cycles[:1]


def _cut(angle: np.ndarray, pressure: np.ndarray, start: float, period: float) -> tuple[np.ndarray, np.ndarray]:
    steps = np.diff(angle)
    step, widest = float(np.median(steps)), float(steps.max())
    first = int(np.searchsorted(angle, start - 1e-3 * step))
    count = math.floor((angle[-1] - angle[first] + 1.001 * widest) / period)
    per_period = round(period / step)
    if bool(np.all(np.abs(steps - step) < 1e-3 * step)) and abs(per_period * step - period) < 1e-3 * step:
        cycles = pressure[first : first + count * per_period].reshape(count, per_period)
        return angle[first] + period / per_period * np.arange(per_period), cycles
    samples = int(np.clip(math.ceil(period / float(steps.min())), _FEWEST, _MOST))
    grid = angle[first] + period / samples * np.arange(samples)
    at = grid + period * np.arange(count)[:, None]
    if at[-1, -1] > angle[-1]:
        # the last cycle closes on the pressure it began with
        pressure = np.append(pressure, np.interp(at[-1, 0], angle, pressure))
        angle = np.append(angle, at[-1, 0] + period)
    return grid, scipy.interpolate.PchipInterpolator(angle, pressure)(at)
