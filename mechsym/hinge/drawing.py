"""The elastic hinge drawn to scale: gas or coil between two pistons, rollers, and the tracks that they run on.

   ___ track ___           The tracks stand still, the spring turns with the guide's shaft at the angle
 /     _____     \\         theta = shaft_ratio * phi. The second roller runs on a track of its own, half a turn
(o)-[|gas|]-(o)   |        on, unless one track serves both.
 \\ ____________ /
"""

import math
from collections.abc import Callable, Iterator

import numpy as np

from mechsym.hinge.guide import Guide, closing, path
from mechsym.hinge.rollers import RollerParameters, parallel
from mechsym.mechanisms.drawing import Circle, Line, Point, Shapes
from mechsym.mechanisms.drawn_parts import box, turned
from mechsym.quantities.units import Array, Metre

_CORNERS = 181  # of a track
_COILS = 9


def elastic_hinge(guide: Guide, rollers: RollerParameters) -> Callable[[float], Shapes]:
    """Crank angle [rad] to a drawing of spring, pistons, rollers and tracks."""
    tracks = tuple(_tracks(guide, rollers))
    rho, ratio = path(guide), guide.parameters.shaft_ratio
    period = rho.x[-1] - rho.x[0]

    def shapes(angle: float) -> Shapes:
        theta = ratio * angle
        at = float(rho(rho.x[0] + (theta - rho.x[0]) % period))
        hub = Circle(role="joint", centre=(0.0, 0.0), radius=0.02 * guide.parameters.rho0)
        return (*tracks, *turned(_spring(guide, rollers, at), theta), hub)

    return shapes


def same_after_half_a_turn(points: Metre[Array]) -> bool:
    """Whether a closed curve repeats after half a turn. points: at even angles, both ends, odd n, shape (n, 2)."""
    half = len(points) // 2
    return bool(np.abs(points[half:] + points[: half + 1]).max() < 1e-6 * float(np.abs(points).max()))


def _tracks(guide: Guide, rollers: RollerParameters) -> Iterator[Line]:
    rho, theta = path(guide), np.linspace(0, 2 * math.pi, _CORNERS)
    inside = rho.x[0] + (theta - rho.x[0]) % (rho.x[-1] - rho.x[0])
    points = np.column_stack(parallel(rho(inside), rho.derivative()(inside), theta, rollers.radius))
    points[-1] = points[0]
    if guide.rollers == 2 and not same_after_half_a_turn(points):
        yield Line(role="second_track", points=_corners(-points))
    yield Line(role="track", points=_corners(points))


def _corners(points: np.ndarray) -> tuple[Point, ...]:
    return tuple((float(x), float(y)) for x, y in points)


def _spring(guide: Guide, rollers: RollerParameters, rho: float) -> Iterator[Line | Circle]:
    """Along x: the roller of the first track at +rho, of the second at -rho or a seat on the shaft."""
    z, both = float(closing(guide, np.array(rho))), guide.rollers == 2
    if guide.spring.gas:
        yield from _gas(guide, rollers.radius, rho, z, both)
    else:
        yield from _coil(rho, rollers.radius, both)
    for x in (rho, -rho) if both else (rho,):
        yield Circle(role="roller", centre=(x, 0.0), radius=rollers.radius)
        yield Circle(role="joint", centre=(x, 0.0), radius=0.2 * rollers.radius)


def _gas(guide: Guide, radius: float, rho: float, z: float, both: bool) -> Iterator[Line | Circle]:
    """Column of gas between two pistons in a sleeve; their rods, of constant length, end at the rollers."""
    spring = guide.spring
    length, bore = spring.H - z, math.sqrt(4 * spring.area / math.pi)
    thick = min(0.25 * bore, 0.08 * guide.parameters.rho0)
    # one roller: the seat stands so far behind the shaft that the rod keeps the roller's radius and a piston's length
    seat = -length / 2 if both else min(0.0, guide.parameters.rho0 - spring.H - radius - 2 * thick)
    face = seat + length
    widest = spring.H - guide.rollers * (guide.parameters.rho0 - float(_largest(guide)))
    end = (widest / 2 if both else seat + widest) + thick
    yield box("gas", (seat, -bore / 2), (length, bore))
    yield box("piston", (face, -bore / 2), (thick, bore))
    yield box("piston", (seat - thick, -bore / 2), (thick, bore))
    for y in (-bore / 2, bore / 2):
        yield Line(role="frame", points=((-end if both else seat - thick, 1.04 * y), (end, 1.04 * y)))
    yield Line(role="rod", points=((face + thick, 0.0), (rho, 0.0)))
    if both:
        yield Line(role="rod", points=((seat - thick, 0.0), (-rho, 0.0)))


def _largest(guide: Guide) -> float:
    rho = path(guide)
    return float(np.max(rho(np.linspace(rho.x[0], rho.x[-1], 361))))


def _coil(rho: float, radius: float, both: bool) -> Iterator[Line | Circle]:
    """A coil between two seats that the rollers carry, or between one and the shaft; its width is drawn, not given."""
    right, half = rho - 1.6 * radius, 0.8 * radius
    left = -right if both else 0.0
    places = np.linspace(left, right, 2 * _COILS + 1)
    points = [(float(x), half * (-1.0) ** k) for k, x in enumerate(places[1:-1])]
    yield Line(role="spring", points=((left, 0.0), *points, (right, 0.0)))
    for x in (left, right):
        yield Line(role="piston", points=((x, -1.2 * half), (x, 1.2 * half)))
    yield Line(role="rod", points=((right, 0.0), (rho, 0.0)))
    if both:
        yield Line(role="rod", points=((left, 0.0), (-rho, 0.0)))
