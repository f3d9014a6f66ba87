"""A slip that has a home of its own: the root of a sum of squares where the squares of the sums are meant.

Where a text gives the direction of a resultant, `tan(phi) = sum(X)/sum(Y) = u/v`, it has the sums themselves: u and v.
"""

import ast
from collections.abc import Iterator, Sequence

from mechsym.audit.judge.sampled import alike, free, states
from mechsym.audit.judge.world import World
from mechsym.audit.read.said import Said
from mechsym.audit.read.tree import (
    Node,
    binary,
    call,
    function_of,
    is_operation,
    letters,
    name,
    number,
    substitute,
    value_of,
    walk,
)


def squares_of_sums(world: World, order: int, said: Said) -> Node | None:
    """The right form of a side that has the squares within the sum, where the text's own sums prove it."""
    for k, side in enumerate(said.sides):
        named = _named(side)
        if len(named) != 2:
            continue
        for above, below in _known_sums(world, named):
            resultant = call("sqrt", binary(ast.Add, _square(above), _square(below)))
            for other in (s for j, s in enumerate(said.sides) if j and j != k):
                if _same(world, order, resultant, world.plain(other)):
                    return call("sqrt", binary(ast.Add, *(_square(call("sum", name(n))) for n in named)))
    return None


def _square(tree: Node) -> Node:
    return binary(ast.Pow, tree, number(2))


def _named(side: Node) -> list[str]:
    # the two letters of sqrt(sum(a^2) + b^2), or of sqrt(sum(a^2 + b^2))
    if function_of(side) != "sqrt" or not isinstance(side, ast.Call):
        return []
    inside = side.args[0]
    if not any(function_of(n) == "sum" for _, n in walk(inside)):
        return []
    squares = [n.left for _, n in walk(inside) if is_operation(n, ast.Pow) and value_of(n.right) == 2]
    return [n.id for n in squares if isinstance(n, ast.Name)] if len(squares) == 2 else []


def _known_sums(world: World, named: Sequence[str]) -> Iterator[tuple[Node, Node]]:
    for one in world.paper.said:
        ratios = [s for s in one.sides if is_operation(s, ast.Div)]
        for printed in ratios:
            both = [s for s in (printed.left, printed.right) if function_of(s) == "sum"]
            if len(both) == 2 and {n for s in both for n in letters(s)} == set(named):
                for known in ratios:
                    if known is not printed:
                        yield world.plain(known.left), world.plain(known.right)


def _same(world: World, order: int, first: Node, second: Node) -> bool:
    # m_n and m may be one mass: a letter with an index for the one without
    bare = {n: n[0] for n in letters(second) if len(n) == 2 and n not in letters(first) and n[0] in letters(first)}
    second = substitute(second, lambda n: name(bare[n.id]) if isinstance(n, ast.Name) and n.id in bare else None)
    theory = world.theory(order)
    return bool(alike(states(theory), first, second)) and bool(free(theory, first))
