"""Sizes that a declaration gives as expressions of its letters: text to numbers, curves or symbols."""

import ast
import functools
import math
import operator
from collections.abc import Callable, Mapping

import casadi as ca
import numpy as np

from mechsym.quantities.units import Scalar

_BINARY: Mapping[type, Callable[[Scalar, Scalar], Scalar]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Pow: operator.pow,
}  # fmt: skip
_FUNCTIONS = {"sin": "sin", "cos": "cos", "tan": "tan", "sqrt": "sqrt", "Abs": "fabs"}


def amount(text: str | float, letters: Mapping[str, Scalar]) -> Scalar:
    """The value of an expression, from text as a declaration stores it and values of its names; a number is its own.

    text: a number is its own value [unit]. Returns value: of the kind of the letters [unit].

    >>> amount("r1 + 2*r2", {"r1": 0.2, "r2": 0.3})
    0.8
    """
    return _value(_parsed(text), letters) if isinstance(text, str) else text


@functools.lru_cache(maxsize=512)
def _parsed(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


def _value(node: ast.expr, letters: Mapping[str, Scalar]) -> Scalar:
    if isinstance(node, ast.Constant):
        return node.value
    if isinstance(node, ast.Name):
        return math.pi if node.id == "pi" else letters[node.id]
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        return -_value(node.operand, letters)
    if isinstance(node, ast.BinOp):
        return _BINARY[type(node.op)](_value(node.left, letters), _value(node.right, letters))
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in _FUNCTIONS:
        inner = _value(node.args[0], letters)
        return getattr(ca if isinstance(inner, ca.SX) else np, _FUNCTIONS[node.func.id])(inner)
    raise ValueError(f"{ast.unparse(node)} is no size of a declaration")
