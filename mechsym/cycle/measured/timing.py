r"""Speed of a measured record from its times, and how far angles are off that were spread evenly over each turn.

time |        . '   by teeth: bent, the shaft slows down in compression and speeds up behind combustion
     |   . '
     | '_____|_____ angle     spread evenly: straight between two marks, with a kink at every mark
"""

import math

import numpy as np

from mechsym.cycle.chamber import Chamber, dvolume_dphi
from mechsym.cycle.measured.diagram import Diagram, period_of
from mechsym.cycle.measured.file import Recording, read_diagram
from mechsym.quantities.units import Array, Pascal, Radian, RadPerSecond

_TURN = 2 * math.pi
_STRAIGHT = math.radians(0.1)
_KINK = 1e-3
_UNKNOWN = math.radians(1.5)  # where the speeds of the turns do not tell: usual for one cylinder
_MOST = math.radians(4.0)


def cycle_speeds(recording: Recording, start: Radian, period: Radian, count: int) -> RadPerSecond[Array] | None:
    """Mean speed of every cycle.

    start: angle at which the first cycle begins; period: 2 pi or 4 pi. Returns omega: from the first to the last sample
    of each cycle; None without times, shape (k,).
    """
    if recording.time is None:
        return None
    at = np.searchsorted(recording.angle, start + period * np.arange(count + 1) - 1e-9)
    first, last = at[:-1], np.minimum(at[1:], recording.angle.size - 1)
    return (recording.angle[last] - recording.angle[first]) / (recording.time[last] - recording.time[first])


def recorded_speed(recording: Recording) -> RadPerSecond | None:
    """Mean speed of a whole record. Returns omega: None without times."""
    if recording.time is None:
        return None
    return float((recording.angle[-1] - recording.angle[0]) / (recording.time[-1] - recording.time[0]))


def speed_of(diagram: Diagram) -> RadPerSecond | None:
    """Speed that the file of a diagram tells by its times; None without them."""
    if not diagram.file:
        return None
    columns = diagram.angle_column, diagram.pressure_column
    return recorded_speed(read_diagram(diagram.file, period_of(diagram), *columns, diagram.recorded_speed))


def turn_speeds(recording: Recording) -> RadPerSecond[Array] | None:
    """Mean speed of every whole turn between two zeros of the encoder, where the angles are spread evenly over them.

    Returns omega: None without times, with fewer than three turns, or where the angles follow the shaft inside a turn,
    shape (k,).
    """
    if recording.time is None:
        return None
    turn = np.floor(recording.angle / _TURN + 1e-9)
    whole = [t for t in np.unique(turn) if np.count_nonzero(turn == t) > 20][1:-1]
    speeds = []
    for number in whole:
        angle, time = recording.angle[turn == number], recording.time[turn == number]
        slope, level = np.polyfit(time - time[0], angle, 1)
        if np.abs(level + slope * (time - time[0]) - angle).max() > _STRAIGHT:
            return None
        speeds.append(slope)
    found = np.array(speeds)
    kinked = found.size >= 3 and float(np.median(np.abs(np.diff(found)) / found.mean())) > _KINK
    return found if kinked else None


def spread_error(
    turns: RadPerSecond[Array], phi: Radian[Array], p: Pascal[Array], cylinder: Chamber, zero: Radian
) -> Radian:
    r"""How far angles are off that were spread evenly over each turn.

    .. math:: \frac{\Delta\omega}{\omega} = \frac{1}{J\omega^2} \int (M - \bar M)\,d\varphi, \quad
        e = \int_{turn} \left(\frac{\Delta\omega}{\omega} - \overline{\frac{\Delta\omega}{\omega}}\right) d\varphi

    turns: speed of successive turns, shape (k,); phi: evenly spaced crank angles of one period, from firing TDC; p:
    absolute pressure of the mean cycle; zero: crank angle at which a turn of the encoder begins.

    Returns
    -------
    error : float
        Largest error over the period, from the gas torque M and the inertia J that explains by how much the speeds
        of successive turns differ; 1.5 degrees where they cannot tell
    """
    step, count = float(phi[1] - phi[0]), round(phi.size * float(phi[1] - phi[0]) / _TURN)
    torque = p * dvolume_dphi(cylinder, phi)
    wave = np.cumsum(torque - torque.mean()) * step
    from_mark = np.argsort(np.remainder(phi - zero, phi.size * step))
    halves = np.array_split(wave[from_mark], count)
    differ = float(np.ptp([half.mean() for half in halves]))
    if count < 2 or differ < 0.02 * float(np.ptp(wave)):
        return _UNKNOWN
    seen = float(np.mean(np.abs(np.diff(turns)))) / float(turns.mean())
    error = np.concatenate([np.cumsum(half - half.mean()) for half in halves]) * step
    return min(float(np.abs(error).max()) * seen / differ, _MOST)
