"""Exponents of units where a formula has letters for them: H^n/(H - z)^n is a number for every n.

A letter stands for one number that nobody prints. What fits with it fits for all values of the letter; a unit in which
it is left is none.
"""

import ast
from collections.abc import Iterable
from fractions import Fraction
from hashlib import blake2b

from mechsym.audit.read.tree import Node, value_of

_LARGEST = 10_007  # a prime: no denominator of a unit


def exponent(tree: Node) -> Fraction | None:
    """Value of an exponent, each letter of it at a number of its own; None where it is no sum or product of these."""
    value = value_of(tree)
    if value is not None:
        return value
    if isinstance(tree, ast.Name):
        drawn = int.from_bytes(blake2b(tree.id.encode(), digest_size=4).digest())
        return Fraction(drawn % (_LARGEST - 1) + 1, _LARGEST)
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
    return any(power.denominator > _LARGEST // 10 for power in kind)
