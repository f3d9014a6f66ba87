"""The record of a theory, made from sympy expressions: what printed formulas are compared with."""

import ast
from collections.abc import Iterable, Mapping
from dataclasses import field, replace
from fractions import Fraction
from functools import partial
from typing import Any

import numpy as np

from mechsym.audit.algebra import Algebra, evaluate
from mechsym.audit.reader import CONSTANTS, read_expression
from mechsym.audit.theory.implicit import harmonic, root
from mechsym.audit.theory.tape import Entry, Harmonic, Root, TheoryTape, needed
from mechsym.audit.tree import Node, children, function_of, walk
from mechsym.errors import BadInput
from mechsym.quantities import dimension, record


@record
class Letter:
    """A letter with its unit, the value that its source gives it, and where it may lie."""

    unit: str  #: SI unit, `"-"` for a pure number
    value: float  #: Value in the source's data, or a plausible one where it prints none [unit]
    sign: str = (
        ""  #: `positive`, `any`, or by the unit: lengths, masses, pressures, temperatures and numbers are positive
    )
    domain: tuple[float, float] | None = None  #: Ends of the range, where it is known [unit]

    @property
    def positive(self) -> bool:
        """Whether it is never negative."""
        if self.domain:
            return self.domain[0] >= 0
        return self.sign == "positive" or (not self.sign and self.value >= 0 and _never_negative(self.unit))


def _never_negative(unit: str) -> bool:
    mass, length, time, kelvin = dimension(unit)
    if unit.startswith("rad"):
        return False
    return time == 0 or kelvin != 0 or (mass, length, time) == (1, -1, -2)


@record
class Theory:
    """Letters and a tape of derived expressions in them."""

    name: str  #: Name before the dot in `crosshead.inertia`
    letters: Mapping[str, Letter]
    #: Named expressions in letters and earlier names; a tuple has one value per part (per journal)
    tape: Mapping[str, Entry]
    results: tuple[str, ...]  #: Names on the tape that formulas may claim to be
    units: Mapping[str, str] = field(default_factory=dict)  #: Units of names on the tape, where known
    angle: str = ""  #: Letter that runs over a turn, empty when nothing turns
    rods: tuple[str, ...] = ()  #: Lengths that grow without limit when lambda goes to zero
    small: tuple[str, ...] = ()  #: Numbers that go to zero as lambda does
    #: What a source may take for granted: words to the letters that vanish then
    conditions: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    data: str = ""
    #: Random states that were drawn before, which questions of one theory share
    states: dict[tuple[object, ...], Mapping[str, list[Fraction]]] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def __post_init__(self) -> None:
        """Every name gets its slopes, rates and harmonics."""
        if not isinstance(self.tape, TheoryTape):
            object.__setattr__(self, "tape", TheoryTape(self.tape, self.letters, self.angle))


def complete(theory: Theory, names: dict[str, Any], wanted: Iterable[str], algebra: Algebra) -> None:
    """Add the values of those names on the tape that are wanted.

    Parameters
    ----------
    names : dict of str to value
        Values of the letters; names are added
    """
    for wish in wanted:
        if wish in names or wish not in theory.tape:
            continue
        entry = theory.tape[wish]
        if isinstance(entry, Harmonic):
            names[wish] = harmonic(entry, names, algebra, partial(_fill, theory, entry.of, algebra))
            continue
        complete(theory, names, needed(entry), algebra)
        if isinstance(entry, Root):
            names[wish] = root(entry, names, algebra)
            continue
        found = [evaluate(part, names, algebra) for part in (entry if isinstance(entry, tuple) else (entry,))]
        names[wish] = np.stack(np.broadcast_arrays(*found)) if isinstance(entry, tuple) else found[0]


def _fill(theory: Theory, wish: str, algebra: Algebra, names: dict[str, Any]) -> None:
    complete(theory, names, [wish], algebra)


def dependencies(theory: Theory, wanted: Iterable[str]) -> set[str]:
    """Letters and names that the wanted ones are made of, themselves included."""
    found, waiting = set(), list(wanted)
    while waiting:
        wish = waiting.pop()
        if wish in found:
            continue
        found.add(wish)
        if wish in theory.tape:
            waiting += needed(theory.tape[wish])
    return found


def parts(theory: Theory, tree: Node) -> bool:
    """Whether an expression has one value per part because a letter was not summed.

    Returns
    -------
    answer : bool
        True when a letter with parts stands outside every sum()
    """
    if isinstance(tree, ast.Name):
        return isinstance(theory.tape.get(tree.id), tuple)
    return function_of(tree) != "sum" and any(parts(theory, child) for _, child in children(tree))


def check_sums(theory: Theory, tree: Node) -> None:
    """Refuse a letter with parts outside sum(), and a sum() without one."""
    letters_with_parts = [k for k, entry in theory.tape.items() if isinstance(entry, tuple)]
    hint = f"letters of {theory.name} with one value per part: {', '.join(letters_with_parts) or 'none'}"
    if parts(theory, tree):
        raise BadInput(f"a letter that has one value per part stands outside sum(); {hint}")
    for _, node in walk(tree):
        if function_of(node) == "sum" and not parts(theory, dict(children(node))["argument"]):
            raise BadInput(f"sum() is over nothing that has parts; {hint}")


def known(theory: Theory) -> list[str]:
    """Letters that a formula may use: free letters, results, and names that have a unit."""
    named = [k for k in theory.tape if k in theory.units]
    return list(dict.fromkeys([*theory.letters, *theory.results, *named]))


def need_result(theory: Theory, quantity: str) -> None:
    """Refuse a quantity that the theory does not derive."""
    if quantity not in theory.tape:
        raise BadInput(f"{theory.name} has no quantity {quantity!r}; it has {', '.join(theory.results)}")


def extended(
    theory: Theory, new_name: str, more_letters: Mapping[str, Letter], expressions: Mapping[str, tuple[str, str]]
) -> Theory:
    """A theory with further letters and expressions.

    Parameters
    ----------
    expressions : mapping of str to (str, str)
        Name to expression in letters and names, and its unit; in the order of definition
    """
    letters_now = {**theory.letters, **more_letters}
    tape = dict(theory.tape)
    for new, (text, _) in expressions.items():
        tape[new] = read_expression(text, [*letters_now, *tape, *CONSTANTS])[0]
    return replace(
        theory,
        name=new_name,
        letters=letters_now,
        tape=tape,
        results=(*theory.results, *expressions),
        units={**theory.units, **{k: unit for k, (_, unit) in expressions.items()}},
    )
