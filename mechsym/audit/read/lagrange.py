r"""The Lagrange equation as it is printed.

.. math:: \frac{d}{dt}\frac{\partial L}{\partial\dot q} - \frac{\partial L}{\partial q} = Q
"""

import ast
import re

from mechsym.audit.read.latex import read_latex
from mechsym.errors import BadInput
from mechsym.quantities import record

_SPARE = re.compile(
    r"\\(?:left|right|big[lrg]?|Big[lrg]?|bigg[lr]?|Bigg[lr]?|displaystyle|[,;:!])(?![A-Za-z])|\s|~|\\ |\\q?quad"
)
_CALLIGRAPHIC = re.compile(r"\\math(?:cal|scr)\s*\{?\s*([A-Za-z])\s*\}?")
_D = r"(?:d|\\mathrm\{?d\}?|\\text\{d\}|\{\\rmd\})"
_GROUP = r"\{\\partial((?:[^{}]|\{(?:[^{}]|\{[^{}]*\})*\})+)\}"
_TERM = re.compile(rf"([+-]?)(\\[dt]?frac\{{{_D}\}}\{{{_D}t\}})?[(\[]?\\[dt]?frac{_GROUP}{_GROUP}[)\]]?")


@record
class Term:
    """A partial derivative of a Lagrange equation."""

    of: str
    by: str  #: A coordinate, or its rate
    sign: int  #: [-]
    timed: bool  #: Whether its rate stands there


@record
class LagrangeEquation:
    """Terms on the left, what acts on the right."""

    terms: tuple[Term, ...]
    right: str


def lagrange_equation(text: str) -> LagrangeEquation | None:
    """A printed Lagrange equation taken apart; None where a text is none."""
    if r"\partial" not in text:
        return None
    left, equals, right = _SPARE.sub("", text).partition("=")
    if not equals or _TERM.sub("", left):
        return None
    # what stands on the right, as Q - dP/dq, counts the other way round on the left
    printed = [(m, 1) for m in _TERM.finditer(left)] + [(m, -1) for m in _TERM.finditer(right)]
    terms = tuple(
        Term(of=plain_letter(m[3]), by=plain_letter(m[4]), sign=-side if m[1] == "-" else side, timed=bool(m[2]))
        for m, side in printed
    )
    if not any(t.timed for t in terms) or not all(t.of and t.by for t in terms):
        return None
    return LagrangeEquation(terms=terms, right=_TERM.sub("", right).strip("+.,;") or "0")


def calligraphic(text: str) -> str:
    """A text in which a calligraphic L is a letter of its own."""
    return _CALLIGRAPHIC.sub(r"\\text{cal\1}", text)


def plain_letter(text: str) -> str:
    """The plain name of a letter of LaTeX, empty where it is none."""
    text = re.sub(r"\\(d?dot)(?=[A-Za-z])", r"\\\1 ", calligraphic(text))
    try:
        tree = read_latex(text, whole=True)[0]
    except BadInput:
        return ""
    return tree.id if isinstance(tree, ast.Name) else ""
