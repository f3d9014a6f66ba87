"""What a formula may hold: letters, numbers, arithmetic and elementary functions, within reasonable size."""

import ast

from mechsym.audit.tree import Node, walk
from mechsym.errors import BadInput

FUNCTIONS = (
    "sin", "cos", "tan", "cot", "asin", "acos", "atan", "sqrt", "exp", "log", "abs", "sum",
)  # fmt: skip
OPERATORS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow)
COMPARISONS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
MAX_NODES = 2000
MAX_DEPTH = 100
LEAST, LARGEST = 1e-30, 1e30
_SHOWN = 40  # characters of a part in a message


def check_size(tree: Node) -> None:
    """Refuse a tree that is too large or too deep to work with."""
    for count, (path, _) in enumerate(walk(tree)):
        if count >= MAX_NODES:
            raise BadInput(f"the formula has more than {MAX_NODES} parts; split it and check the parts")
        if len(path) > MAX_DEPTH:
            raise BadInput(f"the formula is nested more than {MAX_DEPTH} deep; split it and check the parts")


def check(tree: Node) -> None:
    """Refuse a tree that is too large, too deep, or holds anything but arithmetic on letters."""
    check_size(tree)
    if isinstance(tree, ast.Compare):
        raise BadInput(f"a condition alone, {_shown(tree)}, is no formula; write piecewise(a < b, x, y)")
    for path, node in walk(tree):
        if isinstance(node, ast.Compare) and path[-1] != "test":
            raise BadInput(f"{_shown(node)}: a condition may only stand in piecewise(a < b, x, y)")
        _check_node(node)


def _check_node(node: Node) -> None:
    if isinstance(node, ast.Constant):
        if not _is_number(node.value):
            raise BadInput(f"{repr(node.value)[:40]} is not a number between {LEAST:g} and {LARGEST:g}, like 2 or 0.25")
    elif isinstance(node, ast.UnaryOp):
        if not isinstance(node.op, ast.USub):
            raise BadInput(f"{_shown(node)}: only the signs + and - may stand before a term")
    elif isinstance(node, ast.BinOp):
        if not isinstance(node.op, OPERATORS):
            raise BadInput(f"{_shown(node)}: operators are + - * / and ** (or ^)")
    elif isinstance(node, ast.Call):
        if not isinstance(node.func, ast.Name) or node.func.id not in FUNCTIONS:
            raise BadInput(f"{ast.unparse(node.func)[:40]!r} is not a known function; there are {', '.join(FUNCTIONS)}")
        if len(node.args) != 1 or node.keywords:
            raise BadInput(f"{node.func.id} takes one argument, {_shown(node)} has {len(node.args)}")
    elif isinstance(node, ast.Compare):
        if len(node.ops) != 1 or not isinstance(node.ops[0], COMPARISONS):
            raise BadInput(f"{_shown(node)}: a condition compares two expressions with <, <=, > or >=")
    elif not isinstance(node, ast.Name) and not (isinstance(node, ast.IfExp) and isinstance(node.test, ast.Compare)):
        raise BadInput(f"{_shown(node)} is not arithmetic; use + - * / **, numbers, letters and functions")


def _shown(node: Node) -> str:
    text = ast.unparse(node)
    return repr(text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..")


def _is_number(value: object) -> bool:
    # a bool is an int, but no number of a formula
    plain = isinstance(value, (int, float)) and not isinstance(value, bool)
    return plain and (value == 0 or LEAST < value < LARGEST)  # type: ignore[operator]
