"""From sympy as people have it to named CasADi functions.

    from mechsym import convert
    f = convert.casadi(KanesMethod(..), inputs=[q1, q2, u1, u2, m, g])
    mass_matrix, forcing = f(0.1, 0.2, 0, 0, 1, 9.81)          # mass_matrix * d/dt (q, u) = forcing

Expressions are evaluated on CasADi symbols node by node; equal parts become one node, and what has no counterpart is
refused by name. Free letters are symbols, dynamicsymbols and their derivatives, with names that CasADi takes.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import reduce

import casadi as ca
import sympy as sp
from sympy.physics.mechanics import KanesMethod, LagrangesMethod

from mechsym.derive.letterless import free_letters, names, plain
from mechsym.derive.printer import UnsupportedNode, read
from mechsym.errors import BadInput

__all__ = ["casadi"]


def casadi(source: object, inputs: Sequence[sp.Basic] = ()) -> ca.Function:
    r"""A sympy expression, matrix or method as a named CasADi function.

    .. math:: M(x)\, \dot x = f(x), \quad x = (q, u) \text{ for the methods}

    Returns function: outputs `mass_matrix` and `forcing` of a method, else `value` or `value0, value1, ..` [units of
    the source].

    source: what to convert; the methods give `mass_matrix` and `forcing` of all states, in the units of the source.

    inputs: arguments in order, each in its own unit; without them all free letters, sorted by name. Arguments are
    called `q1` for q1(t), `q1d` for its derivative. Raises BadInput: a letter is missing among the inputs, or a node
    has no counterpart; the message names it.
    Source: sympy.physics.mechanics, `mass_matrix_full`, `forcing_full`; kinematic equations are put into the forcing.
    Valid: real arguments.

    >>> from sympy import Symbol, atan2
    >>> from mechsym import convert
    >>> x, y = Symbol("x"), Symbol("y")
    >>> float(convert.casadi(atan2(y, x), inputs=(x, y))(-1, 0))
    3.141592653589793
    """
    outputs = _outputs(source)
    matrices = [plain(sp.ImmutableDenseMatrix(m)) for m in outputs.values()]
    letters = [_read(s, "inputs:") for s in inputs] or free_letters(matrices)
    called = names(letters)
    if clash := sorted(set(called) & set(outputs)):
        raise BadInput(f"the letter {clash[0]!r} has the name of an output; rename it")
    symbols = [ca.SX.sym(name) for name in called]
    known = dict(zip(letters, symbols, strict=True))
    values = []
    for m in matrices:
        rows = [ca.horzcat(*(evaluate(m[i, j], known) for j in range(m.cols))) for i in range(m.rows)]
        values.append(ca.vertcat(*rows))
    return ca.Function("converted", symbols, values, called, list(outputs), {"cse": True})


def _outputs(source: object) -> dict[str, sp.MatrixBase]:
    """Named matrices of what is converted."""
    if isinstance(source, LagrangesMethod):
        if source.eom is None:
            source.form_lagranges_equations()
        return {"mass_matrix": source.mass_matrix_full, "forcing": source.forcing_full}
    if isinstance(source, KanesMethod):
        try:
            mass, forcing = source.mass_matrix_full, source.forcing_full
        except (ValueError, AttributeError) as error:
            raise BadInput(f"the KanesMethod has no equations yet ({error}); call kanes_equations(..) first") from None
        rates = source.kindiffdict()
        return {"mass_matrix": mass.subs(rates), "forcing": forcing.subs(rates)}
    if isinstance(source, (list, tuple)):
        return {f"value{i}": _as_matrix(s) for i, s in enumerate(source)}
    return {"value": _as_matrix(source)}


def _read(value: object, what: str) -> sp.Basic:
    try:
        return read(value)
    except UnsupportedNode as error:
        raise BadInput(f"{what} {error}") from None


def _as_matrix(source: object) -> sp.MatrixBase:
    value = _read(source, "an expression, matrix, LagrangesMethod or KanesMethod is wanted;")
    if isinstance(value, sp.MatrixBase):
        return value
    if isinstance(value, sp.logic.boolalg.Boolean) and not isinstance(value, sp.Expr):  # a Symbol is both
        value = sp.Piecewise((1, value), (0, True))
    if isinstance(value, sp.Expr):
        return sp.ImmutableDenseMatrix([[value]])
    raise BadInput(f"{type(value).__name__} is no sympy expression, matrix, LagrangesMethod or KanesMethod")


_UNARY = {
    "sin": ca.sin, "cos": ca.cos, "tan": ca.tan, "asin": ca.asin, "acos": ca.acos, "atan": ca.atan, "sinh": ca.sinh,
    "cosh": ca.cosh, "tanh": ca.tanh, "asinh": ca.asinh, "acosh": ca.acosh, "atanh": ca.atanh, "exp": ca.exp,
    "log": ca.log, "Abs": ca.fabs, "sign": ca.sign, "floor": ca.floor, "ceiling": ca.ceil, "erf": ca.erf,
    "Not": ca.logic_not,
}  # fmt: skip
_RECIPROCAL = {"sec": ca.cos, "csc": ca.sin, "cot": ca.tan}
_FOLDED: dict[str, Callable[[ca.SX, ca.SX], ca.SX]] = {
    "Add": lambda a, b: a + b, "Mul": lambda a, b: a * b, "Max": ca.fmax, "Min": ca.fmin, "And": ca.logic_and,
    "Or": ca.logic_or, "Xor": ca.ne,
}  # fmt: skip
_BINARY: dict[str, Callable[[ca.SX, ca.SX], ca.SX]] = {
    "atan2": ca.atan2, "Equality": ca.eq, "Unequality": ca.ne, "StrictLessThan": ca.lt, "LessThan": ca.le,
    "StrictGreaterThan": ca.gt, "GreaterThan": ca.ge,
    # sympy's remainder has the divisor's sign
    "Mod": lambda a, b: a - b * ca.floor(a / b),
    "Heaviside": lambda x, at_zero: ca.if_else(ca.eq(x, 0), at_zero, ca.gt(x, 0)),
}  # fmt: skip


def evaluate(expression: sp.Basic, letters: Mapping[sp.Basic, ca.SX]) -> ca.SX:
    """The expression on CasADi symbols.

    letters: mapping of Basic to SX, a symbol for each free letter; filled up with the values of all parts. Raises
    BadInput: a node without a counterpart, or a letter without a symbol.
    """
    known: dict[sp.Basic, ca.SX] = dict(letters)
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


def _node(node: sp.Basic, known: Mapping[sp.Basic, ca.SX]) -> ca.SX:
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
        base, exponent = arguments
        if node.exp == sp.Rational(1, 2):
            return ca.sqrt(base)
        if node.exp == -sp.Rational(1, 2):
            return 1 / ca.sqrt(base)
        if node.exp.is_Integer and abs(int(node.exp)) <= 4:
            product = reduce(lambda a, b: a * b, [base] * abs(int(node.exp)))
            return product if node.exp.is_positive else 1 / product
        return ca.exp(exponent) if node.base == sp.E else base**exponent
    if name in _UNARY and len(arguments) == 1:
        return _UNARY[name](arguments[0])
    if name in _RECIPROCAL:
        return 1 / _RECIPROCAL[name](arguments[0])
    if name in _FOLDED:
        return reduce(_FOLDED[name], arguments)
    if name in _BINARY and len(arguments) == 2:
        return _BINARY[name](*arguments)
    if name == "ITE":
        return ca.if_else(arguments[0], arguments[1], arguments[2])
    if node.is_Symbol or isinstance(node, (sp.core.function.AppliedUndef, sp.Derivative)):
        raise BadInput(f"the letter {node} is not among the inputs; add it to inputs=(..)")
    raise BadInput(f"{name} in {str(node)[:80]} has no CasADi counterpart; known are {', '.join(supported())}")


def _piecewise(node: sp.Piecewise, known: Mapping[sp.Basic, ca.SX]) -> ca.SX:
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
