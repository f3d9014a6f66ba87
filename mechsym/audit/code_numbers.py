"""Which quantity a formula of a program is, told by its numbers where neither name nor comment says it."""

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from mechsym.audit.bench import turn, value
from mechsym.audit.code import Assigned
from mechsym.audit.dimensions import is_consistent, rescaled
from mechsym.audit.question import Question
from mechsym.audit.reader import read
from mechsym.audit.theory.record import Theory, known
from mechsym.audit.tree import letters, name
from mechsym.errors import BadInput
from mechsym.quantities import record

# half a peak off is a lost factor of two, the largest slip that still tells what was meant
NEAR = 0.6


@record
class Likeness:
    """How near the numbers of a formula come to a quantity."""

    quantity: str
    away: float  #: Largest difference over a turn at the theory's data, by the quantity's peak; of either sign [-]


def candidates(found: Sequence[Assigned]) -> list[Assigned]:
    """The formulas that may be quantities: what is given back, else every variable's last one."""
    returned = [a for a in found if a.name == "return"]
    return returned or list({a.name: a for a in found}.values())


def nearest(text: str, theory: Theory, own: Mapping[str, str]) -> Likeness | None:
    """The quantity of a theory whose numbers are nearest to those of a formula, of the same dimension.

    Parameters
    ----------
    own : mapping of str to str
        Its letters, where they are not the theory's
    """
    try:
        formula = read(text, known(theory), own, theory.tape)
    except BadInput:
        return None
    if len(letters(formula.tree)) < 2:
        return None
    quantities = list(dict.fromkeys(_quantities(theory)))
    asked = turn(Question(formula=formula, theory=theory, quantity=quantities[0]))
    printed = _floats(value(asked, formula.tree))
    found = [Likeness(quantity=q, away=_away(printed, _floats(value(asked, name(q))))) for q in quantities]
    for like in sorted((f for f in found if f.away <= NEAR), key=lambda f: f.away):
        question = Question(formula=formula, theory=theory, quantity=like.quantity)
        if is_consistent(rescaled(question), formula.tree):
            return like
    return None


def _quantities(theory: Theory) -> Iterator[str]:
    # the theory's own names first: x_d is often one of them, too
    plain = [q for q in theory.results if not isinstance(theory.tape[q], tuple)]
    yield from plain
    if not theory.angle:
        return
    for q in plain:
        for derived in (f"d{q}_d{theory.angle}", f"d2{q}_d{theory.angle}2", f"{q}_d", f"{q}_dd"):
            try:
                entry = theory.tape.get(derived)
            except BadInput:
                continue
            if entry is not None:
                yield derived


def _floats(values: object) -> np.ndarray:
    return np.atleast_1d(np.asarray(values, dtype=float))


def _away(printed: np.ndarray, expected: np.ndarray) -> float:
    if not (np.all(np.isfinite(printed)) and np.all(np.isfinite(expected))):
        return float("inf")
    peak = float(np.max(np.abs(expected)))
    if peak == 0:
        return float("inf")
    return min(float(np.max(np.abs(sign * printed - expected))) for sign in (1, -1)) / peak
