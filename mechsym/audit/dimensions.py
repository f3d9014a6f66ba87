"""Dimensions without dimension algebra: a formula must rescale with mass, length, time as its quantity does."""

import random
from typing import Any

import numpy as np

from mechsym.audit.algebra import FLOATS
from mechsym.audit.bench import bench, value
from mechsym.audit.question import Question, float_values
from mechsym.audit.states import drawn
from mechsym.audit.tree import Node
from mechsym.quantities import dimension

_CLOSE = 1e-6
_POINTS = 8


def is_consistent(question: Question, tree: Node) -> bool:
    """Whether a formula has the dimension of the quantity.

    Parameters
    ----------
    question : Question
        Letters with units, and the quantity

    Returns
    -------
    answer : bool
        False when random scales of mass, length, time and temperature change it otherwise than the derived quantity
    """
    values = float_values(drawn(question, _POINTS, seed=2))
    before = bench(question, values, FLOATS)
    after = bench(question, _rescaled(question, values), FLOATS)
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
