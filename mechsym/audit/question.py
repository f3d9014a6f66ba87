"""The question that the audit answers (is this formula that quantity?) and the states at which it is asked."""

import ast
import random
from collections.abc import Callable, Mapping
from dataclasses import field
from fractions import Fraction

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


def random_fractions(question: Question, count: int, seed: int) -> dict[str, list[Fraction]]:
    """Random exact values near the source's data, of both signs where a letter may have both; the angle anywhere."""
    generator, theory = random.Random(seed), question.theory
    found = {}
    for letter, about in theory.letters.items():
        draw = [generator.randint(7000, 14000) for _ in range(count)]
        if letter in question.hold:
            found[letter] = [Fraction(str(question.hold[letter]))] * count
        elif about.domain:
            low, high = (Fraction(end).limit_denominator(10**9) for end in about.domain)
            found[letter] = [low + Fraction(d - 6999, 7002) * (high - low) for d in draw]
        elif letter == theory.angle:
            # either sense of rotation, nearly a turn
            found[letter] = [generator.choice((1, -1)) * (Fraction(d * 6, 7000) - 6 + Fraction(1, 7)) for d in draw]
        else:
            value = Fraction(about.value).limit_denominator(10**9) or 1
            signs = [1] * count if about.positive else [generator.choice((1, -1)) for _ in range(count)]
            found[letter] = [Fraction(s * d, 10000) * value for s, d in zip(signs, draw, strict=True)]
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
