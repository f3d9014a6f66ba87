"""Is an expression identically zero? Numbers decide quickly, a polynomial certificate decides exactly.

The certificate writes every root as a letter D with D^2 = radicand and every sine and cosine as letters with
s^2 + c^2 = 1, and reduces the numerator: what vanishes as a polynomial vanishes everywhere.
"""

import random
from collections.abc import Sequence

import mpmath
from sympy import Dummy, Expr, Pow, Rational, Symbol, cos, expand, fraction, lambdify, sin, together

_DIGITS = 50
_POINTS = 20


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


def certificate(expression: Expr) -> bool:
    """Whether the expression reduces to the zero polynomial modulo D^2 = radicand and s^2 + c^2 = 1.

    Parameters
    ----------
    expression : Expr
        Rational expression in letters, sines, cosines and square roots

    Returns
    -------
    zero : bool
        True is a proof; False means that this reduction found no proof
    """
    roots = sorted({p.base for p in expression.atoms(Pow) if p.exp.is_Rational and p.exp.q == 2}, key=str)
    letters = {base: Dummy(f"D{i}", positive=True) for i, base in enumerate(roots)}

    def as_letter(power: Pow) -> Expr:
        return letters[power.base] ** (2 * power.exp)

    polynomial = expression.replace(lambda e: isinstance(e, Pow) and e.base in letters and e.exp.q == 2, as_letter)
    numerator = expand(fraction(together(polynomial))[0])
    for base, letter in letters.items():
        numerator = expand(fraction(together(_reduce(numerator, letter, base)))[0])
    for angle in sorted({f.args[0] for f in numerator.atoms(sin, cos)}, key=str):
        numerator = expand(_reduce(numerator, cos(angle), 1 - sin(angle) ** 2))
    return numerator == 0


def _reduce(polynomial: Expr, letter: Expr, square: Expr) -> Expr:
    def lower(power: Pow) -> Expr:
        return square ** (power.exp // 2) * letter ** (power.exp % 2)

    return polynomial.replace(lambda e: isinstance(e, Pow) and e.base == letter and e.exp.is_Integer, lower)
