r"""How good an approximation is, per group of parameters, as the rods grow: lambda -> eps lambda at a fixed crank.

A quantity of one mass dimension is a sum over masses, inertias and forces; each of them is a group with its own error.
The order k of a group is the power of eps with which its relative error vanishes; -1 when the leading term is wrong.
"""

import math
from collections.abc import Mapping
from fractions import Fraction
from typing import Any

import mpmath

from mechsym.audit.bench import Bench, value
from mechsym.audit.long_rods import ORDER_DIGITS, LongRods
from mechsym.audit.question import Question
from mechsym.audit.states import drawn
from mechsym.audit.tree import Node
from mechsym.quantities import dimension, record

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
    """The groups of a quantity; none without rods, when there is no small parameter.

    Returns
    -------
    groups : list of LetterGroup
        At least one when the theory has rods
    """
    if not (question.theory.rods or question.theory.small):
        return []
    loads, values = _loads(question), drawn(question, _POINTS, seed=3)
    states = [LongRods(question=question, values=values, eps=eps, loads=tuple(loads)) for eps in (COARSE, FINE)]
    found = [_group(load, *states) for load in loads]
    used = [g for g in found if _size(g.fine) > 0]
    whole = _group("all", *states)
    return used if len(used) > 1 and _adds_up(used, whole) else [whole]


def _loads(question: Question) -> list[str]:
    letters = question.theory.letters
    return [k for k, r in letters.items() if dimension(r.unit)[0] == 1 and k not in question.hold]


def _group(name: str, coarse: LongRods, fine: LongRods) -> LetterGroup:
    return LetterGroup(name=name, coarse=coarse.bench(name), fine=fine.bench(name))


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
