"""Every mechanism drawn to scale at any angle: shapes as data, one function that paints them, one that moves them.

A drawing is a tuple of lines and circles with a role (crank, rod, piston, ...), in metres, x along the (first) cylinder
towards the head, y across, the shaft at the origin. Whoever shows them, matplotlib or a page in the browser, decides on
colours; the roles say what belongs together.
"""

from typing import Any

from mechsym.errors import BadInput
from mechsym.mechanisms.drawn_parts import Circle, Line, Point, Shapes, extent_of
from mechsym.mechanisms.own import packaged
from mechsym.mechanisms.traits import traits_of

__all__ = ["Circle", "Line", "Point", "Shapes", "extent", "extent_of", "shapes"]


def shapes(mechanism: str, parameters: Any, angle: float, bore: float | None = None) -> Shapes:
    """A mechanism at a crank angle.

    Parameters
    ----------
    angle : float
        Crank angle of every coordinate that is one [rad]
    bore : float, optional
        Diameter of the cylinders; else they are drawn in proportion to the stroke [m]
    """
    known = traits_of(mechanism)
    if known is None or known.drawing is None:
        drawn = (n for n in packaged() if (t := traits_of(n)) is not None and t.drawing is not None)
        raise BadInput(f"mechanism {mechanism!r} has no drawing; there are {', '.join(drawn)}")
    return tuple(known.drawing(parameters, angle, bore))


def extent(mechanism: str, parameters: Any) -> tuple[float, float, float, float]:
    """Box that holds the mechanism at every angle.

    Returns
    -------
    x_min, x_max, y_min, y_max : float
        Edges [m]
    """
    return extent_of(lambda angle: shapes(mechanism, parameters, angle))
