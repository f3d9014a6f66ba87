"""What every part of a formula would have to be for the whole to be right, all else as printed.

The derived value is pushed down from the root through sums, products, powers and roots. An edit of one part repairs
the formula when its new value meets the required one, so that no candidate formula is ever evaluated as a whole.
"""

import ast
from collections.abc import Mapping

import mpmath
import numpy as np

from mechsym.audit.judge.question import Bench
from mechsym.audit.read.algebra import DIGITS, Values
from mechsym.audit.read.tree import Node, Path, children, function_of, is_operation, value_of

Required = Mapping[Path, tuple[Values, ...]]
_INVERSE = {
    "exp": "log", "log": "exp", "asin": "sin", "acos": "cos", "atan": "tan", "sin": "asin", "cos": "acos",
    "tan": "atan",
}  # fmt: skip
CIRCULAR = ("sin", "cos", "tan")
_MOST = 4  # values that one part is asked for


def required(asked: Bench, tree: Node, memo: Mapping[Node, Values], both: bool = True) -> Required:
    """Required values of all parts that can be reached, the nearest to the print first.

    Parts under sums over parts and cotangents are not reached; `both`: an even power, |x|, a sine and a cosine ask for
    both values, rather than for the one with the printed sign or in the first quadrant.
    """
    wanted: dict[Path, tuple[Values, ...]] = {(): (asked.expected,)}
    waiting: list[tuple[Path, Node]] = [((), tree)]
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        while waiting:
            path, node = waiting.pop()
            for step, child in children(node):
                wishes = [w for above in wanted[path] for w in _below(asked, node, step, above, memo, both)]
                if wishes:
                    wanted[*path, step] = tuple(wishes[:_MOST])
                    waiting.append(((*path, step), child))
    return wanted


def quotient(asked: Bench, above: Values, below: Values) -> Values:
    """Quotient of values state by state, nan where it has none."""
    return asked.algebra.operations[ast.Div](above, below)


def _below(
    asked: Bench, node: Node, step: str, wish: Values, memo: Mapping[Node, Values], both: bool
) -> tuple[Values, ...]:
    if isinstance(node, ast.UnaryOp):
        return (-wish,)
    if isinstance(node, ast.Call):
        function = str(function_of(node))
        functions = asked.algebra.functions
        if function == "sqrt":
            return (np.where(_floats(wish) >= 0, wish * wish, _nan(asked)),)  # no root is negative
        if function not in _INVERSE or function in CIRCULAR and not both:
            return (wish, -wish) if function == "abs" else ()
        value = functions[_INVERSE[function]](wish)
        # of a sine and a cosine either angle, the crank being in its first quadrant
        other = {"sin": lambda: asked.algebra.pi() - value, "cos": lambda: -value}.get(function)
        return (value, other()) if other else (value,)
    if not isinstance(node, ast.BinOp):
        return ()  # which piece counts is decided elsewhere
    operations = asked.algebra.operations
    divide, minus = operations[ast.Div], operations[ast.Sub]
    left, right = memo[node.left], memo[node.right]
    first = step == "left"
    if isinstance(node.op, ast.Add):
        return (minus(wish, right if first else left),)
    if isinstance(node.op, ast.Sub):
        return (operations[ast.Add](wish, right) if first else minus(left, wish),)
    if isinstance(node.op, ast.Mult):
        return (divide(wish, right if first else left),)
    if isinstance(node.op, ast.Div):
        return (operations[ast.Mult](wish, right) if first else divide(left, wish),)
    if not first:
        log = asked.algebra.functions["log"]
        return (divide(log(wish), log(left)),)
    # the root with the sign of what is printed; of an even power the other ones too, of one sign at all states
    power, one = operations[ast.Pow], mpmath.mpf(1) if asked.algebra is DIGITS else 1.0
    root, signs = power(np.abs(wish), divide(one, right)), np.sign(_floats(left))
    signed = root * signs
    consistent = power(signed, right)
    with np.errstate(all="ignore"):
        same = np.sign(_floats(consistent)) == np.sign(_floats(wish))
    others = [s for s in (-1, 1) if not np.all(signs == s)] if both and _is_even(node) else []
    return tuple(np.where(same, r, _nan(asked)) for r in (signed, *(s * root for s in others)))


def is_squared(nodes: Mapping[Path, Node], path: Path) -> bool:
    """Whether a part is raised to an even power."""
    return path[-1:] == ("left",) and _is_even(nodes[path[:-1]])


def _is_even(node: Node) -> bool:
    power = value_of(node.right) if is_operation(node, ast.Pow) else None
    return power is not None and power.numerator % 2 == 0


def _nan(asked: Bench) -> Values:
    return mpmath.nan if asked.algebra is DIGITS else np.nan


def _floats(values: Values) -> Values:
    return np.asarray(values, dtype=float)
