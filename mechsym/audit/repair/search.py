"""The order in which a formula that is not exact is searched: one slip, something lost, two slips, or only nearer.

Of two slips every first one is tried, and the derived value is pushed down the tree again. A second edit elsewhere is
one whose part, of which the values are known beforehand, meets the required one; a wrong number or power is a quotient
that is the same at all states; what was left out is found as for one slip, for all parts at once.
"""

import ast
from collections.abc import Callable, Iterator, Mapping
from decimal import Decimal
from fractions import Fraction

import numpy as np

from mechsym.audit.judge.dimensions import ANGLE, is_consistent, kind_of_letter, odd_arguments
from mechsym.audit.judge.orders import EXACT, Powers, changed_powers, expansions, overshoot, powers
from mechsym.audit.judge.prover import is_exact
from mechsym.audit.judge.question import Bench, names, part_values, peak, scratch, shaped, value
from mechsym.audit.read.algebra import Values, evaluate
from mechsym.audit.read.tree import (
    Node,
    Path,
    at,
    binary,
    children,
    is_operation,
    letters,
    negative,
    number,
    replace,
    value_of,
    walk,
)
from mechsym.audit.repair.edits import Edit, Spot, apply, is_exponent, is_product, is_term, places, scaled, tidy
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
from mechsym.audit.repair.insertion import (
    Vocabulary,
    candidate_words,
    lost_factor,
    lost_term,
    product,
    simple,
    vocabulary,
)
from mechsym.audit.repair.required import required
from mechsym.audit.repair.slips import node_edits
from mechsym.quantities import record

MAX_PARTS = 90
MIN_LEAVES = 5  # two edits make anything of less
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
    solve: np.ndarray  #: shape (words + 1, states): Exponents of words from logarithms [-]


def paired_repair(exam: Examination, start: Repair) -> tuple[Repair | None, str]:
    """The simplest pair of edits after which a formula is the derived quantity, and a note where not all were tried."""
    count = sum(1 for _ in walk(start.tree))
    if count > MAX_PARTS or sum(not children(node) for _, node in walk(start.tree)) < MIN_LEAVES:
        return None, ""
    known = _prepare(exam, start.tree)
    pairs: list[tuple[tuple[int, int], Edit, Edit]] = []
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
        tree = apply(apply(start.tree, first), second)
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
    return _Known(asked=asked, listed=listed, values=known_values, words=words, solve=np.linalg.pinv(matrix))


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
    spots = [p for p in places(tree) if p.path in wishes and not is_exponent(p)]
    yield from _numbers(spots, wishes, memo)
    yield from _left_out(known, tree, spots, wishes, memo)


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


def _numbers(spots: list[Spot], wishes: Wishes, memo: dict[Node, Values]) -> Iterator[Edit]:
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


def _left_out(known: _Known, tree: Node, spots: list[Spot], wishes: Wishes, memo: dict[Node, Values]) -> Iterator[Edit]:
    shape, most = np.shape(wishes[()]), sum(not children(p.node) for p in places(tree))
    nodes = {p.path: p.node for p in places(tree)}
    asked = [p for p in spots if value_of(p.node) is None]
    kinds, gaps = [], []  # place and whether a factor is sought there; what is missing
    for place in asked:
        if is_product(place):
            kinds.append((place, True))
            gaps.append(np.broadcast_to(wishes[place.path] / memo[place.node], shape))
        if is_term(place):
            kinds.append((place, False))
            gaps.append(np.broadcast_to(wishes[place.path] - memo[place.node], shape))
    if not kinds or not known.words.basis:
        return
    missing = np.array(gaps)
    logs = np.log(np.abs(missing))
    good = np.all(np.isfinite(logs), axis=1)
    exponents = np.where(good[:, None], logs, 0.0) @ known.solve.T
    off = np.abs(2 * exponents[:, 1:] - np.round(2 * exponents[:, 1:])).max(axis=1)
    used = np.sum(np.abs(np.round(2 * exponents[:, 1:])) > 0, axis=1)
    for i in np.flatnonzero(good & (off < 1e-4) & (used >= 1) & (used <= min(4, most))):
        place, factor = kinds[i]
        lost = product(known.asked, known.words, missing[i])
        if lost is None or len(lost[1]) > (2 if any(e < 0 for _, e in lost[1]) else 3):
            continue
        if factor:
            yield from lost_factor(nodes, place, lost, most)
        else:
            yield from lost_term(place, lost, most)


_SAME = 1e-9
_NOISE = 1e-12
# an error beyond this at the source's data is no approximation, whatever its powers
LARGEST_ERROR = 5.0
_MOST = 2.0  # a truncation is off by little more than the first term that it leaves out
_NOTHING = 1e-12  # of a term, by which another one beside it is none
_PLAIN = {"root", "sign", "factor", "argument", "number", "unit", "letter", "sine and cosine", "power", "degrees"}


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
    if not start.orders or min(start.orders.values()) < 1 or start.max_rel_error > LARGEST_ERROR:
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


def search(exam: Examination, start: Repair) -> Found:
    """What is wrong with a formula that is neither exact nor a truncation, and its repairs."""
    mixed = _mixed(exam, start)
    single = exact_repair(exam, start)
    if single is not None:
        # in an honest approximation, a bracket moved or a factor taken away is a coincidence; but nobody writes
        # sqrt(1) - x: what the function is of has lost its bracket
        of_number = any(isinstance(n, ast.Call) and value_of(n.args[0]) is not None for _, n in walk(start.tree))
        if not mixed or single.edits[-1].kind in _PLAIN or of_number:
            return Found(repairs=(single,))
    raised, mended = _raising(exam, start) if start.orders else ([], [])
    if mended and mended[0].edits[-1].kind in _PLAIN:
        return Found(repairs=tuple(mended))
    lost = exact_repair(exam, start, insert=True)
    if lost is not None and (not mixed or is_operation(lost.edits[-1].new, ast.Add, ast.Sub)):
        return Found(repairs=(lost,))
    if mixed or mended:
        return Found(repairs=() if mixed else tuple(mended), mixed=mixed, note=mixed)
    pair, cut = paired_repair(exam, start)
    return Found(repairs=(pair,)) if pair else Found(nearer=raised[0] if raised else None, note=cut)


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
    """Whether a formula that is not exact may be what was meant: no odd angles, no part that changes nothing."""
    question = exam.question
    if odd_arguments(question.theory, tree, question.formula.letters):
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
    told = ", ".join(f"lam^{k}" for k in few) + (" .." if len(orders) > 4 else "")
    return f"the relative power{'s' if len(few) > 1 else ''} {told}" if few else "powers of lam"


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
