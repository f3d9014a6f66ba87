"""Coq scripts of exact verdicts: another kernel checks what the polynomial reduction found.

Printed and derived formula are rational in letters, sines, cosines and roots. Their difference, cleared of divisors, is
a combination of s^2 + c^2 - 1 and of the squared roots minus their radicands; sympy finds the cofactors, `ring` and
`field` check them. The last theorem says it for the sine, cosine and root of real numbers.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import field

import sympy
from sympy import Expr, Integer, Mul, Pow, Rational, Symbol, cos, sin

from mechsym.audit.judge.prover import symbolic_names
from mechsym.audit.judge.question import Question
from mechsym.audit.read.algebra import SYMBOLS, evaluate
from mechsym.audit.read.tree import Node
from mechsym.errors import BadInput
from mechsym.quantities import record

_PI = Symbol("PI")
_MOST = 1500  # operations, beyond which ring takes minutes
HEAD = """Require Import Reals Lra Field.
Open Scope R_scope.

Ltac nonzero := repeat split; first
  [ assumption
  | let Z := fresh in intro Z; first
    [ match goal with Z : ?f = 0, h : ?e <> 0 |- False => apply h; replace e with f by ring; exact Z end
    | match goal with Z : ?f = 0, h : ?d <> 0, k : ?e <> 0 |- False =>
        apply (Rmult_integral_contrapositive_currified d e h k); replace (d * e) with f by ring; exact Z end
    | match goal with h : ?e <> 0 |- False => apply h; lra end ] ].
Ltac product := repeat first [ assumption | apply Rmult_integral_contrapositive_currified | apply pow_nonzero | lra ].
"""


@record
class Identity:
    """Two rational expressions, and the polynomials that vanish for their letters."""

    printed: Expr
    derived: Expr
    #: Letter of a sine or cosine to it, letter of a root to its radicand, in the order of definition
    circular: dict[Symbol, Expr] = field(default_factory=dict)
    roots: dict[Symbol, Expr] = field(default_factory=dict)

    @property
    def relations(self) -> list[Expr]:
        """What vanishes: s^2 + c^2 - 1 for every angle, D^2 - radicand for every root."""
        angles = dict.fromkeys(f.args[0] for f in self.circular.values())
        named = {f: letter for letter, f in self.circular.items()}
        circles = [named[sin(a)] ** 2 + named[cos(a)] ** 2 - 1 for a in angles]
        return [*circles, *(letter**2 - square for letter, square in self.roots.items())]


def script(question: Question, tree: Node, name: str) -> str | None:
    """Lemma and theorem of one exact formula in Coq; None where it has no such certificate."""
    try:
        identity = _identity(question, tree)
    except (BadInput, sympy.PolynomialError, RecursionError):
        return None
    return None if identity is None else _written(identity, name)


def _identity(question: Question, tree: Node) -> Identity | None:
    names = symbolic_names(question)
    pair = [_sines(sympy.sympify(e)) for e in (evaluate(tree, names, SYMBOLS), names[question.quantity])]
    if sum(e.count_ops() for e in pair) > _MOST:
        return None
    letters: dict[Expr, Symbol] = {}
    powers: dict[Expr, Symbol] = {}
    pair = [_without_roots(e, letters, powers) for e in pair]
    angles = sorted({f.args[0] for e in (*pair, *letters) for f in e.atoms(sin, cos)}, key=str)
    if not all(a.is_Symbol for a in angles):
        return None
    plain = {f(a): Symbol(f"{f.__name__}_{a}") for a in angles for f in (sin, cos)} | {sympy.pi: _PI}
    identity = Identity(
        printed=pair[0].xreplace(plain),
        derived=pair[1].xreplace(plain),
        circular={v: k for k, v in plain.items() if k.args},
        roots={letter: square.xreplace(plain) for square, letter in letters.items()},
    )
    rational = all(e.is_rational_function() for e in (identity.printed, identity.derived, *identity.roots.values()))
    return identity if rational else None


def _sines(expression: Expr) -> Expr:
    # sines and cosines of single angles
    expression = expression.replace(sympy.tan, lambda x: sin(x) / cos(x)).replace(sympy.cot, lambda x: cos(x) / sin(x))
    return sympy.expand_trig(expression)


def _without_roots(expression: Expr, letters: dict[Expr, Symbol], powers: dict[Expr, Symbol]) -> Expr:
    # innermost first: a radicand may hold roots
    if not expression.args:
        return expression
    expression = expression.func(*(_without_roots(a, letters, powers) for a in expression.args))
    if not isinstance(expression, Pow) or expression.exp.is_Integer:
        return expression
    base, exponent = expression.args
    if exponent.is_Rational and exponent.q == 2:
        return _root(base, letters) ** exponent.p
    # any other power may be any number: x^(n - 1) is x^n/x, and x^(1/3) a letter
    whole, rest = (Integer(0), exponent) if exponent.is_Rational else exponent.expand().as_coeff_Add()
    count, rest = (exponent.p, Rational(1, exponent.q)) if exponent.is_Rational else rest.as_coeff_Mul()
    if not (whole.is_Integer and sympy.sympify(count).is_Integer):
        return expression
    power = Pow(base, rest, evaluate=False)
    return base**whole * powers.setdefault(power, Symbol(f"power_{len(powers) + 1}")) ** count


def _root(base: Expr, letters: dict[Expr, Symbol]) -> Expr:
    # the square of what is positive is taken out, the sign stays inside
    above, below = sympy.fraction(sympy.together(base))
    if not below.is_positive:
        above, below = sympy.together(base), Integer(1)
    square = sympy.expand(above * below).replace(
        lambda e: isinstance(e, Pow) and isinstance(e.base, cos) and e.exp.is_Integer and e.exp > 1,
        lambda e: (1 - sin(e.base.args[0]) ** 2) ** (e.exp // 2) * e.base ** (e.exp % 2),
    )
    content, factors = sympy.sqf_list(sympy.expand(square))
    outside, inside = Integer(1), content
    for factor, power in factors:
        outside *= factor ** (power // 2) if factor.is_positive else 1
        inside *= factor ** (power % 2 if factor.is_positive else power)
    inside = sympy.expand(inside)
    if inside == 1:
        return outside / below
    return outside * letters.setdefault(inside, Symbol(f"root_{len(letters) + 1}")) / below


def _written(identity: Identity, name: str) -> str | None:
    above, below = sympy.fraction(sympy.together(identity.printed - identity.derived))
    relations = identity.relations
    order = [*reversed(identity.roots), *sorted(identity.circular, key=str)]
    free = sorted(above.free_symbols.union(*(r.free_symbols for r in relations)) - set(order), key=str)
    cofactors: Sequence[Expr] = []
    if relations and sympy.expand(above) != 0:
        quotients, rest = sympy.reduced(sympy.expand(above), relations, *order, *free, order="lex")
        if rest != 0:
            return None
        cofactors = quotients
    rational = (identity.printed, identity.derived, *identity.roots.values())
    factors = sorted({f for part in _below(rational) for f in _factors(part)}, key=str)
    divisors = list(dict.fromkeys([*factors, *_factors(below)]))
    everything = (identity.printed, identity.derived, *relations, *divisors)
    letters = sorted(set().union(*(e.free_symbols for e in everything)), key=str)
    lemma = _lemma(identity, name, relations, cofactors, below, divisors, letters)
    return "\n".join([lemma, _theorem(identity, name, divisors, letters)])


def _products(expressions: Iterable[Expr]) -> list[str]:
    # a divisor that is a product, written out: it is not zero because its factors are not
    parts = {part for part in _below(expressions) if part.is_Mul}
    return [
        f"  assert ({_coq(sympy.expand(part))} <> 0) by (replace ({_coq(sympy.expand(part))}) with ({_coq(part)}) "
        "by ring; product)."
        for part in sorted(parts, key=str)
    ]


def _below(expressions: Iterable[Expr]) -> list[Expr]:
    # divisors; of one that is a fraction itself field asks for both of its parts
    powers = [p for e in expressions for p in e.atoms(Pow) if _is_below(p)]
    return [part for p in powers for part in sympy.fraction(sympy.together(p.base))]


def _factors(product: Expr) -> list[Expr]:
    factors = [f.base if isinstance(f, Pow) else f for f in Mul.make_args(product)]
    return [f for f in factors if not f.is_number]


def _lemma(
    identity: Identity,
    name: str,
    relations: list[Expr],
    cofactors: Sequence[Expr],
    below: Expr,
    divisors: list[Expr],
    letters: list[Symbol],
) -> str:
    terms = [f"({_coq(q)}) * ({_coq(g)})" for q, g in zip(cofactors, relations, strict=False) if q != 0]
    used = [i for i, q in enumerate(cofactors) if q != 0]
    hypotheses = [f"  {_coq(g)} = 0 ->" for g in relations] + [f"  {_coq(d)} <> 0 ->" for d in divisors]
    named = [f"H{i}" for i in range(len(relations))] + [f"N{i}" for i in range(len(divisors))]
    combination = " + ".join(terms) or "0"
    rewritten = "".join(f"rewrite H{i}; " for i in used)
    return "\n".join(
        [
            f"Lemma {name}_algebra : forall {' '.join(_letter(k) for k in letters if k != _PI) or 'unused'} : R,",
            *hypotheses,
            f"  {_coq(identity.printed)} = {_coq(identity.derived)}.",
            f"Proof.\n  intros {' '.join([*(_letter(k) for k in letters if k != _PI), *named])}.",
            *_products((identity.printed, identity.derived)),
            f"  apply Rminus_diag_uniq.\n  replace ({_coq(identity.printed)} - ({_coq(identity.derived)}))",
            f"    with (({combination}) / ({_coq(below)})).",
            f"  - {rewritten}unfold Rdiv; ring.\n  - field; nonzero.\nQed.",
        ]
    )


def _theorem(identity: Identity, name: str, divisors: list[Expr], letters: list[Symbol]) -> str:
    put: dict[Symbol, str] = {k: f"({f.func.__name__} {_letter(f.args[0])})" for k, f in identity.circular.items()}
    for letter, square in identity.roots.items():
        put[letter] = f"(sqrt ({_coq(square, put)}))"
    everything = (identity.printed, identity.derived, *identity.roots.values(), *divisors)
    free = set().union(*(e.free_symbols for e in everything)) - {*put, _PI}
    free |= {f.args[0] for f in identity.circular.values()}
    squares = [f"  0 <= {_coq(square, put)} ->" for square in identity.roots.values()]
    hypotheses = [*squares, *(f"  {_coq(d, put)} <> 0 ->" for d in divisors)]
    angles = dict.fromkeys(f.args[0] for f in identity.circular.values())
    facts = [f"pose proof (sin2_cos2 {_letter(a)}) as C{i}; unfold Rsqr in C{i}; " for i, a in enumerate(angles)]
    facts += [f"pose proof (sqrt_sqrt _ Q{i}) as S{i}; " for i in range(len(squares))]
    given = " ".join(put.get(k) or _letter(k) for k in letters if k != _PI)
    named = [f"Q{i}" for i in range(len(squares))] + [f"N{i}" for i in range(len(divisors))]
    return "\n".join(
        [
            f"Theorem {name} : forall {' '.join(sorted(map(_letter, free))) or 'unused'} : R,",
            *hypotheses,
            f"  {_coq(identity.printed, put)} = {_coq(identity.derived, put)}.",
            f"Proof.\n  intros {' '.join([*sorted(map(_letter, free)), *named])}.",
            f"  {''.join(facts)}",
            f"  apply ({name}_algebra {given}); first [ assumption | lra ].\nQed.\n",
        ]
    )


def _letter(symbol: Symbol) -> str:
    return "PI" if symbol == _PI else re.sub(r"\W", "_", f"{symbol}_")


def _coq(e: Expr, put: dict[Symbol, str] | None = None) -> str:
    put = put or {}
    if e.is_Symbol:
        return put.get(e) or _letter(e)
    if e.is_Rational:
        whole = f"{abs(int(e.p))}" if e.q == 1 else f"({abs(int(e.p))} / {int(e.q)})"
        return f"(- {whole})" if e.p < 0 else whole
    if e.is_Add:
        first, *rest = (_coq(a, put) for a in sorted(e.args, key=lambda a: a.could_extract_minus_sign()))
        return "(" + first + "".join(f" - {r[3:-1]}" if r.startswith("(- ") else f" + {r}" for r in rest) + ")"
    if e.is_Mul and e.could_extract_minus_sign():
        return f"(- {_coq(-e, put)})"
    if e.is_Mul:
        above, below = ([a for a in e.args if _is_below(a) is side] for side in (False, True))
        top = " * ".join(_coq(a, put) for a in above) or "1"
        return f"({top} / {_coq(Mul(*(1 / a for a in below)), put)})" if below else f"({top})"
    if _is_below(e):
        return f"(1 / {_coq(1 / e, put)})"
    if isinstance(e, Pow) and e.exp.is_Integer:
        return f"({_coq(e.base, put)} ^ {int(e.exp)})"
    raise BadInput(f"{e} has no place in a certificate")


def _is_below(e: Expr) -> bool:
    return isinstance(e, Pow) and bool(e.exp.is_Integer and e.exp < 0)
