"""The picture of a sweep: lines over one axis, maps over two, histograms and scatter for samples; gaps are marked."""

import functools
import textwrap
from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import XAxis, YAxis
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator

from mechsym.cases import schema
from mechsym.cases.keys import keys
from mechsym.cycle.columns import WORDS
from mechsym.quantities.display import figure, key_words, without_unit
from mechsym.style import BLUE, GREY, INK, PAPER, RED, SERIES, axis_unit, bare
from mechsym.style.panels import NOTHING
from mechsym.sweep import Axis, Sweep, failures, main_results
from mechsym.sweep.data import indices

_MOST = 6  # panels
_LONGEST = 44  # letters that stand at an axis
_WIDE = 32  # letters of a line beside an axis
_FEW = 4  # values of an axis that are drawn as lines of their own
_COUNTS = 12  # steps of a count that is drawn with whole numbers
_TRUTHS = ("feasible", "met", "kept", "holds", "converged", "proven")  # 1 is yes
_DRAWN = 1000  # values of an axis of a map that a picture shows
_CLOUD = 8  # samples below which points are no scatter
_ROUND_OFF = 1e-9  # results are sized in SI, none that matters is as small


def _shown(result: Sweep) -> dict[str, np.ndarray]:
    """The results that a picture has panels for; none for one point or two, or gaps only."""
    # main results, without those that stay the same or are round-off; all when none is left
    results = main_results(result)
    sizes = {n: (np.nanmax(v) - np.nanmin(v), np.nanmax(np.abs(v))) for n, v in results.items()}
    lively = {n: results[n] for n, (change, size) in sizes.items() if change > 1e-9 * size and size > _ROUND_OFF}
    chosen = results if result.show or not lively else lively
    return dict(list(chosen.items())[:_MOST]) if len(result.points) > 2 else {}


def picture(result: Sweep) -> Figure | None:
    """The main results of a sweep, see `mechsym.sweep.main_results`; None where there is nothing to draw."""
    shown = _shown(result)
    if not shown:
        return None
    if result.sobol and indices(result):
        return _indices(result)
    if "sample" in result.dims:
        return _samples(result, shown)
    long = sorted(range(len(result.axes)), key=lambda i: -len(result.axes[i].values))[:2]
    # words are better told apart by colours than by places
    first, *second = sorted(long, key=lambda i: len(result.axes[i].values) > 1 and _words(result, [i]))
    if second and len(result.axes[second[0]].values) > 1:
        wide = len(result.axes[second[0]].values) > _FEW and not _words(result, long)
        # the axis that was named first goes to the right
        pair = (min(long), max(long)) if wide else (first, second[0])
        return (_maps if wide else _lines)(result, shown, pair)
    return _lines(result, shown, (first, None))


def caption(result: Sweep) -> str:
    """What the picture of a sweep shows: between which values each result lies, or on what it hangs most."""
    if result.sobol and (rows := indices(result)):
        names = list(dict.fromkeys(row.result for row in rows))[:_MOST]
        most = [max((row for row in rows if row.result == name), key=lambda row: row.total) for name in names]
        parts = [f"{key_words(row.result, WORDS)} hangs most on {said(row.key)}, "
                f"{figure(row.total, 3)} of its variance with the others" for row in most]  # fmt: skip
        return "; ".join(parts) + "; whiskers are intervals of 95 %."
    parts = []
    for name, column in _shown(result).items():
        values, label = _scaled(name, column[np.isfinite(column)], result.units[name])
        words, _, unit = label.removesuffix("]").partition(" [")
        ends = " to ".join(dict.fromkeys(figure(float(end(values)), 4) for end in (np.min, np.max)))
        ends += f" {unit}".removesuffix(" -")
        truth = f": yes at {int(values.sum())} of {values.size}"
        parts.append(words + (truth if _truth(name, column) else f" {ends}"))
    return "; ".join(parts) + "." if parts else ""


def _words(result: Sweep, axes: list[int]) -> bool:
    return any(isinstance(result.axes[i].values[0], str) for i in axes)


def _panels(result: Sweep, shown: Mapping[str, object], rows: int = 1) -> tuple[Figure, np.ndarray]:
    columns = len(shown) if rows > 1 else {4: 2}.get(len(shown), min(len(shown), 3))
    down = rows if rows > 1 else -(-len(shown) // columns)
    figure = Figure(figsize=(3.5 * columns if columns > 1 else 7.0, 3.0 * down + 0.4), layout="constrained")
    axes = np.atleast_1d(figure.subplots(down, columns)).ravel()
    for axis in axes:
        bare(axis)
    for axis in axes[len(shown) * rows :]:
        axis.set_visible(False)
    return figure, axes


@functools.cache
def said(key: str) -> str:
    """A key of a case in the words of its field; the symbol of a letter whose meaning hangs on the mechanism."""
    section, _, field = key.partition(".")
    if section not in schema.sections():
        return key_words(key, WORDS)
    abouts = {row["about"] for row in keys(section) if row["key"] == field}
    about = abouts.pop().partition(";")[0].replace("`", "") if len(abouts) == 1 else ""
    about = about[:1].lower() + about[1:] if about[1:2].islower() else about
    return about if 0 < len(about) <= _LONGEST else field if section in schema.LETTERS else key_words(key, WORDS)


def _label(name: str, unit: str) -> str:
    return said(name) + (f" [{unit}]" if unit else "")


def _places(axis: XAxis | YAxis, name: str, values: np.ndarray) -> None:
    """Whole numbers at an axis of counts, `no` and `yes` at one of truth."""
    there = values[np.isfinite(values)]
    if _truth(name, values):
        axis.set_ticks([0, 1], ["no", "yes"])
    elif np.all(there == np.round(there)) and there.size and float(np.ptp(there)) < _COUNTS:
        axis.set_major_locator(MaxNLocator(integer=True, min_n_ticks=1))


def _truth(name: str, values: np.ndarray) -> bool:
    return name.rpartition(".")[2] in _TRUTHS and set(values[np.isfinite(values)].tolist()) <= {0.0, 1.0}


def _scaled(name: str, values: np.ndarray, unit: str) -> tuple[np.ndarray, str]:
    """Values in the unit that suits them or was chosen, and what is written at their axis."""
    if unit in ("", "-"):
        return np.where(np.abs(values) < _ROUND_OFF, 0.0, values), _label(name, unit)
    factor, word = axis_unit(unit, values)
    stem = name if name in WORDS else without_unit(name, unit)  # speed_rpm in rad/s is no speed_rpm
    return values * factor, _label(stem, word)


def _slice(result: Sweep, free: list[int], column: np.ndarray) -> np.ndarray:
    """A result over the free axes, the others at their middle value."""
    shape = tuple(len(a.values) for a in result.axes)
    at = tuple(slice(None) if i in free else n // 2 for i, n in enumerate(shape))
    values = column.reshape(shape)[at]
    return values if len(free) == 1 or free[0] < free[1] else values.T


def _title(result: Sweep, free: list[int]) -> str:
    fixed = [a for i, a in enumerate(result.axes) if i not in free and len(a.values) > 1]
    held = ", ".join(_value(a, a.values[len(a.values) // 2]) for a in fixed)
    gaps, whole = len(failures(result)), f"{result.analysis} of {result.case}" + (f" at {held}" if held else "")
    return whole + (f"; {gaps} of {len(result.points)} points failed" if gaps else "")


def _value(axis: Axis, value: float | str) -> str:
    name = said(axis.key)
    if isinstance(value, str):
        return f"{name} = {value}"
    factor, unit = axis_unit(axis.unit, value) if axis.unit not in ("", "-") else (1.0, "")
    return f"{said(without_unit(axis.key, axis.unit))} = {value * factor:.4g} {unit}".rstrip()


def _ticks(axis: Axes, along: Axis) -> tuple[np.ndarray, str]:
    """Places of the values along an axis, and what is written there."""
    if not isinstance(along.values[0], str):
        return _scaled(along.key, np.array(along.values), along.unit)
    places = np.arange(len(along.values))
    axis.set_xticks(places, [str(v) for v in along.values])
    return places, said(along.key)


def _lines(result: Sweep, shown: Mapping[str, np.ndarray], over: tuple[int, int | None]) -> Figure:
    along, other = result.axes[over[0]], None if over[1] is None else result.axes[over[1]]
    free = [i for i in over if i is not None]
    figure, axes = _panels(result, shown)
    figure.suptitle(_title(result, free), fontsize=10)
    for axis, (name, column) in zip(axes, shown.items(), strict=False):
        drawn, axis_label = _scaled(name, column, result.units[name])
        values = np.atleast_2d(_slice(result, free, drawn).T)
        x, across = _ticks(axis, along)
        for k, y in enumerate(values):
            label = None if other is None else _value(other, other.values[k])
            # nothing lies between two words, and many dots hide the line
            few = len(x) < 3 or isinstance(along.values[0], str)  # two points make no curve
            style = "o" if few else "o-" if len(x) <= 25 else "-"
            (drawn_line,) = axis.plot(x, y, style, color=SERIES[k % len(SERIES)], markersize=3, label=label)
            alike = [i for i, other_y in enumerate(values) if np.allclose(y, other_y, rtol=1e-3, equal_nan=True)]
            if len(alike) > 1 and not few:  # curves on each other take turns, so that each is seen
                drawn_line.set_linestyle((4 * alike.index(k), (4, 4 * (len(alike) - 1))))
        gaps = np.isnan(values).any(axis=0)
        if gaps.any():
            foot = axis.get_xaxis_transform()
            axis.plot(x[gaps], np.zeros(gaps.sum()), "x", color=GREY, transform=foot, clip_on=False)
        if _changes_sign(values):
            axis.axhline(0, color=INK, linewidth=0.6)
        axis.set_xlabel(across)
        axis.set_ylabel(textwrap.fill(axis_label, _WIDE))
        _places(axis.yaxis, name, column)
    if other is not None:
        handles, labels = axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=4, fontsize=8, frameon=False)
    return figure


def _maps(result: Sweep, shown: Mapping[str, np.ndarray], over: tuple[int, int]) -> Figure:
    right, up = result.axes[over[0]], result.axes[over[1]]
    figure, axes = _panels(result, shown)
    figure.suptitle(_title(result, list(over)), fontsize=10)
    (x, across), (y, upwards) = (_scaled(a.key, np.array(a.values), a.unit) for a in (right, up))
    few = tuple(slice(None, None, -(-len(along) // _DRAWN)) for along in (y, x))
    y, x = y[few[0]], x[few[1]]
    for axis, (name, column) in zip(axes, shown.items(), strict=False):
        drawn, label = _scaled(name, column, result.units[name])
        values = _slice(result, list(over), drawn).T[few]
        axis.set_facecolor(NOTHING)
        axis.grid(False)
        if np.isfinite(values).any():
            truth = _truth(name, column)
            levels = [-0.5, 0.5, 1.5] if truth else 12
            filled = axis.contourf(x, y, np.ma.masked_invalid(values), levels=levels, cmap="viridis")
            bar = figure.colorbar(filled, ax=axis)
            if truth:
                bar.set_ticks([0, 1], labels=["no", "yes"])
        if _changes_sign(values):
            # where a margin ends
            axis.contour(x, y, np.ma.masked_invalid(values), levels=[0], colors=PAPER, linestyles="--")
        gaps = np.argwhere(np.isnan(values))
        if gaps.size:
            axis.plot(x[gaps[:, 1]], y[gaps[:, 0]], "x", color=RED, markersize=4, clip_on=False)
        axis.set_title(label, fontsize=9)
        axis.set_xlabel(across)
        axis.set_ylabel(upwards)
    return figure


def _changes_sign(values: np.ndarray) -> bool:
    return bool(np.any(values < 0) and np.any(values > 0))


def _indices(result: Sweep) -> Figure:
    """Shares of the variance by itself and with the others, each with its 95 % interval."""
    rows = indices(result)
    names = list(dict.fromkeys(row.result for row in rows))[:_MOST]
    figure, axes = _panels(result, dict.fromkeys(names))
    figure.suptitle(_title(result, list(range(len(result.axes)))), fontsize=10)
    for axis, name in zip(axes, names, strict=False):
        own = [row for row in rows if row.result == name]
        place = np.arange(len(own))[::-1]
        for beside, color, words in ((0.2, BLUE, "by itself"), (-0.2, SERIES[1], "with the others")):
            kind = "first" if beside > 0 else "total"
            mid, low, high = (np.array([getattr(row, kind + end) for row in own]) for end in ("", "_low", "_high"))
            whiskers = [np.maximum(mid - low, 0.0), np.maximum(high - mid, 0.0)]
            axis.barh(place + beside, mid, 0.36, xerr=whiskers, color=color, label=words, error_kw={"ecolor": INK})
        axis.set_yticks(place, [said(row.key) for row in own])
        axis.set_xlabel("share of the variance [-]")
        axis.set_title(key_words(name, WORDS), fontsize=9)
    figure.legend(*axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=2, fontsize=8, frameon=False)
    return figure


def _samples(result: Sweep, shown: Mapping[str, np.ndarray]) -> Figure:
    shown = dict(list(shown.items())[:4])
    figure, axes = _panels(result, shown, rows=2)
    figure.suptitle(_title(result, list(range(len(result.axes)))), fontsize=10)
    inputs = np.array(result.points, dtype=float).T
    for k, (name, column) in enumerate(shown.items()):
        there = np.isfinite(column)
        y, label = _scaled(name, column[there], result.units[name])
        upper, lower = axes[k], axes[len(shown) + k]
        upper.hist(y, bins=min(40, max(5, round(np.sqrt(y.size)))), color=BLUE)
        upper.axvline(y.mean(), color=RED, linewidth=1)
        upper.set_title(f"{y.mean():.5g} ± {y.std():.2g}", fontsize=9)
        upper.set_xlabel(label)
        upper.set_ylabel("samples [-]")
        _places(upper.xaxis, name, column)
        i = int(np.argmax([_rank_correlation(values[there], y) for values in inputs]))
        x, across = _scaled(result.axes[i].key, inputs[i][there], result.axes[i].unit)
        if y.size < _CLOUD:
            lower.set_visible(False)
            continue
        lower.plot(x, y, ".", color=BLUE, markersize=3)
        lower.set_xlabel(across)
        lower.set_ylabel(label)
    return figure


def _rank_correlation(x: np.ndarray, y: np.ndarray) -> float:
    """Magnitude of the correlation of ranks: which input a result follows most."""
    if np.ptp(x) == 0 or np.ptp(y) == 0:
        return 0.0
    ranks = np.array([np.argsort(np.argsort(values)) for values in (x, y)])
    return abs(float(np.corrcoef(ranks)[0, 1]))
