"""Pictures of torsional analysis: Campbell diagram, start-up, twist. Each returns a matplotlib figure."""

from collections.abc import Sequence
from itertools import cycle

import numpy as np
from matplotlib.figure import Figure

from mechsym.simulate import Result
from mechsym.style import BLUE, GREEN, GREY, INK, ORANGE, RED, bare
from mechsym.torsion.startup import StartUp
from mechsym.torsion.twist import pairs

_SERIES = (RED, BLUE, GREEN, ORANGE, INK)


def campbell(found: StartUp) -> Figure:
    """Natural frequency and orders of excitation over the speed; dots mark critical speeds that held the shaft."""
    figure = Figure(figsize=(7.5, 4.5), layout="constrained")
    axes = figure.add_subplot()
    top = 1.1 * max(c.speed for c in found.criticals)
    shown = [c for c in found.criticals if c.order <= 4]
    axes.axhline(found.natural, color=INK, lw=1.5)
    label = f"natural frequency {found.natural:.1f} rad/s"
    axes.text(0.84 * top, found.natural * 1.02, label, color=INK, va="bottom", ha="right")
    held = {c.critical.order for c in found.captures}
    for critical in shown:
        end = min(top, 1.3 * critical.speed)
        axes.plot([0, end], [0, critical.order * end], color=GREY, lw=1.0)
        axes.text(end, critical.order * end, f" order {critical.order:g}", color=INK, va="bottom")
        color = RED if critical.order in held else "white"
        axes.plot(critical.speed, found.natural, "o", mec=INK, mfc=color, ms=7)
        axes.annotate(
            f"{critical.speed:.1f}", (critical.speed, found.natural), (0, -16), textcoords="offset points", ha="center"
        )
    axes.set(xlim=(0, 1.08 * top), ylim=(0, 1.45 * found.natural), xlabel="crank speed [rad/s]")
    axes.set(ylabel="frequency [rad/s]", title="Orders of excitation and natural frequency")
    bare(axes)
    return figure


def start_up(runs: Sequence[StartUp], claim_speed: float | None = None) -> Figure:
    """Mean speed and twist of start-ups with several dampers, beside the rigid shaft.

    Parameters
    ----------
    claim_speed : float, optional
        Speed that the source reports [rad/s]
    """
    figure = Figure(figsize=(7.5, 6.5), layout="constrained")
    speed, twist = figure.subplots(2, 1, sharex=True)
    first = runs[0]
    onset, end = first.drive.time, float(first.result.t[-1])
    speed.plot([onset, end], [0, first.rigid_rate * (end - onset)], "--", color=GREY, label="rigid shaft")
    for run, color in zip(runs, _SERIES, strict=False):
        speed.plot(run.t, run.speed_mean, color=color, lw=1.6, label=f"c1 = {run.c1:g} N m s/rad")
        twist.semilogy(run.t, np.maximum(run.twist_amplitude, 1e-5), color=color, lw=1.2)
    if claim_speed is not None:
        speed.axhline(claim_speed, color=INK, lw=0.8, ls="-.")
        speed.text(0.02 * end, claim_speed, f"printed: {claim_speed:g} rad/s", va="bottom", fontsize=8)
        speed.set_ylim(top=1.12 * claim_speed)
    for critical in first.criticals:
        if critical.order <= 4 and critical.speed < speed.get_ylim()[1]:
            speed.axhline(critical.speed, color=GREY, lw=0.7, ls=":")
            speed.text(end, critical.speed, f" order {critical.order:g}", va="center", color=INK, fontsize=8)
    speed.set(ylabel="mean crank speed [rad/s]", title="Start-up by a constant torque")
    speed.legend(loc="upper left", bbox_to_anchor=(0.0, 0.9), frameon=False, fontsize=8)
    twist.set(xlabel="t [s]", ylabel="twist amplitude [rad]")
    for axes in (speed, twist):
        bare(axes)
    return figure


def twist(result: Result, shafts: int) -> Figure:
    """Speed of the ends of a shaft and twist of its sections over time.

    Parameters
    ----------
    result : Result
        A run of an elastic shaft
    """
    figure = Figure(figsize=(7.5, 6.0), layout="constrained")
    speed, twisted = figure.subplots(2, 1, sharex=True)
    found = pairs(result, shafts)
    for name, color in ((found[0][0], RED), (found[-1][1], BLUE)):
        speed.plot(result.t, result.columns[f"{name}d"], color=color, lw=0.9, label=name)
    for (a, b), color in zip(found, cycle((*_SERIES, GREY)), strict=False):
        twisted.plot(result.t, result.columns[a] - result.columns[b], color=color, lw=0.9, label=f"{a} - {b}")
    speed.set(ylabel="speed [rad/s]", title="Speed of both ends, and twist of the shaft")
    twisted.set(xlabel="t [s]", ylabel="twist [rad]")
    for axes in (speed, twisted):
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False, fontsize=8)
        bare(axes)
    return figure
