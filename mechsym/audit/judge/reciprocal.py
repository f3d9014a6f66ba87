"""Linear equations of motion that stand together: what one body does to another comes back to it."""

import ast
from collections.abc import Iterator
from itertools import combinations

from mechsym.audit.judge.sampled import States, alike, states
from mechsym.audit.judge.world import World
from mechsym.audit.read.said import Said
from mechsym.audit.read.tree import Node, binary, is_operation, letters, negative
from mechsym.audit.theory.tape import is_zero, minus, slope_by

_OTHER: dict[type[ast.operator], type[ast.operator]] = {ast.Add: ast.Sub, ast.Sub: ast.Add}


def mended(world: World, order: int) -> Node | None:
    """The left side of an equation of motion with the one sign that makes its group reciprocal; None where it is."""
    group = _group(world, order)
    if len(group) < 2 or order not in group:
        return None
    at = states(world.bare)
    whole = {place: minus(*world.paper.said[place].sides) for place in group}
    if _is_reciprocal(at, group, whole) is not False:
        return None
    right = []
    for place in group:
        said = world.paper.said[place]
        for left in _turned(said.sides[0]):
            if _is_reciprocal(at, group, whole | {place: minus(left, said.sides[1])}):
                right.append((place, left))
    return right[0][1] if len(right) == 1 and right[0][0] == order else None


def _group(world: World, order: int) -> dict[int, str]:
    # equations one behind the other, each with one acceleration of its own
    said = world.paper.said
    group: dict[int, str] = {}
    for places in (range(order, -1, -1), range(order + 1, len(said))):
        for place in places:
            if said[place].inline:
                continue
            own = _acceleration(said[place])
            if not own or said[place].section != said[order].section or own in group.values():
                break
            group[place] = own
    return group


def _acceleration(said: Said) -> str:
    rates = {n for side in said.sides for n in letters(side) if n.endswith("dd") and len(n) > 2}
    return rates.pop().removesuffix("dd") if len(rates) == 1 and len(said.sides) == 2 else ""


def _is_reciprocal(at: States, group: dict[int, str], whole: dict[int, Node]) -> bool | None:
    # None where nothing can be said: not linear, or one equation is divided by something
    moving = set(group.values())
    rows = {q: {p: slope_by(whole[place], p) for p in moving} for place, q in group.items()}
    masses = [slope_by(whole[place], f"{q}dd") for place, q in group.items()]
    every = [*masses, *(entry for row in rows.values() for entry in row.values())]
    if any(not moving.isdisjoint(letters(entry)) for entry in every) or any(map(is_zero, masses)):
        return None
    if not all((at.value(mass) > 0).all() for mass in masses):
        return None
    good = all((at.value(row[q]) > 0).all() for q, row in rows.items())
    for q, p in combinations(sorted(moving), 2):
        one, other = rows[q][p], rows[p][q]
        if is_zero(one) and is_zero(other):
            continue
        if alike(at, one, negative(other)):
            own = {*letters(rows[q][q]), *letters(rows[p][p])}
            if not {*letters(one)} <= own:
                return None  # cross-coupled, as by the oil of a bearing
            good = False
        elif not alike(at, one, other):
            return None
    return good


def _turned(tree: Node) -> Iterator[Node]:
    # the sum with the other sign of one of its terms
    if is_operation(tree, ast.Add, ast.Sub):
        yield binary(_OTHER[type(tree.op)], tree.left, tree.right)
        yield from (binary(type(tree.op), left, tree.right) for left in _turned(tree.left))
