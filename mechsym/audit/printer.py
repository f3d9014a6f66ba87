"""Formulas back as text, in the form in which the author wrote them."""

import ast
from collections.abc import Mapping

from mechsym.audit.spelling import latex
from mechsym.audit.tree import Node, function_of

_SUM, _PRODUCT, _SIGN, _POWER, _ATOM = range(5)  # how tightly a printed node binds
_NAMES = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "log": "ln"}


def to_python(tree: Node) -> str:
    """A formula as Python text.

    Returns
    -------
    text : str
        Reads back to the same tree
    """
    return _python(tree)[0]


_SIGNS = {ast.Add: (" + ", _SUM), ast.Sub: (" - ", _SUM), ast.Mult: ("*", _PRODUCT), ast.Div: ("/", _PRODUCT)}


def _python(node: Node) -> tuple[str, int]:
    if isinstance(node, ast.Name):
        return node.id, _ATOM
    if isinstance(node, ast.Constant):
        return str(node.value), _ATOM
    if isinstance(node, ast.Call):
        return f"{function_of(node)}({_python(node.args[0])[0]})", _ATOM
    if isinstance(node, ast.UnaryOp):
        return f"-{_bracketed(node.operand, _POWER)}", _SIGN
    if isinstance(node, ast.IfExp):
        return f"piecewise({', '.join(_python(n)[0] for n in (node.test, node.body, node.orelse))})", _ATOM
    if isinstance(node, ast.Compare):
        return f"{_python(node.left)[0]} {_SIDES[type(node.ops[0])]} {_python(node.comparators[0])[0]}", _SUM
    assert isinstance(node, ast.BinOp)
    if isinstance(node.op, ast.Pow):
        return f"{_bracketed(node.left, _ATOM)}**{_bracketed(node.right, _ATOM)}", _POWER
    sign, level = _SIGNS[type(node.op)]
    # a signed factor may only lead, and what follows - or / needs its own bracket
    following = level + 1 if isinstance(node.op, (ast.Sub, ast.Mult, ast.Div)) else level
    right = _bracketed(node.right, following if following != _SIGN else _POWER)
    return f"{_bracketed(node.left, level)}{sign}{right}", level


_SIDES: dict[type, str] = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}


def _bracketed(node: Node, level: int) -> str:
    text, found = _python(node)
    return text if found >= level else f"({text})"


def to_latex(tree: Node, spelled: Mapping[str, str]) -> str:
    """A formula as LaTeX.

    Parameters
    ----------
    spelled : mapping of str to str
        Plain name to the LaTeX that the author wrote for it

    Returns
    -------
    text : str
        Reads back to the same value
    """
    return _latex(tree, spelled)[0]


def _latex(node: Node, spelled: Mapping[str, str]) -> tuple[str, int]:
    if isinstance(node, ast.Name):
        return spelled.get(node.id) or latex(node.id), _ATOM
    if isinstance(node, ast.Constant):
        return _decimal(node)
    if isinstance(node, ast.UnaryOp):
        return f"-{_at_least(node.operand, _POWER, spelled)}", _SUM
    if isinstance(node, ast.Call):
        return _function(node, spelled)
    if isinstance(node, ast.IfExp):
        test, body, other = (_latex(n, spelled)[0] for n in (node.test, node.body, node.orelse))
        return rf"\begin{{cases}} {body} & {test} \\ {other} & \text{{else}} \end{{cases}}", _ATOM
    if isinstance(node, ast.Compare):
        left, right = (_latex(n, spelled)[0] for n in (node.left, node.comparators[0]))
        return f"{left} {_SIDES[type(node.ops[0])]} {right}", _SUM
    assert isinstance(node, ast.BinOp)
    return _operation(node, spelled)


def _decimal(node: ast.Constant) -> tuple[str, int]:
    text = str(node.value)
    if "e" not in text:
        return text, _ATOM
    mantissa, _, exponent = text.partition("e")
    return rf"{mantissa} \cdot 10^{{{int(exponent)}}}", _PRODUCT


def _is_signed(node: Node) -> bool:
    # -a b: the sign of the first factor needs no bracket where the product leads
    while isinstance(node, ast.BinOp) and isinstance(node.op, ast.Mult):
        node = node.left
    return isinstance(node, ast.UnaryOp)


def _at_least(node: Node, level: int, spelled: Mapping[str, str]) -> str:
    text, found = _latex(node, spelled)
    return text if found >= level else rf"\left({text}\right)"


def _function(node: ast.Call, spelled: Mapping[str, str]) -> tuple[str, int]:
    function, argument = str(function_of(node)), node.args[0]
    if function == "sqrt":
        return rf"\sqrt{{{_latex(argument, spelled)[0]}}}", _ATOM
    if function == "abs":
        return rf"\left|{_latex(argument, spelled)[0]}\right|", _ATOM
    if function == "sum":
        return rf"\left(\sum {_at_least(argument, _PRODUCT, spelled)}\right)", _ATOM
    text, level = _latex(argument, spelled)
    short = level == _ATOM and isinstance(argument, ast.Name)
    return rf"\{_NAMES.get(function, function)}" + (f" {text}" if short else rf"\left({text}\right)"), _ATOM


def _operation(node: ast.BinOp, spelled: Mapping[str, str]) -> tuple[str, int]:
    if isinstance(node.op, ast.Div):
        return rf"\frac{{{_latex(node.left, spelled)[0]}}}{{{_latex(node.right, spelled)[0]}}}", _ATOM
    if isinstance(node.op, ast.Pow):
        return _power(node, spelled), _POWER
    if isinstance(node.op, ast.Mult):
        signed = _is_signed(node.left)
        left = _at_least(node.left, _SUM if signed else _PRODUCT, spelled)
        right = _at_least(node.right, _POWER, spelled)
        apart = left[-1:].isdigit() and right[:1].isdigit() or _ends_bare(node.left)
        return f"{left} \\cdot {right}" if apart else f"{left} {right}", _SUM if signed else _PRODUCT
    sign = "+" if isinstance(node.op, ast.Add) else "-"
    right = _at_least(node.right, _PRODUCT, spelled)
    return f"{_latex(node.left, spelled)[0]} {sign} {right}", _SUM


def _ends_bare(node: Node) -> bool:
    # after \sin\varphi a letter would join the argument
    while isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Mult, ast.Pow)):
        node = node.right if isinstance(node.op, ast.Mult) else node.left
    return isinstance(node, ast.Call) and isinstance(node.args[0], ast.Name)


def _power(node: ast.BinOp, spelled: Mapping[str, str]) -> str:
    exponent = _latex(node.right, spelled)[0]
    function = function_of(node.left)
    if isinstance(node.left, ast.Call) and function not in ("sqrt", "abs", "sum") and exponent != "-1":
        head, _, tail = _latex(node.left, spelled)[0].partition(str(_NAMES.get(str(function), function)))
        return rf"{head}{_NAMES.get(str(function), function)}^{{{exponent}}}{tail}"
    base, level = _latex(node.left, spelled)
    simple = level == _ATOM and isinstance(node.left, (ast.Name, ast.Constant))
    return f"{base}^{{{exponent}}}" if simple else rf"\left({base}\right)^{{{exponent}}}"
