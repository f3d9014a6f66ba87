"""The record of a theory, made from sympy expressions: what printed formulas are compared with."""

import ast
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from mechsym.audit.algebra import Algebra, evaluate
from mechsym.audit.reader import CONSTANTS, read_expression
from mechsym.audit.tree import Node, children, function_of, letters, walk
from mechsym.errors import BadInput


@dataclass(frozen=True, kw_only=True)
class Letter:
    """A letter with its unit and the value that its source gives it.

    Parameters
    ----------
    unit : str
        SI unit, `"-"` for a pure number
    value : float
        Value in the source's data, or a plausible one where it prints none
    """

    unit: str
    value: float


@dataclass(frozen=True, kw_only=True)
class Theory:
    """Letters and a tape of derived expressions in them.

    Parameters
    ----------
    name : str
        Name before the dot in `crosshead.inertia`
    letters : mapping of str to Letter
        What may be chosen freely
    tape : mapping of str to Node or tuple of Node
        Named expressions in letters and earlier names; a tuple has one value per part (per journal)
    results : tuple of str
        Names on the tape that formulas may claim to be
    units : mapping of str to str
        Units of names on the tape, where known
    angle : str
        Letter that runs over a turn, empty when nothing turns
    rods : tuple of str
        Lengths that grow without limit when lambda goes to zero
    data : str
        Where the values come from
    """

    name: str
    letters: Mapping[str, Letter]
    tape: Mapping[str, Node | tuple[Node, ...]]
    results: tuple[str, ...]
    units: Mapping[str, str] = field(default_factory=dict)
    angle: str = ""
    rods: tuple[str, ...] = ()
    data: str = ""


def complete(theory: Theory, names: dict[str, Any], wanted: Iterable[str], algebra: Algebra) -> None:
    """Add the values of those names on the tape that are wanted.

    Parameters
    ----------
    theory : Theory
        Letters and tape
    names : dict of str to value
        Values of the letters; names are added
    wanted : iterable of str
        Names that formulas use
    algebra : Algebra
        Number system
    """
    for wish in wanted:
        entry = theory.tape.get(wish, ())
        if wish in names or not entry:
            continue
        parts = entry if isinstance(entry, tuple) else (entry,)
        for part in parts:
            complete(theory, names, letters(part), algebra)
        found = [evaluate(part, names, algebra) for part in parts]
        names[wish] = np.stack(np.broadcast_arrays(*found)) if isinstance(entry, tuple) else found[0]


def dependencies(theory: Theory, wanted: Iterable[str]) -> set[str]:
    """Letters and names that the wanted ones are made of, themselves included.

    Parameters
    ----------
    theory : Theory
        Letters and tape
    wanted : iterable of str
        Names

    Returns
    -------
    names : set of str
        Down to the free letters
    """
    found, waiting = set(), list(wanted)
    while waiting:
        wish = waiting.pop()
        if wish in found:
            continue
        found.add(wish)
        entry = theory.tape.get(wish, ())
        for part in entry if isinstance(entry, tuple) else (entry,):
            waiting += letters(part)
    return found


def parts(theory: Theory, tree: Node) -> bool:
    """Whether an expression has one value per part because a letter was not summed.

    Parameters
    ----------
    theory : Theory
        Letters and tape
    tree : Node
        Expression

    Returns
    -------
    answer : bool
        True when a letter with parts stands outside every sum()
    """
    if isinstance(tree, ast.Name):
        return isinstance(theory.tape.get(tree.id), tuple)
    return function_of(tree) != "sum" and any(parts(theory, child) for _, child in children(tree))


def check_sums(theory: Theory, tree: Node) -> None:
    """Refuse a letter with parts outside sum(), and a sum() without one.

    Parameters
    ----------
    theory : Theory
        Letters and tape
    tree : Node
        Expression

    Raises
    ------
    BadInput
        Says which letters have parts
    """
    letters_with_parts = [k for k, entry in theory.tape.items() if isinstance(entry, tuple)]
    hint = f"letters of {theory.name} with one value per part: {', '.join(letters_with_parts) or 'none'}"
    if parts(theory, tree):
        raise BadInput(f"a letter that has one value per part stands outside sum(); {hint}")
    for _, node in walk(tree):
        if function_of(node) == "sum" and not parts(theory, dict(children(node))["argument"]):
            raise BadInput(f"sum() is over nothing that has parts; {hint}")


def known(theory: Theory) -> list[str]:
    """Letters that a formula may use: free letters, results, and names that have a unit.

    Parameters
    ----------
    theory : Theory
        Letters and tape

    Returns
    -------
    names : list of str
        In order
    """
    named = [k for k in theory.tape if k in theory.units]
    return list(dict.fromkeys([*theory.letters, *theory.results, *named]))


def need_result(theory: Theory, quantity: str) -> None:
    """Refuse a quantity that the theory does not derive.

    Parameters
    ----------
    theory : Theory
        Letters and tape
    quantity : str
        Name after the dot

    Raises
    ------
    BadInput
        Lists what there is
    """
    if quantity not in theory.tape:
        raise BadInput(f"{theory.name} has no quantity {quantity!r}; it has {', '.join(theory.results)}")


def extended(
    theory: Theory, new_name: str, more_letters: Mapping[str, Letter], expressions: Mapping[str, tuple[str, str]]
) -> Theory:
    """A theory with further letters and expressions.

    Parameters
    ----------
    theory : Theory
        What there is
    new_name : str
        Name of the result
    more_letters : mapping of str to Letter
        Letters to add
    expressions : mapping of str to (str, str)
        Name to expression in letters and names, and its unit; in the order of definition

    Returns
    -------
    theory : Theory
        Both together
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
