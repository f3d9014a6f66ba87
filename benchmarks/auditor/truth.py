"""Values of formulas to 30 digits, by an evaluator of its own: what the auditor's answers are measured with."""

import ast
import random
from collections.abc import Mapping
from typing import Any

import mpmath

DIGITS = 30
_OPERATORS: dict[type, Any] = {
    ast.Add: lambda a, b: a + b, ast.Sub: lambda a, b: a - b, ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b, ast.Pow: lambda a, b: a**b,
}  # fmt: skip


def states(ranges: Mapping[str, list[float]], count: int, seed: int) -> list[dict[str, Any]]:
    """Random values of letters between the two ends of their ranges."""
    generator = random.Random(seed)
    return [{k: mpmath.mpf(generator.uniform(*ends)) for k, ends in ranges.items()} for _ in range(count)]


def value(text: str, state: Mapping[str, Any], define: Mapping[str, str]) -> Any:
    """Value of a formula at one state, None where it is not real or uses an unknown name [unit of the formula]."""
    with mpmath.workdps(DIGITS):
        try:
            found = _value(ast.parse(text, mode="eval").body, state, define)
        except (KeyError, ZeroDivisionError, OverflowError, ValueError):
            return None
    return found if isinstance(found, mpmath.mpf) and mpmath.isfinite(found) else None


def _value(node: ast.expr, state: Mapping[str, Any], define: Mapping[str, str]) -> Any:
    if isinstance(node, ast.Constant):
        return mpmath.mpf(str(node.value))
    if isinstance(node, ast.Name):
        if node.id == "pi":
            return +mpmath.pi
        # a defined name hides a letter: r is r1 + r2 in one theory and free in another
        return _value(_body(define[node.id]), state, define) if node.id in define else state[node.id]
    if isinstance(node, ast.UnaryOp):
        return -_value(node.operand, state, define)
    if isinstance(node, ast.Call):
        function = {"abs": abs}.get(node.func.id) or getattr(mpmath, node.func.id)  # type: ignore[attr-defined]
        return function(_value(node.args[0], state, define))
    assert isinstance(node, ast.BinOp)
    return _OPERATORS[type(node.op)](_value(node.left, state, define), _value(node.right, state, define))


def _body(text: str) -> ast.expr:
    return ast.parse(text, mode="eval").body


def same(first: str, second: str, ranges: Mapping[str, list[float]], define: Mapping[str, str]) -> bool:
    """Whether two formulas have the same values at twelve states, to 20 digits where both are real."""
    met = 0
    for state in states(ranges, 12, seed=1):
        one, two = value(first, state, define), value(second, state, define)
        if one is None or two is None:
            if (one is None) != (two is None):
                return False
            continue
        if abs(one - two) > mpmath.mpf(10) ** -20 * (abs(one) + abs(two)):
            return False
        met += 1
    return met > 0
