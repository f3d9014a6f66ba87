"""What linear equations of motion of a text say of the frequencies that stand behind them."""

import ast
import math
from collections.abc import Iterator, Sequence
from functools import reduce
from itertools import permutations

from mechsym.audit.judge.by_energy import Expected
from mechsym.audit.judge.reciprocal import mended
from mechsym.audit.judge.world import World
from mechsym.audit.read.said import Said
from mechsym.audit.read.spelling import SPEEDS
from mechsym.audit.read.tree import (
    Node,
    argument_of,
    call,
    is_operation,
    letters,
    name,
    negative,
    number,
    value_of,
    walk,
)
from mechsym.audit.theory.tape import is_zero, minus, over, plus, slope_by, times

_BEFORE = 6  # equations in front of one, or behind it, that are looked at
_MOST = 4  # coordinates of a system whose determinant is written out


def natural(world: World, order: int, said: Said) -> Iterator[Expected]:
    """Of a linear equation of motion the root of what stands before the way by what stands before its acceleration."""
    printed = world.plain(said.sides[1])
    for source in world.paper.said[max(order - _BEFORE, 0) : order]:
        if source.inline or len(source.sides) != 2:
            continue
        whole = minus(*source.sides)
        for rate in (k for k in letters(whole) if k.endswith("dd")):
            mass, stiffness = (slope_by(whole, k) for k in (rate, rate[:-2]))
            own, used = {*letters(mass), *letters(stiffness)}, {*letters(printed)}
            # the mass of something else: m_1 for m_2
            other = len(own) == len(used) > 1 and {k[0] for k in own - used} == {k[0] for k in used - own}
            if (own == used or other and len(own - used) == 1) and not is_zero(mass):
                tree = call("sqrt", over(stiffness, mass))
                yield Expected(tree=tree, printed=printed, note=f"by the coefficients of ({source.name})")


def characteristic(world: World, order: int, said: Said) -> Iterator[Expected]:
    """The determinant of the linear equations of motion in front of a polynomial of a frequency, in its own scale."""
    printed = world.plain(said.sides[0])
    powers = {n.left.id: 0 for _, n in walk(printed) if is_operation(n, ast.Pow) and isinstance(n.left, ast.Name)}
    frequency = next((k for k in powers if k.startswith((*SPEEDS, "p", "lam"))), "")
    if value_of(said.sides[1]) != 0 or not frequency:
        return
    rows: dict[str, Node] = {}
    for place, source in enumerate(world.paper.said[:order]):
        rates = {k for side in source.sides for k in letters(side) if k.endswith("dd") and len(k) > 2}
        if len(source.sides) == 2 and not source.inline and len(rates) == 1:
            left = mended(world, place) or source.sides[0]
            rows[rates.pop().removesuffix("dd")] = minus(left, source.sides[1])
    if not 1 < len(rows) <= _MOST:
        return
    square, zero = times(name(frequency), name(frequency)), number(0)
    entries = [
        [minus(slope_by(row, q), times(square, slope_by(row, f"{q}dd") if q == own else zero)) for q in rows]
        for own, row in rows.items()
    ]
    if any(k in rows or k.endswith("d") for row in entries for entry in row for k in letters(entry)):
        return  # not linear, or damped
    masses = [slope_by(row, f"{own}dd") for own, row in rows.items()]
    lead, degree = printed, 0
    while not is_zero(slope := slope_by(lead, frequency)) and degree <= 2 * _MOST:
        lead, degree = slope, degree + 1
    if degree not in (2 * len(rows), 2 * len(rows) - 2):
        return
    whole = reduce(times, map(negative, masses))
    scaled = over(over(lead, number(math.factorial(degree))), whole)
    rest = over(_determinant(entries), square) if degree < 2 * len(rows) else _determinant(entries)
    yield Expected(tree=times(scaled, rest), printed=printed, note="by the determinant of the equations of motion")


def _determinant(entries: Sequence[Sequence[Node]]) -> Node:
    terms = []
    for order in permutations(range(len(entries))):
        swaps = sum(order[i] > order[k] for k in range(len(order)) for i in range(k))
        term = reduce(times, (row[k] for row, k in zip(entries, order, strict=True)))
        terms.append(negative(term) if swaps % 2 else term)
    return reduce(plus, terms)


def with_frequency(world: World, order: int) -> Iterator[tuple[int, Node]]:
    """The left side of a linear equation of motion by each frequency behind it that has no other letters, with the
    place of that one."""
    said = world.paper.said[order]
    if len(said.sides) != 2:
        return
    whole, behind = minus(*said.sides), world.paper.said[order + 1 : order + 1 + _BEFORE]
    for rate in (k for k in letters(whole) if k.endswith("dd")):
        mass, stiffness = (slope_by(whole, k) for k in (rate, rate[:-2]))
        for place, other in enumerate(behind, order + 1):
            root = argument_of(other.sides[1], "sqrt") if len(other.sides) == 2 and not other.inline else None
            if root is not None:
                square = world.plain(root)
                if not is_zero(mass) and {*letters(mass), *letters(stiffness)} == {*letters(square)}:
                    more = minus(times(square, mass), stiffness)
                    yield place, plus(world.plain(said.sides[0]), times(more, name(rate[:-2])))
