"""The question that the audit answers (is this formula that quantity?) and the states at which it is asked."""

import ast
import random
from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from fractions import Fraction
from functools import cache

import mpmath
import numpy as np

from mechsym.audit.reader import Formula
from mechsym.audit.theory.record import Theory
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
        """All values, rounded, to see which are good.

        Returns
        -------
        values : dict of str to ndarray, shape (n,)
            By letter
        """
        found = {}
        for letter, numbers in self.numbers.items():
            drawn = np.array(numbers)
            start, slope = (np.where(drawn < 0, *map(float, pair)) for pair in self._lines(letter))
            found[letter] = start + slope * np.abs(drawn)
        return found

    def exact(self, chosen: Sequence[int]) -> dict[str, list[Fraction]]:
        """The values of some of the states."""
        found = {}
        for letter, numbers in self.numbers.items():
            start, slope = self._lines(letter)
            few = [numbers[i] for i in chosen]
            sized = [slope[n > 0] * abs(n) for n in few]
            found[letter] = [start[n > 0] + s for n, s in zip(few, sized, strict=True)] if any(start) else sized
        return found

    def _lines(self, letter: str) -> tuple[tuple[Fraction, Fraction], tuple[Fraction, Fraction]]:
        # value = start + slope * number: the starts and the slopes of negative and of positive numbers
        (start, slope), (other, steep) = (self._line(letter, sign) for sign in (-1, 1))
        return (start, other), (slope, steep)

    def _line(self, letter: str, sign: int) -> tuple[Fraction, Fraction]:
        question, about = self.question, self.question.theory.letters[letter]
        if letter in question.hold:
            return Fraction(str(question.hold[letter])), Fraction(0)
        if about.domain:
            low, high = (Fraction(end).limit_denominator(10**9) for end in about.domain)
            return low - Fraction(6999, 7002) * (high - low), (high - low) / 7002
        if letter == question.theory.angle:
            # either sense of rotation, nearly a turn
            return sign * (Fraction(1, 7) - 6), sign * Fraction(6, 7000)
        value = Fraction(about.value).limit_denominator(10**9) or 1
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
    generator, found = random.Random(seed), []
    for positive in fixed:
        numbers = [generator.randint(7000, 14000) for _ in range(count)]
        found.append(numbers if positive else [generator.choice((1, -1)) * n for n in numbers])
    return found


def small_rods(theory: Theory, values: Mapping[str, list[Fraction]], eps: Fraction) -> dict[str, list[Fraction]]:
    """The same states with the rods divided by eps at a fixed crank, and small numbers times eps."""
    factor = dict.fromkeys(theory.rods, 1 / eps) | dict.fromkeys(theory.small, eps)
    return {k: [x * factor[k] for x in v] if k in factor else list(v) for k, v in values.items()}


def float_values(values: Mapping[str, list[Fraction]]) -> dict[str, np.ndarray]:
    """Exact values as floats.

    Returns
    -------
    values : dict of str to ndarray, shape (n,)
        By letter
    """
    return {k: np.array([float(x) for x in v]) for k, v in values.items()}


def digit_values(values: Mapping[str, list[Fraction]]) -> dict[str, np.ndarray]:
    """Exact values as mpmath numbers of the working precision.

    Returns
    -------
    values : dict of str to ndarray of mpf, shape (n,)
        By letter
    """
    return {k: np.array([mpmath.mpf(x.numerator) / x.denominator for x in v]) for k, v in values.items()}


def turn_values(question: Question) -> dict[str, np.ndarray]:
    """One turn at the source's data; a single state when nothing turns.

    Parameters
    ----------
    question : Question
        Letters, data, held letters and letters that change over the turn

    Returns
    -------
    values : dict of str to ndarray, shape (n,)
        By letter
    """
    theory = question.theory
    count = TURN_POINTS if theory.angle else 1
    values = {k: np.full(count, question.hold.get(k, r.value)) for k, r in theory.letters.items()}
    if theory.angle:
        # half a step off, so that no dead centre is met exactly
        low, high = theory.letters[theory.angle].domain or (0.0, 2 * np.pi)
        angle = low + (np.arange(count) + 0.5) * ((high - low) / count)
        values[theory.angle] = angle
        values |= {k: np.asarray(f(angle), dtype=float) for k, f in question.turn.items()}
    return values
