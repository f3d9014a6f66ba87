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

from mechsym.audit.limits import MAX_DEPTH
from mechsym.audit.spelling import plain
from mechsym.audit.tree import Node, binary, call, name, negative, number
from mechsym.errors import BadInput

_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|\d+(?:(?:\.|,|\{,\})\d+)?|[A-Za-z]|\S")
_SILENT = {
    "\\,", "\\;", "\\:", "\\!", "\\ ", "\\quad", "\\qquad", "\\displaystyle", "\\limits", "\\nolimits", "~", "&", "$",
    "\\left", "\\right", "\\big", "\\Big", "\\bigl", "\\bigr", "\\Bigl", "\\Bigr", "\\bigg", "\\biggl", "\\biggr",
}  # fmt: skip
_FUNCTIONS = {
    "sin": "sin", "cos": "cos", "tan": "tan", "tg": "tan", "cot": "cot", "ctg": "cot", "arcsin": "asin",
    "arccos": "acos", "arctan": "atan", "arctg": "atan", "exp": "exp", "ln": "log", "log": "log",
}  # fmt: skip
_GREEK = {
    "alpha", "beta", "gamma", "delta", "epsilon", "varepsilon", "zeta", "eta", "theta", "vartheta", "kappa", "lambda",
    "mu", "nu", "xi", "pi", "rho", "varrho", "sigma", "tau", "phi", "varphi", "chi", "psi", "omega", "Delta", "Sigma",
    "Phi", "Psi", "Omega", "Gamma", "Theta", "Lambda",
}  # fmt: skip
_WORDS = {"\\mathrm", "\\text", "\\mathit", "\\mathbf", "\\operatorname", "\\textrm", "\\mathsf"}
_FRACTIONS = {"\\frac", "\\dfrac", "\\tfrac"}
_CLOSING = {"(": ")", "[": "]", "{": "}", "\\{": "\\}", "|": "|"}
_TIMES, _OVER = {"*", "\\cdot", "\\times"}, {"/", "\\div"}
_STOP = {")", "]", "}", "\\}", "|", "+", "-", ""}


@dataclass
class _Cursor:
    """Where the reader is; the one thing that changes while reading."""

    tokens: list[str]
    position: int = 0
    depth: int = 0
    spelled: dict[str, str] = field(default_factory=dict)

    def peek(self, ahead: int = 0) -> str:
        index = self.position + ahead
        return self.tokens[index] if index < len(self.tokens) else ""

    def take(self, wanted: str = "") -> str:
        token = self.peek()
        if wanted and token != wanted:
            raise BadInput(f"LaTeX: {wanted!r} is missing {_place(self)}")
        self.position += 1
        return token


def read_latex(text: str) -> tuple[Node, dict[str, str]]:
    """Read a LaTeX expression without an equals sign.

    Parameters
    ----------
    text : str
        As one would paste it from a paper

    Returns
    -------
    tree : Node
        Expression in plain names
    spelled : dict of str to str
        Plain name to the LaTeX that the author wrote for it

    Raises
    ------
    BadInput
        What cannot be read, or can be read in two ways
    """
    cursor = _Cursor([t for t in _TOKEN.findall(text) if t not in _SILENT])
    tree = _sum(cursor)
    if cursor.peek():
        raise BadInput(f"LaTeX: {cursor.peek()!r} does not fit {_place(cursor)}")
    return tree, cursor.spelled


def _place(cursor: _Cursor) -> str:
    before = "".join(cursor.tokens[max(0, cursor.position - 6) : cursor.position])
    return f"after {before!r}" if before else "at the start"


@contextmanager
def _deeper(cursor: _Cursor) -> Iterator[None]:
    cursor.depth += 1
    if cursor.depth > MAX_DEPTH:
        raise BadInput(f"LaTeX: the formula is nested more than {MAX_DEPTH} deep; split it and check the parts")
    yield
    cursor.depth -= 1


def _sum(cursor: _Cursor) -> Node:
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
    if isinstance(tree, ast.BinOp) and not isinstance(tree.op, ast.Pow):
        return binary(type(tree.op), _signed(tree.left), tree.right)
    return negative(tree)


def _product(cursor: _Cursor) -> Node:
    tree = _power(cursor)
    while cursor.peek() not in _STOP:
        if cursor.peek() in _OVER:
            cursor.take()
            below = _power(cursor)
            _refuse_open_slash(cursor, below)
            tree = binary(ast.Div, tree, below)
        else:
            if cursor.peek() in _TIMES:
                cursor.take()
            tree = binary(ast.Mult, tree, _power(cursor))
    return tree


def _refuse_open_slash(cursor: _Cursor, below: Node) -> None:
    following = cursor.peek()
    if following in _STOP | _TIMES | _OVER:
        return
    if isinstance(below, ast.Constant) and following[1:] in _FUNCTIONS:
        return  # lambda/2 \sin 2\varphi leaves no doubt
    raise BadInput(
        f"LaTeX: after the slash it is not clear where the divisor ends {_place(cursor)}; write \\frac{{}}{{}}"
    )


def _power(cursor: _Cursor) -> Node:
    tree = _factor(cursor)
    if cursor.peek() == "^":
        cursor.take()
        tree = binary(ast.Pow, tree, _argument(cursor))
    return tree


def _argument(cursor: _Cursor) -> Node:
    # what follows ^, \sqrt or \frac: a brace group, or one token
    if cursor.peek() == "{":
        return _group(cursor)
    token = cursor.peek()
    if token[:1].isdigit() and len(token) > 1:
        cursor.tokens[cursor.position : cursor.position + 1] = [token[0], token[1:]]
    if token == "-":
        raise BadInput(f"LaTeX: put the exponent in braces {_place(cursor)}")
    return _factor(cursor, bare=True)


def _group(cursor: _Cursor) -> Node:
    opening = cursor.take()
    with _deeper(cursor):
        tree = _sum(cursor)
    cursor.take(_CLOSING[opening])
    return call("abs", tree) if opening == "|" else tree


def _factor(cursor: _Cursor, bare: bool = False) -> Node:
    with _deeper(cursor):
        return _any_factor(cursor, bare)


def _any_factor(cursor: _Cursor, bare: bool) -> Node:
    token = cursor.peek()
    if token in _CLOSING:
        return _group(cursor)
    if token[:1].isdigit():
        return number(Fraction(cursor.take().replace("{,}", ".").replace(",", ".")), decimal=True)
    if token in _FRACTIONS:
        return _fraction(cursor)
    if token == "\\sqrt":
        return _root(cursor)
    if token == "\\sum":
        return _total(cursor)
    function = _function_name(cursor)
    if function:
        return _function(cursor, function)
    return _letter(cursor, bare)


def _fraction(cursor: _Cursor) -> Node:
    cursor.take()
    derivative = _derivative(cursor)
    if derivative:
        return name(derivative)
    above = _argument(cursor)
    return binary(ast.Div, above, _argument(cursor))


def _derivative(cursor: _Cursor) -> str | None:
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
    found = f"d2{above}_d{below}2" if match[1] else f"d{above}_d{below}"
    cursor.spelled[found] = rf"\frac{match[0]}"
    return found


def _root(cursor: _Cursor) -> Node:
    cursor.take()
    if cursor.peek() != "[":
        return call("sqrt", _argument(cursor))
    degree = _group(cursor)
    return binary(ast.Pow, _argument(cursor), binary(ast.Div, number(1), degree))


def _total(cursor: _Cursor) -> Node:
    cursor.take()
    for mark in ("_", "^"):
        if cursor.peek() == mark:
            cursor.take()
            _limits(cursor)
    return call("sum", _product(cursor))


def _limits(cursor: _Cursor) -> None:
    if cursor.take() == "{":
        while cursor.peek() and cursor.take() != "}":
            pass


def _function_name(cursor: _Cursor) -> str | None:
    token = cursor.peek()
    if token in _WORDS and cursor.peek(1) == "{":
        word = "".join(cursor.tokens[cursor.position + 2 :]).partition("}")[0]
        if word in _FUNCTIONS:
            cursor.position += 3 + len(word)
            return _FUNCTIONS[word]
    if token.startswith("\\") and token[1:] in _FUNCTIONS:
        cursor.take()
        return _FUNCTIONS[token[1:]]
    return None


def _function(cursor: _Cursor, function: str) -> Node:
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


def _run(cursor: _Cursor, function: str) -> Node:
    # \sin 2\varphi: numbers, letters and fractions up to a bracket, an operator or the next function
    tree: Node | None = None
    while cursor.peek() not in _STOP | _TIMES | _OVER | set(_CLOSING) | {"\\sqrt", "\\sum"}:
        if cursor.peek()[1:] in _FUNCTIONS or cursor.peek() in _WORDS:
            break
        factor = _factor(cursor)
        if cursor.peek() == "^":
            raise BadInput(
                f"LaTeX: does the power belong to the argument or to \\{function}, {_place(cursor)}? "
                f"Write \\{function}^2 x or \\{function}(x^2)"
            )
        tree = factor if tree is None else binary(ast.Mult, tree, factor)
    if tree is None:
        raise BadInput(f"LaTeX: \\{function} has no argument {_place(cursor)}")
    return tree


def _letter(cursor: _Cursor, bare: bool) -> Node:
    start = cursor.position
    dots = {"\\dot": 1, "\\ddot": 2}.get(cursor.peek(), 0)
    braced = False
    if dots:
        cursor.take()
        braced = cursor.peek() == "{"
        if braced:
            cursor.take()
    base = _base(cursor)
    subscript = "" if bare and not dots else _subscript(cursor)
    if braced:
        cursor.take("}")
        subscript = subscript or _subscript(cursor)
    if cursor.peek() == "'":
        raise BadInput(f"LaTeX: primes are not read {_place(cursor)}; write \\frac{{dx}}{{d\\varphi}} for x'")
    found = plain(base, subscript, dots)
    cursor.spelled.setdefault(found, _join(cursor.tokens[start : cursor.position]))
    return name(found)


def _join(tokens: list[str]) -> str:
    pairs = zip(tokens, [*tokens[1:], ""], strict=True)
    return "".join(f"{t} " if t[0] == "\\" and t[-1].isalpha() and n[:1].isalpha() else t for t, n in pairs)


def _base(cursor: _Cursor) -> str:
    token = cursor.take()
    if token in _WORDS:
        cursor.take("{")
        word = ""
        while cursor.peek().isalnum():
            word += cursor.take()
        cursor.take("}")
        return word
    if token[1:] in _GREEK and token.startswith("\\"):
        return token[1:]
    if len(token) == 1 and token.isalpha() and token.isascii():
        return token
    cursor.position -= 1
    what = repr(token) if token else "an end"
    raise BadInput(f"LaTeX: {what} is not read {_place(cursor)}; use fractions, roots, powers, letters and functions")


def _subscript(cursor: _Cursor) -> str:
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
        if token not in _WORDS:
            text += token
    raise BadInput("LaTeX: a subscript's closing brace is missing")
