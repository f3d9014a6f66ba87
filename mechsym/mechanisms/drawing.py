"""Every mechanism drawn to scale at any angle: shapes as data, one function that paints them, one that moves them.

A drawing is a tuple of lines and circles with a role (crank, rod, piston, ...), in metres, x along the (first) cylinder
towards the head, y across, the shaft at the origin. Whoever shows them, matplotlib or a page in the browser, decides on
colours; the roles say what belongs together.
"""

import math
from collections.abc import Callable, Iterable
from typing import Any

from mechsym.errors import BadInput
from mechsym.mechanisms.drawn_parts import (
    Circle,
    Line,
    Point,
    Shapes,
    box,
    cylinder,
    extent_of,
    piston,
    slider_crank,
    turned,
)
from mechsym.mechanisms.train_drawing import crank_train

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
    if mechanism not in _DRAWINGS:
        raise BadInput(f"mechanism {mechanism!r} has no drawing; there are {', '.join(sorted(_DRAWINGS))}")
    return tuple(_DRAWINGS[mechanism](parameters, angle, bore))


def extent(mechanism: str, parameters: Any) -> tuple[float, float, float, float]:
    """Box that holds the mechanism at every angle.

    Returns
    -------
    x_min, x_max, y_min, y_max : float
        Edges [m]
    """
    return extent_of(lambda angle: shapes(mechanism, parameters, angle))


def _crosshead(p: Any, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    r, l = p.r1 + p.r2, p.l1 + p.l2
    pin = (r * math.cos(angle), r * math.sin(angle))
    end = (pin[0] + math.sqrt(l**2 - pin[1] ** 2), 0.0)
    length, stroke = 1.5 * 2 * r, 2 * r  # of the piston rod: drawn, not a parameter
    top = (end[0] + length, 0.0)
    yield Circle(role="crank", centre=(0.0, 0.0), radius=0.16 * r)
    yield Line(role="crank", points=((0.0, 0.0), pin))
    yield Line(role="rod", points=(pin, end))
    yield Line(role="frame", points=((l - r - 0.3 * r, -0.28 * r), (l + r + 0.3 * r, -0.28 * r)))
    yield Line(role="frame", points=((l - r - 0.3 * r, 0.28 * r), (l + r + 0.3 * r, 0.28 * r)))
    yield box("piston", (end[0] - 0.22 * r, -0.24 * r), (0.44 * r, 0.48 * r))
    yield Line(role="piston", points=(end, top))
    yield Circle(role="joint", centre=pin, radius=0.09 * r)
    yield Circle(role="joint", centre=end, radius=0.09 * r)
    yield from piston(top, stroke, bore)
    yield from cylinder(0.0, l - r + length, stroke, bore)


def _crank_throw(p: Any, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    return slider_crank(p.r, p.l1 + p.l2, p.offset, angle, bore)


def _crankshaft_flywheel(p: Any, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    yield Circle(role="flywheel", centre=(0.0, 0.0), radius=1.5 * p.r)
    yield from slider_crank(p.r, p.l, 0.0, angle, bore)


def _hypocycloid(p: Any, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    e, c, s = p.e, math.cos(angle), math.sin(angle)
    centre, pin, length = (e * c, e * s), (2 * e * c, 0.0), 5 * e
    yield Circle(role="frame", centre=(0.0, 0.0), radius=2 * e)
    yield Circle(role="planet", centre=centre, radius=e)
    yield Line(role="crank", points=((0.0, 0.0), centre))
    yield Circle(role="crank", centre=(0.0, 0.0), radius=0.14 * e)
    yield Line(role="planet", points=(centre, pin))
    yield Line(role="rod", points=(pin, (pin[0] + length, 0.0)))
    yield Circle(role="joint", centre=centre, radius=0.1 * e)
    yield Circle(role="joint", centre=pin, radius=0.1 * e)
    yield from piston((pin[0] + length, 0.0), 4 * e, bore)
    yield from cylinder(0.0, length - 2 * e, 4 * e, bore)


def _rodless(p: Any, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    r, c, s = p.r, math.cos(angle), math.sin(angle)
    middle, a, b = (r * c, r * s), (2 * r * c, 0.0), (0.0, 2 * r * s)
    reach = 6 * r  # of the sliders' rods: drawn, not a parameter
    for sign in (-1, 1):
        for along, at in ((0.0 if sign > 0 else math.pi, a[0]), (sign * math.pi / 2, b[1])):
            yield from turned(cylinder(0.0, reach - 2 * r, 4 * r, bore), along)
            yield from turned(piston((reach + sign * at, 0.0), 4 * r, bore), along)
    yield Line(role="rod", points=((a[0] - reach, 0.0), (a[0] + reach, 0.0)))
    yield Line(role="rod", points=((0.0, b[1] - reach), (0.0, b[1] + reach)))
    yield Line(role="planet", points=(a, b))
    yield Line(role="crank", points=((0.0, 0.0), middle))
    yield Circle(role="crank", centre=(0.0, 0.0), radius=0.14 * r)
    for point in (middle, a, b):
        yield Circle(role="joint", centre=point, radius=0.1 * r)


_DRAWINGS: dict[str, Callable[[Any, float, float | None], Iterable[Line | Circle]]] = {
    "crosshead": _crosshead,
    "crank_throw": _crank_throw,
    "crank_train": crank_train,
    "crankshaft_flywheel": _crankshaft_flywheel,
    "crankshaft_flywheel_printed": _crankshaft_flywheel,
    "hypocycloid": _hypocycloid,
    "rodless": _rodless,
    "rodless_constraints": _rodless,
}
