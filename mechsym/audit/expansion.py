"""Powers of lambda: which of them a formula has right, which it leaves out, and which are neither.

A truncation is pure when each coefficient of lambda^j is the derived one or 0, honest when no power below its order is
wrong and its error there is at most the derived term: never worse than leaving that power out.
"""

from collections.abc import Sequence
from dataclasses import field
from fractions import Fraction
from functools import cache, cached_property
from typing import Any

import mpmath
import numpy as np

from mechsym.audit.bench import Bench, value
from mechsym.audit.long_rods import ORDER_DIGITS, LongRods
from mechsym.audit.question import Question
from mechsym.audit.states import drawn
from mechsym.audit.tree import Node, digest
from mechsym.quantities import record

_SLACK = 1.8  # a sign slip has twice the derived term, products of truncations have little more than it
_ANGLES = 8
_STATES = 1
_NODES = 12
_NODE = Fraction(1, 10**6)
_TRUSTED = 10  # coefficients that the nodes give to eight digits
_SHIFT = 2  # powers of eps below zero that a quantity may start with


_STEPS = [_NODE * (i + 1) for i in range(_NODES)]  # what lambda is multiplied by


def _steps() -> list[Any]:
    return [mpmath.mpf(e.numerator) / e.denominator for e in _STEPS]


@cache
def _weights() -> Any:
    # inverse of the matrix of powers
    with mpmath.workdps(ORDER_DIGITS):
        return np.array((mpmath.matrix([[e**j for j in range(_NODES)] for e in _steps()]) ** -1).tolist())


@record
class Expansion:
    """States at a few tiny lambdas, from which the coefficients of powers follow."""

    load: str  #: The mass, inertia or force that is not zero, `all` for every one
    states: Sequence[LongRods]  #: One for each lambda
    known: dict[bytes, Any] = field(default_factory=dict)  #: Coefficients of formulas that were asked before

    @cached_property
    def benches(self) -> list[Bench]:
        """A few angles of a turn at two states, for each lambda."""
        return [states.bench(self.load) for states in self.states]

    @cached_property
    def derived(self) -> Any:
        """Coefficients of the derived quantity, shape (powers, states)."""
        return self._coefficients([b.expected for b in self.benches])

    def printed(self, tree: Node) -> Any:
        """Coefficients of a formula, shape (powers, states)."""
        said = digest(tree)
        if said not in self.known:
            self.known[said] = self._coefficients([value(b, tree) for b in self.benches])
        return self.known[said]

    def _coefficients(self, values: list[Any]) -> Any:
        with mpmath.workdps(ORDER_DIGITS):
            scale = [step**_SHIFT for step in _steps()]
            return _weights() @ np.array([v * e for v, e in zip(values, scale, strict=True)])


def expansions(question: Question, loads: Sequence[str]) -> dict[str, Expansion]:
    """One expansion for each load, at the same states."""
    values, zeros = _values(question), tuple(k for k in loads if k != "all")
    states = [LongRods(question=question, values=values, eps=eps, loads=zeros) for eps in _STEPS]
    return {k: Expansion(load=k, states=states) for k in loads}


def _values(question: Question) -> dict[str, list[Fraction]]:
    count = _ANGLES * _STATES
    few = drawn(question, _STATES, seed=4)
    values = {k: [v[i // _ANGLES] for i in range(count)] for k, v in few.items()}
    angle = question.theory.angle
    if angle and angle not in question.hold and not question.theory.letters[angle].domain:
        values[angle] = [Fraction(2 * (i % _ANGLES) + 1, _ANGLES) * Fraction(355, 113) for i in range(count)]
    return values


@record
class Powers:
    """How a formula stands in powers of lambda, for one load."""

    honest: bool
    wrong: tuple[int, ...] = ()  #: Powers, counted from the leading one, that are neither right nor left out
    missing: tuple[int, ...] = field(default=())  #: Powers that are left out
    first: int | None = None  #: The first power that differs, of lambda itself

    @property
    def pure(self) -> bool:
        """Whether every power is right or left out."""
        return self.honest and not self.wrong


def powers(expansion: Expansion, tree: Node) -> Powers:
    """Compare the coefficients of a formula with the derived ones."""
    derived, printed = expansion.derived, expansion.printed(tree)
    with mpmath.workdps(ORDER_DIGITS):
        if any(mpmath.isnan(c) for row in printed for c in row):
            return Powers(honest=False)
        sizes = [max(abs(c) for c in row) for row in derived]
        small = max(sizes) * mpmath.mpf(10) ** -8
        errors = [max(abs(a - b) for a, b in zip(*rows, strict=True)) for rows in zip(derived, printed, strict=True)]
        own = [max(abs(c) for c in row) for row in printed]
    leading = next(k for k, size in enumerate(sizes) if size > small)
    off = [k for k in range(_TRUSTED) if errors[k] > small]
    if not off or off[0] <= leading:
        return Powers(honest=False, first=off[0] - _SHIFT if off else None)
    # a derived series that ends before this power has no term to compare with: then its first one
    ended = all(size <= small for size in sizes[off[0] : _TRUSTED])
    measure = sizes[leading] if ended else sizes[off[0]]
    return Powers(
        first=off[0] - _SHIFT,
        honest=bool(errors[off[0]] <= _SLACK * measure),
        wrong=tuple(k - leading for k in off if own[k] > small),
        missing=tuple(k - leading for k in off if own[k] <= small),
    )


def changed_powers(expansion: Expansion, one: Node, other: Node) -> set[int]:
    """Powers, counted from the leading one, in which two formulas differ."""
    derived, first, second = expansion.derived, expansion.printed(one), expansion.printed(other)
    with mpmath.workdps(ORDER_DIGITS):
        sizes = [max(abs(c) for c in row) for row in derived]
        small = max(sizes) * mpmath.mpf(10) ** -8
        leading = next(k for k, size in enumerate(sizes) if size > small)
        gaps = [max(abs(a - b) for a, b in zip(first[k], second[k], strict=True)) for k in range(_TRUSTED)]
    return {k - leading for k, gap in enumerate(gaps) if not gap <= small}
