"""What an author claims of a formula: equality, an approximation, powers up to lam^k, an error within p per cent."""

import re

from mechsym.audit.expansion import powers
from mechsym.audit.orders import EXACT
from mechsym.audit.question import Question
from mechsym.audit.repair import Examination, Repair
from mechsym.audit.verdict import Decision
from mechsym.errors import BadInput

_ORDER = re.compile(r"(?:to\s+)?(?:lam(?:bda)?|λ|\\lambda)\s*(?:\^|\*\*)\s*\{?(\d+)\}?")
_WITHIN = re.compile(r"within\s+(\d+(?:\.\d+)?(?:e-?\d+)?)\s*(%)?")


def checked(claim: str) -> str:
    """The claim as it was given, refused where it is none."""
    claim = claim.strip()
    if claim in ("", "=", "approx") or _ORDER.fullmatch(claim) or _WITHIN.fullmatch(claim):
        return claim
    raise BadInput(f'--claim {claim!r} is not known; it is "=", "approx", "lam^2" or "within 1 %"')


def kept(claim: str, question: Question, found: Decision) -> tuple[bool, str]:
    """Whether a claim holds, and why."""
    if claim == "=":
        return found.verdict == "exact" or (found.verdict == "convention" and not found.orders), found.verdict
    if claim == "approx":
        return found.verdict in ("exact", "truncation", "convention", "mixed"), found.verdict
    if match := _WITHIN.fullmatch(claim):
        allowed = float(match[1]) * (0.01 if match[2] else 1.0)
        return found.max_rel_error <= allowed, f"the largest relative error is {found.max_rel_error:.3g}"
    order = int(_ORDER.fullmatch(claim)[1])  # type: ignore[index]
    if found.verdict == "exact" or found.verdict == "convention" and not found.orders:
        return True, "exact"
    first = _first_wrong(question, found)
    if first is None:
        return False, "there is no small lambda" if not found.orders else "the leading term is wrong"
    return first > order, f"the first power that differs is lam^{first}"


def _first_wrong(question: Question, found: Decision) -> int | None:
    # as an absolute power of lambda, over all loads
    tree = question.formula.tree
    exam = Examination(question=question, judged=None, turn=None)  # type: ignore[arg-type]
    start = Repair(tree=tree, edits=(), exact=False, orders=found.orders, max_rel_error=found.max_rel_error)
    loads = [k for k, order in start.orders.items() if order != EXACT]
    firsts = [powers(exam.expansions[k], tree).first for k in loads]
    known = [f for f in firsts if f is not None]
    return min(known) if known and len(known) == len(firsts) else None
