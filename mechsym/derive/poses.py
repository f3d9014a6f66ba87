"""The side on which a loop closes, from one rough pose of the assembled mechanism, as it is read off a sketch.

    m.pose(phi=0.3, rod=1.1, rocker="110 deg")       angles of links and coordinates, places (x, y) of link origins

A dyad with two solutions has one root on the tape. Both signs are evaluated at the pose and the nearer one is taken.
Letters that have a default value take it; for the others those lengths count with which the pose closes best. So a pose
that says too little is refused, and so is one that both solutions or none of them fit.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from sympy import Expr, Pow, Rational, Symbol, lambdify

from mechsym.derive.linkage import Joint, Link, Linkage
from mechsym.derive.refuse import refuse

_TRIED = 20_000  # sets of lengths where the declaration gives none
_BEST = 200  # of them are asked for the side
_AGREED = 0.95  # of these have to say the same one
_BOTH = 0.1  # of the way between both solutions, within which a pose fits both
_ROUGH = np.pi / 4  # rad, or this share of a length: what a pose may be off

Values = dict[Symbol, np.ndarray]


@dataclass(frozen=True)
class Side:
    """How a loop was closed."""

    joint: str
    links: tuple[str, ...]
    branch: int
    by: str  #: What chose it: `branch`, `pose`, or nothing
    pins: bool  #: Whether pins alone close it, so that neither side is the usual one
    condition: float | None = None  #: In the pose: 1 where its links stand across, 0 in a dead point

    def __str__(self) -> str:
        nobody = "chosen by nobody: say pose= or branch= if it is the other"
        why = {"branch": "as declared", "pose": "by the pose"}.get(self.by, nobody)
        near = "" if self.condition is None else f"; condition {self.condition:.2g} in the pose, 0 in a dead point"
        closing = f"{' and '.join(self.links)} {'close' if len(self.links) > 1 else 'closes'}"
        return f"{closing} at the joint {self.joint}, branch = {self.branch} ({why}{near})"


def choose(m: Linkage, joints: Sequence[Joint], links: tuple[Link, ...], entries: Sequence[Symbol]) -> Side | None:
    """Set the side of the links that were just placed; nothing where there is one solution.

    joints: of the dyad, the inner one first; entries: what their closing put on the tape.
    """
    joint, branch = joints[0], next((j.branch for j in joints if j.branch), 0)
    roots = [name for name in entries if _roots(m, m.tape.entries[name])]
    m.roots += [p for name in roots for p in _roots(m, m.tape.entries[name])]
    names, pins = tuple(link.name for link in links), all(j.kind == "pin" for j in joints)
    if not roots:
        return None
    if branch:
        return Side(joint.name, names, branch, "branch", pins)
    posed = [link for link in links if link.name in m.poses]
    if not posed:
        return Side(joint.name, names, 1, "", pins)
    (root,) = roots
    flipped = m.tape.entries[root].xreplace({p: -p for p in _roots(m, m.tape.entries[root])})
    earlier = [k for k in m.links if k.placed and k.name in m.poses and not k.given and k not in links]
    before = _off(m, earlier, _placed(m, earlier, {}))
    by_sign = {1: _placed(m, posed, {}), -1: _placed(m, posed, {root: flipped})}
    side = _nearer(m, joint, posed, by_sign, before)
    if side == -1:
        m.tape.entries[root] = flipped
    return Side(joint.name, names, side, "pose", pins, _condition(m, root))


def _condition(m: Linkage, name: Symbol) -> float | None:
    """How far a loop is from its dead point in the pose: its root by the most that it can be; none without sizes."""
    (root,) = {p.base for p in _roots(m, m.tape.entries[name])}
    values = _letters(m, [root])
    for known in m.tape.needed([root]):
        values[known] = _number(m.tape.entries[known], values)
    terms = np.array([_number(term, values) for term in root.as_ordered_terms()])
    if terms.shape[1] > 1:
        return None
    return float(np.sqrt(max(terms.sum(), 0.0) / np.maximum(terms, 0.0).sum()))


def _roots(m: Linkage, value: Expr) -> list[Pow]:
    """Square roots that move with the mechanism."""
    moving = {*m.tape.entries, *m.tape.variables}
    return [p for p in value.atoms(Pow) if p.exp == Rational(1, 2) and p.free_symbols & moving]


def _placed(m: Linkage, links: list[Link], instead: Mapping[Symbol, Expr]) -> list[np.ndarray]:
    """Angles of links [rad] and, where the pose has their places, those [m]: one row of numbers each."""
    wanted: list[Expr] = []
    for link in links:
        given = m.poses[link.name]
        wanted += [link.turns] if isinstance(given, float) else [*(link.origin or ())]
    values = _letters(m, wanted)
    for name in m.tape.needed(wanted):
        values[name] = _number(instead.get(name, m.tape.entries[name]), values)
    return [_number(expression, values) for expression in wanted]


def _number(expression: Expr, values: Values) -> np.ndarray:
    letters = sorted(expression.free_symbols, key=str)
    with np.errstate(all="ignore"):
        return np.asarray(lambdify(letters, expression, "numpy")(*(values[s] for s in letters)), dtype=float)


def _letters(m: Linkage, wanted: list[Expr]) -> Values:
    """Numbers of all letters at the pose: defaults, else sizes from a wide range, the same at each call."""
    named = [m.tape.entries[name] for name in m.tape.needed(wanted)]
    free = set().union(*(e.free_symbols for e in [*wanted, *named]))
    values: Values = {s: np.zeros(1) for s in m.joint_list}
    for q in (q for q in m.q if q in free):
        if q.name not in m.poses:
            refuse(f"the pose leaves {q} open; say m.pose({q}=..), in {m.units[q.name]}")
        values[q] = np.full(1, m.poses[q.name])
    random = np.random.default_rng(0)
    size = max((abs(c) for place in m.poses.values() if isinstance(place, tuple) for c in place), default=1.0)
    for letter in m.parameter_list:
        described = m.ranges.get(letter.name, {})
        drawn = size * np.exp(random.uniform(-2, 2, _TRIED))
        if letter not in free:
            continue
        if m.units[letter.name] in ("rad", "-"):
            drawn = random.uniform(-np.pi, np.pi, _TRIED)
        low = max((described[k] for k in ("above", "low") if k in described), default=-np.inf)
        high = min((described[k] for k in ("below", "high") if k in described), default=np.inf)
        values[letter] = np.full(1, described["default"]) if "default" in described else np.clip(drawn, low, high)
    return values


def _off(m: Linkage, links: list[Link], rows: list[np.ndarray], others: list[np.ndarray] | None = None) -> np.ndarray:
    """How far links are from the pose, or from other angles and places [rad, or the share of a length]."""
    square, left = np.zeros(1), list(rows)
    goals = list(others) if others else [np.full(1, g) for k in links for g in np.ravel(m.poses[k.name])]
    for link in links:
        given = m.poses[link.name]
        if isinstance(given, float):
            turn = left.pop(0) - goals.pop(0)
            square = square + np.square(np.mod(turn + np.pi, 2 * np.pi) - np.pi)
        else:
            size = max(map(abs, given)) or 1.0
            square = square + sum(np.square((left.pop(0) - goals.pop(0)) / size) for _ in given)
    return np.sqrt(square)


def _nearer(
    m: Linkage, joint: Joint, links: list[Link], by_sign: dict[int, list[np.ndarray]], before: np.ndarray
) -> int:
    """The sign whose solution is nearer to the pose; before: how far links that were placed earlier are from it."""
    away = {sign: _off(m, links, rows) for sign, rows in by_sign.items()}
    between = _off(m, links, by_sign[1], by_sign[-1])
    rank = np.hypot(np.minimum(away[1], away[-1]), before)
    best = [i for i in np.argsort(rank)[:_BEST] if np.isfinite(rank[i])]
    if not best:
        refuse(f"the loop does not close at the joint {joint.name!r} in the pose; check the pose and the lengths")
    nearest = {sign: [row[best[0] if len(row) > 1 else 0] for row in rows] for sign, rows in by_sign.items()}
    named = " and ".join(link.name for link in links)
    choices = " or ".join(f"{_in_words(m, links, row)} (branch = {sign})" for sign, row in nearest.items())
    way_out = f"{named} at {choices}; say nearer angles of them, or branch= at the joint"
    if rank[best[0]] > _ROUGH * np.sqrt(len(links)):
        refuse(f"the pose fits no solution at the joint {joint.name!r}: {way_out}")
    share = np.mean(away[1][best] < away[-1][best])
    if max(share, 1 - share) < _AGREED:
        refuse(f"the side of the joint {joint.name!r} hangs on lengths; give their letters a default=, or say branch=")
    if abs(away[1][best[0]] - away[-1][best[0]]) <= _BOTH * between[best[0]]:
        refuse(f"the pose fits both solutions at the joint {joint.name!r}: {way_out}")
    return 1 if share > 0.5 else -1


def _in_words(m: Linkage, links: list[Link], row: list[np.ndarray]) -> str:
    """Angles in degrees and places, in the order of the links."""
    left, words = list(row), []
    for link in links:
        if isinstance(m.poses[link.name], float):
            words.append(f"{np.rad2deg(np.mod(left.pop(0) + np.pi, 2 * np.pi) - np.pi):.3g} deg")
        else:
            words.append(f"({left.pop(0):.3g}, {left.pop(0):.3g}) m")
    return ", ".join(words)
