"""A figure as SVG: text as text, title and description, ids of its own, dark where the reader wants it."""

import hashlib
import io
import json
import re
from collections.abc import Iterator
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mechsym.files import write_text
from mechsym.style.live import CURVE, live_panels, number_curves
from mechsym.style.panels import DARK, INK

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_RC: dict[Any, Any] = {
    "svg.hashsalt": "mechsym",
    "svg.fonttype": "none",
    # letters as wide as those that the layout was made with, or narrower
    "font.sans-serif": ["DejaVu Sans", "Verdana", "Arial"],
}
_NO_METADATA = dict.fromkeys(("Creator", "Date", "Format", "Type"))
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
    text = text[text.index("<svg") :].replace("#000000", INK)
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
