r"""Signals that no cylinder makes, refused before anything is read out of them.

sine, square wave     the hump is wider than compression and expansion of this geometry
camshaft degrees      two equal humps in one period, each half as wide
saturated, stuck      the same value again and again where the pressure must change
"""

import math

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber, volume
from mechsym.errors import BadInput
from mechsym.quantities.units import Array, Pascal, Radian

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
    return 2 * float(scipy.optimize.brentq(lambda phi: float(volume(cylinder, phi)) / v_c - half, 0.0, math.pi))


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
        first, length = _longest_run(near)
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


def _longest_run(values: np.ndarray) -> tuple[int, int]:
    """Start and number of samples of the longest piece of equal values."""
    edges = np.flatnonzero(np.concatenate([[True], np.diff(values) != 0, [True]]))
    longest = int(np.argmax(np.diff(edges)))
    return int(edges[longest]), int(edges[longest + 1] - edges[longest])
