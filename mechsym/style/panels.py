"""Figures with quiet panels, legends above them, axes in the units that were chosen."""

import math
from typing import TYPE_CHECKING, Any

import numpy as np

from mechsym.quantities.display import chosen, unit_for
from mechsym.quantities.units import scale
from mechsym.style.palette import GRID, INK

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SMALL = 8  # points of text beside the axes' own


def panels(
    width: float, height: float, rows: int = 1, columns: int = 1, title: str = "", **options: Any
) -> "tuple[Figure, Any]":
    """A figure with panels in rows and columns, as one flat array.

    Parameters
    ----------
    width, height : float
        Of the figure [inch]
    title : str
        What it shows, for those who do not see it

    Returns
    -------
    figure, axes : Figure, ndarray of Axes
        Row by row; the figure is never shown
    """
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    figure.set_label(title)
    axes = np.atleast_1d(figure.subplots(rows, columns, **options)).ravel()
    for axis in axes:
        bare(axis)
    return figure, axes


def grid(axis: Any) -> None:
    """A quiet grid behind the curves."""
    axis.grid(True, color=GRID, linewidth=0.7)
    axis.set_axisbelow(True)


def bare(axis: Any) -> None:
    """A quiet grid, small letters, no frame at the top and the right."""
    grid(axis)
    axis.tick_params(labelsize=SMALL)
    axis.ticklabel_format(style="plain", useOffset=False)  # no factor beside the axis, which says its unit
    axis.xaxis.label.set_size(SMALL + 1)
    axis.yaxis.label.set_size(SMALL + 1)
    axis.spines[["top", "right"]].set_visible(False)


def heading(axis: Any, text: str) -> None:
    """A small heading over a panel, at its left; a legend stands above it."""
    # where it stands is said, or matplotlib would lift it into the legend
    axis.set_title(text, fontsize=SMALL + 1, loc="left", color=INK, y=1.0)


def legend(axis: Any, width: float = 0.0) -> None:
    """A legend above a panel, outside of it, in as many columns as there is room for; none without names.

    Parameters
    ----------
    width : float
        Of the panel; else it is estimated from the figure's [inch]
    """
    from matplotlib.transforms import ScaledTranslation

    handles, names = axis.get_legend_handles_labels()
    if not handles:
        return
    spec = axis.get_subplotspec()
    whole = axis.figure.get_figwidth()
    wide = width or (whole / (spec.get_gridspec().ncols if spec is not None else 1) - 0.8)
    columns = _columns([len(name) for name in names], 72 * wide)
    lifted = 16 / 72 if axis.get_title("left") or axis.get_title() else 0.0
    place = axis.transAxes + ScaledTranslation(0, lifted, axis.figure.dpi_scale_trans)
    axis.legend(
        handles, names, loc="lower left", bbox_to_anchor=(0.0, 1.0), bbox_transform=place, ncols=columns,
        fontsize=SMALL, frameon=False, borderaxespad=0.2, borderpad=0.2, columnspacing=1.2, handlelength=1.8,
    )  # fmt: skip


def _columns(letters: list[int], wide: float) -> int:
    """Most columns of a legend that fit into a width [pt]; it is filled column by column."""
    for columns in range(len(letters), 1, -1):
        rows = math.ceil(len(letters) / columns)
        widest = [max(letters[k : k + rows]) for k in range(0, len(letters), rows)]
        if sum(0.62 * SMALL * n + 3.8 * SMALL for n in widest) <= wide:
            return columns
    return 1


def unit_words(unit: str) -> str:
    """A unit as people write it.

    Examples
    --------
    >>> unit_words("kN*m"), unit_words("m/s^2")
    ('kN m', 'm/s²')
    """
    return unit.replace("*", " ").replace("^2", "²").replace("^3", "³").replace("degC", "°C")


def axis_unit(unit: str, *values: Any) -> tuple[float, str]:
    """The unit of an axis: the user's, or what suits the size of the values.

    Parameters
    ----------
    values : array_like
        What will be drawn, in SI [unit]

    Returns
    -------
    factor : float
        To be multiplied with [-]
    unit : str
        As it stands on the axis

    Examples
    --------
    >>> axis_unit("N*m", np.array([12e3])), axis_unit("Pa", 5.0)
    ((0.001, 'kN m'), (1e-06, 'MPa'))
    """
    finite = [np.abs(v)[np.isfinite(v)] for v in (np.asarray(value, dtype=float) for value in values)]
    size = max((float(v.max(initial=0.0)) for v in finite), default=0.0)
    found = "L" if unit == "m^3" and size >= 0.01 and not chosen() else unit_for(unit, size)
    return (1.0 if found == unit else float(f"{scale(unit) / scale(found):.15g}")), unit_words(found)


def angle_axis(axis: Any, degrees: float, start: float = 0.0, steps: int = 8) -> None:
    """An angle in degrees along an axis, in eighths; in fewer parts where it is narrow.

    Parameters
    ----------
    degrees, start : float
        Last and first angle [deg]
    """
    axis.set_xlim(start, degrees)
    axis.set_xticks(np.arange(start, degrees + 1, (degrees - start) / steps))


def over_angle(axis: Any, period: float, name: str = "crank angle", start: float = 0.0, steps: int = 8) -> float:
    """An angle along an axis with its name, in eighths, in the unit that was chosen.

    Parameters
    ----------
    period, start : float
        Last and first angle [rad]

    Returns
    -------
    factor : float
        From radians to the axis [-]
    """
    factor, unit = axis_unit("rad", period)
    axis.set_xlim(start * factor, period * factor)
    if unit == "deg":
        angle_axis(axis, period * factor, start * factor, steps)
    axis.set_xlabel(f"{name} [{unit}]")
    return factor
