"""Is the formula exactly the derived quantity? Many digits at random states decide, a polynomial certificate proves."""

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cached_property

import mpmath
import numpy as np
import sympy
from sympy import Expr

from mechsym.audit.judge.dimensions import ANGLE, kind_of
from mechsym.audit.judge.question import (
    Bench,
    Question,
    bench,
    digit_values,
    drawn,
    float_values,
    peak,
    turn,
    turn_values,
    used_names,
    value,
)
from mechsym.audit.judge.window import Window, branch, has_cases, is_same, is_wide, wide_window
from mechsym.audit.read.algebra import DIGITS, FLOATS, SYMBOLS, evaluate
from mechsym.audit.read.tree import Node, name
from mechsym.audit.theory.record import complete
from mechsym.derive.identity import vanishes
from mechsym.errors import BadInput
from mechsym.quantities import record

POINTS = 20
ROUNDING = 1e-9  # relative error that is rounding only [-]
_WORST = 5  # states of a turn that many digits decide where floats do not
WORKING_DIGITS = 50
TOLERANCE_DIGITS = 40


@record
class Judges:
    """The states that decide whether a formula is exact, made once per question."""

    question: Question
    values: Mapping[str, Sequence[Fraction]]
    angle: bool = False  #: Whether the quantity is an angle, the same after a whole turn

    @cached_property
    def quick(self) -> Bench:
        """In floats: refutes almost everything that is wrong."""
        return bench(self.question, float_values(self.values), FLOATS)

    @cached_property
    def strict(self) -> Bench:
        """With many digits."""
        with mpmath.workdps(WORKING_DIGITS):
            return bench(self.question, digit_values(self.values), DIGITS, WORKING_DIGITS)

    @cached_property
    def turn(self) -> Bench:
        """One turn at the source's data."""
        return turn(self.question)

    @cached_property
    def wide(self) -> Window | None:
        """States over the whole domain; None where they may only lie near the data."""
        return wide_window(self.question) if is_wide(self.question) else None


def judges(question: Question, seed: int = 1) -> Judges:
    """Random states for a question, the same in floats and with many digits."""
    angle = kind_of(question.theory, name(question.quantity)) == ANGLE
    return Judges(question=question, values=drawn(question, POINTS, seed), angle=angle)


@record
class Agreement:
    """At how many states quantity and formula have a value, and whether they agree where both have."""

    expected: int  #: States at which the quantity has a value [-]
    valued: int  #: States of these at which the formula has one too [-]
    agrees: bool  #: Whether they agree to 40 digits at these, and there are any
    turned: bool = False  #: Whether an angle differs by whole turns at some
    vanishes: bool = False  #: Whether the quantity is 0 at every state, so that nothing is learnt
    at_data: bool = True  #: Whether they agree at the source's data too, where they agree at the states

    @property
    def exact(self) -> bool:
        """Whether they agree wherever the quantity has a value, at more than half of the states, and at the data."""
        everywhere = self.agrees and self.valued == self.expected and 2 * self.expected > POINTS
        return everywhere and not self.vanishes and self.at_data


def agreement(judged: Judges, tree: Node) -> Agreement:
    """Compare a formula with the derived quantity at every random state."""
    printed = value(judged.strict, tree)
    expected = some = valued = met = turned = 0
    with mpmath.workdps(judged.strict.digits):
        for p, e in zip(printed, judged.strict.expected, strict=True):
            if mpmath.isnan(e):
                continue
            expected += 1
            some += e != 0
            if not mpmath.isnan(p):
                valued += 1
                turns = 2 * mpmath.pi * mpmath.nint((p - e) / (2 * mpmath.pi)) if judged.angle else 0
                same = bool(abs(p - turns - e) <= mpmath.mpf(10) ** -TOLERANCE_DIGITS * abs(e))
                met += same
                turned += same and turns != 0
    agrees = met == valued > 0
    return Agreement(
        expected=expected,
        valued=valued,
        agrees=agrees,
        turned=turned > 0,
        vanishes=expected > 0 and not some,
        at_data=not agrees or _agrees_at_data(judged, tree),
    )


def _agrees_at_data(judged: Judges, tree: Node) -> bool:
    # in floats, and with many digits where those leave more than rounding
    off = _errors(judged, judged.turn, tree)
    if np.max(off) <= ROUNDING:
        return True
    values = turn_values(judged.question)
    worst = {k: [Fraction(float(v[i])) for i in np.argsort(off)[-_WORST:]] for k, v in values.items()}
    with mpmath.workdps(WORKING_DIGITS):
        asked = bench(judged.question, digit_values(worst), DIGITS, WORKING_DIGITS)
    return bool(np.max(_errors(judged, asked, tree)) <= ROUNDING)


def _errors(judged: Judges, asked: Bench, tree: Node) -> np.ndarray:
    printed, expected = value(asked, tree), asked.expected
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        away = np.asarray(np.abs(printed - expected), dtype=float)
        if judged.angle:
            away = np.abs(away - 2 * np.pi * np.round(away / (2 * np.pi)))
        sizes = np.abs(np.asarray(expected, dtype=float))
        errors = away / np.maximum(sizes, 0.1 * peak(judged.turn.expected))
    # without a value where the quantity has one
    return np.where(np.isfinite(sizes), np.where(np.isnan(errors), np.where(away == 0, 0.0, np.inf), errors), 0.0)


@record
class Reach:
    """How far from the data a formula that agrees there is still the quantity."""

    everywhere: bool
    where: Node | None = None  #: What is positive wherever it is, on one branch of a root or an inverse function


def reach(judged: Judges, tree: Node) -> Reach:
    """Compare a formula with its quantity over the whole domain."""
    if judged.wide is None:
        return Reach(everywhere=True)
    strict, within = judged.wide.strict, judged.wide.told(tree)
    same = is_same(value(strict, tree), strict.expected, judged.angle) | (~within if within.any() else False)
    if same.all():
        return Reach(everywhere=True)
    # whoever writes |x| means that x may be negative
    return Reach(everywhere=False, where=None if has_cases(tree) else branch(judged.question, strict, same))


def is_exact(judged: Judges, tree: Node) -> bool:
    """Whether a formula agrees with the derived quantity at every random state; False is a refutation."""
    if not agrees_quickly(judged, tree) or not agreement(judged, tree).exact:
        return False
    reached = reach(judged, tree)
    return reached.everywhere or reached.where is not None


def agrees_quickly(judged: Judges, tree: Node) -> bool:
    """Whether floats leave it open that a formula is exact; False is a refutation."""
    printed, expected = value(judged.quick, tree), judged.quick.expected
    with np.errstate(all="ignore"):
        if judged.angle:
            printed = printed - 2 * np.pi * np.round((printed - expected) / (2 * np.pi))
        wrong = ~(np.abs(printed - expected) <= 1e-8 * peak(expected))
    return not np.any(wrong & np.isfinite(expected))


def proves_equal(question: Question, tree: Node, other: Node | None = None) -> bool:
    """Whether a formula is provably the derived quantity, or another one; False: no proof was found."""
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
    symbols = {k: sympy.Symbol(k, real=True, positive=about.positive or None) for k, about in theory.letters.items()}
    held = {k: sympy.Rational(str(v)) for k, v in question.hold.items()}
    names: dict[str, Expr] = {"pi": sympy.pi, **symbols, **held}
    complete(theory, names, [question.quantity, *used_names(formula)], SYMBOLS)
    return names | {k: evaluate(t, names, SYMBOLS) for k, t in formula.letters.items()}
