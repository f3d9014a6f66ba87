"""What the figures of all sources share. matplotlib is imported in figure modules only."""

from typing import Any

from matplotlib.figure import Figure

from mechsym import style


def panels(
    rows: int = 1, columns: int = 1, size: tuple[float, float] = (7.2, 4.2), **options: Any
) -> tuple[Figure, list[Any]]:
    """A figure with panels in rows and columns.

    Parameters
    ----------
    size : tuple of float
        Width and height [inch]
    """
    figure, axes = style.panels(*size, rows, columns, **options)
    return figure, list(axes)


def turn_axis(axis: Any, degrees: float = 360.0, label: str = "crank angle [deg]") -> None:
    """Crank angle along an axis, in eighths.

    Parameters
    ----------
    degrees : float
        Last angle [deg]
    """
    style.angle_axis(axis, degrees)
    axis.set_xlabel(label)
