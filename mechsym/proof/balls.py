"""Balls: a midpoint and a radius that hold the exact value, by python-flint's arb (real) and acb (complex)."""

import decimal as decimals
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from operator import add, methodcaller, mul, neg, sub, truediv
from typing import Any

from mechsym.errors import BadInput, MissingExtra
from mechsym.native.tape import Tape
from mechsym.quantities.units import Scalar

try:
    import flint
except ImportError as error:
    raise MissingExtra("prove needs python-flint: pip install 'mechsym[proof]'") from error

acb, arb, arb_mat, arb_series, ctx = flint.acb, flint.arb, flint.arb_mat, flint.arb_series, flint.ctx
#: A sum of a few thousand doubles of one sign, each rounded to nearest, is below this times what comes out
UP = 1 + 1e-9
Ball = Any  # arb or acb: python-flint has no types


def decimal(value: Scalar) -> Ball:
    """The decimal number [SI] that a double prints as, in a ball: 0.26 and not the double next to it."""
    return ratio(Fraction(repr(float(value))))


def ratio(exact: Fraction) -> Ball:
    """A rational number in a ball."""
    return arb(flint.fmpq(exact.numerator, exact.denominator))


def upper(ball: Ball) -> float:
    """A double [unit of the ball] that no absolute value in it is above; infinite where the ball is not finite."""
    size = float(ball.abs_upper()) * UP
    return size if size == size else float("inf")


def outward(value: float, digits: int, up: bool = True) -> str:
    """A bound [any unit] to some digits, above it, or below it where it is a lower one."""
    rounding = decimals.ROUND_CEILING if up else decimals.ROUND_FLOOR
    return f"{float(decimals.Context(prec=digits, rounding=rounding).create_decimal_from_float(value)):g}"


def _named(*names: str) -> dict[str, Callable[..., Any]]:
    return {name: methodcaller(name) for name in names}


Operators = dict[str, Callable[..., Any]]
_EITHER: Operators = {
    "add": add, "sub": sub, "mul": mul, "div": truediv, "neg": neg,
    "inv": lambda a: 1 / a, "sq": lambda a: a * a, "twice": lambda a: a + a, **_named("sin", "cos", "tan", "exp"),
}  # fmt: skip
#: Operators of the tape by what they do to Taylor series, to real balls, and to complex ones where they are analytic
SERIES: Operators = {**_EITHER, **_named("sqrt", "log"), "pow": pow}
REAL: Operators = {**SERIES, **_named("sinh", "cosh", "tanh", "atan", "asin", "acos")}
COMPLEX: Operators = {
    **_EITHER,
    **_named("sinh", "cosh", "tanh"),
    "sqrt": methodcaller("sqrt", analytic=True),
    "log": methodcaller("log", analytic=True),
    "pow": lambda a, b: a.pow(b, analytic=True),
}


def evaluate(tape: Tape, operators: Mapping[str, Callable[..., Ball]], inputs: Sequence[Ball]) -> list[Ball]:
    """The results of a program for balls; a place where it is not defined gives a ball that is not finite."""
    values: list[Ball] = []
    rules: Operators = {**operators, "input": inputs.__getitem__, "constant": arb}
    for op, args in tape.nodes:
        leaf = op in ("input", "constant")
        values.append(rules[op](*(args if leaf else [values[a] for a in args])))
    return [values[r] for r in tape.results]


def coefficients(
    tape: Tape, operators: Mapping[str, Callable[..., Any]], inputs: Sequence[list[Ball] | Ball], order: int
) -> list[list[Ball]]:
    """The first coefficients of the results, for Taylor series of the inputs that have a list of coefficients."""
    before, ctx.cap = ctx.cap, order
    try:
        values = evaluate(tape, operators, [arb_series(c[:order]) if isinstance(c, list) else c for c in inputs])
    finally:
        ctx.cap = before
    series = (v if isinstance(v, arb_series) else [v, *[0] * order] for v in values)  # or a ball that stays
    return [[arb(one[k]) for k in range(order)] for one in series]


def refuse_unknown(tape: Tape, known: Mapping[str, object], what: str) -> None:
    """Refuse operators that a proof has no rule for."""
    others = sorted({op for op, _ in tape.nodes} - {*known, "input", "constant"})
    if others:
        raise BadInput(f"{what}: {', '.join(others)}: no smooth closed form that can be enclosed; leave it out")
