"""Verdicts as rows with the documented keys, for people, JSON and the record."""

from collections.abc import Callable, Iterable
from typing import Any

from mechsym.audit.bench import peak, turn, value
from mechsym.audit.edits import apply
from mechsym.audit.entries import Audited, Entry, Listed, Printed, TextClaim
from mechsym.audit.printer import to_python
from mechsym.audit.question import Question
from mechsym.audit.reader import read, write
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import known
from mechsym.audit.tree import Node, at
from mechsym.audit.verdict import Decision, decide

Row = dict[str, Any]
NAME = ("source", "equation", "claim")
COMPARED = ("verdict", "order", "correction")
_LONGEST = 90


def question_of(entry: Printed) -> Question:
    """The question that a printed formula raises.

    Returns
    -------
    question : Question
        With the data of its source
    """
    name, _, quantity = entry.quantity.partition(".")
    found = theory(name)
    return Question(
        formula=read(entry.statement, known(found), entry.letters),
        theory=found,
        quantity=quantity,
        hold=entry.hold,
        turn=entry.turn() if entry.turn else {},
    )


def rows(sources: Iterable[Audited], done: Callable[[], Any] = lambda: None) -> list[Row]:
    """Audit sources.

    Returns
    -------
    rows : list of dict
        One per entry, in the order of the text
    """
    found = []
    for source in sources:
        for entry in source.entries:
            found.append(row(source.stem, entry))
            done()
    return found


def row(source: str, entry: Entry) -> Row:
    """The verdict on one entry.

    Returns
    -------
    row : dict
        Documented keys, and printed, evidence, effect
    """
    head = {"source": source, "equation": entry.equation, "claim": entry.claim}
    if isinstance(entry, Printed):
        question = question_of(entry)
        answer = decide(question)
        effect = entry.effect(answer) if entry.effect else _at_the_data(question, answer)
        return head | formula_row(question, answer, entry.statement, entry.note, effect)
    if isinstance(entry, Listed):
        return head | _plain(entry.verdict, None, entry.note, entry.statement)
    assert isinstance(entry, TextClaim)
    decided = entry.decide()
    verdict = "supported claim" if decided.supported else "unsupported claim"
    error = None if decided.rel_error is None else abs(decided.rel_error)
    return head | _plain(verdict, error, decided.note, "")


def _at_the_data(question: Question, decision: Decision) -> str:
    # what a wrong formula does to the number that it stands for
    if decision.verdict not in ("misprint", "nearer", "wrong"):
        return ""
    asked = turn(question)
    printed, derived = peak(value(asked, question.formula.tree)), peak(asked.expected)
    unit = question.theory.units.get(question.quantity, "").removesuffix("-")
    right, own = f"{derived:.4g} {unit}".strip(), f"{printed:.4g} {unit if decision.dimensions else ''}".strip()
    where = "the largest value over a turn at the source's data" if question.theory.angle else "at the source's data it"
    return f"{where} is {own} as printed and {right} as derived"


def formula_row(question: Question, verdict: Decision, printed: str, note: str, effect: str) -> Row:
    """The keys of a formula that was compared.

    Parameters
    ----------
    printed : str
        The formula as it was given
    note, effect : str
        What else there is to say
    """
    best = verdict.repairs[0] if verdict.repairs else None
    notes = [verdict.note, _edits(question, verdict), _nearer(question, verdict), note, effect]
    return {
        "verdict": verdict.verdict,
        "max_rel_error": verdict.max_rel_error,
        "order": verdict.order,
        "correction": write(question.formula, best.tree) if best else None,
        "corrected_max_rel_error": best.max_rel_error if best else None,
        "note": "; ".join(n for n in notes if n),
        "printed": printed,
        "understood": write(question.formula),
        "effect": effect,
        "evidence": _evidence(question, verdict),
    }


def unread_row(name: str, against: str, printed: str, why: str) -> Row:
    """The row of a formula that could not be asked."""
    head = {"source": "own", "equation": name or "-", "claim": against}
    return head | _plain("untestable", None, f"not read: {why}", printed)


def _edits(question: Question, verdict: Decision) -> str:
    if not verdict.repairs:
        return ""
    found, tree = [], question.formula.tree
    for edit in verdict.repairs[0].edits:
        change = edit.about or f"{_told(at(tree, edit.path))} becomes {_told(edit.new)}"
        found.append(f"{edit.kind}: {change}")
        tree = apply(tree, edit)
    return f"repaired by {', then by '.join(found)}"


def _nearer(question: Question, verdict: Decision) -> str:
    if verdict.nearer is None:
        return ""
    text, error = write(question.formula, verdict.nearer.tree), verdict.nearer.max_rel_error
    if verdict.nearer.exact:
        return f"perhaps {text}"
    return f"nearer, and still not right: {text} (largest relative error {error:.3g})"


def _told(node: Node) -> str:
    text = to_python(node)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]} ..."


def _evidence(question: Question, verdict: Decision) -> Row:
    return {
        "quantity": f"{question.theory.name}.{question.quantity}",
        "data": question.theory.data,
        "certificate": verdict.certificate or None,
        "domain": verdict.domain or None,
        "orders": dict(verdict.orders),
        "dimensions_consistent": verdict.dimensions,
        "counterexample": dict(verdict.counterexample),
        "other_repairs": [write(question.formula, r.tree) for r in verdict.repairs[1:4]],
    }


def _plain(verdict: str, error: float | None, note: str, printed: str) -> Row:
    return {
        "verdict": verdict,
        "max_rel_error": error,
        "order": None,
        "correction": None,
        "corrected_max_rel_error": None,
        "note": note,
        "printed": printed,
        "understood": None,
        "effect": "",
        "evidence": {},
    }
