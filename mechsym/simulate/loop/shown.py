"""What of a run of the loop, gas and shaft together, is worth seeing."""

from typing import TYPE_CHECKING

import numpy as np

from mechsym.page import Card, Picture, View, shows
from mechsym.quantities.display import quantity_text, residual_text
from mechsym.simulate.loop.run import LoopResult

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@shows(LoopResult)
def loop_view(result: LoopResult) -> View:
    """How the run ended, its speed over the last cycle, its pressures, its audit."""
    last = result.cycles[-1].time if result.cycles else float(result.t[0])
    speed = result.u[result.t >= last, 0]
    mean = float(np.mean(speed))
    cards = (
        Card(name="run", value=result.status, about=result.reason, mark="no" if result.status == "failed" else ""),
        Card(
            name="speed at the end",
            value=quantity_text(float(result.u[-1, 0]), "rad/s", 4),
            about=f"mean since the last exhaust {quantity_text(mean, 'rad/s', 4)}",
        ),
        Card(name="peak pressure", value=quantity_text(float(result.p.max()), "Pa", 4), about="absolute"),
        Card(
            name="energy residual", value=residual_text(result.energy_residual, 2), about="of the work of the pistons"
        ),
    )
    see = "Speed of the crank, and pressure of each cylinder: whether the speed settles and the cycles repeat."
    drawn = (Picture(name="run", see=see, draw=lambda: _drawn(result)),)
    return View(title="Gas and shaft together", cards=cards, pictures=drawn, columns=lambda: {
        "t [s]": result.t, **{f"q_{k + 1} [rad]": q for k, q in enumerate(result.q.T)},
        **{f"u_{k + 1} [rad/s]": u for k, u in enumerate(result.u.T)},
        **{f"p_{k + 1} [Pa]": p for k, p in enumerate(result.p.T)}})  # fmt: skip


def _drawn(run: LoopResult) -> "Figure":
    from mechsym.style import BLUE, SERIES, axis_unit, envelope, legend, panels

    figure, (upper, lower) = panels(8, 4.6, 2, 1, "Speed and pressures over time", sharex=True)
    (factor, unit), (pressing, pressure) = axis_unit("rad/s", run.u[:, 0]), axis_unit("Pa", run.p)
    envelope(upper, run.t, run.u[:, 0] * factor, BLUE)
    for k, p in enumerate(run.p.T):
        envelope(lower, run.t, p * pressing, SERIES[k % len(SERIES)], f"cylinder {k + 1}")
    upper.set_ylabel(f"speed [{unit}]")
    lower.set(xlabel="time [s]", ylabel=f"absolute pressure [{pressure}]")
    legend(lower)
    return figure
