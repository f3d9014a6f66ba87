"""Every mechanism drawn to scale at any angle: shapes as data, one function that paints them, one that moves them.

A drawing is a tuple of lines and circles with a role (crank, rod, piston, ...), in metres, x along the (first) cylinder
towards the head, y across, the shaft at the origin. Whoever shows them, matplotlib or a page in the browser, decides on
colours; the roles say what belongs together.
"""

import cmath
import math
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.mechanisms.drawn_parts import Circle, Line, Point, Shapes, extent_of, seen, sketched
from mechsym.mechanisms.own import is_file, packaged
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import Mechanism, listing
from mechsym.quantities.records import Record
from mechsym.quantities.units import Metre, Radian

if TYPE_CHECKING:
    from mechsym.derive.listing import Listing

_PATHS, _WAY = ("rail", "trace"), 97  # kinds that follow a point, and over how many angles of a turn
_PROFILE, _SMALL = 240, 1e-3  # corners of a cam; an angle of the crank that shows how fast the cam turns [rad]
_PIN = 0.018  # radius of the pin of a link, by the width of all of them

__all__ = ["Circle", "Line", "Point", "Shapes", "declared", "drawn", "extent_of", "shapes"]


def shapes(mechanism: str, parameters: Record, angle: Radian, bore: Metre | None = None) -> Shapes:
    """A mechanism at a crank angle.

    angle: crank angle of every coordinate that is one. bore: diameter of the cylinders; else they are drawn in
    proportion to the stroke.
    """
    painted = (
        tuple(plan_of(mechanism).shapes(parameters, angle, bore))
        if is_file(mechanism) or mechanism in packaged()
        else ()
    )
    if not painted:
        drawn = (name for name in packaged() if listing(plan_of(name).theory).get("sketch"))
        raise BadInput(f"mechanism {mechanism!r} has no drawing; there are {', '.join(drawn)}")
    return painted


def drawn(
    mechanism: str, parameters: Record, functions: Callable[[], Mechanism], bore: Metre | None = None
) -> Callable[[float], Shapes] | None:
    """Crank angle [rad] to shapes: of a mechanism that is drawn by formulas, or by the links of its declaration.

    functions: makes the mechanism with one coordinate, where it takes that; bore: diameter of the cylinders.
    """
    if any(True for _ in plan_of(mechanism).shapes(parameters, 0.0, bore)):
        return lambda angle: shapes(mechanism, parameters, angle, bore)
    return declared(functions(), listing(mechanism))


def declared(
    mechanism: Mechanism, said: "Listing", poses: Callable[[float], Sequence[float]] | None = None
) -> Callable[[float], Shapes] | None:
    """Crank angle [rad] of a mechanism with one coordinate to the shapes of its declaration; None where it has none.

    poses: coordinates over an angle [rad], of which a motion is a turn, for any number of them.
    """
    if said.get("sketch"):
        return lambda angle: sketched(said, mechanism.parameters, angle, None)
    alone = not said.get("shapes")  # a disc on its pin has places and no lines
    if alone or "drawing" not in mechanism.functions or (poses is None and len(mechanism.coordinates) != 1):
        return None
    function, joints = mechanism.functions["drawing"], _joints(said["shapes"])
    shaped = [shape for shape in said["shapes"] if shape["kind"] not in (*_PATHS, "cam")]

    def places(angle: float) -> Mapping[str, float]:
        return dict(
            zip(function.name_out(), map(float, function.call(poses(angle) if poses else [angle])), strict=True)
        )

    def shapes(angle: float) -> Shapes:
        at = places(angle)
        pins = (Circle(role="joint", centre=(at[x], at[y]), radius=radius, space=_inner(at, (x,))) for x, y in joints)
        turning = (profile(at) for profile in profiles)
        return (*still, *turning, *(_shape(shape, at) for shape in shaped), *pins, *axes)

    start = places(0.0)
    if len({(start[x], start[y]) for shape in said["shapes"] for x, y in shape["points"]}) < 2:
        return None  # a point has no extent
    axes = _axes([_inner(start, (x,))[0] for s in said["shapes"] if "space" in s for x, _ in s["points"]])
    followed = any(shape["kind"] in _PATHS for shape in said["shapes"])
    way = [places(angle) for angle in np.linspace(0.0, 2 * math.pi, _WAY)] if followed else []
    still = [line for shape in said["shapes"] if shape["kind"] in _PATHS for line in _path(shape, way)]
    profiles = [_profile(shape, places) for shape in said["shapes"] if shape["kind"] == "cam"]
    radius = _PIN * max((math.dist((start[a], start[b]), (start[c], start[d])) for a, b in joints for c, d in joints),
                        default=0.0)  # fmt: skip
    return shapes


def _path(said: Json, way: Sequence[Mapping[str, float]]) -> list[Line]:
    """What a point runs along: its path, or a rail on both sides of a slide that moves straight."""
    (x, y), *ahead = said["points"]
    points = np.array([(at[x], at[y]) for at in way])
    if not ahead:
        return [Line(role=said["role"], points=tuple(map(tuple, points.tolist())))]
    along = np.array([way[0][n] for n in ahead[0]]) - points[0]
    s = (points - points[0]) @ along / (along @ along)
    ends = points[0] + np.outer([s.min() - 2.5, s.max() + 2.5], along)
    sides = (ends + side * np.array([-along[1], along[0]]) for side in (1, -1))
    return [Line(role=said["role"], points=tuple(map(tuple, side.tolist()))) for side in sides]


def _profile(said: Json, places: Callable[[float], Mapping[str, float]]) -> Callable[[Mapping[str, float]], Line]:
    """A cam by its places: what its contact, or its roller from outside, runs along as it is seen by the cam."""
    (contact, ahead), radius = said["points"], said.get("radius")

    def turned(at: Mapping[str, float]) -> complex:
        along = complex(*(at[name] for name in ahead))
        return along / abs(along)

    step = abs(cmath.phase(turned(places(_SMALL)) / turned(places(0.0)))) / _SMALL  # of the cam, by the crank's
    way = [places(angle) for angle in np.linspace(0.0, 2 * math.pi / step, _PROFILE, endpoint=False)]
    by_cam = np.array([complex(*(at[name] for name in contact)) / turned(at) for at in way])
    if radius is not None:
        slope = np.fft.ifft(1j * np.fft.fftfreq(_PROFILE, 1 / _PROFILE) * np.fft.fft(by_cam))
        inwards = 1j * slope / abs(slope)
        by_cam += way[0][radius] * inwards * np.sign(-(inwards * by_cam.conj()).real.sum())

    def profile(at: Mapping[str, float]) -> Line:
        corners = by_cam * turned(at)
        points = tuple((float(p.real), float(p.imag)) for p in [*corners, corners[0]])
        return Line(role=said["role"], points=points)

    return profile


def _joints(drawn_shapes: Sequence[Json]) -> list[tuple[str, str]]:
    """Where links end, each place once, as the names of its coordinates; none where a declaration draws its own."""
    if any(shape["role"] == "joint" for shape in drawn_shapes):
        return []
    links = (shape for shape in drawn_shapes if shape["kind"] == "line" and shape["role"] in ("crank", "rod"))
    return list(dict.fromkeys((x, y) for link in links for x, y in link["points"]))


def _inner(places: Mapping[str, float], names: Sequence[str]) -> tuple[tuple[float, float, float], ...]:
    """Places in space by the names of their first coordinates as they are seen; none of what is drawn in the plane."""
    inner = [[f"draw_in_{axis}{name.removeprefix('draw_x')}" for axis in "xyz"] for name in names]
    return tuple((places[x], places[y], places[z]) for x, y, z in inner if x in places)


def _axes(places: Sequence[tuple[float, float, float]]) -> Shapes:
    """The axes of the frame, a quarter of the mechanism long."""
    if not places:
        return ()
    length = max(max(p[k] for p in places) - min(p[k] for p in places) for k in range(3)) / 4
    ends = ((length, 0.0, 0.0), (0.0, length, 0.0), (0.0, 0.0, length))
    return tuple(Line(role="frame", points=((0.0, 0.0), seen(e)), space=((0.0, 0.0, 0.0), e)) for e in ends)


def _shape(said: Json, places: Mapping[str, float]) -> Line | Circle:
    points: list[Point] = [(places[x], places[y]) for x, y in said["points"]]
    space = _inner(places, [x for x, _ in said["points"]])
    if said["kind"] == "circle":
        return Circle(role=said["role"], centre=points[0], radius=places[said["radius"]], space=space)
    if said["kind"] == "box":
        (x, y), a, b = points[0], places[said["width"]] / 2, places[said["height"]] / 2
        points = [(x - a, y - b), (x + a, y - b), (x + a, y + b), (x - a, y + b), (x - a, y - b)]
        space = ()
    return Line(role=said["role"], points=tuple(points), space=space)
