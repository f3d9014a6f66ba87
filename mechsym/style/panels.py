"""One palette for light and dark, contrast 4.5; figures with quiet panels, legends above them, chosen units.

Labels keep clear of each other, and curves that are equal are named once.
"""

import textwrap
from collections.abc import Callable, Mapping, Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from mechsym.quantities.display import chosen, unit_for
from mechsym.quantities.units import Array, Pure, Radian, scale

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


SMALL = 8  # points of text beside the axes' own
_LETTER, _HANDLE = 0.62, 3.8  # widths in a legend of a letter, and of what stands before a name, of that
_FLATTEST = 0.4  # height of a panel to scale by its width, or the other way round


def panels(
    width: Annotated[float, "inch"],
    height: Annotated[float, "inch"],
    rows: int = 1,
    columns: int = 1,
    title: str = "",
    **options: Any,
) -> "tuple[Figure, Any]":
    """A figure with panels in rows and columns, as one flat array.

    title: what it shows, for those who do not see it. Returns figure, axes: Figure, ndarray of Axes, row by row; the
    figure is never shown.
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    figure.set_label(title)
    axes = np.atleast_1d(figure.subplots(rows, columns, **options)).ravel()
    for axis in axes:
        bare(axis)
    return figure, axes


def grid(axis: "Axes") -> None:
    """A quiet grid behind the curves."""
    axis.grid(True, color=GRID, linewidth=0.7)
    axis.set_axisbelow(True)


def bare(axis: "Axes") -> None:
    """A quiet grid, small letters, no frame at the top and the right."""
    grid(axis)
    axis.tick_params(labelsize=SMALL)
    axis.ticklabel_format(style="plain", useOffset=False)  # no factor beside the axis, which says its unit
    axis.xaxis.label.set_fontsize(SMALL + 1)
    axis.yaxis.label.set_fontsize(SMALL + 1)
    axis.spines[["top", "right"]].set_visible(False)


def to_scale(figure: "Figure", axes: "Sequence[Axes]") -> None:
    """Panels to one scale across and up, filled by what they show, in a figure no higher than they need."""
    ratios = []
    for axis in axes:
        limits = np.array([axis.get_xlim(), axis.get_ylim()])
        short = np.maximum(_FLATTEST * np.ptp(limits, axis=1).max() - np.ptp(limits, axis=1), 0.0)
        (left, right), (low, high) = limits + 0.5 * short[:, None] * np.array([-1.0, 1.0])
        axis.set(xlim=(left, right), ylim=(low, high), aspect="equal")
        ratios.append((high - low) / (right - left))
    figure.set_figheight(1.3 + min(1.2, max(ratios)) * (figure.get_figwidth() / len(axes) - 0.8))


def heading(axis: "Axes", text: str) -> None:
    """A small heading over a panel, at its left; a legend stands above it."""
    # where it stands is said, or matplotlib would lift it into the legend
    axis.set_title(text, fontsize=SMALL + 1, loc="left", color=INK, y=1.0)


def legend(axis: "Axes", width: Annotated[float, "inch"] = 0.0) -> None:
    """A legend above a panel, outside of it, in as many columns as there is room for; none without names.

    width: of the panel; else it is estimated from the figure's.
    """
    from matplotlib.transforms import ScaledTranslation

    handles, names = axis.get_legend_handles_labels()
    if not handles:
        return
    spec = axis.get_subplotspec()
    whole = axis.figure.bbox.width / axis.figure.dpi
    wide = width or (whole / (spec.get_gridspec().ncols if spec is not None else 1) - 0.8)
    most = int((72 * wide / SMALL - _HANDLE) / _LETTER)
    names = [textwrap.fill(name, most) for name in names]
    columns = _columns([max(map(len, name.split("\n"))) for name in names], 72 * wide)
    lifted = 16 / 72 if axis.get_title("left") or axis.get_title() else 0.0
    place = axis.transAxes + ScaledTranslation(0, lifted, axis.figure.dpi_scale_trans)
    axis.legend(
        handles, names, loc="lower left", bbox_to_anchor=(0.0, 1.0), bbox_transform=place, ncols=columns,
        fontsize=SMALL, frameon=False, borderaxespad=0.2, borderpad=0.2, columnspacing=1.2, handlelength=1.8,
    )  # fmt: skip


def _columns(letters: list[int], wide: float) -> int:
    """Most columns of a legend that fit into a width [pt]; it is filled column by column."""
    for columns in range(len(letters), 1, -1):
        rows, longer = divmod(len(letters), columns)  # the first columns have one row more
        starts = [k * rows + min(k, longer) for k in range(columns + 1)]
        widest = [max(letters[a:b]) for a, b in pairwise(starts)]
        if sum(_LETTER * SMALL * n + _HANDLE * SMALL for n in widest) <= wide:
            return columns
    return 1


def unit_words(unit: str) -> str:
    """A unit as people write it.

    >>> unit_words("kN*m"), unit_words("m/s^2")
    ('kN m', 'm/s²')
    """
    return unit.replace("*", " ").replace("^2", "²").replace("^3", "³").replace("degC", "°C")


def axis_unit(unit: str, *values: object) -> tuple[Pure, str]:
    """The unit of an axis: the user's, or what suits the size of the values.

    values: array_like, what will be drawn, in SI [unit]. Returns factor: to be multiplied with; unit: as it stands on
    the axis.

    >>> axis_unit("N*m", np.array([12e3])), axis_unit("Pa", 5.0)
    ((0.001, 'kN m'), (1e-06, 'MPa'))
    """
    finite = [np.abs(v)[np.isfinite(v)] for v in (np.asarray(value, dtype=float) for value in values)]
    size = max((float(v.max(initial=0.0)) for v in finite), default=0.0)
    suits = "L" if unit == "m^3" and size >= 0.01 and not chosen() else unit_for(unit, size)
    return (1.0 if suits == unit else float(f"{scale(unit) / scale(suits):.15g}")), unit_words(suits)


def angle_axis(
    axis: "Axes", degrees: Annotated[float, "deg"], start: Annotated[float, "deg"] = 0.0, steps: int = 8
) -> None:
    """An angle in degrees along an axis, in eighths or fewer parts. degrees, start: last and first angle."""
    axis.set_xlim(start, degrees)
    axis.set_xticks(np.arange(start, degrees + 1, (degrees - start) / steps))


def over_angle(axis: "Axes", period: Radian, name: str = "crank angle", start: Radian = 0.0, steps: int = 8) -> Pure:
    """An angle along an axis with its name, in eighths, in the unit that was chosen.

    period, start: last and first angle. Returns factor: from radians to the axis.
    """
    factor, unit = axis_unit("rad", period)
    axis.set_xlim(start * factor, period * factor)
    if unit == "deg":
        angle_axis(axis, period * factor, start * factor, steps)
    axis.set_xlabel(f"{name} [{unit}]")
    return factor


MOST_SWINGS = 160  # of a curve that is still seen as a line


def spread(wanted: Sequence[Pure], gap: Pure, low: Pure = -np.inf, high: Pure = np.inf) -> Pure[Array]:
    """Places near the wanted ones that keep a distance, in any one unit.

    wanted: where the labels belong. gap: distance that neighbours keep; less where there is no room. low, high: where
    the room ends. Returns places: in the order of `wanted`, with the least sum of squares to it where the room has no
    end.

    >>> spread([1.0, 1.1, 5.0], 1.0).tolist()
    [0.55, 1.55, 5.0]
    """
    order = np.argsort(wanted, kind="stable")
    gap = min(gap, (high - low) / max(len(order) - 1, 1))
    steps = gap * np.arange(len(order))
    # without the gaps the places only have to rise: pool neighbours that fall
    pools: list[list[float]] = []
    for value in np.asarray(wanted, dtype=float)[order] - steps:
        pools.append([float(value)])
        while len(pools) > 1 and np.mean(pools[-2]) >= np.mean(pools[-1]):
            last = pools.pop()
            pools[-1] += last
    risen = np.concatenate([np.full(len(pool), np.mean(pool)) for pool in pools]) if pools else np.empty(0)
    places = np.empty(len(order))
    places[order] = np.clip(risen, low, high - (steps[-1] if len(steps) else 0.0)) + steps
    return places


def events(axis: "Axes", marks: Mapping[str, Pure], width: Annotated[float, "inch"]) -> None:
    """Upright names above a panel, each with a line at its place.

    marks: name to place, in the unit of the panel's axis; width: about how wide the panel is.
    """
    low, high = axis.get_xlim()
    gap = 0.15 * (high - low) / width  # of letters of 8 points
    places = spread(list(marks.values()), gap, low + gap / 2, high - gap / 2)
    above = axis.get_xaxis_transform()
    for (name, at), place in zip(marks.items(), places, strict=True):
        axis.axvline(at, color=GREY, linewidth=0.7, linestyle=":")
        axis.plot([at, place], [1.0, 1.06], transform=above, color=GREY, linewidth=0.7, clip_on=False)
        axis.text(place, 1.08, name, rotation=90, ha="center", va="bottom", fontsize=8, color=QUIET, transform=above)
    axis.set_xlim(low, high)


def envelope(axis: "Axes", t: Pure[Array], y: Pure[Array], color: str, label: str | None = None) -> None:
    """A curve over time in a panel's units; one that swings too often to be seen as the band that it fills."""
    swings = np.abs(np.diff(y)).sum() / (np.ptp(y) or 1.0)  # through all of its range, so that ripples do not count
    if swings <= MOST_SWINGS:
        axis.plot(t, y, color=color, linewidth=0.9, label=label)
        return
    # as many stretches as can be told apart, and a swing in each of them
    edges = np.unique(np.searchsorted(t, np.linspace(t[0], t[-1], min(300, int(swings) // 4), endpoint=False)))
    low, high = (f.reduceat(y, edges) for f in (np.minimum, np.maximum))
    axis.fill_between(t[edges], low, high, color=color, alpha=0.55, linewidth=0.6, label=label)


def same_curve(one: np.ndarray, other: np.ndarray, size: float) -> bool:
    """Whether two curves over the same values are equal but for round-off, beside the largest of all, `size` [unit]."""
    return bool(one.shape == other.shape and np.abs(other - one).max(initial=0.0) <= 1e-6 * size)


def same_path(one: np.ndarray, other: np.ndarray, size: float) -> bool:
    """Whether two closed paths lie on each other, wherever each begins.

    one, other: values across, then values up [unit], shape (2 n,); size: largest value of all paths [unit].

    >>> t = np.linspace(0, 2 * np.pi, 100)
    >>> circles = [np.concatenate([r * np.cos(t + s), r * np.sin(t + s)]) for r, s in ((1, 0), (1, 2), (1.1, 0))]
    >>> same_path(circles[0], circles[1], 1.1), same_path(circles[0], circles[2], 1.1)
    (True, False)
    """
    first, second = (np.reshape(path, (2, -1)).T for path in (one, other))
    return max(_away(first, second), _away(second, first)) <= 2e-3 * size


def _away(points: np.ndarray, path: np.ndarray) -> float:
    """How far some of the points lie from the closed polygon of a path at most [unit]."""
    start, step = path, np.roll(path, -1, axis=0) - path
    seen = points[:: max(1, len(points) // 90), None]
    long = np.maximum((step**2).sum(axis=1), 1e-300)
    along = np.clip(((seen - start) * step).sum(axis=2) / long, 0.0, 1.0)
    return float(np.linalg.norm(seen - start - along[..., None] * step, axis=2).min(axis=1).max())


def distinct(
    curves: Mapping[str, np.ndarray],
    joint: str = " = ",
    same: Callable[[np.ndarray, np.ndarray, float], bool] = same_curve,
) -> dict[str, np.ndarray]:
    """Curves by name, those that lie on each other once, under all their names.

    curves: of one unit [unit]; same: tells of two curves, and of the largest value of all, whether they lie on each
    other.

    >>> list(distinct({"N1": np.ones(3), "N2": np.ones(3), "N3": np.zeros(3)}))
    ['N1 = N2', 'N3']
    """
    size = max((float(np.abs(values).max(initial=0.0)) for values in curves.values()), default=0.0)
    apart: list[tuple[list[str], np.ndarray]] = []
    for name, values in curves.items():
        for names, other in apart:
            if same(other, values, size):
                names.append(name)
                break
        else:
            apart.append(([name], values))
    return {joint.join(names): values for names, values in apart}


def clear_places(points: Sequence[tuple[Pure, Pure]], size: tuple[Pure, Pure]) -> list[int]:
    """Which of many labels to write so that none covers another: the first always, each later one where it is free.

    points: where the labels begin, in any one unit; size: how wide and high a label is, in that unit.

    >>> clear_places([(0.0, 0.0), (0.5, 0.0), (2.0, 0.0)], (1.0, 1.0))
    [0, 2]
    """
    written: list[int] = []
    for i, (x, y) in enumerate(points):
        if all(abs(x - points[k][0]) >= size[0] or abs(y - points[k][1]) >= size[1] for k in written):
            written.append(i)
    return written


def significant(value: Pure | None, digits: int = 4) -> str:
    """A number with a few significant digits, or a dash.

    Returns text: without an exponent between 1e-3 and 1e6.

    >>> significant(123456.7), significant(1.5e-7), significant(None)
    ('123500', '1.500e-07', '–')
    """
    if value is None:
        return "–"
    if value != 0 and not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e" in text else text


PAPER, INK = "#ffffff", "#1b2a41"
BLUE, RED, GREEN, ORANGE, VIOLET = "#1f5fa8", "#b5342b", "#2a744a", "#866a00", "#7a4fa3"
TEAL, PINK, GREY, QUIET = "#0f727d", "#ab2f7a", "#667080", "#5b6675"  # grey and quiet: lines and text that explain
GRID = "#e3e6ea"
SERIES = (BLUE, RED, GREEN, ORANGE, VIOLET, TEAL, PINK, INK)  # curves of one kind, in this order

# what parts are filled with
PISTON, CYLINDER, CRANK, GEAR, BEARING = "#a9c7e3", "#cdd3dc", "#d3c0a0", "#e2c46c", "#b2c3a6"
CARRIER, SHAFT, WHEEL, GAS, ROLLER, NOTHING = "#e6dff0", "#bfb0d6", "#f1f3f6", "#d5e6f7", "#f3dcb8", "#eef0f3"
_FILLED = {
    PISTON: "#35597c", CYLINDER: "#46505d", CRANK: "#66563a", GEAR: "#7a6420", BEARING: "#4c5d41", CARRIER: "#4a4260",
    SHAFT: "#5d4f78", WHEEL: "#222a33", GAS: "#233c56", ROLLER: "#6b5020", NOTHING: "#1d242c",
}  # fmt: skip
#: What a colour becomes on dark paper
DARK = {
    PAPER: "#14191f", INK: "#e6eaf0", BLUE: "#7db4f0", RED: "#f2877d", GREEN: "#6cc590", ORANGE: "#e3b341",
    VIOLET: "#c3a0e8", TEAL: "#5cc6d0", PINK: "#ee8fc4", GREY: "#9aa5b3", QUIET: "#a9b3c0", GRID: "#2b333d", **_FILLED,
}  # fmt: skip
