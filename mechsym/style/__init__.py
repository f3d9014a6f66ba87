"""What pictures of every room share: one palette for light and dark, panels, legends, units on axes, SVG.

panels     colours on light and on dark paper; figures with quiet panels, legends above them, axes in the units that
           were chosen, labels that keep clear of each other, equal curves named once, significant digits
picture    a figure as SVG: text as text, title and description, ids of its own, dark where the reader wants it
shapes     how shapes of drawings are painted, and which of them a mechanism may name

matplotlib is imported inside functions, so that whoever only needs a colour or a number does not load it.
"""

from mechsym.style.panels import (
    BLUE,
    DARK,
    GREEN,
    GREY,
    GRID,
    INK,
    ORANGE,
    PAPER,
    PINK,
    QUIET,
    RED,
    SERIES,
    TEAL,
    VIOLET,
    angle_axis,
    axis_unit,
    bare,
    clear_places,
    distinct,
    envelope,
    events,
    grid,
    heading,
    legend,
    over_angle,
    panels,
    same_path,
    significant,
    spread,
    to_scale,
    unit_words,
)
from mechsym.style.picture import svg, write_picture

__all__ = [
    "BLUE",
    "DARK",
    "GREEN",
    "GREY",
    "GRID",
    "INK",
    "ORANGE",
    "PAPER",
    "PINK",
    "QUIET",
    "RED",
    "SERIES",
    "TEAL",
    "VIOLET",
    "angle_axis",
    "axis_unit",
    "bare",
    "clear_places",
    "distinct",
    "envelope",
    "events",
    "grid",
    "heading",
    "legend",
    "over_angle",
    "panels",
    "same_path",
    "significant",
    "spread",
    "svg",
    "to_scale",
    "unit_words",
    "write_picture",
]
