r"""A small Pratt reader for the LaTeX of printed formulas, and the way back.

It reads what authors write: fractions, roots, powers, dots for time derivatives, `\sin 2\varphi`, products without a
sign. What can be read in two ways is refused with the question, never guessed: `a/bc`, `\sin\varphi^2`.
"""

import ast
import re
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NoReturn

from mechsym.audit.read.spelling import plain
from mechsym.audit.read.tree import MAX_DEPTH, Node, binary, call, name, negative, number, piecewise
from mechsym.errors import BadInput

_GREEK = {
    "alpha", "beta", "gamma", "delta", "epsilon", "varepsilon", "zeta", "eta", "theta", "vartheta", "kappa", "lambda",
    "mu", "nu", "xi", "pi", "rho", "varrho", "sigma", "tau", "phi", "varphi", "chi", "psi", "omega", "Delta", "Sigma",
    "Phi", "Psi", "Omega", "Gamma", "Theta", "Lambda",
}  # fmt: skip
_DECORATED = {"\\vec": "", "\\boldsymbol": "", "\\bar": "bar", "\\overline": "bar", "\\hat": "hat", "\\tilde": "tilde"}
_PAIRS = {")": "(r + l)", "}": "{r + l}", "]": "\\sqrt[3]{r}"}
WORDS = {"\\mathrm", "\\text", "\\mbox", "\\mathit", "\\mathbf", "\\operatorname", "\\textrm", "\\mathsf"}


@dataclass
class Cursor:
    """Where the reader is; the one thing that changes while reading."""

    tokens: list[str]
    #: Next token, and how deep the reader is in brackets
    position: int = 0
    depth: int = 0
    spelled: dict[str, str] = field(default_factory=dict)  #: Plain name to the author's LaTeX

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
    while cursor.peek() in _DECORATED and cursor.peek(1) != "{":
        cursor.take()
    # \\vec{r} is r; a bar or a hat makes another letter
    decorated = cursor.peek() in _DECORATED
    start = cursor.position if decorated else start
    mark = _DECORATED[cursor.take()] if decorated else ""
    dots = 0 if decorated else {"\\dot": 1, "\\ddot": 2}.get(cursor.peek(), 0)
    if dots:
        cursor.take()
    braced = decorated or dots > 0 and cursor.peek() == "{"
    if braced:
        cursor.take("{")
    base = _base(cursor)
    subscript = "" if bare and not dots and not decorated else _subscript(cursor)
    if braced:
        cursor.take("}")
        subscript = subscript or _subscript(cursor)
    if not decorated:
        subscript += _star(cursor, bare)
        if cursor.peek() == "'":
            raise BadInput(f"LaTeX: primes are not read {place(cursor)}; write \\frac{{dx}}{{d\\varphi}} for x'")
    plain_name = plain(base, subscript, dots) + mark
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
    if token == "\\Delta" and (len(after) == 1 and after.isalpha() or after.startswith("\\") and after[1:] in _GREEK):
        return f"Delta{_base(cursor)}"
    if token[1:] in _GREEK and token.startswith("\\"):
        return token[1:]
    if len(token) == 1 and token.isalpha():
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
    # \frac{d x}{d \varphi} and \frac{d^2 x}{d \varphi^2} are one letter, dx_dphi and d2x_dphi2
    text = "".join(cursor.tokens[cursor.position : cursor.position + 24])
    d, letter = r"(?:d|\\mathrm\{d\}|\\partial)", r"\\?[A-Za-z]+(?:_\w|_\{\w+\})?"
    match = re.match(rf"\{{{d}(\^2|\^\{{2\}})?({letter})\}}\{{{d}({letter})(\^2|\^\{{2\}})?\}}", text)
    if match is None or bool(match[1]) != bool(match[4]):
        return None
    end, length = cursor.position, 0
    while length < match.end():
        length += len(cursor.tokens[end])
        end += 1
    cursor.position = end
    above, below = (plain(*re.sub(r"[\\{}]", "", match[i]).partition("_")[::2]) for i in (2, 3))
    whole = f"d2{above}_d{below}2" if match[1] else f"d{above}_d{below}"
    cursor.spelled[whole] = rf"\frac{match[0]}"
    return whole


_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|\d+(?:(?:\.|,|\{,\})\d+)?|[^\W\d_]|\S")
_SILENT = {
    "\\,", "\\;", "\\:", "\\!", "\\ ", "\\quad", "\\qquad", "\\displaystyle", "\\limits", "\\nolimits", "~", "$",
    "\\left", "\\right", "\\big", "\\Big", "\\bigl", "\\bigr", "\\Bigl", "\\Bigr", "\\bigg", "\\biggl", "\\biggr",
}  # fmt: skip
_FUNCTIONS = {
    "sin": "sin", "cos": "cos", "tan": "tan", "tg": "tan", "cot": "cot", "ctg": "cot", "arcsin": "asin",
    "arccos": "acos", "arctan": "atan", "arctg": "atan", "exp": "exp", "ln": "log", "log": "log",
}  # fmt: skip
_FRACTIONS = {"\\frac", "\\dfrac", "\\tfrac"}
_CLOSING = {"(": ")", "[": "]", "{": "}", "\\{": "\\}", "|": "|"}
_TIMES, _OVER = {"*", "\\cdot", "\\times"}, {"/", "\\div"}
_STOP = {")", "]", "}", "\\}", "|", "+", "-", "\\over", ""}
_SPELLED = (*sorted({*_FUNCTIONS, "asin", "acos", "atan", "sqrt"}, key=len, reverse=True),)


def read_latex(text: str) -> tuple[Node, dict[str, str]]:
    """Read LaTeX without an equals sign: the tree, and plain names to the LaTeX that was written for them."""
    text = text.replace("²", "^{2}").replace("³", "^{3}")
    silent = _SILENT if r"\begin" in text else {*_SILENT, "&"}
    cursor = Cursor([t for t in _TOKEN.findall(text) if t not in silent])
    tree = _sum(cursor)
    if cursor.peek():
        raise BadInput(f"LaTeX: {cursor.peek()!r} does not fit {place(cursor)}; take it away or open its bracket")
    return tree, cursor.spelled


@contextmanager
def _deeper(cursor: Cursor) -> Iterator[None]:
    cursor.depth += 1
    if cursor.depth > MAX_DEPTH:
        raise BadInput(f"LaTeX: the formula is nested more than {MAX_DEPTH} deep; split it and check the parts")
    yield
    cursor.depth -= 1


def _sum(cursor: Cursor) -> Node:
    sign = cursor.take() if cursor.peek() in ("+", "-") else "+"
    tree = _product(cursor)
    if sign == "-":
        tree = _signed(tree)
    while cursor.peek() in ("+", "-"):
        operator = ast.Add if cursor.take() == "+" else ast.Sub
        tree = binary(operator, tree, _product(cursor))
    return tree


def _signed(tree: Node) -> Node:
    # the sign belongs to the first factor, as Python reads -a*b
    if isinstance(tree, ast.BinOp) and isinstance(tree.op, (ast.Mult, ast.Div)):
        return binary(type(tree.op), _signed(tree.left), tree.right)
    return negative(tree)


def _product(cursor: Cursor) -> Node:
    tree = _power(cursor)
    while cursor.peek() not in _STOP:
        if cursor.peek() in _OVER:
            cursor.take()
            below, after = _power(cursor), cursor.peek()
            # lambda/2 \sin 2\varphi leaves no doubt
            clear = isinstance(below, ast.Constant) and after[1:] in _FUNCTIONS
            if after not in _STOP | _TIMES | _OVER and not clear:
                raise BadInput(
                    f"LaTeX: after the slash it is not clear where the divisor ends {place(cursor)}; "
                    "write \\frac{}{}"
                )
            tree = binary(ast.Div, tree, below)
        else:
            if cursor.peek() in _TIMES:
                cursor.take()
            tree = binary(ast.Mult, tree, _power(cursor))
    return tree


def _power(cursor: Cursor) -> Node:
    tree = _factor(cursor)
    if cursor.peek() == "^":
        cursor.take()
        tree = binary(ast.Pow, tree, _argument(cursor))
    return tree


def _argument(cursor: Cursor) -> Node:
    # what follows ^, \sqrt or \frac: a brace group, or one token
    if cursor.peek() == "{":
        return _group(cursor)
    token = cursor.peek()
    if token[:1].isdecimal() and len(token) > 1:
        cursor.tokens[cursor.position : cursor.position + 1] = [token[0], token[1:]]
    if token == "-":
        raise BadInput(f"LaTeX: put the exponent in braces {place(cursor)}")
    return _factor(cursor, bare=True)


def _group(cursor: Cursor) -> Node:
    opening = cursor.take()
    with _deeper(cursor):
        tree = _sum(cursor)
        if cursor.peek() == "\\over":
            cursor.take()
            tree = binary(ast.Div, tree, _sum(cursor))
    cursor.take(_CLOSING[opening])
    return call("abs", tree) if opening == "|" else tree


def _factor(cursor: Cursor, bare: bool = False) -> Node:
    with _deeper(cursor):
        token = cursor.peek()
        if token in _CLOSING:
            return _group(cursor)
        if token[:1].isdecimal():
            return number(Fraction(cursor.take().replace("{,}", ".").replace(",", ".")), decimal=True)
        if token in _FRACTIONS:
            cursor.take()
            whole = derivative(cursor)
            if whole:
                return name(whole)
            above = _argument(cursor)
            return binary(ast.Div, above, _argument(cursor))
        if token == "\\sqrt":
            cursor.take()
            if cursor.peek() != "[":
                return call("sqrt", _argument(cursor))
            degree = _group(cursor)
            return binary(ast.Pow, _argument(cursor), binary(ast.Div, number(1), degree))
        if token == "\\sum":
            cursor.take()
            for mark in ("_", "^"):
                if cursor.peek() == mark:
                    cursor.take()
                    if cursor.take() == "{":
                        while cursor.peek() and cursor.take() != "}":
                            pass
            return call("sum", _product(cursor))
        if token == "\\begin":
            return _cases(cursor)
        function = _function_name(cursor)
        if function:
            return _function(cursor, function)
        return letter(cursor, bare)


def _cases(cursor: Cursor) -> Node:
    # \begin{cases} a, & b < c \\ d, & \text{otherwise} \end{cases}
    text = "".join(cursor.tokens[cursor.position :])
    whole = re.match(r"\\begin\{cases\}(.*?)\\end\{cases\}", text, re.DOTALL)
    if whole is None:
        raise BadInput(
            f"LaTeX: {text[:20]!r} is not read {place(cursor)}; cases are: \\begin{{cases}} .. \\end{{cases}}"
        )
    length = 0
    while length < whole.end():
        length += len(cursor.take())
    rows = [row.partition("&")[::2] for row in whole[1].split(r"\\") if row.strip()]
    arguments: list[Node] = []
    for value, condition in rows[:-1]:
        relation = re.search(
            r"^(?:\\text\{[^{}]*\})?(.+?)(<|>|\\leq?|\\geq?|\\lt|\\gt)(.+)$", condition.strip().rstrip(".,;")
        )
        if relation is None:
            raise BadInput(f"LaTeX: the condition {condition.strip()[:40]!r} of a case is not read; write a < b")
        left, right = (_inner(cursor, relation[i]) for i in (1, 3))
        less = relation[2] in ("<", r"\le", r"\leq", r"\lt")
        arguments += [
            ast.Compare(left=left, ops=[ast.Lt() if less else ast.Gt()], comparators=[right]),
            _inner(cursor, value),
        ]
    return piecewise([*arguments, _inner(cursor, rows[-1][0])]) if rows else piecewise([])


def _inner(cursor: Cursor, text: str) -> Node:
    tree, spelled = read_latex(text.strip().rstrip(".,;"))
    cursor.spelled.update(spelled)
    return tree


def _function_name(cursor: Cursor) -> str | None:
    token = cursor.peek()
    if token in WORDS and cursor.peek(1) == "{":
        word = "".join(cursor.tokens[cursor.position + 2 :]).partition("}")[0]
        if word in _FUNCTIONS:
            cursor.position += 3 + len(word)
            return _FUNCTIONS[word]
    if token.startswith("\\") and token[1:] in _FUNCTIONS:
        cursor.take()
        return _FUNCTIONS[token[1:]]
    # sin(x) without its backslash
    for word in _SPELLED if token.isalpha() else ():
        if tuple(cursor.peek(i) for i in range(len(word))) == tuple(word) and _opens(cursor.peek(len(word))):
            cursor.position += len(word)
            return _FUNCTIONS.get(word, word)
    return None


def _opens(token: str) -> bool:
    # what can only be the argument of a function that three letters spell
    return token in ("(", "[") or token.startswith("\\") and token[1:].isalpha() and token[1:] not in _FUNCTIONS


def _function(cursor: Cursor, function: str) -> Node:
    power: Node | None = None
    if cursor.peek() == "^":
        cursor.take()
        power = _argument(cursor)
        if ast.dump(power) == ast.dump(negative(number(1))):
            function, power = f"a{function}", None
    if cursor.peek() in _CLOSING:
        argument = _group(cursor)
        if cursor.peek() == "^" and power is None:
            cursor.take()
            power = _argument(cursor)
    else:
        argument = _run(cursor, function)
    tree = call(function, argument)
    return tree if power is None else binary(ast.Pow, tree, power)


def _run(cursor: Cursor, function: str) -> Node:
    # \sin 2\varphi: a number and one letter or fraction; what follows without a sign would leave a doubt
    tree: Node | None = None
    stops = _STOP | _TIMES | _OVER | set(_CLOSING) | {"\\sqrt", "\\sum"} | WORDS
    while cursor.peek() not in stops and cursor.peek()[1:] not in _FUNCTIONS:
        if tree is not None and not isinstance(tree, ast.Constant):
            _ask(cursor, function, cursor.peek())
        factor = _factor(cursor)
        if cursor.peek() == "^":
            _ask(cursor, function, "the power")
        tree = factor if tree is None else binary(ast.Mult, tree, factor)
    if tree is None:
        raise BadInput(f"LaTeX: \\{function} has no argument {place(cursor)}; write it as in \\sin\\varphi")
    if cursor.peek() in _OVER and cursor.peek(1)[:1].isdecimal():
        _ask(cursor, function, f"{cursor.peek()}{cursor.peek(1)}")
    return tree


def _ask(cursor: Cursor, function: str, what: str) -> NoReturn:
    raise BadInput(
        f"LaTeX: does {what} belong to the argument of \\{function} or to the whole, {place(cursor)}? "
        f"Write brackets, \\{function}(..), or a sign, \\{function} x \\cdot .."
    )
