r"""What was left out: terms and factors found from the values that are missing.

A missing factor or term is sought as a product of powers of the letters, functions and brackets of the formula and of
the derivation, :math:`c \prod v_i^{a_i}`: its logarithm is linear in the exponents, so least squares over the states
give them all at once, and only whole or half exponents with a simple number c are believed.
"""

import ast
from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction

import mpmath
import numpy as np

from mechsym.audit.judge.dimensions import NUMBER, kind_of_letter
from mechsym.audit.judge.question import Bench, Question, used_names, value
from mechsym.audit.read.algebra import Values
from mechsym.audit.read.tree import (
    Node,
    Path,
    binary,
    call,
    children,
    is_operation,
    letters,
    name,
    negative,
    number,
    value_of,
    walk,
)
from mechsym.audit.repair.edits import Edit, Spot, chained, factors, is_exponent, is_product, is_term, places, scaled
from mechsym.audit.theory.record import dependencies, related
from mechsym.quantities import record

MAX_WORDS = 26
MAX_FACTORS = 6
MAX_EXPONENT = 4
MAX_INTEGER = 24
UNITS = (1000, 60, 3600, 360, 10**6, 100, 180)
_CLOSE = 1e-5
_SAME = 1e-7


@record
class Vocabulary:
    """Words of which missing factors are made, with their values at the states of a bench."""

    words: tuple[Node, ...]
    signs: np.ndarray  #: shape (k, n): Signs of their values [-]
    logs: np.ndarray  #: shape (k, n): Logarithms of their absolute values [-]
    basis: tuple[int, ...]  #: Words that are no products of powers of earlier ones
    near: int  #: How many of them are what the quantity is made of


Required = Mapping[Path, Sequence[Values]]  # what each part would have to be, the nearest to the print first
Words = list[tuple[Node, Fraction]]  # with their exponents
Product = tuple[Fraction, Words]


def quotient(asked: Bench, above: Values, below: Values) -> Values:
    """Quotient of values state by state, nan where it has none."""
    return asked.algebra.operations[ast.Div](above, below)


def candidate_words(question: Question, tree: Node) -> list[Node]:
    """Words that a missing factor may be made of, the formula's own first."""
    theory, own = question.theory, question.formula.letters
    needed = dependencies(theory, [question.quantity])
    angles = [theory.angle, *(k for k in theory.tape if f"cos_{k}" in theory.tape)]
    printed = [n for _, n in walk(tree) if isinstance(n, (ast.Name, ast.Call)) or is_operation(n, ast.Add, ast.Sub)]
    # of H**(1 - n), H**n may have been lost
    powers = [n for _, n in walk(tree) if is_operation(n, ast.Pow) and value_of(n.right) is None]
    printed += [binary(ast.Pow, n.left, name(k)) for n in powers for k in letters(n.right)]
    turning = [a for a in angles if needed & {a, f"sin_{a}", f"cos_{a}"} and a not in own]
    multiples = [m for a in turning for m in (name(a), binary(ast.Mult, number(2), name(a)))]
    circular = [call(f, m) for m in multiples for f in ("sin", "cos")]
    authors = [name(k) for k, value in own.items() if needed & dependencies(theory, letters(value))]
    # what the formula's own names are made of may have been lost, too: v for v/omega
    allowed = needed | dependencies(theory, used_names(question.formula))
    free = [name(k) for k in theory.letters if k in allowed and k not in own and k not in question.hold]
    results = [name(k) for k in theory.results if k in needed and k != question.quantity and k not in own]
    near = dict.fromkeys([*letters(tree), *own, *(k for k in theory.letters if k in needed)])
    pure = [k for k in near if k != "pi" and kind_of_letter(question, k) == NUMBER]
    ones = [binary(operator, number(1), name(k)) for k in pure for operator in (ast.Add, ast.Sub)]
    words = [*sorted([*printed, *authors, *free, *circular], key=_complexity), *results, *ones]
    distinct: dict[str, Node] = {}
    for word in words:
        if value_of(word) is None and not (isinstance(word, ast.Name) and word.id in angles):
            distinct.setdefault(ast.dump(word), word)
    return list(distinct.values())


def far_words(question: Question) -> list[Node]:
    """Results that the quantity is not made of, and that are made of what it is made of."""
    near = {*dependencies(question.theory, [question.quantity]), *question.formula.letters}
    return [name(k) for k in related(question.theory, question.quantity) if k not in near]


def _complexity(node: Node) -> int:
    # letters before sin(phi), sin(phi) before sin(2*phi), brackets last
    if isinstance(node, ast.Call):
        return 1 if isinstance(node.args[0], ast.Name) else 2
    return 3 if isinstance(node, ast.BinOp) else 0


def vocabulary(asked: Bench, words: Sequence[Node], far: Sequence[Node] = ()) -> Vocabulary:
    """The words that have values at the states of a bench, and other results, of which nothing but one is made."""
    usable: list[Node] = []
    basis: list[int] = []
    signs, logs = [], []
    independent = [np.ones(len(asked.expected))]
    near = 0
    for word in (*words, *far):
        sign, log = logarithm(asked, value(asked, word))
        if not np.all(np.isfinite(log)) or np.ptp(log) < 1e-9:
            continue
        near += word not in far
        if len(basis) < min(MAX_WORDS, len(log) - 4) and word not in far and not _depends(log, independent):
            basis.append(len(usable))
            independent.append(log)
        usable.append(word)
        signs.append(sign)
        logs.append(log)
    shape = (len(usable), len(asked.expected))
    return Vocabulary(
        words=tuple(usable),
        signs=np.array(signs).reshape(shape),
        logs=np.array(logs).reshape(shape),
        basis=tuple(basis),
        near=near,
    )


def _depends(log: np.ndarray, logs: list[np.ndarray]) -> bool:
    matrix = np.array(logs).T
    solution, *_ = np.linalg.lstsq(matrix, log, rcond=None)
    return bool(np.max(np.abs(matrix @ solution - log)) < 1e-7 * max(1.0, np.max(np.abs(log))))


def logarithm(asked: Bench, values: Values) -> tuple[np.ndarray, np.ndarray]:
    """Signs of values and logarithms of their sizes, in floats; infinite or nan where there is none [-]."""
    with np.errstate(all="ignore"):
        if not asked.digits:
            return np.sign(values), np.log(np.abs(values))
        with mpmath.workdps(asked.digits):
            logs = [float(mpmath.log(abs(v))) if v and not mpmath.isnan(v) else np.nan for v in values]
            return np.array([float(mpmath.sign(v)) for v in values]), np.array(logs)


def product(asked: Bench, words: Vocabulary, values: Values) -> Product | None:
    """Missing values as a simple number times a power of one word, or else a product of powers of words."""
    signs, logs = logarithm(asked, values)
    if not np.all(np.isfinite(logs)):
        return None
    near = range(words.near)
    far = range(words.near, len(words.words))
    return _single(words, near, signs, logs) or _several(words, signs, logs) or _single(words, far, signs, logs)


def _single(words: Vocabulary, chosen: range, signs: np.ndarray, logs: np.ndarray) -> Product | None:
    for exponent in (1, -1, 2, -2) if chosen else ():
        rest = logs - exponent * words.logs[chosen.start : chosen.stop]
        for k in chosen.start + np.flatnonzero(np.ptp(rest, axis=1) < _CLOSE):
            constant = _constant(words, [int(k)], np.array([float(exponent)]), signs, logs)
            if constant is not None:
                return constant, [(words.words[k], Fraction(exponent))]
    return None


def _several(words: Vocabulary, signs: np.ndarray, logs: np.ndarray) -> Product | None:
    basis = list(words.basis)
    matrix = np.column_stack([np.ones(len(logs)), words.logs[basis].T])
    solution, *_ = np.linalg.lstsq(matrix, logs, rcond=None)
    exponents = np.round(2 * solution[1:]) / 2
    if np.any(np.abs(exponents - solution[1:]) > 1e-3) or np.max(np.abs(exponents), initial=0.0) > MAX_EXPONENT:
        return None
    used = [(words.words[k], Fraction(e)) for k, e in zip(basis, exponents, strict=True) if e]
    if len(used) > MAX_FACTORS:
        return None
    constant = _constant(words, basis, exponents, signs, logs)
    return None if constant is None else (constant, used)


def _constant(
    words: Vocabulary, chosen: list[int], exponents: np.ndarray, signs: np.ndarray, logs: np.ndarray
) -> Fraction | None:
    # what is left when the powers of the chosen words are taken out
    odd = np.where(exponents[:, None] % 2 == 1, words.signs[chosen], 1.0)
    return simple(signs * np.prod(odd, axis=0) * np.exp(logs - exponents @ words.logs[chosen]))


def simple(constants: np.ndarray) -> Fraction | None:
    """The quotient of integers up to 24, or of such by a unit (60, 1000, ...), that all values are [-]."""
    if not len(constants) or not np.all(np.isfinite(constants)):
        return None
    middle = float(np.median(constants))
    if not middle or np.max(np.abs(constants / middle - 1)) > _CLOSE:
        return None
    for unit in (Fraction(1), *map(Fraction, UNITS), *(Fraction(1, u) for u in UNITS)):
        ratio = Fraction(middle / float(unit)).limit_denominator(MAX_INTEGER)
        if ratio and abs(ratio.numerator) <= MAX_INTEGER and abs(float(ratio * unit) / middle - 1) < _CLOSE:
            return ratio * unit
    return None


def short(values: np.ndarray) -> Fraction | None:
    """The number of at most four digits that all values are, if there is one [-]."""
    middle = float(np.median(values)) if np.size(values) else np.nan
    if not np.isfinite(middle) or not middle or np.max(np.abs(values / middle - 1)) > _CLOSE:
        return None
    rounded = Fraction(f"{middle:.4g}")
    return rounded if abs(float(rounded) / middle - 1) < _SAME else None


def is_unit(factor: Fraction) -> bool:
    """Whether a factor (60, 1/1000) is more likely a change of unit than a slip of the pen."""
    return max(abs(factor.numerator), factor.denominator) > MAX_INTEGER


def product_tree(factor: Fraction, words: Sequence[tuple[Node, Fraction]]) -> Node:
    """A product of powers as an expression with one fraction bar, roots as sqrt."""
    above = [_power(w, e) for w, e in words if e > 0]
    below = [_power(w, -e) for w, e in words if e < 0]
    if factor.numerator != 1 or not above:
        above.insert(0, number(factor.numerator))
    if factor.denominator != 1:
        below.insert(0, number(factor.denominator))
    top = chained(ast.Mult, above)
    return binary(ast.Div, top, chained(ast.Mult, below)) if below else top


def _power(word: Node, exponent: Fraction) -> Node:
    if exponent == 1:
        return word
    if exponent == Fraction(1, 2):
        return call("sqrt", word)
    return binary(ast.Pow, word, number(exponent))


def insertions(
    asked: Bench,
    tree: Node,
    wishes: Required,
    memo: Mapping[Node, Values],
    words: Vocabulary,
    solve: np.ndarray | None = None,
) -> Iterator[Edit]:
    """Terms and factors, made of words, with which a part of the formula is what it is required to be.

    solve: shape (words + 1, states), exponents of words from logarithms [-]; with it all parts are looked at together,
    and only what a few words of the basis make is believed.
    """
    # what is put back must not be more than what stands there, or any formula could be mended
    most = sum(not children(p.node) for p in places(tree))
    nodes = {p.path: p.node for p in places(tree)}
    gaps: list[tuple[Spot, bool, Values]] = []
    for place in places(tree):
        # a number that is a term of its own may have lost a letter, one that a function is of a term
        bare = isinstance(place.parent, ast.Call) or place.parent and is_operation(place.parent, ast.Add, ast.Sub)
        if value_of(place.node) is not None and not bare or solve is not None and is_exponent(place):
            continue
        old = memo[place.node]
        for wish in wishes.get(place.path, ()):
            factor = quotient(asked, wish, old)
            if is_product(place):
                gaps.append((place, True, factor))
            # a multiple of what stands there is no term of its own, nor is what takes it away
            shares = np.asarray(factor, dtype=float)
            alike = np.ptp(shares) <= _CLOSE * np.abs(np.median(shares)) or np.max(np.abs(shares)) < _CLOSE
            if is_term(place) and not alike:
                gaps.append((place, False, wish - old))
    for place, factor, gap in gaps if solve is None else _screened(asked, gaps, solve, min(4, most)):
        lost = product(asked, words, gap)
        if lost is None or not lost[1] or sum(not children(n) for w, _ in lost[1] for _, n in walk(w)) > most:
            continue
        if not factor:
            yield Edit(kind="put back", path=place.path, new=_plus(place.node, *lost))
        elif not _cancels(nodes, place.path, lost[1]):
            yield Edit(kind="put back", path=place.path, new=_times(place.node, *lost))


def _screened(
    asked: Bench, gaps: list[tuple[Spot, bool, Values]], solve: np.ndarray, most: int
) -> list[tuple[Spot, bool, Values]]:
    if not gaps or len(solve) < 2:
        return []
    missing = np.array([np.broadcast_to(gap, np.shape(asked.expected)) for *_, gap in gaps])
    logs = np.log(np.abs(missing))
    good = np.all(np.isfinite(logs), axis=1)
    halves = 2 * (np.where(good[:, None], logs, 0.0) @ solve.T)[:, 1:]
    whole = np.round(halves)
    used = np.count_nonzero(whole, axis=1)
    few = good & (np.abs(halves - whole).max(axis=1) < 1e-4) & (used >= 1) & (used <= most)
    return [gaps[i] for i in np.flatnonzero(few)]


def _cancels(nodes: Mapping[Path, Node], path: Path, used: Words) -> bool:
    # R*R times sin(phi)/R puts nothing back: it takes an R away
    top, above = path, True
    while top and is_operation(nodes[top[:-1]], ast.Mult, ast.Div):
        above ^= top[-1] == "right" and is_operation(nodes[top[:-1]], ast.Div)
        top = top[:-1]
    bases = {
        a: {ast.dump(f.left if is_operation(f, ast.Pow) else f) for f in factors(nodes[top], a)} for a in (True, False)
    }
    return any(ast.dump(word) in bases[(exponent < 0) == above] for word, exponent in used)


def _times(node: Node, factor: Fraction, used: Words) -> Node:
    above = [(w, e) for w, e in used if e > 0]
    below = [(w, -e) for w, e in used if e < 0]
    new = scaled(negative(node) if factor < 0 else node, abs(factor))
    if above:
        new = binary(ast.Mult, new, product_tree(Fraction(1), above))
    return binary(ast.Div, new, product_tree(Fraction(1), below)) if below else new


def _plus(node: Node, factor: Fraction, used: Words) -> Node:
    return binary(ast.Sub if factor < 0 else ast.Add, node, product_tree(abs(factor), used))
