r"""How good an approximation is, per group of parameters, as the rods grow: lambda -> eps lambda at a fixed crank.

A quantity of one mass dimension is a sum over masses, inertias and forces; each of them is a group with its own error.
The order k of a group is the power of eps with which its relative error vanishes; -1 when the leading term is wrong.
"""

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import mpmath
import numpy as np

from mechsym.audit.algebra import DIGITS
from mechsym.audit.bench import Bench, bench, value
from mechsym.audit.question import Question, digit_values, random_fractions, small_rods
from mechsym.audit.tree import Node
from mechsym.quantities import dimension, record

EXACT = math.inf
ORDER_DIGITS = 110
COARSE, FINE = Fraction(1, 10**6), Fraction(1, 10**8)
_POINTS = 7
_ZERO_DIGITS = 90
_SLACK = 1.001
_TURN_POINTS = 16
_NODES = 12
_NODE = Fraction(1, 10**6)
_TRUSTED = 10  # coefficients that the nodes give to eight digits
_SHIFT = 2  # powers of eps below zero that a quantity may start with


@record
class LetterGroup:
    """One mass, inertia or force with all others left out."""

    name: str  #: The letter, `"all"` when the quantity is no such sum
    coarse: Bench
    fine: Bench


def groups(question: Question) -> list[LetterGroup]:
    """The groups of a quantity; none without rods, when there is no small parameter.

    Returns
    -------
    groups : list of LetterGroup
        At least one when the theory has rods
    """
    if not question.theory.rods:
        return []
    loads = _loads(question)
    found = [_group(question, load, loads) for load in loads]
    used = [g for g in found if _size(g.fine) > 0]
    whole = _group(question, "all", [])
    return used if len(used) > 1 and _adds_up(used, whole) else [whole]


def _loads(question: Question) -> list[str]:
    letters = question.theory.letters
    return [k for k, r in letters.items() if dimension(r.unit)[0] == 1 and k not in question.hold]


def _group(question: Question, name: str, loads: list[str]) -> LetterGroup:
    values = random_fractions(question, _POINTS, seed=3)
    values |= {other: [Fraction(0)] * _POINTS for other in loads if other != name}
    coarse, fine = (at_small_rods(question, values, eps) for eps in (COARSE, FINE))
    return LetterGroup(name=name, coarse=coarse, fine=fine)


def at_small_rods(question: Question, values: Mapping[str, list[Fraction]], eps: Fraction) -> Bench:
    """States with long rods and many digits."""
    with mpmath.workdps(ORDER_DIGITS):
        digits = digit_values(small_rods(question.theory, values, eps))
    return bench(question, digits, DIGITS, ORDER_DIGITS)


def _size(asked: Bench) -> Any:
    return max(abs(e) for e in asked.expected)


def _adds_up(found: list[LetterGroup], whole: LetterGroup) -> bool:
    with mpmath.workdps(ORDER_DIGITS):
        rest = whole.coarse.expected - sum(g.coarse.expected for g in found)
        return bool(all(abs(r) <= mpmath.mpf(10) ** -_ZERO_DIGITS * _size(whole.coarse) for r in rest))


def orders(found: list[LetterGroup], tree: Node) -> dict[str, float]:
    """Order of every group's error.

    Returns
    -------
    orders : dict of str to float
        Infinite where the group is exact, -1 where its leading term is wrong [-]
    """
    return {g.name: _order(residual(g.coarse, tree), residual(g.fine, tree)) for g in found}


def residual(asked: Bench, tree: Node) -> Any:
    """Largest difference over the states, relative to the largest value.

    Returns
    -------
    residual : mpf
        Infinite where the formula has no value [-]
    """
    printed = value(asked, tree)
    with mpmath.workdps(asked.digits):
        differences = [abs(p - e) for p, e in zip(printed, asked.expected, strict=True)]
        if any(mpmath.isnan(d) for d in differences):
            return mpmath.inf
        size = _size(asked)
        return max(differences) / size if size else mpmath.inf


def _order(coarse: Any, fine: Any) -> float:
    if coarse == mpmath.inf or fine == mpmath.inf:
        return -1.0
    if fine < mpmath.mpf(10) ** -_ZERO_DIGITS:
        return EXACT
    order = float(mpmath.log10(coarse / fine)) / 2
    return -1.0 if order < 0.5 else float(round(order)) if abs(order - round(order)) < 0.05 else order


def lowest(found: Mapping[str, float]) -> int | None:
    """The order that is reported: the smallest of all groups.

    Returns
    -------
    order : int or None
        None when there is no small parameter or every group is exact
    """
    finite = [k for k in found.values() if k != EXACT]
    return int(min(finite)) if finite else None


def is_truncation(question: Question, found: list[LetterGroup], tree: Node) -> bool:
    """Whether every group is at least as good as leaving out one power of lambda, and everything above it.

    Returns
    -------
    honest : bool
        True when the largest error over a turn, as lambda goes to zero, is at most 1.001 times the derived term of
        the same power, or of the first one where the derived series ends before that power
    """
    known = orders(found, tree)
    if not known or min(known.values()) < 1:
        return False
    loads = [g.name for g in found]
    return all(_honest(question, g.name, loads, tree) for g in found if known[g.name] != EXACT)


def _honest(question: Question, group: str, loads: list[str], tree: Node) -> bool:
    derived, printed = _series(question, group, loads, tree)
    with mpmath.workdps(2 * ORDER_DIGITS):
        sizes = [max(abs(c)) for c in derived]
        small = max(sizes) * mpmath.mpf(10) ** -8
        errors = [max(abs(own - theirs)) for own, theirs in zip(derived, printed, strict=True)]
        wrong = next((k for k, error in enumerate(errors) if error > small), None)
        if wrong is None:
            return False
        # a derived series that ends before this power has no term to compare with: then its first one
        ended = all(size <= small for size in sizes[wrong:_TRUSTED])
        own = next(size for size in sizes if size > small) if ended else sizes[wrong]
        return bool(errors[wrong] <= _SLACK * own)


def _series(question: Question, group: str, loads: list[str], tree: Node) -> tuple[Any, Any]:
    # Taylor coefficients in eps at points of a turn, from values at a few tiny eps
    values = random_fractions(question, _TURN_POINTS, seed=4)
    values |= {other: [Fraction(0)] * _TURN_POINTS for other in loads if other != group and group != "all"}
    angle = question.theory.angle
    if angle:
        values[angle] = [Fraction(2 * i + 1, _TURN_POINTS) * Fraction(355, 113) for i in range(_TURN_POINTS)]
    steps = [_NODE * (i + 1) for i in range(_NODES)]
    benches = [_deep(question, values, eps) for eps in steps]
    with mpmath.workdps(2 * ORDER_DIGITS):
        scale = [(mpmath.mpf(e.numerator) / e.denominator) for e in steps]
        inverse = mpmath.matrix([[e**j for j in range(_NODES)] for e in scale]) ** -1
        weights = np.array(inverse.tolist())
        derived = np.array([b.expected * e**_SHIFT for b, e in zip(benches, scale, strict=True)])
        printed = np.array([value(b, tree) * e**_SHIFT for b, e in zip(benches, scale, strict=True)])
        return weights @ derived, weights @ printed


def _deep(question: Question, values: Mapping[str, list[Fraction]], eps: Fraction) -> Bench:
    digits = 2 * ORDER_DIGITS
    with mpmath.workdps(digits):
        states = digit_values(small_rods(question.theory, values, eps))
    return bench(question, states, DIGITS, digits)
