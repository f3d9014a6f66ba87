"""sympy expressions evaluated on CasADi symbols, node by node; equal parts become one node."""

from collections.abc import Callable, Mapping
from functools import reduce
from typing import Any

import casadi as ca
import sympy as sp

from mechsym.errors import BadInput

_UNARY = {
    "sin": ca.sin, "cos": ca.cos, "tan": ca.tan, "asin": ca.asin, "acos": ca.acos, "atan": ca.atan, "sinh": ca.sinh,
    "cosh": ca.cosh, "tanh": ca.tanh, "asinh": ca.asinh, "acosh": ca.acosh, "atanh": ca.atanh, "exp": ca.exp,
    "log": ca.log, "Abs": ca.fabs, "sign": ca.sign, "floor": ca.floor, "ceiling": ca.ceil, "erf": ca.erf,
    "Not": ca.logic_not,
}  # fmt: skip
_RECIPROCAL = {"sec": ca.cos, "csc": ca.sin, "cot": ca.tan}
_FOLDED: dict[str, Callable[[Any, Any], Any]] = {
    "Add": lambda a, b: a + b, "Mul": lambda a, b: a * b, "Max": ca.fmax, "Min": ca.fmin, "And": ca.logic_and,
    "Or": ca.logic_or, "Xor": ca.ne,
}  # fmt: skip
_BINARY: dict[str, Callable[[Any, Any], Any]] = {
    "atan2": ca.atan2, "Equality": ca.eq, "Unequality": ca.ne, "StrictLessThan": ca.lt, "LessThan": ca.le,
    "StrictGreaterThan": ca.gt, "GreaterThan": ca.ge,
    # sympy's remainder has the divisor's sign
    "Mod": lambda a, b: a - b * ca.floor(a / b),
    "Heaviside": lambda x, at_zero: ca.if_else(ca.eq(x, 0), at_zero, ca.gt(x, 0)),
}  # fmt: skip


def evaluate(expression: sp.Basic, letters: Mapping[sp.Basic, Any]) -> Any:
    """The expression on CasADi symbols.

    Parameters
    ----------
    letters : mapping of Basic to SX
        A symbol for each free letter; filled up with the values of all parts

    Raises
    ------
    BadInput
        A node without a counterpart, or a letter without a symbol
    """
    known: dict[sp.Basic, Any] = dict(letters)
    # innermost first, without recursion: equations of motion are deeper than Python's stack
    stack = [(expression, False)]
    while stack:
        node, ready = stack.pop()
        if node in known:
            continue
        if ready or not _parts(node):
            known[node] = _node(node, known)
        else:
            stack += [(node, True), *((a, False) for a in _parts(node))]
    return known[expression]


def _parts(node: sp.Basic) -> tuple[sp.Basic, ...]:
    """What must have a value before a node has one; the inside of a letter such as q(t) is not looked at."""
    if isinstance(node, (sp.core.function.AppliedUndef, sp.Derivative)):
        return ()
    if isinstance(node, sp.Piecewise):
        return tuple(a for pair in node.args for a in pair.args)
    return node.args


def _node(node: sp.Basic, known: Mapping[sp.Basic, Any]) -> Any:
    name = type(node).__name__
    if node in (sp.nan, sp.zoo):
        raise BadInput("the expression holds an undefined number (nan or zoo); simplify it first")
    if isinstance(node, (sp.Number, sp.NumberSymbol)):
        return ca.SX(float(node))
    if isinstance(node, (sp.logic.boolalg.BooleanTrue, sp.logic.boolalg.BooleanFalse)):
        return ca.SX(bool(node))
    if isinstance(node, sp.Piecewise):
        return _piecewise(node, known)
    arguments = [known[a] for a in _parts(node)]
    if isinstance(node, sp.Pow):
        return _power(node, arguments)
    if name in _UNARY and len(arguments) == 1:
        return _UNARY[name](arguments[0])
    if name in _RECIPROCAL:
        return 1 / _RECIPROCAL[name](arguments[0])
    if name in _FOLDED:
        return reduce(_FOLDED[name], arguments)
    if name in _BINARY and len(arguments) == 2:
        return _BINARY[name](*arguments)
    if name == "ITE":
        return ca.if_else(*arguments)
    if node.is_Symbol or isinstance(node, (sp.core.function.AppliedUndef, sp.Derivative)):
        raise BadInput(f"the letter {node} is not among the inputs; add it to inputs=(..)")
    raise BadInput(f"{name} in {str(node)[:80]} has no CasADi counterpart; known are {', '.join(supported())}")


def _power(node: sp.Pow, arguments: list[Any]) -> Any:
    base, exponent = arguments
    if node.exp == sp.Rational(1, 2):
        return ca.sqrt(base)
    if node.exp == -sp.Rational(1, 2):
        return 1 / ca.sqrt(base)
    if node.exp.is_Integer and abs(int(node.exp)) <= 4:
        product = reduce(lambda a, b: a * b, [base] * abs(int(node.exp)))
        return product if node.exp.is_positive else 1 / product
    return ca.exp(exponent) if node.base == sp.E else base**exponent


def _piecewise(node: sp.Piecewise, known: Mapping[sp.Basic, Any]) -> Any:
    *branches, (last, condition) = node.args
    if condition != sp.true:
        raise BadInput(f"{node} has no value where no condition holds; end it with (value, True)")
    result = known[last]
    for value, test in reversed(branches):
        result = ca.if_else(known[test], known[value], result)
    return result


def supported() -> list[str]:
    """Functions and nodes that are converted."""
    return sorted([*_UNARY, *_RECIPROCAL, *_FOLDED, *_BINARY, "ITE", "Piecewise", "Pow"], key=str.lower)
