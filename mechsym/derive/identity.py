"""Is an expression identically zero? Numbers refute quickly, a polynomial certificate proves.

The certificate: sines and cosines of multiples and sums become polynomials in s and c with s^2 + c^2 = 1; roots become
letters D with D^2 = radicand, the radicand made square-free where signs allow; powers with letters in the exponent
become letters. What then vanishes as a polynomial vanishes everywhere. A failure to reduce proves nothing.
"""

import random
from collections.abc import Sequence
from contextvars import ContextVar
from functools import cache, reduce
from math import comb, prod

import mpmath
import sympy
from sympy import Dummy, Expr, Integer, Pow, Rational, Symbol, cos, lambdify, sin

# beyond these an expression takes minutes to expand, and is not tried: 6 and more times what any proof has needed
MAX_OPERATIONS = 4000
MAX_POWER = 12
MAX_TERMS = 10_000
MAX_MULTIPLE = 24  # of an angle, or angles in a sum
_DIGITS = 50
_most: ContextVar[int] = ContextVar("most", default=MAX_TERMS)  # of the proof that is under way


def random_state(symbols: Sequence[Symbol], generator: random.Random) -> dict[Symbol, Rational]:
    """Rational values in [1/10, 1] by a seeded generator: a rod is longer than its crank, no root imaginary."""
    return {s: Rational(generator.randint(100, 1000), 1000) for s in symbols}


def vanishes_at_random_points(expression: Expr, scale: Expr, states: Sequence[dict[Symbol, Rational]]) -> bool:
    """Whether the expression is below 1e-40 of a scale at every state, with 50 digits.

    expression: the difference that should vanish; scale: what it is compared with; states: values of all letters, the
    same letters in each. Returns zero: False is a refutation, True is evidence only.
    """
    letters = list(states[0])
    evaluate = lambdify(letters, [expression, scale], "mpmath", cse=True)
    with mpmath.workdps(_DIGITS):
        for state in states:
            values = [mpmath.mpf(int(state[s].p)) / int(state[s].q) for s in letters]
            difference, size = (abs(v) for v in evaluate(*values))
            if not difference <= mpmath.mpf(10) ** -40 * (size + 1):
                return False
    return True


def vanishes(expression: Expr, terms: int = MAX_TERMS) -> bool:
    """Whether an expression reduces to the zero polynomial.

    expression: in letters, sines, cosines, roots and powers; terms: most terms that opened brackets may have. Returns
    zero: True is a proof wherever the expression is real; False means that this reduction found none.
    """
    too_high = any(p.exp.is_number and abs(p.exp) > MAX_POWER for p in expression.atoms(Pow))
    if expression.count_ops() > MAX_OPERATIONS or too_high:
        return False
    token = _most.set(terms)
    try:
        expression = _circular(expression)
        letters: dict[Expr, Dummy] = {}
        polynomial = _without_roots(expression, letters)
        numerator = sympy.fraction(sympy.together(polynomial))[0]
        for _ in range(len(letters) + 1):
            numerator = sympy.fraction(sympy.together(_lower_roots(_opened(numerator), letters)))[0]
        return _lower_cosines(_opened(numerator)) == 0
    except _TooLong:
        return False
    finally:
        _most.reset(token)


class _TooLong(Exception):
    """An expression that has too many terms when its brackets are opened."""


def _opened(expression: Expr) -> Expr:
    # with all brackets opened, where that stays within bounds
    _terms(expression, {})
    return sympy.expand(expression)


def _terms(expression: Expr, known: dict[Expr, int]) -> int:
    # at most so many terms, the parts that are opened on the way included
    if expression in known or not expression.args:
        return known.get(expression, 1)
    counts = [_terms(a, known) for a in expression.args]
    count = 1
    if expression.is_Add:
        count = sum(counts)
    elif expression.is_Mul:
        count = prod(counts)
    elif isinstance(expression, Pow) and expression.exp.is_Integer:
        power = abs(int(expression.exp))
        count = comb(counts[0] + power - 1, power)
    known[expression] = count
    if max(count, len(known)) > _most.get():
        raise _TooLong
    return count


def _circular(expression: Expr) -> Expr:
    expression = expression.replace(sympy.tan, lambda x: sin(x) / cos(x)).replace(sympy.cot, lambda x: cos(x) / sin(x))
    arguments = [_opened(f.args[0]) for f in expression.atoms(sin, cos)]
    if any(sum(abs(c) for c in a.as_coefficients_dict().values()) > MAX_MULTIPLE for a in arguments):
        raise _TooLong
    divisors: dict[Expr, int] = {}
    for argument in arguments:
        for atom, coefficient in argument.as_coefficients_dict().items():
            divisors[atom] = sympy.ilcm(divisors.get(atom, 1), getattr(coefficient, "q", 1))
    halves = {atom: divisor * atom for atom, divisor in divisors.items() if atom.is_Symbol and divisor > 1}
    return sympy.expand_trig(expression.xreplace(halves))


def _without_roots(expression: Expr, letters: dict[Expr, Dummy]) -> Expr:
    # innermost first: a radicand may hold roots
    if not expression.args:
        return expression
    expression = expression.func(*(_without_roots(a, letters) for a in expression.args))
    if not isinstance(expression, Pow) or expression.exp.is_Integer:
        return expression
    base, exponent = expression.args
    if exponent.is_Rational:
        return _root(base, exponent.q, letters) ** exponent.p
    whole, rest = exponent.expand().as_coeff_Add()
    coefficient, rest = rest.as_coeff_Mul()
    if not (whole.is_Integer and coefficient.is_Integer):
        return expression
    return base**whole * letters.setdefault(base**rest, Dummy("P", positive=True)) ** coefficient


def _root(base: Expr, degree: int, letters: dict[Expr, Dummy]) -> Expr:
    if degree != 2:
        return letters.setdefault(Pow(base, Rational(1, degree), evaluate=False), Dummy("R", positive=True))
    content, outside, inside, below = _square_free(base)
    return outside * _letter_of(content, letters) * _letter_of(inside, letters) / below


@cache
def _square_free(base: Expr) -> tuple[Expr, Expr, Expr, Expr]:
    # content * outside^2 * inside/below^2, what is outside and below positive; the same radicands come often
    above, below = sympy.fraction(sympy.together(base))
    if not below.is_positive:
        # a denominator that may be negative stays in the radicand
        return Integer(1), Integer(1), sympy.together(_lower_cosines(_opened(base))), Integer(1)
    content, factors = sympy.sqf_list(_lower_cosines(_opened(above * below)))
    outside, inside = Integer(1), Integer(1)
    for factor, power in factors:
        if factor.is_positive:
            outside *= factor ** (power // 2)
            inside *= factor ** (power % 2)
        else:
            inside *= factor**power
    return content, outside, _opened(inside), below


def _letter_of(square: Expr, letters: dict[Expr, Dummy]) -> Expr:
    root = sympy.sqrt(square)
    if root.is_Symbol or root.is_Rational:
        return root
    return letters.setdefault(square, Dummy("D", positive=True))


def _lower_roots(polynomial: Expr, letters: dict[Expr, Dummy]) -> Expr:
    def lower(power: Pow, square: Expr) -> Expr:
        return square ** (power.exp // 2) * power.base ** (power.exp % 2)

    for square, letter in letters.items():
        if letter.name == "D":
            polynomial = polynomial.replace(
                lambda e, d=letter: isinstance(e, Pow) and e.base == d and e.exp.is_Integer,
                lambda e, s=square: lower(e, s),
            )
    return _opened(polynomial)


def _lower_cosines(polynomial: Expr) -> Expr:
    angles = sorted({f.args[0] for f in polynomial.atoms(cos)}, key=str)
    return reduce(_lower_cosine, angles, polynomial)


def _lower_cosine(polynomial: Expr, angle: Expr) -> Expr:
    def lower(power: Pow) -> Expr:
        return (1 - sin(angle) ** 2) ** (power.exp // 2) * cos(angle) ** (power.exp % 2)

    return _opened(
        polynomial.replace(lambda e: isinstance(e, Pow) and e.base == cos(angle) and e.exp.is_Integer, lower)
    )
