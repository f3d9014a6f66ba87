"""What a question takes for granted: letters that vanish or hang together, relations that every state keeps."""

import ast
import re
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from mechsym.audit.reader import CONSTANTS, read_expression
from mechsym.audit.theory.record import Theory
from mechsym.audit.theory.tape import retaped
from mechsym.audit.tree import Node, letters, value_of
from mechsym.errors import BadInput
from mechsym.quantities import record

_RELATION = re.compile(r"(<=|>=|<|>|=|\\leq?|\\geq?|\\ll|\\gg|≤|≥)")
_SIGNS: dict[str, type[ast.cmpop]] = {
    "<": ast.Lt, "<=": ast.Lt, "≤": ast.Lt, "\\le": ast.Lt, "\\leq": ast.Lt, "\\ll": ast.Lt,
    ">": ast.Gt, ">=": ast.Gt, "≥": ast.Gt, "\\ge": ast.Gt, "\\geq": ast.Gt, "\\gg": ast.Gt,
}  # fmt: skip


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
            where.append(ast.Compare(left=left, ops=[_SIGNS[sides[1]]()], comparators=[right]))
            continue
        letter = _letter(theory, left, own, part)
        value = value_of(right)
        if value is not None:
            hold[letter] = float(Fraction(value))
        else:
            theory = _tied(theory, letter, right, part)
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


def _tied(theory: Theory, letter: str, tree: Node, part: str) -> Theory:
    free = {k: v for k, v in theory.letters.items() if k != letter}
    unknown = [k for k in letters(tree) if k not in free and k not in [*theory.tape] and k not in CONSTANTS]
    if letter in letters(tree) or unknown:
        raise BadInput(f"--assume {part!r}: {letter} must be given by the other letters of {theory.name}")
    units = {**theory.units, letter: theory.letters[letter].unit}
    return replace(theory, letters=free, tape=retaped(theory.tape, {letter: tree}, free, theory.angle), units=units)
