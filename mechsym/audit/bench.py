"""States with the values of everything that formulas need there."""

from collections import ChainMap
from collections.abc import Iterable, Iterator, Mapping, MutableMapping
from contextlib import contextmanager
from dataclasses import field
from typing import Any

import mpmath
import numpy as np

from mechsym.audit.algebra import FLOATS, Algebra, evaluate
from mechsym.audit.question import Question, turn_values
from mechsym.audit.reader import Formula
from mechsym.audit.theory.record import Theory, complete
from mechsym.audit.tree import Node, letters, walk
from mechsym.quantities import record


@record
class Bench:
    """States with everything that formulas need there."""

    theory: Theory
    algebra: Algebra
    base: dict[str, Any]  #: Values of the theory's letters and of its names as far as they were needed
    own: dict[str, Any]
    expected: Any  #: shape (n,): The derived quantity
    digits: int = 0
    memo: MutableMapping[bytes, Any] = field(default_factory=dict)  #: Values of expressions that were needed before


def bench(
    question: Question,
    values: Mapping[str, Any],
    algebra: Algebra,
    digits: int = 0,
    memo: MutableMapping[bytes, Any] | None = None,
) -> Bench:
    """Everything that formulas need at given states.

    Parameters
    ----------
    memo : mutable mapping of bytes to value, optional
        Takes the values of expressions; an own dictionary when left out

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


def part_values(asked: Bench, tree: Node) -> dict[Node, Any]:
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


def value(asked: Bench, tree: Node) -> Any:
    """Value of an expression at the states of a bench.

    Returns
    -------
    value : array, shape (n,)
        Values; nan where there is none
    """
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        found = evaluate(tree, names(asked, letters(tree)), asked.algebra, asked.memo)
    return shaped(asked, found)


def shaped(asked: Bench, found: Any) -> Any:
    """A value as one number per state.

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

    Returns
    -------
    names : mapping of str to array
        The author's letters hide the theory's
    """
    complete(asked.theory, asked.base, [w for w in wanted if w not in asked.own], asked.algebra)
    return ChainMap(asked.own, asked.base)


def turn(question: Question) -> Bench:
    """The bench of one turn at the source's data, in floats."""
    return bench(question, turn_values(question), FLOATS)


def peak(values: Any) -> float:
    """Largest size of values that may be nan; 0 where all are."""
    sizes = np.abs(np.asarray(values, dtype=float))
    return float(np.max(sizes, initial=0.0, where=~np.isnan(sizes)))


def max_rel_error(asked: Bench, tree: Node) -> float:
    r"""Largest relative error, :math:`\max |P - E| / \max(|E|, 0.1 \max|E|)`.

    Returns
    -------
    error : float
        Infinite where the formula has no value although the quantity has one [-]
    """
    printed, expected = value(asked, tree).astype(float), np.asarray(asked.expected, dtype=float)
    with np.errstate(all="ignore"):
        size = np.abs(expected)
        error = np.abs(printed - expected) / np.maximum(size, 0.1 * peak(size))
    return float(np.max(np.where(np.isnan(error), np.where(np.isnan(expected), 0.0, np.inf), error), initial=0.0))
