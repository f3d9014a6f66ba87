"""Two slips at once: every first one is tried, and the derived value is pushed down the tree again.

A second edit is one whose part, of which the values are known beforehand, meets the required one, wherever the first
has put it; a wrong number or power is a quotient that is the same at all states; what was left out is found for all
parts at once. Of the pairs that are exact the one with the shortest description is taken.
"""

import ast
import dataclasses
from collections.abc import Iterator, Mapping

import numpy as np

from mechsym.audit.judge.dimensions import ANGLE, kind_of_letter
from mechsym.audit.judge.prover import is_exact
from mechsym.audit.judge.question import Bench, names, part_values, scratch, shaped
from mechsym.audit.read.algebra import Values, evaluate
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import Node, Path, at, function_of, letters, replace, walk
from mechsym.audit.repair.edits import Edit, apply, tidy
from mechsym.audit.repair.examination import Examination, Repair, search_bench, simplicity, slips, standing
from mechsym.audit.repair.lost import Vocabulary, candidate_words, insertions, vocabulary
from mechsym.audit.repair.required import numbers, required, words_of
from mechsym.audit.repair.rules import CIRCULAR, Words, description, forms, length, rewritten
from mechsym.quantities import record

MAX_PARTS = 90
LONGEST = 0.85  # share of a formula's own description that two edits may take: more make anything of anything
MAX_FIRST = 700
MAX_PAIRS = 3000  # that are asked whether they are exact, those with the shortest description first
MAX_WORK = 30_000  # first slips times parts of the formula: beyond, some seconds, no further first slip is tried
_MET = 1e-7
Wishes = Mapping[Path, Values]  # what each part would have to be


@record
class _Known:
    """What does not change while first edits are tried."""

    asked: Bench
    listed: list[Edit]
    parts: set[int]  #: Identities of the formula's parts
    seen: list[Path]  #: Of each edit, the sine, cosine or tangent that its angle stands in, or else its own place
    edits_of: Mapping[int, list[int]]  #: By the identity of what stands there, which of them
    values: np.ndarray  #: shape (edits, states): What stands there with the edit [-]
    words: Vocabulary
    nested: Words  #: What rules may bring in within a first edit and around it
    solve: np.ndarray  #: shape (words + 1, states): Exponents of words from logarithms [-]


def paired_repair(exam: Examination, start: Repair) -> tuple[Repair | None, str]:
    """The simplest pair of edits after which a formula is the derived quantity, and a note where not all were tried."""
    count = sum(1 for _ in walk(start.tree))
    if count > MAX_PARTS:
        return None, ""
    known = _prepare(exam, start.tree)
    pairs: list[tuple[float, int, Node, Edit, Edit]] = []
    firsts = known.listed[:MAX_FIRST]
    most = MAX_WORK // count
    note = f"of two slips at once only the first {most} of {len(firsts)} were tried" if len(firsts) > most else ""
    with np.errstate(all="ignore"):
        for first in firsts[:most]:
            once = apply(start.tree, first)
            bits = description(start.tree, first) + 2 * np.log2(count)
            with scratch(known.asked):
                seconds = list(_seconds(known, first, once))
            for second in seconds:
                tree, both = apply(once, second), bits + description(once, second)
                if both <= LONGEST * length(tree):
                    pairs.append((both, len(to_python(tree)), tree, first, second))
    for _, _, tree, first, second in sorted(pairs, key=lambda pair: pair[:2])[:MAX_PAIRS]:
        if is_exact(exam.judged, tree):
            return standing(exam, tidy(tree, start.tree), (*start.edits, first, second)), ""
    return None, note


def _prepare(exam: Examination, tree: Node) -> _Known:
    asked = search_bench(exam, "exact")
    edits = [e for e in slips(exam, tree)[0] if _plain_letter(exam, tree, e)]
    listed = _distinct(asked, sorted(edits, key=lambda e: simplicity(e, e.new)))
    # with two slips a derived name would mend anything
    used = {*letters(tree), *exam.question.theory.letters}
    candidates = candidate_words(exam.question, tree)
    words = vocabulary(asked, [w for w in candidates if isinstance(w, ast.Call) or used.issuperset(letters(w))])
    matrix = np.column_stack([np.ones(len(asked.expected)), words.logs[list(words.basis)].T])
    seen = [_seen(tree, e.path) for e in listed]
    edits_of: dict[int, list[int]] = {}
    for k, path in enumerate(seen):
        edits_of.setdefault(id(at(tree, path)), []).append(k)
    news = [replace(at(tree, p), e.path[len(p) :], e.new) for p, e in zip(seen, listed, strict=True)]
    with np.errstate(all="ignore"):
        known = names(asked, {n for new in news for n in letters(new)})
        values = [shaped(asked, evaluate(new, known, asked.algebra, asked.memo)) for new in news]
    known_values = np.array(values, dtype=float).reshape(len(listed), len(asked.expected))
    every = words_of(exam.question)
    return _Known(
        asked=asked,
        listed=listed,
        parts={id(node) for _, node in walk(tree)},
        seen=seen,
        edits_of=edits_of,
        values=known_values,
        words=words,
        nested=Words(
            turned=every.turned,
            pure=every.pure,
            is_pure=every.is_pure,
            alike=lambda k: [a for a in every.alike(k) if a in used],
        ),
        solve=np.linalg.pinv(matrix),
    )


def _seen(tree: Node, path: Path) -> Path:
    """The sine, cosine or tangent whose argument stands at a path: of its values alone the angle is not known."""
    above = at(tree, path[:-1]) if path[-1:] == ("argument",) else None
    return path[:-1] if above is not None and function_of(above) in CIRCULAR else path


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
    yield from _standing(known, tree, wishes)
    yield from _changed(known, first, tree, wishes)
    single = {path: (wish,) for path, wish in wishes.items()}
    yield from numbers(asked, tree, single, memo)
    yield from insertions(asked, tree, single, memo, known.words, known.solve)


def _standing(known: _Known, tree: Node, wishes: Wishes) -> Iterator[Edit]:
    """Edits of parts that the first edit has left as they were, wherever they stand now."""
    usable: list[int] = []
    paths: list[Path] = []
    for path, node in walk(tree):
        edits = known.edits_of.get(id(node), ()) if path in wishes else ()
        usable += edits
        paths += [path] * len(edits)
    if not usable:
        return
    wanted = np.array([wishes[path] for path in paths], dtype=float)
    for i in np.flatnonzero(_meets(known.values[usable], wanted)):
        edit, seen = known.listed[usable[i]], known.seen[usable[i]]
        yield dataclasses.replace(edit, path=paths[i] + edit.path[len(seen) :])


def _meets(values: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    valid = np.isfinite(wanted)
    close = np.abs(values - wanted) <= _MET * np.abs(wanted)
    return np.all(close | ~valid, axis=-1) & (np.mean(valid, axis=-1) > 0.6)


def _changed(known: _Known, first: Edit, tree: Node, wishes: Wishes) -> Iterator[Edit]:
    """Edits of parts that the first edit has brought, or put elsewhere, or that it stands in."""
    asked, within = known.asked, len(first.path)
    for form in forms(tree, wide=False):
        path = form.place.path
        stands = path[:within] != first.path or id(form.place.parent) in known.parts
        if stands and id(form.place.node) in known.parts:
            continue
        above = _seen(tree, path)
        while above not in wishes:
            above = above[:-1]
        for kind, new in rewritten(form, known.nested):
            whole = replace(at(tree, above), path[len(above) :], new)
            values = shaped(asked, evaluate(whole, names(asked, letters(whole)), asked.algebra, asked.memo))
            if _meets(np.asarray(values, dtype=float), np.asarray(wishes[above], dtype=float)):
                yield Edit(kind=kind, path=path, new=new)
