r"""How good an approximation is as the rods grow, lambda -> eps lambda at a fixed crank, for every load.

A quantity of one mass dimension is a sum over masses, inertias and forces; each of them is a group with its own error.
The order k of a group is the power of eps with which its relative error vanishes; -1 when the leading term is wrong.
A truncation is pure when each coefficient of lambda^j is the derived one or 0, honest when no power below its order is
wrong and its error there is at most the derived term: never worse than leaving that power out.
"""

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from functools import cache, cached_property

import mpmath
import numpy as np

from mechsym.audit.judge.question import (
    Bench,
    Question,
    bench,
    digit_values,
    drawn,
    small_rods,
    turn_values,
    used_names,
    value,
)
from mechsym.audit.read.algebra import DIGITS, Layered, Values
from mechsym.audit.read.tree import Node, digest, letters
from mechsym.audit.theory.record import complete, dependencies
from mechsym.quantities import dimension, record

ORDER_DIGITS = 110


class _Changes(dict[str, bool]):
    """Whether a letter or name changes with the loads, found when it is first asked."""

    def __init__(self, question: Question, loads: Collection[str]) -> None:
        super().__init__()
        self.question, self.loads = question, set(loads)

    def __missing__(self, key: str) -> bool:
        own = self.question.formula.letters
        wanted = letters(own[key]) if key in own else (key,)
        changes = self[key] = not self.loads.isdisjoint(dependencies(self.question.theory, wanted))
        return changes


@record
class LongRods:
    """States with long rods, many digits, and benches that leave out all loads but one."""

    question: Question
    values: Mapping[str, list[Fraction]]
    eps: Fraction
    loads: tuple[str, ...]  #: Letters that are set to zero in turn
    memo: dict[bytes, Values] = field(default_factory=dict)  #: Values of expressions that no load changes

    @cached_property
    def digits(self) -> dict[str, Values]:
        """Values of the letters, all loads with their own."""
        with mpmath.workdps(ORDER_DIGITS):
            return digit_values(small_rods(self.question.theory, self.values, self.eps))

    @cached_property
    def changes(self) -> Mapping[str, bool]:
        """Whether a name changes with the loads."""
        return _Changes(self.question, self.loads)

    @cached_property
    def names(self) -> dict[str, Values]:
        """Values of everything that quantity and formula need and no load changes."""
        question = self.question
        needed = dependencies(question.theory, [question.quantity, *used_names(question.formula)])
        unchanged = {k: v for k, v in self.digits.items() if k not in self.loads}
        with mpmath.workdps(ORDER_DIGITS):
            unchanged["pi"] = DIGITS.pi()
            complete(question.theory, unchanged, [k for k in needed if not self.changes[k]], DIGITS)
        return unchanged

    def bench(self, load: str) -> Bench:
        """The bench of one load with the others left out; with every load for `all`."""
        some = next(iter(self.digits.values()))
        zero = some - some
        loads = {k: self.digits[k] if load in (k, "all") else zero for k in self.loads}
        memo = Layered(self.memo, self.changes)
        return bench(self.question, {**self.names, **loads}, DIGITS, ORDER_DIGITS, memo)


EXACT = math.inf
COARSE, FINE = Fraction(1, 10**6), Fraction(1, 10**8)
_POINTS = 7
_ZERO_DIGITS = 90


@record
class LetterGroup:
    """One mass, inertia or force with all others left out."""

    name: str  #: The letter, `"all"` when the quantity is no such sum
    coarse: Bench
    fine: Bench


def groups(question: Question) -> list[LetterGroup]:
    """The groups of a quantity; none without rods, when there is no small parameter."""
    if not (question.theory.rods or question.theory.small):
        return []
    massive = [k for k, letter in question.theory.letters.items() if dimension(letter.unit)[0] == 1]
    loads, values = [k for k in massive if k not in question.hold], drawn(question, _POINTS, seed=3)
    states = [LongRods(question=question, values=values, eps=eps, loads=tuple(loads)) for eps in (COARSE, FINE)]
    single = [_group(load, *states) for load in loads]
    used = [g for g in single if _size(g.fine) > 0]
    whole = _group("all", *states)
    return used if len(used) > 1 and _adds_up(used, whole) else [whole]


def _group(name: str, coarse: LongRods, fine: LongRods) -> LetterGroup:
    return LetterGroup(name=name, coarse=coarse.bench(name), fine=fine.bench(name))


def _size(asked: Bench) -> Values:
    return max(abs(e) for e in asked.expected)


def _adds_up(single: list[LetterGroup], whole: LetterGroup) -> bool:
    with mpmath.workdps(ORDER_DIGITS):
        rest = whole.coarse.expected - sum(g.coarse.expected for g in single)
        return bool(all(abs(r) <= mpmath.mpf(10) ** -_ZERO_DIGITS * _size(whole.coarse) for r in rest))


def orders(by_load: list[LetterGroup], tree: Node) -> dict[str, float]:
    """Order of every group's error: infinite where it is exact, -1 where its leading term is wrong [-]."""
    return {g.name: _order(residual(g.coarse, tree), residual(g.fine, tree)) for g in by_load}


def residual(asked: Bench, tree: Node) -> Values:
    """Largest difference over the states by the largest value; infinite where the formula has no value [-]."""
    printed = value(asked, tree)
    with mpmath.workdps(asked.digits):
        differences = [abs(p - e) for p, e in zip(printed, asked.expected, strict=True)]
        if any(mpmath.isnan(d) for d in differences):
            return mpmath.inf
        size = _size(asked)
        return max(differences) / size if size else mpmath.inf


def _order(coarse: Values, fine: Values) -> float:
    if coarse == mpmath.inf or fine == mpmath.inf:
        return -1.0
    if fine < mpmath.mpf(10) ** -_ZERO_DIGITS:
        return EXACT
    order = float(mpmath.log10(coarse / fine)) / 2
    return -1.0 if order < 0.5 else float(round(order)) if abs(order - round(order)) < 0.05 else order


def lowest(by_load: Mapping[str, float]) -> int | None:
    """The order that is reported, the smallest of all groups; None where all are exact or nothing is small."""
    finite = [k for k in by_load.values() if k != EXACT]
    return int(min(finite)) if finite else None


_SLACK = 1.8  # a sign slip has twice the derived term, products of truncations have little more than it
_ANGLES = 8
_TURN = 24  # states of a turn at which an error is compared with the first term that is left out
_STATES = 1
# what lambda is multiplied by; more of them, further apart, for formulas that go on beyond the first powers
_STEPS = tuple(Fraction(i, 10**6) for i in range(1, 13))
_MANY_STEPS = tuple(Fraction(i, 10**4) for i in range(1, 25))
_UNTOLD = 2  # last coefficients, which the steps do not give to eight digits
_SHIFT = 2  # powers of eps below zero that a quantity may start with


@cache
def _weights(steps: tuple[Fraction, ...]) -> Values:
    # inverse of the matrix of powers
    with mpmath.workdps(ORDER_DIGITS):
        sizes = [mpmath.mpf(e.numerator) / e.denominator for e in steps]
        return np.array((mpmath.matrix([[e**j for j in range(len(steps))] for e in sizes]) ** -1).tolist())


@record
class Expansion:
    """States at a few tiny lambdas, from which the coefficients of powers follow."""

    load: str  #: The mass, inertia or force that is not zero, `all` for every one
    states: Sequence[LongRods]  #: One for each lambda, and last the rods as they are
    known: dict[bytes, Values] = field(default_factory=dict)  #: Coefficients of formulas that were asked before

    @cached_property
    def benches(self) -> list[Bench]:
        """A few angles of a turn at two states, for each lambda."""
        return [states.bench(self.load) for states in self.states[:-1]]

    @property
    def told(self) -> int:
        """Count of the coefficients that can be trusted."""
        return len(self.states) - 1 - _UNTOLD

    @cached_property
    def derived(self) -> Values:
        """Coefficients of the derived quantity, shape (powers, states)."""
        return self._coefficients([b.expected for b in self.benches])

    def printed(self, tree: Node) -> Values:
        """Coefficients of a formula, shape (powers, states)."""
        said = digest(tree)
        if said not in self.known:
            self.known[said] = self._coefficients([value(b, tree) for b in self.benches])
        return self.known[said]

    def ends(self, tree: Node) -> bool:
        """Whether a formula has no powers beyond those that are compared."""
        whole = value(self.states[-1].bench(self.load), tree)
        with mpmath.workdps(ORDER_DIGITS):
            rest = whole - sum(self.printed(tree)[: self.told])
            return max(map(abs, rest)) <= mpmath.mpf(10) ** -11 * max(map(abs, whole))

    def _coefficients(self, values: list[Values]) -> Values:
        steps = tuple(states.eps for states in self.states[:-1])
        with mpmath.workdps(ORDER_DIGITS):
            scale = [mpmath.mpf(e.numerator) ** _SHIFT / e.denominator**_SHIFT for e in steps]
            return _weights(steps) @ np.array([v * e for v, e in zip(values, scale, strict=True)])


def expansions(question: Question, loads: Sequence[str], many: bool = False) -> dict[str, Expansion]:
    """One expansion for each load, at the same states; to twice as many powers where `many` are wanted."""
    count = _ANGLES * _STATES
    few = drawn(question, _STATES, seed=4)
    values = {k: [v[i // _ANGLES] for i in range(count)] for k, v in few.items()}
    angle = question.theory.angle
    if angle and angle not in question.hold and not question.theory.letters[angle].domain:
        values[angle] = [Fraction(2 * (i % _ANGLES) + 1, _ANGLES) * Fraction(355, 113) for i in range(count)]
    zeros = tuple(k for k in loads if k != "all")
    steps = (*(_MANY_STEPS if many else _STEPS), Fraction(1))
    states = [LongRods(question=question, values=values, eps=eps, loads=zeros) for eps in steps]
    return {k: Expansion(load=k, states=states) for k in loads}


def overshoot(question: Question, tree: Node, first: Mapping[str, int]) -> float:
    """Largest error over a turn at the data, by the largest first term left out, of the worst load; 1 is usual [-].

    `first`: by load, the first power of lambda in which formula and quantity differ.
    """
    values = {k: [Fraction(float(x)) for x in v[:: -(-len(v) // _TURN)]] for k, v in turn_values(question).items()}
    loads = tuple(k for k in first if k != "all")
    whole, tiny = (LongRods(question=question, values=values, eps=eps, loads=loads) for eps in (Fraction(1), _STEPS[0]))
    shares = [0.0]
    for load, power in first.items():
        away, small = (_largest_error(states.bench(load), tree) for states in (whole, tiny))
        with mpmath.workdps(ORDER_DIGITS):
            term = small * mpmath.mpf(_STEPS[0].denominator) ** power
            shares.append(float(away / term) if term else 0.0)
    return max(shares)


def _largest_error(asked: Bench, tree: Node) -> Values:
    printed = value(asked, tree)
    with mpmath.workdps(asked.digits):
        away = [abs(p - e) for p, e in zip(printed, asked.expected, strict=True) if not mpmath.isnan(e)]
        return mpmath.inf if any(map(mpmath.isnan, away)) else max(away, default=mpmath.mpf(0))


@record
class Powers:
    """How a formula stands in powers of lambda, for one load."""

    honest: bool
    wrong: tuple[int, ...] = ()  #: Powers, counted from the leading one, that are neither right nor left out
    missing: tuple[int, ...] = field(default=())  #: Powers that are left out
    worse: tuple[int, ...] = ()  #: Wrong powers of which the derived term is smaller than what is wrong
    first: int | None = None  #: The first power that differs, of lambda itself

    @property
    def pure(self) -> bool:
        """Whether every power is right or left out."""
        return self.honest and not self.wrong


def powers(expansion: Expansion, tree: Node) -> Powers:
    """Compare the coefficients of a formula with the derived ones."""
    known = expansion.told
    derived, printed = expansion.derived[:known], expansion.printed(tree)[:known]
    with mpmath.workdps(ORDER_DIGITS):
        if any(mpmath.isnan(c) for row in printed for c in row):
            return Powers(honest=False)
        sizes = [max(abs(c) for c in row) for row in derived]
        small = max(sizes) * mpmath.mpf(10) ** -8
        errors = [max(abs(a - b) for a, b in zip(*rows, strict=True)) for rows in zip(derived, printed, strict=True)]
        own = [max(abs(c) for c in row) for row in printed]
    leading = next(k for k, size in enumerate(sizes) if size > small)
    off = [k for k in range(known) if errors[k] > small]
    if not off or off[0] <= leading:
        return Powers(honest=False, first=off[0] - _SHIFT if off else None)
    # a derived series that ends before this power has no term to compare with: then its first one
    ended = all(size <= small for size in sizes[off[0] :])
    measure = sizes[leading] if ended else sizes[off[0]]
    return Powers(
        first=off[0] - _SHIFT,
        honest=bool(errors[off[0]] <= _SLACK * measure),
        wrong=tuple(k - leading for k in off if own[k] > small),
        missing=tuple(k - leading for k in off if own[k] <= small),
        worse=tuple(k - leading for k in off if own[k] > small and errors[k] > _SLACK * max(sizes[k], small)),
    )


def changed_powers(expansion: Expansion, one: Node, other: Node) -> set[int]:
    """Powers, counted from the leading one, in which two formulas differ."""
    known = expansion.told
    derived, first, second = expansion.derived[:known], expansion.printed(one), expansion.printed(other)
    with mpmath.workdps(ORDER_DIGITS):
        sizes = [max(abs(c) for c in row) for row in derived]
        small = max(sizes) * mpmath.mpf(10) ** -8
        leading = next(k for k, size in enumerate(sizes) if size > small)
        gaps = [max(abs(a - b) for a, b in zip(first[k], second[k], strict=True)) for k in range(known)]
    return {k - leading for k, gap in enumerate(gaps) if not gap <= small}
