"""A figure as SVG: text as text, title and description, ids of its own, dark where the reader wants it.

A page may bring some of its panels to life, with a cursor that reads values and a zoom. The points stay where they are,
in the paths of the picture; a page needs to know where a panel stands and what its axes span. A panel with bars, bands,
maps or words among its curves stays as it is drawn.
"""

import hashlib
import io
import json
import re
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym.files import Json, write_text
from mechsym.style.panels import DARK, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.lines import Line2D


_RC: dict[Any, Any] = {
    "svg.hashsalt": "mechsym",
    "svg.fonttype": "none",
    # letters as wide as those that the layout was made with, or narrower
    "font.sans-serif": ["DejaVu Sans", "Verdana", "Arial"],
}
_NO_METADATA = dict.fromkeys(("Creator", "Date", "Format", "Type"))
# places to a hundredth of a point, a tenth of what a drawn line is simplified by
_PATH, _LONG, _GAP = re.compile(r' d="[^"]*"'), re.compile(r"-?\d+\.\d{3,}"), re.compile(r"\s*([A-Za-z])\s+")
_ID, _USED = re.compile(r' id="([^"]+)"'), re.compile(r'(url\(#|href="#)([^")]+)')


def svg(figure: "Figure", name: str = "") -> str:
    """A figure as SVG, which may be a file or stand in a page; equal data give equal text.

    name: what tells this figure from an equal one in the same page.
    """
    import matplotlib
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    buffer = io.StringIO()
    with matplotlib.rc_context(_RC):
        # not savefig, which lays everything out twice
        number_curves(figure)
        FigureCanvasSVG(figure).print_svg(buffer, metadata=_NO_METADATA)
    text = buffer.getvalue()
    text = _PATH.sub(_shorter, text[text.index("<svg") :].replace("#000000", INK))
    own = hashlib.sha256((name + text).encode()).hexdigest()[:8]
    used = {match[2] for match in _USED.finditer(text)}
    known = {old: f' id="{own}-{k}"' for k, old in enumerate(sorted(used))}
    text = _ID.sub(lambda m: known.get(m[1]) or _curve(m[1]), text)
    text = _USED.sub(lambda m: m[1] + known[m[2]][5:-1], text)
    text = re.sub(r'<style type="text/css">.*?</style>', "", text, flags=re.S).replace("<defs>\n  \n </defs>", "")
    head, _, rest = text.partition(">")
    shows, about = escape(title(figure)), escape(_description(figure))
    words = f'<title id="{own}-t">{shows}</title>\n <desc id="{own}-d">{about}</desc>'
    stand = " ".join(f"{x:g}" for x in columns(figure))
    split = f' data-columns="{stand}"' if stand else ""
    panels = live_panels(figure)
    live = f' data-panels="{escape(json.dumps(panels, separators=(",", ":")))}"' if panels else ""
    named = f'{head} class="picture"{split}{live} role="img" aria-labelledby="{own}-t {own}-d">'
    return f"{named}\n {words}\n <style>{_sheet(rest)}</style>{rest}"


def _shorter(path: re.Match[str]) -> str:
    places = _LONG.sub(lambda number: f"{float(number[0]):.2f}".rstrip("0").rstrip("."), path[0][4:-1])
    return ' d="' + _GAP.sub(r"\1", places).strip() + '"'


def _curve(name: str) -> str:
    return f' data-curve="{name.removeprefix(CURVE)}"' if name.startswith(CURVE) else ""


def write_picture(path: Path, figure: "Figure") -> Path:
    """Write a figure as a file of SVG."""
    return write_text(path, svg(figure))


def title(figure: "Figure") -> str:
    """What a figure shows: its label, its heading, or what its first panel draws."""
    first = next(iter(_panels(figure)), None)
    named = figure.get_label() or figure.get_suptitle()
    return " ".join(str(named or ("" if first is None else _said(first)) or "drawing").split())


def _sheet(text: str) -> str:
    """Rules of a figure's own: the joints of its lines, and its colours on dark paper."""
    dark = "".join(
        # no ancestor is named: what a `use` repeats has none of the figure's
        f'[style*="{kind}: {light}"]{{{kind}:{shade} !important}}'
        for light, shade in DARK.items()
        for kind in ("fill", "stroke")
        if f"{kind}: {light}" in text
    )
    rules = f".picture *{{stroke-linejoin:round;stroke-linecap:butt}}.picture text{{fill:{INK}}}"
    return f"{rules}@media screen and (prefers-color-scheme:dark){{.picture text{{fill:{DARK[INK]}}}{dark}}}"


def columns(figure: "Figure") -> list[float]:
    """Where a picture that is laid out may be cut so that its columns of panels stand below each other [pt].

    Empty where it has one column, or words that go over all of them.
    """
    shown = [axis for axis in figure.axes if axis.get_visible()]
    if figure.get_suptitle() or figure.legends or any(axis.get_label() == "<colorbar>" for axis in shown):
        return []
    places = [axis.get_position() for axis in shown]
    starts = sorted({round(place.x0, 2) for place in places})
    wide, cuts = 72 * figure.get_size_inches()[0], []
    for start in starts[1:]:
        ends = [place.x1 for place in places if place.x0 < start - 0.01]
        if max(ends) < start:  # what names the axis stands at the left of its panel
            cuts.append(wide * min(max(ends) + 0.008, (max(ends) + start) / 2))
    return [0.0, *cuts, wide] if cuts else []


def _panels(figure: "Figure") -> Iterator["Axes"]:
    return (axis for axis in figure.axes if axis.get_visible() and axis.get_label() != "<colorbar>")


def _description(figure: "Figure") -> str:
    """Panel by panel what is drawn over what, with the names of the curves."""
    parts = []
    for axis in _panels(figure):
        shown = axis.get_legend()
        names = [text.get_text() for text in shown.get_texts()] if shown is not None else []
        parts.append(_said(axis) + (f": {', '.join(names)}" if names else ""))
    return "; ".join(" ".join(part.split()) for part in parts if part) or title(figure)


def _said(axis: "Axes") -> str:
    across, up = axis.get_xlabel(), axis.get_ylabel()
    drawn = f"{up} over {across}" if across and up else up or across
    heads = [axis.get_title(loc) for loc in ("left", "center", "right")]
    return ", ".join(part for part in (*heads, drawn) if part)


CURVE = "curve-"  # before the number of a curve that a page reads


def number_curves(figure: "Figure") -> None:
    """Give each curve of a live panel the id by which a page knows it, before the figure is drawn."""
    lines = (line for axis in _shown(figure) if _lives(axis) for line in axis.lines if _polyline(line))
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
    curves = [line for line in axis.lines if _polyline(line)]
    long = any(len(_points(line)[0]) > 2 for line in curves)
    return bool(scales and not others and not words and long and all(map(_rises, curves)))


def _points(line: "Line2D") -> tuple[np.ndarray, np.ndarray]:
    return np.asarray(line.get_xdata(), dtype=float), np.asarray(line.get_ydata(), dtype=float)


def _polyline(line: "Line2D") -> bool:
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
    lines = [line for line in axis.lines if _polyline(line)]
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
