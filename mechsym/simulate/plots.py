"""Pictures of a run: speed over time and over the last period; and events of stops, contacts and friction."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechsym.quantities.units import Radian, RadPerSecond
from mechsym.simulate.result import Result, last_period, period_ends, period_means
from mechsym.style import (
    BLUE,
    GREEN,
    INK,
    ORANGE,
    RED,
    TEAL,
    VIOLET,
    axis_unit,
    envelope,
    heading,
    legend,
    over_angle,
    panels,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure


_LEAST, _SPAN = 1e-3, 0.02  # of the speed: what swings less is round-off, and drawn over so much


_KINDS = {"hit": RED, "touch": RED, "rest": VIOLET, "release": GREEN, "stick": BLUE, "slip": ORANGE, "turn": TEAL}
_FINE = 2000  # times of a motion with events, which is quicker than its table
_MOST = 4  # coordinates that are drawn


def motion(result: Result, outputs: Sequence[str] = ()) -> "Figure":
    """Coordinates and their speeds over time, and outputs, two beside one another."""
    places, (t, columns) = _places(result), _finely(result)
    shown = [(n, t, columns) for q in places for n in (q, f"{q}d")]
    shown += [(n, result.t, result.columns) for n in outputs[: 2 * _MOST]]
    rows = -(-len(shown) // 2)
    figure, axes = panels(9.0, 1.6 * rows + 0.7, rows, 2, "Motion over time", sharex=True)
    every = np.ravel(axes)
    for axis, (name, times, of) in zip(every, shown, strict=False):
        factor, unit = axis_unit(result.units[name], of[name])
        envelope(axis, times, of[name] * factor, BLUE)
        rate = name not in (*places, *outputs)
        axis.set_ylabel(f"{'speed of ' if rate else ''}{name.removesuffix('d' * rate).replace('_', ' ')} [{unit}]")
    for axis in every[len(shown) :]:
        axis.set_visible(False)
    for axis in every[max(len(shown) - 2, 0) : len(shown)]:
        axis.set_xlabel("time [s]")
        axis.tick_params(labelbottom=True)
    return figure


def met(result: Result) -> "Figure":
    """Coordinates over time, and below them what each stop, contact and friction did when."""
    places, (t, columns) = _places(result), _finely(result)
    names = list(dict.fromkeys(e.name for e in result.happened.events))
    height = 1.3 * len(places) + 0.9 + 0.25 * len(names)
    figure, axes = panels(9.0, height, len(places) + 1, 1, "Motion and events over time", sharex=True)
    for axis, name in zip(axes, places, strict=False):
        factor, unit = axis_unit(result.units[name], columns[name])
        envelope(axis, t, columns[name] * factor, BLUE)
        axis.set_ylabel(f"{name.replace('_', ' ')} [{unit}]")
    last = axes[-1]
    for kind, color in _KINDS.items():
        marks = [(e.t, names.index(e.name)) for e in result.happened.events if e.kind == kind]
        if marks:
            last.plot(*zip(*marks, strict=True), ls="", marker="o", ms=4, color=color, label=kind)
    last.set_yticks(range(len(names)), [n.replace("_", " ") for n in names])
    last.set(xlabel="time [s]", ylim=(-0.6, len(names) - 0.4))
    legend(last, width=8.0)
    return figure


def _places(result: Result) -> list[str]:
    return [n for n in result.columns if f"{n}d" in result.columns][:_MOST]


def _finely(result: Result) -> tuple[np.ndarray, Mapping[str, np.ndarray]]:
    """Times and columns, where the run can tell them finer than its table."""
    if result.dense is None:
        return result.t, result.columns
    t = np.linspace(result.t[0], result.t[-1], _FINE)
    return t, result.dense(t)


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
    heading(whole, f"speed of the {words or 'shaft'}{'' if result.as_planned else f', ended by {result.end}'}")
    legend(whole, width=5.0)
    keep = t >= last_period(result, coordinate, period)
    angle = over_angle(last, period, "angle", steps=4)
    last.plot((q[keep] - q[keep][0]) * angle, u[keep] * factor, color=BLUE, lw=1.2)
    heading(last, "last period")
    return figure
