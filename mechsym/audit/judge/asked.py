"""A formula with everything that its author says and assumes of it, and the question that it raises."""

import ast
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from mechsym.audit.judge.left_side import name_alone, refuse_left, refuse_sameness, with_left
from mechsym.audit.judge.question import Question, require_possible
from mechsym.audit.read.letter import ASKED, WAYS, Way
from mechsym.audit.read.reader import (
    CONSTANTS,
    AnyLetter,
    Formula,
    joined,
    letter_pairs,
    read,
    read_expression,
)
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.statement import Statement
from mechsym.audit.read.tree import Node, is_operation, letters, value_of
from mechsym.audit.theory.catalogue import named, target
from mechsym.audit.theory.record import Theory, check_sums, dependencies, known, need_result
from mechsym.audit.theory.tape import retaped
from mechsym.errors import BadInput
from mechsym.quantities import record


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
        refuse_left(theory, quantity, said.left, formula)
    check_sums(theory, formula.tree)
    under = assumed(theory, asked.assume, formula.letters)
    theory, quantity = with_left(under.theory, quantity, said.left, formula)
    refuse_sameness(theory, quantity, asked.quantity, formula)
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
    told = {plain: k for k in said.letters if k not in pairs and (plain := name_alone(k))}
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
