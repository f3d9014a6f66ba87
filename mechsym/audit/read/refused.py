r"""What would be read as a product of letters and is none: matrices, vectors, functions, values at a point.

Each is refused with why: a reader who multiplies f by x in `f(x)` blames what is right.
"""

import re
from collections.abc import Collection, Sequence

from mechsym.audit.read.displays import Displayed

#: A letter with its index and primes
SIGN = r"(?:\\[A-Za-z]+|[A-Za-z])'*(?:_(?:\w|\{(?:[^{}]|\{[^{}]*\})*\}))?'*"
#: Names of functions, which are no letters
NO_LETTERS = frozenset("sin cos tan tg cot arcsin arccos arctan exp ln log sinh cosh tanh pi".split())
_OPEN, _CLOSE = r"\s*(?:\\left)?\s*\(", r"(?:\\right)?\s*\)"

_TURNED = re.compile(
    rf"({SIGN}|\)|\])\s*\^\s*(?:\{{\s*)?(?:T(?![A-Za-z_\\])|\\(?:top|intercal|mathsf\s*\{{\s*T\s*\}}))"
)
_GIVEN = re.compile(rf"({SIGN})\s*=\s*(?:\\left)?\s*[\[(]?\s*\\begin\{{(?:[bpvB]?matrix|array)\}}")
_BOLD = re.compile(r"\\(?:mathbf|boldsymbol|bm|textbf)\s*\{?\s*([A-Za-z])\s*\}?")
_OF_MATRICES = re.compile(r"\\(?:operatorname\s*\{\s*)?(?:tr|det|rank)\b")
_VECTOR = re.compile(r"\\(?:mathbf|boldsymbol|bm|vec)(?![A-Za-z])")
_CROSSED = re.compile(r"\\times\s*(?!\d)")
_PUT_IN = re.compile(
    r"\b(?:substitut|insert|put)[a-z]* (?:in )?(?:the |these )?(?:numbers|(?:numeric|numerical|given) values)[^.]*$",
    re.IGNORECASE,
)
_UPRIGHT = re.compile(r"\\(?:mathrm|mathit|mathbf|text)\s*\{\s*([A-Za-z])\s*\}")
_ARGUMENTS = rf"{_OPEN}([^()=]*)\)"
_OF_ARGUMENTS = re.compile(rf"\s*({SIGN}){_ARGUMENTS}\s*=(.*)", re.DOTALL)
_WORD = r"\\(?:mathrm|operatorname|text)\s*\{\s*\w+\s*\}"
# u[T^2] beside u[T], DFT(f) beside DFT(g)
_OF_A_THING = re.compile(rf"({SIGN}|{_WORD})(?:\s*(?:\\left)?\[([^][+=-]*?)(?:\\right)?\]|{_OPEN}({SIGN}){_CLOSE})")
#: Patterns that say what a formula has, and how it is told
_REASONS = (
    (
        rf"\\(?:ln|log)\s*(?!\\(?:left|frac|sqrt)){SIGN}{_OPEN}",
        "it is not clear where the argument of its logarithm ends; write ln(..)",
    ),
    (
        r"\\(?:mathrm|operatorname|text)\s*\{\s*(?:erfc?|sgn|sign|floor|ceil|mod|diag)\s*\}",
        "it has a function that is none of those which are read",
    ),
    (
        r"(?<![A-Za-z])(?:[A-Za-z]|\\(?!left|sin|cos|tan|exp|ln|log)[a-z]+(?:\{[A-Za-z]\})?)(?:_\w|_\{[^{}]*\})?"
        rf"{_OPEN}\s*0\s*{_CLOSE}",
        "it has a value at 0, as x(0), which is no product",
    ),
    (
        rf"(?<![A-Za-z\\])[A-Za-z](?:_\w|_\{{[^{{}}]*\}})?{_OPEN}\s*e\s*\^\s*\{{[^{{}}]*\}}\s*{_CLOSE}",
        "it has a function of an exponential, as X(e^..), which is no product",
    ),
    (
        rf"^\s*{SIGN}{_OPEN}\s*-?\s*t\s*[+-]\s*{SIGN}\s*{_CLOSE}\s*=",
        "it has a value at another time, as h(t - c), which is no product",
    ),
    (rf"{SIGN}{_OPEN}\s*t\s*[+-]\s*\d\s*{_CLOSE}", "it has a value at another step, as x(t+1), which is no product"),
    (r"[A-Za-z)}]\s*\^\s*(?:\{\s*[01]\s*\}|[01](?![\d./]))", "raised 0 and 1 are indices, no powers"),
)
_COMPILED = [(re.compile(pattern), reason) for pattern, reason in _REASONS]


def refused(text: str, before: str, matrices: Collection[str]) -> str:
    """Why the formula of an equation cannot be read as numbers and letters, empty where it can.

    before: the words in front of it. matrices: the letters of matrices of its text.
    """
    if _multiplies_matrices(text, matrices):
        return "it multiplies matrices, whose order counts"
    if _CROSSED.search(text) and len(_VECTOR.findall(text)) > 1:
        return "it has vectors whose product is one, and order counts"
    if _PUT_IN.search(before) and re.search(r"\d", text):
        return "it has numbers for letters"
    if _is_two_functions(_UPRIGHT.sub(r"\1", text)):
        return "it has one letter for two things, by what it is of"
    return next((reason for pattern, reason in _COMPILED if pattern.search(text)), "")


def matrices_of(shown: Sequence[Displayed]) -> frozenset[str]:
    """Letters that some equation turns over, as x^T, or gives row by row."""
    texts = [_BOLD.sub(r"\1", one.text) for one in shown]
    turned = {m[1] for text in texts for m in (*_TURNED.finditer(text), *_GIVEN.finditer(text))}
    return frozenset(k.partition("_")[0] for k in turned if k not in ("e", ")", "]"))


def _multiplies_matrices(text: str, matrices: Collection[str]) -> bool:
    # a transpose, or two letters of matrices, whose order counts
    plain = _BOLD.sub(r"\1", text)
    turned = [m for m in _TURNED.finditer(plain) if m[1] != "e"]
    own = [k.partition("_")[0] for k in re.findall(SIGN, plain)]
    return bool(turned) or sum(k in matrices for k in own) > 1 or bool(_OF_MATRICES.search(plain))


def _is_two_functions(text: str) -> bool:
    # F(t) = H F(omega, theta), and P(t) = P sin omega t
    if (match := _OF_ARGUMENTS.match(text)) is not None:
        letter = re.escape(match[1])
        others = re.findall(rf"{letter}{_ARGUMENTS}", match[3])
        if any("," in other and other != match[2] for other in others):
            return True
        if re.search(rf"(?<![A-Za-z\\{{]){letter}(?![A-Za-z_'^]|{_OPEN})", match[3]):
            return True
    applied = [m for m in _OF_A_THING.finditer(text) if m[1].lstrip("\\") not in NO_LETTERS]
    of_things = {(m[1], (m[2] or m[3] or "").strip()) for m in applied}
    return len({letter for letter, _ in of_things}) < len(of_things)
