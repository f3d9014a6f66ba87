"""Two slips at once: every first one is tried, and the derived value is pushed down the tree again.

A second edit elsewhere is one whose part, of which the values are known beforehand, meets the required one; a wrong
number or power is a quotient that is the same at all states; what was left out is found for all parts at once.
"""

import ast
from collections.abc import Iterator, Mapping

import numpy as np

from mechsym.audit.judge.dimensions import ANGLE, kind_of_letter
from mechsym.audit.judge.prover import is_exact
from mechsym.audit.judge.question import Bench, names, part_values, scratch, shaped
from mechsym.audit.read.algebra import Values, evaluate
from mechsym.audit.read.tree import Node, Path, at, letters, replace, walk
from mechsym.audit.repair.edits import Edit, apply, tidy
from mechsym.audit.repair.examination import Examination, Repair, search_bench, simplicity, slips, standing
from mechsym.audit.repair.lost import Vocabulary, candidate_words, insertions, vocabulary
from mechsym.audit.repair.required import numbers, required, words_of
from mechsym.audit.repair.rules import Words, description, forms, length, rewritten
from mechsym.quantities import record

MAX_PARTS = 90
LONGEST = 0.85  # share of a formula's own description that two edits may take: more make anything of anything
MAX_FIRST = 700
MAX_WORK = 30_000  # first slips times parts of the formula: beyond, some seconds, no further first slip is tried
_MET = 1e-7
Wishes = Mapping[Path, Values]  # what each part would have to be


@record
class _Known:
    """What does not change while first edits are tried."""

    asked: Bench
    listed: list[Edit]
    values: np.ndarray  #: shape (edits, states): What stands at the place of each edit [-]
    words: Vocabulary
    angles: Words  #: Of all that rules may bring in
    solve: np.ndarray  #: shape (words + 1, states): Exponents of words from logarithms [-]


def paired_repair(exam: Examination, start: Repair) -> tuple[Repair | None, str]:
    """The simplest pair of edits after which a formula is the derived quantity, and a note where not all were tried."""
    count = sum(1 for _ in walk(start.tree))
    if count > MAX_PARTS:
        return None, ""
    known = _prepare(exam, start.tree)
    pairs: list[tuple[tuple[float, int], Edit, Edit]] = []
    firsts = known.listed[:MAX_FIRST]
    most = MAX_WORK // count
    note = f"of two slips at once only the first {most} of {len(firsts)} were tried" if len(firsts) > most else ""
    with np.errstate(all="ignore"):
        for first in firsts[:most]:
            tree = apply(start.tree, first)
            with scratch(known.asked):
                seconds = list(_seconds(known, first, tree))
            for second in seconds:
                rank = [simplicity(e, t) for e, t in ((first, tree), (second, apply(tree, second)))]
                pairs.append(((rank[0][0] + rank[1][0], rank[1][1]), first, second))
    for _, first, second in sorted(pairs, key=lambda f: f[0])[:60]:
        once = apply(start.tree, first)
        tree = apply(once, second)
        told = description(start.tree, first) + description(once, second) + 2 * np.log2(count)
        if told > LONGEST * length(tree):
            continue
        if is_exact(exam.judged, tree):
            return standing(exam, tidy(tree, start.tree), (*start.edits, first, second)), ""
    return None, note


def _prepare(exam: Examination, tree: Node) -> _Known:
    asked = search_bench(exam, "exact")
    edits = [e for e in slips(exam, tree)[0] if _plain_letter(exam, tree, e)]
    listed = sorted(_distinct(asked, edits), key=lambda e: simplicity(e, e.new))
    # with two slips a derived name would mend anything
    used = {*letters(tree), *exam.question.theory.letters}
    candidates = candidate_words(exam.question, tree)
    words = vocabulary(
        asked, [w for w in candidates if isinstance(w, ast.Call) or isinstance(w, ast.Name) and w.id in used]
    )
    matrix = np.column_stack([np.ones(len(asked.expected)), words.logs[list(words.basis)].T])
    with np.errstate(all="ignore"):
        known = names(asked, {n for e in listed for n in letters(e.new)})
        values = [shaped(asked, evaluate(e.new, known, asked.algebra, asked.memo)) for e in listed]
    known_values = np.array(values, dtype=float).reshape(len(listed), len(asked.expected))
    return _Known(
        asked=asked,
        listed=listed,
        values=known_values,
        words=words,
        angles=Words(turned=words_of(exam.question).turned),
        solve=np.linalg.pinv(matrix),
    )


def _plain_letter(exam: Examination, tree: Node, edit: Edit) -> bool:
    # with two slips a derived name would mend anything; an angle may be taken for another
    if edit.kind != "letter" or not isinstance(edit.new, ast.Name):
        return True
    used = {*letters(tree), *exam.question.theory.letters, *exam.question.formula.letters}
    return edit.new.id in used or kind_of_letter(exam.question, edit.new.id) == ANGLE


def _distinct(asked: Bench, edits: list[Edit]) -> list[Edit]:
    # edits of one place that give the same values count once
    distinct: dict[tuple[Path, bytes], Edit] = {}
    known = names(asked, {n for e in edits for n in letters(e.new)})
    with np.errstate(all="ignore"):
        for edit in edits:
            new = shaped(asked, evaluate(edit.new, known, asked.algebra, asked.memo))
            distinct.setdefault((edit.path, np.asarray(new, dtype=float).round(12).tobytes()), edit)
    return list(distinct.values())


def _seconds(known: _Known, first: Edit, tree: Node) -> Iterator[Edit]:
    asked = known.asked
    memo = part_values(asked, tree)
    wishes = {path: nearest for path, (nearest, *_) in required(asked, tree, memo, both=False).items()}
    yield from _elsewhere(known, first, wishes)
    yield from _near(known, first, tree, wishes)
    single = {path: (wish,) for path, wish in wishes.items()}
    yield from numbers(asked, tree, single, memo)
    yield from insertions(asked, tree, single, memo, known.words, known.solve)


def _elsewhere(known: _Known, first: Edit, wishes: Wishes) -> Iterator[Edit]:
    usable = []
    for k, edit in enumerate(known.listed):
        depth = min(len(edit.path), len(first.path))
        if edit.path in wishes and edit.path[:depth] != first.path[:depth]:
            usable.append(k)
    if not usable:
        return
    wanted = np.array([wishes[known.listed[i].path] for i in usable], dtype=float)
    for i in np.flatnonzero(_meets(known.values[usable], wanted)):
        yield known.listed[usable[i]]


def _meets(values: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    valid = np.isfinite(wanted)
    close = np.abs(values - wanted) <= _MET * np.abs(wanted)
    return np.all(close | ~valid, axis=-1) & (np.mean(valid, axis=-1) > 0.6)


def _near(known: _Known, first: Edit, tree: Node, wishes: Wishes) -> Iterator[Edit]:
    # on the way to the first edit, and in what it brought
    asked = known.asked
    for form in forms(tree, wide=False):
        path = form.place.path
        if not (path[: len(first.path)] == first.path or first.path[: len(path)] == path):
            continue
        above = path
        while above not in wishes:
            above = above[:-1]
        for kind, new in rewritten(form, known.angles):
            whole = replace(at(tree, above), path[len(above) :], new)
            values = shaped(asked, evaluate(whole, names(asked, letters(whole)), asked.algebra, asked.memo))
            if _meets(np.asarray(values, dtype=float), np.asarray(wishes[above], dtype=float)):
                yield Edit(kind=kind, path=path, new=new)
