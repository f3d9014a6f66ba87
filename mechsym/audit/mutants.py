"""Tests of the auditor by spoiling formulas: is every spoiled one refuted, and does the search find the way back?"""

import random
import re
from collections.abc import Sequence
from dataclasses import field

from mechsym.audit.edits import Edit, apply
from mechsym.audit.printer import to_python
from mechsym.audit.prover import is_exact, judges, proves_equal
from mechsym.audit.question import Question
from mechsym.audit.repair import Examination, examine, fingerprint, standing
from mechsym.audit.slips import single_edits
from mechsym.audit.tree import Node, letters
from mechsym.audit.verdict import search
from mechsym.quantities import record


@record
class Kills:
    """How many mutants of exact formulas were refuted."""

    #: All; those refuted; those proved to be the same function
    mutants: int
    refuted: int
    equivalent: int
    survivors: tuple[str, ...] = ()  #: Mutants that were neither refuted nor proved equal


@record
class Returns:
    """How many spoiled formulas came back to the original."""

    #: All, and those whose first repair is the original function
    spoiled: int
    returned: int
    misses: tuple[str, ...] = ()  #: The others: what was spoiled, and what was found instead
    by_kind: dict[str, tuple[int, int]] = field(default_factory=dict)  #: Kind of slip to (spoiled, returned)


def mutants(tree: Node) -> list[Edit]:
    """Every single edit of a formula.

    Returns
    -------
    edits : list of Edit
        Letters are mistaken for those of the formula with another index
    """
    used = letters(tree)

    def siblings(letter: str) -> list[str]:
        stem = re.sub(r"\d+$", "", letter)
        return [k for k in used if k != letter and re.sub(r"\d+$", "", k) == stem]

    return list(single_edits(tree, siblings))


def kills(question: Question) -> Kills:
    """Try to have every mutant of an exact formula refuted."""
    judged, original = judges(question), question.formula.tree
    changed = [apply(original, edit) for edit in mutants(original)]
    alive = [tree for tree in changed if is_exact(judged, tree)]
    survivors = [tree for tree in alive if not proves_equal(question, tree, original)]
    return Kills(
        mutants=len(changed),
        refuted=len(changed) - len(alive),
        equivalent=len(alive) - len(survivors),
        survivors=tuple(f"{question.theory.name}.{question.quantity}: {to_python(t)}" for t in survivors),
    )


def returns(question: Question, count: int, seed: int) -> Returns:
    """Spoil a right formula several times and search for the way back.

    Parameters
    ----------
    question : Question
        With an exact or honestly approximate formula
    count : int
        How often at most; mutants that are the same function are passed over
    """
    exam = examine(question)
    original = question.formula.tree
    wanted = fingerprint(exam, original)
    edits = [e for e in mutants(original) if fingerprint(exam, apply(original, e)) != wanted]
    chosen = random.Random(seed).sample(edits, min(count, len(edits)))
    found = {edit.path + (edit.kind, str(i)): _way_back(exam, edit) for i, edit in enumerate(chosen)}
    misses = [text for text in found.values() if text]
    return Returns(
        spoiled=len(chosen),
        returned=len(chosen) - len(misses),
        misses=tuple(misses),
        by_kind=_by_kind(chosen, list(found.values())),
    )


def _way_back(exam: Examination, edit: Edit) -> str:
    # empty when the first repair is the original function
    original = exam.question.formula.tree
    spoiled = apply(original, edit)
    verdict, found = search(exam, standing(exam, spoiled))
    if found and fingerprint(exam, found[0].tree) == fingerprint(exam, original):
        return ""
    instead = to_python(found[0].tree) if found else f"judged {verdict}"
    where = f"{exam.question.theory.name}.{exam.question.quantity}"
    return f"{where} [{edit.kind}]: {to_python(spoiled)} -> {instead}"


def _by_kind(edits: Sequence[Edit], misses: Sequence[str]) -> dict[str, tuple[int, int]]:
    counts: dict[str, tuple[int, int]] = {}
    for edit, miss in zip(edits, misses, strict=True):
        spoiled, returned = counts.get(edit.kind, (0, 0))
        counts[edit.kind] = (spoiled + 1, returned + (not miss))
    return counts


def total_kills(parts: Sequence[Kills]) -> Kills:
    """Kills of several formulas together."""
    return Kills(
        mutants=sum(p.mutants for p in parts),
        refuted=sum(p.refuted for p in parts),
        equivalent=sum(p.equivalent for p in parts),
        survivors=tuple(s for p in parts for s in p.survivors),
    )


def total_returns(parts: Sequence[Returns]) -> Returns:
    """Returns of several formulas together."""
    kinds = sorted({k for p in parts for k in p.by_kind})
    pairs = {k: [p.by_kind.get(k, (0, 0)) for p in parts] for k in kinds}
    return Returns(
        spoiled=sum(p.spoiled for p in parts),
        returned=sum(p.returned for p in parts),
        misses=tuple(m for p in parts for m in p.misses),
        by_kind={k: (sum(a for a, _ in v), sum(b for _, b in v)) for k, v in pairs.items()},
    )
