"""Edits that make a part of the formula what it is required to be: candidates for a repair."""

import ast
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache, partial
from typing import Any

import mpmath
import numpy as np

from mechsym.audit.algebra import evaluate
from mechsym.audit.bench import Bench, names, part_values, scratch, shaped, used_names
from mechsym.audit.edits import Edit, Spot, is_exponent, is_product, places, scaled, without_double_signs
from mechsym.audit.insertion import candidate_words, is_unit, short, simple, vocabulary
from mechsym.audit.printer import to_python
from mechsym.audit.put_back import insertions
from mechsym.audit.question import Question
from mechsym.audit.required import Required, quotient, required
from mechsym.audit.slips import CIRCULAR, INVERSE, in_degrees, single_edits
from mechsym.audit.theory.record import dependencies, known
from mechsym.audit.tree import (
    Node,
    Path,
    binary,
    call,
    children,
    function_of,
    is_operation,
    letters,
    name,
    negative,
    number,
    replace,
    substitute,
    value_of,
)
from mechsym.audit.units_of import NUMBER, kind_of_letter
from mechsym.quantities import record

_MET = 1e-5
_VALID = 0.6
_DEGREES = ("times 180/pi", "times pi/180", "without the factor between degrees and radians")


def listed_edits(question: Question, tree: Node) -> list[Edit]:
    """Slips that are tried one by one.

    Returns
    -------
    edits : list of Edit
        Changes; some give the same function
    """
    siblings = cache(lambda letter: confusable(question, letter))
    return [*single_edits(tree, siblings), *_lost_exponents(question, tree), *_lost_ones(question, tree)]


def _lost_ones(question: Question, tree: Node) -> Iterator[Edit]:
    # r_c for r_c - 1: a pure number of the theory, one less or one more
    for place in places(tree):
        node = place.node
        if isinstance(node, ast.Name) and node.id != "pi" and kind_of_letter(question, node.id) == NUMBER:
            for operator in (ast.Sub, ast.Add):
                yield Edit(kind="number", path=place.path, new=binary(operator, node, number(1)))


def _lost_exponents(question: Question, tree: Node) -> Iterator[Edit]:
    # (V1/V2) for (V1/V2)**(gamma - 1): an exponent that is a pure number of the theory, or one less
    needed = dependencies(question.theory, [question.quantity, *used_names(question.formula)])
    free = [k for k, v in question.theory.letters.items() if v.unit == "-" and k in needed]
    less = [(n, o) for k in free for n, o in ((name(k), number(1)), (number(1), name(k)))]
    exponents: list[Node] = [name(k) for k in free] + [binary(ast.Sub, a, b) for a, b in less]
    for place in places(tree) if free else ():
        bare = isinstance(place.node, ast.Name) or is_operation(place.node, ast.Add, ast.Sub, ast.Div)
        if bare and not is_exponent(place) and not (place.parent and is_operation(place.parent, ast.Pow)):
            for exponent in exponents:
                yield Edit(kind="power", path=place.path, new=binary(ast.Pow, place.node, exponent))


def repeated_edits(tree: Node) -> list[Edit]:
    """One slip wherever the same part stands: an error that was carried through.

    Returns
    -------
    edits : list of Edit
        Sign or factor two of parts that are repeated
    """
    nodes = [p.node for p in places(tree) if children(p.node) and value_of(p.node) is None]
    texts = {node: ast.dump(node) for node in nodes}
    counts = Counter(texts.values())
    distinct = {text: node for node, text in texts.items() if counts[text] > 1}
    found = []
    for text, node in distinct.items():
        others = [f for kin in (CIRCULAR, INVERSE) if function_of(node) in kin for f in kin if f != function_of(node)]
        again = [call(other, node.args[0]) for other in others]  # type: ignore[attr-defined]
        for new in (negative(node), binary(ast.Mult, number(2), node), binary(ast.Div, node, number(2)), *again):
            changed = substitute(tree, partial(_instead, texts, text, new))
            about = f"{to_python(node)} becomes {to_python(new)} in {counts[text]} places"
            found.append(Edit(kind="everywhere", path=(), new=without_double_signs(changed), about=about))
    return [*found, *_degrees_everywhere(tree)]


def _degrees_everywhere(tree: Node) -> list[Edit]:
    # degrees for radians is no slip of one place: whoever counts in degrees does so throughout
    inside = [p.node.args[0] for p in places(tree) if isinstance(p.node, ast.Call) and function_of(p.node) in CIRCULAR]
    changes: dict[str, dict[Node, Node]] = {}
    for argument in inside if len(inside) > 1 else ():
        for new, told in zip(reversed([*in_degrees(argument)]), _DEGREES, strict=False):
            changes.setdefault(told, {})[argument] = new
    found = []
    for told, instead in changes.items():
        if len(instead) > 1:
            about = f"the arguments of {len(instead)} functions, {told}"
            found.append(Edit(kind="everywhere", path=(), new=substitute(tree, instead.get), about=about))
    return found


def _instead(texts: Mapping[Node, str], text: str, new: Node, node: Node) -> Node | None:
    return new if texts.get(node) == text else None


def confusable(question: Question, letter: str) -> list[str]:
    """Letters that one may be mistaken for: of the same dimension, and such that the quantity or the formula has."""
    stem, kind = re.sub(r"\d+$", "", letter), kind_of_letter(question, letter)
    if kind is None:
        return []
    theory = question.theory
    needed = dependencies(theory, [question.quantity, *used_names(question.formula)])
    needed |= {k for k in theory.tape if needed & {f"sin_{k}", f"cos_{k}"}}
    free = [k for k in theory.letters if k in needed]
    names = [k for k in known(theory) if k in theory.tape and k != question.quantity]
    derived = [k for k in names if k in needed and not _is_number(theory.tape[k])]
    alike = [
        k for k in dict.fromkeys([*question.formula.letters, *free, *derived]) if kind_of_letter(question, k) == kind
    ]
    # m_fuel for mdot_fuel: another dimension, and still taken for each other
    same = [k for k in names if "_" in letter and k[0] == letter[0] and k.partition("_")[2] == letter.partition("_")[2]]
    return [
        k for k in dict.fromkeys([*sorted(alike, key=lambda k: re.sub(r"\d+$", "", k) != stem), *same]) if k != letter
    ]


def _is_number(entry: object) -> bool:
    return isinstance(entry, ast.expr) and value_of(entry) is not None


def matching_edits(question: Question, asked: Bench, tree: Node, listed: Sequence[Edit], insert: bool) -> list[Edit]:
    """Edits after which a part of the formula is what it is required to be at every state.

    Parameters
    ----------
    listed : sequence of Edit
        Edits to try one by one
    insert : bool
        Whether to look for terms and factors that were left out, rather than for wrong numbers and signs
    """
    memo = part_values(asked, tree)
    wishes = required(asked, tree, memo)
    nodes = {p.path: p.node for p in places(tree)}
    edits = list(listed)
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        if insert:
            words = vocabulary(asked, candidate_words(question, tree))
            edits += insertions(asked, tree, wishes, memo, words)
        else:
            edits += _numbers(asked, tree, wishes, memo)
        known = names(asked, {n for edit in edits for n in letters(edit.new)})
        goals = {path: _goal(asked, wish, memo[nodes[path]]) for path, wish in wishes.items()}
        first = _first_state(asked, known)
        with scratch(asked):
            return [e for e in edits if _meets(asked, nodes, goals, known, first, e)]


@record
class _First:
    """The first state alone: with many digits it refutes most edits at a fraction of the cost."""

    names: Mapping[str, Any]
    memo: dict[bytes, Any]


def _first_state(asked: Bench, known: Mapping[str, Any]) -> _First | None:
    if not asked.digits:
        return None
    return _First(names={k: v[..., :1] if np.ndim(v) else v for k, v in known.items()}, memo={})


@record
class _Goal:
    """What a part has to be, at the states where that is known."""

    wish: Any
    valid: np.ndarray  #: shape (n,): Where it is known [-]
    within: np.ndarray  #: How near a new value has to come [SI]


def _goal(asked: Bench, wish: Any, old: Any) -> _Goal | None:
    # None where no edit counts: the part is right as it stands, or what it has to be is hardly known
    valid = ~np.isnan(np.asarray(wish, dtype=float))
    wrong = _away(old, wish)[valid]
    noise = 0.0 if asked.digits else 1e-9 * np.abs(wish)[valid]
    if len(wrong) < _VALID * len(valid) or not np.all(wrong > 10 * noise):
        return None
    return _Goal(wish=wish, valid=valid, within=np.maximum(_MET * wrong, noise))


def _meets(
    asked: Bench,
    nodes: dict[Path, Node],
    goals: Mapping[Path, _Goal | None],
    known: Mapping[str, Any],
    first: _First | None,
    edit: Edit,
) -> bool:
    path = edit.path
    while path not in goals:
        path = path[:-1]
    goal = goals[path]
    if goal is None:
        return False
    new = replace(nodes[path], edit.path[len(path) :], edit.new)
    if first is not None and goal.valid[0]:
        found = evaluate(new, first.names, asked.algebra, first.memo)
        if np.ndim(found) <= 1 and not np.all(_away(found, goal.wish[..., :1]) <= goal.within[0]):
            return False
    found = shaped(asked, evaluate(new, known, asked.algebra, asked.memo))
    return bool(np.all(_away(found, goal.wish)[goal.valid] <= goal.within))


def _away(values: Any, wish: Any) -> np.ndarray:
    # a part without a value is as far away as can be
    differences = np.asarray(np.abs(values - wish), dtype=float)
    return np.where(np.isnan(differences), np.inf, differences)


def _numbers(asked: Bench, tree: Node, wishes: Required, memo: dict[Node, Any]) -> Iterator[Edit]:
    for place in places(tree):
        if place.path not in wishes:
            continue
        if isinstance(place.node, ast.Constant):
            right = short(np.asarray(wishes[place.path], dtype=float))
            if right is not None and _misread(Fraction(str(place.node.value)), right):
                yield Edit(kind="number", path=place.path, new=number(right, decimal=True))
        if not is_product(place):
            continue
        factors = np.asarray(quotient(asked, wishes[place.path], memo[place.node]), dtype=float)
        factor = simple(factors)
        if factor is None:
            yield from _turns(place, factors)
        if factor is None or factor == 1:
            continue
        if factor == -1:
            yield Edit(kind="sign", path=place.path, new=negative(place.node))
        elif factor > 0:
            kind = "unit" if is_unit(factor) else "factor"
            if value_of(place.node) is not None:
                if kind == "unit":
                    continue  # a unit is not hidden in a number that stands there for another reason
                kind = "number"
            yield Edit(kind=kind, path=place.path, new=scaled(place.node, factor))


def _misread(printed: Fraction, right: Fraction) -> bool:
    # 0.651 for 0.615, 0.53 for 0.55, 0.6 for 0.06: digits exchanged, one of them wrong, the point moved
    if not printed or not 0.09 < abs(right / printed) < 11:
        return False  # that is a unit
    one, other = (f"{float(abs(v)):.6e}".partition("e")[0].replace(".", "").rstrip("0") for v in (printed, right))
    if one == other or sorted(one) == sorted(other):
        return True
    return len(one) == len(other) > 1 and sum(a != b for a, b in zip(one, other, strict=True)) == 1


def _turns(place: Spot, factors: np.ndarray) -> Iterator[Edit]:
    # 2 f for 2 pi f, B^2/4 for pi B^2/4
    for power in (1, -1, 2, -2):
        factor = simple(factors / np.pi**power)
        if factor is not None and not is_unit(factor) and value_of(place.node) is None:
            more = name("pi") if abs(power) == 1 else binary(ast.Pow, name("pi"), number(2))
            node = scaled(negative(place.node) if factor < 0 else place.node, abs(factor))
            operator = ast.Mult if power > 0 else ast.Div
            yield Edit(kind="factor", path=place.path, new=binary(operator, node, more))
