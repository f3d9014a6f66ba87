"""Two slips in one formula: every first one is tried, the second is read off from what is required then.

After a first edit the derived value is pushed down the tree again. A second edit elsewhere is one whose part, of which
the values are known beforehand, meets the required one; a wrong number or power is a quotient that is the same at all
states; what was left out is found as for one slip, for all parts at once.
"""

import ast
import time
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np

from mechsym.audit.algebra import evaluate
from mechsym.audit.bench import Bench, names, part_values, scratch, shaped
from mechsym.audit.edits import Edit, apply, is_exponent, is_product, is_term, places, scaled
from mechsym.audit.insertion import Vocabulary, candidate_words, product, simple, vocabulary
from mechsym.audit.prover import is_exact
from mechsym.audit.put_back import lost_factor, lost_term
from mechsym.audit.repair import Examination, Repair, search_bench, simplicity, slips, standing
from mechsym.audit.required import required
from mechsym.audit.slips import node_edits
from mechsym.audit.tidy import tidy
from mechsym.audit.tree import Node, Path, at, binary, children, letters, negative, number, replace, value_of, walk
from mechsym.audit.units_of import ANGLE, kind_of_letter
from mechsym.quantities import record

MAX_PARTS = 90
MIN_LEAVES = 5  # two edits make anything of less
MAX_FIRST = 700
MAX_SECONDS = 20.0  # of the processor, after which no further first slip is tried
_MET = 1e-7


@record
class _Known:
    """What does not change while first edits are tried."""

    asked: Bench
    listed: list[Edit]
    values: np.ndarray  #: shape (edits, states): What stands at the place of each edit [-]
    words: Vocabulary
    solve: np.ndarray  #: shape (words + 1, states): Exponents of words from logarithms [-]


def paired_repair(exam: Examination, start: Repair) -> tuple[Repair | None, str]:
    """The simplest pair of edits after which a formula is the derived quantity, and a note where not all were tried."""
    count = sum(1 for _ in walk(start.tree))
    if count > MAX_PARTS or sum(not children(node) for _, node in walk(start.tree)) < MIN_LEAVES:
        return None, ""
    known = _prepare(exam, start.tree)
    found: list[tuple[tuple[int, int], Edit, Edit]] = []
    firsts, end, note = known.listed[:MAX_FIRST], time.process_time() + MAX_SECONDS, ""
    with np.errstate(all="ignore"):
        for tried, first in enumerate(firsts):
            if time.process_time() > end:
                note = f"of two slips at once only the first {tried} of {len(firsts)} were tried, in {MAX_SECONDS:g} s"
                break
            tree = apply(start.tree, first)
            with scratch(known.asked):
                seconds = list(_seconds(known, first, tree))
            for second in seconds:
                rank = [simplicity(e, t) for e, t in ((first, tree), (second, apply(tree, second)))]
                found.append(((rank[0][0] + rank[1][0], rank[1][1]), first, second))
    for _, first, second in sorted(found, key=lambda f: f[0])[:60]:
        tree = apply(apply(start.tree, first), second)
        if is_exact(exam.judged, tree):
            return standing(exam, tidy(tree, start.tree), (*start.edits, first, second)), ""
    return None, note


def _prepare(exam: Examination, tree: Node) -> _Known:
    asked = search_bench(exam, "exact")
    edits = [e for e in slips(exam, tree)[0] if _plain_letter(exam, tree, e)]
    listed = sorted(_distinct(asked, edits), key=lambda e: simplicity(e, e.new))
    words = vocabulary(asked, _plain_words(exam, tree))
    matrix = np.column_stack([np.ones(len(asked.expected)), words.logs[list(words.basis)].T])
    with np.errstate(all="ignore"):
        known = names(asked, {n for e in listed for n in letters(e.new)})
        values = [shaped(asked, evaluate(e.new, known, asked.algebra, asked.memo)) for e in listed]
    shape = (len(listed), len(asked.expected))
    return _Known(
        asked=asked, listed=listed, values=np.array(values, dtype=float).reshape(shape),
        words=words, solve=np.linalg.pinv(matrix),
    )  # fmt: skip


def _plain_letter(exam: Examination, tree: Node, edit: Edit) -> bool:
    # with two slips a derived name would mend anything; an angle may be taken for another
    if edit.kind != "letter" or not isinstance(edit.new, ast.Name):
        return True
    used = {*letters(tree), *exam.question.theory.letters, *exam.question.formula.letters}
    return edit.new.id in used or kind_of_letter(exam.question, edit.new.id) == ANGLE


def _plain_words(exam: Examination, tree: Node) -> list[Node]:
    # with two slips a derived name would mend anything
    used = {*letters(tree), *exam.question.theory.letters}
    words = candidate_words(exam.question, tree)
    return [w for w in words if isinstance(w, ast.Call) or isinstance(w, ast.Name) and w.id in used]


def _distinct(asked: Bench, edits: list[Edit]) -> list[Edit]:
    # edits of one place that give the same values count once
    found: dict[Any, Edit] = {}
    known = names(asked, {n for e in edits for n in letters(e.new)})
    with np.errstate(all="ignore"):
        for edit in edits:
            new = shaped(asked, evaluate(edit.new, known, asked.algebra, asked.memo))
            found.setdefault((edit.path, np.asarray(new, dtype=float).round(12).tobytes()), edit)
    return list(found.values())


def _seconds(known: _Known, first: Edit, tree: Node) -> Iterator[Edit]:
    asked = known.asked
    memo = part_values(asked, tree)
    wishes = required(asked, tree, memo)
    yield from _elsewhere(known, first, wishes)
    yield from _near(known, first, tree, wishes)
    spots = [p for p in places(tree) if p.path in wishes and not is_exponent(p)]
    yield from _numbers(spots, wishes, memo)
    yield from _left_out(known, tree, spots, wishes, memo)


def _elsewhere(known: _Known, first: Edit, wishes: Any) -> Iterator[Edit]:
    usable = [i for i, e in enumerate(known.listed) if e.path in wishes and _apart(e.path, first.path)]
    if not usable:
        return
    wanted = np.array([wishes[known.listed[i].path] for i in usable], dtype=float)
    for i in np.flatnonzero(_meets(known.values[usable], wanted)):
        yield known.listed[usable[i]]


def _apart(one: Path, other: Path) -> bool:
    short = min(len(one), len(other))
    return one[:short] != other[:short]


def _meets(values: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    valid = np.isfinite(wanted)
    close = np.abs(values - wanted) <= _MET * np.abs(wanted)
    return np.all(close | ~valid, axis=-1) & (np.mean(valid, axis=-1) > 0.6)


def _near(known: _Known, first: Edit, tree: Node, wishes: Any) -> Iterator[Edit]:
    # on the way to the first edit, and in what it brought
    asked = known.asked
    for place in places(tree):
        inside = place.path[: len(first.path)] == first.path
        if not (inside or first.path[: len(place.path)] == place.path):
            continue
        above = place.path
        while above not in wishes:
            above = above[:-1]
        for kind, new in node_edits(place, lambda letter: ()):
            whole = replace(at(tree, above), place.path[len(above) :], new)
            values = shaped(asked, evaluate(whole, names(asked, ()), asked.algebra, asked.memo))
            if _meets(np.asarray(values, dtype=float), np.asarray(wishes[above], dtype=float)):
                yield Edit(kind=kind, path=place.path, new=new)


def _numbers(spots: list[Any], wishes: Any, memo: dict[Node, Any]) -> Iterator[Edit]:
    products = [p for p in spots if is_product(p)]
    if not products:
        return
    factors = np.array([np.broadcast_to(wishes[p.path] / memo[p.node], np.shape(wishes[()])) for p in products])
    for i in np.flatnonzero(_constant(factors)):
        factor, node = simple(factors[i]), products[i].node
        if factor is not None and factor not in (1, 0):
            new = scaled(negative(node) if factor < 0 else node, abs(factor))
            yield Edit(kind="sign" if factor == -1 else "factor", path=products[i].path, new=new)
    bases = [p for p in spots if value_of(p.node) is None and not isinstance(p.node, ast.UnaryOp)]
    logs = [np.log(np.abs(wishes[p.path])) / np.log(np.abs(memo[p.node])) for p in bases]
    powers = np.array([np.broadcast_to(e, np.shape(wishes[()])) for e in logs])
    for i in np.flatnonzero(_constant(powers)) if len(bases) else ():
        exponent = Fraction(float(np.median(powers[i]))).limit_denominator(4)
        if exponent not in (0, 1) and abs(exponent) <= 4 and abs(float(exponent) - np.median(powers[i])) < 1e-6:
            yield Edit(kind="power", path=bases[i].path, new=binary(ast.Pow, bases[i].node, number(exponent)))


def _constant(values: np.ndarray) -> np.ndarray:
    middle = np.median(values, axis=1, keepdims=True)
    return np.all(np.isfinite(values), axis=1) & np.all(np.abs(values - middle) <= _MET * np.abs(middle), axis=1)


def _left_out(known: _Known, tree: Node, spots: list[Any], wishes: Any, memo: dict[Node, Any]) -> Iterator[Edit]:
    shape, most = np.shape(wishes[()]), sum(not children(p.node) for p in places(tree))
    nodes = {p.path: p.node for p in places(tree)}
    asked = [p for p in spots if value_of(p.node) is None]
    kinds = [(p, factor) for p in asked for factor in (True, False) if (is_product(p) if factor else is_term(p))]
    if not kinds or not known.words.basis:
        return
    missing = np.array(
        [
            np.broadcast_to(wishes[p.path] / memo[p.node] if factor else wishes[p.path] - memo[p.node], shape)
            for p, factor in kinds
        ]
    )
    logs = np.log(np.abs(missing))
    good = np.all(np.isfinite(logs), axis=1)
    exponents = np.where(good[:, None], logs, 0.0) @ known.solve.T
    off = np.abs(2 * exponents[:, 1:] - np.round(2 * exponents[:, 1:])).max(axis=1)
    used = np.sum(np.abs(np.round(2 * exponents[:, 1:])) > 0, axis=1)
    for i in np.flatnonzero(good & (off < 1e-4) & (used >= 1) & (used <= min(4, most))):
        place, factor = kinds[i]
        found = product(known.asked, known.words, missing[i])
        if found is None or len(found[1]) > (2 if any(e < 0 for _, e in found[1]) else 3):
            continue
        if factor:
            yield from lost_factor(nodes, place, found, most)
        else:
            yield from lost_term(place, found, most)
