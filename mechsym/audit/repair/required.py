"""What every part of a formula would have to be for the whole to be right, all else as printed.

The derived value is pushed down from the root through sums, products, powers and roots. An edit of one part repairs
the formula when its new value meets the required one, so that no candidate formula is ever evaluated as a whole.
"""

import ast
import re
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache

import mpmath
import numpy as np

from mechsym.audit.judge.dimensions import ANGLE, NUMBER, kind_of_letter
from mechsym.audit.judge.question import Bench, Question, names, part_values, scratch, shaped, used_names
from mechsym.audit.read.algebra import DIGITS, Values, evaluate
from mechsym.audit.read.tree import (
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
    value_of,
    walk,
)
from mechsym.audit.repair.edits import Edit, Spot, is_exponent, is_product, places, scaled
from mechsym.audit.repair.lost import (
    Required,
    candidate_words,
    far_words,
    insertions,
    is_unit,
    quotient,
    short,
    simple,
    vocabulary,
)
from mechsym.audit.repair.rules import CIRCULAR, Words
from mechsym.audit.theory.record import dependencies, known, related
from mechsym.quantities import record

_INVERSE = {
    "exp": "log", "log": "exp", "asin": "sin", "acos": "cos", "atan": "tan", "sin": "asin", "cos": "acos",
    "tan": "atan",
}  # fmt: skip
_MOST = 4  # values that one part is asked for
_MET = 1e-5
_VALID = 0.6


def required(asked: Bench, tree: Node, memo: Mapping[Node, Values], both: bool = True) -> Required:
    """Required values of all parts that can be reached, the nearest to the print first.

    Parts under sums over parts and cotangents are not reached; `both`: an even power, |x|, a sine and a cosine ask for
    both values, rather than for the one with the printed sign or in the first quadrant.
    """
    wanted: dict[Path, tuple[Values, ...]] = {(): (asked.expected,)}
    waiting: list[tuple[Path, Node]] = [((), tree)]
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        while waiting:
            path, node = waiting.pop()
            for step, child in children(node):
                wishes = [w for above in wanted[path] for w in _below(asked, node, step, above, memo, both)]
                if wishes:
                    wanted[*path, step] = tuple(wishes[:_MOST])
                    waiting.append(((*path, step), child))
    return wanted


def _below(
    asked: Bench, node: Node, step: str, wish: Values, memo: Mapping[Node, Values], both: bool
) -> tuple[Values, ...]:
    if isinstance(node, ast.UnaryOp):
        return (-wish,)
    if isinstance(node, ast.Call):
        function = str(function_of(node))
        functions = asked.algebra.functions
        if function == "sqrt":
            return (np.where(_floats(wish) >= 0, wish * wish, _nan(asked)),)  # no root is negative
        if function not in _INVERSE:
            return (wish, -wish) if function == "abs" else ()
        value = functions[_INVERSE[function]](wish)
        # of a sine and a cosine either angle, the crank being in its first quadrant
        other = {"sin": lambda: asked.algebra.pi() - value, "cos": lambda: -value}.get(function)
        return (value, other()) if other and both else (value,)
    if not isinstance(node, ast.BinOp):
        return ()  # which piece counts is decided elsewhere
    operations = asked.algebra.operations
    divide, minus = operations[ast.Div], operations[ast.Sub]
    left, right = memo[node.left], memo[node.right]
    first = step == "left"
    if isinstance(node.op, ast.Add):
        return (minus(wish, right if first else left),)
    if isinstance(node.op, ast.Sub):
        return (operations[ast.Add](wish, right) if first else minus(left, wish),)
    if isinstance(node.op, ast.Mult):
        return (divide(wish, right if first else left),)
    if isinstance(node.op, ast.Div):
        return (operations[ast.Mult](wish, right) if first else divide(left, wish),)
    if not first:
        log = asked.algebra.functions["log"]
        return (divide(log(wish), log(left)),)
    # the root with the sign of what is printed, where that has a value; of an even power the other ones too, of one
    # sign at all states
    power, one = operations[ast.Pow], mpmath.mpf(1) if asked.algebra is DIGITS else 1.0
    root = power(np.abs(wish), divide(one, right))
    signs = np.where(np.isnan(_floats(memo[node])), 1.0, np.sign(_floats(left)))
    signed = root * signs
    consistent = power(signed, right)
    with np.errstate(all="ignore"):
        same = np.sign(_floats(consistent)) == np.sign(_floats(wish))
    others = [s for s in (-1, 1) if not np.all(signs == s)] if both and _is_even(node) else []
    return tuple(np.where(same, r, _nan(asked)) for r in (signed, *(s * root for s in others)))


def is_squared(nodes: Mapping[Path, Node], path: Path) -> bool:
    """Whether a part is raised to an even power."""
    return path[-1:] == ("left",) and _is_even(nodes[path[:-1]])


def _is_even(node: Node) -> bool:
    power = value_of(node.right) if is_operation(node, ast.Pow) else None
    return power is not None and power.numerator % 2 == 0


def _nan(asked: Bench) -> Values:
    return mpmath.nan if asked.algebra is DIGITS else np.nan


def _floats(values: Values) -> Values:
    return np.asarray(values, dtype=float)


def words_of(question: Question) -> Words:
    """What the theory of a question knows that a rule may bring in."""
    theory, formula = question.theory, question.formula
    needed = dependencies(theory, [question.quantity, *used_names(formula)])
    own = dependencies(theory, [question.quantity])
    own |= {k for k in theory.tape if own & {f"sin_{k}", f"cos_{k}"}}
    everything = dict.fromkeys([*formula.letters, *theory.letters, *theory.tape])
    printed = letters(formula.tree)
    return Words(
        alike=cache(lambda letter: _alike(question, letter)),
        kind=lambda letter: kind_of_letter(question, letter),
        is_pure=lambda letter: kind_of_letter(question, letter) == NUMBER,
        pure=[k for k, v in theory.letters.items() if v.unit == "-" and k in needed],
        turned=[k for k in everything if (k in own or k in printed) and kind_of_letter(question, k) == ANGLE],
        known=[*dict.fromkeys([*formula.letters, *(k for k in theory.letters if k in own)])],
    )


def _alike(question: Question, letter: str) -> list[str]:
    # of the same dimension, and such that the quantity or the formula has
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
    # of other results the one that is defined most shortly: F for F - m x''
    entries = {k: theory.tape[k] for k in related(theory, question.quantity) if k not in needed}
    sizes = {k: len([*walk(e)]) for k, e in entries.items() if isinstance(e, ast.expr)}
    alike += sorted((k for k in sizes if kind_of_letter(question, k) == kind), key=lambda k: (sizes[k], k))[:1]
    alike.sort(key=lambda k: re.sub(r"\d+$", "", k) != stem)
    # m_fuel for mdot_fuel: another dimension, and still taken for each other
    same = [k for k in names if "_" in letter and k[0] == letter[0] and k.partition("_")[2] == letter.partition("_")[2]]
    # phi for phid for phidd: dots that are lost, or one too many
    same += [k for k in free if k.rstrip("d") == letter.rstrip("d")]
    return [k for k in dict.fromkeys([*alike, *same]) if k != letter]


def matching_edits(question: Question, asked: Bench, tree: Node, listed: Sequence[Edit], insert: bool) -> list[Edit]:
    """Edits that make a part what it must be: those listed, and numbers or, with `insert`, what was left out."""
    memo = part_values(asked, tree)
    wishes = required(asked, tree, memo)
    nodes = {p.path: p.node for p in places(tree)}
    edits = list(listed)
    with np.errstate(all="ignore"), mpmath.workdps(asked.digits or 15):
        if insert:
            words = vocabulary(asked, candidate_words(question, tree), far_words(question))
            edits += insertions(asked, tree, wishes, memo, words)
        else:
            edits += numbers(asked, tree, wishes, memo)
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


def numbers(asked: Bench, tree: Node, wishes: Required, memo: Mapping[Node, Values]) -> Iterator[Edit]:
    """Numbers, factors and powers with which a part of the formula is what it is required to be."""
    for place in places(tree):
        for wish in wishes.get(place.path, ()):
            yield from _numbers_at(asked, place, wish, memo)


def _numbers_at(asked: Bench, place: Spot, wish: Values, memo: Mapping[Node, Values]) -> Iterator[Edit]:
    node, own = place.node, value_of(place.node)
    wanted, old = (np.asarray(v, dtype=float) for v in (wish, memo[node]))
    if isinstance(node, ast.Constant):
        right = short(wanted)
        if right is not None and _misread(Fraction(str(node.value)), right):
            yield Edit(kind="number", path=place.path, new=number(right, decimal=True))
    elif own is not None and is_operation(node, ast.Div) and (right := short(wanted)) is not None and right != own:
        yield Edit(kind="number", path=place.path, new=number(right))  # 3/2 for 2/3
    if is_product(place):
        # 2 f for 2 pi f, B^2/4 for pi B^2/4
        factors = np.asarray(quotient(asked, wish, memo[node]), dtype=float)
        by_power = ((power, simple(factors / np.pi**power)) for power in (0, 1, -1, 2, -2))
        power, factor = next(((p, f) for p, f in by_power if f is not None), (0, Fraction(1)))
        # a unit is not hidden in a number that stands there for another reason
        plain = own is None or not power and not is_unit(factor)
        if plain and (power and not is_unit(factor) or not power and factor != 1 and factor >= -1):
            new = scaled(negative(node) if factor < 0 else node, abs(factor))
            if power:
                more = name("pi") if abs(power) == 1 else binary(ast.Pow, name("pi"), number(2))
                new = binary(ast.Mult if power > 0 else ast.Div, new, more)
            kind = "unit" if is_unit(factor) else "number" if own is not None else "factor"
            yield Edit(kind="sign" if factor == -1 and not power else kind, path=place.path, new=new)
    if own is None and not isinstance(node, ast.UnaryOp) and not is_exponent(place):
        exponents = np.log(np.abs(wanted)) / np.log(np.abs(old))
        exponent = simple(np.broadcast_to(exponents, np.shape(wanted)))
        if exponent is not None and exponent != 1 and 0 < exponent <= 4 and exponent.denominator <= 4:
            yield Edit(
                kind="root" if exponent == Fraction(1, 2) else "power", path=place.path, new=_raised(node, exponent)
            )
            if is_operation(node, ast.Pow) and (own_power := value_of(node.right)) is not None:
                # of what is positive no power of a power
                yield Edit(kind="power", path=place.path, new=_raised(node.left, exponent * own_power))


def _raised(base: Node, exponent: Fraction) -> Node:
    if exponent == Fraction(1, 2):
        return call("sqrt", base)
    return base if exponent == 1 else binary(ast.Pow, base, number(exponent))


def _misread(printed: Fraction, right: Fraction) -> bool:
    # 0.651 for 0.615, 0.53 for 0.55, 0.6 for 0.06: digits exchanged, one of them wrong, the point moved
    if not printed or not 0.09 < abs(right / printed) < 11:
        return False  # that is a unit
    one, other = (f"{float(abs(v)):.6e}".partition("e")[0].replace(".", "").rstrip("0") for v in (printed, right))
    if one == other or sorted(one) == sorted(other):
        return True
    return len(one) == len(other) > 1 and sum(a != b for a, b in zip(one, other, strict=True)) == 1
