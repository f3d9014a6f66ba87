"""Joints in space: how each hangs a body on the tree, and the rows by which it closes a loop.

R a turn about an axis, C a turn and a way along it, T a way, Q a quaternion, F nothing: a joint is a word of these,
with massless bodies between them. Rows look along directions of the first body: n and b square to its axis, d along it.
"""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Any

from sympy import Expr, Symbol, cos, pi, sin

from mechsym.derive import vectors as vec
from mechsym.derive.rates import curvature
from mechsym.derive.refuse import refuse
from mechsym.derive.space_rows import AlongLine, ClosureRow, Distance, Meet, Norm, Square
from mechsym.derive.space_tree import Column, TreeBody
from mechsym.derive.vectors import AXES, EYE, NONE, O, Vector

Joint = Any  # of space.py, which imports this module
Declaration = Any


@dataclass(frozen=True)
class Freedom:
    """One coordinate of a joint: its value and whether it turns."""

    value: Expr
    turns: bool


@dataclass(frozen=True)
class Move:
    """One step of a joint: its letter, the axis in the body before and in the one behind, and its coordinates."""

    letter: str
    axis: Vector = NONE
    behind: Vector = NONE
    values: tuple[Expr, ...] = ()


@dataclass(frozen=True)
class JointKind:
    """What a kind of joint is: which sides need an axis, its freedoms where it may hang a body, its rows."""

    axes: tuple[bool, bool]
    freedoms: str  #: R, T and Q in the order of its coordinates
    word: Callable[[Joint, Vector, Vector, list[Expr]], list[Move]]
    rows: str  #: Letters of `_ROWS`
    forces: str = "xyz"
    moments: str = "xyz"
    hangs: bool = True  #: Whether it may hang a body; others only close

    def count(self, joint: Joint) -> int:
        """How many freedoms it has."""
        return 3 if self.freedoms == "Q" else len(self.freedoms)

    def reactions(self, name: str) -> Iterator[tuple[str, str]]:
        """Names and units of its reactions."""
        if self.forces == "n":
            yield f"R_{name}", "N"
            return
        yield from ((f"R_{axis}_{name}", "N") for axis in self.forces)
        yield from ((f"M_{axis}_{name}", "N*m") for axis in self.moments)


def _planar(joint: Joint, d1: Vector, d2: Vector, v: list[Expr]) -> list[Move]:
    if joint.child is joint.first.link:
        refuse(f"the planar joint {joint.name!r} hangs its first body; name the body nearer to the frame first")
    n, b = vec.normals(d1)
    return [Move("T", n, n, (v[0],)), Move("T", b, b, (v[1],)), Move("R", d1, d2, (v[2],))]


def _spherical(joint: Joint, d1: Vector, d2: Vector, v: list[Expr]) -> list[Move]:
    if not joint.sequence:
        return [Move("Q", values=tuple(v))]
    bad = set(joint.sequence) - set("xyz")
    if bad or len(joint.sequence) != 3 or any(a == b for a, b in zip(joint.sequence, joint.sequence[1:], strict=False)):
        refuse(f"the sequence {joint.sequence!r} of {joint.name!r} names three axes, no two alike in a row: 'zxz'")
    pairs = list(zip(joint.sequence, v, strict=True))
    return [Move("R", AXES[a], AXES[a], (x,)) for a, x in (pairs if joint.child is joint.second.link else pairs[::-1])]


def _universal(joint: Joint, d1: Vector, d2: Vector, v: list[Expr]) -> list[Move]:
    if vec.dot(d1, d2).equals(0) is False:
        refuse(f"the axes of the universal joint {joint.name!r} are not square to one another while the bodies' axes "
               "are parallel; name axes that are")  # fmt: skip
    return [Move("R", d1, d1, (v[0],)), Move("R", d2, d2, (v[1],))]


def _screw(joint: Joint, d1: Vector, d2: Vector, v: list[Expr]) -> list[Move]:
    return [Move("C", d1, d2, (v[0], joint.lead / (2 * pi) * v[0]))]


def _free(joint: Joint, d1: Vector, d2: Vector, v: list[Expr]) -> list[Move]:
    return [*(Move("T", e, e, (x,)) for e, x in zip(EYE, v[:3], strict=True)), Move("Q", values=tuple(v[3:]))]


KINDS: dict[str, JointKind] = {
    "revolute": JointKind((True, True), "R", lambda j, a, b, v: [Move("R", a, b, (v[0],))], "xyzuv"),
    "pin": JointKind((True, True), "R", lambda j, a, b, v: [Move("R", a, b, (v[0],))], "xyzuv"),
    "prismatic": JointKind((True, True), "T", lambda j, a, b, v: [Move("T", a, b, (v[0],))], "nbrst"),
    "cylindrical": JointKind((True, True), "RT", lambda j, a, b, v: [Move("C", a, b, (v[0], v[1]))], "nbuv"),
    "screw": JointKind((True, True), "R", _screw, "nbuv!"),
    "spherical": JointKind((False, False), "Q", _spherical, "xyz", moments=""),
    "universal": JointKind((True, True), "RR", _universal, "xyzw"),
    "planar": JointKind((True, True), "TTR", _planar, "duv"),
    "fixed": JointKind((False, False), "", lambda j, a, b, v: [Move("F", a, b)], "xyzrst"),
    "free": JointKind((False, False), "TTTQ", _free, "", "", ""),
    "slot": JointKind((True, False), "", lambda j, a, b, v: [], "nb", moments="", hangs=False),
    "plane": JointKind((True, False), "", lambda j, a, b, v: [], "d", moments="", hangs=False),
    "strut": JointKind((False, False), "", lambda j, a, b, v: [], "l", "n", "", hangs=False),
}

_STEMS = {"R": ("turn", "rad"), "T": ("slide", "m")}


def _coordinates(m: Declaration, joint: Joint) -> list[Expr]:
    """The coordinates of a joint, those of the user's own or named after it."""
    if joint.given:
        letters = "R" * 3 if joint.sequence else KINDS[joint.kind].freedoms
        joint.freedoms = [Freedom(v, k == "R") for v, k in zip(joint.given, letters, strict=True)]
        return list(joint.given)
    letters, link, values = KINDS[joint.kind].freedoms, joint.child, []
    if joint.kind == "pin":
        return [_pinned(m, joint, link)]
    if joint.sequence:
        letters = "R" * 3
    poses = joint.pose if isinstance(joint.pose, (tuple, list)) else (joint.pose,) * len(letters)
    for k, letter in enumerate(letters):
        if letter == "Q":
            values += _quaternion(m, joint, tuple(poses))
            continue
        stem, unit = _STEMS[letter]
        many = letters.count(letter) > 1
        guess = 0.0 if k >= len(poses) or poses[k] is None else m._posed(poses[k], unit, f"pose of {joint.name}")
        stem = "xyz"[k] if joint.kind == "free" else f"{stem}{k + 1 if many else ''}"
        values.append(m.freedom(stem, joint, unit, guess))
    joint.freedoms = [Freedom(v, m.units[v.name] == "rad") for v in values]
    return values


def _quaternion(m: Declaration, joint: Joint, pose: tuple[Any, ...]) -> list[Symbol]:
    """Four letters with the norm 1; a pose is three angles of a turn's vector [rad]."""
    turn = (
        [m._posed(p, "rad", f"pose of {joint.name}") for p in pose[-3:]] if len(pose) >= 3 and pose[-1] else [0.0] * 3
    )
    size = sum(t * t for t in turn) ** 0.5
    share = float(sin(size / 2)) / size if size else 0.0
    guesses = [float(cos(size / 2)), *(share * t for t in turn)]
    e = [m.freedom(f"e{k}", joint, "-", g) for k, g in enumerate(guesses)]
    m.norms[f"norm_{joint.name}"] = Norm(tuple(e), tuple(Symbol(f"{x.name}d", real=True) for x in e))
    return e


def _pinned(m: Declaration, joint: Joint, link: Any) -> Expr:
    """The turn of a pin by the angle of its link about z, as in the plane."""
    before = joint.first.link if link is joint.second.link else joint.second.link
    if link.turns is None:
        posed = m.poses.get(link.name, link.guess)
        link.turns = m.coordinates(m.free_name(f"theta_{link.name}"), "rad")
        m.own[link.turns] = float(posed or 0.0)
    if before.angle is None:
        refuse(f"the pin {joint.name!r} holds {link.name} to {before.name}, which has turned about more than z; "
               "write m.revolute")  # fmt: skip
    link.angle = link.turns
    joint.freedoms = [Freedom(link.turns, True)]
    turn = link.turns - before.angle
    return turn if link is joint.second.link else -turn


def hung(m: Declaration, joint: Joint, child: Any) -> tuple[TreeBody, ...]:
    """Bodies that a joint adds to the tree: those between its steps, and what it hangs."""
    first, second = joint.sides
    values = _coordinates(m, joint)
    one, other, sign = (first, second, 1) if child is joint.second.link else (second, first, -1)
    d1, d2 = first.axis, second.axis
    moves = KINDS[joint.kind].word(joint, d1, d2, values)
    if sign < 0:
        moves = [Move(v.letter, v.behind, v.axis, tuple(-x for x in v.values)) for v in reversed(moves)]
        if moves[0].letter == "Q":
            w, x, y, z = (-v for v in moves[0].values)
            moves = [Move("Q", values=(w, -x, -y, -z))]
    parts: list[TreeBody] = []
    before = one.part
    for k, move in enumerate(moves):
        last = k == len(moves) - 1
        name = child.name if last else f"{joint.name}{k + 1}"
        part = _part(
            m, move, TreeBody(name, before, joint=joint.name), one.at if k == 0 else NONE, other.at if last else NONE
        )
        parts.append(m.tree.hang(part))
        before = part
    if joint.kind in ("prismatic", "fixed"):
        before_link = joint.first.link if child is joint.second.link else joint.second.link
        child.angle = _flat_turn(before_link.angle, d1, d2, sign)
    return tuple(parts)


def _flat_turn(angle: Expr | None, d1: Vector, d2: Vector, sign: int) -> Expr | None:
    """The angle about z of what slides in the plane of x and y."""
    if angle is None or d1[2] != 0 or d2[2] != 0 or d1 != d2:
        return None
    return angle


def _part(m: Declaration, move: Move, part: TreeBody, a1: Vector, a2: Vector) -> TreeBody:
    d1, d2, tape = move.axis, move.behind, m.tape
    columns: list[Column] = []
    if move.letter in "RC":
        angle = tape.named(move.values[0])
        if not (angle.is_Symbol or (-angle).is_Symbol or angle.is_Number):
            angle = tape.step(f"angle_{part.name}", angle)
        c, s = (tape.step(f"{stem}_{part.name}", tape.named(f(angle))) for f, stem in ((cos, "c"), (sin, "s")))
        part.turn = vec.product(vec.turned(d1, c, s), vec.onto(d2, d1, f"joint {part.joint}"))
        columns.append(_column(m, True, d2, a2, move.values[0]))
    elif move.letter == "Q":
        part.turn = vec.of_quaternion(move.values)
        signs = [1 if v.is_Symbol else -1 for v in move.values]
        letters = [s * v for s, v in zip(signs, move.values, strict=True)]
        for axis, row in zip(EYE, vec.rates_of_quaternion(move.values), strict=True):
            by = {q: s * c for q, s, c in zip(letters, signs, row, strict=True)}
            columns.append(Column(True, axis, a2, by))
    elif move.letter in "TF":
        part.turn = _level(d1, d2, part.joint)
    part.offset = vec.less(a1, vec.times(part.turn, a2))
    if move.letter in "CT":
        part.offset = vec.add(part.offset, vec.scaled(move.values[-1], d1))
        columns.append(_column(m, False, d2, NONE, move.values[-1]))
    part.columns = tuple(columns)
    return part


def _level(d1: Vector, d2: Vector, name: str) -> vec.Matrix:
    """How a body stands whose axis lies on another: turned about z where both lie in x and y."""
    if d1 == NONE or d1 == d2:
        return EYE
    if d1[2] == 0 and d2[2] == 0:
        return vec.turned(EYE[2], vec.dot(d1, d2), vec.cross(d2, d1)[2])
    return vec.onto(d2, d1, f"joint {name}")


def _column(m: Declaration, turns: bool, axis: Vector, at: Vector, value: Expr) -> Column:
    by = {q: slope for q in m.q if (slope := m.tape.diff(value, q)) != 0}
    if not by:
        refuse(f"a freedom = {value} moves with no coordinate; there are {', '.join(map(str, m.q)) or 'none'}")
    return Column(turns, axis, at, by, curvature(m, value) if any(c.free_symbols for c in by.values()) else O)


def rows_of(joint: Joint) -> dict[str, ClosureRow]:
    """The rows of a joint that closes a loop, by the names of its constraints."""
    first, second = joint.sides
    if joint.kind == "screw":
        refuse(f"the screw {joint.name!r} closes a loop, which does not know its turns; give it turns=, so that it "
               "hangs a body, and let another joint close", joint.where)  # fmt: skip
    if joint.kind == "strut":
        return {joint.name: Distance(first, second, joint.length)}
    rows: dict[str, ClosureRow] = {}
    letters = KINDS[joint.kind].rows
    n, b = vec.normals(first.axis) if first.axis != NONE else (NONE, NONE)
    level = _level(first.axis, second.axis, joint.name) if set("rst") & set(letters) else EYE
    seen = [vec.back(level, e) for e in EYE]  # axes of the first in those of the second
    directions = {"n": n, "b": b, "d": first.axis}
    squares = {
        "u": (n, second.axis), "v": (b, second.axis), "w": (first.axis, second.axis),
        "r": (EYE[0], seen[1]), "s": (EYE[1], seen[2]), "t": (EYE[2], seen[0]),
    }  # fmt: skip
    for letter in letters:
        if letter in "xyz":
            rows[f"{letter}_{joint.name}"] = Meet(first, second, "xyz".index(letter))
        elif letter in directions:
            rows[f"{letter}_{joint.name}"] = AlongLine(first, second, directions[letter])
        else:
            rows[f"t{letter}_{joint.name}"] = Square(first, second, *squares[letter])
    return rows
