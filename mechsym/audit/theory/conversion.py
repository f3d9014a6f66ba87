"""Sympy expressions as trees, so that a derivation is evaluated like a printed formula."""

import ast
from collections.abc import Mapping
from fractions import Fraction
from functools import reduce
from typing import Any

import sympy
from sympy import Expr

from mechsym.audit.functions import MEANINGS
from mechsym.audit.tree import Node, binary, call, name, number

_FUNCTIONS = {
    sympy.sin: "sin", sympy.cos: "cos", sympy.tan: "tan", sympy.asin: "asin", sympy.acos: "acos", sympy.atan: "atan",
    sympy.exp: "exp", sympy.log: "log", sympy.Abs: "abs",
}  # fmt: skip
_MEANT = {sympy.atan2: "atan2", sympy.Max: "max", sympy.Min: "min"}


def tree_of(expression: Any) -> Node:
    """A sympy expression as a tree.

    Raises
    ------
    TypeError
        A node that formulas do not have
    """
    e = sympy.sympify(expression)
    if isinstance(e, sympy.Symbol) or e is sympy.pi:
        return name(str(e))
    if e.is_Rational:
        return number(Fraction(int(e.p), int(e.q)))
    if e.is_Add:
        return reduce(_plus, e.args[1:], tree_of(e.args[0]))
    if e.is_Mul:
        return reduce(lambda t, a: binary(ast.Mult, t, tree_of(a)), e.args[1:], tree_of(e.args[0]))
    if e.is_Pow:
        return _power(*e.args)
    if e.func in _FUNCTIONS:
        return call(_FUNCTIONS[e.func], tree_of(e.args[0]))
    if e.func in _MEANT:
        return reduce(MEANINGS[_MEANT[e.func]][1], map(tree_of, e.args))
    raise TypeError(f"{e.func.__name__} has no place in a formula: {e}")


def _plus(left: Node, term: Expr) -> Node:
    if term.could_extract_minus_sign():
        return binary(ast.Sub, left, tree_of(-term))
    return binary(ast.Add, left, tree_of(term))


def _power(base: Expr, exponent: Expr) -> Node:
    if base is sympy.E:
        return call("exp", tree_of(exponent))
    if exponent == sympy.Rational(1, 2):
        return call("sqrt", tree_of(base))
    if exponent.could_extract_minus_sign():
        return binary(ast.Div, number(1), tree_of(base**-exponent))
    return binary(ast.Pow, tree_of(base), tree_of(exponent))


def tape_of(expressions: Mapping[str, Any]) -> dict[str, Node | tuple[Node, ...]]:
    """Named sympy expressions as trees."""
    return {n: tuple(map(tree_of, e)) if isinstance(e, tuple) else tree_of(e) for n, e in expressions.items()}
