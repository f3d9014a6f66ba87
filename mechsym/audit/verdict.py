"""The decision: exact, approximate, misprint (with the edit that repairs it) or wrong."""

from collections.abc import Mapping
from dataclasses import field
from typing import Any

import mpmath
import numpy as np

from mechsym.audit.bench import max_rel_error, names, value
from mechsym.audit.candidates import listed_edits
from mechsym.audit.dimensions import is_consistent
from mechsym.audit.edits import apply
from mechsym.audit.orders import EXACT, is_truncation, lowest
from mechsym.audit.prover import proves_equal
from mechsym.audit.question import Question
from mechsym.audit.repair import Examination, Repair, better, examine, repairs, standing
from mechsym.audit.rounding import rounded_constant
from mechsym.audit.tree import Node, letters
from mechsym.quantities import record

_BEAM = 6


@record
class Decision:
    """What the audit says of one formula, with its evidence."""

    verdict: str
    max_rel_error: float  #: Largest relative error over a turn at the source's data [-]
    order: int | None  #: Order of the first neglected power of lambda; None when exact or without a small parameter
    orders: Mapping[str, float]
    repairs: tuple[Repair, ...] = ()  #: Corrected formulas, the most plausible first
    certificate: str = ""  #: What proves an exact formula: `polynomial` or `50 digits`
    dimensions: bool = True  #: Whether the formula rescales with mass, length and time as the quantity does
    #: State with the largest error, and both values; empty for an exact formula
    counterexample: Mapping[str, float] = field(default_factory=dict)
    note: str = ""  #: Remarks of the reader and of the decision


def decide(question: Question) -> Decision:
    """Compare a printed formula with the derived quantity."""
    exam = examine(question)
    start = standing(exam, question.formula.tree)
    if start.exact:
        proof = "polynomial" if proves_equal(question, start.tree) else "50 digits"
        return _verdict(exam, "exact", start, certificate=proof)
    verdict, found = search(exam, start)
    note = rounded_constant(exam, start.tree) if verdict == "approximate" else ""
    return _verdict(exam, verdict, start, repairs=tuple(found), note=note)


def search(exam: Examination, start: Repair) -> tuple[str, list[Repair]]:
    """The verdict on a formula that is not exact, and its repairs.

    A slip that one edit mends is a misprint even if the rest is an honest approximation; only what is neither is
    searched for lost terms and factors, since every truncation lacks those.

    Returns
    -------
    repairs : list of Repair
        For a misprint, the most plausible first
    """
    found = repairs(exam, start, insert=False)
    if not found:
        if rounded_constant(exam, start.tree) or _honest(exam, start):
            return "approximate", []
        found = repairs(exam, start, insert=True)
    found = _complete(exam, found) if found else _second_edits(exam, start)
    return ("misprint" if found else "wrong"), found


def _complete(exam: Examination, found: list[Repair]) -> list[Repair]:
    # a second slip: search again from the best repair when that is no honest approximation yet
    best = found[0]
    if _honest(exam, best):
        return found
    return [*repairs(exam, best, insert=False), *found]


def _second_edits(exam: Examination, start: Repair) -> list[Repair]:
    for first in _promising(exam, start):
        found = [r for r in repairs(exam, first, insert=False) if _honest(exam, r)]
        if found:
            return found
    return []


def _honest(exam: Examination, repair: Repair) -> bool:
    if repair.exact:
        return True
    truncated = is_truncation(exam.question, exam.groups, repair.tree)
    return truncated and is_consistent(exam.question, repair.tree)


def _promising(exam: Examination, start: Repair) -> list[Repair]:
    # first edits that leave the least error, or that mend one group of several
    parts = better(exam, start, insert=False)
    edits = listed_edits(exam.question, start.tree)
    errors = sorted((max_rel_error(exam.turn, apply(start.tree, e)), i) for i, e in enumerate(edits))
    least = [standing(exam, apply(start.tree, edits[i]), (edits[i],)) for _, i in errors[:_BEAM]]
    return [*sorted(parts, key=lambda r: r.max_rel_error)[:_BEAM], *least]


def _verdict(exam: Examination, verdict: str, start: Repair, **more: Any) -> Decision:
    notes = [exam.question.formula.note, more.pop("note", "")]
    return Decision(
        verdict=verdict,
        max_rel_error=start.max_rel_error,
        order=None if start.exact else lowest(start.orders),
        orders={k: v for k, v in start.orders.items() if v != EXACT},
        dimensions=is_consistent(exam.question, start.tree),
        counterexample={} if start.exact else _counterexample(exam, start.tree),
        note="; ".join(n for n in notes if n),
        **more,
    )


def _counterexample(exam: Examination, tree: Node) -> dict[str, float]:
    strict = exam.judged.strict
    printed, expected = value(strict, tree), strict.expected
    with mpmath.workdps(strict.digits):
        errors = [_relative(p, e) for p, e in zip(printed, expected, strict=True)]
    worst = int(np.argmax(errors))
    shown = [n for n in letters(tree) if n in names(strict, [])]
    state = {n: float(_at(names(strict, [])[n], worst)) for n in shown if np.ndim(names(strict, [])[n]) <= 1}
    return state | {"printed": float(printed[worst]), "derived": float(expected[worst])}


def _relative(printed: Any, expected: Any) -> float:
    if mpmath.isnan(expected):
        return -1.0
    if mpmath.isnan(printed):
        return float("inf")
    return float(abs(printed - expected) / (abs(expected) or mpmath.mpf(1)))


def _at(values: Any, index: int) -> Any:
    return values[index] if np.ndim(values) else values
