r"""Bodies as plain numbers, turned or cut from plate: what `step.py` builds, with volumes in closed form.

Turned: a section in (r, z) about an axis.       Plate: the hull of two circles, less holes, over a thickness.

    r ^  +-----+                                      ___-----____
      |  |     +----+                                ( a )       ( b )
      +--+-----+----+--> z along the axis             ---_____----

The sized parts of an engine as bodies: piston, cylinder, crank, gears, bearings of one side, at top dead centre. x runs
along the cylinder from the middle of the engine, y along the crank axes, as in the section view. Bearings are rings of
their outer sizes, gears cylinders of their pitch diameter; bolt holes, keys and fillets are not drawn.
"""

import math

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import Metre
from mechsym.sizing.bearing_design import Choice
from mechsym.sizing.hypocycloid.engine import PartForces, Parts, Stock, chosen, shaft_length, spans
from mechsym.sizing.rows import Sizing
from mechsym.sizing.slider_crank import SliderForces, SliderParts
from mechsym.sizing.wants import CrankPart

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


_CAP_WALL = 4e-3  # of the rod's eye around its bearing, as in the section view [m]
_GAP = 2e-3  # between the eye and the webs together, and between a web and its bearing [m]
_SIDES = ((1, ""), (-1, ", far"))


def bodies(sized: Sizing) -> tuple[Body, ...]:
    """The bodies of a sized engine."""
    parts, forces, stock = sized.parts, sized.forces, sized.stock
    if isinstance(parts, Parts) and isinstance(forces, PartForces) and stock is not None:
        return _hypocycloid(parts, forces, stock)
    if isinstance(parts, SliderParts) and isinstance(forces, SliderForces):
        return _slider_crank(parts, forces)
    raise BadInput("--step: only engines that are sized have parts; leave out --as-printed, or give another case")


def _slider_crank(parts: SliderParts, forces: SliderForces) -> tuple[Body, ...]:
    crank, rod, main = parts.crank, parts.rod_bearing, parts.main_bearing
    pin = forces.gap / 2 + parts.piston.height + forces.l
    axis, start = pin + forces.r, crank.pin_length / 2 + crank.web
    width = main.count * main.bearing.width
    solids = [*_common(parts, forces, rod, pin), *_webs(crank, pin, axis, crank.shaft)]
    for side, word in _SIDES:
        shaft = (start, start + 2 * _GAP + width), (start + 2 * _GAP + width, start + 2 * _GAP + width + 0.03)
        place = (axis, 0.0, 0.0)
        solids += [
            _across(f"shaft{word}", (0.0, crank.shaft / 2), shaft[0], place, side),
            _across(f"output shaft{word}", (0.0, crank.output / 2), shaft[1], place, side),
            _bearing(f"main bearing{word}", main, place, start + _GAP, side),
        ]
    return tuple(solids)


def _hypocycloid(parts: Parts, forces: PartForces, stock: Stock) -> tuple[Body, ...]:
    places, z, crank, gears = chosen(parts.bearings, stock), spans(parts, stock), parts.crank, parts.gears
    pin = forces.gap / 2 + parts.piston.head + parts.piston.rod_length + places["rod"].bearing.outside / 2
    planet, axis = (pin + forces.e, 0.0, 0.0), (pin + 2 * forces.e, 0.0, 0.0)
    start, middle = crank.pin_length / 2 + crank.web, 2 * z.inner - crank.pin_length / 2 - crank.web
    end, pitch = start + shaft_length(parts, stock), gears.module * gears.teeth_pinion
    face = (z.gear - gears.face / 2, z.gear + gears.face / 2)
    solids = [*_common(parts, forces, places["rod"], pin), *_webs(crank, pin, planet[0], crank.shaft)]
    for side, word in _SIDES:
        solids += [
            _across(f"shaft{word}", (0.0, crank.shaft / 2), (start, middle), planet, side),
            _across(f"shaft end{word}", (0.0, gears.pinion_bore / 2), (middle, end), planet, side),
            _across(f"pinion{word}", (gears.pinion_bore / 2, pitch / 2), face, planet, side),
            _across(f"ring{word}", (pitch, gears.ring_outside / 2), face, axis, side),
            _centred(f"inner bearing{word}", places["inner"], crank.shaft / 2, planet, z.inner, side),
            _centred(f"outer bearing{word}", places["outer"], gears.pinion_bore / 2, planet, z.outer, side),
            _across(f"output shaft{word}", (0.0, crank.output / 2), (end, z.outboard + 0.02), axis, side),
        ]
    return tuple(solids)


def _common(parts: Parts | SliderParts, forces: PartForces | SliderForces, rod: Choice, pin: float) -> list[Body]:
    """Piston with rod, cylinder, the rod's eye, its bearing and the crankpin."""
    piston, cylinder, crank, bore = parts.piston, parts.cylinder, parts.crank, forces.bore / 2
    start, outside = forces.gap / 2, rod.bearing.outside / 2
    neck, skirt = start + piston.head, start + piston.height
    eye, half, outer = pin - outside - _CAP_WALL, cylinder.length / 2, bore + cylinder.wall
    reach = outer + 2.2e-3 * cylinder.thread_mm  # the flange must hold a washer
    wall = ((bore - piston.barrel, neck), (bore - piston.barrel, skirt)) if skirt > neck else ()
    profile = (
        (0.0, start), (bore, start), (bore, max(skirt, neck)), *reversed(wall), (piston.rod / 2, neck),
        (piston.rod / 2, eye), (0.0, eye),
    )  # fmt: skip
    tubes = (
        (bore, -half), (reach, -half), (reach, cylinder.flange - half), (outer, cylinder.flange - half),
        (outer, half - cylinder.flange), (reach, half - cylinder.flange), (reach, half), (bore, half),
    )  # fmt: skip
    wide = crank.pin_length / 2 - _GAP / 2
    place = (pin, 0.0, 0.0)
    return [
        Turned(name="piston and rod", profile=profile, axis="x"),
        Turned(name="cylinder", profile=tubes, axis="x"),
        tube("eye of the rod", (outside, outside + _CAP_WALL), (-wide, wide), place, "y"),
        tube(f"rod bearing, {rod.count} x {rod.bearing.designation}", (crank.pin / 2, outside), (-wide, wide), place,
             "y"),
        tube("crankpin", (crank.pin_bore / 2, crank.pin / 2), (-0.5 * crank.pin_length, 0.5 * crank.pin_length), place,
             "y"),
    ]  # fmt: skip


def _webs(crank: CrankPart, pin: float, shaft: float, diameter: float) -> list[Body]:
    """Both webs: the hull of pin and shaft, nowhere narrower than the web's width."""
    ends = tuple((x, 0.0, max(d, crank.web_width) / 2) for x, d in ((pin, crank.pin), (shaft, diameter)))
    holes = ((pin, 0.0, crank.pin_bore / 2),) if crank.pin_bore > 0 else ()
    faces = (crank.pin_length / 2, crank.pin_length / 2 + crank.web)
    return [
        Plate(name=f"web{word}", ends=(ends[0], ends[1]), holes=holes, low=min(side * f for f in faces),
              high=max(side * f for f in faces))
        for side, word in _SIDES
    ]  # fmt: skip


def _across(
    name: str, radii: tuple[float, float], ends: tuple[float, float], place: tuple[float, float, float], side: int
) -> Turned:
    low, high = sorted(side * end for end in ends)
    return tube(name, radii, (low, high), place, "y")


def _bearing(name: str, choice: Choice, place: tuple[float, float, float], start: float, side: int) -> Turned:
    b = choice.bearing
    return _across(
        f"{name}, {b.designation}", (b.bore / 2, b.outside / 2), (start, start + choice.count * b.width), place, side
    )


def _centred(
    name: str, choice: Choice, inner: float, place: tuple[float, float, float], at: float, side: int
) -> Turned:
    b, half = choice.bearing, choice.count * choice.bearing.width / 2
    return _across(f"{name}, {b.designation}", (inner, b.outside / 2), (at - half, at + half), place, side)
