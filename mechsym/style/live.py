"""Which panels of a figure a page may bring to life, with a cursor that reads values and a zoom.

The points stay where they are, in the paths of the picture; a page needs to know where a panel stands and what its
axes span. A panel with bars, bands, maps or words among its curves stays as it is drawn.
"""

from typing import TYPE_CHECKING

import numpy as np

from mechsym.files import Json

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D

CURVE = "curve-"  # before the number of a curve that a page reads


def number_curves(figure: "Figure") -> None:
    """Give each curve of a live panel the id by which a page knows it, before the figure is drawn."""
    lines = (line for axis in _shown(figure) if _lives(axis) for line in axis.lines if _curve(line))
    for k, line in enumerate(lines):
        line.set_gid(f"{CURVE}{k}")


def live_panels(figure: "Figure") -> Json:
    """The panels of a figure that has been drawn: a live one by its axes and curves, another by its frame.

    Empty where nothing is live, or words and colours go over all panels.
    """
    shown, beside = _shown(figure), any(axis.get_label() == "<colorbar>" for axis in figure.axes)
    if figure.get_suptitle() or figure.legends or beside or not any(map(_lives, shown)):
        return {}
    panels = [_panel(figure, axis) if _lives(axis) else {"crop": _frame(figure, axis)} for axis in shown]
    return {"columns": len({round(axis.get_position().x0, 2) for axis in shown}), "panels": panels}


def _shown(figure: "Figure") -> "list[Axes]":
    return [axis for axis in figure.axes if axis.get_visible()]


def _lives(axis: "Axes") -> bool:
    """Whether all that stands in a panel are curves over a rising value, upright marks with their names above."""
    scales = axis.name == "rectilinear" and axis.get_xscale() == axis.get_yscale() == "linear"
    others = [*axis.patches, *axis.collections, *axis.images, *axis.tables]
    words = [text for text in axis.texts if text.get_rotation() != 90]
    curves = [line for line in axis.lines if _curve(line)]
    long = any(len(_points(line)[0]) > 2 for line in curves)
    return bool(scales and not others and not words and long and all(map(_rises, curves)))


def _points(line: "Line2D") -> tuple[np.ndarray, np.ndarray]:
    return np.asarray(line.get_xdata(), dtype=float), np.asarray(line.get_ydata(), dtype=float)


def _curve(line: "Line2D") -> bool:
    """Whether a line is a curve or level, no mark at a place or the lead to its name."""
    x, _ = _points(line)
    return bool(line.get_clip_on() and len(x) > 1 and x[0] != x[-1])


def _mark(line: "Line2D") -> bool:
    x, _ = _points(line)
    return bool(line.get_clip_on() and len(x) == 2 and x[0] == x[1])


def _rises(line: "Line2D") -> bool:
    x, y = _points(line)
    drawn = line.get_linestyle() != "None" and line.get_marker() in ("None", "", None)
    return bool(drawn and np.isfinite(y).all() and (np.diff(x) >= 0).all())


def _panel(figure: "Figure", axis: "Axes") -> Json:
    (wide, high), place = 72 * figure.get_size_inches(), axis.get_position()
    corners = place.x0 * wide, (1 - place.y0) * high, place.x1 * wide, (1 - place.y1) * high
    names = {text.get_position()[0]: text.get_text() for text in axis.texts}
    at = sorted(float(_points(line)[0][0]) for line in axis.lines if _mark(line))
    # a name is moved aside where there is no room: names and places have one order
    named = dict(zip(at, [names[k] for k in sorted(names)], strict=True)) if len(at) == len(names) else {}
    up = _words(axis.get_ylabel())
    lines = [line for line in axis.lines if _curve(line)]
    unnamed = [line for line in lines if str(line.get_label()).startswith("_") and len(_points(line)[0]) > 2]
    own = up.partition(" [")[0] if len(unnamed) == 1 else ""  # several are named by their colours, in another panel
    return {
        "curves": [[int(str(line.get_gid())[len(CURVE) :]), _named(line, own)] for line in lines],
        "at": [round(v, 3) for v in corners],
        "x": [float(v) for v in axis.get_xlim()],
        "y": [float(v) for v in axis.get_ylim()],
        "across": _words(axis.get_xlabel() or _below(figure, axis)),
        "up": up,
        "head": _words(axis.get_title("left")),
        "marks": [[x, named.get(x, "")] for x in at],
    }


def _named(line: "Line2D", else_: str) -> str:
    """The name of a curve; none of a level that nobody has named."""
    label = str(line.get_label())
    if not label.startswith("_"):
        return label
    return else_ if len(_points(line)[0]) > 2 else ""


def _below(figure: "Figure", axis: "Axes") -> str:
    """What a panel without a name for its values shares with one below it."""
    column = (other for other in _shown(figure) if other.get_xlim() == axis.get_xlim() and other.get_xlabel())
    return next((str(other.get_xlabel()) for other in column), "")


def _frame(figure: "Figure", axis: "Axes") -> list[float]:
    """The box of a panel with its words in the picture [pt]."""
    box, (wide, high) = axis.get_tightbbox(), figure.get_size_inches()
    assert box is not None
    left, low, right, top = (72 * v / figure.dpi for v in box.extents)
    left, right = max(0.0, left - 3), min(72 * wide, right + 3)
    return [round(v, 1) for v in (left, 72 * high - top - 3, right - left, top - low + 6)]


def _words(text: str) -> str:
    return " ".join(text.split())
