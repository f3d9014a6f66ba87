"""What is wrong with a figure: texts that meet or leave the paper, as the renderer places them; ids; contrast."""

import functools
import itertools
import re
from collections import Counter

from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.backends.backend_svg import FigureCanvasSVG
from matplotlib.text import Text

_NEAR = 0.5  # points that two boxes may share


def drawn(monkeypatch):
    """All figures that become SVG from here on."""
    found, plain = [], FigureCanvasSVG.print_svg

    @functools.wraps(plain)  # matplotlib asks which options it takes
    def keep(canvas, *args, **options):
        if all(canvas.figure is not figure for figure in found):  # print_svg calls itself
            found.append(canvas.figure)
        return plain(canvas, *args, **options)

    monkeypatch.setattr(FigureCanvasSVG, "print_svg", keep)
    return found


def boxes(figure):
    """Every text that is seen, with its box in points of the figure."""
    FigureCanvasAgg(figure)
    figure.set_dpi(72)
    figure.canvas.draw()
    renderer = figure.canvas.get_renderer()
    ticks = set()
    seen = []
    for axis in figure.axes:
        if not axis.get_visible():
            continue
        for one in axis._axis_map.values():
            ticks |= {id(t) for tick in (*one.majorTicks, *one.minorTicks) for t in (tick.label1, tick.label2)}
            if axis.axison and one.get_visible():
                shown = [t for tick in one._update_ticks() for t in (tick.label1, tick.label2)]
                seen += [t for t in shown if t.get_visible()]
    hidden = {id(t) for axis in figure.axes if not (axis.get_visible() and axis.axison) for t in _of_axis(axis)}
    for text in figure.findobj(Text):
        if id(text) not in ticks and id(text) not in hidden and text.get_visible():
            seen.append(text)
    # the words alone, without the line that leads from them
    return [(t.get_text(), Text.get_window_extent(t, renderer)) for t in seen if t.get_text().strip()]


def _of_axis(axis):
    if not axis.get_visible():
        return axis.findobj(Text)
    return [t for one in axis._axis_map.values() for t in one.findobj(Text)]


def faults(figure):
    """Texts that lie on each other, or leave the paper."""
    found, (width, height) = [], 72 * figure.get_size_inches()
    seen = boxes(figure)
    for text, box in seen:
        if box.x0 < -_NEAR or box.y0 < -_NEAR or box.x1 > width + _NEAR or box.y1 > height + _NEAR:
            found.append(f"{text!r} leaves the paper: {box.x0:.0f}..{box.x1:.0f} of {width:.0f}, "
                         f"{box.y0:.0f}..{box.y1:.0f} of {height:.0f}")  # fmt: skip
    for (one, a), (other, b) in itertools.combinations(seen, 2):
        across, up = min(a.x1, b.x1) - max(a.x0, b.x0), min(a.y1, b.y1) - max(a.y0, b.y0)
        if across > _NEAR and up > _NEAR:
            found.append(f"{one!r} on {other!r}")
    return found


def unitless(figure):
    """Axes that have numbers and no unit; a bar of colours has it in the title of its map."""
    found = []
    for axis in figure.axes:
        if not (axis.get_visible() and axis.axison) or axis.get_label() == "<colorbar>":
            continue
        # around a pole angles carry their degrees, and the label below is the radius's
        for one in (axis.xaxis,) if axis.name == "polar" else (axis.xaxis, axis.yaxis):
            label = one.get_label_text()
            numbers = [t.get_text() for t in one.get_ticklabels() if t.get_visible() and re.search(r"\d", t.get_text())]
            if (label and "[" not in label) or (not label and numbers and numbers != one_words(axis, one)):
                found.append(label or f"no label beside {numbers[:3]}")
    return found


def one_words(axis, one):
    """Names along an axis, which need no unit: ticks that were given as texts."""
    given = type(one.get_major_locator()).__name__ == "FixedLocator"
    words = type(one.get_major_formatter()).__name__ in ("FixedFormatter", "FuncFormatter")
    return [t.get_text() for t in one.get_ticklabels()] if given and words else []


def ids(page):
    """Ids that stand more than once in a page, and references to ids that are not there."""
    given = Counter(re.findall(r'\sid="([^"]+)"', page))
    used = set(re.findall(r'(?:url\(#|href="#)([^")]+)', page))
    return {i for i, n in given.items() if n > 1} | (used - set(given))


def colours(text):
    """Colours of lines, filled areas and letters in a figure."""
    return set(re.findall(r"(?:fill|stroke): (#[0-9a-f]{6})", re.sub(r"<style>.*?</style>", "", text)))


def contrast(one, other):
    """Contrast of two colours `#rrggbb` by WCAG 2.1, from 1, the same, to 21, black on white [-]."""
    dark, light = sorted((_luminance(one), _luminance(other)))
    return (light + 0.05) / (dark + 0.05)


def _luminance(colour):
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.03928 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return sum(k * c for k, c in zip((0.2126, 0.7152, 0.0722), linear, strict=True))
