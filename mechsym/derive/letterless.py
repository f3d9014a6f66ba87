"""Letters of sympy expressions as people have them: symbols, dynamicsymbols and their derivatives, and their names."""

import re
import unicodedata
from collections.abc import Iterable, Sequence

import sympy as sp
from sympy.core.function import AppliedUndef

from mechsym.errors import BadInput


def free_letters(expressions: Iterable[sp.Basic]) -> list[sp.Basic]:
    """Letters that must have a value, sorted by name; a derivative counts apart from its function."""
    letters: set[sp.Basic] = set()
    for expression in expressions:
        stack = [expression]
        while stack:
            node = stack.pop()
            if isinstance(node, (sp.Derivative, AppliedUndef)) or node.is_Symbol:
                letters.add(node)
            else:
                stack += node.args
    return sorted(letters, key=lambda s: (name_of(s), str(s)))


def name_of(letter: sp.Basic) -> str:
    """Name of a letter: `q1`, its rate `q1d`, of that `q1dd`. Raises BadInput: no letter, or no name remains."""
    if isinstance(letter, sp.Derivative):
        order = sum(count for _, count in letter.variable_count)
        return name_of(letter.expr) + "d" * int(order)
    if not (letter.is_Symbol or isinstance(letter, AppliedUndef)):
        raise BadInput(f"input {letter} is no letter; inputs are symbols, dynamicsymbols and their derivatives")
    text = letter.name if letter.is_Symbol else letter.func.__name__
    for character in {c for c in text if not c.isascii()}:
        words = unicodedata.name(character, "").lower().split()  # GREEK SMALL LETTER PHI becomes phi
        text = text.replace(character, words[-1] if "letter" in words else "_")
    text = re.sub(r"_+", "_", re.sub(r"\W", "_", text)).strip("_")
    if not text:
        raise BadInput(f"the letter {letter} has no name in ASCII; rename it")
    return text if text[0].isalpha() else f"x{text}"


def names(letters: Sequence[sp.Basic]) -> list[str]:
    """Names of letters, in order. Raises BadInput: two letters would get one name."""
    called = [name_of(s) for s in letters]
    for name in called:
        if called.count(name) > 1:
            both = [str(s) for s, n in zip(letters, called, strict=True) if n == name]
            raise BadInput(f"the letters {' and '.join(both)} would both be called {name!r}; rename one")
    return called


def plain(expression: sp.Basic) -> sp.Basic:
    """The expression with derivatives of composed expressions worked out."""
    compound = [d for d in expression.atoms(sp.Derivative) if not isinstance(d.expr, (AppliedUndef, sp.Symbol))]
    return expression.doit() if compound else expression
