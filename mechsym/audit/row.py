"""The one road from a formula to its row: equation, question, verdict, and the keys that people and JSON get."""

import re
from collections.abc import Mapping, Sequence
from dataclasses import replace

from mechsym.audit.judge import conventions
from mechsym.audit.judge.asked import Asked, question_of
from mechsym.audit.judge.left_side import left_note
from mechsym.audit.judge.orders import expansions, groups, powers
from mechsym.audit.judge.question import Question, used_names
from mechsym.audit.read.letter import WAYS, Ambiguous, Way
from mechsym.audit.read.mathml import STYLE, corrected, formula
from mechsym.audit.read.reader import joined, write
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.statement import Statement, statement
from mechsym.audit.read.tree import at, with_one_number, without_double_signs
from mechsym.audit.repair.edits import apply
from mechsym.audit.repair.examination import Repair
from mechsym.audit.theory.record import dependencies
from mechsym.audit.verdict import FINDINGS, PASSED, RIGHT_WITH, WORST, Decision, decide
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.page import page
from mechsym.quantities import results
from mechsym.quantities.display import ratio_text
from mechsym.quantities.results import Columns, part, result, tell

Row = Json
_LONGEST = 90


@result
class Evidence:
    """What a verdict rests on."""

    quantity: str = part()
    data: str = part()
    certificate: str | None = part()
    domain: str | None = part()
    orders: Mapping[str, float] = results.quantity("-")  #: First power of lambda that is neglected, by load
    dimensions_consistent: bool = part()
    counterexample: Columns = part()  #: A state of the letters where print and derivation differ, and both there
    other_repairs: list[str] = part()


@result
class Compared:
    """What the audit tells of a formula; what is no formula to compare has no evidence."""

    verdict: str = part()
    max_rel_error: float | None = results.quantity("-")  #: Largest over a turn, over the derived or a tenth of its peak
    order: int | None = results.quantity("-")  #: First power of lambda that is neglected
    correction: str | None = part()
    corrected_max_rel_error: float | None = results.quantity("-")  #: Largest error of the correction
    note: str = part()
    printed: str = part()
    understood: str | None = part()
    effect: str = part()
    evidence: Evidence | Mapping[str, str] = part()


_ORDER = re.compile(r"(?:to\s+)?(?:lam(?:bda)?|λ|\\lambda)\s*(?:\^|\*\*)\s*\{?(\d+)\}?")
_WITHIN = re.compile(r"within\s+(\d+(?:\.\d+)?(?:e-?\d+)?)\s*(%)?")


def _share(within: re.Match[str]) -> float:
    return float(within[1]) * (0.01 if within[2] else 1.0)


def answer(asked: Asked, *, one: bool = False) -> Row:
    """The row of one formula; of a = b = c that of the worst equality. one: repairs of two edits are not looked for.

    What can be read in two ways is read in the one that is right, and asked about where none is.
    """
    try:
        return _row(asked, one)
    except Ambiguous:
        rows = _read_each_way(asked)
        right = [(way, row) for way, row in rows if row["verdict"] in PASSED]
        if len(right) != 1 and (right or not rows or any(row["verdict"] not in FINDINGS for _, row in rows)):
            raise
        way, row = right[0] if right else min(rows, key=_how_far)
        row = row if right or one else _row(replace(asked, way=way), one)
        other = f"the other way it is not {asked.quantity}" if right else "it is not right in any way"
        return row | {"note": joined(row["note"], f"read as {row['understood']}; {other}")}


def _read_each_way(asked: Asked) -> list[tuple[Way, Row]]:
    rows: dict[tuple[str, str], tuple[Way, Row]] = {}
    for way in WAYS:
        try:
            row = _row(replace(asked, way=way), one=True)
        except BadInput:
            continue
        rows.setdefault((row["understood"], row["verdict"]), (way, row))
    return list(rows.values())


def _how_far(read: tuple[Way, Row]) -> tuple[bool, int]:
    return read[1]["correction"] is None, len(read[1]["note"])


def _row(asked: Asked, one: bool) -> Row:
    said, claim = statement(asked.text, asked.quantity), asked.claim.strip()
    if claim not in ("", "=", "approx") and not _ORDER.fullmatch(claim) and not _WITHIN.fullmatch(claim):
        raise BadInput(f'--claim {claim!r} is not known; it is "=", "approx", "lam^2" or "within 1 %"')
    within = _WITHIN.fullmatch(claim)
    if within and _share(within) >= 1:
        raise BadInput(
            f"--claim {claim!r} is {100 * _share(within):g} %, which most formulas keep; write 'within 1 %' or '0.01'"
        )
    rows = [_answer(asked, replace(said, right=(right,)), claim, one) for right in said.right]
    return min(rows, key=lambda r: WORST.index(r["verdict"]))


def answer_or_why(asked: Asked) -> Row:
    """The row of one formula, `untestable` with the reason where it cannot be asked."""
    try:
        return answer(asked)
    except BadInput as error:
        return unread_row(asked.name, asked.against, asked.text, str(error))


def shared(rows: Sequence[Row]) -> list[Row]:
    """The rows of one source: what several formulas count alike is their author's convention."""
    notes = [row["note"].partition(RIGHT_WITH)[2].partition(";")[0].strip() for row in rows]
    said = [(row["claim"].rpartition(".")[0], words) for row, words in zip(rows, notes, strict=True)]
    settled = []
    for row, pair in zip(rows, said, strict=True):
        many = said.count(pair) if pair[1] and row["verdict"] == "untestable" else 0
        note = f"right with {pair[1]}, as {many} formulas of this source count"
        settled.append(row | {"verdict": "convention", "correction": None, "note": note} if many > 1 else row)
    return settled


def _answer(asked: Asked, said: Statement, claim: str, one: bool) -> Row:
    chosen = [c for c in conventions.checked(asked.convention) if c != "show"]
    question = question_of(asked, said)
    verdict = decide(question, one=one, cut_short=bool(claim))
    read = {*dependencies(question.theory, [question.quantity]), *used_names(question.formula)}
    held, idle = ([f"{k} = {v:g}" for k, v in question.hold.items() if (k in read) == there] for there in (True, False))
    notes = [f"compared at {', '.join(held)}" if held else "", left_note(question, asked.quantity, said.left)]
    # an even motion is said of a whole paper, not of the formulas that hold its speed
    idle = [said for said in idle if not question.theory.letters[said.split()[0]].unit.endswith(("/s", "/s^2"))]
    notes += [f"not read: {', '.join(idle)}; neither the formula nor {question.quantity} holds it"] if idle else []
    if chosen and verdict.verdict not in ("exact", "convention"):
        question = conventions.converted(question, chosen)
        verdict = decide(question, settled=True)
        if verdict.verdict in PASSED:
            note = joined(verdict.note, f"{verdict.verdict} with {conventions.told(chosen)}")
            verdict = replace(verdict, verdict="convention", note=note)
    if verdict.verdict not in PASSED and (also := conventions.also_exact(question)):
        notes.append(f"also exact with {conventions.told(also)}")
    claimed = f"{question.theory.name}.{asked.quantity}"
    head = {"source": "own", "equation": asked.name or said.number or "-", "claim": claimed}
    row = head | formula_row(question, verdict, asked.text, joined(*notes), "")
    if not claim:
        return row
    holds, why = _kept(claim, question, verdict)
    words = f"the claim {claim!r} {'is kept' if holds else 'is broken'}: {why}"
    return row | {"claimed": claim, "claim_kept": holds, "note": joined(row["note"], words)}


def _kept(claim: str, question: Question, decision: Decision) -> tuple[bool, str]:
    # whether a claim holds, and why
    exact = decision.verdict == "exact" or decision.verdict == "convention" and not decision.orders
    if claim == "=":
        return exact, decision.verdict
    if claim == "approx":
        return decision.verdict in ("exact", "truncation", "convention", "mixed"), decision.verdict
    if match := _WITHIN.fullmatch(claim):
        return decision.max_rel_error <= _share(match), f"the largest relative error is {decision.max_rel_error:.3g}"
    if exact:
        return True, "exact"
    # as absolute powers of lambda, over all loads
    by_load = expansions(question, [g.name for g in groups(question)])
    firsts = [powers(by_load[k], question.formula.tree).first for k in decision.orders]
    kept = [f for f in firsts if f is not None]
    order = _ORDER.fullmatch(claim)
    if order is None or not kept or len(kept) < len(firsts):
        return False, "there is no small lambda" if not decision.orders else "the leading term is wrong"
    return min(kept) > int(order[1]), f"the first power that differs is lam^{min(kept)}"


def formula_row(question: Question, verdict: Decision, printed: str, note: str, effect: str) -> Row:
    """The keys of a formula that was compared."""
    best = verdict.repairs[0] if verdict.repairs else None
    evidence = Evidence(
        quantity=f"{question.theory.name}.{question.quantity}",
        data=question.theory.data,
        certificate=verdict.certificate or None,
        domain=verdict.domain or None,
        orders=dict(verdict.orders),
        dimensions_consistent=verdict.dimensions,
        counterexample=_with_units(question, verdict.counterexample),
        other_repairs=[write(question.formula, r.tree) for r in verdict.repairs[1:4]],
    )
    row = tell(
        Compared(
            verdict=verdict.verdict,
            max_rel_error=verdict.max_rel_error,
            order=verdict.order,
            correction=write(question.formula, with_one_number(without_double_signs(best.tree))) if best else None,
            corrected_max_rel_error=best.max_rel_error if best else None,
            note=joined(verdict.note, _edits(question, best), _nearer(question, verdict.nearer), note, effect),
            printed=printed,
            understood=write(question.formula),
            effect=effect,
            evidence=evidence,
        )
    )
    if evidence.counterexample:  # a state keeps the units of its letters
        row["evidence"]["counterexample"] = evidence.counterexample
    return row


def _with_units(question: Question, state: Mapping[str, float]) -> Columns:
    """A state of the letters, with what the print and the derivation give there."""
    theory = question.theory
    units = {**theory.units, **{name: letter.unit for name, letter in theory.letters.items()}}
    own = units.get(question.quantity, "-")
    return Columns(state, {name: units.get(name) or "-" for name in state} | {"printed": own, "derived": own})


def _edits(question: Question, best: Repair | None) -> str:
    if best is None:
        return ""
    changes, tree = [], question.formula.tree
    for edit in best.edits:
        texts = [to_python(node) for node in (at(tree, edit.path), edit.new)]
        old, new = (text if len(text) <= _LONGEST else f"{text[:_LONGEST]} ..." for text in texts)
        changes.append(f"{edit.kind}: {edit.about or f'{old} becomes {new}'}")
        tree = apply(tree, edit)
    return f"repaired by {', then by '.join(changes)}"


def _nearer(question: Question, nearer: Repair | None) -> str:
    if nearer is None:
        return ""
    text = write(question.formula, nearer.tree)
    if nearer.exact:
        return f"perhaps {text}"
    return f"nearer, and still not right: {text} (largest relative error {nearer.max_rel_error:.3g})"


def plain_row(verdict: str, error: float | None, note: str, printed: str) -> Row:
    """The keys of what is no formula to compare; the error is relative [-]."""
    return tell(Compared(
        verdict=verdict, max_rel_error=error, order=None, correction=None, corrected_max_rel_error=None,
        note=note, printed=printed, understood=None, effect="", evidence={},
    ))  # fmt: skip


def unread_row(name: str, against: str, printed: str, why: str) -> Row:
    """The row of a formula that could not be asked."""
    head = {"source": "own", "equation": name or "-", "claim": against}
    return head | plain_row("untestable", None, f"not read: {why}", printed)


def html(title: str, summary: str, rows: Sequence[Row]) -> str:
    """The rows as one HTML page that opens offline: what is printed, what it was compared with, verdict, correction."""
    from markupsafe import Markup

    def set_beside(printed: str, correction: str | None) -> Sequence[Markup]:
        both = corrected(printed, correction) if correction else (formula(printed),)
        return [Markup(text) for text in both]  # noqa: S704 escaped where it is made

    return page("audit.html", title=title, summary=summary, rows=rows, ratio=ratio_text, set_beside=set_beside,
                formulas=Markup(STYLE))  # fmt: skip
