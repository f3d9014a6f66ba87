"""What every part of a formula would have to be for the whole to be right, all else as printed.

The derived value is pushed down from the root through sums, products, powers and roots. An edit of one part repairs
the formula when its new value meets the required one, so that no candidate formula is ever evaluated as a whole.
"""

import ast
from collections.abc import Mapping
from typing import Any

import mpmath
import numpy as np

from mechsym.audit.algebra import DIGITS
from mechsym.audit.bench import Bench
from mechsym.audit.tree import Node, Path, children, function_of

Required = Mapping[Path, Any]


def required(asked: Bench, tree: Node, memo: Mapping[Node, Any]) -> Required:
    """Required values of all parts that can be reached.

    Returns
    -------
    required : mapping of path to array, shape (n,)
        Parts under sines, absolute values and sums over parts are not reached
    """
    found: dict[Path, Any] = {(): asked.expected}
    waiting: list[tuple[Path, Node]] = [((), tree)]
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        while waiting:
            path, node = waiting.pop()
            for step, child in children(node):
                wish = _below(asked, node, step, found[path], memo)
                if wish is not None:
                    found[*path, step] = wish
                    waiting.append(((*path, step), child))
    return found


def quotient(asked: Bench, above: Any, below: Any) -> Any:
    """Quotient of values, nan where it has none.

    Parameters
    ----------
    above, below : array, shape (n,)
        Values

    Returns
    -------
    quotient : array, shape (n,)
        State by state
    """
    return asked.algebra.operations[ast.Div](above, below)


def _below(asked: Bench, node: Node, step: str, wish: Any, memo: Mapping[Node, Any]) -> Any:
    if isinstance(node, ast.UnaryOp):
        return -wish
    if isinstance(node, ast.Call):
        return _argument(asked, str(function_of(node)), wish)
    if not isinstance(node, ast.BinOp):
        return None  # which piece counts is decided elsewhere
    operations = asked.algebra.operations
    divide, minus = operations[ast.Div], operations[ast.Sub]
    left, right = memo[node.left], memo[node.right]
    first = step == "left"
    if isinstance(node.op, ast.Add):
        return minus(wish, right if first else left)
    if isinstance(node.op, ast.Sub):
        return operations[ast.Add](wish, right) if first else minus(left, wish)
    if isinstance(node.op, ast.Mult):
        return divide(wish, right if first else left)
    if isinstance(node.op, ast.Div):
        return operations[ast.Mult](wish, right) if first else divide(left, wish)
    return _base(asked, left, right, wish) if first else _exponent(asked, left, wish)


def _argument(asked: Bench, function: str, wish: Any) -> Any:
    functions = asked.algebra.functions
    inverse = {"exp": "log", "log": "exp", "asin": "sin", "acos": "cos", "atan": "tan"}
    if function == "sqrt":
        return np.where(_floats(wish) >= 0, wish * wish, _nan(asked))  # no root is negative
    return functions[inverse[function]](wish) if function in inverse else None


def _base(asked: Bench, base: Any, exponent: Any, wish: Any) -> Any:
    # an even power has two roots: the one nearer to what is printed
    root = asked.algebra.operations[ast.Pow](np.abs(wish), asked.algebra.operations[ast.Div](_one(asked), exponent))
    signed = root * np.sign(_floats(base))
    consistent = asked.algebra.operations[ast.Pow](signed, exponent)
    with np.errstate(all="ignore"):
        same = np.sign(_floats(consistent)) == np.sign(_floats(wish))
    return np.where(same, signed, _nan(asked))


def _exponent(asked: Bench, base: Any, wish: Any) -> Any:
    log = asked.algebra.functions["log"]
    return asked.algebra.operations[ast.Div](log(wish), log(base))


def _one(asked: Bench) -> Any:
    return mpmath.mpf(1) if asked.algebra is DIGITS else 1.0


def _nan(asked: Bench) -> Any:
    return mpmath.nan if asked.algebra is DIGITS else np.nan


def _floats(values: Any) -> Any:
    return np.asarray(values, dtype=float)
