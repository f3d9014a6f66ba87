"""Closed forms of one link and of dyads: RRR, RRP, RPR, PRP, RPP, and their kin with a slot or a gear.

R a pin, P a slider; the letters are outer, inner, outer joint. Where two poses close, `branch` chooses: RRR the inner
pin on the left (1) or the right (-1) of the way from the first outer pin to the second; RRP the slider further on
along its line; RPR the other pin ahead (1) or behind (-1) along the line of the slider's first link. Displacements: the
second link of a joint moves against the first; n along the left normal of the line. A slider's reactions are the force
R_n at the reference point of the second link's line, and the moment M about it.
"""

from collections.abc import Callable
from dataclasses import dataclass

from sympy import Expr, Integer, Symbol, cos, sin, sqrt

from mechsym.derive.linkage import Joint, Link, Linkage, LinkLine, LinkPoint, Pair, named_point
from mechsym.derive.refuse import refuse


def target(m: Linkage, link: Link, joint: Joint) -> Pair:
    """Where a pin holds the point of a link that is to be placed."""
    dx, dy = m.displace(joint)
    if joint.place is None:
        other, s = joint.other(link), joint.sign(link)
        further = None if other.link.placed else pinned_at(m, other, (joint,))
        x, y = named_point(m, joint.name, other.xy if further is None else target(m, other.link, further))
        joint.place = x + s * dx, y + s * dy
        if further is not None:
            further.used = False  # it has yet to place the link between
    return joint.place


def pinned_at(m: Linkage, point: LinkPoint, beside: tuple[Joint, ...] = ()) -> Joint | None:
    """A pin that tells where a point of a link lies whose angle is not known yet: a joint of three bodies or more."""
    for joint in m.link_joints:
        if joint.kind != "pin" or joint in beside or point.link not in (joint.first.link, joint.second.link):
            continue
        own, other = joint.side(point.link), joint.other(point.link)
        if (own.u, own.v) == (point.u, point.v):
            if other.link.placed or pinned_at(m, other, (*beside, joint)):
                return joint
    return None


def place(m: Linkage, link: Link, local: Pair, position: Pair) -> None:
    """Place a link of known angle by one of its points, and give it its body."""
    if link.turns is not None and not link.turns.is_Symbol and not link.turns.is_number:
        link.turns = m.derived(f"angle_{link.name}", link.turns, "rad")
    x, y = link.turn(local)
    if local == (0, 0):
        link.origin = position
    else:
        link.origin = named_point(m, f"at_{link.name}", (position[0] - x, position[1] - y))
    if link.mass != 0:
        m.body(link.name, mass=link.mass, at=link.out(link.centre), turns=link.turns, inertia=link.inertia)
    elif link.inertia != 0:
        m.body(link.name, turns=link.turns, inertia=link.inertia)


def place_by_pin(m: Linkage, link: Link, joint: Joint, position: Pair) -> None:
    """Place a link of known angle by the point of it that a pin holds."""
    point = joint.side(link)
    place(m, link, (point.u, point.v), position)


def _along(m: Linkage, link: Link, start: LinkPoint, end: LinkPoint, way: Pair) -> None:
    """Angle of a link from the way between two of its points."""
    (wx, wy), u, v = way, end.u - start.u, end.v - start.v
    square = u**2 + v**2
    c, s = (wx / u, wy / u) if v == 0 else ((wx * u + wy * v) / square, (wy * u - wx * v) / square)
    link.turns = _direction(m, f"angle_{link.name}", c, s)


def _direction(m: Linkage, name: str, c: Expr, s: Expr) -> Symbol:
    name = m.free_name(name)
    m._take(name, "rad", f"sin_{name}", f"cos_{name}")
    symbol = m.tape.define_direction(name, m._checked(c, "-", name), m._checked(s, "-", name))
    m.dimensions[symbol] = (0, 0, 0, 0)
    return symbol


@dataclass(frozen=True)
class Rail:
    """A line on which a link of known angle slides: where its reference point starts, and the direction."""

    start: Pair
    e: Pair
    reference: Pair  # in the link's axes


def on_line(m: Linkage, link: Link, joint: Joint) -> Rail:
    """Angle of a link from a slider on a placed line, and the line that its reference point follows."""
    own, rail, s = joint.side(link), joint.other(link), joint.sign(link)
    n, turn = m.displace(joint)
    base = rail.link.turns + rail.tilt
    link.turns = m.derived(f"angle_{link.name}", base + s * turn - own.tilt, "rad")
    way = base if s == 1 else base - turn  # of the first link's line
    x, y = rail.link.out((rail.u, rail.v))
    start = named_point(m, joint.name, (x - s * n * sin(way), y + s * n * cos(way)))
    return Rail(start, (cos(way), sin(way)), (own.u, own.v))


def _offset(link: Link, rail: Rail, point: LinkPoint) -> Pair:
    """A point of a sliding link while its reference is at the rail's start."""
    x, y = link.turn((point.u - rail.reference[0], point.v - rail.reference[1]))
    return rail.start[0] + x, rail.start[1] + y


def _slide(m: Linkage, link: Link, rail: Rail, s: Expr) -> None:
    s = m.derived(f"slide_of_{link.name}", s, "m")
    place(m, link, rail.reference, (rail.start[0] + s * rail.e[0], rail.start[1] + s * rail.e[1]))


def _branch(*joints: Joint) -> int:
    return next((j.branch for j in joints if j.branch), 1)


def _minus(a: Pair, b: Pair, s: int = 1, d: tuple[Expr | float, ...] = (0, 0)) -> Pair:
    return a[0] - b[0] - s * d[0], a[1] - b[1] - s * d[1]


def _cross(a: Pair, b: Pair) -> Expr:
    return a[0] * b[1] - a[1] * b[0]


def _dot(a: Pair, b: Pair) -> Expr:
    return a[0] * b[0] + a[1] * b[1]


def _square(start: LinkPoint, end: LinkPoint) -> Expr:
    return (end.u - start.u) ** 2 + (end.v - start.v) ** 2


def _rrr(m: Linkage, one: tuple[Link, Joint], inner: Joint, other: tuple[Link, Joint]) -> None:
    (a, ja), (b, jb) = one, other
    A, B = target(m, a, ja), target(m, b, jb)
    d, s, k = m.displace(inner), inner.sign(b), inner.name
    ways = [_square(j.side(link), inner.side(link)) for link, j in (one, other)]
    D = m.derived(f"way_x_{k}", _minus(B, A, s, d)[0], "m"), m.derived(f"way_y_{k}", _minus(B, A, s, d)[1], "m")
    square = m.derived(f"square_{k}", _dot(D, D), "m^2")
    share = m.derived(f"share_{k}", (1 + (ways[0] - ways[1]) / square) / 2, "-")
    height = m.derived(f"height_{k}", _branch(inner, ja, jb) * sqrt(ways[0] / square - share**2), "-")
    way = share * D[0] - height * D[1], share * D[1] + height * D[0]
    _along(m, a, ja.side(a), inner.side(a), way)
    place_by_pin(m, a, ja, A)
    _along(m, b, jb.side(b), inner.side(b), (way[0] - D[0], way[1] - D[1]))
    place_by_pin(m, b, jb, B)


def _reach(m: Linkage, name: str, w: Pair, e: Pair, square: Expr, branch: int) -> Expr:
    """How far along a line a point lies at a distance from another."""
    across = m.derived(f"across_{name}", _cross(w, e), "m")
    return m.derived(f"along_{name}", branch * sqrt(square - across**2) - _dot(w, e), "m")


def _rrp(m: Linkage, one: tuple[Link, Joint], inner: Joint, other: tuple[Link, Joint]) -> None:
    (a, ja), (b, jb) = one, other
    A, rail = target(m, a, ja), on_line(m, b, jb)
    w = _minus(_offset(b, rail, inner.side(b)), A, inner.sign(b), m.displace(inner))
    s = _reach(m, inner.name, w, rail.e, _square(ja.side(a), inner.side(a)), _branch(inner, ja, jb))
    _along(m, a, ja.side(a), inner.side(a), (w[0] + s * rail.e[0], w[1] + s * rail.e[1]))
    place_by_pin(m, a, ja, A)
    _slide(m, b, rail, s)


def _in_line(line: LinkLine, point: LinkPoint) -> Pair:
    """A point of a link in the axes of one of its lines."""
    u, v = point.u - line.u, point.v - line.v
    c, s = cos(line.tilt), sin(line.tilt)
    return u * c + v * s, v * c - u * s


def _aim(m: Linkage, name: str, D: Pair, h: Expr, branch: int) -> Symbol:
    """Direction of a line at a signed distance: its normal component of D is h."""
    D = m.derived(f"way_x_{name}", D[0], "m"), m.derived(f"way_y_{name}", D[1], "m")
    square, h = m.derived(f"square_{name}", _dot(D, D), "m^2"), m.derived(f"off_{name}", h, "m")
    along = m.derived(f"reach_{name}", branch * sqrt(square - h**2), "m")
    return _direction(m, f"beta_{name}", (D[0] * along + D[1] * h) / square, (D[1] * along - D[0] * h) / square)


def _rpr(m: Linkage, one: tuple[Link, Joint], inner: Joint, other: tuple[Link, Joint]) -> None:
    (a, ja), (b, jb) = (one, other) if inner.first.link is one[0] else (other, one)
    A, B = target(m, a, ja), target(m, b, jb)
    n, turn = m.displace(inner)
    la, lb = inner.side(a), inner.side(b)
    (_, ha), (ub, hb) = _in_line(la, ja.side(a)), _in_line(lb, jb.side(b))
    h = n + ub * sin(turn) + hb * cos(turn) - ha
    beta = _aim(m, inner.name, _minus(B, A), h, _branch(inner, ja, jb))
    a.turns, b.turns = beta - la.tilt, beta + turn - lb.tilt
    place_by_pin(m, a, ja, A)
    place_by_pin(m, b, jb, B)


def _prp(m: Linkage, one: tuple[Link, Joint], inner: Joint, other: tuple[Link, Joint]) -> None:
    (a, ja), (b, jb) = one, other
    ra, rb = on_line(m, a, ja), on_line(m, b, jb)
    W = _minus(_offset(b, rb, inner.side(b)), _offset(a, ra, inner.side(a)), inner.sign(b), m.displace(inner))
    _slide(m, a, ra, _cross(W, rb.e) / _cross(ra.e, rb.e))
    _slide(m, b, rb, _cross(W, ra.e) / _cross(ra.e, rb.e))


def _rpp(m: Linkage, one: tuple[Link, Joint], inner: Joint, other: tuple[Link, Joint]) -> None:
    (a, ja), (b, jb) = one, other
    A, rail = target(m, a, ja), on_line(m, b, jb)
    la, lb, s, (n, turn) = inner.side(a), inner.side(b), inner.sign(a), m.displace(inner)
    base = b.turns + lb.tilt
    a.turns = base + s * turn - la.tilt
    place_by_pin(m, a, ja, A)
    way = base if s == 1 else base - turn
    normal = -sin(way), cos(way)
    gap = _minus(a.out((la.u, la.v)), _offset(b, rail, lb))
    _slide(m, b, rail, (_dot(normal, gap) - s * n) / _dot(normal, rail.e))


def _slider_and_slot(m: Linkage, link: Link, slider: Joint, slot: Joint) -> bool:
    rail, (n,) = on_line(m, link, slider), m.displace(slot)
    n = n if isinstance(slot.second, LinkPoint) else -n
    own, fixed = slot.side(link), slot.other(link)
    line = own if isinstance(own, LinkLine) else fixed
    base = line.link.turns + line.tilt
    normal = -sin(base), cos(base)
    gap = _minus(fixed.link.out((fixed.u, fixed.v)), _offset(link, rail, own))
    s = _dot(normal, gap) + (-n if line is own else n)
    _slide(m, link, rail, s / _dot(normal, rail.e))
    return True


def _pin_and_slot(m: Linkage, link: Link, pin: Joint, slot: Joint) -> bool:
    A, (n,) = target(m, link, pin), m.displace(slot)
    n = n if isinstance(slot.second, LinkPoint) else -n
    own, fixed, branch = slot.side(link), slot.other(link), _branch(slot, pin)
    at = fixed.link.out((fixed.u, fixed.v))
    if isinstance(own, LinkLine):
        h = n - _in_line(own, pin.side(link))[1]
        link.turns = _aim(m, slot.name, _minus(at, A), h, branch) - own.tilt
    else:
        base = fixed.link.turns + fixed.tilt
        w, e = (at[0] - n * sin(base) - A[0], at[1] + n * cos(base) - A[1]), (cos(base), sin(base))
        s = _reach(m, slot.name, w, e, _square(pin.side(link), own), branch)
        _along(m, link, pin.side(link), own, (w[0] + s * e[0], w[1] + s * e[1]))
    place_by_pin(m, link, pin, A)
    return True


def rolled(joint: Joint, gamma: Expr, first: Expr, second: Expr) -> Expr:
    """How far the second wheel's teeth have moved on the first's, along the pitch circle [m]."""
    (r1, r2), s = joint.radii, 1 if joint.inside else -1
    return (r1 - s * r2) * gamma + s * r2 * second - r1 * first


def line_of_centres(m: Linkage, joint: Joint, second: Pair) -> Symbol:
    """Angle through which the line of centres has turned; its rates are those of the geometry."""
    x, y = _minus(second, joint.first.xy)
    needed = m.tape.needed([m.tape.named(x), m.tape.named(y)])
    letters = x.free_symbols.union(y.free_symbols, *(m.tape.entries[n].free_symbols for n in needed))
    roots = {s for s in letters if s in m.q and s not in m.joint_list}
    turning = [k for k in m.links if k.origin is not None and (k.given or k.turns in m.dependent_list)]
    carriers = [k.turns for k in turning if k.angle.free_symbols & roots]
    if roots and not carriers:
        why = f"no link carries the wheels of the gear {joint.name!r}: their line of centres turns with none"
        refuse(f"{why}; pin the second wheel on a link that turns about the first one's centre", joint.where)
    return m.tape.define_turn(f"gamma_{joint.name}", carriers[0] if carriers else Integer(0), x, y)


def _pin_and_gear(m: Linkage, link: Link, pin: Joint, gear: Joint) -> bool:
    own, held = gear.side(link), pin.side(link)
    if (own.u, own.v) != (held.u, held.v) or gear.first.link is link:
        return False
    centre = target(m, link, pin)
    gamma = line_of_centres(m, gear, centre)
    (r1, r2), s, (t,) = gear.radii, 1 if gear.inside else -1, m.displace(gear)
    link.turns = s * (t - (r1 - s * r2) * gamma + r1 * gear.first.link.turns) / r2
    place_by_pin(m, link, pin, centre)
    return True


SINGLES: dict[tuple[str, str], Callable[..., bool]] = {
    ("slider", "slot"): _slider_and_slot,
    ("pin", "slot"): _pin_and_slot,
    ("pin", "gear"): _pin_and_gear,
}
DYADS: dict[tuple[str, str, str], Callable[..., None]] = {
    ("pin", "pin", "pin"): _rrr, ("pin", "pin", "slider"): _rrp, ("pin", "slider", "pin"): _rpr,
    ("slider", "pin", "slider"): _prp, ("pin", "slider", "slider"): _rpp,
}  # fmt: skip
