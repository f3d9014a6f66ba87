"""Pictures of torsional analysis: Campbell diagram, start-up, twist. Each returns a matplotlib figure."""

from collections.abc import Mapping, Sequence
from itertools import cycle
from typing import TYPE_CHECKING

import numpy as np

from mechsym.quantities.units import RadPerSecond
from mechsym.simulate import Result
from mechsym.style import GREY, INK, PAPER, RED, SERIES, axis_unit, envelope, heading, legend, panels, spread
from mechsym.torsion.startup import StartUp
from mechsym.torsion.twist import pairs, section_words

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_MOST_ORDERS = 4


def campbell(start: StartUp) -> "Figure":
    """Natural frequency and orders of excitation over the speed; dots mark critical speeds that held the shaft."""
    figure, (axes,) = panels(7.5, 4.8, title="Orders of excitation and natural frequency over the crank speed")
    factor, unit = axis_unit("rad/s", start.natural)
    top = 1.1 * max(c.speed for c in start.criticals)
    shown = [c for c in start.criticals if c.order <= _MOST_ORDERS]
    natural, held = start.natural * factor, {c.critical.order for c in start.captures}
    high = 1.45 * natural
    axes.axhline(natural, color=INK, lw=1.5, label=f"natural frequency {natural:.4g} {unit}")
    ends = [min(top, 1.3 * c.speed) for c in shown]
    heights = spread([min(c.order * e * factor / high, 1.0) for c, e in zip(shown, ends, strict=True)], 0.06, 0.0, 1.0)
    for critical, end, height in zip(shown, ends, heights, strict=True):
        speed = critical.speed * factor
        axes.plot([0, end * factor], [0, critical.order * end * factor], color=GREY, lw=1.0)
        words, at = f"order {critical.order:g}: {speed:.4g} {unit}", (end * factor, critical.order * end * factor)
        axes.annotate(words, at, (1.02, height), textcoords="axes fraction", va="center", fontsize=8, color=INK,
                      arrowprops={"arrowstyle": "-", "color": GREY, "lw": 0.5})  # fmt: skip
        color = RED if critical.order in held else PAPER
        axes.plot(speed, natural, "o", mec=INK, mfc=color, ms=7)
    axes.set(
        xlim=(0, 1.08 * top * factor), ylim=(0, high), xlabel=f"crank speed [{unit}]", ylabel=f"frequency [{unit}]"
    )
    for color, words in ((PAPER, "critical speed"), (RED, "critical speed that held the shaft")):
        axes.plot([], [], "o", mec=INK, mfc=color, ms=7, label=words)
    legend(axes)
    return figure


def start_up(runs: Sequence[StartUp], claim_speed: RadPerSecond | None = None) -> "Figure":
    """Mean speed and twist of start-ups with several dampers, beside the rigid shaft.

    claim_speed: speed that the source reports.
    """
    figure, (speed, twist) = panels(7.5, 6.5, 2, 1, "Start-up: mean speed and twist over time", sharex=True)
    first = runs[0]
    factor, unit = axis_unit("rad/s", first.natural)
    angle, angle_unit = axis_unit("rad", 1.0)
    onset, end = first.drive.time, float(first.result.t[-1])
    speed.plot([onset, end], [0, first.rigid_rate * (end - onset) * factor], "--", color=GREY, label="rigid shaft")
    for run, color in zip(runs, SERIES[1:], strict=False):
        speed.plot(run.t, run.speed_mean * factor, color=color, lw=1.6, label=f"c1 = {run.c1:g} N m s/rad")
        twist.semilogy(run.t, np.maximum(run.twist_amplitude, 1e-5) * angle, color=color, lw=1.2)
    marks = {f"order {c.order:g}": c.speed * factor for c in first.criticals if c.order <= _MOST_ORDERS}
    if claim_speed is not None:
        marks["printed"] = claim_speed * factor
        speed.set_ylim(top=1.12 * claim_speed * factor)
    _levels(speed, marks)
    speed.set(ylabel=f"mean crank speed [{unit}]")
    legend(speed)
    twist.set(xlabel="time [s]", ylabel=f"twist amplitude [{angle_unit}]")
    return figure


def _levels(axis: "Axes", marks: Mapping[str, float]) -> None:
    """Lines across a panel with their names at its right."""
    low, high = axis.get_ylim()
    shown = {name: at for name, at in marks.items() if low <= at <= high}
    places = spread([(at - low) / (high - low) for at in shown.values()], 0.07, 0.0, 1.0)
    for (name, at), place in zip(shown.items(), places, strict=True):
        axis.axhline(at, color=GREY, lw=0.7, ls=":")
        axis.text(1.01, place, name, transform=axis.transAxes, va="center", color=INK, fontsize=8)


def twist(result: Result, shafts: int) -> "Figure":
    """Speed of the ends of a shaft and twist of its sections over time, and the last two turns of the crank.

    result: a run of an elastic shaft.
    """
    name = "Speed of both ends of the shaft and its twist, over time and in the last two turns"
    figure, axes = panels(9, 6.0, 2, 2, name, width_ratios=(2, 1), sharex="col", sharey="row")
    ends_of = pairs(result, shafts)
    ends = {"free end": result.columns[f"{ends_of[0][0]}d"], "flywheel": result.columns[f"{ends_of[-1][1]}d"]}
    twists = {section_words(k, len(ends_of)): result.columns[a] - result.columns[b] for k, (a, b) in enumerate(ends_of)}
    last = result.columns[ends_of[0][0]] >= result.columns[ends_of[0][0]][-1] - 4 * np.pi
    for row, (curves, si, label) in enumerate(((ends, "rad/s", "speed"), (twists, "rad", "twist"))):
        whole, zoomed = axes[2 * row : 2 * row + 2]
        factor, unit = axis_unit(si, *curves.values())
        for (curve, values), color in zip(curves.items(), cycle(SERIES[1:]), strict=False):
            envelope(whole, result.t, values * factor, color, curve)
            zoomed.plot(result.t[last], values[last] * factor, color=color, lw=0.9)
        whole.set(ylabel=f"{label} [{unit}]")
        legend(whole, width=5.0)
    for axis in axes[2:]:
        axis.set(xlabel="time [s]")
    heading(axes[1], "last two turns")
    return figure
