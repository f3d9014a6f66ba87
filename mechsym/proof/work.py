r"""Integrals of a law that is smooth between given angles, in balls: work that an engine's torque does.

A stretch of angles has a Taylor polynomial about its middle, with the coefficient of the last order taken over the
whole stretch (Lagrange):

.. math:: \int_{-h}^{h} f = \sum_{k\,even} \frac{2 c_k h^{k+1}}{k+1} \pm \frac{2 |c_n| h^{n+1}}{n+1}

Stretches grow from the start of each piece, where a power of the angle may have its branch; the first is taken by the
values over it alone.
"""

from collections.abc import Callable, Sequence
from typing import Any

from mechsym.errors import BadInput
from mechsym.native.tape import Tape
from mechsym.proof.balls import SERIES, Ball, arb, arb_series, coefficients, ctx, evaluate
from mechsym.proof.rounding import VALUES

_ORDER, _BITS = 12, 80
_FIRST, _GROWTH, _WIDEST = 1e-6, 1.5, 0.03  # stretches [rad]
_BRANCHED = {"pow", "sqrt", "log", "fmax", "fmin"}
Piece = tuple[float, float, Tape]  #: From and to an angle [rad], and the law there


def _larger(a: Any, b: Any) -> Any:
    first, second = (x[0] if isinstance(x, arb_series) else x for x in (a, b))
    if first > second:
        return a
    if first < second:
        return b
    raise BadInput("it bends within a piece")


_LIMITS: dict[str, Callable[..., Any]] = {"fmax": _larger, "fmin": lambda a, b: -_larger(-a, -b)}
_SERIES = SERIES | _LIMITS | {"expm1": lambda a: a.exp() - 1, "pow": lambda a, b: (a.log() * b).exp()}


def _power_from_zero(a: Ball, b: Ball) -> Ball:
    """A power of what a limit keeps from falling below 0, over a ball that may reach there."""
    return a**b if not a.contains(0) or not b > 0 else arb(0.5, 0.5) * arb(a.upper()) ** b


_PLAIN = VALUES | {"expm1": lambda a: a.expm1(), "pow": _power_from_zero}


def integrals(pieces: Sequence[Piece], angles: Sequence[float]) -> list[Ball]:
    """The integral from the start of the first piece to each of some ascending angles [rad] within the pieces.

    Raises BadInput: an operator that has no rule, or a piece that is not smooth.
    """
    for _, _, tape in pieces:
        if others := sorted({op for op, _ in tape.nodes} - {*_SERIES, "input", "constant"}):
            raise BadInput(f"a law with {', '.join(others)} cannot be enclosed")
    sums, total, wanted = [], arb(0), list(angles)
    with ctx.workprec(_BITS):
        for start, end, tape in pieces:
            has_branch = not _BRANCHED.isdisjoint(op for op, _ in tape.nodes)
            a, width = start, _FIRST if has_branch else _WIDEST
            while a < end:
                b = min(a + width, end, *(w for w in wanted if w > a))
                while wanted and wanted[0] <= a:
                    sums.append(total)
                    wanted.pop(0)
                try:
                    total += _over(tape, a, b, plain=width == _FIRST)
                except (ValueError, ZeroDivisionError) as error:  # of a series that has no inverse
                    raise BadInput(f"a law cannot be enclosed at {a:.4g} rad ({error})") from error
                a, width = b, min(width * _GROWTH, _WIDEST)
    sums += [total] * len(wanted)
    if not all(ball.is_finite() for ball in sums):
        raise BadInput("a law that is not finite everywhere cannot be enclosed")
    return sums


def _over(tape: Tape, a: float, b: float, plain: bool) -> Ball:
    """The integral over a stretch."""
    whole, length = arb(a).union(arb(b)), arb(b) - arb(a)
    if plain:
        return evaluate(tape, _PLAIN, [whole])[0] * length
    h = length / 2
    near, over = (coefficients(tape, _SERIES, [[at, arb(1)]], _ORDER + 1)[0] for at in ((arb(a) + arb(b)) / 2, whole))
    rest = arb(0, float((over[_ORDER] * h ** (_ORDER + 1)).abs_upper()) * 2.1 / (_ORDER + 1))
    return sum((2 * near[k] * h ** (k + 1) / (k + 1) for k in range(0, _ORDER, 2)), rest)
