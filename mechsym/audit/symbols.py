r"""What the letters of a paper mean: its symbol table, dots and derivatives of what stands there."""

import ast
import re
from collections.abc import Mapping

from mechsym.audit.latex import read_latex
from mechsym.audit.reader import AnyLetter, is_latex, read_expression
from mechsym.audit.spelling import resolve
from mechsym.audit.theory.record import Theory, known
from mechsym.audit.tree import letters
from mechsym.errors import BadInput
from mechsym.quantities import record

_ARGUMENT = re.compile(r"^(.*[\w}])\s*(?:\\left)?\(\s*(?:\\[a-z]+|[a-z])\s*(?:\\right)?\)$")
_SLOPE = re.compile(r"d(\d?)(\w+?)_d(\w+?)(\d?)$")
_LETTER = re.compile(r"[A-Za-z_]\w*")


@record
class Symbols:
    """The symbol table: plain name of the author's letter to its expression in the theory's letters."""

    meanings: Mapping[str, str]

    @classmethod
    def of(cls, pairs: Mapping[str, str]) -> "Symbols":
        """A table whose letters may be written in LaTeX."""
        return cls(meanings={_plain(k): v for k, v in pairs.items()})

    def letter(self, written: str, theory: Theory) -> str:
        """The free letter of the theory that a letter stands for; empty where it is none."""
        meant = self.meanings.get(written, written)
        found = resolve(meant, theory.letters) if _LETTER.fullmatch(meant) else None
        return found or ""


def _plain(written: str) -> str:
    tree = read_latex(written)[0] if is_latex(written) else None
    found = letters(tree) if tree is not None else (written.strip(),)
    if len(found) != 1:
        raise BadInput(f"symbols: {written!r} is no letter")
    return found[0]


def without_argument(left: str) -> str:
    r"""A left side without the letter that it depends on: x for x(\varphi)."""
    inner = _ARGUMENT.match(left.strip())
    function = inner and re.search(r"\\?(?:sin|cos|tan|exp|ln|log|sqrt)\s*$", inner[1])
    return left if inner is None or function else inner[1]


def left_letter(left: str) -> str:
    """Plain name of the letter that a left side is; empty where it is an expression."""
    tree = read_expression(left, (), AnyLetter())[0]
    return tree.id if isinstance(tree, ast.Name) else ""


def quantity_of(written: str, theory: Theory, symbols: Symbols) -> str:
    """Name on the theory's tape that a letter of the paper stands for; empty where it is none."""
    meant = symbols.meanings.get(written, written)
    if not _LETTER.fullmatch(meant):
        return ""
    found = meant if meant in theory.tape else resolve(meant, known(theory))
    if found and found in theory.tape:
        return found
    return "" if meant in theory.letters else _derived(written, theory, symbols)


def _derived(written: str, theory: Theory, symbols: Symbols) -> str:
    # \dot{s} is s_d, ds/dphi is ds_dphi, ds/dt is s_d
    if slope := _SLOPE.match(written):
        if slope[1] != slope[4]:
            return ""
        of = quantity_of(slope[2], theory, symbols)
        by = symbols.letter(slope[3], theory)
        order = int(slope[1] or 1)
        new = f"{of}_{'d' * order}" if slope[3] == "t" and not by else f"d{slope[1]}{of}_d{by}{slope[1]}"
        return new if of and new in theory.tape else ""
    for dots in ("dd", "d"):
        if written.endswith(dots) and len(written) > len(dots):
            of = quantity_of(written[: -len(dots)], theory, symbols)
            if of and f"{of}_{dots}" in theory.tape:
                return f"{of}_{dots}"
    return ""


def with_derivatives(text: str, theory: Theory, symbols: Symbols) -> dict[str, str]:
    """The symbol table with the dotted letters and derivatives that an equation uses."""
    found = dict(symbols.meanings)
    for written in _letters_of(text):
        if written in found or resolve(written, known(theory)) or written in theory.tape:
            continue
        if meant := _derived(written, theory, symbols):
            found[written] = meant
    return found


def _letters_of(text: str) -> list[str]:
    found: list[str] = []
    for side in re.split(r"(?<![<>!])=|\\approx|\\simeq|\\equiv", text):
        try:
            found += letters(read_expression(side if is_latex(side) else rf"\,{side}", (), AnyLetter())[0])
        except BadInput:
            continue  # what cannot be read is refused where it is compared
    return found
