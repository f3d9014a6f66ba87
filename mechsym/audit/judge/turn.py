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
from mechsym.audit.read.tree import letters, name, negative, number
from mechsym.audit.theory.record import complete
from mechsym.audit.theory.tape import is_zero, minus, over, slope_by
from mechsym.errors import BadInput

_BOUNDS = re.compile(r"\\int_(\{[^{}]*\}|\w|\\[a-z]+)\^(\{[^{}]*\}|\w|\\[a-z]+)")
_ROUNDING = 1e-9  # [-]
_STEPS = 721  # angles of a turn at which a way is looked for its ends
_LARGEST = 8  # numerator and denominator of a factor that a slip of the pen leaves


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


def stroke(world: World, order: int, said: Said) -> Iterator[Expected]:
    """The stroke of the way that was given last: how far it goes in a turn, where that is a number of times what is
    printed."""
    printed = world.plain(said.sides[1])
    before = [d.letter for d in world.defined if d.order < order and world.turns(d.letter)]
    ways = [k for k in before if world.kinds.of(k) in (of_unit("m"), None)]
    if not ways or not world.angle or world.angle in letters(printed):
        return
    theory = world.theory(order)
    at = states(theory).values
    count = at["pi"].size
    turn = np.tile(np.linspace(0.0, 2 * math.pi, _STEPS), count)
    values = {k: np.repeat(v, _STEPS) for k, v in at.items()} | {world.angle: turn}
    try:
        with np.errstate(all="ignore"):
            complete(theory, values, [ways[-1], *letters(printed)], FLOATS)
            way, told = (np.asarray(evaluate(tree, values, FLOATS)) for tree in (name(ways[-1]), printed))
            ratio = np.abs(told).reshape(count, _STEPS)[:, 0] / np.ptp(
                np.broadcast_to(way, turn.shape).reshape(count, _STEPS), axis=1
            )
    except (BadInput, KeyError, ValueError):
        return
    share = Fraction(float(ratio[0])).limit_denominator(_LARGEST) if np.isfinite(ratio).all() else Fraction(0)
    if (
        share and share.numerator <= _LARGEST and np.abs(ratio - float(share)).max() < 1e-4
    ):  # ends lie between the steps
        yield Expected(tree=over(printed, number(share)), printed=printed, note=f"the way of {ways[-1]} in a turn")


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
