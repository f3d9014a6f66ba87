r"""Bodies as plain numbers, turned or cut from plate: what `step.py` builds, with volumes in closed form.

Turned: a section in (r, z) about an axis.       Plate: the hull of two circles, less holes, over a thickness.

    r ^  +-----+                                      ___-----____
      |  |     +----+                                ( a )       ( b )
      +--+-----+----+--> z along the axis             ---_____----
"""

import math

from mechsym.quantities import record
from mechsym.quantities.units import Metre

Point = tuple[float, float, float]
Circle = tuple[float, float, float]

AXES = {"x": (1.0, 0.0, 0.0), "y": (0.0, 1.0, 0.0), "z": (0.0, 0.0, 1.0)}


@record
class Turned:
    """A solid of revolution."""

    name: str
    profile: tuple[tuple[float, float], ...]  #: corners of its section: radius, distance along the axis [m]
    place: Point = (0.0, 0.0, 0.0)  #: where the distance is 0 [m]
    axis: str = "z"


@record
class Plate:
    """The hull of two circles, extruded along y; circles are (x, z, radius) [m]."""

    name: str
    ends: tuple[Circle, Circle]
    holes: tuple[Circle, ...] = ()
    low: float  #: one face, along y [m]
    high: float  #: the other face, along y [m]


Body = Turned | Plate


def tube(name: str, radii: tuple[Metre, Metre], ends: tuple[Metre, Metre], place: Point, axis: str) -> Turned:
    """A tube, or a rod of inner radius 0. radii: inner and outer. ends: distances of its faces from `place`."""
    (inner, outer), (low, high) = radii, ends
    corners = ((inner, low), (outer, low), (outer, high), (inner, high))
    return Turned(name=name, profile=corners, place=place, axis=axis)


def volume(body: Body) -> float:
    r"""Volume of a body [m^3].

    .. math::
        V = \tfrac{\pi}{3} \left| \sum (r_i^2 + r_i r_{i+1} + r_{i+1}^2)(z_{i+1} - z_i) \right|, \qquad
        A = L (a + b) + a^2 (\tfrac{\pi}{2} + \beta) + b^2 (\tfrac{\pi}{2} - \beta)

    A is the hull of two circles whose centres are d apart, sin beta = (a - b) / d, L^2 = d^2 - (a - b)^2.
    """
    if isinstance(body, Turned):
        around = zip(body.profile, (*body.profile[1:], body.profile[0]), strict=True)
        return abs(math.pi / 3 * sum((r * r + r * s + s * s) * (w - z) for (r, z), (s, w) in around))
    area = hull_area(*body.ends) - sum(math.pi * r * r for _, _, r in body.holes)
    return area * (body.high - body.low)


def hull_area(first: Circle, second: Circle) -> float:
    """Area of the hull of two circles, neither of which holds the other [m^2]."""
    (x, z, a), (u, w, b) = first, second
    d = math.hypot(u - x, w - z)
    beta = math.asin((a - b) / d)
    return math.sqrt(d * d - (a - b) ** 2) * (a + b) + a * a * (math.pi / 2 + beta) + b * b * (math.pi / 2 - beta)


def tangents(first: Circle, second: Circle) -> tuple[tuple[float, float], ...]:
    """Corners of the hull of two circles, where its straight sides begin and end: (x, z), two on each circle [m]."""
    (x, z, a), (u, w, b) = first, second
    d, along = math.hypot(u - x, w - z), math.atan2(w - z, u - x)
    turned = math.acos((a - b) / d)
    return tuple(
        (cx + r * math.cos(along + side * turned), cz + r * math.sin(along + side * turned))
        for cx, cz, r, side in ((x, z, a, 1), (u, w, b, 1), (u, w, b, -1), (x, z, a, -1))
    )
