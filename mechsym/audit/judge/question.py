"""The question that the audit answers (is this formula that quantity?), states at which it is asked, values there."""

import ast
import random
from collections import ChainMap
from collections.abc import Callable, Iterable, Iterator, Mapping, MutableMapping, Sequence
from contextlib import contextmanager
from dataclasses import field
from fractions import Fraction
from functools import cache, reduce

import mpmath
import numpy as np

from mechsym.audit.read.algebra import FLOATS, Algebra, Values, evaluate
from mechsym.audit.read.reader import Formula
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import Node, letters, walk
from mechsym.audit.theory.record import Theory, complete
from mechsym.errors import BadInput
from mechsym.quantities import record

TURN_POINTS = 360


@record
class Question:
    """A printed formula and what it claims to be."""

    formula: Formula
    theory: Theory
    quantity: str
    hold: Mapping[str, float] = field(default_factory=dict)  #: Letters that the source's assumptions fix
    #: Letters that change over a turn in the source's data, as functions of the angle array
    turn: Mapping[str, Callable[[np.ndarray], np.ndarray]] = field(default_factory=dict)
    where: tuple[ast.Compare, ...] = ()  #: Relations that every state keeps
    #: States that were drawn before, by their number and seed
    states: dict[tuple[int, int], Mapping[str, list[Fraction]]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )


@record
class Draws:
    """Random exact values of every letter, as whole numbers until they are wanted."""

    question: Question
    numbers: Mapping[str, Sequence[int]]  #: From 7000 to 14000, negative for a value of the other sign [-]

    def floats(self) -> dict[str, np.ndarray]:
        """All values, rounded, to see which are good."""
        values = {}
        for letter, numbers in self.numbers.items():
            drawn = np.array(numbers)
            start, slope = (np.where(drawn < 0, *map(float, pair)) for pair in self._lines(letter))
            values[letter] = start + slope * np.abs(drawn)
        return values

    def exact(self, chosen: Sequence[int]) -> dict[str, list[Fraction]]:
        """The values of some of the states."""
        values = {}
        for letter, numbers in self.numbers.items():
            start, slope = self._lines(letter)
            few = [numbers[i] for i in chosen]
            sized = [slope[n > 0] * abs(n) for n in few]
            values[letter] = [start[n > 0] + s for n, s in zip(few, sized, strict=True)] if any(start) else sized
        return values

    def _lines(self, letter: str) -> tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]:
        # value = start + slope * number: the starts and the slopes of negative and of positive numbers
        (start, slope), (other, steep) = (self._line(letter, sign) for sign in (-1, 1))
        return (start, other), (slope, steep)

    def _line(self, letter: str, sign: int) -> tuple[Fraction, Fraction]:
        question, about = self.question, self.question.theory.letters[letter]
        if letter in question.hold:
            return Fraction(str(question.hold[letter])), Fraction(0)
        if about.domain:
            low, high = (Fraction(str(end)) for end in about.domain)
            return low - Fraction(6999, 7002) * (high - low), (high - low) / 7002
        if letter == question.theory.angle:
            # either sense of rotation, nearly a turn
            return sign * (Fraction(1, 7) - 6), sign * Fraction(6, 7000)
        value = Fraction(str(about.value)) or 1
        return Fraction(0), Fraction(sign, 10000) * value


def draws(question: Question, count: int, seed: int) -> Draws:
    """Random values near the source's data, of both signs where a letter may have both; the angle anywhere."""
    theory = question.theory
    fixed = tuple(
        bool(letter in question.hold or about.domain or about.positive and letter != theory.angle)
        for letter, about in theory.letters.items()
    )
    return Draws(question=question, numbers=dict(zip(theory.letters, _numbers(fixed, count, seed), strict=True)))


@cache
def _numbers(fixed: tuple[bool, ...], count: int, seed: int) -> list[list[int]]:
    # the same for all questions of a theory
    generator, lists = random.Random(seed), []
    for positive in fixed:
        numbers = [generator.randint(7000, 14000) for _ in range(count)]
        lists.append(numbers if positive else [generator.choice((1, -1)) * n for n in numbers])
    return lists


def small_rods(theory: Theory, values: Mapping[str, list[Fraction]], eps: Fraction) -> dict[str, list[Fraction]]:
    """The same states with the rods divided by eps at a fixed crank, and small numbers times eps."""
    factor = dict.fromkeys(theory.rods, 1 / eps) | dict.fromkeys(theory.small, eps)
    return {k: [x * factor[k] for x in v] if k in factor else list(v) for k, v in values.items()}


def float_values(values: Mapping[str, Sequence[Fraction]]) -> dict[str, np.ndarray]:
    """Exact values as floats, by letter."""
    return {k: np.array([float(x) for x in v]) for k, v in values.items()}


def digit_values(values: Mapping[str, Sequence[Fraction]]) -> dict[str, np.ndarray]:
    """Exact values as mpmath numbers of the working precision, by letter."""
    return {k: np.array([mpmath.mpf(x.numerator) / x.denominator for x in v]) for k, v in values.items()}


def turn_values(question: Question) -> dict[str, np.ndarray]:
    """One turn at the source's data, by letter; a single state when nothing turns."""
    theory = question.theory
    count = TURN_POINTS if theory.angle else 1
    values = {k: np.full(count, question.hold.get(k, r.value)) for k, r in theory.letters.items()}
    if theory.angle and theory.angle not in question.hold:
        # half a step off, so that no dead centre is met exactly
        low, high = theory.letters[theory.angle].domain or (0.0, 2 * np.pi)
        angle = low + (np.arange(count) + 0.5) * ((high - low) / count)
        values[theory.angle] = angle
        values |= {k: np.asarray(f(angle), dtype=float) for k, f in question.turn.items()}
    return values


@record
class Bench:
    """States with everything that formulas need there."""

    theory: Theory
    algebra: Algebra
    base: dict[str, Values]  #: Values of the theory's letters and of its names as far as they were needed
    own: dict[str, Values]
    expected: Values  #: shape (n,): The derived quantity
    digits: int = 0
    memo: MutableMapping[bytes, Values] = field(default_factory=dict)  #: Values of expressions that were needed before


def bench(
    question: Question,
    values: Mapping[str, Values],
    algebra: Algebra,
    digits: int = 0,
    memo: MutableMapping[bytes, Values] | None = None,
) -> Bench:
    """Everything that formulas need at given states; `memo` takes the values of expressions."""
    theory, formula = question.theory, question.formula
    with np.errstate(all="ignore"), mpmath.workdps(digits or 15):
        names = {"pi": algebra.pi(), **values}
        complete(theory, names, [question.quantity, *used_names(formula)], algebra)
        own = {letter: evaluate(tree, names, algebra) for letter, tree in formula.letters.items()}
        expected = names[question.quantity]
    if not np.ndim(expected) and values:
        # a quantity that is the same at all states
        like = np.asarray(next(iter(values.values())))
        expected = np.full(like.shape, expected, dtype=like.dtype)
    kept = {} if memo is None else memo
    return Bench(theory=theory, algebra=algebra, base=names, own=own, expected=expected, digits=digits, memo=kept)


def used_names(formula: Formula) -> list[str]:
    """Names that a formula and its author's letters use."""
    # what an author's letter stands for is in the theory's letters, also where both have the same name
    meant = [n for tree in formula.letters.values() for n in letters(tree)]
    return list(dict.fromkeys([*meant, *(n for n in letters(formula.tree) if n not in formula.letters)]))


def part_values(asked: Bench, tree: Node) -> dict[Node, Values]:
    """Values of an expression and of all its parts at the states of a bench."""
    known = names(asked, letters(tree))
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        return {node: evaluate(node, known, asked.algebra, asked.memo) for _, node in walk(tree)}


@contextmanager
def scratch(asked: Bench) -> Iterator[None]:
    """Values of expressions that are needed within are forgotten afterwards."""
    count = len(asked.memo)
    yield
    while len(asked.memo) > count:
        asked.memo.popitem()


def value(asked: Bench, tree: Node) -> Values:
    """Values of an expression at the states of a bench, nan where there is none."""
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        result = evaluate(tree, names(asked, letters(tree)), asked.algebra, asked.memo)
    return shaped(asked, result)


def shaped(asked: Bench, result: Values) -> Values:
    """One number for each state; nan where a letter with parts was not summed."""
    if np.ndim(result) > np.ndim(asked.expected):
        return np.full(np.shape(asked.expected), mpmath.nan if asked.digits else np.nan)
    return np.broadcast_to(result, np.shape(asked.expected))


def names(asked: Bench, wanted: Iterable[str]) -> Mapping[str, Values]:
    """Values of the author's letters, which hide the theory's, and of wanted names; new ones are computed and kept."""
    complete(asked.theory, asked.base, [w for w in wanted if w not in asked.own], asked.algebra)
    return ChainMap(asked.own, asked.base)


def turn(question: Question) -> Bench:
    """The bench of one turn at the source's data, in floats."""
    return bench(question, turn_values(question), FLOATS)


def peak(values: Values) -> float:
    """Largest size of values that may be nan; 0 where all are [unit of the values]."""
    sizes = np.abs(np.asarray(values, dtype=float))
    return float(np.max(sizes, initial=0.0, where=~np.isnan(sizes)))


def max_rel_error(asked: Bench, tree: Node) -> float:
    r"""Largest relative error of a print P beside what is derived, E.

    .. math:: \max \frac{|P - E|}{\max(|E|,\; 0.1 \max|E|)}

    Returns error: infinite where the formula has no value although the quantity has one [-].
    """
    printed, expected = value(asked, tree).astype(float), np.asarray(asked.expected, dtype=float)
    with np.errstate(all="ignore"):
        size = np.abs(expected)
        error = np.abs(printed - expected) / np.maximum(size, 0.1 * peak(size))
    return float(np.max(np.where(np.isnan(error), np.where(np.isnan(expected), 0.0, np.inf), error), initial=0.0))


_MORE = (6, 40, 240)  # draws for each state that is wanted, the next number where too few of them are good


def drawn(question: Question, count: int, seed: int) -> dict[str, list[Fraction]]:
    """Random exact states; those without a value of the quantity or outside the assumptions come last."""
    if (count, seed) not in question.states:
        for more in _MORE:
            random_draws = draws(question, more * count, seed)
            asked = bench(question, random_draws.floats(), FLOATS)
            # of the quantity, and of derived names in the formula: a loop that does not close is no state
            derived = [asked.base[k] for k in used_names(question.formula) if k in question.theory.tape]
            with_parts = [np.all(np.isfinite(v), axis=0) if np.ndim(v) > 1 else np.isfinite(v) for v in derived]
            valued = reduce(np.logical_and, with_parts, np.isfinite(asked.expected))
            good = np.broadcast_to(valued & kept(question, asked), (more * count,))
            if np.count_nonzero(good) >= count:
                break
        chosen = [*np.flatnonzero(good), *np.flatnonzero(~good)][:count]
        key = (count, seed, more, tuple(question.hold.items()), tuple(map(int, chosen)))
        known = question.theory.states
        if key not in known:
            known[key] = random_draws.exact(chosen)
        question.states[count, seed] = known[key]
    return dict(question.states[count, seed])


_SETS, _ANGLES, _DECADES = 600, 12, 1.5  # machines that are tried, angles of each, how far their letters lie apart


def require_possible(question: Question) -> None:
    """Refuse assumptions that no machine keeps. Raises BadInput: they contradict one another, or the theory."""
    theory = question.theory
    if not question.where:
        return
    rng, angles = np.random.default_rng(0), _ANGLES if theory.angle else 1
    values = {}
    for name, about in theory.letters.items():
        size = (abs(about.value) or 1.0) * 10 ** rng.uniform(-_DECADES, _DECADES, _SETS)
        drawn = rng.uniform(*about.domain, _SETS) if about.domain else size
        signed = drawn if about.positive or about.domain else drawn * rng.choice((-1.0, 1.0), _SETS)
        values[name] = np.repeat(np.full(_SETS, question.hold.get(name, signed)), angles)
    if theory.angle and theory.angle not in question.hold:
        values[theory.angle] = np.tile(0.1 + np.linspace(0, 2 * np.pi, angles, endpoint=False), _SETS)
    asked = bench(question, values, FLOATS)
    valued = np.isfinite(asked.expected)
    there = np.broadcast_to(valued if valued.ndim < 2 else valued.all(axis=0), (_SETS * angles,)).reshape(_SETS, -1)
    # a rod that is longer than its crank lets it turn all the way
    machines = there.all(axis=1) if theory.rods and there.all(axis=1).any() else there.any(axis=1)
    keep = np.broadcast_to(kept(question, asked), (_SETS * angles,)).reshape(_SETS, -1).any(axis=1)
    if not (machines & keep).any():
        rods = ", or rods longer than their cranks, which are taken for granted" if theory.rods else ""
        said = ", ".join(to_python(relation) for relation in question.where)
        raise BadInput(f"--assume {said!r}: no values of the letters keep it; it contradicts itself{rods}")


def kept(question: Question, asked: Bench) -> np.ndarray:
    """At which states the assumptions hold [-]."""
    holds = np.ones(np.shape(asked.expected) or (1,), dtype=bool)
    for relation in question.where:
        with np.errstate(all="ignore"):
            holds = holds & np.asarray(evaluate(relation, names(asked, letters(relation)), FLOATS), dtype=bool)
    return holds
