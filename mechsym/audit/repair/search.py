"""The order in which a formula that is not exact is searched: one slip, something lost, two slips, or only nearer."""

import ast
from collections.abc import Callable
from decimal import Decimal
from fractions import Fraction

import mpmath
import numpy as np

from mechsym.audit.judge.dimensions import is_consistent, odd_arguments
from mechsym.audit.judge.orders import EXACT, Powers, changed_powers, expansions, overshoot, powers
from mechsym.audit.judge.question import part_values, peak, value
from mechsym.audit.read.tree import (
    Node,
    argument_of,
    at,
    function_of,
    is_operation,
    number,
    replace,
    value_of,
    walk,
)
from mechsym.audit.repair.edits import Edit, apply, places
from mechsym.audit.repair.examination import (
    Examination,
    Repair,
    exact_repair,
    raising_repairs,
    search_bench,
)
from mechsym.audit.repair.pairs import paired_repair
from mechsym.audit.repair.required import required
from mechsym.audit.repair.rules import CIRCULAR
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
    emptied = bool(mended) and _emptied(mended[0].tree)
    if mended and not emptied and mended[0].edits[-1].kind in _PLAIN:
        return Found(repairs=tuple(mended))
    lost = exact_repair(exam, start, insert=True)
    if lost is not None:
        added = is_operation(lost.edits[-1].new, ast.Add, ast.Sub)
        if not mixed or added or _of_number(start.tree) or _is_slip(exam, start.tree, lost.edits):
            return Found(repairs=(lost,))
    evident = emptied or _of_number(start.tree) or _in_degrees(start.tree)
    if mended and (one or not emptied) or mixed and (one or not evident):
        return Found(repairs=() if mixed else tuple(mended), mixed=mixed, note=mixed)
    pair, cut = (None, "") if one else paired_repair(exam, start)
    if pair or mixed:
        return Found(repairs=(pair,)) if pair else Found(mixed=mixed, note=mixed)
    if mended:
        return Found(repairs=tuple(mended))
    return Found(nearer=raised[0] if raised else None, note=cut)


def _of_number(tree: Node) -> bool:
    # nobody writes sqrt(1) - x: what the function is of has lost something
    return any(isinstance(n, ast.Call) and value_of(n.args[0]) is not None for _, n in walk(tree))


def _emptied(tree: Node) -> bool:
    """Whether a root has lost what stood beside its square: sqrt(l**2), sqrt(l)**2, sqrt(1)."""
    inside = [n for _, node in walk(tree) if (n := argument_of(node, "sqrt")) is not None]
    squared = [node.left for _, node in walk(tree) if is_operation(node, ast.Pow) and value_of(node.right) == 2]
    alone = any(value_of(n) is not None or is_operation(n, ast.Pow) and value_of(n.right) == 2 for n in inside)
    return alone or any(argument_of(n, "sqrt") is not None for n in squared)


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
