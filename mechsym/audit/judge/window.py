"""States over the whole domain that is stated: far from the data, at the ends of the domain, on both sides of branches.

A formula that agrees near its data may leave the quantity elsewhere: where a difference changes its sign, where a term
that is nothing at the data grows. Wide states are drawn on a logarithmic scale, those at an end by halving between one
where the quantity has a value and one where it has none, and of every |.|, root and case on both of its sides.
"""

import ast
from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction

import mpmath
import numpy as np

from mechsym.audit.judge.question import (
    Bench,
    Question,
    bench,
    digit_values,
    float_values,
    kept,
    part_values,
    used_names,
    value,
)
from mechsym.audit.read.algebra import DIGITS, FLOATS, Values
from mechsym.audit.read.tree import Node, argument_of, binary, function_of, is_operation, letters, value_of, walk
from mechsym.audit.theory.record import dependencies
from mechsym.audit.theory.tape import Harmonic, Ranged, Root
from mechsym.quantities import record

DECADES = 3  # that letters lie away from their data, either way
WINDOW_DIGITS = 120
_DRAWS, _NEAR = 600, 200  # machines that are drawn, and how many of them lie near the data
_WIDE, _ENDS, _SIDE = 14, 6, 2  # states that are compared: anywhere, at ends, on each side of a branch
_HALVINGS = 14
_MACHINE = 24  # angles at which a machine with rods must close
_LOST, _STEEP = 1e-12, 600.0  # share of a sum that is left, and exponents: beyond, the digits do not suffice
_SPREAD = 0.3  # decades, near the data
Floats = Mapping[str, np.ndarray]


def is_wide(question: Question) -> bool:
    """Whether states may lie far from the data: not where a root is found from a start, or a range is summed up."""
    tape = question.theory.tape
    names = dependencies(question.theory, [question.quantity, *used_names(question.formula)])
    return not any(isinstance(tape.get(k), (Root, Harmonic, Ranged)) for k in names)


@record
class Window:
    """Wide states, in floats and with many digits."""

    quick: Bench
    strict: Bench

    def told(self, tree: Node) -> np.ndarray:
        """At which states nothing of a formula is lost where two values nearly cancel [-]."""
        # of |x| and cases every value is meant, nought too
        lost = _cancels(self.quick, [] if has_cases(tree) else [tree])
        return ~lost


def wide_window(question: Question) -> Window:
    """The wide states of a question."""
    chosen = _chosen(question)
    exact = {k: [Fraction(float(x)) for x in v] for k, v in chosen.items()}
    exact |= {k: [Fraction(str(v))] * len(exact.get(k, [0])) for k, v in question.hold.items() if k in exact}
    with mpmath.workdps(WINDOW_DIGITS):
        strict = bench(question, digit_values(exact), DIGITS, WINDOW_DIGITS)
    return Window(quick=bench(question, float_values(exact), FLOATS), strict=strict)


def _cancels(asked: Bench, trees: Iterable[Node]) -> np.ndarray:
    lost = np.zeros(np.shape(asked.expected), dtype=bool)
    for tree in trees:
        parts = part_values(asked, tree)
        for node, total in parts.items():
            with np.errstate(all="ignore"):
                # a + |a| is to vanish: it is a largest value
                if is_operation(node, ast.Add, ast.Sub) and "abs" not in map(function_of, (node.left, node.right)):
                    size = np.maximum(np.abs(parts[node.left]), np.abs(parts[node.right]))
                    gone = np.abs(total) <= _LOST * size
                    lost |= np.any(gone, axis=0) if np.ndim(gone) > 1 else gone
                elif (exponent := argument_of(node, "exp")) is not None:
                    lost |= np.abs(parts[exponent]) > _STEEP
    return lost


def _chosen(question: Question) -> Floats:
    rng = np.random.default_rng(17)
    states = _drawn(question, rng)
    good, signs = _judged(question, states)
    usable = np.flatnonzero(good)
    picked = list(usable[usable >= _NEAR][:_WIDE])
    for sign in signs:
        for side in (sign > 0, sign < 0):
            there = np.flatnonzero(good & side)
            near, far = there[there < _NEAR], there[there >= _NEAR]
            picked += [*near[:_SIDE], *far[:_SIDE]]
    picked = list(dict.fromkeys(picked)) or list(usable[:_WIDE])
    ends = _ends(question, states, good)
    return {k: np.concatenate([v[picked], ends[k]]) for k, v in states.items()}


def _drawn(question: Question, rng: np.random.Generator) -> dict[str, np.ndarray]:
    theory, values = question.theory, {}
    reach = np.where(np.arange(_DRAWS) < _NEAR, _SPREAD, DECADES)
    for letter, about in theory.letters.items():
        free = rng.uniform(-1, 1, _DRAWS)
        if letter in question.hold:
            values[letter] = np.full(_DRAWS, float(question.hold[letter]))
        elif about.domain:
            low, high = about.domain
            share = (free + 1) / 2
            near_end = 10 ** -rng.uniform(1, 4, _DRAWS)
            which = rng.integers(0, 4, _DRAWS)
            share = np.where(which == 0, near_end, np.where(which == 1, 1 - near_end, share))
            values[letter] = low + (high - low) * share
        elif letter == theory.angle:
            values[letter] = 6.2 * free
        else:
            size = (about.value or 1.0) * 10 ** (reach * free)
            values[letter] = size if about.positive else size * rng.choice((-1.0, 1.0), _DRAWS)
    return values


def _judged(question: Question, states: Floats) -> tuple[np.ndarray, list[np.ndarray]]:
    # which states are good, and what decides a branch there
    asked = bench(question, states, FLOATS)
    count = len(next(iter(states.values())))
    tape = question.theory.tape
    names = dependencies(question.theory, [question.quantity, *used_names(question.formula)])
    entries = [e for k in names for e in _trees(tape.get(k))]
    lost = _cancels(asked, [e for e in entries if asked.base.keys() >= set(letters(e))])
    good = np.broadcast_to(kept(question, asked) & np.isfinite(asked.expected) & ~lost, (count,)).copy()
    with np.errstate(all="ignore"):
        for name in used_names(question.formula):
            part = np.asarray(asked.base.get(name, 0.0), dtype=float)
            good &= np.all(np.isfinite(part), axis=0) if part.ndim > 1 else np.isfinite(part)
    if question.theory.rods and question.theory.angle and question.theory.angle not in question.hold:
        good &= _turns(question, states)
    return good, [value(asked, tree) for tree in _switches(question)]


def _turns(question: Question, states: Floats) -> np.ndarray:
    # a rod that is longer than its crank lets it turn all the way
    count = len(next(iter(states.values())))
    angles = np.linspace(0, 2 * np.pi, _MACHINE, endpoint=False)
    turned = {k: np.repeat(v, _MACHINE) for k, v in states.items()} | {question.theory.angle: np.tile(angles, count)}
    valued = np.isfinite(np.broadcast_to(bench(question, turned, FLOATS).expected, (count * _MACHINE,)))
    return valued.reshape(count, _MACHINE).all(axis=1)


def _ends(question: Question, states: Floats, good: np.ndarray) -> dict[str, np.ndarray]:
    # just inside of the domain, between good states and others
    inside, outside = np.flatnonzero(good)[:_ENDS], np.flatnonzero(~good)[:_ENDS]
    count = min(len(inside), len(outside))
    here = {k: v[inside[:count]] for k, v in states.items()}
    there = {k: v[outside[:count]] for k, v in states.items()}
    if not count:
        return here
    for _ in range(_HALVINGS):
        middle = {k: _between(here[k], there[k]) for k in here}
        fine = _judged(question, middle)[0]
        here = {k: np.where(fine, middle[k], v) for k, v in here.items()}
        there = {k: np.where(fine, v, middle[k]) for k, v in there.items()}
    return here


def _between(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    with np.errstate(all="ignore"):
        return np.where(a * b > 0, np.sign(a) * np.sqrt(np.abs(a)) * np.sqrt(np.abs(b)), (a + b) / 2)


def _switches(question: Question) -> list[Node]:
    """Expressions whose sign decides a branch of the formula or of the quantity: inside |.|, of a case, of a squared
    radicand."""
    theory, formula = question.theory, question.formula
    names = dependencies(theory, [question.quantity, *used_names(formula)])
    entries = [e for k in names for e in _trees(theory.tape.get(k))]
    distinct = {ast.dump(s): s for tree in (formula.tree, *formula.letters.values(), *entries) for s in _of(tree)}
    known = {*theory.letters, *theory.tape, *formula.letters, "pi"}
    return [s for s in distinct.values() if letters(s) and known.issuperset(letters(s))][:12]


def _trees(entry: object) -> Iterable[Node]:
    return entry if isinstance(entry, tuple) else [entry] if isinstance(entry, ast.expr) else []


def _of(tree: Node) -> Iterator[Node]:
    for _, node in walk(tree):
        if (inside := argument_of(node, "abs")) is not None:
            yield inside
        elif isinstance(node, ast.Compare):
            yield binary(ast.Sub, node.left, node.comparators[0])
        elif (inside := argument_of(node, "sqrt", "atan")) is not None:
            yield from _factors(inside)
        elif is_operation(node, ast.Pow) and value_of(node.right) is None or is_operation(node, ast.Div):
            yield from _factors(node.right if is_operation(node, ast.Div) else node.left)


def _factors(node: Node) -> Iterator[Node]:
    if is_operation(node, ast.Mult, ast.Div):
        yield from (*_factors(node.left), *_factors(node.right))
    elif is_operation(node, ast.Pow):
        yield from _factors(node.left)
    elif value_of(node) is None:
        yield node


def branch(question: Question, asked: Bench, agrees: np.ndarray) -> Node | None:
    """What is positive wherever a formula agrees with its quantity and negative elsewhere; None where nothing is.

    agrees: shape (n,), at which states of the bench the two agree [-].
    """
    for tree in sorted(_switches(question), key=lambda t: sum(1 for _ in walk(t))):
        signs = np.sign(np.asarray(value(asked, tree), dtype=float))
        for sign in (1, -1):
            if np.all((signs == sign) == agrees):
                return tree if sign == 1 else ast.UnaryOp(op=ast.USub(), operand=tree)
    return None


def has_cases(tree: Node) -> bool:
    """Whether a formula itself holds |.|, the root of a square, or cases."""
    return any(
        function_of(n) == "abs"
        or isinstance(n, ast.IfExp)
        or (a := argument_of(n, "sqrt")) is not None
        and _is_square(a)
        for _, n in walk(tree)
    )


def _is_square(node: Node) -> bool:
    power = value_of(node.right) if is_operation(node, ast.Pow) else None
    return power is not None and power.numerator % 2 == 0


def is_same(printed: Values, expected: Values, angle: bool) -> np.ndarray:
    """At which states two values agree to half of the digits; nan agrees with nothing [-]."""
    with mpmath.workdps(WINDOW_DIGITS), np.errstate(all="ignore"):
        close = mpmath.mpf(10) ** -(WINDOW_DIGITS // 2)
        turn = 2 * mpmath.pi
        same = []
        for p, e in zip(printed, expected, strict=True):
            turns = turn * mpmath.nint((p - e) / turn) if angle and not mpmath.isnan(p) else 0
            same.append(mpmath.isnan(e) or bool(abs(p - turns - e) <= close * abs(e)))
        return np.array(same, dtype=bool)
