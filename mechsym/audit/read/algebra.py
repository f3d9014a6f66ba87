"""One tree, three number systems: floats for speed, many digits for decisions, symbols for proofs.

Values are arrays of states. What has no value (a root of a negative number, a division by zero, a power beyond all
bounds) is nan in the first two systems, so that hostile input costs nothing and never counts as agreement.
"""

import ast
import operator
from collections.abc import Callable, Iterator, Mapping, MutableMapping
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np
import sympy

from mechsym.audit.read.tree import Node, as_printed, children, digest, function_of, letters
from mechsym.errors import BadInput
from mechsym.quantities import record

Values = Any  # numbers of one system, or an array of them: one for each state, with parts on a first axis
MAX_EXPONENT = 10_000
MAX_ARGUMENT = 1e12


@record
class Algebra:
    """A number system."""

    number: Callable[[Fraction], Values]
    operations: Mapping[type, Callable[..., Values]]  #: ast operator class to function of two values
    functions: Mapping[str, Callable[..., Values]]
    pi: Callable[[], Values]
    choose: Callable[[Values, Values, Values], Values] = np.where  #: The second where the first holds, else the third


class Layered(MutableMapping[bytes, Values]):
    """Values of expressions of one load; those that no load changes lie in a dictionary that all loads share."""

    def __init__(self, common: dict[bytes, Values], changes: Mapping[str, bool]) -> None:
        self.own: dict[bytes, Values] = {}
        self.common, self.changes = common, changes

    def home(self, tree: Node) -> dict[bytes, Values]:
        """Where the value of an expression belongs."""
        return self.own if any(map(self.changes.__getitem__, letters(tree))) else self.common

    def __getitem__(self, said: bytes) -> Values:
        return self.own[said] if said in self.own else self.common[said]

    def __setitem__(self, said: bytes, value: Values) -> None:
        self.own[said] = value

    def __delitem__(self, said: bytes) -> None:
        del self.own[said]

    def __iter__(self) -> Iterator[bytes]:
        return iter(self.own)

    def __len__(self) -> int:
        return len(self.own)

    def popitem(self) -> tuple[bytes, Values]:
        """The value of this load that came last."""
        return self.own.popitem()


def evaluate(
    tree: Node, names: Mapping[str, Values], algebra: Algebra, memo: MutableMapping[bytes, Values] | None = None
) -> Values:
    """Value of an expression; `memo` is filled by what the parts say, for all trees with the same names."""
    if isinstance(tree, ast.Name):
        return names[tree.id]
    memo = {} if memo is None else memo
    said = digest(tree)
    if said in memo:
        return memo[said]
    if isinstance(tree, ast.BinOp):
        left, right = evaluate(tree.left, names, algebra, memo), evaluate(tree.right, names, algebra, memo)
        value = algebra.operations[type(tree.op)](left, right)
    elif isinstance(tree, ast.Constant):
        value = algebra.number(as_printed(tree.value))
    else:
        values = [evaluate(child, names, algebra, memo) for _, child in children(tree)]
        if isinstance(tree, ast.Call):
            value = algebra.functions[str(function_of(tree))](values[0])
        elif isinstance(tree, ast.Compare):
            value = _COMPARED[type(tree.ops[0])](*values)
        else:
            value = algebra.choose(*values) if isinstance(tree, ast.IfExp) else -values[0]
    home = memo.home(tree) if isinstance(memo, Layered) else memo
    home[said] = value
    return value


_COMPARED: dict[type, Callable[..., Values]] = {
    ast.Lt: operator.lt, ast.LtE: operator.le, ast.Gt: operator.gt, ast.GtE: operator.ge,
}  # fmt: skip


def _total(value: Values) -> Values:
    # a letter with parts has a first axis for them; anything else has no sum
    if np.ndim(value) >= 2:
        return np.sum(value, axis=0)
    return np.full(np.shape(value), mpmath.nan if np.asarray(value).dtype == object else np.nan)


FLOATS = Algebra(
    number=lambda f: np.float64(f.numerator) / np.float64(f.denominator),
    operations={
        ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply, ast.Div: np.divide,
        ast.Pow: lambda base, exponent: np.power(base, np.where(np.abs(exponent) <= MAX_EXPONENT, exponent, np.nan)),
    },
    functions={
        "sin": np.sin, "cos": np.cos, "tan": np.tan, "cot": lambda x: 1 / np.tan(x), "asin": np.arcsin,
        "acos": np.arccos, "atan": np.arctan, "sqrt": np.sqrt, "exp": np.exp, "log": np.log, "abs": np.abs,
        "sum": _total,
    },
    pi=lambda: np.float64(np.pi),
)  # fmt: skip


def _each(function: Callable[..., Values], arguments: int = 1) -> Callable[..., Values]:
    # one state at a time: what raises or leaves the real numbers is nan
    def guarded(*values: Values) -> Values:
        try:
            result = function(*values)
        except (ZeroDivisionError, ValueError, OverflowError):
            return mpmath.nan
        return result if isinstance(result, mpmath.mpf) else mpmath.nan

    return np.frompyfunc(guarded, arguments, 1)


def _within(function: Callable[..., Values]) -> Callable[..., Values]:
    return _each(lambda x: function(x) if abs(x) <= MAX_ARGUMENT else mpmath.nan)


def _power(base: Values, exponent: Values) -> Values:
    if not abs(exponent) <= MAX_EXPONENT:
        return mpmath.nan
    return base ** int(exponent) if exponent == int(exponent) else base**exponent


DIGITS = Algebra(
    number=lambda f: mpmath.mpf(f.numerator) / f.denominator,
    operations={
        ast.Add: np.add, ast.Sub: np.subtract, ast.Mult: np.multiply,
        ast.Div: _each(lambda a, b: a / b, 2), ast.Pow: _each(_power, 2),
    },
    functions={
        "sin": _within(mpmath.sin), "cos": _within(mpmath.cos), "tan": _within(mpmath.tan),
        "cot": _within(mpmath.cot), "asin": _each(mpmath.asin), "acos": _each(mpmath.acos),
        "atan": _each(mpmath.atan), "sqrt": _each(mpmath.sqrt), "exp": _within(mpmath.exp),
        "log": _each(mpmath.log), "abs": _each(abs), "sum": _total,
    },
    pi=lambda: +mpmath.pi,
)  # fmt: skip


def _unproved(*values: Values) -> Values:
    raise BadInput("a formula with cases is decided by its digits alone")


def _symbolic_power(base: Values, exponent: Values) -> Values:
    # sympy computes powers of numbers at once, however large
    if exponent.is_number and not abs(exponent) <= (MAX_EXPONENT if base.free_symbols else MAX_EXPONENT**0.5):
        raise BadInput(f"the exponent {str(exponent)[:40]} is too large")
    return base**exponent


SYMBOLS = Algebra(
    number=lambda f: sympy.Rational(f.numerator, f.denominator),
    operations={
        ast.Add: np.add,
        ast.Sub: np.subtract,
        ast.Mult: np.multiply,
        ast.Pow: np.frompyfunc(_symbolic_power, 2, 1),
        ast.Div: np.frompyfunc(lambda a, b: a / b, 2, 1),
    },
    functions={
        name: np.frompyfunc(getattr(sympy, name if name != "abs" else "Abs"), 1, 1)
        for name in ("sin", "cos", "tan", "cot", "asin", "acos", "atan", "sqrt", "exp", "log", "abs")
    }
    | {"sum": lambda value: np.sum(value) if np.ndim(value) else sympy.nan},
    pi=lambda: sympy.pi,
    choose=_unproved,
)
