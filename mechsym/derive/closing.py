"""Links placed one after another: in closed form where one or two of them close, by constraint elsewhere.

Every placed link has an angle and an origin in names of the tape that hold the joints' displacements, so that the
reactions come out by virtual work like those of a declaration by hand.
"""

from collections.abc import Callable
from typing import Any

from sympy import Symbol, cos, sin

from mechsym.derive.dyads import DYADS, SINGLES, line_of_centres, on_line, place, place_by_pin, rolled, target
from mechsym.derive.linkage import Joint, Link, LinkLine, named_point
from mechsym.derive.refuse import refuse

Declaration = Any  # the declaration, which imports this module


def advance(m: Declaration) -> None:
    """Place every link whose joints so far give a closed form."""
    while any(_single(m, link) for link in _free(m)) or any(_dyad(m, *pair) for pair in _pairs(m)):
        pass


def _free(m: Declaration) -> list[Link]:
    return [link for link in m.links if not link.placed]


def _pairs(m: Declaration) -> list[tuple[Link, Link]]:
    free = _free(m)
    return [(a, b) for i, a in enumerate(free) for b in free[i + 1 :]]


def _open(m: Declaration, link: Link) -> list[Joint]:
    """Unused joints between a link and placed ones."""
    found = [j for j in m.link_joints if not j.used and link in (j.first.link, j.second.link)]
    return [j for j in found if j.other(link).link.placed]


def _single(m: Declaration, link: Link) -> bool:
    joints = _open(m, link)
    if link.given:
        pins = [j for j in joints if j.kind == "pin"]
        if pins:
            place_by_pin(m, link, pins[0], target(m, link, pins[0]))
        return bool(pins)
    for one in joints:
        for other in joints:
            close = SINGLES.get((one.kind, other.kind))
            if close and one is not other and close(m, link, one, other):
                return True
    return False


def _dyad(m: Declaration, a: Link, b: Link) -> bool:
    between = [j for j in m.link_joints if {j.first.link, j.second.link} == {a, b} and not j.used]
    if len(between) != 1 or a.given or b.given:
        return False
    for first, second in ((a, b), (b, a)):
        for outer in _open(m, first):
            for last in _open(m, second):
                close = DYADS.get((outer.kind, between[0].kind, last.kind))
                if close:
                    close(m, (first, outer), between[0], (second, last))
                    return True
    return False


def settle(m: Declaration, wanted: Link | None = None) -> None:
    """Place a link, or all of them, with dependent coordinates where there is no closed form."""
    advance(m)
    while free := [link for link in _free(m) if wanted in (None, link) or not wanted.placed]:
        hanging = [(link, j) for kind in ("pin", "slider") for link in free for j in _open(m, link) if j.kind == kind]
        if not hanging:
            link = wanted or free[0]
            refuse(f"link {link.name!r} hangs on nothing that is placed; join it by a pin or a slider", link.where)
        link, joint = hanging[0]
        # a slider gives the angle, so that less is left to close
        _by_constraint(m, link, next((j for j in _open(m, link) if j.kind == "slider"), joint))
        advance(m)


def _by_constraint(m: Declaration, link: Link, joint: Joint) -> None:
    if joint.kind == "pin":
        if link.turns is None:
            link.turns = _dependent(m, f"theta_{link.name}", "rad", link)
        place_by_pin(m, link, joint, target(m, link, joint))
        return
    rail = on_line(m, link, joint)
    s = _dependent(m, f"s_{link.name}", "m", link)
    place(m, link, rail.reference, (rail.start[0] + s * rail.e[0], rail.start[1] + s * rail.e[1]))


def _dependent(m: Declaration, name: str, unit: str, link: Link) -> Symbol:
    return m.dependents(name, unit, guess=link.guess)


def finish(m: Declaration) -> None:
    """Place what is left, close the remaining joints by constraint, and count the freedoms."""
    if not m.links:
        return
    settle(m)
    _draw(m)
    before = len(m.constraints)
    for joint in m.link_joints:
        if not joint.used:
            _CLOSED[joint.kind](m, joint)
            joint.used = True
    made = len(m.constraints) - before
    if before == 0 and made != len(m.dependent_list):
        free, last = len(m.dependent_list) - made, m.link_joints[-1]
        if free > 0:
            why = f"the loop is open: {free} freedom(s) more than coordinates"
            refuse(f"{why} ({', '.join(map(str, m.dependent_list))}); add a joint or declare a coordinate", last.where)
        spare = next(
            j for j in reversed(m.link_joints) if f"joint {j.name}" in m.where or f"joint x_{j.name}" in m.where
        )
        refuse(f"{-free} constraint(s) too many: the joint {spare.name!r} or another holds what is held", spare.where)


def _draw(m: Declaration) -> None:
    """Every link as a line through what its joints hold, where the declaration draws nothing."""
    if m.shapes:
        return
    for link in m.links:
        sides = [j.side(link) for j in m.link_joints if link in (j.first.link, j.second.link)]
        points = [p.link.at(p.u, p.v) for p in sides]
        where = list({(str(p.u), str(p.v)): p for p in points}.values())
        if len(where) > 1:
            m.draw_line(*where, *(where[:1] if len(where) > 2 else ()), role="crank" if link.given else "rod")
        elif link.mass != 0 and where:
            m.draw_line(where[0], link.at(*link.centre), role="piston")


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
        rolled(joint, gamma, joint.first.link.turns, joint.second.link.turns),
        between=_between(joint),
    )


_CLOSED: dict[str, Callable[..., None]] = {
    "pin": _closed_pin, "slider": _closed_slider, "slot": _closed_slot, "gear": _closed_gear,
}  # fmt: skip
