"""One picture of a run: every route of every problem as a dot on a logarithmic axis of time."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from benchmarks.measure import Row

# panel: (title, problem, case, unit, factor)
_PANELS = (
    ("P1 derive 12 throws", "P1 derive + callable", "N = 12", "ms", 1e3),
    ("P2 batch, 1 coordinate", "P2 batch", "1-DOF", "ns a point", 1e9),
    ("P2 batch of 256 points", "P2 batch", "1-DOF, 256", "ns a point", 1e9),
    ("P2 batch, 7 coordinates", "P2 batch", "N = 6", "ns a point", 1e9),
    ("P2 one call from Python", "P2 scalar", "1-DOF", "ns", 1e9),
    ("P3 99 s at 1e-8", "P3 single run", "1e-08", "ms", 1e3),
    ("P3 sixteen runs, each", "P3 ensemble of 16", "1e-08", "ms", 1e3),
    ("P4 optimal torque", "P4 repeated solve", "200 nodes", "ms", 1e3),
    ("P5 cycle at 800 speeds", "P5 cycle map", "800 speeds", "ms", 1e3),
)
_OURS, _HAND, _OTHERS = "#1a6fb0", "#222222", "#b0b0b0"


def chart(path: Path, rows: Sequence[Row], where: str = "") -> Path:
    """Draw the chart.

    Parameters
    ----------
    path : Path
        SVG file
    rows : sequence of Row
        Measured routes
    where : str
        Machine and date, written below

    Returns
    -------
    path : Path
        The same
    """
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    panels = [p for p in _PANELS if any((r.problem, r.case) == p[1:3] for r in rows)]
    with plt.rc_context({"svg.hashsalt": "mechsym", "font.size": 8}):
        figure, axes = plt.subplots(-(-len(panels) // 2), 2, figsize=(9, 1.45 * len(panels) / 2 + 1), squeeze=False)
        for axis in axes.ravel()[len(panels) :]:
            axis.set_visible(False)
        for axis, (title, problem, case, unit, factor) in zip(axes.ravel(), panels, strict=False):
            found = [r for r in rows if (r.problem, r.case) == (problem, case)]
            _panel(axis, f"{title} [{unit}]", {r.route: r.median_s * factor for r in found})
        figure.text(0.01, 0.004, where, fontsize=6)
        figure.tight_layout(rect=(0, 0.015, 1, 1))
        path.parent.mkdir(parents=True, exist_ok=True)
        figure.savefig(path, metadata={"Date": None})
        plt.close(figure)
    return path


def _panel(axis: Any, title: str, times: dict[str, float]) -> None:
    """Dots from slow to fast; their times stand beside them."""
    names = sorted(times, key=lambda name: -times[name])
    low, high = min(times.values()), max(times.values())
    axis.set_xscale("log")
    axis.set_xlim(low / 1.5, max(high * (high / low) ** 0.3, low * 4))
    for i, name in enumerate(names):
        axis.plot([low / 1.5, times[name]], [i, i], color=_colour(name), linewidth=1.2)
        axis.plot(times[name], i, "o", color=_colour(name), markersize=5)
        axis.annotate(_number(times[name]), (times[name], i), (6, 0), textcoords="offset points", va="center")
    axis.set_yticks(range(len(names)), names)
    axis.set_ylim(-0.6, len(names) - 0.4)
    axis.xaxis.set_major_formatter("")
    axis.xaxis.set_minor_formatter("")
    axis.set_title(title, loc="left", fontsize=9)
    axis.spines[["top", "right", "bottom"]].set_visible(False)
    axis.tick_params(axis="x", which="both", length=0)


def _number(value: float) -> str:
    return f"{value:,.0f}" if value >= 100 else f"{value:.3g}"


def _colour(route: str) -> str:
    if route.startswith("mechsym"):
        return _OURS
    return _HAND if route.startswith("hand") else _OTHERS
