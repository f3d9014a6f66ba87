"""A proof that two formulas are the same function.

Sines and cosines of multiples and sums become polynomials in s and c with s^2 + c^2 = 1; roots become letters D with
D^2 = radicand, the radicand made square-free; powers with letters in the exponent become letters. What then vanishes
as a polynomial vanishes everywhere. A failure to reduce proves nothing.
"""

from functools import reduce

import sympy
from sympy import Dummy, Expr, Integer, Pow, cos, sin

from mechsym.audit.algebra import SYMBOLS, evaluate
from mechsym.audit.bench import used_names
from mechsym.audit.question import Question
from mechsym.audit.theory.record import Theory, complete
from mechsym.audit.tree import Node
from mechsym.errors import BadInput

MAX_OPERATIONS = 4000
MAX_POWER = 12


def proves_equal(question: Question, tree: Node, other: Node | None = None) -> bool:
    """Whether a formula is provably the derived quantity, or another formula.

    Parameters
    ----------
    question : Question
        Letters and theory
    tree : Node
        Expression in the formula's letters
    other : Node, optional
        Expression in the same letters; the derived quantity when left out

    Returns
    -------
    proved : bool
        False means that no proof was found
    """
    try:
        names = symbolic_names(question)
        first = evaluate(tree, names, SYMBOLS)
        second = names[question.quantity] if other is None else evaluate(other, names, SYMBOLS)
        return vanishes(sympy.sympify(first - second))
    except (BadInput, sympy.PolynomialError, RecursionError):
        return False


def symbolic_names(question: Question) -> dict[str, Expr]:
    """Symbols for the theory's letters, closed forms for its names and the author's letters.

    Parameters
    ----------
    question : Question
        Letters and theory

    Returns
    -------
    names : dict of str to Expr
        By name
    """
    theory, formula = question.theory, question.formula
    letters = {k: _symbol(theory, k) for k in theory.letters} | {
        k: sympy.Rational(str(v)) for k, v in question.hold.items()
    }
    names: dict[str, Expr] = {"pi": sympy.pi, **letters}
    complete(theory, names, [question.quantity, *used_names(formula)], SYMBOLS)
    return names | {k: evaluate(t, names, SYMBOLS) for k, t in formula.letters.items()}


def _symbol(theory: Theory, letter: str) -> sympy.Symbol:
    record = theory.letters[letter]
    positive = record.value > 0 and not record.unit.startswith("rad")
    return sympy.Symbol(letter, real=True, positive=positive or None)


def vanishes(expression: Expr) -> bool:
    """Whether an expression reduces to the zero polynomial.

    Parameters
    ----------
    expression : Expr
        Difference of two formulas

    Returns
    -------
    zero : bool
        True is a proof
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
        return letters.setdefault(Pow(base, sympy.Rational(1, degree), evaluate=False), Dummy("R", positive=True))
    above, below = sympy.fraction(sympy.together(base))
    if not below.is_positive:
        above, below = base, Integer(1)
    content, factors = sympy.sqf_list(_lower_cosines(sympy.expand(above * below)))
    outside, inside = _letter_of(content, letters), Integer(1)
    for factor, power in factors:
        if factor.is_positive:
            outside *= factor ** (power // 2)
            inside *= factor ** (power % 2)
        else:
            inside *= factor**power
    return outside * _letter_of(sympy.expand(inside), letters) / below


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
