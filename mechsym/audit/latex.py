r"""A small Pratt reader for the LaTeX of printed formulas, and the way back.

It reads what authors write: fractions, roots, powers, dots for time derivatives, `\sin 2\varphi`, products without a
sign. What can be read in two ways is refused with the question, never guessed: `a/bc`, `\sin\varphi^2`.
"""

import ast
import re
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from typing import NoReturn

from mechsym.audit.functions import piecewise
from mechsym.audit.latex_letters import WORDS, Cursor, derivative, letter, place
from mechsym.audit.limits import MAX_DEPTH
from mechsym.audit.tree import Node, binary, call, name, negative, number
from mechsym.errors import BadInput

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
    """Read a LaTeX expression without an equals sign.

    Parameters
    ----------
    text : str
        As one would paste it from a paper

    Returns
    -------
    spelled : dict of str to str
        Plain name to the LaTeX that the author wrote for it
    """
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
            below = _power(cursor)
            _refuse_open_slash(cursor, below)
            tree = binary(ast.Div, tree, below)
        else:
            if cursor.peek() in _TIMES:
                cursor.take()
            tree = binary(ast.Mult, tree, _power(cursor))
    return tree


def _refuse_open_slash(cursor: Cursor, below: Node) -> None:
    following = cursor.peek()
    if following in _STOP | _TIMES | _OVER:
        return
    if isinstance(below, ast.Constant) and following[1:] in _FUNCTIONS:
        return  # lambda/2 \sin 2\varphi leaves no doubt
    raise BadInput(
        f"LaTeX: after the slash it is not clear where the divisor ends {place(cursor)}; write \\frac{{}}{{}}"
    )


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
        return _any_factor(cursor, bare)


def _any_factor(cursor: Cursor, bare: bool) -> Node:
    token = cursor.peek()
    if token in _CLOSING:
        return _group(cursor)
    if token[:1].isdecimal():
        return number(Fraction(cursor.take().replace("{,}", ".").replace(",", ".")), decimal=True)
    if token in _FRACTIONS:
        return _fraction(cursor)
    if token == "\\sqrt":
        return _root(cursor)
    if token == "\\sum":
        return _total(cursor)
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
        arguments += [_condition(cursor, condition), _inner(cursor, value)]
    return piecewise([*arguments, _inner(cursor, rows[-1][0])]) if rows else piecewise([])


def _condition(cursor: Cursor, text: str) -> Node:
    relation = re.search(r"^(?:\\text\{[^{}]*\})?(.+?)(<|>|\\leq?|\\geq?|\\lt|\\gt)(.+)$", text.strip().rstrip(".,;"))
    if relation is None:
        raise BadInput(f"LaTeX: the condition {text.strip()[:40]!r} of a case is not read; write a < b")
    left, right = (_inner(cursor, relation[i]) for i in (1, 3))
    less = relation[2] in ("<", r"\le", r"\leq", r"\lt")
    return ast.Compare(left=left, ops=[ast.Lt() if less else ast.Gt()], comparators=[right])


def _inner(cursor: Cursor, text: str) -> Node:
    tree, spelled = read_latex(text.strip().rstrip(".,;"))
    cursor.spelled.update(spelled)
    return tree


def _fraction(cursor: Cursor) -> Node:
    cursor.take()
    whole = derivative(cursor)
    if whole:
        return name(whole)
    above = _argument(cursor)
    return binary(ast.Div, above, _argument(cursor))


def _root(cursor: Cursor) -> Node:
    cursor.take()
    if cursor.peek() != "[":
        return call("sqrt", _argument(cursor))
    degree = _group(cursor)
    return binary(ast.Pow, _argument(cursor), binary(ast.Div, number(1), degree))


def _total(cursor: Cursor) -> Node:
    cursor.take()
    for mark in ("_", "^"):
        if cursor.peek() == mark:
            cursor.take()
            _limits(cursor)
    return call("sum", _product(cursor))


def _limits(cursor: Cursor) -> None:
    if cursor.take() == "{":
        while cursor.peek() and cursor.take() != "}":
            pass


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
    while not _ends_run(cursor):
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


def _ends_run(cursor: Cursor) -> bool:
    token = cursor.peek()
    stops = _STOP | _TIMES | _OVER | set(_CLOSING) | {"\\sqrt", "\\sum"}
    return token in stops or token[1:] in _FUNCTIONS or token in WORDS


def _ask(cursor: Cursor, function: str, what: str) -> NoReturn:
    raise BadInput(
        f"LaTeX: does {what} belong to the argument of \\{function} or to the whole, {place(cursor)}? "
        f"Write brackets, \\{function}(..), or a sign, \\{function} x \\cdot .."
    )
