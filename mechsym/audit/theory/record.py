"""The record of a theory, made from sympy expressions: what printed formulas are compared with."""

import ast
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import reduce
from typing import Any

import numpy as np
import sympy
from sympy import Expr

from mechsym.audit.algebra import Algebra, evaluate
from mechsym.audit.reader import CONSTANTS, read_expression
from mechsym.audit.tree import Node, binary, call, children, function_of, letters, name, number, walk
from mechsym.errors import BadInput

_FUNCTIONS = {
    sympy.sin: "sin", sympy.cos: "cos", sympy.tan: "tan", sympy.asin: "asin", sympy.acos: "acos", sympy.atan: "atan",
    sympy.exp: "exp", sympy.log: "log", sympy.Abs: "abs",
}  # fmt: skip


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


def tree_of(expression: Any) -> Node:
    """A sympy expression as a tree.

    Parameters
    ----------
    expression : sympy.Expr or number
        Sums, products, powers, elementary functions

    Returns
    -------
    tree : Node
        The same value

    Raises
    ------
    TypeError
        A node that formulas do not have
    """
    e = sympy.sympify(expression)
    if isinstance(e, sympy.Symbol) or e is sympy.pi:
        return name(str(e))
    if e.is_Rational:
        return number(Fraction(int(e.p), int(e.q)))
    if e.is_Add:
        return reduce(_plus, e.args[1:], tree_of(e.args[0]))
    if e.is_Mul:
        return reduce(lambda t, a: binary(ast.Mult, t, tree_of(a)), e.args[1:], tree_of(e.args[0]))
    if e.is_Pow:
        return _power(*e.args)
    if e.func in _FUNCTIONS:
        return call(_FUNCTIONS[e.func], tree_of(e.args[0]))
    raise TypeError(f"{e.func.__name__} has no place in a formula: {e}")


def _plus(left: Node, term: Expr) -> Node:
    if term.could_extract_minus_sign():
        return binary(ast.Sub, left, tree_of(-term))
    return binary(ast.Add, left, tree_of(term))


def _power(base: Expr, exponent: Expr) -> Node:
    if base is sympy.E:
        return call("exp", tree_of(exponent))
    if exponent == sympy.Rational(1, 2):
        return call("sqrt", tree_of(base))
    if exponent.could_extract_minus_sign():
        return binary(ast.Div, number(1), tree_of(base**-exponent))
    return binary(ast.Pow, tree_of(base), tree_of(exponent))


def tape_of(expressions: Mapping[str, Any]) -> dict[str, Node | tuple[Node, ...]]:
    """Named sympy expressions as trees.

    Parameters
    ----------
    expressions : mapping of str to Expr or tuple of Expr
        In the order of definition

    Returns
    -------
    tape : dict
        The same names
    """
    return {n: tuple(map(tree_of, e)) if isinstance(e, tuple) else tree_of(e) for n, e in expressions.items()}


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
    """Letters that a formula may use, the free ones first.

    Parameters
    ----------
    theory : Theory
        Letters and tape

    Returns
    -------
    names : list of str
        In order
    """
    return list(dict.fromkeys([*theory.letters, *theory.results, *theory.tape]))


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
