"""Slips that take several parts of a formula at once: runs of a sum or a product, letters throughout, complements.

They are tried when no slip of one place mends the formula, and count only where they make it exact.
"""

import ast
from collections.abc import Callable, Iterator, Sequence

from mechsym.audit.edits import Edit, Spot, is_exponent, is_product, is_term, places
from mechsym.audit.question import Question
from mechsym.audit.slips import CIRCULAR
from mechsym.audit.theory.record import dependencies
from mechsym.audit.tree import (
    Node,
    Path,
    binary,
    call,
    function_of,
    is_operation,
    letters,
    name,
    negative,
    number,
    substitute,
    value_of,
)
from mechsym.audit.units_of import kind_of_letter

_LONGEST = 7  # of a sum or a product of which every run is tried
_SIGN = {True: ast.Add, False: ast.Sub}
_FACTOR = {True: ast.Mult, False: ast.Div}

Siblings = Callable[[str], Sequence[str]]
Run = list[tuple[bool, Node]]  # terms or factors, each with whether it is added or multiplied


def wider_edits(question: Question, tree: Node, siblings: Siblings) -> list[Edit]:
    """Slips of several parts at once.

    Parameters
    ----------
    siblings : callable
        Takes a letter and gives the letters it may be mistaken for

    Returns
    -------
    edits : list of Edit
        Changes; some give the same function
    """
    found = [*_throughout(question, tree, siblings)]
    usable = _usable(question)
    for place in places(tree):
        found += [*_runs(place), *_complements(place), *_arguments(place, usable)]
    return found


def _throughout(question: Question, tree: Node, siblings: Siblings) -> Iterator[Edit]:
    # two letters for each other, or one for another wherever it stands
    used = [k for k in letters(tree) if k != "pi"]
    kinds = {k: kind_of_letter(question, k) for k in used}
    for i, one in enumerate(used):
        for other in used[i + 1 :]:
            if kinds[one] is not None and kinds[one] == kinds[other]:
                yield _renamed(tree, {one: other, other: one}, f"{one} and {other} are taken for each other")
        if sum(isinstance(p.node, ast.Name) and p.node.id == one for p in places(tree)) > 1:
            for other in siblings(one):
                yield _renamed(tree, {one: other}, f"{one} becomes {other} wherever it stands")


def _renamed(tree: Node, instead: dict[str, str], about: str) -> Edit:
    new = substitute(tree, lambda n: name(instead[n.id]) if isinstance(n, ast.Name) and n.id in instead else None)
    return Edit(kind="everywhere", path=(), new=new, about=about)


def _usable(question: Question) -> list[str]:
    needed = dependencies(question.theory, [question.quantity])
    return list(dict.fromkeys([*question.formula.letters, *(k for k in question.theory.letters if k in needed)]))


def _arguments(place: Spot, usable: list[str]) -> Iterator[Edit]:
    # sin(2*pi*phi) for sin(2*pi*phi/duration)
    if place.parent is None or function_of(place.parent) not in CIRCULAR:
        return
    for letter in usable:
        for operator in (ast.Mult, ast.Div):
            yield Edit(kind="argument", path=place.path, new=binary(operator, place.node, name(letter)))


def _complements(place: Spot) -> Iterator[Edit]:
    # x for 1 - x
    if value_of(place.node) is None and not isinstance(place.node, ast.UnaryOp) and not is_exponent(place):
        yield Edit(kind="put back", path=place.path, new=binary(ast.Sub, number(1), place.node))


def _runs(place: Spot) -> Iterator[Edit]:
    if is_operation(place.node, ast.Add, ast.Sub) and is_term(place):
        yield from _of_sum(place.path, _parts(place.node, ast.Add, ast.Sub))
    if is_operation(place.node, ast.Mult, ast.Div) and (is_product(place) or is_term(place)):
        yield from _of_product(place.path, _parts(place.node, ast.Mult, ast.Div))


def _parts(node: Node, more: type[ast.operator], less: type[ast.operator], first: bool = True) -> Run:
    """Terms of a sum or factors of a product, through brackets of the same kind."""
    if not is_operation(node, more, less):
        return [(first, node)]
    assert isinstance(node, ast.BinOp)
    last = first == isinstance(node.op, more)
    return [*_parts(node.left, more, less, first), *_parts(node.right, more, less, last)]


def _of_sum(path: Path, terms: Run) -> Iterator[Edit]:
    # sqrt(a) + b - c for sqrt(a + b - c); a - b - c for a - (b - c)
    for before, inside, after in _cuts(terms):
        plus = inside[0][0]
        whole = _joined([(sign == plus, term) for sign, term in inside], _SIGN)
        yield Edit(kind="root", path=path, new=_joined([*before, (plus, call("sqrt", whole)), *after], _SIGN))
        if before:
            turned = [inside[0], *((not sign, term) for sign, term in inside[1:])]
            yield Edit(kind="bracket", path=path, new=_joined([*before, *turned, *after], _SIGN))
        if len(inside) > 1 and not (before and after):
            square = binary(ast.Pow, whole, number(2))
            yield Edit(kind="power", path=path, new=_joined([*before, (plus, square), *after], _SIGN))


def _of_product(path: Path, factors: Run) -> Iterator[Edit]:
    # a*b/c for a/(b/c), a*sqrt(b*c), a*(1 - b*c)
    for before, inside, after in _cuts(factors):
        upright = [(above == inside[0][0], factor) for above, factor in inside]
        turned = [(not above, factor) for above, factor in inside]
        yield Edit(kind="inverted", path=path, new=_joined([*before, *turned, *after], _FACTOR))
        whole = _joined(upright, _FACTOR)
        for kind, new in (
            ("root", call("sqrt", whole)),
            ("power", binary(ast.Pow, whole, number(2))),
            ("put back", binary(ast.Sub, number(1), whole)),
        ):
            yield Edit(kind=kind, path=path, new=_joined([*before, (inside[0][0], new), *after], _FACTOR))


def _cuts(parts: Run) -> Iterator[tuple[Run, Run, Run]]:
    for start in range(len(parts) if len(parts) <= _LONGEST else 0):
        for end in range(start + 2, len(parts) + 1):
            yield parts[:start], parts[start:end], parts[end:]


def _joined(parts: Run, operators: dict[bool, type[ast.operator]]) -> Node:
    # what is added or multiplied first, then the rest; a product has one fraction bar
    first, rest = ([part for sign, part in parts if sign == plus] for plus in (True, False))
    if operators is _FACTOR:
        above = _chained(first, ast.Mult) if first else number(1)
        return binary(ast.Div, above, _chained(rest, ast.Mult)) if rest else above
    if not first:
        return negative(_chained(rest, ast.Add))
    tree = _chained(first, ast.Add)
    for part in rest:
        tree = binary(ast.Sub, tree, part)
    return tree


def _chained(parts: list[Node], operator: type[ast.operator]) -> Node:
    tree = parts[0]
    for part in parts[1:]:
        tree = binary(operator, tree, part)
    return tree
