r"""Coq scripts of exact verdicts: another kernel checks the printed formula itself against the declared geometry.

The theorem holds the formula as printed, node by node in its author's names, and the definitions of the theory, such as
`beta := asin (lam * sin phi)`. Its proof takes the functions in turn, the innermost first: the sine of a sum by sines
of its parts, a root by what it is the root of, the sine of an arcsine by its argument. What is left is rational in
letters, sines, cosines, roots; sympy guesses the cofactors of s^2 + c^2 - 1 and D^2 - radicand, with which `ring` and
`field` prove it.
"""

import ast
import re
from collections.abc import Sequence
from fractions import Fraction

import sympy
from sympy import Expr, Integer, Symbol

from mechsym.audit.judge.coq import (
    CoqTerm,
    Script,
    bases,
    coq_text,
    is_half,
    lowered,
    not_zero,
    power_text,
    prime_factors,
    rational,
    symbol,
)
from mechsym.audit.judge.question import Question
from mechsym.audit.read.tree import Node, function_of, value_of
from mechsym.errors import BadInput

_MOST = 1500  # operations, beyond which ring takes minutes
_MULTIPLE = 8  # of an angle
_UNOPENED = ("exp", "log", "acos", "atan")
_SIGNS: dict[type, str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}


def script(question: Question, tree: Node, name: str) -> str | None:
    """Lemmas and theorem of one exact formula in Coq; None where it has no such certificate."""
    own = Script(question=question, name=name)
    try:
        printed = _part(own, tree, authors=True)
        derived = _named(own, question.quantity, authors=False)
        if printed.value.count_ops() + derived.value.count_ops() > _MOST:
            return None
        last = _lemma(own, f"{name}_algebra", printed, derived)
        theorem = _theorem(own, tree, last)
    except (BadInput, sympy.PolynomialError, RecursionError, TypeError):
        return None
    return "\n".join([*own.lemmas, theorem])


def _part(own: Script, tree: Node, authors: bool) -> CoqTerm:
    value = value_of(tree)
    if value is not None and not isinstance(tree, ast.BinOp):
        return rational(value)
    if isinstance(tree, ast.Name):
        return _named(own, tree.id, authors)
    if isinstance(tree, ast.UnaryOp):
        inner = _part(own, tree.operand, authors)
        return CoqTerm(text=f"(- {inner.text})", value=-inner.value)
    if isinstance(tree, ast.Call):
        return _function(own, str(function_of(tree)), _part(own, tree.args[0], authors))
    if not isinstance(tree, ast.BinOp):
        raise BadInput("cases have no certificate")
    left = _part(own, tree.left, authors)
    if isinstance(tree.op, ast.Pow):
        base = left
        power = _part(own, tree.right, authors)
        exponent = Fraction(int(power.value.p), int(power.value.q)) if power.value.is_Rational else None
        if not is_half(exponent):
            return _real_power(own, base, power)
        if exponent.denominator == 2:
            base = _function(own, "sqrt", base)
        whole = Fraction(exponent.numerator)
        if whole < 0:
            not_zero(own, base.value)
        return CoqTerm(text=power_text(base.text, whole, str), value=base.value ** int(whole))
    right = _part(own, tree.right, authors)
    text = f"({left.text} {_SIGNS[type(tree.op)]} {right.text})"
    if isinstance(tree.op, ast.Add):
        return CoqTerm(text=text, value=left.value + right.value)
    if isinstance(tree.op, ast.Sub):
        return CoqTerm(text=text, value=left.value - right.value)
    if isinstance(tree.op, ast.Mult):
        return CoqTerm(text=text, value=left.value * right.value)
    not_zero(own, right.value)
    return CoqTerm(text=text, value=left.value / right.value)


def _named(own: Script, key: str, authors: bool) -> CoqTerm:
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


def _letter(own: Script, key: str) -> CoqTerm:
    if key == "pi":
        return CoqTerm(text="PI", value=Symbol("PI", positive=True))
    if key in own.question.hold:
        return rational(Fraction(str(own.question.hold[key])))
    positive = own.question.theory.letters[key].positive
    if positive:
        own.suppose(f"0 < {key}_")
    return CoqTerm(text=f"{key}_", value=Symbol(f"{key}_", real=True, positive=positive or None))


def _identifier(own: Script, key: str, authors: bool) -> str:
    if authors and key in own.question.formula.letters:
        meant = own.question.formula.letters[key]
        if not (isinstance(meant, ast.Name) and meant.id == key):
            return f"own_{key}"
    return f"the_{key}" if key in own.question.theory.tape else f"{key}_"


def _raw(own: Script, tree: Node, authors: bool) -> str:
    """A tree in Coq, node by node, names by name."""
    value = value_of(tree)
    if value is not None and not isinstance(tree, ast.BinOp):
        return rational(value).text
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
        return power_text(left, value_of(tree.right), lambda: _raw(own, tree.right, authors))
    return f"({left} {_SIGNS[type(tree.op)]} {_raw(own, tree.right, authors)})"


def _real_power(own: Script, base: CoqTerm, power: CoqTerm) -> CoqTerm:
    # x^(n - 1) is x^n/x, and x^n a letter; of a product, the product of powers
    text = f"(Rpower {base.text} {power.text})"
    if text in own.functions:
        return own.functions[text]
    above, below = sympy.fraction(sympy.together(base.value))
    exponents = sympy.expand(power.value)
    if len(exponents.free_symbols) == 1:
        exponents = sympy.apart(sympy.together(power.value))
    value, primes = Integer(1), []
    for whole, sign in ((above, 1), (below, -1)):
        factors = list(prime_factors(whole))
        for factor, count in factors:
            value *= _powers_of(own, factor, exponents * sign * count)
        primes.append(" * ".join(f"({coq_text(factor)} ^ {count})" for factor, count in factors) or "1")
    plain = f"({' / '.join(f'({product})' for product in primes)})"
    named = "" if plain == base.text else f"replace {base.text} with {plain} by (field; nonzero); "
    own.prove(text, coq_text(value), f"{named}logarithms")
    own.functions[text] = CoqTerm(text=coq_text(value), value=value)
    return own.functions[text]


def _powers_of(own: Script, base: Expr, exponent: Expr) -> Expr:
    if base in own.powers:
        base, inner = own.powers[base]
        exponent = sympy.expand(sympy.together(exponent * inner).cancel())
    if not base.is_positive:
        own.suppose(f"0 < {coq_text(base)}")
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
            known = own.new("P", own.put(f"(Rpower {coq_text(base)} {coq_text(sympy.together(kind))})"))
            own.powers[known] = (base, kind)
            own.suppose(f"0 < {known}")
            if kind.is_Rational:
                own.relations.append(known**kind.q - base**kind.p)
        value *= known**count.p
    return value


def _function(own: Script, function: str, argument: CoqTerm) -> CoqTerm:
    text = f"({function} {argument.text})"
    if text not in own.functions:
        own.functions[text] = _evaluated(own, function, argument, text)
    return own.functions[text]


def _evaluated(own: Script, function: str, argument: CoqTerm, text: str) -> CoqTerm:
    if function == "tan":
        sine, cosine = (_function(own, f, argument) for f in ("sin", "cos"))
        not_zero(own, cosine.value)
        whole = CoqTerm(text=f"({sine.text} / {cosine.text})", value=sine.value / cosine.value)
        own.prove(text, whole.text, f"unfold tan; {own.rewritten}; reflexivity")
        return whole
    if function in ("sin", "cos"):
        return _circular(own, function, argument, text)
    if function == "sqrt":
        return _root(own, argument, text)
    if function == "asin":
        for value, known in own.angles:
            if sympy.cancel(value - argument.value) == 0:
                own.prove(text, own.terms[known.text], "f_equal; field; nonzero")
                return known
        own.suppose(f"-1 <= {argument.text} <= 1")
        angle = own.new("A", own.put(text))
        own.angles.append((argument.value, CoqTerm(text=str(angle), value=angle)))
        own.prove(f"(sin {text})", argument.text, "apply sin_asin; assumption")
        own.functions[f"(sin {angle})"] = argument
        inside = CoqTerm(text=f"(1 - ({argument.text} ^ 2))", value=1 - argument.value**2)
        own.prove(f"(cos {text})", f"(sqrt {inside.text})", "apply cos_of_asin; assumption")
        own.functions[f"(cos {angle})"] = _function(own, "sqrt", inside)
        return CoqTerm(text=str(angle), value=angle)
    if function not in _UNOPENED:
        raise BadInput(f"{function} has no place in a certificate")
    return _unopened(own, function, argument, text)


def _unopened(own: Script, function: str, argument: CoqTerm, text: str) -> CoqTerm:
    # of which nothing is known but that it is the same of the same: exp of a product, the sine of a quotient
    for kind, value, known in own.unopened:
        if kind == function and sympy.cancel(value - argument.value) == 0:
            own.prove(text, own.terms[known.text], "f_equal; field; nonzero")
            return known
    letter = own.new("E", own.put(text))
    own.unopened.append((function, argument.value, CoqTerm(text=str(letter), value=letter)))
    return own.unopened[-1][2]


def _circular(own: Script, function: str, argument: CoqTerm, text: str) -> CoqTerm:
    terms = sympy.expand(argument.value).as_coefficients_dict()
    if len(terms) == 1 and next(iter(terms.values())) == 1 and next(iter(terms)).is_Symbol:
        return _same(own, function, next(iter(terms)), text)
    if any(not k.is_Symbol or not v.is_Integer for k, v in terms.items()) or sum(map(abs, terms.values())) > _MULTIPLE:
        angle = _unopened(own, "angle", argument, argument.text)
        return _same(own, function, angle.value, text)
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
        coq_text(value),
        f"replace {argument.text} with ({added}) by (field; nonzero); {opened}; {own.rewritten}; field; nonzero",
    )
    return CoqTerm(text=coq_text(value), value=value)


def _same(own: Script, function: str, angle: Symbol, text: str) -> CoqTerm:
    # of an angle that is a letter in the end
    own.prove(text, own.put(f"({function} {angle})"), "f_equal; field; nonzero")
    return _of_letter(own, function, angle)


def _of_letter(own: Script, function: str, angle: Symbol) -> CoqTerm:
    key = f"({function} {angle})"
    if key not in own.functions:
        for f in ("sin", "cos"):
            letter = own.new(f[0], own.put(f"({f} {angle})"))
            own.functions[f"({f} {angle})"] = CoqTerm(text=str(letter), value=letter)
        s, c = (own.functions[f"({f} {angle})"].value for f in ("sin", "cos"))
        own.relations.append(s**2 + c**2 - 1)
    return own.functions[key]


def _root(own: Script, argument: CoqTerm, text: str) -> CoqTerm:
    # the square of what is positive is taken out, the sign stays inside
    above, below = sympy.fraction(sympy.together(argument.value))
    if not below.is_positive:
        raise BadInput("a root of a fraction of either sign has no certificate")
    content, factors = sympy.factor_list(lowered(own, sympy.expand(above * below)))
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
    result = CoqTerm(text=coq_text(value), value=value)
    if own.put(text) != own.put(result.text):
        number = len(own.steps)
        product = CoqTerm(text=f"({result.text} * {result.text})", value=value * value)
        lemma = _lemma(own, f"{own.name}_root{number}", product, argument)
        own.prove(text, result.text, f"apply root_is; [ positive | {lemma} ]")
    return result


def _root_letter(own: Script, square: Expr) -> Expr:
    key = f"(sqrt {coq_text(square)})"
    if key not in own.functions:
        own.suppose(f"0 <= {coq_text(square)}")
        letter = own.new("D", own.put(key))
        own.relations.append(letter**2 - square)
        own.functions[key] = CoqTerm(text=str(letter), value=letter)
    return own.functions[key].value


def _lemma(own: Script, name: str, one: CoqTerm, other: CoqTerm) -> str:
    """A lemma of two rational expressions in letters, and how it is applied."""
    above, below = sympy.fraction(sympy.together(one.value - other.value))
    relations = own.relations
    order = [symbol(k) for k in reversed(own.terms)]
    free = sorted(above.free_symbols.union(*(r.free_symbols for r in relations)) - set(order), key=str)
    cofactors: Sequence[Expr] = []
    if relations and sympy.expand(above) != 0:
        quotients, rest = sympy.reduced(sympy.expand(above), relations, *order, *free, order="lex")
        if rest != 0:
            raise BadInput("the difference does not reduce to nothing")
        cofactors = quotients
    elif sympy.expand(above) != 0:
        raise BadInput("the difference is not nothing")
    for factor in bases(sympy.factor(below)):
        if not factor.is_positive:
            own.suppose(f"{coq_text(factor)} <> 0")
    used = [(i, q, r) for i, (q, r) in enumerate(zip(cofactors, relations, strict=False)) if q != 0]
    combination = " + ".join(f"({coq_text(q)}) * ({coq_text(r)})" for _, q, r in used) or "0"
    conditions = list(own.hypotheses)
    proof = " ".join([one.text, other.text, *map(coq_text, relations), *conditions])
    letters = [k for k in dict.fromkeys(re.findall(r"\b(?:[A-Za-z]\w*_|[AEscDP]\d+)\b", proof))]
    named = [f"H{i}" for i in range(len(relations))] + [f"N{i}" for i in range(len(conditions))]
    own.lemmas.append(
        "\n".join(
            [
                f"Lemma {name} : forall {' '.join(letters) or 'unused'} : R,",
                *(f"  {coq_text(r)} = 0 ->" for r in relations),
                *(f"  {c} ->" for c in conditions),
                f"  {one.text} = {other.text}.",
                f"Proof.\n  intros {' '.join([*letters, *named])}.",
                *(
                    f"  assert ({coq_text(sympy.expand(d))} <> 0) by "
                    f"(replace {coq_text(sympy.expand(d))} with {coq_text(d)} by ring; product)."
                    for d in own.divisors
                    if {str(k) for k in d.free_symbols} <= set(letters)
                ),
                "  apply Rminus_diag_uniq.",
                f"  replace ({one.text} - {other.text}) with (({combination}) / ({coq_text(below)})).",
                f"  - {''.join(f'rewrite H{i}; ' for i, _, _ in used)}unfold Rdiv; ring.\n  - field; nonzero.\nQed.",
            ]
        )
    )
    given = " ".join(own.terms.get(k, k) for k in letters)
    return f"apply ({name} {given}); first [ assumption | circles | lra ]"


def _theorem(own: Script, tree: Node, last: str) -> str:
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
