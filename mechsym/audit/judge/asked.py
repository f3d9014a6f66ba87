"""A formula with everything that its author says and assumes of it, and the question that it raises."""

import ast
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

import numpy as np

from mechsym.audit.judge.dimensions import kind_of, kind_of_unit
from mechsym.audit.judge.question import Question, require_possible
from mechsym.audit.read.algebra import FLOATS, evaluate
from mechsym.audit.read.letter import ASKED, WAYS, Way
from mechsym.audit.read.printed import differential
from mechsym.audit.read.reader import (
    CONSTANTS,
    RESERVED,
    AnyLetter,
    Formula,
    joined,
    letter_pairs,
    read,
    read_expression,
)
from mechsym.audit.read.spelling import resolve, to_python
from mechsym.audit.read.statement import Statement
from mechsym.audit.read.tree import Node, is_operation, letters, substitute, value_of
from mechsym.audit.read.tree import name as name_of
from mechsym.audit.theory.catalogue import named, target
from mechsym.audit.theory.record import Theory, check_sums, dependencies, known, need_result
from mechsym.audit.theory.tape import TheoryTape, retaped
from mechsym.errors import BadInput
from mechsym.quantities import record

_IDENTITY = "left_side"  # name of the quantity that the left side of a law is


@record
class Asked:
    """A formula and everything that its author says of it."""

    text: str
    against: str  #: What it claims to be
    letters: str | Mapping[str, str] = ""
    case: str = ""
    name: str = ""
    assume: str | Sequence[str] = ""
    claim: str = ""
    convention: str = ""
    theory: str = ""  #: TOML file that declares the theory
    given: Theory | None = None  #: The theory itself, where it is at hand
    #: What an author's letter that is one of the theory's, too, comes to: a program cannot be told to rename its own
    hidden: str = "refused"
    way: Way = ASKED

    @property
    def pairs(self) -> dict[str, str]:
        """The author's letters with their meanings."""
        return letter_pairs(self.letters) if isinstance(self.letters, str) else dict(self.letters)

    @property
    def quantity(self) -> str:
        """The quantity that the formula claims to be."""
        return target(self.against)[1]


def question_of(asked: Asked, said: Statement) -> Question:
    """The question that a user asks; letters that are zero in the case and not in the formula stay zero."""
    name, quantity = target(asked.against)
    if not name:
        raise BadInput(f"--against {asked.against!r} is not THEORY.QUANTITY, as slider_crank.x, nor ./FILE.py:QUANTITY")
    theory = asked.given or named(name, asked.case, asked.theory)
    need_result(theory, quantity)
    pairs = asked.pairs | _used_beside(said, asked.pairs, known(theory))
    formula = read(said.right[0], known(theory), pairs, theory.tape, asked.way)
    if asked.hidden == "refused":
        _refuse_letters(theory, formula)
        _refuse_left(theory, quantity, said.left, formula)
    check_sums(theory, formula.tree)
    under = assumed(theory, asked.assume, formula.letters)
    theory, quantity = _with_left(under.theory, quantity, said.left, formula)
    _refuse_sameness(theory, quantity, asked.quantity, formula)
    used = {n for tree in (formula.tree, *formula.letters.values()) for n in letters(tree)}
    needed = dependencies(theory, [quantity])
    zero = [k for k, letter in theory.letters.items() if letter.value == 0 and k in needed and k != theory.angle]
    hold = {k: 0.0 for k in zero if k not in used} | dict(under.hold)
    formula = replace(formula, note=joined(formula.note, said.note))
    question = Question(formula=formula, theory=theory, quantity=quantity, hold=hold, where=under.where)
    require_possible(question)
    return question


def _used_beside(said: Statement, pairs: Mapping[str, str], letters_known: Sequence[str]) -> dict[str, str]:
    # of the letters that are told beside a formula those that it needs and that have no meaning yet
    told = {plain: k for k in said.letters if k not in pairs and (plain := _name_alone(k))}
    used: dict[str, str] = {}
    waiting = [said.left, *said.right]
    while told and waiting:
        try:
            tree = read_expression(waiting.pop(), [*told, *pairs, *letters_known], AnyLetter(), WAYS[0])[0]
        except BadInput:
            continue
        needed = [told.pop(plain) for plain in letters(tree) if plain in told]
        used |= {k: said.letters[k] for k in needed}
        waiting += [said.letters[k] for k in needed]
    return used


def left_note(question: Question, asked: Asked, left: str) -> str:
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
    if isinstance(meant, ast.Name) and meant.id != asked.quantity and meant.id in question.theory.tape:
        return f"its left side names {meant.id}, and it is compared with {asked.quantity}"
    return ""


def _with_left(theory: Theory, quantity: str, left: str, formula: Formula) -> tuple[Theory, str]:
    # l*sin(beta) = r*sin(phi) is a law: its sides are compared with each other
    if not left:
        return theory, quantity
    try:
        tree = read_expression(left, [*formula.letters, *known(theory), *CONSTANTS], theory.tape)[0]
    except BadInput:
        if _name_alone(left) or _is_name(left):
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


def _name_alone(text: str) -> str:
    # the name that a text is; empty where it is anything else
    try:
        tree = read_expression(text, (), AnyLetter())[0] if text else None
    except BadInput:
        return ""
    return tree.id if isinstance(tree, ast.Name) else ""


def _refuse_letters(theory: Theory, formula: Formula) -> None:
    printed = letters(formula.tree)
    for letter, meant in formula.letters.items():
        # an author's F may be the derived total force and r his r1 + r2, but no datum may become an expression, and no
        # two letters of his one of the theory's
        renamed = isinstance(meant, ast.Name) and (
            meant.id in theory.tape or meant.id == letter or meant.id not in printed or meant.id in formula.letters
        )
        if letter in theory.letters and not renamed and not _in_another_unit(letter, meant):
            raise BadInput(
                f"--letters '{letter}={to_python(meant)}': {letter} is a letter of {theory.name} already; write "
                f"another letter for it in the formula, for example {letter}_own, and --letters '{letter}_own=..'"
            )


def _in_another_unit(letter: str, meant: Node) -> bool:
    # p = p/1000: the same letter, in kPa
    if not is_operation(meant, ast.Mult, ast.Div):
        return False
    return {letter} == {*letters(meant)} and any(value_of(n) for n in (meant.left, meant.right))


def _refuse_left(theory: Theory, quantity: str, left: str, formula: Formula) -> None:
    # a datum or a function gets no other meaning; a law between both sides may stand
    written = differential(left) or _name_alone(left)
    if not written or written == quantity:
        return
    way_out = f"write '{quantity} = ..', or the right side alone"
    meant = formula.letters.get(written)
    if re.fullmatch(rf"d2?{quantity}_d\w+|{quantity}(?:d|prime)+", written):
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


def _refuse_sameness(theory: Theory, side: str, quantity: str, formula: Formula) -> None:
    # x = x and x = r - r + x hold of anything: what the letters stand for is not asked
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


_RELATION = re.compile(r"(<=|>=|<|>|=|\\leq?|\\geq?|\\ll|\\gg|≤|≥)")
_LESS = ("<", "<=", "≤", "\\le", "\\leq", "\\ll")


@record
class Assumed:
    """A theory under assumptions."""

    theory: Theory
    hold: Mapping[str, float]  #: Letters with a fixed value
    where: tuple[ast.Compare, ...]


def assumed(theory: Theory, text: str | Sequence[str], own: Mapping[str, Node]) -> Assumed:
    """Read assumptions such as `phidd = 0, r < l, CR = 1 + V_d/V_c`; the author's letters may stand in them."""
    hold: dict[str, float] = {}
    where: list[ast.Compare] = []
    parts = re.split(r"[,;]", text) if isinstance(text, str) else list(text)
    for part in filter(None, (p.strip() for p in parts)):
        sides = _RELATION.split(part)
        if len(sides) != 3 or not sides[0].strip() or not sides[2].strip():
            raise BadInput(f"--assume {part!r} is no relation; write for example 'phidd = 0, r < l, CR = 1 + V_d/V_c'")
        left, right = (_side(theory, s, own, part) for s in (sides[0], sides[2]))
        if sides[1] != "=":
            sign = ast.Lt() if sides[1] in _LESS else ast.Gt()
            where.append(ast.Compare(left=left, ops=[sign], comparators=[right]))
            continue
        letter = _letter(theory, left, own, part)
        value = value_of(right)
        if value is not None:
            about = theory.letters[letter]
            low, high = about.domain or (0.0 if about.positive else -math.inf, math.inf)
            if not low <= float(Fraction(value)) <= high:
                raise BadInput(f"--assume {part!r}: {letter} of {theory.name} lies between {low:g} and {high:g}")
            if hold.setdefault(letter, float(Fraction(value))) != float(Fraction(value)):
                raise BadInput(f"--assume {part!r}: {letter} = {hold[letter]:g} is assumed already; keep one of them")
        else:
            free = {k: v for k, v in theory.letters.items() if k != letter}
            unknown = set(letters(right)) - {*free, *theory.tape, *CONSTANTS}
            if letter in letters(right) or unknown:
                raise BadInput(f"--assume {part!r}: {letter} must be given by the other letters of {theory.name}")
            units = {**theory.units, letter: theory.letters[letter].unit}
            angle = "" if letter == theory.angle else theory.angle  # which turns no more
            tape = retaped(theory.tape, {letter: right}, free, angle)
            theory = replace(theory, letters=free, tape=tape, units=units, angle=angle)
    return Assumed(theory=theory, hold=hold, where=tuple(where))


def _side(theory: Theory, text: str, own: Mapping[str, Node], part: str) -> Node:
    try:
        return read_expression(text, [*own, *theory.letters, *theory.tape, *CONSTANTS], theory.tape)[0]
    except BadInput as error:
        raise BadInput(f"--assume {part!r}: {error}") from None


def _letter(theory: Theory, left: Node, own: Mapping[str, Node], part: str) -> str:
    meant = own.get(left.id, left) if isinstance(left, ast.Name) else left
    if isinstance(meant, ast.Name) and meant.id in theory.letters:
        return meant.id
    free = ", ".join(theory.letters)
    raise BadInput(f"--assume {part!r}: the left side of = must be one free letter; those of {theory.name} are {free}")
