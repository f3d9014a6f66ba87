"""Edits that make a part of the formula what it is required to be: candidates for a repair."""

import ast
import re
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache

import mpmath
import numpy as np

from mechsym.audit.judge.dimensions import NUMBER, kind_of_letter
from mechsym.audit.judge.question import Bench, Question, names, part_values, scratch, shaped, used_names
from mechsym.audit.read.algebra import Values, evaluate
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.tree import (
    Node,
    Path,
    argument_of,
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
from mechsym.audit.repair.edits import Edit, Spot, is_exponent, is_product, places, scaled, without_double_signs
from mechsym.audit.repair.insertion import candidate_words, insertions, is_unit, short, simple, vocabulary
from mechsym.audit.repair.required import Required, is_squared, quotient, required
from mechsym.audit.repair.slips import CIRCULAR, INVERSE, in_degrees, single_edits
from mechsym.audit.theory.record import dependencies, known
from mechsym.quantities import record

_MET = 1e-5
_VALID = 0.6
_DEGREES = ("times 180/pi", "times pi/180", "without the factor between degrees and radians")


def listed_edits(question: Question, tree: Node) -> list[Edit]:
    """Slips that are tried one by one; some give the same function."""
    edits = [*single_edits(tree, cache(lambda letter: confusable(question, letter)))]
    # (V1/V2) for (V1/V2)**(gamma - 1): an exponent that is a pure number of the theory, or one less
    needed = dependencies(question.theory, [question.quantity, *used_names(question.formula)])
    free = [k for k, v in question.theory.letters.items() if v.unit == "-" and k in needed]
    less = [(n, o) for k in free for n, o in ((name(k), number(1)), (number(1), name(k)))]
    exponents: list[Node] = [name(k) for k in free] + [binary(ast.Sub, a, b) for a, b in less]
    for place in places(tree) if free else ():
        bare = isinstance(place.node, ast.Name) or is_operation(place.node, ast.Add, ast.Sub, ast.Div)
        if bare and not is_exponent(place) and not (place.parent and is_operation(place.parent, ast.Pow)):
            powers = [binary(ast.Pow, place.node, exponent) for exponent in exponents]
            edits += [Edit(kind="power", path=place.path, new=power) for power in powers]
    # r_c for r_c - 1: a pure number of the theory, one less or one more
    for place in places(tree):
        node = place.node
        if isinstance(node, ast.Name) and node.id != "pi" and kind_of_letter(question, node.id) == NUMBER:
            others = [binary(operator, node, number(1)) for operator in (ast.Sub, ast.Add)]
            edits += [Edit(kind="number", path=place.path, new=new) for new in others]
    return edits


def repeated_edits(tree: Node) -> list[Edit]:
    """Sign, factor two or function of parts that are repeated: an error that was carried through."""
    nodes = [p.node for p in places(tree) if children(p.node) and value_of(p.node) is None]
    texts = {node: ast.dump(node) for node in nodes}
    counts = Counter(texts.values())
    distinct = {text: node for node, text in texts.items() if counts[text] > 1}
    edits = []
    for text, node in distinct.items():
        own, argument = function_of(node), argument_of(node)
        others = [f for kin in (CIRCULAR, INVERSE) if own in kin for f in kin if f != own]
        again = [call(other, argument) for other in others if argument is not None]
        for new in (negative(node), binary(ast.Mult, number(2), node), binary(ast.Div, node, number(2)), *again):
            alike = {one: new for one, said in texts.items() if said == text}
            changed = substitute(tree, alike.get)
            about = f"{to_python(node)} becomes {to_python(new)} in {counts[text]} places"
            edits.append(Edit(kind="everywhere", path=(), new=without_double_signs(changed), about=about))
    # the stars of powers that became those of products
    starred = {p.node: power for p in places(tree) if (power := _powered(p.node)) is not None}
    if len(starred) > 1:
        about = f"{len(starred)} products become powers"
        edits.append(Edit(kind="everywhere", path=(), new=substitute(tree, starred.get), about=about))
    # degrees for radians is no slip of one place: whoever counts in degrees does so throughout
    inside = [a for p in places(tree) if (a := argument_of(p.node, *CIRCULAR)) is not None]
    changes: dict[str, dict[Node, Node]] = {}
    for argument in inside if len(inside) > 1 else ():
        for new, told in zip(reversed([*in_degrees(argument)]), _DEGREES, strict=False):
            changes.setdefault(told, {})[argument] = new
    for told, instead in changes.items():
        if len(instead) > 1:
            about = f"the arguments of {len(instead)} functions, {told}"
            edits.append(Edit(kind="everywhere", path=(), new=substitute(tree, instead.get), about=about))
    return edits


def _powered(node: Node) -> Node | None:
    # 3*a**2 for 3*a*2
    if not is_operation(node, ast.Mult) or value_of(node.right) is None or value_of(node.left) is not None:
        return None
    if is_operation(node.left, ast.Mult):
        return binary(ast.Mult, node.left.left, binary(ast.Pow, node.left.right, node.right))
    return binary(ast.Pow, node.left, node.right)


def confusable(question: Question, letter: str) -> list[str]:
    """Letters that one may be mistaken for: of the same dimension, and such that the quantity or the formula has."""
    stem, kind = re.sub(r"\d+$", "", letter), kind_of_letter(question, letter)
    if kind is None:
        return []
    theory = question.theory
    needed = dependencies(theory, [question.quantity, *used_names(question.formula)])
    needed |= {k for k in theory.tape if needed & {f"sin_{k}", f"cos_{k}"}}
    names = [k for k in known(theory) if k in theory.tape and k != question.quantity]
    derived = []
    for k in names:
        entry = theory.tape[k]
        if k in needed and not (isinstance(entry, ast.expr) and value_of(entry) is not None):
            derived.append(k)
    free = [k for k in theory.letters if k in needed]
    alike = [k for k in [*question.formula.letters, *free, *derived] if kind_of_letter(question, k) == kind]
    alike.sort(key=lambda k: re.sub(r"\d+$", "", k) != stem)
    # m_fuel for mdot_fuel: another dimension, and still taken for each other
    same = [k for k in names if "_" in letter and k[0] == letter[0] and k.partition("_")[2] == letter.partition("_")[2]]
    return [k for k in dict.fromkeys([*alike, *same]) if k != letter]


def matching_edits(question: Question, asked: Bench, tree: Node, listed: Sequence[Edit], insert: bool) -> list[Edit]:
    """Edits that make a part what it must be: those listed, and numbers or, with `insert`, what was left out."""
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
        # below an even power, where either sign will do, what is squared tells
        goals: dict[Path, tuple[Path, Sequence[_Goal]]] = {}
        within: set[Path] = set()
        for path, wanted in wishes.items():  # a part comes after the whole
            squared = is_squared(nodes, path)
            goals[path] = path, _goals(asked, wanted, memo[nodes[path]], squared)
            above = goals.get(path[:-1])
            # an angle is known by its sine only up to turns
            angled = path and (function_of(nodes[path[:-1]]) in CIRCULAR or path[:-1] in within)
            if angled and above:
                within.add(path)
                goals[path] = above
                continue
            if path and above and above[1] and above[1][0].squared and not squared:
                goals[path] = above
        few = {k: v[..., :1] if np.ndim(v) else v for k, v in known.items()} if asked.digits else {}
        first = _First(names=few, memo={}) if asked.digits else None
        with scratch(asked):
            return [e for e in edits if _meets(asked, nodes, goals, known, first, e)]


@record
class _First:
    """The first state alone: with many digits it refutes most edits at a fraction of the cost."""

    names: Mapping[str, Values]
    memo: dict[bytes, Values]


@record
class _Goal:
    """What a part has to be, at the states where that is known."""

    wish: Values
    valid: np.ndarray  #: shape (n,): Where it is known [-]
    within: np.ndarray  #: How near a new value has to come [SI]
    squared: bool  #: Whether its sign does not matter, at any state


def _goals(asked: Bench, wishes: Sequence[Values], old: Values, squared: bool) -> list[_Goal]:
    # none where no edit counts: the part is right as it stands, or what it has to be is hardly known
    goals = []
    for wish in wishes[:1] if squared else wishes:
        if squared:
            wish, old = np.abs(wish), np.abs(old)
        valid = ~np.isnan(np.asarray(wish, dtype=float))
        wrong = _away(old, wish)[valid]
        noise = 0.0 if asked.digits else 1e-9 * np.abs(wish)[valid]
        if len(wrong) >= _VALID * len(valid) and np.all(wrong > 10 * noise):
            goals.append(_Goal(wish=wish, valid=valid, within=np.maximum(_MET * wrong, noise), squared=squared))
    return goals


def _meets(
    asked: Bench,
    nodes: dict[Path, Node],
    goals: Mapping[Path, tuple[Path, Sequence[_Goal]]],
    known: Mapping[str, Values],
    first: _First | None,
    edit: Edit,
) -> bool:
    path = edit.path
    while path not in goals:
        path = path[:-1]
    path, open_goals = goals[path]
    if not open_goals:
        return False
    new = replace(nodes[path], edit.path[len(path) :], edit.new)
    if first is not None:
        result = evaluate(new, first.names, asked.algebra, first.memo)
        if np.ndim(result) <= 1:
            open_goals = [g for g in open_goals if not g.valid[0] or _is_met(result, g.wish[..., :1], g.within[0], g)]
            if not open_goals:
                return False
    result = shaped(asked, evaluate(new, known, asked.algebra, asked.memo))
    for goal in open_goals:
        if _is_met(result[goal.valid], goal.wish[goal.valid], goal.within, goal):
            return True
    return False


def _is_met(values: Values, wish: Values, within: Values, goal: _Goal) -> bool:
    return bool(np.all(_away(np.abs(values) if goal.squared else values, wish) <= within))


def _away(values: Values, wish: Values) -> np.ndarray:
    # a part without a value is as far away as can be
    differences = np.asarray(np.abs(values - wish), dtype=float)
    return np.where(np.isnan(differences), np.inf, differences)


def _numbers(asked: Bench, tree: Node, wishes: Required, memo: dict[Node, Values]) -> Iterator[Edit]:
    for place in places(tree):
        if place.path not in wishes:
            continue
        for wish in wishes[place.path]:
            yield from _numbers_at(asked, place, wish, memo)


def _numbers_at(asked: Bench, place: Spot, wish: Values, memo: dict[Node, Values]) -> Iterator[Edit]:
    if isinstance(place.node, ast.Constant):
        right = short(np.asarray(wish, dtype=float))
        if right is not None and _misread(Fraction(str(place.node.value)), right):
            yield Edit(kind="number", path=place.path, new=number(right, decimal=True))
    if is_product(place):
        factors = np.asarray(quotient(asked, wish, memo[place.node]), dtype=float)
        factor = simple(factors)
        if factor is None:
            # 2 f for 2 pi f, B^2/4 for pi B^2/4
            for power in (1, -1, 2, -2):
                turned = simple(factors / np.pi**power)
                if turned is not None and not is_unit(turned) and value_of(place.node) is None:
                    more = name("pi") if abs(power) == 1 else binary(ast.Pow, name("pi"), number(2))
                    node = scaled(negative(place.node) if turned < 0 else place.node, abs(turned))
                    sign = ast.Mult if power > 0 else ast.Div
                    yield Edit(kind="factor", path=place.path, new=binary(sign, node, more))
        if factor == -1:
            yield Edit(kind="sign", path=place.path, new=negative(place.node))
        elif factor is not None and factor > 0 and factor != 1:
            kind = "unit" if is_unit(factor) else "factor"
            if value_of(place.node) is not None:
                if kind == "unit":
                    return  # a unit is not hidden in a number that stands there for another reason
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
