"""States at which the derived quantity has a value and the assumptions hold."""

from collections.abc import Mapping
from fractions import Fraction

import numpy as np

from mechsym.audit.algebra import FLOATS, evaluate
from mechsym.audit.bench import Bench, bench, names
from mechsym.audit.question import Question, draws
from mechsym.audit.tree import letters

_MORE = 6  # draws for each state that is wanted


def drawn(question: Question, count: int, seed: int) -> dict[str, list[Fraction]]:
    """Random exact states; those without a value of the quantity or outside the assumptions come last."""
    if (count, seed) not in question.states:
        question.states[count, seed] = _drawn(question, count, seed)
    return dict(question.states[count, seed])


def _drawn(question: Question, count: int, seed: int) -> Mapping[str, list[Fraction]]:
    found = draws(question, _MORE * count, seed)
    asked = bench(question, found.floats(), FLOATS)
    good = np.isfinite(np.broadcast_to(asked.expected, (_MORE * count,))) & kept(question, asked)
    chosen = [*np.flatnonzero(good), *np.flatnonzero(~good)][:count]
    key = (count, seed, tuple(question.hold.items()), tuple(map(int, chosen)))
    known = question.theory.states
    if key not in known:
        known[key] = found.exact(chosen)
    return known[key]


def kept(question: Question, asked: Bench) -> np.ndarray:
    """Where the assumptions hold.

    Returns
    -------
    kept : ndarray of bool, shape (n,)
        State by state [-]
    """
    found = np.ones(np.shape(asked.expected) or (1,), dtype=bool)
    for relation in question.where:
        with np.errstate(all="ignore"):
            found = found & np.asarray(evaluate(relation, names(asked, letters(relation)), FLOATS), dtype=bool)
    return found
