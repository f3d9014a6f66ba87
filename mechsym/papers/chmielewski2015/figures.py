"""Figs. 5 to 11 of Chmielewski et al. (2015) as the source drew them, for 10 and for 100 s, and the speeds compared."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mechsym.cases import load
from mechsym.papers.chmielewski2015 import rows as study
from mechsym.style import BLUE, GREEN, GREY, INK, RED, legend, panels

_SLOW = 14.0  # from then on a turn is too short to be seen among 100 s [s]
_FIGURES = (
    ("6", "x0", "piston displacement [m]"),
    ("7", "v", "piston velocity [m/s]"),
    ("8", "a", "piston acceleration [m/s$^2$]"),
    ("9", "phi0", "crank angle [rad]"),
    ("10", "phi0d", "crank speed [rad/s]"),
    ("11", "epsilon", "crank acceleration [rad/s$^2$]"),
)


def figures() -> dict[str, Figure]:
    """All figures with curves, `figure_5` to `figure_11`, and `speeds`: the printed claim beside all runs."""
    result = study.run(study.EXACT, study.FINEST[1], study.FINEST[0])
    columns = {**result.columns, **study.piston()}
    drive = load(study.CASE).need("drive")
    figure, axes = panels(10, 3, 1, 2)
    for axis, end in zip(axes, (10.0, 100.0), strict=True):
        axis.step([0, drive.time, end], [0, drive.torque, drive.torque], where="post", color=BLUE)
        axis.set(xlabel="t [s]", xlim=(0, end))
    axes[0].set_ylabel("torque [N m]")
    axes[0].set_title("Fig. 5", loc="left")
    drawn = {"figure_5": figure}
    drawn |= {f"figure_{n}": _both_spans(n, result.t, columns[key], label) for n, key, label in _FIGURES}
    return drawn | {"speeds": _speeds()}


def _both_spans(number: str, t: np.ndarray, y: np.ndarray, label: str) -> Figure:
    figure, axes = panels(10, 3, 1, 2)
    for axis, end in zip(axes, (10.0, 100.0), strict=True):
        inside = t <= end
        if end > 10 and number != "9":
            axis.plot(t[t <= _SLOW], y[t <= _SLOW], color=BLUE, linewidth=0.8)
            _band(axis, t[t >= _SLOW], y[t >= _SLOW])
        else:
            axis.plot(t[inside], y[inside], color=BLUE, linewidth=0.8)
        axis.set(xlabel="t [s]", xlim=(0, end))
    axes[0].set_ylabel(label)
    axes[0].set_title(f"Fig. {number}", loc="left")
    return figure


def _band(axis: Axes, t: np.ndarray, y: np.ndarray, width: float = 0.25, **options: Any) -> None:
    """Thousands of turns as the band that they fill: extremes within short stretches."""
    edges = np.searchsorted(t, np.arange(t[0], t[-1], width))
    low, high = np.minimum.reduceat(y, edges), np.maximum.reduceat(y, edges)
    axis.fill_between(t[edges], low, high, step="post", **{"color": BLUE, "linewidth": 0.8, **options})


def _speeds() -> Figure:
    figure, (axis,) = panels(8, 4.6)
    exact, printed = (study.run(model, study.FINEST[1], study.FINEST[0]) for model in (study.EXACT, study.PRINTED))
    t, y = study.fixed(study.PRINTED, study.TELLING_STEP, 4)
    for times, speed, color, label in (
        (exact.t, exact.columns["phi0d"], BLUE, "exact equations, converged"),
        (printed.t, printed.columns["phi0d"], GREEN, "(6) with (11) as printed, converged"),
        (t, y[:, 2], RED, f"as printed, Runge-Kutta 4 with a study.fixed step of {1e3 * study.TELLING_STEP:g} ms"),
    ):
        axis.plot(*_mean(times, speed), color=color, linewidth=1.4, label=label)
    _band(axis, t, y[:, 2], color=RED, alpha=0.15, linewidth=0, label="the same, momentary speed")
    end = float(exact.t[-1])
    axis.plot([1, end], [0, study.rigid_speed_with_piston(end)], "--", color=GREY, label="rigid shaft, hand check")
    axis.plot([study.CLAIMED_TIME, end], [study.CLAIMED_SPEED] * 2, color=INK, linewidth=2, label="printed: 194 rad/s")
    axis.set(xlabel="t [s]", ylabel="mean crank speed over a second [rad/s]", xlim=(0, end))
    legend(axis)
    return figure


def _mean(t: np.ndarray, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    angle = np.concatenate([[0.0], np.cumsum(np.diff(t) * (speed[1:] + speed[:-1]) / 2)])
    middle = np.arange(0.5, t[-1] - 0.5, 0.25)
    return middle, np.interp(middle + 0.5, t, angle) - np.interp(middle - 0.5, t, angle)
