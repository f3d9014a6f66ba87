"""The order in which a formula that is not exact is searched: one slip, something lost, two slips, or only nearer.

Two slips at once: every first one is tried, and the derived value is pushed down the tree again. A second edit
elsewhere is one whose part, of which the values are known beforehand, meets the required one; a wrong number or power
is a quotient that is the same at all states; what was left out is found for all parts at once.
"""

import ast
import dataclasses
from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np

from mechsym.audit.judge.dimensions import ANGLE, is_consistent, kind_of_letter, odd_arguments
from mechsym.audit.judge.orders import EXACT, Powers, changed_powers, expansions, overshoot, powers
from mechsym.audit.judge.prover import is_exact
from mechsym.audit.judge.question import Bench, names, part_values, peak, scratch, shaped, value
from mechsym.audit.read.algebra import Values, evaluate
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import (
    Node,
    Path,
    at,
    function_of,
    is_operation,
    letters,
    number,
    replace,
    value_of,
    walk,
)
from mechsym.audit.repair.edits import Edit, apply, places, tidy
from mechsym.audit.repair.examination import (
    Examination,
    Repair,
    exact_repair,
    raising_repairs,
    search_bench,
    simplicity,
    slips,
    standing,
)
from mechsym.audit.repair.lost import Vocabulary, candidate_words, insertions, vocabulary
from mechsym.audit.repair.required import numbers, required, words_of
from mechsym.audit.repair.rules import CIRCULAR, Words, description, forms, length, rewritten
from mechsym.quantities import record

_SAME = 1e-9
_SMALL = 1e-3  # change of a part at rods that are a hundred million times as long
_NOISE = 1e-12
# an error beyond this at the source's data is no approximation, whatever its powers
LARGEST_ERROR = 5.0
_MOST = 2.0  # a truncation is off by little more than the first term that it leaves out
_HALF_TURN = 180
_NOTHING = 1e-12  # of a term, by which another one beside it is none
_PLAIN = {*"root sign factor argument number unit letter power degrees angle".split(), "sine and cosine"}


@record
class Found:
    """What the search says of a formula."""

    repairs: tuple[Repair, ...] = ()  #: Corrected formulas, the most plausible first
    mixed: str = ""  #: Why it is neither a slip nor a truncation
    nearer: Repair | None = None
    note: str = ""


def standing_powers(exam: Examination, repair: Repair, holds: Callable[[Powers], bool]) -> list[Powers] | None:
    """Powers of lambda for every load for which a formula is not exact; None where something does not hold for one."""
    by_load = []
    for load in (k for k, order in repair.orders.items() if order != EXACT):
        by_load.append(powers(exam.expansions[load], repair.tree))
        if not holds(by_load[-1]):
            return None
    return by_load


def truncated(exam: Examination, start: Repair) -> str | None:
    """A note on a formula that is a pure truncation, or exact but for rounded numbers; None where it is neither."""
    if note := rounded_constant(exam, start.tree):
        return note
    if (
        not start.orders
        or min(start.orders.values()) < 1
        or start.max_rel_error > LARGEST_ERROR
        or _of_number(start.tree)
    ):
        return None
    standing = standing_powers(exam, start, lambda p: p.pure)
    if standing is None:
        return None
    # off by more than the first term left out accounts for, or wrong beyond the powers that are compared
    loads = [k for k, order in start.orders.items() if order != EXACT]
    if not all(exam.expansions[k].ends(start.tree) for k in loads):
        more = expansions(exam.question, [g.name for g in exam.groups], many=True)
        if not all(powers(more[k], start.tree).pure for k in loads):
            return None
    first = {k: p.first for k, p in zip(loads, standing, strict=True) if p.first is not None}
    # it leaves out nothing and differs all the same, or by more than the first term left out accounts for
    if not loads or len(first) < len(loads) or overshoot(exam.question, start.tree, first) > _MOST:
        return None
    return f"leaves out {_powers({k for p in standing for k in p.missing[:1]})} and what follows"


def search(exam: Examination, start: Repair, one: bool = False) -> Found:
    """What is wrong with a formula that is neither exact nor a truncation, and its repairs; `one`: of one edit."""
    mixed = _mixed(exam, start)
    single = exact_repair(exam, start)
    if single is not None and (not mixed or _of_number(start.tree) or _is_slip(exam, start.tree, single.edits)):
        return Found(repairs=(single,))
    raised, mended = _raising(exam, start) if start.orders else ([], [])
    if mended and mended[0].edits[-1].kind in _PLAIN:
        return Found(repairs=tuple(mended))
    lost = exact_repair(exam, start, insert=True)
    if lost is not None:
        added = is_operation(lost.edits[-1].new, ast.Add, ast.Sub)
        if not mixed or added or _of_number(start.tree) or _is_slip(exam, start.tree, lost.edits):
            return Found(repairs=(lost,))
    evident = _of_number(start.tree) or _in_degrees(start.tree)
    if mended or mixed and (one or not evident):
        return Found(repairs=() if mixed else tuple(mended), mixed=mixed, note=mixed)
    pair, cut = (None, "") if one else paired_repair(exam, start)
    if pair or mixed:
        return Found(repairs=(pair,)) if pair else Found(mixed=mixed, note=mixed)
    return Found(nearer=raised[0] if raised else None, note=cut)


def _of_number(tree: Node) -> bool:
    # nobody writes sqrt(1) - x: what the function is of has lost something
    return any(isinstance(n, ast.Call) and value_of(n.args[0]) is not None for _, n in walk(tree))


def _in_degrees(tree: Node) -> bool:
    """Whether the angle of a sine, cosine or tangent is turned from degrees, or into them."""
    circular = [n for _, n in walk(tree) if isinstance(n, ast.Call) and function_of(n) in CIRCULAR]
    return any(value_of(n) == _HALF_TURN for call in circular for _, n in walk(call.args[0]))


def _is_slip(exam: Examination, tree: Node, edits: tuple[Edit, ...]) -> bool:
    # in an honest approximation an edit that changes its part by little, if the rods are long, is a coincidence
    asked = exam.groups[0].fine
    for edit in edits:
        old, new = value(asked, at(tree, edit.path)), value(asked, edit.new)
        with np.errstate(all="ignore"), mpmath.workdps(asked.digits):
            changes = np.asarray(np.abs(new - old) / np.abs(new), dtype=float)
        if edit.kind not in _PLAIN and not np.nanmax(changes, initial=0.0) > _SMALL:
            return False
        tree = apply(tree, edit)
    return True


def _raising(exam: Examination, start: Repair) -> tuple[list[Repair], list[Repair]]:
    # what raises an order, and what of it leaves nothing wrong
    first: list[Repair] = []
    for repairs in raising_repairs(exam, start):
        raised = [r for r in repairs if is_consistent(exam.scales, r.tree)]
        if mended := [r for r in raised if _mends(exam, start, r)]:
            return raised, mended
        first = first or raised
    return first, []


def _mends(exam: Examination, start: Repair, repair: Repair) -> bool:
    # every power that the edit changes is right or left out afterwards
    if repair.edits[-1].kind == "left out" or min(repair.orders.values(), default=EXACT) < 1:
        return False
    if not is_plausible(exam, repair.tree):
        return False
    inexact = [k for k, order in repair.orders.items() if order != EXACT]
    standing = {load: powers(exam.expansions[load], repair.tree) for load in inexact}
    if any(p.worse or not p.honest for p in standing.values()):
        return False  # another slip is left
    for load in (k for k in inexact if repair.orders[k] != start.orders[k]):
        now = standing[load]
        truncates = now.pure or now.missing and min(now.missing) < min(now.wrong)
        if not truncates or set(now.wrong) & changed_powers(exam.expansions[load], start.tree, repair.tree):
            return False
    return True


def is_plausible(exam: Examination, tree: Node) -> bool:
    """Whether a formula that is not exact may be what was meant: angles in radians, no part that changes nothing."""
    question = exam.question
    if _in_degrees(tree) or odd_arguments(question.theory, tree, question.formula.letters):
        return False
    values = part_values(exam.judged.quick, tree)
    for _, node in walk(tree):
        if not is_operation(node, ast.Add, ast.Sub):
            continue
        # a term beside which the other one is nothing at any state
        with np.errstate(all="ignore"):
            left, right = (np.abs(np.asarray(values[side], dtype=float)) for side in (node.left, node.right))
            sizes = np.minimum(left, right) / np.maximum(left, right)
        if np.nanmax(sizes, initial=0.0) < _NOTHING and np.any(left * right != 0):
            return False
    return True


def _mixed(exam: Examination, start: Repair) -> str:
    if not start.orders or min(start.orders.values()) < 1 or start.max_rel_error > LARGEST_ERROR:
        return ""
    standing = standing_powers(exam, start, lambda p: p.honest)
    if standing is None or not is_consistent(exam.scales, start.tree):
        return ""
    wrong = {k for p in standing for k in p.wrong}
    if not wrong:
        return "no truncation: it is further off than by the first term that it leaves out, or wrong in higher powers"
    return f"no truncation: {_powers(wrong)} neither right nor left out"


def _powers(orders: set[int]) -> str:
    few = sorted(orders)[:4]
    words = ", ".join(f"lam^{k}" for k in few) + (" .." if len(orders) > 4 else "")
    return f"the relative power{'s' if len(few) > 1 else ''} {words}" if few else "powers of lam"


def rounded_constant(exam: Examination, tree: Node) -> str:
    """The one number that would make the formula exact with all its digits, in words: 6.28 for 2 pi is approximate, not
    wrong; empty where there is none."""
    asked, quick = search_bench(exam, "exact"), exam.judged.quick
    wishes = required(asked, tree, part_values(asked, tree))
    for place in places(tree):
        printed = place.node.value if isinstance(place.node, ast.Constant) else None
        if not isinstance(printed, float):
            continue
        half = 0.5 * 10.0 ** int(Decimal(str(printed)).as_tuple().exponent)
        for values in wishes.get(place.path, ()):
            wish = float(np.median(values))
            same = np.isfinite(wish) and wish and np.all(np.abs(np.asarray(values) / wish - 1) < _SAME)
            # a number that has lost no digits is not the one that is rounded
            if not same or abs(wish - printed) > half or abs(wish - printed) <= _NOISE * abs(printed) < half:
                continue
            mended = value(quick, replace(tree, place.path, number(Fraction(wish))))
            with np.errstate(all="ignore"):
                away = np.abs(mended - quick.expected) / peak(quick.expected)
            if np.all(away[np.isfinite(quick.expected)] < _SAME):
                return f"the constant {printed!r} is {wish:.9g} rounded"
    return ""


MAX_PARTS = 90
LONGEST = 0.85  # share of a formula's own description that two edits may take: more make anything of anything
MAX_FIRST = 700
MAX_PAIRS = 3000
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
        found = known.edits_of.get(id(node), ()) if path in wishes else ()
        usable += found
        paths += [path] * len(found)
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
