"""Lines and circles with a role, and the parts that drawings of mechanisms share."""

import dataclasses
import math
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING

import numpy as np

from mechsym.files import Json
from mechsym.mechanisms.amounts import amount
from mechsym.quantities import record
from mechsym.quantities.units import Metre, Radian

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing

Point = tuple[float, float]


@record
class Line:
    """A line through points, closed when it ends where it starts."""

    role: str
    points: tuple[Point, ...]  #: Corners [m]
    space: tuple[tuple[float, float, float], ...] = ()  #: The same in space, where it is drawn there [m]
    of: int = 0  #: Number of its cylinder; 0: of none, or of the only one


@record
class Circle:
    """A circle."""

    role: str
    centre: Point  #: Middle [m]
    radius: float  #: Radius [m]
    space: tuple[tuple[float, float, float], ...] = ()  #: Its middle in space, where it is drawn there [m]
    of: int = 0  #: Number of its cylinder; 0: of none, or of the only one


Shapes = tuple[Line | Circle, ...]


def seen(place: tuple[float, float, float]) -> Point:
    """A place in space [m] as drawings show it: from the front, from the right and from above, 30 degrees each."""
    x, y, z = place
    c, s = math.sqrt(3) / 2, 0.5
    return c * x + s * y, s * (c * y - s * x) + c * z


def extent_of(drawn: Callable[[float], Shapes]) -> tuple[float, float, float, float]:
    """Box that holds a drawing at every crank angle [rad] where it is: x_min, x_max, y_min, y_max [m]."""
    inner = np.array([p for k in range(24) for shape in drawn(math.pi * k / 12) for p in shape.space])
    if len(inner):
        middle = (np.nanmin(inner, axis=0) + np.nanmax(inner, axis=0)) / 2
        far = float(np.nanmax(np.linalg.norm(inner - middle, axis=1)))  # whichever way it is turned
        x, y = seen((float(middle[0]), float(middle[1]), float(middle[2])))
        return x - far, x + far, y - far, y + far
    (left, low), (right, high) = (end(_corners(drawn), axis=0).tolist() for end in (np.nanmin, np.nanmax))
    return left, right, low, high


def turns_round(drawn: Callable[[float], Shapes]) -> bool:
    """Whether a drawing is there at every crank angle."""
    return bool(np.isfinite(_corners(drawn)).all())


def _corners(drawn: Callable[[float], Shapes]) -> np.ndarray:
    corners: list[Point] = []
    for angle in np.linspace(0, 2 * math.pi, 24, endpoint=False):
        for shape in drawn(float(angle)):
            if isinstance(shape, Line):
                corners += shape.points
            else:
                (x, y), r = shape.centre, shape.radius
                corners += [(x - r, y - r), (x + r, y + r)]
    return np.array(corners)


def width_of(bore: float | None, stroke: float) -> float:
    """Width of a piston as it is drawn: the bore, or in proportion to the stroke where none is known [m]."""
    return bore or 0.72 * stroke


def piston(end: Point, stroke: float, bore: float | None) -> Iterable[Line | Circle]:
    """A piston with its pin at a point [m]."""
    width = width_of(bore, stroke)
    yield box("piston", (end[0] - 0.12 * stroke, end[1] - width / 2), (0.36 * stroke, width))


def cylinder(y: float, bottom: float, stroke: float, bore: float | None) -> Iterable[Line | Circle]:
    """Walls and a head around the way of a piston, from its lowest pin on [m]."""
    # walls and head around the piston's path; the gaps at head and walls are drawn, not to scale
    left, right, half = bottom - 0.12 * stroke, bottom + 1.32 * stroke, 0.53 * width_of(bore, stroke)
    yield Line(role="frame", points=((left, y - half), (right, y - half), (right, y + half), (left, y + half)))


def box(role: str, corner: Point, size: Point) -> Line:
    """A closed rectangle from its lower left corner [m]."""
    (x, y), (a, b) = corner, size
    return Line(role=role, points=((x, y), (x + a, y), (x + a, y + b), (x, y + b), (x, y)))


def slider_crank(r: float, l: float, offset: float, angle: float, bore: float | None) -> Iterable[Line | Circle]:
    """Crank, rod, piston and cylinder along x; lengths and bore [m], its own crank angle [rad]."""
    stroke = 2 * r
    pin = (r * math.cos(angle), r * math.sin(angle))
    end = (pin[0] + math.sqrt(l**2 - (pin[1] - offset) ** 2), offset)
    yield Circle(role="crank", centre=(0.0, 0.0), radius=0.16 * r)
    yield Line(role="crank", points=((0.0, 0.0), pin))
    yield Line(role="rod", points=(pin, end))
    yield Circle(role="joint", centre=pin, radius=0.09 * r)
    yield from piston(end, stroke, bore)
    yield from cylinder(offset, math.sqrt((r + l) ** 2 - offset**2) - stroke, stroke, bore)
    yield Circle(role="joint", centre=end, radius=0.09 * r)


def turned(
    shapes: Iterable[Line | Circle], angle: float, sense: float = 1.0, origin: Point = (0.0, 0.0)
) -> Iterable[Line | Circle]:
    """Shapes turned about the shaft by an angle [rad], mirrored for sense -1, and moved to an origin [m]."""
    c, s = math.cos(angle), math.sin(angle)

    def place(point: Point) -> Point:
        x, y = point[0], sense * point[1]
        return origin[0] + c * x - s * y, origin[1] + s * x + c * y

    for shape in shapes:
        if isinstance(shape, Line):
            yield dataclasses.replace(shape, points=tuple(place(point) for point in shape.points))
        else:
            yield dataclasses.replace(shape, centre=place(shape.centre))


def sketched(said: "Listing", parameters: Mapping[str, float], angle: Radian, bore: Metre | None) -> Shapes:
    """The sketch of a declaration, from its listing; nothing where it has none."""
    letters = {**parameters, **dict.fromkeys(said["coordinates"], angle)}
    return tuple(shape for row in said.get("sketch", ()) for shape in _row(row, letters, bore))


def _row(row: Json, letters: Mapping[str, float], bore: float | None) -> Iterable[Line | Circle]:
    points = tuple((float(amount(x, letters)), float(amount(y, letters))) for x, y in row["points"])
    sizes = {name: float(amount(text, letters)) for name, text in row["sizes"].items()}
    turn = float(amount(row["turned"], letters))
    shapes = _KINDS[row["kind"]](row["role"], points, sizes, bore)
    return turned(shapes, turn) if turn else shapes


_KINDS: Mapping[str, Callable[..., Iterable[Line | Circle]]] = {
    "line": lambda role, points, sizes, bore: (Line(role=role, points=points),),
    "circle": lambda role, points, sizes, bore: (Circle(role=role, centre=points[0], radius=sizes["radius"]),),
    "box": lambda role, points, sizes, bore: (box(role, points[0], (sizes["width"], sizes["height"])),),
    "piston": lambda role, points, sizes, bore: piston(points[0], sizes["stroke"], bore),
    "cylinder": lambda role, points, sizes, bore: cylinder(points[0][1], points[0][0], sizes["stroke"], bore),
    "slider_crank": lambda role, points, sizes, bore: slider_crank(
        sizes["r"], sizes["l"], sizes["offset"], sizes["angle"], bore
    ),
}
