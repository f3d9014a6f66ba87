"""Dimensions of expressions, so that only letters of one kind are taken for each other."""

import ast
from collections.abc import Mapping
from fractions import Fraction

from mechsym.audit.question import Question
from mechsym.audit.theory.record import Theory
from mechsym.audit.tree import Node, value_of
from mechsym.quantities import dimension

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
    known = dict(known or {})
    return _kind(theory, tree, known)


def _kind(theory: Theory, tree: Node, known: dict[str, Kind | None]) -> Kind | None:
    if value_of(tree) is not None:
        return NUMBER
    if isinstance(tree, ast.Name):
        return _of_name(theory, tree.id, known)
    if isinstance(tree, ast.UnaryOp):
        return _kind(theory, tree.operand, known)
    if isinstance(tree, ast.IfExp):
        return _kind(theory, tree.body, known)
    if isinstance(tree, ast.Call):
        return _of_call(theory, tree, known)
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


def _of_name(theory: Theory, letter: str, known: dict[str, Kind | None]) -> Kind | None:
    if letter == "pi":
        return NUMBER
    if letter in theory.letters:
        return kind_of_unit(theory.letters[letter].unit)
    if letter in theory.units:
        return kind_of_unit(theory.units[letter])
    if letter not in known:
        known[letter] = None
        entry = theory.tape.get(letter)
        if isinstance(entry, ast.expr):
            known[letter] = _kind(theory, entry, known)
    return known[letter]


def _of_call(theory: Theory, tree: ast.Call, known: dict[str, Kind | None]) -> Kind | None:
    function = tree.func.id  # type: ignore[attr-defined]
    if function in ("asin", "acos", "atan"):
        return ANGLE
    inner = _kind(theory, tree.args[0], known)
    if function in ("abs", "sum") or inner is None:
        return inner
    return (*(e / 2 for e in inner[:4]), Fraction(0)) if function == "sqrt" else NUMBER
