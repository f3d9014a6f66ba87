"""Exponents of units where a formula has letters for them: H^n/(H - z)^n is a number for every n.

A letter stands for one number that nobody prints: a prime by a larger one, so that no sum, product or quotient of
several has a small denominator but where they cancel. What fits with it fits for all values of the letter; a unit in
which it is left is none.
"""

import ast
from collections.abc import Iterable
from fractions import Fraction
from functools import cache
from hashlib import blake2b

import sympy

from mechsym.audit.read.tree import Node, value_of

_BELOW, _FROM, _MANY = 1_000_003, 550_000, 150_000  # the prime that all are divided by; where theirs begin
_SMALL = 1000  # denominators of units are smaller


def exponent(tree: Node) -> Fraction | None:
    """Value of an exponent, each letter of it at a number of its own; None where it is no sum or product of these."""
    value = value_of(tree)
    if value is not None:
        return value
    if isinstance(tree, ast.Name):
        return _drawn(tree.id)
    if isinstance(tree, ast.UnaryOp):
        inner = exponent(tree.operand)
        return None if inner is None else -inner
    if not isinstance(tree, ast.BinOp) or isinstance(tree.op, ast.Pow):
        return None
    left, right = exponent(tree.left), exponent(tree.right)
    if left is None or right is None or isinstance(tree.op, ast.Div) and not right:
        return None
    if isinstance(tree.op, ast.Mult | ast.Div):
        return left * right if isinstance(tree.op, ast.Mult) else left / right
    return left + right if isinstance(tree.op, ast.Add) else left - right


def is_left(kind: Iterable[Fraction]) -> bool:
    """Whether a letter is left in the exponents of a unit."""
    return any(power.denominator >= _SMALL for power in kind)


@cache
def _drawn(letter: str) -> Fraction:
    place = int.from_bytes(blake2b(letter.encode(), digest_size=4).digest()) % _MANY
    return Fraction(int(sympy.nextprime(_FROM + place)), _BELOW)
