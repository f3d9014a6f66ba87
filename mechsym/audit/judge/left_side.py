"""What stands on the left of a formula: the quantity, a name of it, or one side of a law."""

import ast
import re
from dataclasses import replace

import numpy as np

from mechsym.audit.judge.dimensions import kind_of, kind_of_unit
from mechsym.audit.judge.question import Question
from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.printed import differential
from mechsym.audit.read.reader import CONSTANTS, RESERVED, AnyLetter, Formula, read_expression
from mechsym.audit.read.slopes import slope_in
from mechsym.audit.read.spelling import resolve, to_python
from mechsym.audit.read.tree import Node, is_operation, letters, substitute
from mechsym.audit.read.tree import name as name_of
from mechsym.audit.theory.record import Theory, dependencies, known
from mechsym.audit.theory.tape import TheoryTape, retaped
from mechsym.errors import BadInput

_IDENTITY = "left_side"  # name of the quantity that the left side of a law is


def name_alone(text: str) -> str:
    """The name that a text is; empty where it is anything else."""
    try:
        tree = read_expression(text, (), AnyLetter())[0] if text else None
    except BadInput:
        return ""
    return tree.id if isinstance(tree, ast.Name) else ""


def refuse_left(theory: Theory, quantity: str, left: str, formula: Formula) -> None:
    """Refuse a left side that gives a datum or a function another meaning; a law between both sides may stand."""
    written = differential(left) or name_alone(left)
    if not written or written == quantity:
        return
    way_out = f"write '{quantity} = ..', or the right side alone"
    meant = formula.letters.get(written)
    slope = slope_in(written)
    if slope and slope.of == quantity or re.fullmatch(rf"{quantity}(?:d|prime)+", written):
        raise BadInput(
            f"'{left} = ..' is a derivative of {quantity}, and it is to be compared with {quantity}; {way_out}"
        )
    if meant is None:
        datum = resolve(written, theory.letters) if written not in theory.tape else None
        # F = .. of an inertia force, where the theory's F is a force too
        read_there = {n for k in letters(formula.tree) for n in (k, *letters(formula.letters.get(k, name_of(k))))}
        if datum and read_there and datum not in read_there:
            if kind_of_unit(theory.letters[datum].unit) == kind_of(theory, name_of(quantity)):
                return
        if datum or written in RESERVED:
            kind = f"a letter of {theory.name}" if datum else "a constant or a function"
            raise BadInput(f"'{left} = ..': {datum or written} is {kind} already and cannot be redefined; {way_out}")
    elif all(name in theory.letters for name in letters(meant)):
        raise BadInput(f"'{left} = ..': {left} is {to_python(meant)} already, by --letters; {way_out}")


def with_left(theory: Theory, quantity: str, left: str, formula: Formula) -> tuple[Theory, str]:
    """The theory and the quantity of it that the right side is compared with: of a law, l*sin(beta) = r*sin(phi), its
    left side."""
    if not left:
        return theory, quantity
    try:
        tree = read_expression(left, [*formula.letters, *known(theory), *CONSTANTS], theory.tape)[0]
    except BadInput:
        if name_alone(left) or _is_name(left):
            return theory, quantity
        tree = _of_one_unknown(left, theory, quantity, formula)
    if isinstance(tree, ast.Name) and isinstance(formula.letters.get(tree.id, tree), ast.Name):
        return theory, quantity
    meant = {m for n in letters(tree) for m in letters(formula.letters.get(n, ast.Name(n, ast.Load())))}
    if not meant & {quantity, *dependencies(theory, [quantity])}:
        raise BadInput(f"the left side {left[:40]!r} has nothing of {quantity}; write '{quantity} = expression'")
    tape = theory.tape.base if isinstance(theory.tape, TheoryTape) else dict(theory.tape)
    own = {k: t for k, t in formula.letters.items() if k not in theory.letters and k not in tape}
    whole = retaped(theory.tape, {**own, _IDENTITY: tree}, theory.letters, theory.angle)
    return replace(theory, tape=whole), _IDENTITY


_NAMES = re.compile(
    r"\\(?:mathrm|operatorname|text)\s*\{\w{2,}\}.*|(\\(?:delta|partial|mathrm\{d\})|[dδ∂])\s*\w+\s*(/.*)?"
)


def _is_name(left: str) -> bool:
    # inv α and δQ/dθ only name what is given
    bare = re.sub(r"\\[dt]?frac\s*\{(.*?)\}\s*\{(.*)\}", r"\1/\2", left.strip(" $"))
    word = re.fullmatch(r"([A-Za-z]{3,})\s+\\?\w+", bare)
    return bool(_NAMES.fullmatch(bare) or word and word[1].lower() not in RESERVED)


def _of_one_unknown(left: str, theory: Theory, quantity: str, formula: Formula) -> Node:
    # tan μ = .. and T/(F r) = ..: the one letter that nothing tells of is the quantity; Sp/Sm of none is its name
    letters_known = [*formula.letters, *known(theory), *CONSTANTS]
    tree = read_expression(left, letters_known, AnyLetter())[0]
    unknown = [n for n in letters(tree) if n not in letters_known and n not in theory.tape]
    if (
        len(unknown) == 2
        and is_operation(tree, ast.Div)
        and all(isinstance(n, ast.Name) for n in (tree.left, tree.right))
    ):
        return name_of(quantity)
    if len(unknown) != 1:
        return read_expression(left, letters_known, theory.tape)[0]
    return substitute(tree, lambda n: name_of(quantity) if isinstance(n, ast.Name) and n.id == unknown[0] else None)


def refuse_sameness(theory: Theory, side: str, quantity: str, formula: Formula) -> None:
    """Refuse x = x and x = r - r + x, which hold of anything: what the letters stand for is not asked."""
    right = substitute(formula.tree, lambda n: formula.letters.get(n.id) if isinstance(n, ast.Name) else None)
    if quantity not in letters(right):
        return
    law = theory.tape[side] if side == _IDENTITY else None
    lead = law if isinstance(law, ast.expr) else name_of(quantity)
    lead = substitute(lead, lambda n: formula.letters.get(n.id) if isinstance(n, ast.Name) else None)
    rng = np.random.default_rng(1)
    values = {k: rng.uniform(-6, 6, 8) for k in sorted({*letters(lead), *letters(right)} - {"pi"})} | {"pi": np.pi}
    with np.errstate(all="ignore"):
        sides = evaluate(lead, values, FLOATS), evaluate(right, values, FLOATS)
    if np.allclose(sides[0], sides[1], rtol=1e-12, atol=0):
        raise BadInput(f"both sides say {quantity}, whatever it is; write one of them in other letters")


def left_note(question: Question, quantity: str, left: str) -> str:
    """What became of a left side, where it is not the quantity itself."""
    if not left:
        return ""
    if question.quantity.startswith(_IDENTITY):
        return f"a law: its left side {left} is compared with its right side"
    own = {k: t for k, t in question.formula.letters.items() if isinstance(t, ast.Name)}
    try:
        tree = read_expression(left, [*own, *known(question.theory)], question.theory.tape)[0]
    except BadInput:
        return ""
    meant = own.get(tree.id, tree) if isinstance(tree, ast.Name) else tree
    if isinstance(meant, ast.Name) and meant.id != quantity and meant.id in question.theory.tape:
        return f"its left side names {meant.id}, and it is compared with {quantity}"
    return ""
