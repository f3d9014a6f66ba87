"""Equations that say of one part what another says of its twin: x_2 is x_1 with the letters of the other part.

Two formulas of one shape, whose letters have another index, differ in what the letters of one are in the other. Where
they differ in one thing more, a function, an operator or a letter that is elsewhere another, one of them has a slip.
"""

import ast
import re
from collections import Counter, defaultdict
from dataclasses import dataclass, field

from mechsym.audit.judge.world import World
from mechsym.audit.read.said import Said
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


def twin_slip(world: World, order: int) -> tuple[Node, int] | None:
    """What an equation would be if it were as its twin, and the twin's place; None where it has none, or is as that."""
    said = world.paper.said[order]
    own = _left(said)
    for place, other in enumerate(world.paper.said) if own is not None else ():
        its = _left(other)
        if own is None or its is None or its[0] != own[0] or its[1] == own[1] or other.inline:
            continue
        right = _between(world, world.plain(other.sides[1]), world.plain(said.sides[1]))
        if right is not None:
            return right, place
    return None


def _left(said: Said) -> tuple[str, str] | None:
    if len(said.sides) != 2 or not isinstance(said.sides[0], ast.Name):
        return None
    match = _INDEXED.fullmatch(said.sides[0].id)
    return (match[1], match[2]) if match else None


def _between(world: World, first: Node, second: Node) -> Node | None:
    if sum(isinstance(n, ast.BinOp | ast.Call) for _, n in walk(first)) < _HEAVY:
        return None
    beside = _Beside()
    beside.add(first, second)
    meant = {letter: Counter(ast.dump(two) for _, two in pairs) for letter, pairs in beside.meant.items()}
    torn = [letter for letter, seen in meant.items() if len(seen) > 1]
    if len(torn) + len(beside.other) != 1 or all(next(iter(seen)) == ast.dump(name(k)) for k, seen in meant.items()):
        return None
    targets = {letter: pairs[0][1] for letter, pairs in beside.meant.items()}
    if torn:
        if len(meant[torn[0]]) > 2:
            return None
        known = _elsewhere(world, torn[0])
        usual = [two for _, two in beside.meant[torn[0]] if ast.dump(two) in known]
        if not usual:
            return None
        targets[torn[0]] = usual[0]
    return substitute(first, lambda node: targets.get(node.id) if isinstance(node, ast.Name) else None)


def _elsewhere(world: World, letter: str) -> set[str]:
    # what a letter is in the other pairs of twins, where it is one thing
    known: Counter[str] = Counter()
    for one in world.paper.said:
        for two in world.paper.said:
            left, right = _left(one), _left(two)
            if left and right and left[0] == right[0] and left[1] < right[1]:
                beside = _Beside()
                beside.add(world.plain(one.sides[1]), world.plain(two.sides[1]))
                seen = {ast.dump(target) for _, target in beside.meant.get(letter, ())}
                if len(seen) == 1:
                    known.update(seen)
    return set(known)
