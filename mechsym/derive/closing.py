"""Links placed one after another: in closed form where one or two of them close, by constraint elsewhere.

Every placed link has an angle and an origin in names of the tape that hold the joints' displacements, so that the
reactions come out by virtual work like those of a declaration by hand.
"""

from collections.abc import Callable
from itertools import combinations
from typing import Any

from sympy import Symbol, cos, sin

from mechsym.derive import dyads, figures, poses
from mechsym.derive.dyads import line_of_centres, on_line, pinned_at, place_by_pin, target
from mechsym.derive.linkage import Joint, Link, LinkLine, LinkPoint, named_point
from mechsym.derive.refuse import refuse

Declaration = Any  # the declaration, which imports this module


def advance(m: Declaration) -> None:
    """Place every link whose joints so far give a closed form."""
    while any(_single(m, link) for link in _free(m)) or any(_dyad(m, *pair) for pair in combinations(_free(m), 2)):
        pass


def _free(m: Declaration) -> list[Link]:
    return [link for link in m.links if not link.placed]


def _open(m: Declaration, link: Link) -> list[Joint]:
    """Unused joints between a link and points or lines that are placed."""
    unused = [j for j in m.link_joints if not j.used and link in (j.first.link, j.second.link)]
    return [j for j in unused if j.other(link).link.placed or (j.kind == "pin" and pinned_at(m, j.other(link), (j,)))]


def _outer(m: Declaration, link: Link) -> list[Joint]:
    """Joints that may place a link: a pin by which another link of its point was placed has to."""
    joints = _open(m, link)
    return [j for j in joints if j.displacements] or joints


def _single(m: Declaration, link: Link) -> bool:
    if link.given:
        pins = [j for j in _outer(m, link) if j.kind == "pin"]
        if pins:
            place_by_pin(m, link, pins[0], target(m, link, pins[0]))
        return bool(pins)
    for one in _outer(m, link):
        for other in _open(m, link):
            close, before = dyads.SINGLES.get((one.kind, other.kind)), len(m.tape.entries)
            if m.by_constraint and other.kind != "gear":  # a wheel has no dead point
                continue
            if close and one is not other and close(m, link, one, other):
                _choose(m, (other, one), (link,), before)
                return True
    return False


def _dyad(m: Declaration, a: Link, b: Link) -> bool:
    between = _inner(m, a, b)
    if m.by_constraint or len(between) != 1 or a.given or b.given:
        return False
    inner = between[0]
    for first, second in ((a, b), (b, a)):
        for outer in _outer(m, first):
            for last in _outer(m, second):
                close = dyads.DYADS.get((outer.kind, inner.kind, last.kind))
                if close and inner not in (outer, last) and not _of_no_length((first, outer), inner, (second, last)):
                    before = len(m.tape.entries)
                    close(m, (first, outer), inner, (second, last))
                    _choose(m, (inner, outer, last), (a, b), before)
                    return True
    return False


def _inner(m: Declaration, a: Link, b: Link) -> list[Joint]:
    """Unused joints of two links, else pins of both at one point of a third that is not placed."""
    unused = [j for j in m.link_joints if not j.used and not j.displacements]
    direct = [j for j in unused if {j.first.link, j.second.link} == {a, b}]
    if direct:
        return direct
    ends = [[j for j in unused if j.kind == "pin" and link in (j.first.link, j.second.link)] for link in (a, b)]
    through = []
    for one, other in ((j, k) for j in ends[0] for k in ends[1]):
        p, q = one.other(a), other.other(b)
        if p.link is q.link and (p.u, p.v) == (q.u, q.v) and not p.link.placed:
            branch = one.branch or other.branch
            through.append(Joint("pin", one.name, one.side(a), other.side(b), branch, through=(one, other)))
    return through


def _of_no_length(one: tuple[Link, Joint], inner: Joint, other: tuple[Link, Joint]) -> bool:
    """Whether two joints of a dyad are pins at one point of a link, so that nothing closes."""
    (a, outer), (b, last) = one, other
    pairs = (outer.side(a), inner.side(a)), (inner.side(b), last.side(b)), (outer.other(a), last.other(b))
    points = [p for p in pairs if all(isinstance(side, LinkPoint) for side in p)]
    return any(p.link is q.link and (p.u, p.v) == (q.u, q.v) for p, q in points)


def _choose(m: Declaration, joints: tuple[Joint, ...], links: tuple[Link, ...], before: int) -> None:
    """Set the side of links that were just placed, by their pose or `branch`; before: length of the tape then."""
    _require_no_guess(joints[0], *links)
    if side := poses.choose(m, joints, links, list(m.tape.entries)[before:]):
        m.sides.append(side)


def _require_no_guess(joint: Joint, *links: Link) -> None:
    for link in links:
        if link.guess is not None:
            why = f"the link {link.name!r} closes in closed form at the joint {joint.name!r}, which leaves its guess"
            way_out = "choose the side by pose= of the link, or branch=1 or -1 of that joint, and leave guess away"
            refuse(f"{why} without use; {way_out}")


def settle(m: Declaration, wanted: Link | None = None) -> None:
    """Place a link, or all of them, with dependent coordinates where there is no closed form."""
    advance(m)
    while free := [link for link in _free(m) if wanted in (None, link) or not wanted.placed]:
        hanging = [(link, j) for kind in ("pin", "slider") for link in free for j in _outer(m, link) if j.kind == kind]
        if not hanging:
            link = wanted or free[0]
            refuse(f"link {link.name!r} hangs on nothing that is placed; join it by a pin or a slider", link.where)
        link, joint = hanging[0]
        # a slider gives the angle, so that less is left to close
        _by_constraint(m, link, next((j for j in _outer(m, link) if j.kind == "slider"), joint))
        advance(m)


def _by_constraint(m: Declaration, link: Link, joint: Joint) -> None:
    if joint.kind == "pin":
        if link.turns is None:
            link.turns = _dependent(m, f"theta_{link.name}", "rad", link)
        place_by_pin(m, link, joint, target(m, link, joint))
        return
    rail = on_line(m, link, joint)
    s = _dependent(m, f"s_{link.name}", "m", link)
    dyads.place(m, link, rail.reference, (rail.start[0] + s * rail.e[0], rail.start[1] + s * rail.e[1]))


def _dependent(m: Declaration, name: str, unit: str, link: Link) -> Symbol:
    posed = m.poses.get(link.name)
    angle = posed if unit == "rad" and isinstance(posed, float) else 0.0
    return m.dependents(m.free_name(name), unit, guess=angle if link.guess is None else link.guess)


def finish(m: Declaration) -> None:
    """Place what is left, close the remaining joints by constraint, and count the freedoms."""
    if not m.links:
        if m.shapes:
            m.cams_drawn.clear()
        figures.draw_bodies(m)
        return
    settle(m)
    _require_held(m)
    figures.draw(m)
    before = len(m.constraints)
    closed = [joint for joint in m.link_joints if not joint.used]
    for joint in closed:
        _CLOSED[joint.kind](m, joint)
        joint.used = True
    added = len(m.constraints) - before
    if before == 0 and added != len(m.dependent_list):
        free, last = len(m.dependent_list) - added, m.link_joints[-1]
        if free > 0:
            why = f"the loop is open: {free} freedom(s) more than coordinates"
            refuse(f"{why} ({', '.join(map(str, m.dependent_list))}); add a joint or declare a coordinate", last.where)
        why = f"{-free} constraint(s) too many: the joint {closed[-1].name!r} or another holds what is held"
        refuse(f"{why}; leave one of them away, or free a link", closed[-1].where)
    _require_free(m, closed)


def _require_free(m: Declaration, joints: list[Joint]) -> None:
    """Refuse joints that hold what the declaration lets move freely, and nothing else."""
    for name, gap in m.constraints.items():
        joint = next((j for j in joints if name == j.name or name.endswith(f"_{j.name}")), None)
        held = [q for q in m.q if not m.tape.diff(gap, q).is_zero]
        if joint is not None and held and not set(held) & set(m.dependent_list):
            why = f"the joint {joint.name!r} holds {', '.join(map(str, held))}, which is to move freely"
            refuse(f"{why}; leave it away, or let the link hang on {joint.first.link.name} otherwise", joint.where)


def _require_held(m: Declaration) -> None:
    """Refuse a link whose joints are pins at one point: they leave its angle free."""
    for link in m.links:
        sides = [j.side(link) for j in m.link_joints if link in (j.first.link, j.second.link)]
        points = {(p.u, p.v) for p in sides if isinstance(p, LinkPoint)}
        pins = all(j.kind == "pin" for j in m.link_joints if link in (j.first.link, j.second.link))
        if pins and len(sides) > 1 and len(points) == 1 and link.turns in m.dependent_list:
            u, v = points.pop()
            why = f"all joints of the link {link.name!r} are pins at its point ({u}, {v}), which leaves its angle free"
            refuse(f"{why}; put one at another point, or give it turns=", link.where)


def _between(joint: Joint) -> str:
    return f"{joint.first.link.name} on {joint.second.link.name}, {joint.kind} {joint.name}"


def _closed_pin(m: Declaration, joint: Joint) -> None:
    (x1, y1), (x2, y2) = joint.first.xy, joint.second.xy
    m.constraint(joint.name, (x2 - x1, y2 - y1), between=_between(joint))


def _closed_slider(m: Declaration, joint: Joint) -> None:
    one, other = joint.first, joint.second
    angle = one.link.turns + one.tilt
    (x1, y1), (x2, y2) = one.link.out((one.u, one.v)), other.link.out((other.u, other.v))
    m.constraint(f"n_{joint.name}", (y2 - y1) * cos(angle) - (x2 - x1) * sin(angle), between=_between(joint))
    turned = sin(other.link.turns + other.tilt - angle)
    if not turned.free_symbols & {*m.tape.variables, *m.tape.entries}:
        links = f"{one.link.name} and {other.link.name}"
        why = f"the slider {joint.name!r} holds the turn of {links} in one another, which is held already"
        refuse(f"{why}; leave turns= away, or let a point slide: m.slot", joint.where)
    m.constraint(f"turn_{joint.name}", turned, between=_between(joint), reaction=f"M_{joint.name}")


def _closed_slot(m: Declaration, joint: Joint) -> None:
    line, point, s = (
        (joint.first, joint.second, 1) if isinstance(joint.first, LinkLine) else (joint.second, joint.first, -1)
    )
    angle = line.link.turns + line.tilt
    (x1, y1), (x2, y2) = line.link.out((line.u, line.v)), point.xy
    m.constraint(f"n_{joint.name}", s * ((y2 - y1) * cos(angle) - (x2 - x1) * sin(angle)), between=_between(joint))


def _closed_gear(m: Declaration, joint: Joint) -> None:
    gamma = line_of_centres(m, joint, named_point(m, joint.name, joint.second.xy))
    m.constraint(
        f"t_{joint.name}",
        dyads.rolled(joint, gamma, joint.first.link.turns, joint.second.link.turns),
        between=_between(joint),
    )


_CLOSED: dict[str, Callable[..., None]] = {
    "pin": _closed_pin, "slider": _closed_slider, "slot": _closed_slot, "gear": _closed_gear,
}  # fmt: skip
