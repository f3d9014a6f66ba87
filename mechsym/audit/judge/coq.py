"""The language of certificates: what every Coq script starts with, and expressions as Coq text."""

import re
from collections.abc import Callable, Iterator
from dataclasses import field
from fractions import Fraction
from importlib import resources
from itertools import combinations
from typing import TypeGuard

import sympy
from sympy import Expr, Integer, Mul, Pow, Symbol

from mechsym.audit.judge.question import Question
from mechsym.errors import BadInput
from mechsym.quantities import record

HEAD = (resources.files("mechsym.audit.judge") / "certificate.v").read_text(encoding="utf-8")


def symbol(letter: str) -> Symbol:
    """The symbol of a letter that stands for a function."""
    # a power of a positive number is positive, a root at least not negative
    return Symbol(letter, real=True, positive=letter[0] == "P" or None, nonnegative=letter[0] == "D" or None)


@record
class CoqTerm:
    """An expression twice: as Coq text with all functions named, and as rational function of the same letters."""

    text: str
    value: Expr


@record
class Script:
    """What is gathered on the way through both formulas."""

    question: Question
    name: str
    steps: list[str] = field(default_factory=list)
    lemmas: list[str] = field(default_factory=list)
    names: dict[str, CoqTerm] = field(default_factory=dict)
    functions: dict[str, CoqTerm] = field(default_factory=dict)  #: By their text
    terms: dict[str, str] = field(default_factory=dict)  #: Letter of a sine, cosine or root: what it stands for
    relations: list[Expr] = field(default_factory=list)  #: What vanishes
    powers: dict[Symbol, tuple[Expr, Expr]] = field(default_factory=dict)  #: Letter of a power: base and exponent
    angles: list[tuple[Expr, CoqTerm]] = field(default_factory=list)  #: Arcsines, by what they are of
    #: Functions that are taken as they are: which one, of what, and its letter
    unopened: list[tuple[str, Expr, CoqTerm]] = field(default_factory=list)
    divisors: dict[Expr, None] = field(default_factory=dict)  #: Factored, of several factors
    hypotheses: dict[str, None] = field(default_factory=dict)
    definitions: dict[str, str] = field(default_factory=dict)  #: Names of the tape and of the author, in their order

    def put(self, text: str) -> str:
        """A text with what its letters stand for."""
        return re.sub(r"\b[A-Za-z]\w*", lambda m: self.terms.get(m[0], m[0]), text)

    def new(self, stem: str, term: str) -> Symbol:
        """A letter for a term."""
        letter = f"{stem}{len(self.terms)}"
        self.terms[letter] = term
        return symbol(letter)

    def prove(self, left: str, right: str, proof: str) -> None:
        """A function of which the value is known: from here on it is replaced."""
        if self.put(left) == self.put(right):
            return
        assertion = f"  assert (K{len(self.steps)} : {left} = {right}). {{ {proof}. }}"
        self.steps.append(assertion)
        self.steps[-1] += f"\n  {self.rewritten}."

    @property
    def rewritten(self) -> str:
        """A tactic that puts in all values that are known."""
        known = ", ".join(f"?K{i}" for i in range(len(self.steps)))
        return f"repeat (progress rewrite {known})" if known else "idtac"

    def suppose(self, hypothesis: str) -> None:
        """A condition of the theorem."""
        self.hypotheses[hypothesis] = None


def rational(number: Fraction) -> CoqTerm:
    """A number in Coq and for sympy."""
    text = str(abs(number.numerator))
    text = text if number.denominator == 1 else f"({text} / {number.denominator})"
    return CoqTerm(
        text=f"(- {text})" if number < 0 else text, value=sympy.Rational(number.numerator, number.denominator)
    )


def is_half(exponent: Fraction | None) -> TypeGuard[Fraction]:
    """Whether an exponent is whole or half."""
    return exponent is not None and exponent.denominator <= 2


def power_text(base: str, exponent: Fraction | None, written: Callable[[], str]) -> str:
    """A power in Coq; one that is not whole or half of a positive number."""
    if not is_half(exponent):
        return f"(Rpower {base} {written()})"
    text = base if exponent.denominator == 1 else f"(sqrt {base})"
    text = f"({text} ^ {abs(exponent.numerator)})"
    return f"(/ {text})" if exponent < 0 else text


def bases(product: Expr) -> list[Expr]:
    """What a product is made of, powers and numbers left out."""
    factors = [f.base if isinstance(f, Pow) else f for f in Mul.make_args(product)]
    return [f for f in factors if not f.is_number]


def prime_factors(product: Expr) -> Iterator[tuple[Expr, int]]:
    """What a product is made of, with exponents; numbers as primes."""
    for factor in Mul.make_args(sympy.factor(product)):
        base, count = factor.as_base_exp()
        if base.is_Integer and base > 1:
            yield from ((Integer(p), k * int(count)) for p, k in sympy.factorint(base).items())
        elif base.is_number and base != 1 or not count.is_Integer:
            raise BadInput("a power of this has no place in a certificate")
        elif base != 1:
            yield base, int(count)


def coq_text(e: Expr) -> str:
    """A rational expression in Coq."""
    if e.is_Symbol:
        return str(e)
    if e.is_Rational:
        return rational(Fraction(int(e.p), int(e.q))).text
    if e.is_Add:
        first, *rest = (coq_text(a) for a in sorted(e.args, key=lambda a: (a.could_extract_minus_sign(), str(a))))
        return "(" + first + "".join(f" - {r[3:-1]}" if r.startswith("(- ") else f" + {r}" for r in rest) + ")"
    if e.is_Mul and e.could_extract_minus_sign():
        return f"(- {coq_text(-e)})"
    if e.is_Mul:
        above, below = ([a for a in e.args if _is_below(a) is side] for side in (False, True))
        top = " * ".join(map(coq_text, above)) or "1"
        return f"({top} / {coq_text(Mul(*(1 / a for a in below)))})" if below else f"({top})"
    if _is_below(e):
        return f"(1 / {coq_text(1 / e)})"
    if isinstance(e, Pow) and e.exp.is_Integer:
        return f"({coq_text(e.base)} ^ {int(e.exp)})"
    raise BadInput(f"{e} has no place in a certificate")


def _is_below(e: Expr) -> bool:
    return isinstance(e, Pow) and bool(e.exp.is_Integer and e.exp < 0)


_CANCELLED = 4  # letters of a divisor, of which all products are tried


def not_zero(own: Script, value: Expr) -> None:
    """Suppose that a divisor is not zero, factor by factor."""
    above = sympy.factor(sympy.fraction(sympy.together(value))[0])
    factors = bases(above)
    for factor in factors:
        if not factor.is_positive:
            own.suppose(f"{coq_text(factor)} <> 0")
    # `field` asks for divisors less what cancels
    sums = sympy.Mul(*(f for f in factors if f.is_Add))
    plain = [f for f in factors if f.is_Symbol][:_CANCELLED]
    for count in range(1, len(plain) + 1) if sums != 1 else ():
        own.divisors.update((sympy.Mul(*some) * sums, None) for some in combinations(plain, count))


def lowered(own: Script, polynomial: Expr) -> Expr:
    """A polynomial with c^2 as 1 - s^2."""
    for relation in own.relations:
        cosine = max(relation.free_symbols, key=lambda k: int(str(k)[1:]) if str(k)[0] == "c" else -1)
        if str(cosine)[0] == "c" and relation.has(cosine**2):
            polynomial = sympy.rem(polynomial, relation, cosine)
    return sympy.expand(polynomial)
