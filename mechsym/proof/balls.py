"""Balls: a midpoint and a radius that hold the exact value, by python-flint's arb (real) and acb (complex)."""

import decimal as decimals
from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
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


_EITHER: dict[str, Callable[..., Ball]] = {
    "add": lambda a, b: a + b, "sub": lambda a, b: a - b, "mul": lambda a, b: a * b, "div": lambda a, b: a / b,
    "neg": lambda a: -a, "inv": lambda a: 1 / a, "sq": lambda a: a * a, "twice": lambda a: a + a,
    "sin": lambda a: a.sin(), "cos": lambda a: a.cos(), "tan": lambda a: a.tan(), "exp": lambda a: a.exp(),
    "sinh": lambda a: a.sinh(), "cosh": lambda a: a.cosh(), "tanh": lambda a: a.tanh(), "atan": lambda a: a.atan(),
    "asin": lambda a: a.asin(), "acos": lambda a: a.acos(),
}  # fmt: skip
#: Operators of the tape by what they do to real balls, and to complex ones where the value is analytic
REAL = _EITHER | {"sqrt": lambda a: a.sqrt(), "log": lambda a: a.log(), "pow": lambda a, b: a**b}
COMPLEX = _EITHER | {
    "sqrt": lambda a: a.sqrt(analytic=True),
    "log": lambda a: a.log(analytic=True),
    "pow": lambda a, b: a.pow(b, analytic=True),
}
for _cut in ("atan", "asin", "acos"):  # their cuts are not looked at
    del COMPLEX[_cut]


def evaluate(tape: Tape, operators: Mapping[str, Callable[..., Ball]], inputs: Sequence[Ball]) -> list[Ball]:
    """The results of a program for balls; a place where it is not defined gives a ball that is not finite."""
    values: list[Ball] = []
    for op, args in tape.nodes:
        if op == "input":
            values.append(inputs[args[0]])
        elif op == "constant":
            values.append(arb(args[0]))
        else:
            values.append(operators[op](*[values[a] for a in args]))
    return [values[r] for r in tape.results]


def refuse_unknown(tape: Tape, known: Mapping[str, object], what: str) -> None:
    """Refuse operators that a proof has no rule for."""
    others = sorted({op for op, _ in tape.nodes} - {*known, "input", "constant"})
    if others:
        raise BadInput(f"{what}: {', '.join(others)}: no smooth closed form that can be enclosed; leave it out")
