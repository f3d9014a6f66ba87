"""The repair search: which single edit makes the formula right? Found by search, never entered by hand."""

from collections.abc import Iterator, Mapping
from dataclasses import field
from fractions import Fraction
from functools import cached_property

import mpmath
import numpy as np

from mechsym.audit.judge.dimensions import Rescaled, rescaled
from mechsym.audit.judge.orders import EXACT, FINE, Expansion, LetterGroup, expansions, groups, orders, residual
from mechsym.audit.judge.prover import Judges, is_exact, judges
from mechsym.audit.judge.question import (
    Bench,
    Question,
    bench,
    digit_values,
    drawn,
    float_values,
    max_rel_error,
    small_rods,
    value,
)
from mechsym.audit.read.algebra import DIGITS, FLOATS
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import Node, digest, function_of, walk
from mechsym.audit.repair.edits import Edit, apply, tidy
from mechsym.audit.repair.required import matching_edits, words_of
from mechsym.audit.repair.rules import BITS, exchanged_edits, listed_edits, repeated_edits
from mechsym.quantities import record

SEARCH_DIGITS = 80
SEARCH_POINTS = 34


@record
class Examination:
    """A question with all states at which it is asked, made once."""

    question: Question
    judged: Judges
    search: dict[str, Bench] = field(default_factory=dict)  #: States of the search by group, made when needed
    slips: dict[bytes, tuple[list[Edit], list[Edit]]] = field(default_factory=dict)  #: Of formulas that were searched

    @property
    def turn(self) -> Bench:
        """One turn at the source's data."""
        return self.judged.turn

    @cached_property
    def groups(self) -> list[LetterGroup]:
        """Long rods for each load, made when needed."""
        return groups(self.question)

    @cached_property
    def scales(self) -> Rescaled:
        """States before and after a change of all units, made when needed."""
        return rescaled(self.question)

    @cached_property
    def expansions(self) -> dict[str, Expansion]:
        """Powers of lambda for each load, made when needed."""
        return expansions(self.question, [g.name for g in self.groups])


@record
class Repair:
    """A formula that an edit made better."""

    tree: Node
    edits: tuple[Edit, ...]
    exact: bool  #: Whether it is the derived quantity
    orders: Mapping[str, float]
    max_rel_error: float  #: Largest relative error over a turn [-]


def examine(question: Question) -> Examination:
    """Prepare the states at which a question is asked."""
    return Examination(question=question, judged=judges(question))


def standing(exam: Examination, tree: Node, edits: tuple[Edit, ...] = ()) -> Repair:
    """How good a formula is as it stands."""
    exact = is_exact(exam.judged, tree)
    known = {} if exact else orders(exam.groups, tree)
    return Repair(tree=tree, edits=edits, exact=exact, orders=known, max_rel_error=max_rel_error(exam.turn, tree))


def slips(exam: Examination, tree: Node) -> tuple[list[Edit], list[Edit]]:
    """Slips of one place of a formula, and slips that are repeated wherever the same part stands."""
    said = digest(tree)
    if said not in exam.slips:
        words = words_of(exam.question)
        exam.slips[said] = listed_edits(tree, words), repeated_edits(tree, words)
    return exam.slips[said]


def exact_repair(exam: Examination, start: Repair, insert: bool = False) -> Repair | None:
    """The simplest single edit that makes a formula the quantity: a slip, or with `insert` what was left out."""
    for listed in [[]] if insert else slips(exam, start.tree):
        if exact := _exact(exam, start, listed, insert):
            return exact
    if insert:
        return None
    words = words_of(exam.question)
    wider = [*exchanged_edits(start.tree, words.kind), *repeated_edits(start.tree, words, True)]
    return _exact(exam, start, [*wider, *listed_edits(start.tree, words, True)], insert)


def raising_repairs(exam: Examination, start: Repair) -> Iterator[list[Repair]]:
    """Edits that raise some load's order and worsen nothing, the likeliest first: of one place, then repeated."""
    for listed in slips(exam, start.tree):
        yield sorted((r for r in _raised(exam, start, listed, False) if is_sound(r)), key=_rank)


def _exact(exam: Examination, start: Repair, listed: list[Edit], insert: bool) -> Repair | None:
    edits = matching_edits(exam.question, search_bench(exam, "exact"), start.tree, listed, insert)
    for edit in _by_simplicity(start.tree, edits):
        tree = apply(start.tree, edit)
        if is_exact(exam.judged, tree):
            return standing(exam, tidy(tree, start.tree), (*start.edits, edit))
    return None


def _raised(exam: Examination, start: Repair, listed: list[Edit], insert: bool) -> list[Repair]:
    # groups with the same error at both lambdas need not be searched twice
    groups: dict[tuple[bytes, bytes], LetterGroup] = {}
    for one in sorted(exam.groups, key=lambda g: start.orders[g.name]):
        if start.orders[one.name] != EXACT:
            groups.setdefault((residual(one.coarse, start.tree), residual(one.fine, start.tree)), one)
    for group in groups.values():
        asked = search_bench(exam, group.name) if insert else group.fine
        edits = matching_edits(exam.question, asked, start.tree, listed, insert)
        distinct: dict[bytes, Edit] = {}
        for edit in _by_simplicity(start.tree, edits):
            distinct.setdefault(fingerprint(exam, apply(start.tree, edit)), edit)
        nearer = [
            e for e in distinct.values() if not max_rel_error(exam.turn, apply(start.tree, e)) > start.max_rel_error
        ]
        candidates = [standing(exam, apply(start.tree, e), (*start.edits, e)) for e in nearer]
        improved = [c for c in candidates if _improves(c, start)]
        if improved:
            return improved
    return []


def is_sound(repair: Repair) -> bool:
    """Whether every group's leading term is right; False when there is no small parameter."""
    return repair.exact or bool(repair.orders) and min(repair.orders.values()) >= 1


def search_bench(exam: Examination, group: str) -> Bench:
    """States of the search, the crank in the first quadrant, where most terms are positive: ordinary ones in floats for
    `exact`, long rods with many digits for a group."""
    if group not in exam.search:
        exam.search[group] = _search_bench(exam, group)
    return exam.search[group]


def _search_bench(exam: Examination, group: str) -> Bench:
    question, theory = exam.question, exam.question.theory
    letters = theory.letters
    # |F| for F is right wherever F is positive
    turned = any(function_of(node) == "abs" for _, node in walk(question.formula.tree))
    signs = {k: -1 if (turned and not r.positive) != (r.value < 0) else 1 for k, r in letters.items()}
    values = {
        k: v if letters[k].domain else [signs[k] * abs(x) for x in v]
        for k, v in drawn(question, SEARCH_POINTS, seed=5).items()
    }
    if theory.angle and not letters[theory.angle].domain and theory.angle not in question.hold:
        values[theory.angle] = [
            Fraction(1, 5) + abs(v) * Fraction(19, 10) % Fraction(11, 10) for v in values[theory.angle]
        ]
    if group == "exact":
        return bench(question, float_values(values), FLOATS)
    if group != "all":
        values |= {g.name: [Fraction(0)] * SEARCH_POINTS for g in exam.groups if g.name != group}
    with mpmath.workdps(SEARCH_DIGITS):
        digits = digit_values(small_rods(theory, values, FINE))
    return bench(question, digits, DIGITS, SEARCH_DIGITS)


def _improves(candidate: Repair, start: Repair) -> bool:
    pairs = [(candidate.orders.get(g, EXACT), start.orders[g]) for g in start.orders]
    higher = all(new >= old for new, old in pairs) and any(new > old for new, old in pairs)
    return higher and candidate.max_rel_error <= start.max_rel_error


def _by_simplicity(tree: Node, edits: list[Edit]) -> list[Edit]:
    return sorted(edits, key=lambda e: simplicity(e, apply(tree, e)))


def fingerprint(exam: Examination, tree: Node) -> bytes:
    """What formulas that are the same function have in common: their values to eight digits."""
    values = np.asarray(value(exam.judged.quick, tree), dtype=float)
    with np.errstate(all="ignore"):
        scale = 10.0 ** (8 - np.ceil(np.log10(np.abs(values))))
        return np.where(np.isfinite(values) & (values != 0), np.round(values * scale), 0).tobytes()


def simplicity(edit: Edit, tree: Node) -> tuple[float, int]:
    """The shortest description of a slip first, then the shortest formula [bits], [-]."""
    return BITS[edit.kind], len(to_python(tree))


def _rank(repair: Repair) -> tuple[float, ...]:
    worst = min(repair.orders.values(), default=EXACT)
    total = sum(min(k, 9.0) for k in repair.orders.values())
    return not repair.exact, -worst, -total, *simplicity(repair.edits[-1], repair.tree)
