"""Every mechanism drawn to scale at any angle: shapes as data, one function that paints them, one that moves them.

A drawing is a tuple of lines and circles with a role (crank, rod, piston, ...), in metres, x along the (first) cylinder
towards the head, y across, the shaft at the origin. Whoever shows them, matplotlib or a page in the browser, decides on
colours; the roles say what belongs together.
"""

import math
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.crank_train.parameters import each, local_shift
from mechsym.quantities import record

Point = tuple[float, float]


@record
class Line:
    """A line through points, closed when it ends where it starts."""

    role: str
    points: tuple[Point, ...]  #: Corners [m]


@record
class Circle:
    """A circle."""

    role: str
    centre: Point  #: Middle [m]
    radius: float  #: Radius [m]


Shapes = tuple[Line | Circle, ...]


def shapes(mechanism: str, parameters: Any, angle: float) -> Shapes:
    """A mechanism at a crank angle.

    Parameters
    ----------
    angle : float
        Crank angle of every coordinate that is one [rad]
    """
    if mechanism not in _DRAWINGS:
        raise BadInput(f"mechanism {mechanism!r} has no drawing; there are {', '.join(sorted(_DRAWINGS))}")
    return tuple(_DRAWINGS[mechanism](parameters, angle))


def extent(mechanism: str, parameters: Any) -> tuple[float, float, float, float]:
    """Box that holds the mechanism at every angle.

    Returns
    -------
    x_min, x_max, y_min, y_max : float
        Edges [m]
    """
    return extent_of(lambda angle: shapes(mechanism, parameters, angle))


def extent_of(drawn: Callable[[float], Shapes]) -> tuple[float, float, float, float]:
    """Box that holds a drawing at every crank angle [rad]: x_min, x_max, y_min, y_max [m]."""
    corners: list[Point] = []
    for angle in np.linspace(0, 2 * math.pi, 24, endpoint=False):
        for shape in drawn(float(angle)):
            if isinstance(shape, Line):
                corners += shape.points
            else:
                (x, y), r = shape.centre, shape.radius
                corners += [(x - r, y - r), (x + r, y + r)]
    xs, ys = zip(*corners, strict=True)
    return min(xs), max(xs), min(ys), max(ys)


def _slider_crank(r: float, l: float, offset: float, stroke: float, angle: float) -> Iterable[Line | Circle]:
    pin = (r * math.cos(angle), r * math.sin(angle))
    end = (pin[0] + math.sqrt(l**2 - (pin[1] - offset) ** 2), offset)
    yield Circle(role="crank", centre=(0.0, 0.0), radius=0.16 * r)
    yield Line(role="crank", points=((0.0, 0.0), pin))
    yield Line(role="rod", points=(pin, end))
    yield Circle(role="joint", centre=pin, radius=0.09 * r)
    yield from _piston(end, stroke)
    yield from _cylinder(offset, math.sqrt((r + l) ** 2 - offset**2) - stroke, stroke)
    yield Circle(role="joint", centre=end, radius=0.09 * r)


def _piston(end: Point, stroke: float) -> Iterable[Line | Circle]:
    yield _box("piston", (end[0] - 0.12 * stroke, end[1] - 0.36 * stroke), (0.36 * stroke, 0.72 * stroke))


def _cylinder(y: float, bottom: float, stroke: float) -> Iterable[Line | Circle]:
    # walls and head around the piston's path; the gap at the head is drawn, not to scale
    left, right, half = bottom - 0.12 * stroke, bottom + 1.32 * stroke, 0.38 * stroke
    yield Line(role="frame", points=((left, y - half), (right, y - half), (right, y + half), (left, y + half)))


def _box(role: str, corner: Point, size: Point) -> Line:
    (x, y), (a, b) = corner, size
    return Line(role=role, points=((x, y), (x + a, y), (x + a, y + b), (x, y + b), (x, y)))


def _crosshead(p: Any, angle: float) -> Iterable[Line | Circle]:
    r, l = p.r1 + p.r2, p.l1 + p.l2
    pin = (r * math.cos(angle), r * math.sin(angle))
    end = (pin[0] + math.sqrt(l**2 - pin[1] ** 2), 0.0)
    length, stroke = 1.5 * 2 * r, 2 * r  # of the piston rod: drawn, not a parameter
    piston = (end[0] + length, 0.0)
    yield Circle(role="crank", centre=(0.0, 0.0), radius=0.16 * r)
    yield Line(role="crank", points=((0.0, 0.0), pin))
    yield Line(role="rod", points=(pin, end))
    yield Line(role="frame", points=((l - r - 0.3 * r, -0.28 * r), (l + r + 0.3 * r, -0.28 * r)))
    yield Line(role="frame", points=((l - r - 0.3 * r, 0.28 * r), (l + r + 0.3 * r, 0.28 * r)))
    yield _box("piston", (end[0] - 0.22 * r, -0.24 * r), (0.44 * r, 0.48 * r))
    yield Line(role="piston", points=(end, piston))
    yield Circle(role="joint", centre=pin, radius=0.09 * r)
    yield Circle(role="joint", centre=end, radius=0.09 * r)
    yield from _piston(piston, stroke)
    yield from _cylinder(0.0, l - r + length, stroke)


def _crank_throw(p: Any, angle: float) -> Iterable[Line | Circle]:
    return _slider_crank(p.r, p.l1 + p.l2, p.offset, 2 * p.r, angle)


def _crankshaft_flywheel(p: Any, angle: float) -> Iterable[Line | Circle]:
    yield Circle(role="flywheel", centre=(0.0, 0.0), radius=1.5 * p.r)
    yield from _slider_crank(p.r, p.l, 0.0, 2 * p.r, angle)


def _hypocycloid(p: Any, angle: float) -> Iterable[Line | Circle]:
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
    yield from _piston((pin[0] + length, 0.0), 4 * e)
    yield from _cylinder(0.0, length - 2 * e, 4 * e)


def _rodless(p: Any, angle: float) -> Iterable[Line | Circle]:
    r, c, s = p.r, math.cos(angle), math.sin(angle)
    middle, a, b = (r * c, r * s), (2 * r * c, 0.0), (0.0, 2 * r * s)
    reach = 6 * r  # of the sliders' rods: drawn, not a parameter
    for sign in (-1, 1):
        yield from _turned(_cylinder(0.0, reach - 2 * r, 4 * r), 0.0 if sign > 0 else math.pi)
        yield from _turned(_cylinder(0.0, reach - 2 * r, 4 * r), sign * math.pi / 2)
        yield from _turned(_piston((reach + sign * a[0], 0.0), 4 * r), 0.0 if sign > 0 else math.pi)
        yield from _turned(_piston((reach + sign * b[1], 0.0), 4 * r), sign * math.pi / 2)
    yield Line(role="rod", points=((a[0] - reach, 0.0), (a[0] + reach, 0.0)))
    yield Line(role="rod", points=((0.0, b[1] - reach), (0.0, b[1] + reach)))
    yield Line(role="planet", points=(a, b))
    yield Line(role="crank", points=((0.0, 0.0), middle))
    yield Circle(role="crank", centre=(0.0, 0.0), radius=0.14 * r)
    for point in (middle, a, b):
        yield Circle(role="joint", centre=point, radius=0.1 * r)


def _crank_train(p: Any, angle: float) -> Iterable[Line | Circle]:
    for i, k in enumerate(p.throw):
        r, l1, l2, offset, bank = (each(p, n)[i] for n in ("r", "l1", "l2", "offset", "bank"))
        sense, origin = each(p, "sense")[k - 1], (each(p, "axis_x")[k - 1], each(p, "axis_y")[k - 1])
        own = _slider_crank(r, l1 + l2, offset, 2 * r, angle + local_shift(p)[i])
        yield from _turned(own, bank, sense, origin)


def _turned(
    found: Iterable[Line | Circle], angle: float, sense: float = 1.0, origin: Point = (0.0, 0.0)
) -> Iterable[Line | Circle]:
    c, s = math.cos(angle), math.sin(angle)

    def place(point: Point) -> Point:
        x, y = point[0], sense * point[1]
        return origin[0] + c * x - s * y, origin[1] + s * x + c * y

    for shape in found:
        if isinstance(shape, Line):
            yield Line(role=shape.role, points=tuple(place(point) for point in shape.points))
        else:
            yield Circle(role=shape.role, centre=place(shape.centre), radius=shape.radius)


_DRAWINGS: dict[str, Callable[[Any, float], Iterable[Line | Circle]]] = {
    "crosshead": _crosshead,
    "crank_throw": _crank_throw,
    "crank_train": _crank_train,
    "crankshaft_flywheel": _crankshaft_flywheel,
    "crankshaft_flywheel_printed": _crankshaft_flywheel,
    "hypocycloid": _hypocycloid,
    "rodless": _rodless,
    "rodless_constraints": _rodless,
}
