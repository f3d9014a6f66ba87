"""Dimensions without dimension algebra: a formula must rescale with mass, length, time as its quantity does."""

import random
from typing import Any

import numpy as np

from mechsym.audit.algebra import FLOATS
from mechsym.audit.bench import Bench, bench, value
from mechsym.audit.question import Question, float_values
from mechsym.audit.states import drawn
from mechsym.audit.tree import Node
from mechsym.quantities import dimension, record

_CLOSE = 1e-6
_POINTS = 8


@record
class Rescaled:
    """The same states before and after random scales of mass, length, time and temperature."""

    before: Bench
    after: Bench


def rescaled(question: Question) -> Rescaled:
    """States at which dimensions are compared."""
    values = float_values(drawn(question, _POINTS, seed=2))
    return Rescaled(before=bench(question, values, FLOATS), after=bench(question, _rescaled(question, values), FLOATS))


def is_consistent(scales: Rescaled, tree: Node) -> bool:
    """Whether a formula has the dimension of the quantity.

    Returns
    -------
    answer : bool
        False when random scales change it otherwise than the derived quantity
    """
    before, after = scales.before, scales.after
    with np.errstate(all="ignore"):
        ratio = value(after, tree) / value(before, tree)
        wanted = after.expected / before.expected
        usable = np.isfinite(wanted) & (np.abs(wanted) > 0)
        return bool(np.all(np.abs(ratio / wanted - 1)[usable] < _CLOSE))


def _rescaled(question: Question, values: dict[str, Any]) -> dict[str, Any]:
    generator = random.Random(11)
    scales = [generator.uniform(1.1, 1.9) for _ in range(4)]

    def factor(unit: str) -> float:
        return float(np.prod([s**e for s, e in zip(scales, dimension(unit), strict=True)]))

    return {k: v * factor(question.theory.letters[k].unit) for k, v in values.items()}
