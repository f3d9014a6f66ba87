"""What pictures and numbers of every room share: colours, axes, SVG, significant digits.

matplotlib is imported inside functions, so that whoever only needs a colour or a number does not load it.
"""

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym.files import write_text

if TYPE_CHECKING:
    from matplotlib.figure import Figure

BLUE, RED, GREEN, GREY, ORANGE = "#1f5fa8", "#b5342b", "#2f7d4f", "#8a8f98", "#c77c11"
INK, QUIET = "#1b2a41", "#8a94a6"  # text and lines that explain
_GRID = "#e3e6ea"


def panels(width: float, height: float, rows: int = 1, columns: int = 1, **options: Any) -> "tuple[Figure, Any]":
    """A figure with panels in rows and columns, as one flat array.

    Parameters
    ----------
    width, height : float
        Of the figure [inch]

    Returns
    -------
    figure, axes : Figure, ndarray of Axes
        Row by row; the figure is never shown
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    axes = np.atleast_1d(figure.subplots(rows, columns, **options)).ravel()
    for axis in axes:
        bare(axis)
    return figure, axes


def grid(axis: Any) -> None:
    """A quiet grid behind the curves."""
    axis.grid(True, color=_GRID, linewidth=0.7)
    axis.set_axisbelow(True)


def bare(axis: Any) -> None:
    """A quiet grid and no frame at the top and the right."""
    grid(axis)
    axis.spines[["top", "right"]].set_visible(False)


def angle_axis(axis: Any, degrees: float) -> None:
    """Crank angle along an axis, in eighths.

    Parameters
    ----------
    degrees : float
        Last angle [deg]
    """
    axis.set_xlim(0, degrees)
    axis.set_xticks(np.arange(0, degrees + 1, degrees / 8))


def document(figure: "Figure") -> str:
    """A figure as a file of SVG, without a date, so that equal data give equal text."""
    import matplotlib

    buffer = io.StringIO()
    with matplotlib.rc_context({"svg.hashsalt": "mechsym", "svg.fonttype": "path"}):
        figure.savefig(buffer, format="svg", metadata={"Date": None})
    return buffer.getvalue()


def svg(figure: "Figure") -> str:
    """A figure as SVG text that may stand in a page."""
    text = document(figure)
    return text[text.index("<svg") :]


def write_picture(path: Path, figure: "Figure") -> Path:
    """Write a figure as a file of SVG."""
    return write_text(path, document(figure))


def significant(value: float | None, digits: int = 4) -> str:
    """A number with a few significant digits, or a dash.

    Parameters
    ----------
    value : float or None
        Number [-]

    Returns
    -------
    text : str
        Without an exponent between 1e-3 and 1e6

    Examples
    --------
    >>> significant(123456.7), significant(1.5e-7), significant(None)
    ('123500', '1.500e-07', '–')
    """
    if value is None:
        return "–"
    if value != 0 and not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e" in text else text
