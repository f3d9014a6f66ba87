r"""Letters of LaTeX: dots, primes, indices, words in roman, differentials; and where the reader of a formula is."""

import re
from dataclasses import dataclass, field

from mechsym.audit.read.slopes import Slope
from mechsym.audit.read.spelling import plain
from mechsym.audit.read.tree import Node, name
from mechsym.errors import BadInput

_GREEK = {
    "alpha", "beta", "gamma", "delta", "epsilon", "varepsilon", "zeta", "eta", "theta", "vartheta", "kappa", "lambda",
    "mu", "nu", "xi", "pi", "rho", "varrho", "sigma", "tau", "phi", "varphi", "chi", "psi", "omega", "Delta", "Sigma",
    "Phi", "Psi", "Omega", "Gamma", "Theta", "Lambda", "Pi", "ell",
    "Vartheta", "Varphi", "Varrho", "Varepsilon",  # of a text that has both forms
}  # fmt: skip
_DECORATED = {"\\vec": "", "\\boldsymbol": "", "\\bar": "bar", "\\overline": "bar", "\\hat": "hat", "\\tilde": "tilde"}
_PAIRS = {")": "(r + l)", "}": "{r + l}", "]": "\\sqrt[3]{r}"}
WORDS = {"\\mathrm", "\\text", "\\mbox", "\\mathit", "\\mathbf", "\\operatorname", "\\textrm", "\\mathsf"}


class Ambiguous(BadInput):
    """A text that can be read in two ways, with the question."""


@dataclass(frozen=True)
class Way:
    """Which of two ways a doubtful text is read in; None where it is asked."""

    #: Where a divisor ends: 0 behind its first factor, 1 before a function, 2 with the product
    divisor: int | None = None
    argument: bool | None = None  #: Whether the argument of a function goes on behind its first letter


ASKED = Way()
WAYS = tuple(Way(divisor=d, argument=a) for d in range(3) for a in (False, True))


@dataclass
class Cursor:
    """Where the reader is; the one thing that changes while reading."""

    tokens: list[str]
    #: Next token, and how deep the reader is in brackets
    position: int = 0
    depth: int = 0
    bar: bool = False  #: Whether the innermost open bracket is a bar, which the next bar closes
    spelled: dict[str, str] = field(default_factory=dict)  #: Plain name to the author's LaTeX
    whole: bool = False  #: Whether a whole text is read: dV is a letter, x' a derivative, an integral one symbol
    way: Way = ASKED
    names: frozenset[str] = frozenset()  #: Tokens of several characters that are one letter each

    def peek(self, ahead: int = 0) -> str:
        """A token that is not taken yet."""
        index = self.position + ahead
        return self.tokens[index] if index < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        """The next token, refused where it is not the wanted one."""
        token = self.peek()
        if wanted and token != wanted:
            way = f"close what is open, as in {_PAIRS[wanted]}" if wanted in _PAIRS else f"write {wanted} there"
            raise BadInput(f"LaTeX: {wanted!r} is missing {place(self)}; {way}")
        self.position += 1
        return token


def place(cursor: Cursor) -> str:
    """Where the reader is, for messages."""
    before = "".join(cursor.tokens[max(0, cursor.position - 6) : cursor.position])
    return f"after {before!r}" if before else "at the start"


def letter(cursor: Cursor, bare: bool) -> Node:
    """Read a letter with dots and subscript; `bare`: the one token after a fraction or a power, without subscript."""
    start = cursor.position
    while cursor.peek() in _DECORATED and not _DECORATED[cursor.peek()] and cursor.peek(1) != "{":
        cursor.take()
    # \\vec{r} is r; a bar or a hat makes another letter
    decorated = cursor.peek() in _DECORATED
    start = cursor.position if decorated else start
    mark = _DECORATED[cursor.take()] if decorated else ""
    dots = 0 if decorated else {"\\dot": 1, "\\ddot": 2}.get(cursor.peek(), 0)
    if dots:
        cursor.take()
    braced = (decorated or dots > 0) and cursor.peek() == "{"
    if braced:
        cursor.take("{")
    base = _base(cursor)
    primes = _primes(cursor)
    subscript = "" if bare and not dots and not decorated else _subscript(cursor)
    if braced:
        cursor.take("}")
        subscript = subscript or _subscript(cursor)
    if not decorated:
        subscript += _star(cursor, bare)
        subscript += _primes(cursor)
    plain_name = plain(base, subscript + primes, dots) + mark
    tokens = cursor.tokens[start : cursor.position]
    pairs = zip(tokens, [*tokens[1:], ""], strict=True)
    spelled = "".join(f"{t} " if t[0] == "\\" and t[-1].isalpha() and n[:1].isalpha() else t for t, n in pairs)
    cursor.spelled.setdefault(plain_name, spelled)
    return name(plain_name)


def _star(cursor: Cursor, bare: bool) -> str:
    # E^* is one letter
    for length, mark in ((2, ("*",)), (2, ("\\ast",)), (4, ("{", "*", "}")), (4, ("{", "\\ast", "}"))):
        if not bare and tuple(cursor.peek(i) for i in range(length)) == ("^", *mark):
            cursor.position += length
            return "star"
    return ""


def _primes(cursor: Cursor) -> str:
    # x', and x^{\prime\prime}
    marks = ""
    while cursor.peek() == "'":
        cursor.take()
        marks += "prime"
    while cursor.whole and cursor.peek() == "^" and "\\prime" in (cursor.peek(1), cursor.peek(2)):
        cursor.take()
        braced = cursor.peek() == "{" and bool(cursor.take())
        while cursor.peek() == "\\prime":
            cursor.take()
            marks += "prime"
        if braced:
            cursor.take("}")
    return marks


def _base(cursor: Cursor) -> str:
    token = cursor.take()
    if token in WORDS:
        cursor.take("{")
        word = ""
        while cursor.peek().isalnum():
            word += cursor.take()
        cursor.take("}")
        return word
    after = cursor.peek()
    small = cursor.whole and token in ("\\delta", "d")  # \\delta Q and dV, where a whole text is read
    if (token == "\\Delta" or small) and (
        len(after) == 1 and after.isalpha() or after[:1] == "\\" and after[1:] in _GREEK
    ):
        return f"{token.strip(chr(92))}{_base(cursor)}"
    if token[1:] in _GREEK and token.startswith("\\"):
        return token[1:]
    if len(token) == 1 and token.isalpha() or token in cursor.names:
        return token
    cursor.position -= 1
    if not token:
        raise BadInput(f"LaTeX: the formula ends {place(cursor)}; write what belongs there, a letter or a bracket")
    raise BadInput(f"LaTeX: {token!r} is not read {place(cursor)}; use fractions, roots, powers, letters and functions")


def _subscript(cursor: Cursor) -> str:
    if cursor.peek() != "_":
        return ""
    cursor.take()
    if cursor.peek() != "{":
        return cursor.take()
    text, depth = "", 0
    while cursor.peek():
        token = cursor.take()
        depth += {"{": 1, "}": -1}.get(token, 0)
        if depth == 0:
            return text
        if token not in WORDS:
            text += token
    raise BadInput(f"LaTeX: the subscript's closing brace is missing {place(cursor)}; write it as in m_{{rod}}")


def derivative(cursor: Cursor) -> str | None:
    r"""Read what follows `\frac` as `dx_dphi` or `d2x_dphi2`; None when it is an ordinary fraction."""
    # \frac{d x}{d \varphi} and \frac{d^2 x}{d \varphi^2} are one letter, dx_dphi and d2x_dphi2; dL_dqd by a rate
    text = "".join(cursor.tokens[cursor.position : cursor.position + 28])
    d, letter = r"(?:d|\\mathrm\{d\}|\\partial)", r"\\?[A-Za-z]+(?:_\w|_\{\w+\})?"
    rate = rf"\\dot(?:\{{)?({letter})(?:\}})?"
    match = re.match(rf"\{{{d}(\^2|\^\{{2\}})?({letter})\}}\{{{d}(?:{rate}|({letter}))(\^2|\^\{{2\}})?\}}", text)
    if match is None or bool(match[1]) != bool(match[5]):
        return None
    end, length = cursor.position, 0
    while length < match.end():
        length += len(cursor.tokens[end])
        end += 1
    cursor.position = end
    above, below = (
        plain(*re.sub(r"[\\{}]", "", part).partition("_")[::2], dots=dots)
        for part, dots in ((match[2], 0), (match[3] or match[4], int(bool(match[3]))))
    )
    whole = Slope(above, below, 2 if match[1] else 1).name
    cursor.spelled[whole] = rf"\frac{match[0]}"
    return whole
