"""Formulas as a page prints them, copied as text, "x = r(1 − cos φ) + ½ λ r sin²φ"; products have no sign.

The grammar is that of LaTeX; what differs is how a text falls into tokens: a word is the letter of that name where
there is one, and else the letters that it is set together of.
"""

import re
import unicodedata
from collections.abc import Iterable, Iterator
from functools import cache

from mechsym.audit.read.latex import SINGLE, read_tokens
from mechsym.audit.read.letter import ASKED, Way
from mechsym.audit.read.slopes import Slope
from mechsym.audit.read.spelling import LOWERED, RAISED, SYMBOLS, typeset, undotted
from mechsym.audit.read.tree import Node
from mechsym.errors import BadInput

_GREEK = {sign: name for name, sign in SYMBOLS.items()} | {"ϕ": "phi", "ϑ": "theta", "ϵ": "epsilon", "µ": "mu"}
_SIGNS = {
    "·": "*", "∙": "*", "⋅": "*", "×": "*", "∗": "*", "•": "*", "\N{INVISIBLE TIMES}": "*",
    "÷": "/", "∕": "/", "⁄": "/", "**": "^", "\N{FUNCTION APPLICATION}": " ", "√": " sqrt ", "∛": " cbrt ",
    "½": "(1/2)", "¼": "(1/4)", "¾": "(3/4)", "⅓": "(1/3)", "⅔": "(2/3)", "⅛": "(1/8)",
    **{sign: str(digit) for digit, sign in enumerate(LOWERED)},
}  # fmt: skip
_ARCS = {f"a{name}": f"arc{name}" for name in ("sin", "cos", "tan")}
_FUNCTIONS = {name: name for name in (*SINGLE, "sqrt", "cbrt")} | _ARCS
_FUNCTIONS |= {name.capitalize(): meant for name, meant in _FUNCTIONS.items()}
_FUNCTIONS |= {f"Arc{name}": f"arc{name.lower()}" for name in ("Sin", "Cos", "Tan")}
_DIFFERENTIAL = re.compile(r"\bd(\^\{?2\}?)?([^\W\d]\w*)\s*/\s*d([^\W\d][^\W_]*)(\^\{?2\}?)?(?!\w)")
# what a divisor without spaces before it ends with: a bracket or a number, and then a space
_DIVISOR = re.compile(r"(?<=\S/)(\d+(?:\.\d+)?|\([^()]*\))\s+(?=[\w(\[])")
_STARRED = re.compile(r"([^\W\d]\w*)\*(?=(\s*(?:[)\]}/+\-^]|$))?)")  # E*
_EXPONENT = re.compile(r"\^\s*(-?\s*(?:\d+(?:[.,]\d+)?|[^\W\d]\w*))")
_TOKEN = re.compile(r"\\[a-z]+|\d+(?:[.,]\d+)?(?:[eE][+-]?\d+(?!\w))?|[^\W\d]\w*|\S")
_PLAIN = re.compile(
    r"[\w\s.,+\-*/^()\[\]|'{}" + "".join(map(re.escape, (*_SIGNS, *RAISED, *"⁻−–′’″\u0307\u0308"))) + "]*"
)
_PROGRAM = re.compile(r"\b(?:if|else|for|in|and|or|not|is|lambda\s\w+\s*:|True|False|None)\b|\.[^\W\d]|__|//")
_MOST_PIECES = 5  # letters without a function that one word may be set together of


def is_printed(text: str) -> bool:
    """Whether a text has nothing but what a page prints: no quotes, commands, comparisons, words of a program."""
    return bool(_PLAIN.fullmatch(unicodedata.normalize("NFD", text))) and not _PROGRAM.search(text)


def read_printed(text: str, known: Iterable[str], way: Way = ASKED) -> Node:
    """Read what a page prints, without an equals sign; `known` are the letters that words may be set together of."""
    forms = _forms(frozenset(known))
    text = _STARRED.sub(lambda m: f"{m[1]}star " if _starred(m, forms) else m[0], _signs(text))
    tokens = [piece for token in _TOKEN.findall(text) for piece in _pieces(token, forms)]
    for at, token in enumerate(tokens):
        if token == r"\sqrt" and tokens[at + 1 : at + 2] == ["["]:
            _round(tokens, at + 1)  # no degree
        elif token == r"\cbrt":
            tokens[at : at + 1] = [r"\sqrt", "[", "3", "]"]
    names = frozenset(t for t in tokens if re.fullmatch(r"[^\W\d]\w+", t))
    try:
        return read_tokens(tokens, way, names)
    except BadInput as error:
        error.args = (str(error).replace("LaTeX: ", "as printed: "),)
        raise


def _round(tokens: list[str], opening: int) -> None:
    depth = 0
    for at in range(opening, len(tokens)):
        depth += {"[": 1, "]": -1}.get(tokens[at], 0)
        if depth == 0:
            tokens[opening], tokens[at] = "(", ")"
            return


def _starred(match: re.Match[str], forms: dict[str, str]) -> bool:
    # no factor behind it, or no letter without the star
    return f"{match[1]}star" in forms and (match[2] is not None or match[1] not in forms)


def differential(text: str) -> str:
    """The one letter that `dV/dθ` is; empty for anything else."""
    match = _DIFFERENTIAL.fullmatch(text.strip())
    return _rate(match).strip() if match else ""


def _signs(text: str) -> str:
    text = typeset(undotted(text))
    for sign, instead in _SIGNS.items():
        text = text.replace(sign, instead)
    text = re.sub(r"_\{(\w+)\}", r"_\1", text)
    text = _DIVISOR.sub(r"\1*", _DIFFERENTIAL.sub(_rate, text))
    return _EXPONENT.sub(r"^{\1}", text)


def _rate(match: re.Match[str]) -> str:
    above, below = ("".join(_GREEK.get(c, c) for c in match[i]) for i in (2, 3))
    return f" {Slope(above, below, 2 if match[1] else 1).name} "


@cache
def _forms(known: frozenset[str]) -> dict[str, str]:
    # how a letter may be written, and the letter
    forms: dict[str, str] = {}
    for letter in sorted(known):
        forms |= dict.fromkeys([w for form in _written(letter) for w in (form, form.replace("_", ""))], letter)
    return forms


def _written(letter: str) -> list[str]:
    # Deltatheta, Δtheta and Δθ
    stem = next((n for n in SYMBOLS if letter.startswith(n)), "")
    if not stem:
        return [letter]
    signs = (stem, SYMBOLS[stem], *(["lambda"] if stem == "lam" else []))
    return [sign + rest for rest in _written(letter[len(stem) :]) for sign in signs]


def _pieces(token: str, forms: dict[str, str]) -> Iterator[str]:
    if not re.fullmatch(r"[^\W\d]\w*", token):
        mantissa, e, exponent = token.lower().partition("e")
        yield from ("(", mantissa, "*", "10", "^", "{", *_TOKEN.findall(exponent), "}", ")") if e else (token,)
        return
    pieces = (forms[token],) if token in forms else _split(token, tuple(forms))
    for piece in pieces or (token,):
        if piece in _FUNCTIONS and piece not in forms:
            yield rf"\{_FUNCTIONS[piece]}"
        else:
            yield forms.get(piece) or "".join(_GREEK.get(c, c) for c in piece)


@cache
def _split(word: str, written: tuple[str, ...]) -> tuple[str, ...]:
    # the fewest letters and functions that make the word; a number stands at its start or behind a function
    best: list[tuple[str, ...] | None] = [(), *[None] * len(word)]
    parts = {*written, *_FUNCTIONS, *_GREEK, "pi"}
    for end in range(1, len(word) + 1):
        for start in range(end):
            before, part = best[start], word[start:end]
            if before is None or part not in parts and not (part.isdigit() and before and before[-1] in _FUNCTIONS):
                continue
            if best[end] is None or len(before) + 1 < len(best[end] or ()):
                best[end] = (*before, part)
    pieces = best[-1] or ()
    return pieces if len(pieces) <= _MOST_PIECES or {*pieces} & {*_FUNCTIONS} else ()
