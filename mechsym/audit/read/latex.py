r"""A small Pratt reader for the LaTeX of printed formulas, and the way back.

It reads what authors write: fractions, roots, powers, dots for time derivatives, `\sin 2\varphi`, products without a
sign. What can be read in two ways is refused with the question unless it is told which: `a/bc`, `\sin\varphi^2`.
"""

import ast
import re
from collections.abc import Iterator
from contextlib import contextmanager
from fractions import Fraction
from zlib import crc32

from mechsym.audit.read.letter import ASKED, WORDS, Ambiguous, Cursor, Way, derivative, letter, place
from mechsym.audit.read.spelling import SPEEDS, typeset
from mechsym.audit.read.tree import MAX_DEPTH, Node, binary, call, letters, meaning, name, negative, number, piecewise
from mechsym.errors import BadInput

PLUS_MINUS = "plusminus"  #: What stands for either sign
_TOKEN = re.compile(r"\\[A-Za-z]+|\\.|\d+(?:(?:\.|,|\{,\})\d+)?|[^\W\d_]|\S")
_SILENT = {
    "\\,", "\\;", "\\:", "\\!", "\\ ", "\\quad", "\\qquad", "\\displaystyle", "\\limits", "\\nolimits", "~", "$",
    "\\left", "\\right", "\\big", "\\Big", "\\bigl", "\\bigr", "\\Bigl", "\\Bigr", "\\bigg", "\\biggl", "\\biggr",
}  # fmt: skip
_FUNCTIONS = {
    "sin": "sin", "cos": "cos", "tan": "tan", "tg": "tan", "cot": "cot", "ctg": "cot", "arcsin": "asin",
    "arccos": "acos", "arctan": "atan", "arctg": "atan", "exp": "exp", "ln": "log", "log": "log",
}  # fmt: skip
_SEVERAL = ("atan2", "min", "max", "hypot")
_FUNCTIONS |= {n: n for n in (*_SEVERAL, "sinh", "cosh", "tanh", "sec", "csc")} | {"sen": "sin"}
SINGLE = (*(n for n in _FUNCTIONS if n not in _SEVERAL),)  #: Functions of one argument, as they are written
_LONGEST = 400  # digits of a number
_CLOSING = {"(": ")", "[": "]", "{": "}", "\\{": "\\}", "|": "|"}
# {\sin}^2 and {\sin^2}, \mathrm around signs: braces that say nothing; \sin\varphi\,\frac{a}{b}: a space that ends it
_ONE = rf"\\(?:{'|'.join(sorted(SINGLE, key=len, reverse=True))})"
_TWICE, _LETTER = r"(\^\{?\d\}?)", r"\s*(\\?[A-Za-z]+(?:_\w|_\{\w+\})?)\s*"
_APART = r"\s*\\[,;:]\s*(?=\\(?:[dt]?frac|d?dot)\b)"
_SLOPE = rf"(?<![\\A-Za-z_^])d{_TWICE}?{_LETTER}/\s*d{_LETTER}((?(1){_TWICE}))(?![A-Za-z_])"  # d\rho/d\varphi
_REWRITTEN = (
    (re.compile(rf"\{{\s*({_ONE})\s*\}}"), r"\1 "),
    (re.compile(rf"\{{\s*({_ONE})\s*(\^\s*(?:\{{[^{{}}]*\}}|\w))\s*\}}"), r"\1\2 "),
    (re.compile(r"\\(?:mathrm|mathit|mathbf|mathsf)\s*\{([^{}]*\\[^{}]*)\}"), r"{\1}"),
    (re.compile(_SLOPE), r"\\frac{d\1\2}{d\3\4}"),
    (re.compile(rf"({_ONE}(?:\^\{{?\d\}}?)?\s*\d?\s*\\?[A-Za-z]+(?:_\w)?){_APART}"), r"\1\\cdot "),
)
_TIMES, _OVER = {"*", "\\cdot", "\\times", ".", "\\ast", "\\bullet", "·"}, {"/", "\\div", ":"}
_SUMS, _FRACTIONS = ("+", "-", "\\pm", "\\mp"), {"\\frac", "\\dfrac", "\\tfrac"}
_STOP = {")", "]", "}", "\\}", "|", "\\over", "", ",", *_SUMS}
_SPELLED = (*sorted({*_FUNCTIONS, "asin", "acos", "atan", "sqrt"}, key=len, reverse=True),)


def read_latex(text: str, whole: bool = False, way: Way = ASKED) -> tuple[Node, dict[str, str]]:
    """Read LaTeX without an equals sign: the tree, and plain names to the LaTeX that was written for them."""
    text = typeset(text).replace("ℓ", r"\ell ")
    for pattern, instead in _REWRITTEN:
        text = pattern.sub(instead, text)
    silent = _SILENT if r"\begin" in text else {*_SILENT, "&"}
    cursor = Cursor([t for t in _TOKEN.findall(text) if t not in silent], whole=whole, way=way)
    return _whole(cursor), cursor.spelled


def read_tokens(tokens: list[str], way: Way, names: frozenset[str]) -> Node:
    """Read tokens of the same grammar; `names` are those of several characters that are one letter each."""
    return _whole(Cursor(tokens, way=way, names=names))


def _whole(cursor: Cursor) -> Node:
    tree = _sum(cursor)
    if cursor.peek():
        raise BadInput(f"LaTeX: {cursor.peek()!r} does not fit {place(cursor)}; take it away or open its bracket")
    return tree


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
    while cursor.peek() in _SUMS:
        operator = cursor.take()
        term = _product(cursor)
        if operator in ("\\pm", "\\mp"):  # either sign: a letter that is 1 or -1
            term = binary(ast.Mult, name(PLUS_MINUS), term)
        tree = binary(ast.Add if operator in ("+", "\\pm") else ast.Sub, tree, term)
    return tree


def _signed(tree: Node) -> Node:
    # the sign belongs to the first factor, as Python reads -a*b
    if isinstance(tree, ast.BinOp) and isinstance(tree.op, (ast.Mult, ast.Div)):
        return binary(type(tree.op), _signed(tree.left), tree.right)
    return negative(tree)


def _product(cursor: Cursor) -> Node:
    tree = _power(cursor)
    while cursor.peek() not in _STOP or _bar_opens(cursor):
        if cursor.peek() in _OVER:
            cursor.take()
            below, after = _power(cursor), cursor.peek()
            # lambda/2 \sin 2\varphi leaves no doubt
            clear = isinstance(below, ast.Constant) and _is_function(after)
            if after not in _STOP | _TIMES | _OVER and not clear:
                if cursor.way.divisor is None:
                    raise Ambiguous(
                        f"LaTeX: after the slash it is not clear where the divisor ends {place(cursor)}; "
                        "write \\frac{}{}"
                    )
                while cursor.way.divisor and cursor.peek() not in _STOP | _TIMES | _OVER:
                    if cursor.way.divisor == 1 and _is_function(cursor.peek()):
                        break
                    below = binary(ast.Mult, below, _power(cursor))
            tree = binary(ast.Div, tree, below)
        else:
            if cursor.peek() in _TIMES:
                cursor.take()
            tree = binary(ast.Mult, tree, _power(cursor))
    return tree


def _bar_opens(cursor: Cursor) -> bool:
    # a bar behind a factor opens where no bar is open and another one closes it: not in f|_{x=0}, nor in P(a|b)
    if cursor.peek() != "|" or cursor.bar or cursor.peek(1) in ("_", "^"):
        return False
    depth = 0
    for token in cursor.tokens[cursor.position + 1 :]:
        if token == "|" and not depth:
            return True
        depth += (token in _CLOSING) - (token in _CLOSING.values()) if token != "|" else 0
        if depth < 0:
            return False
    return False


def _power(cursor: Cursor) -> Node:
    euler = cursor.peek() == "e" and cursor.peek(1) == "^"
    tree = _factor(cursor)
    if cursor.peek() == "^":
        cursor.take()
        if _degrees(cursor):
            return binary(ast.Div, binary(ast.Mult, tree, name("pi")), number(180))
        exponent = _argument(cursor)
        # e to the power of a letter is the exponential, e^2 the square of a letter
        tree = call("exp", exponent) if euler and letters(exponent) else binary(ast.Pow, tree, exponent)
    return tree


def _degrees(cursor: Cursor) -> bool:
    for marks in (("\\circ",), ("{", "\\circ", "}")):
        if tuple(cursor.peek(i) for i in range(len(marks))) == marks:
            cursor.position += len(marks)
            return True
    return False


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
    opening, outer = cursor.take(), cursor.bar
    cursor.bar = opening == "|"
    with _deeper(cursor):
        tree = _sum(cursor)
        if cursor.peek() == "\\over":
            cursor.take()
            tree = binary(ast.Div, tree, _sum(cursor))
    cursor.bar = outer
    cursor.take(_CLOSING[opening])
    return call("abs", tree) if opening == "|" else tree


def _factor(cursor: Cursor, bare: bool = False) -> Node:
    with _deeper(cursor):
        token = cursor.peek()
        if token in _CLOSING:
            return _group(cursor)
        if token[:1].isdecimal():
            if len(token) > _LONGEST:
                raise BadInput(f"LaTeX: a number of {len(token)} digits {place(cursor)}; round it")
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
            while cursor.peek() in ("_", "^"):
                _subscript_of(cursor)
            return call("sum", _product(cursor))
        if token == "\\begin":
            return _cases(cursor)
        if token in ("\\underbrace", "\\overbrace"):
            cursor.take()
            tree = _group(cursor)
            if cursor.peek() in ("_", "^"):
                _subscript_of(cursor)
            return tree
        if cursor.whole and token in _INTEGRALS:
            return _integral(cursor)
        function = _function_name(cursor)
        if function:
            return _function(cursor, function)
        return letter(cursor, bare)


_INTEGRALS = {"\\int", "\\oint", "\\iint", "\\lim"}


def _subscript_of(cursor: Cursor) -> None:
    cursor.take()
    if cursor.peek() != "{":
        cursor.take()
        return
    depth = 0
    while token := cursor.peek():
        cursor.take()
        depth += {"{": 1, "}": -1}.get(token, 0)
        if not depth:
            return


def _integral(cursor: Cursor) -> Node:
    # to the end of the group: one symbol, known by what is printed
    start, depth = cursor.position, 0
    while token := cursor.peek():
        depth += {"(": 1, "[": 1, "{": 1, ")": -1, "]": -1, "}": -1}.get(token, 0)
        if depth < 0:
            break
        cursor.take()
    text = "".join(cursor.tokens[start : cursor.position])
    plain_name = f"integral{crc32(text.encode()):08x}"
    cursor.spelled[plain_name] = text
    return name(plain_name)


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
    tree, spelled = read_latex(text.strip().rstrip(".,;"), cursor.whole)
    cursor.spelled.update(spelled)
    return tree


def _is_function(token: str) -> bool:
    return token.startswith("\\") and token[1:] in _FUNCTIONS


def _function_name(cursor: Cursor) -> str | None:
    token = cursor.peek()
    if token in WORDS and cursor.peek(1) == "{":
        word = "".join(cursor.tokens[cursor.position + 2 :]).partition("}")[0]
        if word in _FUNCTIONS:
            cursor.position += 3 + len(word)
            return _FUNCTIONS[word]
    if _is_function(token):
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
    if function == "log" and cursor.peek() == "_":
        cursor.take()
        base = _argument(cursor)
        return binary(ast.Div, _function(cursor, function), call("log", base))
    if cursor.peek() == "^":
        cursor.take()
        power = _argument(cursor)
        if ast.dump(power) == ast.dump(negative(number(1))):
            function, power = f"a{function}", None
    if function in _SEVERAL:
        opening = cursor.take("(" if cursor.peek() != "\\{" else "")
        arguments = [_sum(cursor)]
        while cursor.peek() == ",":
            cursor.take()
            arguments.append(_sum(cursor))
        cursor.take(_CLOSING[opening])
        several = meaning(function, arguments)
        if several is None:
            raise BadInput(f"LaTeX: {function} takes two arguments {place(cursor)}; write {function}(a, b)")
        return several
    if cursor.peek() in _CLOSING:
        argument = _group(cursor)
        if cursor.peek() == "^" and power is None:
            cursor.take()
            power = _argument(cursor)
    else:
        argument = _run(cursor, function)
    tree = meaning(function, [argument]) or call(function, argument)
    return tree if power is None else binary(ast.Pow, tree, power)


def _run(cursor: Cursor, function: str) -> Node:
    # \sin 2\varphi: a number and one letter, bracket or fraction; what follows without a sign leaves a doubt
    tree: Node | None = None
    stops = _STOP | _TIMES | _OVER | {"\\sqrt", "\\sum"} | WORDS
    while cursor.peek() not in stops and not _is_function(cursor.peek()):
        number_alone = isinstance(tree, ast.Constant)
        if cursor.peek() in _CLOSING and not (number_alone and cursor.peek() in ("(", "[")):
            break
        bound = number_alone or tree is not None and _is_turned(cursor, tree)
        if tree is not None and not bound and not _goes_on(cursor, function, cursor.peek()):
            return tree
        factor = _factor(cursor)
        if cursor.peek() == "^":
            if not _goes_on(cursor, function, "the power"):
                return factor if tree is None else binary(ast.Mult, tree, factor)
            cursor.take()
            factor = binary(ast.Pow, factor, _argument(cursor))
        tree = factor if tree is None else binary(ast.Mult, tree, factor)
    if tree is None:
        raise BadInput(f"LaTeX: \\{function} has no argument {place(cursor)}; write it as in \\sin\\varphi")
    # sin 2\pi\theta/\beta, where what is to be read is told
    plain = cursor.way.argument and not _is_function(cursor.peek(1)) and cursor.peek(1) not in _CLOSING
    divides = cursor.peek() in _OVER and (plain or cursor.peek(1)[:1].isdecimal())
    if divides and _goes_on(cursor, function, f"{cursor.peek()}{cursor.peek(1)}"):
        cursor.take()
        tree = binary(ast.Div, tree, _factor(cursor))
    return tree


def _is_turned(cursor: Cursor, tree: Node) -> bool:
    # sin omega t, cos n omega t: the time belongs to the speed
    if cursor.peek() == "t":
        return any(n.startswith(speed) for n in letters(tree) for speed in SPEEDS)
    after = cursor.peek(3) if cursor.peek(1) == "_" else cursor.peek(1)
    return cursor.peek().removeprefix("\\") in SPEEDS and after == "t"


def _goes_on(cursor: Cursor, function: str, what: str) -> bool:
    if cursor.way.argument is not None:
        return cursor.way.argument
    raise Ambiguous(
        f"LaTeX: does {what} belong to the argument of \\{function} or to the whole, {place(cursor)}? "
        f"Write brackets, \\{function}(..), or a sign, \\{function} x \\cdot .."
    )
