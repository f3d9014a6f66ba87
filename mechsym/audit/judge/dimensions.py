"""Dimensions of letters and expressions; a formula's own need no algebra: it must rescale as its quantity does."""

import ast
import random
from collections.abc import Mapping
from fractions import Fraction

import numpy as np

from mechsym.audit.judge.question import Bench, Question, bench, drawn, float_values, value
from mechsym.audit.read.algebra import FLOATS
from mechsym.audit.read.tree import Node, argument_of, function_of, is_operation, value_of, walk
from mechsym.audit.theory.record import Theory
from mechsym.quantities import dimension, record

Kind = tuple[Fraction, ...]  # exponents of kg, m, s, K, and 1 for an angle
NUMBER: Kind = (Fraction(0),) * 5
ANGLE: Kind = (*NUMBER[:4], Fraction(1))


def kind_of_unit(unit: str) -> Kind:
    """Dimension of a unit; an angle is a kind of its own."""
    return (*map(Fraction, dimension(unit)), Fraction(int(unit == "rad")))


def kind_of_letter(question: Question, letter: str) -> Kind | None:
    """Dimension of a letter of a formula; None where nothing tells it."""
    own = question.formula.letters.get(letter)
    if own is not None:
        return kind_of(question.theory, own)
    return kind_of(question.theory, ast.Name(id=letter, ctx=ast.Load()))


def kind_of(theory: Theory, tree: Node, known: Mapping[str, Kind | None] | None = None) -> Kind | None:
    """Dimension of an expression; None where it has none, or a name on the way has none."""
    return _kind(theory, tree, dict(known or {}))


def _kind(theory: Theory, tree: Node, known: dict[str, Kind | None]) -> Kind | None:
    if value_of(tree) is not None:
        return NUMBER
    if isinstance(tree, ast.Name):
        if tree.id == "pi":
            return NUMBER
        if tree.id in theory.letters:
            return kind_of_unit(theory.letters[tree.id].unit)
        if tree.id in theory.units:
            return kind_of_unit(theory.units[tree.id])
        if tree.id not in known:
            known[tree.id] = None
            entry = theory.tape.get(tree.id)
            if isinstance(entry, ast.expr):
                known[tree.id] = _kind(theory, entry, known)
        return known[tree.id]
    if isinstance(tree, ast.UnaryOp):
        return _kind(theory, tree.operand, known)
    if isinstance(tree, ast.IfExp):
        return _kind(theory, tree.body, known)
    if isinstance(tree, ast.Call):
        function = function_of(tree)
        if function in ("asin", "acos", "atan"):
            return ANGLE
        inner = _kind(theory, tree.args[0], known)
        if function in ("abs", "sum") or inner is None:
            return inner
        return (*(e / 2 for e in inner[:4]), Fraction(0)) if function == "sqrt" else NUMBER
    if not isinstance(tree, ast.BinOp):
        return None
    left, right = _kind(theory, tree.left, known), _kind(theory, tree.right, known)
    if isinstance(tree.op, ast.Pow):
        exponent = value_of(tree.right)
        if exponent is None:
            return NUMBER if left == NUMBER else None
        return None if left is None else (*(e * exponent for e in left[:4]), Fraction(0))
    if left is None or right is None:
        return left if isinstance(tree.op, (ast.Add, ast.Sub)) and right is None else None
    if isinstance(tree.op, (ast.Add, ast.Sub)):
        return left
    sign = 1 if isinstance(tree.op, ast.Mult) else -1
    both = tuple(a + sign * b for a, b in zip(left[:4], right[:4], strict=True))
    turned = ANGLE in (left, right) and NUMBER in (left, right) and left[4] + sign * right[4] == 1  # half an angle
    return (*both, Fraction(int(turned)))


def odd_arguments(theory: Theory, tree: Node, own: Mapping[str, Node]) -> list[Node]:
    """Arguments of sines, cosines and tangents that are no angles: of a length, or of an angle's power."""
    known = {k: kind_of(theory, t) for k, t in own.items()}
    odd = []
    for _, node in walk(tree):
        argument = argument_of(node, "sin", "cos", "tan", "cot")
        if argument is None:
            continue
        kind = kind_of(theory, argument, known)
        powers = [n for _, n in walk(argument) if is_operation(n, ast.Pow)]
        if any(kind_of(theory, n.left, known) == ANGLE for n in powers) or kind is not None and any(kind[:4]):
            odd.append(argument)
    return odd


_CLOSE = 1e-6
_POINTS = 8


@record
class Rescaled:
    """The same states before and after random scales of mass, length, time and temperature."""

    before: Bench
    after: Bench


def rescaled(question: Question) -> Rescaled:
    """States at which dimensions are compared."""
    values = float_values(drawn(question, _POINTS, seed=2))
    generator = random.Random(11)
    scales = [generator.uniform(1.1, 1.9) for _ in range(4)]
    after = {}
    for letter, before in values.items():
        exponents = dimension(question.theory.letters[letter].unit)
        after[letter] = before * float(np.prod([s**e for s, e in zip(scales, exponents, strict=True)]))
    return Rescaled(before=bench(question, values, FLOATS), after=bench(question, after, FLOATS))


def is_consistent(scales: Rescaled, tree: Node) -> bool:
    """Whether random scales change a formula as they change the quantity."""
    before, after = scales.before, scales.after
    with np.errstate(all="ignore"):
        ratio = value(after, tree) / value(before, tree)
        wanted = after.expected / before.expected
        usable = np.isfinite(wanted) & (np.abs(wanted) > 0)
        return bool(np.all(np.abs(ratio / wanted - 1)[usable] < _CLOSE))
