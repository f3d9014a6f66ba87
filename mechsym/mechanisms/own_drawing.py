"""Shapes of a mechanism of the user's own: declared points and sizes at a crank angle."""

from collections.abc import Callable, Mapping
from typing import Any

from mechsym.mechanisms.drawing import Circle, Line, Point, Shapes
from mechsym.mechanisms.record import Mechanism


def drawn(mechanism: Mechanism, listing: Mapping[str, Any]) -> Callable[[float], Shapes] | None:
    """Crank angle [rad] of a mechanism with one coordinate to shapes; None where the declaration has none."""
    if "drawing" not in mechanism.functions or len(mechanism.coordinates) != 1:
        return None
    function = mechanism.functions["drawing"]

    def shapes(angle: float) -> Shapes:
        found = dict(zip(function.name_out(), map(float, function.call([angle])), strict=True))
        return tuple(_shape(s, found) for s in listing["shapes"])

    return shapes


def _shape(said: Mapping[str, Any], found: Mapping[str, float]) -> Line | Circle:
    points: list[Point] = [(found[x], found[y]) for x, y in said["points"]]
    if said["kind"] == "circle":
        return Circle(role=said["role"], centre=points[0], radius=found[said["radius"]])
    if said["kind"] == "box":
        (x, y), a, b = points[0], found[said["width"]] / 2, found[said["height"]] / 2
        points = [(x - a, y - b), (x + a, y - b), (x + a, y + b), (x - a, y + b), (x - a, y - b)]
    return Line(role=said["role"], points=tuple(points))
