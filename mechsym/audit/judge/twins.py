"""Equations that say of one part what another says of its twin: x_2 is x_1 with the letters of the other part.

Two formulas of one shape, whose letters have another index, differ in what the letters of one are in the other. Where
they differ in one thing more, a function, an operator or a letter that is elsewhere another, one of them has a slip.
"""

import ast
import itertools
import re
from collections import Counter, defaultdict
from dataclasses import dataclass, field

from mechsym.audit.judge.world import World
from mechsym.audit.read.tree import Node, name, substitute, walk

_INDEXED = re.compile(r"([A-Za-z]+?)(\d)")
_HEAVY = 5  # operations of formulas that are alike by more than chance


@dataclass
class _Beside:
    """What stands where in two formulas of one shape."""

    #: Of each letter of one, where it stands and what stands there in the other
    meant: dict[str, list[tuple[Node, Node]]] = field(default_factory=lambda: defaultdict(list))
    other: list[tuple[Node, Node]] = field(default_factory=list)  #: That differ in kind

    def add(self, one: Node, two: Node) -> None:
        """Put two formulas, or parts of them, beside each other."""
        if isinstance(one, ast.Name):
            self.meant[one.id].append((one, two))
        elif isinstance(one, ast.BinOp) and isinstance(two, ast.BinOp):
            if type(one.op) is not type(two.op):
                self.other.append((one, two))
            self.add(one.left, two.left)
            self.add(one.right, two.right)
        elif isinstance(one, ast.Call) and isinstance(two, ast.Call) and len(one.args) == len(two.args) == 1:
            if ast.dump(one.func) != ast.dump(two.func):
                self.other.append((one, two))
            self.add(one.args[0], two.args[0])
        elif isinstance(one, ast.UnaryOp) and isinstance(two, ast.UnaryOp):
            self.add(one.operand, two.operand)
        elif ast.dump(one) != ast.dump(two):
            self.other.append((one, two))


@dataclass
class Twins:
    """The equations of a text whose letters have an index."""

    world: World
    places: dict[str, dict[int, str]] = field(init=False)  #: Of each stem, place of the equation to its index

    def __post_init__(self) -> None:
        """Find them."""
        self.places = defaultdict(dict)
        for place, said in enumerate(self.world.paper.said):
            left = said.sides[0] if len(said.sides) == 2 else None
            if isinstance(left, ast.Name) and (match := _INDEXED.fullmatch(left.id)):
                self.places[match[1]][place] = match[2]

    def slip(self, order: int) -> tuple[Node, int] | None:
        """What an equation would be if it were as its twin, and the twin's place; None where it has none, or is so."""
        for alike in self.places.values():
            for place, index in alike.items() if order in alike else ():
                if index != alike[order] and not self.world.paper.said[place].inline:
                    right = self._as(place, order)
                    if right is not None:
                        return right, place
        return None

    def _as(self, first: int, second: int) -> Node | None:
        tree = self._side(first)
        if sum(isinstance(n, ast.BinOp | ast.Call) for _, n in walk(tree)) < _HEAVY:
            return None
        beside = self._beside(first, second)
        meant = {letter: Counter(ast.dump(two) for _, two in pairs) for letter, pairs in beside.meant.items()}
        torn = [letter for letter, seen in meant.items() if len(seen) > 1]
        same = all(next(iter(seen)) == ast.dump(name(letter)) for letter, seen in meant.items())
        if len(torn) + len(beside.other) != 1 or same or any(len(meant[letter]) > 2 for letter in torn):
            return None
        targets = {letter: pairs[0][1] for letter, pairs in beside.meant.items()}
        for letter in torn:
            known = self._elsewhere(letter)
            usual = [two for _, two in beside.meant[letter] if ast.dump(two) in known]
            if not usual:
                return None
            targets[letter] = usual[0]
        return substitute(tree, lambda node: targets.get(node.id) if isinstance(node, ast.Name) else None)

    def _elsewhere(self, letter: str) -> set[str]:
        # what a letter is in the pairs of twins where it is one thing
        known = set()
        for alike in self.places.values():
            for one, two in itertools.permutations(alike, 2):
                if alike[one] < alike[two]:
                    seen = {ast.dump(target) for _, target in self._beside(one, two).meant.get(letter, ())}
                    known |= seen if len(seen) == 1 else set()
        return known

    def _beside(self, first: int, second: int) -> _Beside:
        beside = _Beside()
        beside.add(self._side(first), self._side(second))
        return beside

    def _side(self, place: int) -> Node:
        return self.world.plain(self.world.paper.said[place].sides[1])
