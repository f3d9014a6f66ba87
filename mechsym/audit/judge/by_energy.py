"""What an equation has to be by the energies of a text: halves of kinetic ones, what a spring stores, an inertia."""

import ast
import re
from collections.abc import Iterator, Mapping
from fractions import Fraction
from functools import partial, reduce
from typing import TypeGuard

from mechsym.audit.judge.kinds import kind_in, of_unit
from mechsym.audit.judge.motion import ANGLES, KINETIC
from mechsym.audit.judge.world import World
from mechsym.audit.read.said import Said
from mechsym.audit.read.slopes import Slope
from mechsym.audit.read.spelling import SPEEDS
from mechsym.audit.read.tree import (
    Node,
    is_operation,
    letters,
    name,
    number,
    renamed,
    substitute,
    summands,
    value_of,
    walk,
)
from mechsym.audit.theory.tape import is_zero, over, plus, slope_by, times
from mechsym.quantities import record

_NEAR = 3  # equations in front of an energy that its force may be
_OF_ANY = set("the its and about mass moment inertia centre center axis own angular velocity speed".split())


@record
class Expected:
    """What an equation may have to say by the words in front of it."""

    tree: Node
    printed: Node  #: The part of the equation that it is held against
    note: str
    scaled: bool = False  #: Whether a number before all of it is left open
    whole: bool = False  #: Whether what the text defines is meant by its letters


def stored(world: World, order: int, said: Said) -> Iterator[Expected]:
    """What a spring stores: its force over its way, by Simpson's rule, which is exact for a cubic one."""
    printed = world.plain(said.sides[1])
    for source in world.paper.said[max(order - _NEAR, 0) : order]:
        if len(source.sides) != 2 or source.claim or kind_in(world.kinds, source.sides[0]) != of_unit("N"):
            continue
        force = world.plain(source.sides[1])
        for way in (k for k in letters(force) if k in letters(printed) and world.kinds.of(k) == of_unit("m")):
            slope = reduce(slope_by, [way] * 4, force)
            if is_zero(slope):
                relaxed, middle = (substitute(force, partial(_at, way, number(k))) for k in (0, Fraction(1, 2)))
                ends = plus(relaxed, force)
                tree = times(over(name(way), number(6)), plus(ends, times(number(4), middle)))
                yield Expected(tree=tree, printed=printed, note=f"the work of ({source.name})")


def _at(way: str, share: Node, node: Node) -> Node | None:
    return times(share, node) if isinstance(node, ast.Name) and node.id == way else None


def halved(world: World, said: Said) -> Iterator[Expected]:
    """A kinetic energy with one half before each square of a speed, where it is one alone or has one before some."""
    printed = world.plain(said.sides[1])
    terms = summands(printed)
    before = [_number_before(term) if _has_square_of_rate(term) else None for term in terms]
    whole = [term for c, term in zip(before, terms, strict=True) if c == 1]
    alone = before == [1] and sum(is_operation(n, ast.Pow) for _, n in walk(printed)) == 1  # m v^2, no m r^2 omega^2
    if (alone or {*before} == {Fraction(1, 2), Fraction(1)}) and not any(_has_twins(world, term) for term in whole):
        mended = [over(term, number(2)) if c == 1 else term for c, term in zip(before, terms, strict=True)]
        yield Expected(tree=reduce(plus, mended), printed=printed, note="half of each mass by the square of its speed")


def _has_twins(world: World, term: Node) -> bool:
    # of two crankshafts the energy has no half before it
    words = {word for k in letters(term) for word in re.findall("[a-z]{3,}", world.phrase(k))} - _OF_ANY
    prose = " ".join(world.paper.prose.lower().split())
    return any(re.search(rf"\b(?:two|both|each|either|one|three|four) (?:[a-z]+ )?{w}s?\b", prose) for w in words)


def _number_before(term: Node) -> Fraction:
    if is_operation(term, ast.Mult, ast.Div):
        left, right = _number_before(term.left), _number_before(term.right)
        return left * right if isinstance(term.op, ast.Mult) else left / right
    return value_of(term) or Fraction(1)


def _has_square_of_rate(term: Node) -> bool:
    squares = [n.left for _, n in walk(term) if is_operation(n, ast.Pow) and value_of(n.right) == 2]
    return any(_is_rate(n) or isinstance(n, ast.Name) and n.id[0] == "v" for square in squares for _, n in walk(square))


def reduced(world: World, order: int, said: Said) -> Iterator[Expected]:
    """An inertia: twice the kinetic energy over the square of a rate."""
    printed = world.plain(said.sides[1])
    used = {*letters(printed)}
    ratios = {
        d.tree.left.id: times(name(d.letter), d.tree.right)
        for d in world.defined
        if d.letter in used and is_operation(d.tree, ast.Div) and _is_rate(d.tree.left) and _is_rate(d.tree.right)
    }
    own = getattr(said.sides[0], "id", "")
    for note, whole in ((note, whole) for note, whole in _kinetic(world, order) if own not in letters(whole)):
        energy = substitute(whole, partial(_put_in, ratios))
        rates = {k: rate_in(k.removesuffix("d"), used) or k for k in letters(energy) if k.endswith("d")}
        energy = renamed(energy, rates)
        for rate in dict.fromkeys(rates.values()):
            tree = over(times(number(2), energy), times(name(rate), name(rate)))
            yield Expected(tree=tree, printed=printed, note=note)
        turning = f"{world.angle}d"
        ways = {k: k.removesuffix("d") for k in rates.values() if k != turning and world.turns(k.removesuffix("d"))}
        if ways and turning in rates.values():  # of what moves with the angle its rate is the slope by the angle
            by_angle = {k: times(name(Slope(way, world.angle).name), name(turning)) for k, way in ways.items()}
            moved = substitute(energy, partial(_put_in, by_angle))
            tree = over(times(number(2), moved), times(name(turning), name(turning)))
            yield Expected(tree=tree, printed=printed, note=note, whole=True)


def _put_in(trees: Mapping[str, Node], node: Node) -> Node | None:
    return trees.get(node.id) if isinstance(node, ast.Name) else None


def _is_rate(tree: Node) -> TypeGuard[ast.Name]:
    return isinstance(tree, ast.Name) and (tree.id.endswith("d") or tree.id.startswith(SPEEDS))


def _kinetic(world: World, order: int) -> Iterator[tuple[str, Node]]:
    # each kinetic energy in front of an equation, and the sum of those of the parts
    parts: dict[str, tuple[str, Node]] = {}
    for source in world.paper.said[:order]:
        letter = getattr(source.sides[0], "id", "") if len(source.sides) > 1 else ""
        whole = world.plain(source.sides[-1]) if letter else None
        base = letter.rstrip("0123456789")
        told = world.phrase(letter) == "kinetic energy" or source.about.endswith("kinetic energy")
        sums_up = letter in KINETIC or letter == base and told
        if whole is not None and sums_up:
            yield f"by the energy of ({source.name})", whole
        elif (
            whole is not None
            and (base in KINETIC or world.phrase(base) == "kinetic energy")
            and any(k.endswith("d") for k in letters(whole))
        ):
            parts[letter] = (source.name, whole)
    if len(parts) > 1:
        total = reduce(plus, (tree for _, tree in parts.values()))
        yield f"by the energies of {', '.join(f'({source})' for source, _ in parts.values())}", total


def rate_in(letter: str, used: set[str]) -> str:
    """The rate of a letter among those of an equation; empty where none stands there."""
    # the rate of an angle with an index may be an omega with it
    stem = next((a for a in ANGLES if letter.startswith(a)), "")
    named = [f"{rate}{letter.removeprefix(stem)}" for rate in ("omega", "w")] if stem and letter != stem else []
    return next((rate for rate in (f"{letter}d", *named) if rate in used), "")
