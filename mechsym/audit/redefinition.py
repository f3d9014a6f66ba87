"""A known letter or function may not get another meaning, by `--letters` or as the left side of a formula."""

import ast

from mechsym.audit.printer import to_python
from mechsym.audit.reader import RESERVED, AnyLetter, Formula, read_expression
from mechsym.audit.spelling import resolve
from mechsym.audit.theory.record import Theory
from mechsym.audit.tree import letters as letters_of
from mechsym.errors import BadInput


def refuse_letters(theory: Theory, formula: Formula) -> None:
    """Refuse an author's letter that is a datum of the theory already."""
    for letter, meant in formula.letters.items():
        # an author's F may be the derived total force and r his r1 + r2, but no datum may become another one
        named_quantity = isinstance(meant, ast.Name) and (meant.id in theory.tape or meant.id == letter)
        if letter in theory.letters and not named_quantity:
            raise BadInput(
                f"--letters '{letter}={to_python(meant)}': {letter} is a letter of {theory.name} already; write "
                f"another letter for it in the formula, for example {letter}_own, and --letters '{letter}_own=..'"
            )


def refuse_left(theory: Theory, quantity: str, left: str, formula: Formula) -> None:
    """Refuse a left side that would give a datum or a function another meaning; a law between both sides may stand."""
    written = _name(left)
    if not written or written == quantity:
        return
    way_out = f"write '{quantity} = ..', or the right side alone"
    meant = formula.letters.get(written)
    if meant is None:
        known = resolve(written, theory.letters) if written not in theory.tape else None
        if known or written in RESERVED:
            kind = f"a letter of {theory.name}" if known else "a constant or a function"
            raise BadInput(f"'{left} = ..': {known or written} is {kind} already and cannot be redefined; {way_out}")
    elif all(name in theory.letters for name in letters_of(meant)):
        raise BadInput(f"'{left} = ..': {left} is {to_python(meant)} already, by --letters; {way_out}")


def _name(text: str) -> str:
    try:
        tree = read_expression(text, (), AnyLetter())[0] if text else None
    except BadInput:
        return ""
    return tree.id if isinstance(tree, ast.Name) else ""
