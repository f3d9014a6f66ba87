"""The question that the audit answers (is this formula that quantity?) and the states at which it is asked."""

import random
from collections import ChainMap
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from mechsym.audit.algebra import FLOATS, Algebra, evaluate
from mechsym.audit.reader import Formula
from mechsym.audit.theory.record import Theory, complete
from mechsym.audit.tree import Node, letters, walk

TURN_POINTS = 360


@dataclass(frozen=True, kw_only=True)
class Question:
    """A printed formula and what it claims to be.

    Parameters
    ----------
    formula : Formula
        As printed
    theory : Theory
        What derives the quantity
    quantity : str
        Name on the theory's tape
    hold : mapping of str to float
        Letters that the source's assumptions fix
    turn : mapping of str to callable
        Letters that change over a turn in the source's data, as functions of the angle array
    """

    formula: Formula
    theory: Theory
    quantity: str
    hold: Mapping[str, float] = field(default_factory=dict)
    turn: Mapping[str, Callable[[np.ndarray], np.ndarray]] = field(default_factory=dict)


@dataclass(frozen=True, kw_only=True)
class Bench:
    """States with everything that formulas need there.

    Parameters
    ----------
    theory : Theory
        Letters and tape
    algebra : Algebra
        Number system
    base : dict of str to array
        Values of the theory's letters and of its names as far as they were needed
    own : dict of str to array
        Values of the author's letters
    expected : array, shape (n,)
        The derived quantity
    digits : int
        Working precision, 0 for floats
    calls : dict of str to array
        Values of functions that were needed before
    """

    theory: Theory
    algebra: Algebra
    base: dict[str, Any]
    own: dict[str, Any]
    expected: Any
    digits: int = 0
    calls: dict[str, Any] = field(default_factory=dict)


Values = Mapping[str, Any]


def random_fractions(question: Question, count: int, seed: int) -> dict[str, list[Fraction]]:
    """Random exact values near the source's data; the angle anywhere in a turn.

    Parameters
    ----------
    question : Question
        Letters, data and held letters
    count : int
        Number of states
    seed : int
        Seed of the generator

    Returns
    -------
    values : dict of str to list of Fraction
        By letter
    """
    generator, theory = random.Random(seed), question.theory
    found = {}
    for letter, record in theory.letters.items():
        value = Fraction(record.value).limit_denominator(10**9)
        draw = [generator.randint(7000, 14000) for _ in range(count)]
        if letter in question.hold:
            found[letter] = [Fraction(str(question.hold[letter]))] * count
        elif letter == theory.angle:
            found[letter] = [Fraction(d * 6, 7000) - 6 + Fraction(1, 7) for d in draw]
        else:
            found[letter] = [Fraction(d, 10000) * (value or 1) for d in draw]
    return found


def small_rods(theory: Theory, values: Mapping[str, list[Fraction]], eps: Fraction) -> dict[str, list[Fraction]]:
    """The same states with the rods divided by eps at a fixed crank.

    Parameters
    ----------
    theory : Theory
        Says which lengths are rods
    values : mapping of str to list of Fraction
        States
    eps : Fraction
        lambda becomes eps times lambda

    Returns
    -------
    values : dict of str to list of Fraction
        States
    """
    return {k: [x / eps for x in v] if k in theory.rods else list(v) for k, v in values.items()}


def float_values(values: Mapping[str, list[Fraction]]) -> dict[str, np.ndarray]:
    """Exact values as floats.

    Parameters
    ----------
    values : mapping of str to list of Fraction
        States

    Returns
    -------
    values : dict of str to ndarray, shape (n,)
        By letter
    """
    return {k: np.array([float(x) for x in v]) for k, v in values.items()}


def digit_values(values: Mapping[str, list[Fraction]]) -> dict[str, np.ndarray]:
    """Exact values as mpmath numbers of the working precision.

    Parameters
    ----------
    values : mapping of str to list of Fraction
        States

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
        angle = (np.arange(count) + 0.5) * (2 * np.pi / count)
        values[theory.angle] = angle
        values |= {k: np.asarray(f(angle), dtype=float) for k, f in question.turn.items()}
    return values


def bench(question: Question, values: Values, algebra: Algebra, digits: int = 0) -> Bench:
    """Everything that formulas need at given states.

    Parameters
    ----------
    question : Question
        What is asked
    values : mapping of str to array
        Values of the theory's letters
    algebra : Algebra
        Number system
    digits : int
        Working precision, 0 for floats

    Returns
    -------
    bench : Bench
        States, names and the derived quantity
    """
    theory, formula = question.theory, question.formula
    with np.errstate(all="ignore"), mpmath.workdps(digits or 15):
        names = {"pi": algebra.pi(), **values}
        complete(theory, names, [question.quantity, *used_names(formula)], algebra)
        own = {letter: evaluate(tree, names, algebra) for letter, tree in formula.letters.items()}
        expected = names[question.quantity]
    return Bench(theory=theory, algebra=algebra, base=names, own=own, expected=expected, digits=digits)


def used_names(formula: Formula) -> list[str]:
    """Names that a formula and its author's letters use.

    Parameters
    ----------
    formula : Formula
        As printed

    Returns
    -------
    names : list of str
        Without repetition
    """
    trees = [*formula.letters.values(), formula.tree]
    return list(dict.fromkeys(n for tree in trees for n in letters(tree) if n not in formula.letters))


def part_values(asked: Bench, tree: Node) -> dict[Node, Any]:
    """Values of an expression and of all its parts at the states of a bench.

    Parameters
    ----------
    asked : Bench
        States
    tree : Node
        Expression in the formula's letters

    Returns
    -------
    values : dict of Node to array
        By node
    """
    memo: dict[Node, Any] = {}
    known = names(asked, letters(tree))
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        for _, node in walk(tree):
            evaluate(node, known, asked.algebra, memo, asked.calls)
    return memo


def value(asked: Bench, tree: Node) -> Any:
    """Value of an expression at the states of a bench.

    Parameters
    ----------
    asked : Bench
        States
    tree : Node
        Expression in the formula's letters

    Returns
    -------
    value : array, shape (n,)
        Values; nan where there is none
    """
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        found = evaluate(tree, names(asked, letters(tree)), asked.algebra, {}, asked.calls)
    return shaped(asked, found)


def shaped(asked: Bench, found: Any) -> Any:
    """A value as one number per state.

    Parameters
    ----------
    asked : Bench
        States
    found : scalar or array
        What an evaluation gave

    Returns
    -------
    value : array, shape (n,)
        nan where a letter with parts was not summed
    """
    if np.ndim(found) > np.ndim(asked.expected):
        return np.full(np.shape(asked.expected), mpmath.nan if asked.digits else np.nan)
    return np.broadcast_to(found, np.shape(asked.expected))


def names(asked: Bench, wanted: Iterable[str]) -> Mapping[str, Any]:
    """Values of the author's letters, and of the theory's letters and wanted names.

    Parameters
    ----------
    asked : Bench
        States; names that were not needed before are computed and kept
    wanted : iterable of str
        Names that formulas use

    Returns
    -------
    names : mapping of str to array
        The author's letters hide the theory's
    """
    complete(asked.theory, asked.base, [w for w in wanted if w not in asked.own], asked.algebra)
    return ChainMap(asked.own, asked.base)


def turn(question: Question) -> Bench:
    """The bench of one turn at the source's data, in floats.

    Parameters
    ----------
    question : Question
        What is asked

    Returns
    -------
    bench : Bench
        States of the turn
    """
    return bench(question, turn_values(question), FLOATS)


def max_rel_error(asked: Bench, tree: Node) -> float:
    r"""Largest relative error, :math:`\max |P - E| / \max(|E|, 0.1 \max|E|)`.

    Parameters
    ----------
    asked : Bench
        States of a turn
    tree : Node
        Expression

    Returns
    -------
    error : float
        Infinite where the formula has no value although the quantity has one [-]
    """
    printed, expected = value(asked, tree).astype(float), np.asarray(asked.expected, dtype=float)
    with np.errstate(all="ignore"):
        size = np.abs(expected)
        error = np.abs(printed - expected) / np.maximum(size, 0.1 * np.nanmax(size))
    return float(np.max(np.where(np.isnan(error), np.where(np.isnan(expected), 0.0, np.inf), error), initial=0.0))
