"""Constants that were rounded: 6.28 for 2 pi makes a formula approximate, not wrong."""

import ast
from decimal import Decimal
from fractions import Fraction
from typing import Any

import numpy as np

from mechsym.audit.bench import part_values, peak, value
from mechsym.audit.edits import places
from mechsym.audit.repair import Examination, search_bench
from mechsym.audit.required import required
from mechsym.audit.tree import Node, Path, number, replace

_SAME = 1e-9


def rounded_constant(exam: Examination, tree: Node) -> str:
    """Whether one number of the formula, given with all its digits, would make it exact.

    Returns
    -------
    note : str
        Which number is rounded; empty when there is none
    """
    asked = search_bench(exam, "exact")
    wishes = required(asked, tree, part_values(asked, tree))
    for place in places(tree):
        if isinstance(place.node, ast.Constant) and place.path in wishes:
            wish = _constant(wishes[place.path])
            if wish is not None and _rounds_to(wish, place.node.value) and _mended(exam, tree, place.path, wish):
                return f"the constant {place.node.value!r} is {wish:.9g} rounded"
    return ""


def _mended(exam: Examination, tree: Node, path: Path, wish: float) -> bool:
    asked = exam.judged.quick
    found = value(asked, replace(tree, path, number(Fraction(wish))))
    with np.errstate(all="ignore"):
        away = np.abs(found - asked.expected) / peak(asked.expected)
    return bool(np.all(away[np.isfinite(asked.expected)] < _SAME))


def _constant(values: Any) -> float | None:
    values = np.broadcast_to(values, np.shape(values) or (1,))
    middle = float(np.median(values))
    return middle if np.isfinite(middle) and middle and np.all(np.abs(values / middle - 1) < _SAME) else None


def _rounds_to(wish: float, printed: Any) -> bool:
    exponent = Decimal(str(printed)).as_tuple().exponent
    return isinstance(printed, float) and abs(wish - printed) <= 0.5 * 10.0 ** int(exponent)
