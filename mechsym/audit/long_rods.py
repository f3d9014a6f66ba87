"""The same states for every load: what no load changes is computed once, for the kinematics cost most."""

from collections.abc import Collection, Mapping
from dataclasses import field
from fractions import Fraction
from functools import cached_property
from typing import Any

import mpmath

from mechsym.audit.algebra import DIGITS, Layered
from mechsym.audit.bench import Bench, bench, used_names
from mechsym.audit.question import Question, digit_values, small_rods
from mechsym.audit.theory.record import complete, dependencies
from mechsym.audit.tree import letters
from mechsym.quantities import record

ORDER_DIGITS = 110


class _Changes(dict[str, bool]):
    """Whether a letter or name changes with the loads, found when it is first asked."""

    def __init__(self, question: Question, loads: Collection[str]) -> None:
        super().__init__()
        self.question, self.loads = question, set(loads)

    def __missing__(self, key: str) -> bool:
        own = self.question.formula.letters
        wanted = letters(own[key]) if key in own else (key,)
        found = self[key] = not self.loads.isdisjoint(dependencies(self.question.theory, wanted))
        return found


@record
class LongRods:
    """States with long rods, many digits, and benches that leave out all loads but one."""

    question: Question
    values: Mapping[str, list[Fraction]]
    eps: Fraction
    loads: tuple[str, ...]  #: Letters that are set to zero in turn
    memo: dict[bytes, Any] = field(default_factory=dict)  #: Values of expressions that no load changes

    @cached_property
    def digits(self) -> dict[str, Any]:
        """Values of the letters, all loads with their own."""
        with mpmath.workdps(ORDER_DIGITS):
            return digit_values(small_rods(self.question.theory, self.values, self.eps))

    @cached_property
    def changes(self) -> Mapping[str, bool]:
        """Whether a name changes with the loads."""
        return _Changes(self.question, self.loads)

    @cached_property
    def names(self) -> dict[str, Any]:
        """Values of everything that quantity and formula need and no load changes."""
        question = self.question
        needed = dependencies(question.theory, [question.quantity, *used_names(question.formula)])
        found = {k: v for k, v in self.digits.items() if k not in self.loads}
        with mpmath.workdps(ORDER_DIGITS):
            found["pi"] = DIGITS.pi()
            complete(question.theory, found, [k for k in needed if not self.changes[k]], DIGITS)
        return found

    def bench(self, load: str) -> Bench:
        """The bench of one load with the others left out; with every load for `all`."""
        some = next(iter(self.digits.values()))
        zero = some - some
        loads = {k: self.digits[k] if load in (k, "all") else zero for k in self.loads}
        memo = Layered(self.memo, self.changes)
        return bench(self.question, {**self.names, **loads}, DIGITS, ORDER_DIGITS, memo)
