"""The decision: exact, truncation, convention, mixed, misprint (with the edit that repairs it), nearer, wrong."""

from collections.abc import Mapping
from dataclasses import field, replace
from typing import Any

import mpmath
import numpy as np

from mechsym.audit.bench import names, used_names, value
from mechsym.audit.conditions import conditions, under
from mechsym.audit.dimensions import is_consistent
from mechsym.audit.orders import EXACT, lowest
from mechsym.audit.prover import POINTS, Agreement, agreement, proves_equal
from mechsym.audit.question import Question
from mechsym.audit.repair import Examination, Repair, exact_repair, examine, standing
from mechsym.audit.search import Found, search, truncated
from mechsym.audit.theory.record import dependencies
from mechsym.audit.tree import Node, letters
from mechsym.quantities import record

PASSED = ("exact", "truncation", "convention")  # exit status 0
_NONE = 1e-9  # an error that is rounding only [-]
_EITHER = "a term is too many, or one has lost a factor that the condition makes zero"
_STATIC = "it has no speed at all, so that what it has lost may hold at any speed"
OPEN = ("mixed", "untestable")  # exit status 3


@record
class Decision:
    """What the audit says of one formula, with its evidence."""

    #: `exact`, `truncation`, `convention`, `mixed`, `misprint`, `nearer`, `wrong` or `untestable`
    verdict: str
    max_rel_error: float  #: Largest relative error over a turn at the source's data [-]
    order: int | None  #: Order of the first neglected power of lambda; None when exact or without a small parameter
    orders: Mapping[str, float]
    repairs: tuple[Repair, ...] = ()  #: Corrected formulas, the most plausible first
    nearer: Repair | None = None  #: Formula that is better and still not right
    certificate: str = ""  #: What proves an exact formula: `polynomial` or `50 digits`
    #: Whether the formula rescales with mass, length and time as the quantity does
    dimensions: bool = True
    #: State with the largest error, and both values; empty for an exact formula
    counterexample: Mapping[str, float] = field(default_factory=dict)
    domain: str = ""  #: Where the comparison was made
    note: str = ""


def decide(question: Question) -> Decision:
    """Compare a printed formula with the derived quantity."""
    exam = examine(question)
    found = _plain(exam)
    if found is not None:
        return found
    for condition in (*conditions(question), *conditions(question, written=True)):
        judged = _plain(examine(under(question, condition)))
        if judged is not None and judged.verdict in ("exact", "truncation"):
            words = "exact" if judged.verdict == "exact" else f"a truncation of relative order {judged.order}"
            note = "; ".join(n for n in (judged.note, f"{words} at {condition.told}") if n)
            return replace(judged, verdict="convention", note=note)
    return _searched(exam)


def _plain(exam: Examination) -> Decision | None:
    # what needs no search: exact, without values, or a truncation
    tree = exam.question.formula.tree
    met = agreement(exam.judged, tree)
    if met.exact:
        proof = "polynomial" if proves_equal(exam.question, tree) else "50 digits"
        start = standing(exam, tree)
        turns = "up to whole turns" if met.turned else ""
        return _verdict(exam, "exact", start, certificate=proof, domain=domain(exam.question), note=turns)
    if met.expected <= POINTS // 2 or met.agrees:
        return _verdict(exam, "untestable", _unordered(exam, tree), note=_without_value(met))
    if not is_consistent(exam.scales, tree):
        return None
    start = standing(exam, tree)
    note = truncated(exam, start)
    return None if note is None else _verdict(exam, "truncation", start, note=note, domain=domain(exam.question))


def _searched(exam: Examination) -> Decision:
    tree = exam.question.formula.tree
    start = standing(exam, tree)
    condition = next(conditions(exam.question), None)
    single = exact_repair(exam, start) if condition else None
    if single is not None:
        found, note = Found(verdict="misprint", repairs=(single,)), ""
    elif condition is not None:
        # a slip in a formula for constant speed
        other = examine(under(exam.question, condition))
        start = standing(other, tree)
        found = search(other, start)
        if found.repairs and found.repairs[0].edits[-1].kind == "left out":
            # a term to be taken away at constant speed may as well have lost what vanishes there
            found = Found(verdict="nearer", nearer=found.repairs[0], note=_EITHER)
        if found.repairs and _brings_rates(exam.question, found.repairs[0]):
            found = Found(verdict="nearer", nearer=found.repairs[0], note=_STATIC)
        note = "; ".join(n for n in (found.note, f"compared at {condition.told}") if n)
        exam = other
    else:
        found = search(exam, start)
        note = found.note
    met = agreement(exam.judged, tree)
    if found.verdict in ("wrong", "nearer") and 2 * met.valued <= met.expected:
        return _verdict(exam, "untestable", start, note=_without_value(met))
    if not met.valued:
        note = "; ".join(n for n in (note, "as printed it has no real value anywhere") if n)
    return _verdict(exam, found.verdict, start, repairs=found.repairs, nearer=found.nearer, note=note)


def _brings_rates(question: Question, repair: Repair) -> bool:
    # a term with the speed put back into a formula that has none is right at constant speed only by chance
    rates = {k for k, letter in question.theory.letters.items() if letter.unit in ("rad/s", "rad/s^2")}
    had = dependencies(question.theory, used_names(question.formula))
    new = [n for edit in repair.edits if edit.kind == "put back" for n in letters(edit.new)]
    return not rates & had and bool(rates & dependencies(question.theory, new))


def _without_value(met: Agreement) -> str:
    if met.expected <= POINTS // 2:
        return f"the quantity has no value at {POINTS - met.expected} of {POINTS} states; say where it has with assume"
    told = f"no value at {met.expected - met.valued} of {met.expected} states"
    return f"{told}; agrees at the others, so say with assume where it is meant to hold" if met.agrees else told


def _unordered(exam: Examination, tree: Node) -> Repair:
    found = standing(exam, tree)
    return replace(found, orders={})


def domain(question: Question) -> str:
    """Where formula and quantity were compared, in words."""
    theory = question.theory
    used = [k for k in theory.letters if k in dependencies(theory, [question.quantity]) and k not in question.hold]
    positive = [k for k in used if theory.letters[k].positive and not theory.letters[k].domain]
    signed = [k for k in used if not theory.letters[k].positive and not theory.letters[k].domain]
    ranges = [f"{d[0]:g} < {k} < {d[1]:g}" for k in used if (d := theory.letters[k].domain)]
    parts = [f"positive {', '.join(positive)}"] if positive else []
    parts += [f"all {', '.join(signed)}"] if signed else []
    parts += ["rods longer than their cranks"] if theory.rods else []
    held = [f"{k} = {v:g}" for k, v in question.hold.items()]
    return "; ".join([*parts, *ranges, *held])


def _verdict(exam: Examination, verdict: str, start: Repair, **more: Any) -> Decision:
    notes = [exam.question.formula.note, more.pop("note", ""), _at_the_data(verdict, start)]
    return Decision(
        verdict=verdict,
        max_rel_error=start.max_rel_error,
        order=None if start.exact else lowest(start.orders),
        orders={k: v for k, v in start.orders.items() if v != EXACT},
        dimensions=is_consistent(exam.scales, start.tree),
        counterexample={} if start.exact else _counterexample(exam, start.tree),
        note="; ".join(n for n in notes if n),
        **more,
    )


def _at_the_data(verdict: str, start: Repair) -> str:
    if verdict in PASSED or verdict == "untestable" or start.max_rel_error > _NONE:
        return ""
    return "at the case's own data it agrees over the whole turn; other values of the letters, as in the example, tell"


def _counterexample(exam: Examination, tree: Node) -> dict[str, float]:
    strict = exam.judged.strict
    printed, expected = value(strict, tree), strict.expected
    with mpmath.workdps(strict.digits):
        errors = [_relative(p, e) for p, e in zip(printed, expected, strict=True)]
    worst = int(np.argmax(errors))
    known = names(strict, [])
    needed = dependencies(exam.question.theory, [exam.question.quantity])
    free = [k for k in exam.question.theory.letters if k in needed]
    shown = [n for n in dict.fromkeys([*letters(tree), *free]) if n in known]
    state = {n: float(_at(known[n], worst)) for n in shown if np.ndim(known[n]) <= 1}
    return state | {"printed": float(printed[worst]), "derived": float(expected[worst])}


def _relative(printed: Any, expected: Any) -> float:
    if mpmath.isnan(expected):
        return -1.0
    if mpmath.isnan(printed):
        return float("inf")
    return float(abs(printed - expected) / (abs(expected) or mpmath.mpf(1)))


def _at(values: Any, index: int) -> Any:
    return values[index] if np.ndim(values) else values
