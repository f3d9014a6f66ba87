r"""Rows that close loops in space: what vanishes, its slopes by the coordinates, its bias, and what it bears.

A row looks from the first body at the second: directions n are fixed in the first, P is the point of the second.

.. math:: g = n \cdot (P - P_1), \qquad \dot g = n \cdot (v_P - v_{1P}), \qquad
          \ddot g = n \cdot (a_P - a_{1P} - 2\,\omega_1 \times v_{rel})

with the velocity and acceleration of the point of the first body that lies at P.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

from sympy import Expr, Symbol

from mechsym.derive import vectors as vec
from mechsym.derive.space_tree import Column, Tree, TreeBody
from mechsym.derive.vectors import EYE, HALF, NONE, O, Vector

#: On a body: force, moment, and the place of the frame where the force acts
Push = tuple[TreeBody, Vector, Vector, Vector]


class ClosureRow(Protocol):
    """One condition that closes a loop."""

    def value(self, tree: Tree) -> Expr:
        """What vanishes."""

    def slopes(self, tree: Tree) -> dict[Symbol, Expr]:
        """Its derivatives by the coordinates."""

    def bias(self, tree: Tree) -> Expr:
        """Its second derivative in time where no coordinate accelerates."""

    def pushes(self, tree: Tree, mu: Expr) -> list[Push]:
        """What the bodies bear of its multiplier."""


@dataclass(eq=False)
class JointSide:
    """A point of a body, and perhaps a direction."""

    part: TreeBody
    at: Vector
    axis: Vector = NONE


def _between(first: TreeBody, second: TreeBody) -> list[tuple[int, TreeBody, Column]]:
    """Freedoms that move the second body against the first: sign, body, freedom."""
    common = set(first.path) & set(second.path)
    sides = ((1, second.path), (-1, first.path))
    return [(sign, p, c) for sign, path in sides for p in path if p not in common for c in p.columns]


def _collected(terms: list[tuple[int, Column, Expr]]) -> dict[Symbol, Expr]:
    collected: dict[Symbol, Expr] = {}
    for sign, column, value in terms:
        for q, c in column.by.items():
            collected[q] = collected.get(q, O) + sign * c * value
    return collected


@dataclass(eq=False)
class AlongLine:
    """The points of two bodies meet along a direction of the first."""

    first: JointSide
    second: JointSide
    n: Vector

    def _places(self, tree: Tree) -> tuple[Vector, Vector, Vector]:
        P, at = tree.place(self.second.part, self.second.at), tree.place(self.first.part, self.first.at)
        return tree.out(self.first.part, self.n), P, tree.tape.vector("gap", vec.less(P, at))

    def value(self, tree: Tree) -> Expr:
        """What vanishes."""
        n, _, gap = self._places(tree)
        return vec.dot(n, gap)

    def slopes(self, tree: Tree) -> dict[Symbol, Expr]:
        """Its derivatives by the coordinates."""
        n, P, _ = self._places(tree)
        terms = []
        for sign, part, column in _between(self.first.part, self.second.part):
            way = tree.tape.vector(f"s_{part.name}", tree.column(part, column, P)[1])
            terms.append((sign, column, tree.tape.step(f"s_{part.name}_n", vec.dot(n, way))))
        return _collected(terms)

    def bias(self, tree: Tree) -> Expr:
        """Its second derivative in time where no coordinate accelerates."""
        n, _, gap = self._places(tree)
        relative = tree.acceleration(self.second.part, self.second.at, False)
        if self.first.part.path:
            at = tree.acceleration(self.first.part, self.first.at, False)
            w = tree.spinning(self.first.part)
            alpha = tree.out(self.first.part, tree.accelerated(self.first.part, False)[0])
            swept = tree.tape.vector("swept", vec.cross(w, gap))
            here = tree.velocity(self.first.part, self.first.at)
            way = vec.less(tree.velocity(self.second.part, self.second.at), vec.add(here, swept))
            moved = tree.tape.vector("way", way)
            carried = vec.add(at, vec.cross(alpha, gap), vec.cross(w, vec.add(swept, vec.scaled(2, moved))))
            relative = tree.tape.vector("relative", vec.less(relative, carried))
        return vec.dot(n, relative)

    def pushes(self, tree: Tree, mu: Expr) -> list[Push]:
        """What the bodies bear of its multiplier."""
        n, P, _ = self._places(tree)
        force = tree.tape.vector("push", vec.scaled(mu, n))
        return [(self.second.part, force, NONE, P), (self.first.part, vec.scaled(-1, force), NONE, P)]


@dataclass(eq=False)
class Meet:
    """The points of two bodies meet along an axis of the frame."""

    first: JointSide
    second: JointSide
    axis: int

    def value(self, tree: Tree) -> Expr:
        """What vanishes."""
        P, at = (tree.place(s.part, s.at)[self.axis] for s in (self.second, self.first))
        return P - at

    def slopes(self, tree: Tree) -> dict[Symbol, Expr]:
        """Its derivatives by the coordinates."""
        return _collected(_ways(tree, self.first, self.second, lambda part, way: way[self.axis]))

    def bias(self, tree: Tree) -> Expr:
        """Its second derivative in time where no coordinate accelerates."""
        a2, a1 = (tree.acceleration(s.part, s.at, False)[self.axis] for s in (self.second, self.first))
        return a2 - a1

    def pushes(self, tree: Tree, mu: Expr) -> list[Push]:
        """What the bodies bear of its multiplier."""
        force = vec.scaled(mu, EYE[self.axis])
        P, at = (tree.place(s.part, s.at) for s in (self.second, self.first))
        return [(self.second.part, force, NONE, P), (self.first.part, vec.scaled(-1, force), NONE, at)]


def _ways(
    tree: Tree, first: JointSide, second: JointSide, seen: Callable[[TreeBody, Vector], Expr]
) -> list[tuple[int, Column, Expr]]:
    """What is seen of the way of each point by every freedom before it."""
    terms = []
    for sign, side in ((1, second), (-1, first)):
        place = tree.place(side.part, side.at)
        for part in side.part.path:
            for column in part.columns:
                way = tree.tape.vector(f"s_{part.name}", tree.column(part, column, place)[1])
                terms.append((sign, column, seen(part, way)))
    return terms


@dataclass(eq=False)
class Square:
    """A direction of the second body stays square to one of the first."""

    first: JointSide
    second: JointSide
    n: Vector
    d: Vector

    def _directions(self, tree: Tree) -> tuple[Vector, Vector, Vector]:
        n, d = tree.out(self.first.part, self.n), tree.out(self.second.part, self.d)
        return n, d, tree.tape.vector("square", vec.cross(d, n))

    def value(self, tree: Tree) -> Expr:
        """What vanishes."""
        n, d, _ = self._directions(tree)
        return vec.dot(n, d)

    def slopes(self, tree: Tree) -> dict[Symbol, Expr]:
        """Its derivatives by the coordinates."""
        across, terms = self._directions(tree)[2], []
        for sign, part, column in _between(self.first.part, self.second.part):
            if column.turns:
                axis = tree.out(part, column.axis)
                terms.append((sign, column, tree.tape.step(f"s_{part.name}_t", vec.dot(axis, across))))
        return _collected(terms)

    def bias(self, tree: Tree) -> Expr:
        """Its second derivative in time where no coordinate accelerates."""
        (_, d, across), (one, two) = self._directions(tree), (self.first.part, self.second.part)
        w1, w2 = tree.spinning(one), tree.spinning(two)
        alpha = [tree.out(part, tree.accelerated(part, False)[0]) for part in (one, two)]
        w = tree.tape.vector("wr", vec.less(w2, w1))
        spun = tree.tape.vector("dwr", vec.less(vec.less(alpha[1], alpha[0]), vec.cross(w1, w2)))
        n = tree.out(one, self.n)
        return vec.dot(spun, across) + vec.dot(w, d) * vec.dot(w, n) - vec.dot(w, w) * vec.dot(d, n)

    def pushes(self, tree: Tree, mu: Expr) -> list[Push]:
        """What the bodies bear of its multiplier."""
        across, P = self._directions(tree)[2], tree.place(self.second.part, self.second.at)
        moment = tree.tape.vector("twist", vec.scaled(mu, across))
        return [(self.second.part, NONE, moment, P), (self.first.part, NONE, vec.scaled(-1, moment), P)]


@dataclass(eq=False)
class Distance:
    """Two points keep their distance, as a rod without mass holds them; its force is positive where it is pressed."""

    first: JointSide
    second: JointSide
    length: Expr

    def _line(self, tree: Tree) -> tuple[Vector, Vector, Vector]:
        P, at = tree.place(self.second.part, self.second.at), tree.place(self.first.part, self.first.at)
        gap = tree.tape.vector("gap", vec.less(P, at))
        return at, P, tree.tape.vector("line", vec.scaled(1 / self.length, gap))

    def value(self, tree: Tree) -> Expr:
        """What vanishes."""
        line = self._line(tree)[2]
        return HALF * self.length * (vec.dot(line, line) - 1)

    def slopes(self, tree: Tree) -> dict[Symbol, Expr]:
        """Its derivatives by the coordinates."""
        line = self._line(tree)[2]
        along = lambda part, way: tree.tape.step(f"s_{part.name}_l", vec.dot(line, way))  # noqa: E731
        return _collected(_ways(tree, self.first, self.second, along))

    def bias(self, tree: Tree) -> Expr:
        """Its second derivative in time where no coordinate accelerates."""
        line = self._line(tree)[2]
        a1, a2 = (tree.acceleration(s.part, s.at, False) for s in (self.first, self.second))
        v1, v2 = (tree.velocity(s.part, s.at) for s in (self.first, self.second))
        v = tree.tape.vector("way", vec.less(v2, v1))
        return vec.dot(line, vec.less(a2, a1)) + vec.dot(v, v) / self.length

    def pushes(self, tree: Tree, mu: Expr) -> list[Push]:
        """What the bodies bear of its multiplier."""
        at, P, line = self._line(tree)
        force = tree.tape.vector("push", vec.scaled(mu, line))
        return [(self.second.part, force, NONE, P), (self.first.part, vec.scaled(-1, force), NONE, at)]


@dataclass(eq=False)
class Norm:
    """A quaternion keeps its length 1; it bears nothing."""

    e: tuple[Symbol, ...]
    rates: tuple[Symbol, ...]

    def value(self, tree: Tree) -> Expr:
        """What vanishes."""
        return HALF * (sum((x**2 for x in self.e), O) - 1)

    def slopes(self, tree: Tree) -> dict[Symbol, Expr]:
        """Its derivatives by the coordinates."""
        return dict(zip(self.e, self.e, strict=True))

    def bias(self, tree: Tree) -> Expr:
        """Its second derivative in time where no coordinate accelerates."""
        return sum((x**2 for x in self.rates), O)

    def pushes(self, tree: Tree, mu: Expr) -> list[Push]:
        """Nothing."""
        return []
