"""Is an expression identically zero? Numbers refute quickly, a polynomial certificate proves.

The certificate: sines and cosines of multiples and sums become polynomials in s and c with s^2 + c^2 = 1; roots become
letters D with D^2 = radicand, the radicand made square-free where signs allow; powers with letters in the exponent
become letters. What then vanishes as a polynomial vanishes everywhere. A failure to reduce proves nothing.
"""

import random
from collections.abc import Sequence
from functools import cache, reduce

import mpmath
import sympy
from sympy import Dummy, Expr, Integer, Pow, Rational, Symbol, cos, lambdify, sin

# beyond these an expression takes minutes to expand, and is not tried
MAX_OPERATIONS = 4000
MAX_POWER = 12
_DIGITS = 50


def random_state(symbols: Sequence[Symbol], generator: random.Random) -> dict[Symbol, Rational]:
    """Random rational values in [1/10, 1], so that a rod is longer than its crank and no root is imaginary.

    Parameters
    ----------
    symbols : sequence of Symbol
        What gets a value
    generator : random.Random
        Seeded generator

    Returns
    -------
    state : dict of Symbol to Rational
        Values
    """
    return {s: Rational(generator.randint(100, 1000), 1000) for s in symbols}


def vanishes_at_random_points(expression: Expr, scale: Expr, states: Sequence[dict[Symbol, Rational]]) -> bool:
    """Whether the expression is below 1e-40 of a scale at every state, with 50 digits.

    Parameters
    ----------
    expression : Expr
        The difference that should vanish
    scale : Expr
        What it is compared with
    states : sequence of dict
        Values of all letters, the same letters in each

    Returns
    -------
    zero : bool
        False is a refutation, True is evidence only
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


def vanishes(expression: Expr) -> bool:
    """Whether an expression reduces to the zero polynomial.

    Parameters
    ----------
    expression : Expr
        In letters, sines, cosines, roots and powers

    Returns
    -------
    zero : bool
        True is a proof wherever the expression is real; False means that this reduction found none
    """
    if expression.count_ops() > MAX_OPERATIONS or any(abs(p.exp) > MAX_POWER for p in _number_powers(expression)):
        return False
    expression = _circular(expression)
    letters: dict[Expr, Dummy] = {}
    polynomial = _without_roots(expression, letters)
    numerator = sympy.fraction(sympy.together(polynomial))[0]
    for _ in range(len(letters) + 1):
        numerator = sympy.fraction(sympy.together(_lower_roots(sympy.expand(numerator), letters)))[0]
    return _lower_cosines(sympy.expand(numerator)) == 0


def _number_powers(expression: Expr) -> list[Pow]:
    return [p for p in expression.atoms(Pow) if p.exp.is_number]


def _circular(expression: Expr) -> Expr:
    expression = expression.replace(sympy.tan, lambda x: sin(x) / cos(x)).replace(sympy.cot, lambda x: cos(x) / sin(x))
    arguments = [sympy.expand(f.args[0]) for f in expression.atoms(sin, cos)]
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
        return Integer(1), Integer(1), sympy.together(_lower_cosines(sympy.expand(base))), Integer(1)
    content, factors = sympy.sqf_list(_lower_cosines(sympy.expand(above * below)))
    outside, inside = Integer(1), Integer(1)
    for factor, power in factors:
        if factor.is_positive:
            outside *= factor ** (power // 2)
            inside *= factor ** (power % 2)
        else:
            inside *= factor**power
    return content, outside, sympy.expand(inside), below


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
    return sympy.expand(polynomial)


def _lower_cosines(polynomial: Expr) -> Expr:
    angles = sorted({f.args[0] for f in polynomial.atoms(cos)}, key=str)
    return reduce(_lower_cosine, angles, polynomial)


def _lower_cosine(polynomial: Expr, angle: Expr) -> Expr:
    def lower(power: Pow) -> Expr:
        return (1 - sin(angle) ** 2) ** (power.exp // 2) * cos(angle) ** (power.exp % 2)

    found = polynomial.replace(lambda e: isinstance(e, Pow) and e.base == cos(angle) and e.exp.is_Integer, lower)
    return sympy.expand(found)
