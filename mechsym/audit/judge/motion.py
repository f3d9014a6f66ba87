"""What moves in a text: the angle that runs, and the energies that Lagrange's equations are taken of."""

import ast
import re
from collections import Counter
from functools import partial, reduce

from mechsym.audit.read.said import Said, Text
from mechsym.audit.read.slopes import slope_in
from mechsym.audit.read.spelling import SPEEDS
from mechsym.audit.read.tree import Node, argument_of, binary, factors, letters, name, substitute, walk

ANGLES = ("varphi", "phi", "theta", "alpha", "gamma", "psi")
KINETIC, _POTENTIAL = ("T", "K", "Ek", "Ekin", "EK", "calT"), ("V", "U", "Pi", "Ep", "Epot", "EP", "calV", "calU")
_FIXED = re.compile(
    r"\b(?:[vV]|vee|swash plate|cone|tilt|bank|half|phase|pressure|helix|lead|contact|inclination|slope)\b"
)


def even_rate(said: Said) -> str:
    """The rate of an angle that an equation says to turn evenly, theta = omega t; empty for any other equation."""
    left = said.sides[0] if len(said.sides) == 2 else None
    parts = {f.id for f in factors(said.sides[1]) if isinstance(f, ast.Name)} if left is not None else set()
    rate = next(iter(parts - {"t"}), "")
    turning = isinstance(left, ast.Name) and left.id.startswith(ANGLES) and parts == {rate, "t"}
    return rate if turning and rate in SPEEDS and len(factors(said.sides[1])) == 2 else ""


def angle_of(paper: Text) -> str:
    """The angle that runs: what sines and cosines are taken of most often, and no equation gives."""
    said = paper.said
    given = {s.sides[0].id for s in said if s.sides and isinstance(s.sides[0], ast.Name) and not even_rate(s)}
    given |= {
        a.id for s in said if s.sides for a in [argument_of(s.sides[0], "sin", "cos", "tan")] if isinstance(a, ast.Name)
    }
    given |= {letter for letter, phrase in paper.called.items() if _FIXED.search(phrase)}
    counts: Counter[str] = Counter()
    for one in said:
        for side in one.sides:
            for _, node in walk(side):
                argument = argument_of(node, "sin", "cos", "tan", "cot")
                for n in letters(argument) if argument is not None else ():
                    if n not in given and any(n.startswith(a) for a in ANGLES):
                        counts[n] += 1
    if not counts:  # or by what slopes are taken
        slopes = (slope_in(n) for one in said for s in one.sides for n in letters(s))
        counts.update(s.by for s in slopes if s and s.by not in given and any(s.by.startswith(a) for a in ANGLES))
    return counts.most_common(1)[0][0] if counts else ""


def energies_of(paper: Text) -> tuple[str, ...]:
    """The kinetic energy of a text that speaks of Lagrange, and the potential one; nothing where it does not."""
    if not re.search(r"\bLagrang", paper.prose):
        return ()
    defined = {getattr(one.sides[0], "id", ""): k for k, one in enumerate(paper.said) if len(one.sides) > 1}
    rates = {k: [n for side in paper.said[at].sides[1:] for n in letters(side)] for k, at in defined.items()}
    kinetic = [k for k in defined if k in KINETIC and any(n.endswith("d") for n in rates[k])]
    if len(kinetic) != 1:
        return ()
    # a V that stands elsewhere is a volume
    near = [k for k in defined if k in _POTENTIAL and 0 < abs(defined[k] - defined[kinetic[0]]) < 3]
    called = [k for k in defined if k in _POTENTIAL and "energy" in paper.called.get(k, "")]
    potential = called or near
    return (*kinetic, *potential) if len(potential) < 2 else ()


def with_angle(tree: Node, rate: str, angle: str) -> Node:
    """The tree with an angle in place of the product of its rate and time."""

    def changed(node: Node) -> Node | None:
        parts = factors(node)
        names = [f.id for f in parts if isinstance(f, ast.Name)]
        if names.count("t") != 1 or names.count(rate) != 1:
            return None
        rest = [f for f in parts if not (isinstance(f, ast.Name) and f.id in ("t", rate))]
        return reduce(partial(binary, ast.Mult), [*(with_angle(f, rate, angle) for f in rest), name(angle)])

    return substitute(tree, changed)
