"""The decision: exact, truncation, convention, mixed, misprint (with the edit that repairs it), nearer, wrong."""

import ast
from collections.abc import Mapping
from dataclasses import field, replace
from typing import Any

import mpmath
import numpy as np

from mechsym.audit.judge.conventions import conditions, reading, under
from mechsym.audit.judge.dimensions import is_consistent
from mechsym.audit.judge.orders import EXACT, lowest
from mechsym.audit.judge.prover import POINTS, ROUNDING, Agreement, agreement, proves_equal, reach
from mechsym.audit.judge.question import Question, names, used_names, value
from mechsym.audit.judge.window import DECADES, is_wide
from mechsym.audit.read.reader import joined
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import Node, letters, walk
from mechsym.audit.repair.examination import Examination, Repair, exact_repair, examine, standing
from mechsym.audit.repair.search import Found, search, truncated
from mechsym.audit.theory.record import dependencies
from mechsym.quantities import record

PASSED = ("exact", "truncation", "convention")  # exit status 0
FINDINGS = ("misprint", "nearer", "wrong")  # exit status 1
OPEN = ("mixed", "untestable")  # exit status 3
WORST = ("wrong", "nearer", "misprint", *OPEN, "convention", "truncation", "exact")  # the worst first
RIGHT_WITH = "a misprint, or right with"  # a convention that nothing tells
_NEAR_ONLY = "it agrees near the data and not over the whole domain; say with assume where it is meant to hold"
_EITHER = "a term is too many, or one has lost a factor that the condition makes zero"
_STATIC = "it has no speed at all, so that what it has lost may hold at any speed"


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


def decide(question: Question, settled: bool = False, one: bool = False, cut_short: bool = False) -> Decision:
    """Compare a printed formula with the derived quantity; `settled`: its author's way of counting is known; `one`:
    two slips at once are not searched for; `cut_short`: its author says that it is one."""
    exam = examine(question)
    plain = _plain(exam, cut_short)
    if plain is not None:
        return plain
    for condition in (*conditions(question), *conditions(question, written=True)):
        judged = _plain(examine(under(question, condition)), cut_short)
        if judged is not None and judged.verdict in ("exact", "truncation"):
            words = "exact" if judged.verdict == "exact" else f"a truncation of relative order {judged.order}"
            note = joined(judged.note, f"{words} at {condition.told}")
            return replace(judged, verdict="convention", note=note)
    return _searched(exam, settled, one)


def _keeps_the_rod(question: Question) -> bool:
    """Whether a sine, a root or the like of the formula is of what hangs on the length of a rod."""
    for _, node in walk(question.formula.tree):
        if isinstance(node, ast.Call):
            own = question.formula.letters
            inside = [k for name in letters(node) for k in (letters(own[name]) if name in own else [name])]
            if {*question.theory.rods} & dependencies(question.theory, inside):
                return True
    return False


def _plain(exam: Examination, cut_short: bool = False) -> Decision | None:
    # what needs no search: exact, without values, or a truncation
    tree = exam.question.formula.tree
    met = agreement(exam.judged, tree)
    reached = reach(exam.judged, tree) if met.exact else None
    if reached is not None and not reached.everywhere and reached.where is None:
        return _decision(exam, "untestable", replace(standing(exam, tree), orders={}), note=_NEAR_ONLY)
    if reached is not None:
        proof = "polynomial" if reached.everywhere and proves_equal(exam.question, tree) else "50 digits"
        turns = "up to whole turns" if met.turned else ""
        limit = f"{to_python(reached.where)} > 0" if reached.where is not None else ""
        where = joined(domain(exam.question), limit)
        reason = joined(turns, f"where {limit}" if limit else "")
        return _decision(exam, "exact", standing(exam, tree), certificate=proof, domain=where, note=reason)
    if met.expected <= POINTS // 2 or met.agrees or met.vanishes:
        start = replace(standing(exam, tree), orders={})
        return _decision(exam, "untestable", start, note=_without_value(met))
    if not is_consistent(exam.scales, tree):
        return None
    start = standing(exam, tree)
    note = truncated(exam, start)
    if note is not None and not cut_short and _keeps_the_rod(exam.question) and exact_repair(exam, start) is not None:
        return None  # a series has no angle of the rod in it
    return None if note is None else _decision(exam, "truncation", start, note=note, domain=domain(exam.question))


def _searched(exam: Examination, settled: bool, one: bool) -> Decision:
    question, tree = exam.question, exam.question.formula.tree
    start = standing(exam, tree)
    condition = next(conditions(question), None)
    single = exact_repair(exam, start) or exact_repair(exam, start, insert=True) if condition else None
    if single is not None:
        outcome = Found(repairs=(single,))
    else:
        if condition is not None:  # a slip in a formula for constant speed
            exam = examine(under(question, condition))
            start = standing(exam, tree)
        outcome = search(exam, start, one)
    if single is None and condition is not None:
        if outcome.repairs and outcome.repairs[0].edits[-1].kind == "left out":
            # a term to be taken away at constant speed may as well have lost what vanishes there
            outcome = Found(nearer=outcome.repairs[0], note=_EITHER)
        if outcome.repairs and _brings_rates(question, outcome.repairs[0]):
            outcome = Found(nearer=outcome.repairs[0], note=_STATIC)
        outcome = replace(outcome, note=joined(outcome.note, f"compared at {condition.told}"))
    # the one place where a slip of the pen gets its name
    if outcome.repairs:
        verdict = "misprint"
    else:
        verdict = "mixed" if outcome.mixed else "nearer" if outcome.nearer else "wrong"
    met = agreement(exam.judged, tree)
    if verdict in ("wrong", "nearer") and 2 * met.valued <= met.expected:
        return _decision(exam, "untestable", start, note=_without_value(met))
    # what is right in its author's way of counting is said and not blamed
    if not settled and verdict in FINDINGS and (read := reading(exam.judged, tree)):
        verdict, outcome = "untestable", replace(outcome, note=joined(f"{RIGHT_WITH} {read}", outcome.note))
    note = outcome.note if met.valued else joined(outcome.note, "as printed it has no real value anywhere")
    return _decision(exam, verdict, start, repairs=outcome.repairs, nearer=outcome.nearer, note=note)


def _brings_rates(question: Question, repair: Repair) -> bool:
    # a term with the speed put back into a formula that has none is right at constant speed only by chance
    rates = {k for k, letter in question.theory.letters.items() if letter.unit in ("rad/s", "rad/s^2")}
    had = dependencies(question.theory, used_names(question.formula))
    new = [n for edit in repair.edits if edit.kind == "put back" for n in letters(edit.new)]
    return not rates & had and bool(rates & dependencies(question.theory, new))


def _without_value(met: Agreement) -> str:
    if met.vanishes:
        return "the quantity is 0 at every state, so that any formula that vanishes there would do; assume less"
    if met.agrees and met.valued == met.expected and not met.at_data:
        return "it agrees at random states and not at the source's data, which lie outside of where those are drawn"
    if met.expected <= POINTS // 2:
        return f"the quantity has no value at {POINTS - met.expected} of {POINTS} states; say where it has with assume"
    reason = f"no value at {met.expected - met.valued} of {met.expected} states"
    return f"{reason}; agrees at the others, so say with assume where it is meant to hold" if met.agrees else reason


def domain(question: Question) -> str:
    """Where formula and quantity were compared, in words."""
    theory = question.theory
    needed = dependencies(theory, [question.quantity])
    used = {k: about for k, about in theory.letters.items() if k in needed and k not in question.hold}
    positive = [k for k, about in used.items() if about.positive and not about.domain]
    signed = [k for k, about in used.items() if not about.positive and not about.domain]
    ranges = [f"{about.domain[0]:g} < {k} < {about.domain[1]:g}" for k, about in used.items() if about.domain]
    parts = [f"positive {', '.join(positive)}"] if positive else []
    parts += [f"all {', '.join(signed)}"] if signed else []
    parts += ["rods longer than their cranks"] if theory.rods else []
    reach = f"from 1/{10**DECADES} to {10**DECADES} of the data" if is_wide(question) else "from 0.7 to 1.4 of the data"
    parts += [reach] if positive or signed else []
    return "; ".join([*parts, *ranges, *(f"{k} = {v:g}" for k, v in question.hold.items())])


def _decision(exam: Examination, verdict: str, start: Repair, note: str, **more: Any) -> Decision:
    data = ""
    if verdict not in (*PASSED, "untestable") and start.max_rel_error <= ROUNDING:
        data = (
            "at the case's own data it agrees over the whole turn; other values of the letters, as in the example, tell"
        )
    return Decision(
        verdict=verdict,
        max_rel_error=start.max_rel_error,
        order=None if start.exact else lowest(start.orders),
        orders={k: v for k, v in start.orders.items() if v != EXACT},
        dimensions=is_consistent(exam.scales, start.tree),
        counterexample={} if start.exact else _counterexample(exam, start.tree),
        note=joined(exam.question.formula.note, note, data),
        **more,
    )


def _counterexample(exam: Examination, tree: Node) -> dict[str, float]:
    strict = exam.judged.strict
    printed, expected = value(strict, tree), strict.expected
    errors = []
    with mpmath.workdps(strict.digits):
        for p, e in zip(printed, expected, strict=True):
            away = float("inf") if mpmath.isnan(p) else float(abs(p - e) / (abs(e) or mpmath.mpf(1)))
            errors.append(-1.0 if mpmath.isnan(e) else away)
    worst = int(np.argmax(errors))
    known = names(strict, [])
    needed = dependencies(exam.question.theory, [exam.question.quantity])
    free = [k for k in exam.question.theory.letters if k in needed]
    shown = [n for n in dict.fromkeys([*letters(tree), *free]) if n in known]
    state = {n: float(known[n][worst] if np.ndim(known[n]) else known[n]) for n in shown if np.ndim(known[n]) <= 1}
    return state | {"printed": float(printed[worst]), "derived": float(expected[worst])}
