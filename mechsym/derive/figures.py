"""The drawing of a mechanism that draws nothing itself: links through their joints, marks of the ground, slides, gears.

line, circle    as declared by hand (drawing.py), placed by the derived code
cam             the contact, or the centre of the roller of `radius`, and a point ahead that turns with the cam
rail            the frame beside a slide, as far as it moves; points: the slide, and one ahead of it
trace           the path of a watched point
"""

from collections.abc import Iterable
from itertools import chain
from typing import Any

from sympy import Expr, Integer, Rational, cos, sin, sqrt

from mechsym.derive.linkage import Joint, Link, LinkLine, LinkPoint

Declaration = Any  # the declaration, whose closing imports this module
_HATCH = [(14, -16), (10, -20), (7, -16), (3, -20), (0, -16), (-4, -20), (-7, -16), (-11, -20), (-14, -16), (14, -16)]
_GROUND = [[(0, 0), (-9, -16), (9, -16), (0, 0)], _HATCH]  # tenths of a mark, about the pin


def draw(m: Declaration) -> None:
    """Name where pins are, and draw what the declaration leaves undrawn."""
    m.pins = {pin.name: m.point_names((pin.first,))[0] for pin in m.link_joints if pin.kind == "pin"}
    slides = (one for one in m.link_joints if one.kind in ("slider", "slot"))
    # size of a mark: a fifteenth of the root mean square of the lengths of all links [m]
    held = [p for joint in m.link_joints for p in (joint.first, joint.second)]
    held += [p for p in m.watched.values() if isinstance(p, LinkPoint)]
    points = {(p.u, p.v) for p in held} | {tuple(link.centre) for link in m.links}
    square = sum((x**2 for point in points for x in point), Integer(0))
    mark = sqrt(square * Rational(1, len(points))) / 15 if square != 0 else Integer(0)
    m.pins |= {one.name: [*chain(*m.point_names(_across(one, mark)))] for one in slides if mark != 0}
    drawn = bool(m.shapes)
    for point in m.watched.values():
        m._shape("trace", "trace", (point,))
    if drawn:
        m.cams_drawn.clear()
        return
    for joint in m.link_joints if mark != 0 else ():
        _DRAWN[joint.kind](m, joint, mark)
    for link in m.links:
        _link(m, link)
    for radius, point in {(str(r), str(p)): (r, p) for p, r, _, _ in m.faces if isinstance(p, LinkPoint)}.values():
        if radius != 0:
            m.draw_circle(point, radius, role="planet")
    for _, _, line, length in m.faces:
        if isinstance(line, LinkLine) and (length is not None or line.link is m.frame):
            _face(m, line, length, mark)


def draw_bodies(m: Declaration) -> None:
    """Where nothing else is drawn, centres of the bodies that move, and the origin; as large as the letters say."""
    if m.shapes or m.sketches or m.cams_drawn:
        return
    lengths = [letter for letter in m.parameter_list if m.units[letter.name] == "m"]
    moving = [b for b in m.bodies if b.mass != 0 and any(m.tape.flat(x).free_symbols & {*m.q} for x in b.at)]
    if not lengths or not moving:
        return
    size = sqrt(sum((length**2 for length in lengths), Integer(0))) / 30
    m.draw_line((-size, Integer(0)), (size, Integer(0)), role="frame")
    m.draw_line((Integer(0), -size), (Integer(0), size), role="frame")
    for body in moving:
        m.draw_circle(body.at, size, role="planet")
        m._shape("trace", "trace", (body.at,))


def draw_cams(m: Declaration) -> None:
    """Cams by where their contact runs as they turn, and their followers."""
    for cam in m.cams_drawn:
        ahead = cam.base * cos(cam.turned), cam.base * sin(cam.turned)
        radius = {"radius": cam.roller} if cam.roller != 0 else {}
        m._shape("cam", "cam", (cam.place, ahead), **radius)
        for line in cam.lines:
            m.draw_line(*line, role="piston")
        if cam.roller != 0:
            m.draw_circle(cam.lines[0][0], cam.roller, role="roller")
        m.draw_circle((Integer(0), Integer(0)), cam.base / 12)


def _face(m: Declaration, line: LinkLine, length: object, mark: Expr) -> None:
    """A wall as long as it is, or a piece of the ground."""
    ends = (-8 * mark, 8 * mark) if length is None else (Integer(0), m._sized(length, "m", "wall", "length of a wall"))
    places = [(line.u + s * cos(line.tilt), line.v + s * sin(line.tilt)) for s in ends]
    if ends[0] != ends[1]:
        m.draw_line(*(line.link.at(*place) for place in places), role="frame" if line.link is m.frame else "planet")


def _link(m: Declaration, link: Link) -> None:
    """A link as a line, or a polygon, through what its joints hold and what is watched of it."""
    sides = [joint.side(link) for joint in m.link_joints if link in (joint.first.link, joint.second.link)]
    watched = (p for p in m.watched.values() if isinstance(p, LinkPoint) and p.link is link)
    faces = (p for p, _, _, _ in m.faces if isinstance(p, LinkPoint) and p.link is link)
    points = [link.at(p.u, p.v) for p in (*sides, *watched, *faces)]
    where = list({(str(p.u), str(p.v)): p for p in points}.values())
    if len(where) > 1:
        m.draw_line(*where, *(where[:1] if len(where) > 2 else ()), role="crank" if link.given else "rod")
    elif link.mass != 0 and where and (link.centre[0], link.centre[1]) != (where[0].u, where[0].v):
        m.draw_line(where[0], link.at(*link.centre), role="piston")


def _pin(m: Declaration, joint: Joint, mark: Expr) -> None:
    for point in (joint.first, joint.second):
        stands = point.link is m.frame and not (point.u.free_symbols | point.v.free_symbols) & set(m.q)
        for corners in _GROUND if stands else ():
            places = [(point.u + mark * Rational(x, 10), point.v + mark * Rational(y, 10)) for x, y in corners]
            m.draw_line(*places, role="frame")


def _slide(m: Declaration, joint: Joint, mark: Expr) -> None:
    """A block on a line, with a rail where the line stands still."""
    line, point = (joint.first, joint.second) if isinstance(joint.first, LinkLine) else (joint.second, joint.first)
    if point.link is m.frame and isinstance(point, LinkLine):
        line, point = point, line
    angle = line.link.angle + line.tilt
    along, across = (mark * cos(angle), mark * sin(angle)), (-mark * sin(angle), mark * cos(angle))
    x, y = point.link.out((point.u, point.v))
    if line.link is m.frame:
        m._shape("rail", "frame", ((x, y), (x + along[0], y + along[1])))
    else:
        m.draw_line(line.link.at(line.u, line.v), (x, y), role="rod")
    m.draw_line(*_corners((x, y), along, across), role="piston")


def _corners(middle: tuple[Expr, Expr], along: tuple[Expr, Expr], across: tuple[Expr, Expr]) -> Iterable[object]:
    (x, y), (ax, ay), (bx, by) = middle, along, across
    for i, j in ((1, 1), (-1, 1), (-1, -1), (1, -1), (1, 1)):
        k, n = i * Rational(3, 2), j * Rational(4, 5)
        yield x + k * ax + n * bx, y + k * ay + n * by


def _across(joint: Joint, mark: Expr) -> tuple[tuple[Expr, Expr], ...]:
    """Where a slide is held, and a mark on along the left normal of its line."""
    line, at = joint.first if isinstance(joint.first, LinkLine) else joint.second, joint.second
    if isinstance(at, LinkLine) and isinstance(joint.first, LinkPoint):
        at = joint.first
    angle, (x, y) = line.link.angle + line.tilt, at.link.out((at.u, at.v))
    return (x, y), (x - mark * sin(angle), y + mark * cos(angle))


def _gear(m: Declaration, joint: Joint, mark: Expr) -> None:
    for point, radius in zip((joint.first, joint.second), joint.radii, strict=True):
        m.draw_circle(point, radius, role="frame" if point.link is m.frame else "planet")


_DRAWN = {"pin": _pin, "slider": _slide, "slot": _slide, "gear": _gear}
