"""Speed of shafts over a stretch of a motion: mean, extremes of the dense solution, and the ripple.

Output samples say where a speed is about to turn; what it is there says the solution between them.
"""

from collections.abc import Callable

import numpy as np

from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pure, Radian, Second

#: ascending times (n,) [s] to coordinates and velocities (k, n) [rad, rad/s], up to where the motion ends
Dense = Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]

_SURE = 1e-10  # of the largest speed: what a finer look may still add to an extreme
_LOOKS = 8  # at most; a smooth extreme needs two, one at a kink of the torque six
_DOUBTED = 2  # a parabola through samples that are far apart adds too little
_FINER = 4, 64  # parts of a bracket in the next look: of many, and of four or fewer
_MOST = 1000  # peaks of nearly one height that are followed


@record
class Speed:
    """Speed of a coordinate over a stretch."""

    mean: float  #: Advance by time; negative of a shaft that turns backwards [rad/s]
    min: float  #: Least, with its sign [rad/s]
    max: float  #: Greatest, with its sign [rad/s]

    @property
    def ripple(self) -> Pure | None:
        r"""Speed ripple, the one definition of the package.

        .. math:: \delta = \frac{\omega_\max - \omega_\min}{|\omega_\mathrm{mean}|}

        Returns delta: ripple; None where nothing advances.
        """
        return (self.max - self.min) / abs(self.mean) if self.mean else None


def speeds(dense: Dense, t: Second[Array]) -> list[Speed]:
    """Speed of each coordinate at times t over a whole stretch, as fine as the motion is smooth."""
    q, u = dense(t)
    end = q.shape[1] - 1
    mean = (q[:, end] - q[:, 0]) / (t[end] - t[0])
    least, greatest = extremes(lambda times: dense(times)[1], t, u)
    return [Speed(mean=float(m), min=float(a), max=float(b)) for m, a, b in zip(mean, least, greatest, strict=True)]


def extremes(
    values: Callable[[np.ndarray], np.ndarray], t: Second[Array], rows: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest of values over a stretch, between the times that were looked at too.

    values: ascending times (n,) -> values (k, n), up to where the motion ends. t: times as close as the motion is
    smooth. rows: the values there [unit of the values]. Returns least, greatest: shape (k,) [unit of the values].
    """
    ends = _greatest(lambda times: _both(values(times)), t, _both(rows))
    return -ends[: len(rows)], ends[len(rows) :]


def _both(rows: np.ndarray) -> np.ndarray:
    """Values whose greatest are the least with the other sign, then the greatest."""
    return np.vstack([-rows, rows])


def _greatest(values: Callable[[np.ndarray], np.ndarray], t: np.ndarray, rows: np.ndarray) -> np.ndarray:
    """Greatest of each row (k,): where it may be more than was seen at times t, it is looked at more finely."""
    greatest = rows.max(axis=1)
    for _ in range(_LOOKS):
        t, brackets = t[: rows.shape[1]], []
        for k, row in enumerate(rows):
            at = np.flatnonzero((row[1:-1] >= row[:-2]) & (row[1:-1] >= row[2:])) + 1
            before, after = t[at] - t[at - 1], t[at + 1] - t[at]
            rise, fall = (row[at] - row[at - 1]) / before, (row[at + 1] - row[at]) / after
            bend, slope = (fall - rise) / (before + after), (rise * after + fall * before) / (before + after)
            even = np.abs(after - before) < 0.5 * (after + before)  # not across the gap between two brackets
            peak = (bend < 0) & even
            # what a parabola through the sample and its neighbours adds to it
            at, gain = at[peak], slope[peak] ** 2 / (-4 * bend[peak])
            more = (gain > 0) & (row[at] + _DOUBTED * gain >= greatest[k])
            may, gain = at[more], gain[more]
            if gain.max(initial=0.0) <= _SURE * np.abs(row).max():
                greatest[k] = max(greatest[k], (row[may] + gain).max(initial=-np.inf))
                continue
            brackets += [(t[i - 1], t[i + 1]) for i in may[np.argsort(-(row[may] + gain))][:_MOST]]
        if not brackets:
            break
        parts = max(_FINER[0], _FINER[1] // (len(brackets) // 4 + 1))
        begins, ends = np.transpose(brackets)
        t = np.unique(np.linspace(begins, ends, parts + 1))
        rows = values(t)
        greatest = np.maximum(greatest, rows.max(axis=1))
    return greatest


def before_last_period(q: np.ndarray, period: float) -> int | None:
    """The sample before the last period [rad] of a coordinate q [rad], either way it turns; None in a shorter run."""
    before = np.flatnonzero(np.abs(q - q[-1]) >= period * (1 - 1e-9))
    return int(before[-1]) if len(before) and before[-1] < len(q) - 1 else None


def last_period(t: Second[Array], q: np.ndarray, u: np.ndarray, period: Radian, end: Radian | None = None) -> Second:
    """When the last period of a coordinate began.

    t: times of samples as close as the motion is smooth. q, u: coordinate and its velocity there [rad, rad/s]. period:
    a turn, or two for a four-stroke engine. end: where the last period ends; None is the last sample. Returns t: the
    start of a run that is shorter.
    """
    end = q[-1] if end is None else end
    i = before_last_period(np.append(q, end), period)
    if i is None or i == len(t) - 1:
        return float(t[0 if i is None else i])
    wanted, a, b = end + np.copysign(period, q[i] - end), q[i], q[i + 1]
    if (wanted - a) * (b - a) <= 0:  # the sample itself, to rounding
        return float(t[i])
    if u[i] * u[i + 1] <= 0 or u[i] * (b - a) <= 0:  # it swings there
        return float(t[i] + (wanted - a) / (b - a) * (t[i + 1] - t[i]))
    way = np.sign(b - a)
    inverse = PPoly.hermite(way * np.array([a, b]), t[i : i + 2], way / u[i : i + 2])
    return float(np.clip(inverse(way * wanted), t[i], t[i + 1]))
