r"""Coq scripts of exact verdicts: another kernel checks the printed formula itself against the declared geometry.

The theorem holds the formula as printed, node by node in its author's names, and the definitions of the theory, such as
`beta := asin (lam * sin phi)`. Its proof takes the functions in turn, the innermost first: the sine of a sum by sines
of its parts, a root by what it is the root of, the sine of an arcsine by its argument. What is left is rational in
letters, sines, cosines, roots; sympy guesses the cofactors of s^2 + c^2 - 1 and D^2 - radicand, with which `ring` and
`field` prove it.
"""

import ast
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import field
from fractions import Fraction
from typing import TypeGuard

import sympy
from sympy import Expr, Integer, Mul, Pow, Symbol

from mechsym.audit.judge.question import Question
from mechsym.audit.read.tree import Node, function_of, value_of
from mechsym.errors import BadInput
from mechsym.quantities import record

_MOST = 1500  # operations, beyond which ring takes minutes
_MULTIPLE = 8  # of an angle
HEAD = """Require Import Reals Lra Field.
Open Scope R_scope.

Lemma root_is : forall u v : R, 0 <= v -> v * v = u -> sqrt u = v.
Proof. intros u v H E. rewrite <- E. apply sqrt_square; exact H. Qed.
Lemma cos_of_asin : forall u : R, -1 <= u <= 1 -> cos (asin u) = sqrt (1 - u ^ 2).
Proof. intros u H. rewrite (cos_asin u H). unfold Rsqr. f_equal; ring. Qed.

Ltac product := repeat first
  [ assumption | apply PI_neq0 | apply Rmult_integral_contrapositive_currified | apply pow_nonzero
  | apply Rinv_neq_0_compat | lra | solve [ apply Rgt_not_eq; unfold Rpower; apply exp_pos ] ].
Ltac nonzero := repeat split; first
  [ assumption
  | solve [ product ]
  | let Z := fresh in intro Z; first
    [ match goal with Z : ?f = 0, h : ?e <> 0 |- False => apply h; replace e with f by ring; exact Z end
    | match goal with Z : ?f = 0, h : ?d <> 0, k : ?e <> 0 |- False =>
        apply (Rmult_integral_contrapositive_currified d e h k); replace (d * e) with f by ring; exact Z end
    | match goal with h : ?e <> 0 |- False => apply h; lra end ] ].
Ltac strictly := unfold Rpower, Rdiv; repeat first
  [ assumption | apply exp_pos | apply PI_RGT_0 | apply Rmult_lt_0_compat | apply Rinv_0_lt_compat | apply pow_lt
  | apply sqrt_lt_R0 | lra ].
Ltac positive := unfold Rdiv; repeat first
  [ assumption | apply sqrt_pos | apply pow2_ge_0 | apply Rmult_le_pos | apply pow_le | lra
  | solve [ apply Rlt_le; strictly ] ].
Lemma ln_of_pow : forall (n : nat) (x : R), 0 < x -> ln (x ^ n) = INR n * ln x.
Proof.
  induction n; intros x H. { simpl; rewrite ln_1; ring. }
  rewrite S_INR. simpl pow. rewrite ln_mult; [ | exact H | apply pow_lt; exact H ]. rewrite IHn; [ ring | exact H ].
Qed.
Ltac logarithms := unfold Rdiv; apply ln_inv; [ strictly | strictly | ];
  repeat first [ rewrite ln_mult by strictly | rewrite ln_Rinv by strictly | rewrite ln_of_pow by strictly
    | unfold Rpower; rewrite ln_exp | progress rewrite ?ln_1 ]; simpl INR; field; nonzero.
Ltac circles := first
  [ match goal with |- context [cos ?a] => solve [ generalize (sin2_cos2 a); unfold Rsqr; lra ] end
  | match goal with |- context [sqrt ?u] =>
      solve [ let Q := fresh in assert (Q : 0 <= u) by assumption; generalize (sqrt_sqrt u Q); lra ] end ].
"""
_SIGNS: dict[type, str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}


def _symbol(letter: str) -> Symbol:
    # a power of a positive number is positive, a root at least not negative
    return Symbol(letter, real=True, positive=letter[0] == "P" or None, nonnegative=letter[0] == "D" or None)


@record
class _CoqTerm:
    """An expression twice: as Coq text with all functions named, and as rational function of the same letters."""

    text: str
    value: Expr


@record
class _Script:
    """What is gathered on the way through both formulas."""

    question: Question
    name: str
    steps: list[str] = field(default_factory=list)
    lemmas: list[str] = field(default_factory=list)
    names: dict[str, _CoqTerm] = field(default_factory=dict)
    functions: dict[str, _CoqTerm] = field(default_factory=dict)  #: By their text
    terms: dict[str, str] = field(default_factory=dict)  #: Letter of a sine, cosine or root: what it stands for
    relations: list[Expr] = field(default_factory=list)  #: What vanishes
    powers: dict[Symbol, tuple[Expr, Expr]] = field(default_factory=dict)  #: Letter of a power: base and exponent
    hypotheses: dict[str, None] = field(default_factory=dict)
    definitions: dict[str, str] = field(default_factory=dict)  #: Names of the tape and of the author, in their order

    def put(self, text: str) -> str:
        """A text with what its letters stand for."""
        return re.sub(r"\b[A-Za-z]\w*", lambda m: self.terms.get(m[0], m[0]), text)

    def new(self, stem: str, term: str) -> Symbol:
        """A letter for a term."""
        letter = f"{stem}{len(self.terms)}"
        self.terms[letter] = term
        return _symbol(letter)

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


def script(question: Question, tree: Node, name: str) -> str | None:
    """Lemmas and theorem of one exact formula in Coq; None where it has no such certificate."""
    own = _Script(question=question, name=name)
    try:
        printed = _part(own, tree, authors=True)
        derived = _named(own, question.quantity, authors=False)
        if printed.value.count_ops() + derived.value.count_ops() > _MOST:
            return None
        last = _by_algebra(own, printed, derived)
        theorem = _theorem(own, tree, last)
    except (BadInput, sympy.PolynomialError, RecursionError, TypeError):
        return None
    return "\n".join([*own.lemmas, theorem])


def _part(own: _Script, tree: Node, authors: bool) -> _CoqTerm:
    number = value_of(tree)
    if number is not None and not isinstance(tree, ast.BinOp):
        return _number(number)
    if isinstance(tree, ast.Name):
        return _named(own, tree.id, authors)
    if isinstance(tree, ast.UnaryOp):
        inner = _part(own, tree.operand, authors)
        return _CoqTerm(text=f"(- {inner.text})", value=-inner.value)
    if isinstance(tree, ast.Call):
        return _function(own, str(function_of(tree)), _part(own, tree.args[0], authors))
    if not isinstance(tree, ast.BinOp):
        raise BadInput("cases have no certificate")
    left = _part(own, tree.left, authors)
    if isinstance(tree.op, ast.Pow):
        return _power(own, left, _part(own, tree.right, authors))
    right = _part(own, tree.right, authors)
    text = f"({left.text} {_SIGNS[type(tree.op)]} {right.text})"
    if isinstance(tree.op, ast.Add):
        return _CoqTerm(text=text, value=left.value + right.value)
    if isinstance(tree.op, ast.Sub):
        return _CoqTerm(text=text, value=left.value - right.value)
    if isinstance(tree.op, ast.Mult):
        return _CoqTerm(text=text, value=left.value * right.value)
    _not_zero(own, right.value)
    return _CoqTerm(text=text, value=left.value / right.value)


def _number(number: Fraction) -> _CoqTerm:
    text = str(abs(number.numerator))
    text = text if number.denominator == 1 else f"({text} / {number.denominator})"
    return _CoqTerm(
        text=f"(- {text})" if number < 0 else text, value=sympy.Rational(number.numerator, number.denominator)
    )


def _named(own: _Script, key: str, authors: bool) -> _CoqTerm:
    theory, meant = own.question.theory, own.question.formula.letters
    entry = meant[key] if authors and key in meant else theory.tape.get(key)
    if authors and key in meant and isinstance(entry, ast.Name) and entry.id == key:
        authors, entry = False, theory.tape.get(key)
    name = _identifier(own, key, authors)
    if name not in own.names:
        if entry is None:
            own.names[name] = _letter(own, key)
        elif isinstance(entry, ast.expr):
            part = _part(own, entry, authors=False)
            own.definitions[name] = _raw(own, entry, authors=False)
            own.names[name] = part
        else:
            raise BadInput(f"{key} has no closed form")
    return own.names[name]


def _letter(own: _Script, key: str) -> _CoqTerm:
    if key == "pi":
        return _CoqTerm(text="PI", value=Symbol("PI", positive=True))
    if key in own.question.hold:
        return _number(Fraction(str(own.question.hold[key])))
    positive = own.question.theory.letters[key].positive
    if positive:
        own.suppose(f"0 < {key}_")
    return _CoqTerm(text=f"{key}_", value=Symbol(f"{key}_", real=True, positive=positive or None))


def _identifier(own: _Script, key: str, authors: bool) -> str:
    if authors and key in own.question.formula.letters:
        meant = own.question.formula.letters[key]
        if not (isinstance(meant, ast.Name) and meant.id == key):
            return f"own_{key}"
    return f"the_{key}" if key in own.question.theory.tape else f"{key}_"


def _raw(own: _Script, tree: Node, authors: bool) -> str:
    """A tree in Coq, node by node, names by name."""
    number = value_of(tree)
    if number is not None and not isinstance(tree, ast.BinOp):
        return _number(number).text
    if isinstance(tree, ast.Name):
        name = _identifier(own, tree.id, authors)
        return name if name in own.definitions else own.names[name].text
    if isinstance(tree, ast.UnaryOp):
        return f"(- {_raw(own, tree.operand, authors)})"
    if isinstance(tree, ast.Call):
        return f"({function_of(tree)} {_raw(own, tree.args[0], authors)})"
    assert isinstance(tree, ast.BinOp)
    left = _raw(own, tree.left, authors)
    if isinstance(tree.op, ast.Pow):
        return _power_text(left, value_of(tree.right), lambda: _raw(own, tree.right, authors))
    return f"({left} {_SIGNS[type(tree.op)]} {_raw(own, tree.right, authors)})"


def _is_half(exponent: Fraction | None) -> TypeGuard[Fraction]:
    return exponent is not None and exponent.denominator <= 2


def _power_text(base: str, exponent: Fraction | None, written: Callable[[], str]) -> str:
    if not _is_half(exponent):
        return f"(Rpower {base} {written()})"
    text = base if exponent.denominator == 1 else f"(sqrt {base})"
    text = f"({text} ^ {abs(exponent.numerator)})"
    return f"(/ {text})" if exponent < 0 else text


def _power(own: _Script, base: _CoqTerm, power: _CoqTerm) -> _CoqTerm:
    exponent = Fraction(int(power.value.p), int(power.value.q)) if power.value.is_Rational else None
    if not _is_half(exponent):
        return _real_power(own, base, power)
    if exponent.denominator == 2:
        base = _function(own, "sqrt", base)
    whole = Fraction(exponent.numerator)
    if whole < 0:
        _not_zero(own, base.value)
    return _CoqTerm(text=_power_text(base.text, whole, str), value=base.value ** int(whole))


def _real_power(own: _Script, base: _CoqTerm, power: _CoqTerm) -> _CoqTerm:
    # x^(n - 1) is x^n/x, and x^n a letter; of a product, the product of powers
    text = f"(Rpower {base.text} {power.text})"
    if text in own.functions:
        return own.functions[text]
    above, below = sympy.fraction(sympy.together(base.value))
    exponents = sympy.expand(power.value)
    if len(exponents.free_symbols) == 1:
        exponents = sympy.apart(sympy.together(power.value))
    value = Integer(1)
    for whole, sign in ((above, 1), (below, -1)):
        for factor, count in _prime_factors(whole):
            value *= _powers_of(own, factor, exponents * sign * count)
    plain = _coq(sympy.factor(base.value))
    named = "" if plain == base.text else f"replace {base.text} with {plain} by (field; nonzero); "
    own.prove(text, _coq(value), f"{named}logarithms")
    own.functions[text] = _CoqTerm(text=_coq(value), value=value)
    return own.functions[text]


def _prime_factors(product: Expr) -> Iterator[tuple[Expr, int]]:
    for factor in Mul.make_args(sympy.factor(product)):
        base, count = factor.as_base_exp()
        if base.is_Integer and base > 1:
            yield from ((Integer(p), k * int(count)) for p, k in sympy.factorint(base).items())
        elif base.is_number and base != 1 or not count.is_Integer:
            raise BadInput("a power of this has no place in a certificate")
        elif base != 1:
            yield base, int(count)


def _powers_of(own: _Script, base: Expr, exponent: Expr) -> Expr:
    if base in own.powers:
        base, inner = own.powers[base]
        exponent = sympy.expand(sympy.together(exponent * inner).cancel())
    if not base.is_positive:
        own.suppose(f"0 < {_coq(base)}")
    value = Integer(1)
    for kind, count in sympy.expand(exponent).as_coefficients_dict().items():
        if kind == 1 and count.is_Integer:
            value *= base**count
            continue
        kind = kind / count.q
        if any(not p.is_polynomial() or sympy.total_degree(p) > 1 for p in sympy.fraction(sympy.together(kind))):
            raise BadInput("powers of powers of this kind have no certificate")
        known = next((k for k, pair in own.powers.items() if pair == (base, kind)), None)
        if known is None:
            known = own.new("P", own.put(f"(Rpower {_coq(base)} {_coq(sympy.together(kind))})"))
            own.powers[known] = (base, kind)
            own.suppose(f"0 < {known}")
        value *= known**count.p
    return value


def _not_zero(own: _Script, value: Expr) -> None:
    above, below = sympy.fraction(sympy.together(value))
    for factor in _factors(sympy.factor(above)):
        if not factor.is_positive:
            own.suppose(f"{_coq(factor)} <> 0")


def _factors(product: Expr) -> list[Expr]:
    factors = [f.base if isinstance(f, Pow) else f for f in Mul.make_args(product)]
    return [f for f in factors if not f.is_number]


def _function(own: _Script, function: str, argument: _CoqTerm) -> _CoqTerm:
    text = f"({function} {argument.text})"
    if text not in own.functions:
        own.functions[text] = _evaluated(own, function, argument, text)
    return own.functions[text]


def _evaluated(own: _Script, function: str, argument: _CoqTerm, text: str) -> _CoqTerm:
    if function == "tan":
        sine, cosine = (_function(own, f, argument) for f in ("sin", "cos"))
        _not_zero(own, cosine.value)
        whole = _CoqTerm(text=f"({sine.text} / {cosine.text})", value=sine.value / cosine.value)
        own.prove(text, whole.text, f"unfold tan; {own.rewritten}; reflexivity")
        return whole
    if function in ("sin", "cos"):
        return _circular(own, function, argument, text)
    if function == "sqrt":
        return _root(own, argument, text)
    if function == "asin":
        own.suppose(f"-1 <= {argument.text} <= 1")
        angle = own.new("A", own.put(text))
        own.prove(f"(sin {text})", argument.text, "apply sin_asin; assumption")
        own.functions[f"(sin {angle})"] = argument
        inside = _CoqTerm(text=f"(1 - ({argument.text} ^ 2))", value=1 - argument.value**2)
        own.prove(f"(cos {text})", f"(sqrt {inside.text})", "apply cos_of_asin; assumption")
        own.functions[f"(cos {angle})"] = _function(own, "sqrt", inside)
        return _CoqTerm(text=str(angle), value=angle)
    raise BadInput(f"{function} has no place in a certificate")


def _circular(own: _Script, function: str, argument: _CoqTerm, text: str) -> _CoqTerm:
    terms = sympy.expand(argument.value).as_coefficients_dict()
    if len(terms) == 1 and next(iter(terms.values())) == 1 and next(iter(terms)).is_Symbol:
        return _of_letter(own, function, next(iter(terms)))
    if any(not k.is_Symbol or not v.is_Integer for k, v in terms.items()) or sum(map(abs, terms.values())) > _MULTIPLE:
        raise BadInput("a sine of this has no place in a certificate")
    parts = [(k, 1 if v > 0 else -1) for k, v in sorted(terms.items(), key=str) for _ in range(abs(int(v)))]
    added = " + ".join(f"{k}" if sign > 0 else f"(- {k})" for k, sign in parts)
    sine, cosine = Integer(0), Integer(1)
    for angle, sign in parts:
        s, c = (_of_letter(own, f, angle).value for f in ("sin", "cos"))
        sine, cosine = sine * c + cosine * sign * s, cosine * c - sine * sign * s
    value = sympy.expand(sine if function == "sin" else cosine)
    opened = "repeat first [ rewrite sin_plus | rewrite cos_plus | rewrite sin_neg | rewrite cos_neg ]"
    own.prove(
        text,
        _coq(value),
        f"replace {argument.text} with ({added}) by (field; nonzero); {opened}; {own.rewritten}; field; nonzero",
    )
    return _CoqTerm(text=_coq(value), value=value)


def _of_letter(own: _Script, function: str, angle: Symbol) -> _CoqTerm:
    key = f"({function} {angle})"
    if key not in own.functions:
        for f in ("sin", "cos"):
            letter = own.new(f[0], own.put(f"({f} {angle})"))
            own.functions[f"({f} {angle})"] = _CoqTerm(text=str(letter), value=letter)
        s, c = (own.functions[f"({f} {angle})"].value for f in ("sin", "cos"))
        own.relations.append(s**2 + c**2 - 1)
    return own.functions[key]


def _root(own: _Script, argument: _CoqTerm, text: str) -> _CoqTerm:
    # the square of what is positive is taken out, the sign stays inside
    above, below = sympy.fraction(sympy.together(argument.value))
    if not below.is_positive:
        raise BadInput("a root of a fraction of either sign has no certificate")
    content, factors = sympy.factor_list(_lowered(own, sympy.expand(above * below)))
    outside, inside, whole = Integer(1), Integer(1), Integer(1)
    if content > 0:
        factors = [*factors, *((Integer(p), k) for p, k in sympy.factorint(content).items())]
    else:
        inside = content
    for factor, power in factors:
        if factor.is_positive:
            outside *= factor ** (power // 2)
            whole *= _root_letter(own, factor) if power % 2 else 1
        else:
            inside *= factor**power
    inside = sympy.expand(inside)
    if inside != 1:
        root = sympy.sqrt(inside)
        whole *= root if root.is_rational_function() and root.is_nonnegative else _root_letter(own, inside)
    value = outside * whole / below
    result = _CoqTerm(text=_coq(value), value=value)
    if own.put(text) != own.put(result.text):
        number = len(own.steps)
        product = _CoqTerm(text=f"({result.text} * {result.text})", value=value * value)
        lemma = _lemma(own, f"{own.name}_root{number}", product, argument)
        own.prove(text, result.text, f"apply root_is; [ positive | {lemma} ]")
    return result


def _root_letter(own: _Script, square: Expr) -> Expr:
    key = f"(sqrt {_coq(square)})"
    if key not in own.functions:
        own.suppose(f"0 <= {_coq(square)}")
        letter = own.new("D", own.put(key))
        own.relations.append(letter**2 - square)
        own.functions[key] = _CoqTerm(text=str(letter), value=letter)
    return own.functions[key].value


def _lowered(own: _Script, polynomial: Expr) -> Expr:
    # c^2 as 1 - s^2
    for relation in own.relations:
        cosine = max(relation.free_symbols, key=lambda k: int(str(k)[1:]) if str(k)[0] == "c" else -1)
        if str(cosine)[0] == "c" and relation.has(cosine**2):
            polynomial = sympy.rem(polynomial, relation, cosine)
    return sympy.expand(polynomial)


def _by_algebra(own: _Script, printed: _CoqTerm, derived: _CoqTerm) -> str:
    return _lemma(own, f"{own.name}_algebra", printed, derived)


def _lemma(own: _Script, name: str, one: _CoqTerm, other: _CoqTerm) -> str:
    """A lemma of two rational expressions in letters, and how it is applied."""
    above, below = sympy.fraction(sympy.together(one.value - other.value))
    relations = own.relations
    order = [_symbol(k) for k in reversed(own.terms)]
    free = sorted(above.free_symbols.union(*(r.free_symbols for r in relations)) - set(order), key=str)
    cofactors: Sequence[Expr] = []
    if relations and sympy.expand(above) != 0:
        quotients, rest = sympy.reduced(sympy.expand(above), relations, *order, *free, order="lex")
        if rest != 0:
            raise BadInput("the difference does not reduce to nothing")
        cofactors = quotients
    elif sympy.expand(above) != 0:
        raise BadInput("the difference is not nothing")
    for factor in _factors(sympy.factor(below)):
        if not factor.is_positive:
            own.suppose(f"{_coq(factor)} <> 0")
    used = [(i, q, r) for i, (q, r) in enumerate(zip(cofactors, relations, strict=False)) if q != 0]
    combination = " + ".join(f"({_coq(q)}) * ({_coq(r)})" for _, q, r in used) or "0"
    conditions = list(own.hypotheses)
    told = " ".join([one.text, other.text, *map(_coq, relations), *conditions])
    letters = [k for k in dict.fromkeys(re.findall(r"\b(?:[A-Za-z]\w*_|[AscDP]\d+)\b", told))]
    named = [f"H{i}" for i in range(len(relations))] + [f"N{i}" for i in range(len(conditions))]
    own.lemmas.append(
        "\n".join(
            [
                f"Lemma {name} : forall {' '.join(letters) or 'unused'} : R,",
                *(f"  {_coq(r)} = 0 ->" for r in relations),
                *(f"  {c} ->" for c in conditions),
                f"  {one.text} = {other.text}.",
                f"Proof.\n  intros {' '.join([*letters, *named])}.",
                "  apply Rminus_diag_uniq.",
                f"  replace ({one.text} - {other.text}) with (({combination}) / ({_coq(below)})).",
                f"  - {''.join(f'rewrite H{i}; ' for i, _, _ in used)}unfold Rdiv; ring.\n  - field; nonzero.\nQed.",
            ]
        )
    )
    given = " ".join(own.terms.get(k, k) for k in letters)
    return f"apply ({name} {given}); first [ assumption | circles | lra ]"


def _theorem(own: _Script, tree: Node, last: str) -> str:
    printed = _raw(own, tree, authors=True)
    derived = f"the_{own.question.quantity}"
    lets = [f"  let {name} := {own_text} in" for name, own_text in own.definitions.items()]
    conditions = [own.put(c) for c in own.hypotheses]
    everything = " ".join([printed, *lets, *conditions])
    letters = [k for k in dict.fromkeys(re.findall(r"\b\w+_\b", everything)) if not k.startswith(("the_", "own_"))]
    named = " ".join(f"N{i}" for i in range(len(conditions)))
    return "\n".join(
        [
            f"Theorem {own.name} : forall {' '.join(letters) or 'unused'} : R,",
            *(f"  {c} ->" for c in conditions),
            *lets,
            f"  {printed} = {derived}.",
            f"Proof.\n  intros {' '.join(letters) or 'unused'} {named}; cbv zeta.",
            *(own.put(step) for step in own.steps),
            f"  {own.put(last)}.\nQed.\n",
        ]
    )


def _coq(e: Expr) -> str:
    if e.is_Symbol:
        return str(e)
    if e.is_Rational:
        return _number(Fraction(int(e.p), int(e.q))).text
    if e.is_Add:
        first, *rest = (_coq(a) for a in sorted(e.args, key=lambda a: (a.could_extract_minus_sign(), str(a))))
        return "(" + first + "".join(f" - {r[3:-1]}" if r.startswith("(- ") else f" + {r}" for r in rest) + ")"
    if e.is_Mul and e.could_extract_minus_sign():
        return f"(- {_coq(-e)})"
    if e.is_Mul:
        above, below = ([a for a in e.args if _is_below(a) is side] for side in (False, True))
        top = " * ".join(map(_coq, above)) or "1"
        return f"({top} / {_coq(Mul(*(1 / a for a in below)))})" if below else f"({top})"
    if _is_below(e):
        return f"(1 / {_coq(1 / e)})"
    if isinstance(e, Pow) and e.exp.is_Integer:
        return f"({_coq(e.base)} ^ {int(e.exp)})"
    raise BadInput(f"{e} has no place in a certificate")


def _is_below(e: Expr) -> bool:
    return isinstance(e, Pow) and bool(e.exp.is_Integer and e.exp < 0)
