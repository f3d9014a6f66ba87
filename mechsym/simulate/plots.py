"""Picture of a run: speed over time with its mean over each period, and the last period over its angle."""

from typing import TYPE_CHECKING

import numpy as np

from mechsym.quantities.units import Radian, RadPerSecond
from mechsym.simulate.result import Result, last_period, period_ends, period_means
from mechsym.style import BLUE, INK, RED, axis_unit, envelope, heading, legend, over_angle, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_LEAST, _SPAN = 1e-3, 0.02  # of the speed: what swings less is round-off, and drawn over so much
_PLANNED = ("turns", "t_end")  # ends that a run was made for


def speed(result: Result, coordinate: str, period: Radian, wanted: RadPerSecond, words: str = "") -> "Figure":
    """Speed of a coordinate that turns.

    period: a turn, or two for a four-stroke engine; wanted: speed of operation, drawn as a line; words: the
    coordinate's name for people, where there are several.
    """
    figure, (whole, last) = panels(
        9.0, 3.9, 1, 2, "Speed over time and over the angle", width_ratios=(2, 1), sharey=True
    )
    t, q, u = result.t, result.columns[coordinate], result.columns[f"{coordinate}d"]
    factor, unit = axis_unit("rad/s", u)
    envelope(whole, t, u * factor, BLUE, "speed")
    ends = period_ends(result, coordinate, period)
    if len(ends) > 1:
        means = period_means(result, coordinate, period) * factor
        turns = round(period / (2 * np.pi))
        label = f"mean over {'a turn' if turns == 1 else f'{turns} turns'}"
        whole.stairs(means, ends, baseline=None, color=RED, lw=1.4, label=label)
    whole.axhline(wanted * factor, color=INK, lw=0.9, ls="--", label="speed of operation")
    low, high = whole.get_ylim()
    if high - low < _LEAST * wanted * factor:  # round-off is no ripple
        whole.set_ylim(np.array([-0.5, 0.5]) * _SPAN * wanted * factor + (low + high) / 2)
    whole.set(xlabel="time [s]", ylabel=f"speed [{unit}]")
    heading(whole, f"speed of the {words or 'shaft'}{'' if result.end in _PLANNED else f', ended by {result.end}'}")
    legend(whole, width=5.0)
    keep = t >= last_period(result, coordinate, period)
    angle = over_angle(last, period, "angle", steps=4)
    last.plot((q[keep] - q[keep][0]) * angle, u[keep] * factor, color=BLUE, lw=1.2)
    heading(last, "last period")
    return figure
