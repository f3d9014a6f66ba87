"""An equation of a text in the forms in which its sides are compared."""

import ast
import re
from collections.abc import Iterator, Mapping
from dataclasses import replace

from mechsym.audit.judge.kinds import of_unit
from mechsym.audit.judge.primes import PRIMED, primed, rated, slope_of, stems_of
from mechsym.audit.judge.world import World
from mechsym.audit.read.said import Said
from mechsym.audit.read.slopes import Slope, slope_in
from mechsym.audit.read.tree import Node, factors, letters, substitute, value_of, walk
from mechsym.audit.read.units import usual_unit
from mechsym.audit.theory.record import Theory
from mechsym.audit.theory.tape import slope_by

_WORD = re.compile(r"[A-Za-z]_?(?:piston|rod|crank|cylinder|shaft|wheel)")  # A_piston


def known(world: World, tree: Node, theory: Theory) -> Node:
    """A side under the names of the tape: dots, slopes by time and by what stands in a formula, rates of the angle."""
    return substitute(rated(world.plain(tree), theory), lambda n: _sloped(n, theory))


def _sloped(node: Node, theory: Theory) -> Node | None:
    # the stiffness dF/dz of a spring, whose force is printed by its travel z, which the text defines
    slope = slope_in(node.id) if isinstance(node, ast.Name) and node.id not in theory.letters else None
    entry = theory.tape.get(slope.of) if slope and slope.order == 1 and slope.by in theory.tape else None
    return slope_by(entry, slope.by) if slope and isinstance(entry, ast.AST) and slope.by in letters(entry) else None


def readings(world: World, left: Node, right: Node, theory: Theory) -> Iterator[tuple[Node, Node]]:
    """Both sides with a prime as a derivative by the angle, or in time."""
    angle = world.angle
    for by in (Slope("{}", angle).name, "{}_d"):
        yield primed(left, by, theory), primed(right, by, theory)


def steady(world: World, theory: Theory, said: Said) -> Theory:
    """A theory at constant speed: with an omega, and in a text without an acceleration of the angle."""
    rate = f"{world.angle}dd"
    used = {n for side in said.sides for n in letters(side)}
    constant = rate not in used and any(world.aliases.get(n) == f"{world.angle}d" for n in used)
    if rate in world.used and not constant or rate not in theory.letters:
        return theory
    still = replace(theory.letters[rate], value=1e-300)
    return replace(theory, letters={**theory.letters, rate: still})


def spelled(world: World, said: Said) -> dict[str, str]:
    """The author's LaTeX of every letter of a text, as this equation has it where they differ."""
    everywhere = {k: v for one in world.paper.said for k, v in one.spelled.items()}
    named = {slope_of(k, world.angle): v for k, v in everywhere.items() if PRIMED.fullmatch(k)}
    dotted = {k: v for k, v in everywhere.items() if v.startswith((r"\dot", r"\ddot"))}
    named |= {f"{k.rstrip('d')}_{k[len(k.rstrip('d')) :]}": v for k, v in dotted.items()}  # of what the text defines
    written = everywhere | named | dict(said.spelled)
    known = {k: rate for k, rate in world.aliases.items() if k in written}
    return written | {rate: written[k] for k, rate in known.items() if k in said.spelled or rate not in written}


def is_still(world: World, letter: str) -> bool:
    """Whether it is a rate of what the text says elsewhere without time or angle: there it was a state of rest."""
    slope = slope_in(letter)
    if slope and slope.by not in ("t", world.angle):
        return False
    stems = [] if letter in world.paper.named else stems_of(letter)
    given = {d.letter for d in world.defined}
    return letter not in given and any(stem in given and not world.turns(stem) for stem in stems)


def is_another(world: World, said: Said) -> bool:
    """Whether the left side is called here what is measured otherwise: a T that was a temperature, and is a torque."""
    left = getattr(said.sides[0], "id", "")
    here, known = usual_unit(left, said.about), world.kinds.of(left)
    return bool(here) and known is not None and of_unit(here)[:4] != known[:4]


def has_sense(world: World, said: Said) -> bool:
    """Whether it gives the rate of what the text itself defines, which cannot be counted the other way."""
    stems = stems_of(said.sides[0].id) if isinstance(said.sides[0], ast.Name) else ()
    return any(d.letter in stems for d in world.defined)


def are_told(world: World, tree: Node, meant: Mapping[str, str]) -> bool:
    """Whether a text tells what each factor of a formula is, be it by an index that is a word."""
    multiplied = {f.id for _, n in walk(tree) for f in factors(n) if isinstance(f, ast.Name) and f is not n}
    return all(n in meant or world.turns(n) or world.phrase(n) or _WORD.fullmatch(n) for n in multiplied)


def has_nothing(tree: Node) -> bool:
    """Whether something in an expression is taken from itself, or divided by itself."""
    pairs = [n for _, n in walk(tree) if isinstance(n, ast.BinOp) and isinstance(n.op, (ast.Sub, ast.Div))]
    return any(ast.dump(n.left) == ast.dump(n.right) for n in pairs)


def is_one_of_several(world: World, said: Said) -> bool:
    """Whether an equation that is zero stands in one display with others, which hold together."""
    zero = [one for one in world.paper.said if one.sides and value_of(one.sides[-1]) == 0]
    return said in zero and not said.inline and sum(one.shown.opens == said.shown.opens for one in zero) > 1
