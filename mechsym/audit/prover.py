"""Is the formula exactly the derived quantity? Many digits at random states decide, a polynomial certificate proves."""

import mpmath
import numpy as np
import sympy
from sympy import Expr

from mechsym.audit.algebra import DIGITS, FLOATS, SYMBOLS, evaluate
from mechsym.audit.bench import Bench, bench, peak, used_names, value
from mechsym.audit.question import Question, digit_values, float_values
from mechsym.audit.states import drawn
from mechsym.audit.theory.record import Theory, complete
from mechsym.audit.tree import Node, name
from mechsym.audit.units_of import ANGLE, kind_of
from mechsym.derive.identity import vanishes
from mechsym.errors import BadInput
from mechsym.quantities import record

POINTS = 20
WORKING_DIGITS = 50
TOLERANCE_DIGITS = 40


@record
class Judges:
    """The states that decide whether a formula is exact, made once per question."""

    quick: Bench  #: In floats: refutes almost everything that is wrong
    strict: Bench
    angle: bool = False  #: Whether the quantity is an angle, the same after a whole turn


def judges(question: Question, seed: int = 1) -> Judges:
    """Random states for a question.

    Returns
    -------
    judges : Judges
        The same states in floats and with many digits
    """
    values = drawn(question, POINTS, seed)
    with mpmath.workdps(WORKING_DIGITS):
        strict = digit_values(values)
    return Judges(
        quick=bench(question, float_values(values), FLOATS),
        strict=bench(question, strict, DIGITS, WORKING_DIGITS),
        angle=kind_of(question.theory, name(question.quantity)) == ANGLE,
    )


@record
class Agreement:
    """At how many states quantity and formula have a value, and whether they agree where both have."""

    expected: int  #: States at which the quantity has a value [-]
    valued: int  #: States of these at which the formula has one too [-]
    agrees: bool  #: Whether they agree to 40 digits at these, and there are any
    turned: bool = False  #: Whether an angle differs by whole turns at some

    @property
    def exact(self) -> bool:
        """Whether they agree wherever the quantity has a value, at more than half of the states."""
        return self.agrees and self.valued == self.expected and 2 * self.expected > POINTS


def agreement(judged: Judges, tree: Node) -> Agreement:
    """Compare a formula with the derived quantity at every random state."""
    printed = value(judged.strict, tree)
    expected = valued = met = turns = 0
    with mpmath.workdps(judged.strict.digits):
        for p, e in zip(printed, judged.strict.expected, strict=True):
            if mpmath.isnan(e):
                continue
            expected += 1
            if not mpmath.isnan(p):
                valued += 1
                turn = 2 * mpmath.pi * mpmath.nint((p - e) / (2 * mpmath.pi)) if judged.angle else 0
                same = bool(abs(p - turn - e) <= mpmath.mpf(10) ** -TOLERANCE_DIGITS * abs(e))
                met += same
                turns += same and turn != 0
    return Agreement(expected=expected, valued=valued, agrees=met == valued > 0, turned=turns > 0)


def is_exact(judged: Judges, tree: Node) -> bool:
    """Whether a formula agrees with the derived quantity to 40 digits at every random state; False is a refutation."""
    return agrees_quickly(judged, tree) and agreement(judged, tree).exact


def agrees_quickly(judged: Judges, tree: Node) -> bool:
    """Whether floats leave it open that a formula is exact; False is a refutation."""
    printed, expected = value(judged.quick, tree), judged.quick.expected
    with np.errstate(all="ignore"):
        if judged.angle:
            printed = printed - 2 * np.pi * np.round((printed - expected) / (2 * np.pi))
        wrong = ~(np.abs(printed - expected) <= 1e-8 * peak(expected))
    return not np.any(wrong & np.isfinite(expected))


def certified(question: Question) -> bool:
    """Whether the polynomial certificate proves an exact formula.

    Parameters
    ----------
    question : Question
        A formula that `is_exact` found exact

    Returns
    -------
    proved : bool
        False means that the digits are the only evidence
    """
    return proves_equal(question, question.formula.tree)


def proves_equal(question: Question, tree: Node, other: Node | None = None) -> bool:
    """Whether a formula is provably the derived quantity, or another formula.

    Parameters
    ----------
    other : Node, optional
        Expression in the same letters; the derived quantity when left out

    Returns
    -------
    proved : bool
        False means that no proof was found
    """
    try:
        names = symbolic_names(question)
        first = evaluate(tree, names, SYMBOLS)
        second = names[question.quantity] if other is None else evaluate(other, names, SYMBOLS)
        return vanishes(sympy.sympify(first - second))
    except (BadInput, sympy.PolynomialError, RecursionError):
        return False


def symbolic_names(question: Question) -> dict[str, Expr]:
    """Symbols for the theory's letters, closed forms for its names and the author's letters."""
    theory, formula = question.theory, question.formula
    letters = {k: _symbol(theory, k) for k in theory.letters} | {
        k: sympy.Rational(str(v)) for k, v in question.hold.items()
    }
    names: dict[str, Expr] = {"pi": sympy.pi, **letters}
    complete(theory, names, [question.quantity, *used_names(formula)], SYMBOLS)
    return names | {k: evaluate(t, names, SYMBOLS) for k, t in formula.letters.items()}


def _symbol(theory: Theory, letter: str) -> sympy.Symbol:
    record = theory.letters[letter]
    return sympy.Symbol(letter, real=True, positive=record.positive or None)
