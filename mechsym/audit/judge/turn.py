"""What an equation has to be by a whole turn of what stands before it, or at rest: a mean, a stroke, what holds."""

import ast
import math
import re
from collections.abc import Iterator
from fractions import Fraction

import numpy as np

from mechsym.audit.judge.by_energy import Expected
from mechsym.audit.judge.kinds import of_unit
from mechsym.audit.judge.sampled import states
from mechsym.audit.judge.world import World
from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.latex import read_latex
from mechsym.audit.read.said import Said
from mechsym.audit.read.tree import Node, letters, name, negative, number, substitute
from mechsym.audit.theory.tape import is_zero, minus, over, slope_by, times
from mechsym.errors import BadInput

_BOUNDS = re.compile(r"\\int_(\{[^{}]*\}|\w|\\[a-z]+)\^(\{[^{}]*\}|\w|\\[a-z]+)")
_ROUNDING = 1e-9  # [-]
_DEEPEST, _MOST = 6, 0.5  # definitions within definitions; share of the states [-]


def averaged(said: Said) -> Iterator[Expected]:
    """The mean over what is integrated; what is nothing elsewhere may be divided by the whole period."""
    printed = said.sides[1]
    integrals = [n for n in letters(printed) if n.startswith("integral")]
    bounds = _BOUNDS.match(said.spelled.get(integrals[0], "")) if len(integrals) == 1 else None
    if bounds is None or isinstance(printed, ast.Name):  # the integral alone is no mean
        return
    try:
        low, high = (read_latex(text.strip("{}"), whole=True)[0] for text in bounds.groups())
    except BadInput:
        return
    tree = over(name(integrals[0]), minus(high, low))
    if {*letters(printed)} - {"pi"} == {*letters(tree)} - {"pi"}:
        values = {"pi": math.pi} | {n: 1.3 + 0.4 * k for k, n in enumerate(letters(tree)) if n != "pi"}
        one, other = (float(evaluate(part, values, FLOATS)) for part in (printed, tree))
        if other and one / other > 1 - _ROUNDING:
            yield Expected(tree=tree, printed=printed, note="a mean is the integral by the length that it goes over")


def over_a_turn(world: World, order: int, said: Said) -> Iterator[Expected]:
    """The stroke of the way that was given last, or the ratio of a volume's ends, at quarters of a turn."""
    printed = world.plain(said.sides[1])
    is_stroke = "stroke" in (said.about, world.paper.called.get(getattr(said.sides[0], "id", "")))
    kind = of_unit("m" if is_stroke else "m^3")
    moving = [d.letter for d in world.defined if d.order < order and world.turns(d.letter)]
    way = next((k for k in reversed(moving) if world.kinds.of(k) in (kind, None)), "")
    if not way or not world.angle or world.angle in letters(printed):
        return
    whole, at = _expanded(world, order, way), states(world.bare)
    quarters = [times(number(k), over(name("pi"), number(2))) for k in range(4)]
    places = [_at_angle(whole, world.angle, quarter) for quarter in quarters]
    try:
        ends, between = (
            np.array([at.value(tree) for tree in trees])
            for trees in (places, [_at_angle(whole, world.angle, number(Fraction(k, 7))) for k in range(1, 44)])
        )
    except (BadInput, KeyError, RecursionError):
        return
    first, last = ends.argmin(axis=0), ends.argmax(axis=0)
    low, high = np.bincount(first).argmax(), np.bincount(last).argmax()
    usual = (first == low) & (last == high)  # the tangent of an angle that is drawn at random may have either sign
    inside = (between >= ends.min(axis=0)) & (between <= ends.max(axis=0))
    if inside.all() and usual.mean() > _MOST and low != high:
        least, largest = places[low], places[high]
        tree = minus(largest, least) if is_stroke else over(largest, least)
        yield Expected(tree=tree, printed=printed, note=f"the ends of {way} in a turn")


def _expanded(world: World, order: int, letter: str) -> Node:
    # what turns, with all that turns in it as the text defines it
    trees = {d.letter: d.tree for d in world.defined if d.order < order and world.turns(d.letter)}
    tree: Node = name(letter)
    for _ in range(_DEEPEST):
        tree = substitute(tree, lambda n: trees.get(n.id) if isinstance(n, ast.Name) else None)
    return tree


def _at_angle(tree: Node, angle: str, value: Node) -> Node:
    return substitute(tree, lambda n: value if isinstance(n, ast.Name) and n.id == angle else None)


def held(world: World, said: Said) -> Iterator[Expected]:
    """What holds a coordinate at rest: the slope of the potential energy by it."""
    left, printed = getattr(said.sides[0], "id", ""), world.plain(said.sides[1])
    energy = next((d.tree for d in world.defined if world.phrase(d.letter) == "potential energy"), None)
    index = left[len(left.rstrip("0123456789")) :]
    moving = [q for q in sorted(world.coordinates) if q[len(q.rstrip("0123456789")) :] == index]
    if energy is None or len(moving) != 1 or any(k.endswith("d") for k in letters(printed)):
        return
    slope = slope_by(energy, moving[0])
    for tree in () if is_zero(slope) else (slope, negative(slope)):
        yield Expected(tree=tree, printed=printed, note=f"the slope of the potential energy by {moving[0]}")
