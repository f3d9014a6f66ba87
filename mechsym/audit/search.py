"""The order in which a formula that is not exact is searched: one slip, something lost, two slips, or only nearer."""

import ast
from collections.abc import Callable

from mechsym.audit.dimensions import is_consistent
from mechsym.audit.expansion import Powers, changed_powers, powers
from mechsym.audit.orders import EXACT
from mechsym.audit.pairs import paired_repair
from mechsym.audit.repair import Examination, Repair, exact_repair, raising_repairs
from mechsym.audit.rounding import rounded_constant
from mechsym.audit.tree import Node, is_operation, value_of, walk
from mechsym.quantities import record

# an error beyond this at the source's data is no approximation, whatever its powers
LARGEST_ERROR = 5.0
# what makes a formula a truncation by taking its terms away does not repair it
_TAKES_AWAY = {"left out"}
_PLAIN = {"root", "sign", "factor", "argument", "number", "unit", "letter", "sine and cosine", "power", "degrees"}


@record
class Found:
    """What the search says of a formula."""

    verdict: str  #: `misprint`, `mixed`, `nearer` or `wrong`
    repairs: tuple[Repair, ...] = ()
    nearer: Repair | None = None
    note: str = ""


def standing_powers(exam: Examination, repair: Repair, holds: Callable[[Powers], bool]) -> list[Powers] | None:
    """Powers of lambda for every load for which a formula is not exact; None where something does not hold for one."""
    found = []
    for load in (k for k, order in repair.orders.items() if order != EXACT):
        found.append(powers(exam.expansions[load], repair.tree))
        if not holds(found[-1]):
            return None
    return found


def truncated(exam: Examination, start: Repair) -> str | None:
    """A note on a formula that is a pure truncation, or exact but for rounded numbers; None where it is neither."""
    if note := rounded_constant(exam, start.tree):
        return note
    if not start.orders or min(start.orders.values()) < 1 or start.max_rel_error > LARGEST_ERROR:
        return None
    found = standing_powers(exam, start, lambda p: p.pure)
    if found is None:
        return None
    return f"leaves out {_powers({k for p in found for k in p.missing[:1]})} and what follows"


def search(exam: Examination, start: Repair) -> Found:
    """The verdict on a formula that is neither exact nor a truncation, and its repairs."""
    mixed = _mixed(exam, start)
    single = exact_repair(exam, start)
    # in an honest approximation, a bracket moved or a factor taken away is a coincidence
    if single is not None and not (mixed and single.edits[-1].kind not in _PLAIN and not _of_number(start.tree)):
        return Found(verdict="misprint", repairs=(single,))
    raised, mended = _raising(exam, start) if start.orders else ([], [])
    if mended and mended[0].edits[-1].kind in _PLAIN:
        return Found(verdict="misprint", repairs=tuple(mended))
    lost = exact_repair(exam, start, insert=True)
    if lost is not None and (not mixed or is_operation(lost.edits[-1].new, ast.Add, ast.Sub)):
        return Found(verdict="misprint", repairs=(lost,))
    if mended and not mixed:
        return Found(verdict="misprint", repairs=tuple(mended))
    if mixed:
        return Found(verdict="mixed", note=mixed)
    pair, cut = paired_repair(exam, start)
    if pair is not None:
        return Found(verdict="misprint", repairs=(pair,))
    if raised:
        return Found(verdict="nearer", nearer=raised[0], note=cut)
    return Found(verdict="wrong", note=cut)


def _of_number(tree: Node) -> bool:
    # nobody writes sqrt(1) - x: what the function is of has lost its bracket
    return any(isinstance(n, ast.Call) and value_of(n.args[0]) is not None for _, n in walk(tree))


def _raising(exam: Examination, start: Repair) -> tuple[list[Repair], list[Repair]]:
    # what raises an order, and what of it leaves nothing wrong
    first: list[Repair] = []
    for found in raising_repairs(exam, start):
        raised = [r for r in found if is_consistent(exam.scales, r.tree)]
        if mended := [r for r in raised if _mends(exam, start, r)]:
            return raised, mended
        first = first or raised
    return first, []


def _mends(exam: Examination, start: Repair, repair: Repair) -> bool:
    # every power that the edit changes is right or left out afterwards
    if repair.edits[-1].kind in _TAKES_AWAY or min(repair.orders.values(), default=EXACT) < 1:
        return False
    changed = [k for k in repair.orders if repair.orders[k] != start.orders[k] and repair.orders[k] != EXACT]
    kept = [k for k, order in repair.orders.items() if k not in changed and order != EXACT]
    if not all(powers(exam.expansions[load], repair.tree).honest for load in kept):
        return False  # another slip is left
    for load in changed:
        found = powers(exam.expansions[load], repair.tree)
        truncates = found.pure or found.missing and min(found.missing) < min(found.wrong)
        if not (found.honest and truncates) or set(found.wrong) & changed_powers(
            exam.expansions[load], start.tree, repair.tree
        ):
            return False
    return True


def _mixed(exam: Examination, start: Repair) -> str:
    if not start.orders or min(start.orders.values()) < 1 or start.max_rel_error > LARGEST_ERROR:
        return ""
    found = standing_powers(exam, start, lambda p: p.honest)
    if found is None or not is_consistent(exam.scales, start.tree):
        return ""
    wrong = {k for p in found for k in p.wrong}
    return f"no truncation: {_powers(wrong)} neither right nor left out"


def _powers(orders: set[int]) -> str:
    few = sorted(orders)[:4]
    told = ", ".join(f"lam^{k}" for k in few) + (" .." if len(orders) > 4 else "")
    return f"the relative power{'s' if len(few) > 1 else ''} {told}" if few else "powers of lam"
