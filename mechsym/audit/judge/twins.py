"""Equations that say of one part what another says of its twin: x_2 is x_1 with the letters of the other part.

Two formulas of one shape, whose letters have another index, differ in what the letters of one are in the other. Where
they differ in one thing more, a function, an operator or a letter that is elsewhere another, one of them has a slip. So
it is where a letter has the other sign, theta + psi and theta - psi, and of projections on two axes, sines for cosines.
"""

import ast
import itertools
import re
from collections import Counter, defaultdict
from collections.abc import Collection
from dataclasses import dataclass, field
from functools import partial

from mechsym.audit.judge.world import World
from mechsym.audit.read.tree import (
    Node,
    argument_of,
    call,
    function_of,
    is_operation,
    letters,
    name,
    negative,
    number,
    substitute,
    summands,
    walk,
    without_double_signs,
)

_INDEXED = re.compile(r"([A-Za-z]+?)(\d)")
_ONE_INDEX = re.compile(r"(?P<of>\\?[A-Za-z]+)_\{?\s*(?P<index>\w)\s*\}?")
_AXES = re.compile(r"(.*?)([xX])(.*)")
_KIN = (ast.Add, ast.Sub), (ast.Mult, ast.Div)
_OTHER = {"sin": "cos", "cos": "sin"}
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
                if not any(is_operation(one, *kin) and is_operation(two, *kin) for kin in _KIN):
                    return
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

    axes: list[tuple[int, int]] = field(init=False)  #: Places of projections on two axes, both ways

    def __post_init__(self) -> None:
        """Find them."""
        self.places, self.axes = defaultdict(dict), []
        lefts: dict[str, int] = {}
        for place, said in enumerate(self.world.paper.said):
            left = said.sides[0] if len(said.sides) == 2 and not said.claim else None
            if isinstance(left, ast.Name) and (match := _INDEXED.fullmatch(left.id)):
                self.places[match[1]][place] = match[2]
            if isinstance(left, ast.Name) and not said.inline:
                lefts.setdefault(left.id, place)
        for letter, place in lefts.items():
            if axis := _AXES.fullmatch(letter):
                other = lefts.get(f"{axis[1]}{'y' if axis[2] == 'x' else 'Y'}{axis[3]}")
                self.axes += [] if other is None else [(place, other), (other, place)]

    def slip(self, order: int) -> tuple[Node, int] | None:
        """What an equation would be if it were as its twin, and the twin's place; None where it has none, or is so."""
        for alike in self.places.values():
            for place, index in alike.items() if order in alike else ():
                if index != alike[order] and not self.world.paper.said[place].inline:
                    right = self._as(place, order)
                    right = self._turned(place, order) if right is None else right
                    if right is not None:
                        return right, place
        for place, other in self.axes:
            if other == order and (right := self._across(place, order)) is not None:
                return right, place
        return None

    def other_left(self, order: int) -> tuple[str, int] | None:
        """What a left side stands for that the row before it has, and its place: m_R = .., m_R = .. for m_R and m_L."""
        before, here = self.world.paper.said[max(order - 1, 0)], self.world.paper.said[order]
        if not all(len(one.sides) == 2 and isinstance(one.sides[0], ast.Name) for one in (before, here)):
            return None
        (letter,), index = letters(here.sides[0]), _ONE_INDEX.fullmatch(here.spelled.get(letters(here.sides[0])[0], ""))
        in_one = letters(before.sides[0]) == (letter,) and before.shown.opens == here.shown.opens
        if not (order and index and in_one and self._is_twin(order - 1, order)):
            return None
        lefts = {one.sides[0].id for one in self.world.paper.said if one.sides and isinstance(one.sides[0], ast.Name)}
        named = {*lefts, *self.world.paper.named}
        spelled = {n: how for one in self.world.paper.said for n, how in one.spelled.items() if n not in named}
        others = [
            match for how in spelled.values() if (match := _ONE_INDEX.fullmatch(how)) and match["of"] == index["of"]
        ]
        meant = [match[0] for match in others if match["index"].isdigit() == index["index"].isdigit()]
        return (meant[0], order - 1) if len(meant) == 1 else None

    def _is_twin(self, first: int, second: int) -> bool:
        # of one shape, with another sign or another letter somewhere
        one, two = self._side(first), self._side(second)
        beside = _beside(one, two)
        changed = [(a, b) for pairs in beside.meant.values() for a, b in pairs if ast.dump(a) != ast.dump(b)]
        return _weight(one) > 1 and 0 < len(beside.other) + len(changed) < 3

    def _as(self, first: int, second: int) -> Node | None:
        tree = self._side(first)
        if _weight(tree) < _HEAVY:
            return None
        beside = self._beside(first, second)
        meant = {letter: Counter(ast.dump(two) for _, two in pairs) for letter, pairs in beside.meant.items()}
        torn = [letter for letter, seen in meant.items() if len(seen) > 1]
        same = all(next(iter(seen)) == ast.dump(name(letter)) for letter, seen in meant.items())
        if len(torn) + len(beside.other) != 1 or same or any(len(meant[letter]) > 2 for letter in torn):
            return None
        if not all(_akin(*pair) for pair in beside.other):
            return None
        targets = {letter: pairs[0][1] for letter, pairs in beside.meant.items()}
        for letter in torn:
            known = self._elsewhere(letter) or self._written(meant[letter], (first, second))
            usual = [two for _, two in beside.meant[letter] if ast.dump(two) in known]
            if not usual:
                return None
            targets[letter] = usual[0]
        return substitute(tree, lambda node: targets.get(node.id) if isinstance(node, ast.Name) else None)

    def _turned(self, first: int, second: int) -> Node | None:
        # the twin has a letter with the other sign: theta + psi, and theta - psi
        plain = self._side(first)
        if len(self._beside(first, second).other) < 2 or _weight(plain) < _HEAVY:
            return None
        inside = {id(n) for _, f in walk(plain) for _, n in walk(argument_of(f, *_OTHER) or number(0))}
        outside = {n.id for _, n in walk(plain) if isinstance(n, ast.Name) and id(n) not in inside}
        for letter in sorted({*letters(plain)} - outside):
            tree = without_double_signs(substitute(plain, partial(_with_other_sign, letter)))
            if (right := _but_one(tree, self._side(second))) is not None:
                return right
        return None

    def _across(self, first: int, second: int) -> Node | None:
        # the projection on the other axis has sines for cosines
        tree = substitute(self._side(first), _exchanged)
        printed = self._side(second)
        right = _but_one(tree, printed)
        if right is None:
            return None
        (wanted, there), *_ = _beside(tree, printed).other
        swapped = [n for _, n in walk(tree) if function_of(n) in _OTHER]
        if function_of(wanted) in _OTHER and isinstance(there, ast.Call):  # F cos(a) cos(b), F sin(a) cos(b) in space
            return right if len(swapped) > 1 and all(_circular(term) == 1 for term in summands(tree)) else None
        inside = any(wanted is n for f in swapped for _, n in walk(argument_of(f, *_OTHER) or f))
        sign = is_operation(wanted, *_KIN[0]) and is_operation(there, *_KIN[0])
        return right if inside and len(swapped) > (1 if sign else 2) else None

    def _elsewhere(self, letter: str) -> set[str]:
        # what a letter is in the pairs of twins where it is one thing
        known = set()
        for alike in self.places.values():
            for one, two in itertools.permutations(alike, 2):
                if alike[one] < alike[two]:
                    seen = {ast.dump(target) for _, target in self._beside(one, two).meant.get(letter, ())}
                    known |= seen if len(seen) == 1 else set()
        return known

    def _written(self, seen: Collection[str], places: tuple[int, int]) -> set[str]:
        # of two parts that stand for one letter the one that other equations have, too
        others = [said for place, said in enumerate(self.world.paper.said) if place not in places]
        sides = [self.world.plain(side) for said in others for side in said.sides]
        parts = {ast.dump(n) for side in sides for _, n in walk(side) if isinstance(n, ast.BinOp)}
        used = parts & {*seen}
        sums = all(part.startswith("BinOp") for part in seen)
        return used if sums and len(used) == 1 else set()

    def _beside(self, first: int, second: int) -> _Beside:
        return _beside(self._side(first), self._side(second))

    def _side(self, place: int) -> Node:
        return self.world.plain(self.world.paper.said[place].sides[1])


def _beside(one: Node, two: Node) -> _Beside:
    beside = _Beside()
    beside.add(one, two)
    return beside


def _but_one(wanted: Node, printed: Node) -> Node | None:
    """What is wanted, where something else is printed in one place, and the letters are the same or of the twin."""
    beside = _beside(wanted, printed)
    meant = {letter: {ast.dump(two) for _, two in pairs} for letter, pairs in beside.meant.items()}
    if len(beside.other) != 1 or any(len(seen) > 1 for seen in meant.values()):
        return None
    targets = {letter: pairs[0][1] for letter, pairs in beside.meant.items()}
    if any(not isinstance(two, ast.Name) or two.id[:1] != letter[:1] for letter, two in targets.items()):
        return None
    return substitute(wanted, lambda node: targets.get(node.id) if isinstance(node, ast.Name) else None)


def _with_other_sign(letter: str, node: Node) -> Node | None:
    return negative(node) if isinstance(node, ast.Name) and node.id == letter else None


def _akin(one: Node, two: Node) -> bool:
    # of one kind, or a part that has lost or gained something
    return type(one) is type(two) or ast.dump(one) in ast.dump(two) or ast.dump(two) in ast.dump(one)


def _weight(tree: Node) -> int:
    return sum(isinstance(n, ast.BinOp | ast.Call) for _, n in walk(tree))


def _exchanged(node: Node) -> Node | None:
    # arguments stay as they are
    argument = argument_of(node, *_OTHER)
    return None if argument is None else call(_OTHER[str(function_of(node))], argument)


def _circular(tree: Node) -> int:
    return sum(function_of(n) in _OTHER for _, n in walk(tree))
