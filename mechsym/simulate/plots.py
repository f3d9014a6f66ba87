"""Picture of a run: speed over time with its mean over each period, and the last period over its angle."""

from typing import TYPE_CHECKING

import numpy as np

from mechsym.quantities import RPM
from mechsym.simulate.result import Result
from mechsym.simulate.summary import last_period
from mechsym.style import BLUE, INK, RED, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def speed(result: Result, coordinate: str, period: float, wanted: float) -> "Figure":
    """Speed of a coordinate that turns.

    Parameters
    ----------
    period : float
        A turn, or two for a four-stroke engine [rad]
    wanted : float
        Speed of operation, drawn as a line [rad/s]
    """
    figure, (whole, last) = panels(9.0, 3.6, 1, 2, width_ratios=(2, 1), sharey=True)
    t, q, u = result.t, result.columns[coordinate], result.columns[f"{coordinate}d"] / RPM
    whole.plot(t, u, color=BLUE, lw=0.8, label="speed")
    ends = np.interp(np.arange(q[0], q[-1], period), np.maximum.accumulate(q), t)
    if len(ends) > 1:
        means = period / np.diff(ends) / RPM
        whole.stairs(means, ends, baseline=None, color=RED, lw=1.4, label=f"mean over {period / np.pi * 180:.0f} deg")
    whole.axhline(wanted / RPM, color=INK, lw=0.9, ls="--", label="speed of operation")
    whole.set(xlabel="t [s]", ylabel="speed [rpm]", title=f"{coordinate}: ended by {result.end}")
    whole.legend(frameon=False, fontsize=8, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3)
    keep = t >= last_period(result, coordinate, period)
    last.plot(np.degrees(q[keep] - q[keep][0]), u[keep], color=BLUE, lw=1.2)
    last.set(xlabel="angle [deg]", title="last period")
    return figure
