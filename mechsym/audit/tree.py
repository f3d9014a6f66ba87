"""Formulas as Python syntax trees with a short list of allowed nodes, edited by replacing one node.

A tree keeps the form that its author printed, which a computer algebra system would lose. Nodes are `ast` nodes and
are never changed in place; trees share what they have in common. Numbers are exact: `0.25` means 1/4.
"""

import ast
from collections.abc import Callable, Iterator
from fractions import Fraction
from hashlib import blake2b

Node = ast.expr
Path = tuple[str, ...]  # steps from the root: left, right, operand, argument
# what is known of a node is kept with it, for nodes never change
_DIGEST, _LETTERS = "_digest", "_letters"

_STEPS: dict[type, tuple[str, ...]] = {
    ast.BinOp: ("left", "right"),
    ast.UnaryOp: ("operand",),
    ast.Call: ("argument",),
    ast.IfExp: ("test", "body", "orelse"),  # a if b < c else d
    ast.Compare: ("less", "more"),
}


def name(text: str) -> ast.Name:
    """A letter."""
    return ast.Name(id=text, ctx=ast.Load())


def number(value: Fraction | int, decimal: bool = False) -> Node:
    """A number as an author writes it.

    Parameters
    ----------
    decimal : bool
        Whether a short decimal is preferred to a fraction bar

    Returns
    -------
    node : Node
        A constant, a quotient of constants, or the negative of one
    """
    value = Fraction(value)
    if value < 0:
        return negative(number(-value, decimal))
    if value.denominator == 1:
        return ast.Constant(value=int(value))
    if decimal and Fraction(repr(float(value))) == value:
        return ast.Constant(value=float(value))
    return binary(ast.Div, ast.Constant(value=value.numerator), ast.Constant(value=value.denominator))


def negative(node: Node) -> Node:
    """The negative of an expression; two signs cancel."""
    return node.operand if isinstance(node, ast.UnaryOp) else ast.UnaryOp(op=ast.USub(), operand=node)


def binary(operator: type[ast.operator], left: Node, right: Node) -> ast.BinOp:
    """An operation on two expressions.

    Parameters
    ----------
    operator : type
        One of ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow
    """
    return ast.BinOp(left=left, op=operator(), right=right)


def call(function: str, argument: Node) -> ast.Call:
    """A function of one expression."""
    return ast.Call(func=name(function), args=[argument], keywords=[])


def is_operation(node: Node, *operators: type[ast.operator]) -> bool:
    """Whether a node is one of the named operations."""
    return isinstance(node, ast.BinOp) and isinstance(node.op, operators)


def function_of(node: Node) -> str | None:
    """Name of the function that a node calls.

    Returns
    -------
    function : str or None
        None when the node is no call
    """
    return node.func.id if isinstance(node, ast.Call) else None  # type: ignore[attr-defined]


def value_of(node: Node) -> Fraction | None:
    """Exact value of a number, a negative number or a quotient of numbers.

    Returns
    -------
    value : Fraction or None
        None when the node holds letters or functions
    """
    if isinstance(node, (ast.Name, ast.Call)):
        return None
    if isinstance(node, ast.Constant):
        return Fraction(str(node.value))
    if isinstance(node, ast.UnaryOp):
        inner = value_of(node.operand)
        return None if inner is None else -inner
    if is_operation(node, ast.Div):
        above, below = value_of(node.left), value_of(node.right)  # type: ignore[attr-defined]
        return above / below if above is not None and below else None
    return None


def children(node: Node) -> list[tuple[str, Node]]:
    """Steps to the operands of a node."""
    if isinstance(node, ast.BinOp):
        return [("left", node.left), ("right", node.right)]
    if isinstance(node, ast.Call):
        return [("argument", argument) for argument in node.args[:1]]
    if isinstance(node, ast.Compare):
        return [("less", node.left), ("more", node.comparators[0])]
    return [(step, getattr(node, step)) for step in _STEPS.get(type(node), ())]


def walk(tree: Node) -> Iterator[tuple[Path, Node]]:
    """Every node with the path to it, a node before its operands."""
    waiting: list[tuple[Path, Node]] = [((), tree)]
    while waiting:
        path, node = waiting.pop()
        yield path, node
        waiting += [((*path, step), child) for step, child in reversed(children(node))]


def at(tree: Node, path: Path) -> Node:
    """The node at the end of a path."""
    for step in path:
        tree = dict(children(tree))[step]
    return tree


def replace(tree: Node, path: Path, new: Node) -> Node:
    """The tree with one node replaced; the rest is shared."""
    if not path:
        return new
    below = replace(dict(children(tree))[path[0]], path[1:], new)
    if isinstance(tree, ast.Call):
        return call(str(function_of(tree)), below)
    if isinstance(tree, ast.UnaryOp):
        return negative(below)
    if isinstance(tree, ast.IfExp):
        parts = {"test": tree.test, "body": tree.body, "orelse": tree.orelse, path[0]: below}
        return ast.IfExp(test=parts["test"], body=parts["body"], orelse=parts["orelse"])
    if isinstance(tree, ast.Compare):
        sides = {"less": tree.left, "more": tree.comparators[0], path[0]: below}
        return ast.Compare(left=sides["less"], ops=tree.ops, comparators=[sides["more"]])
    assert isinstance(tree, ast.BinOp)
    if path[0] == "left":
        return ast.BinOp(left=below, op=tree.op, right=tree.right)
    return ast.BinOp(left=tree.left, op=tree.op, right=below)


def substitute(tree: Node, change: Callable[[Node], Node | None]) -> Node:
    """The tree with every node that `change` answers to replaced.

    Parameters
    ----------
    change : callable
        Takes a node, gives the new node or None to keep it and look at its operands
    """
    new = change(tree)
    if new is not None:
        return new
    for step, child in children(tree):
        below = substitute(child, change)
        if below is not child:
            tree = replace(tree, (step,), below)
    return tree


def letters(tree: Node) -> tuple[str, ...]:
    """Letters of an expression in the order of their first use."""
    found: tuple[str, ...] | None = tree.__dict__.get(_LETTERS)
    if found is None:
        below = (tree.id,) if isinstance(tree, ast.Name) else (k for _, c in children(tree) for k in letters(c))
        found = tree.__dict__[_LETTERS] = tuple(dict.fromkeys(below))
    return found


def digest(tree: Node) -> bytes:
    """What an expression says in sixteen bytes: the same for two nodes that say the same."""
    found: bytes | None = tree.__dict__.get(_DIGEST)
    if found is None:
        found = tree.__dict__[_DIGEST] = blake2b(_said(tree), digest_size=16).digest()
    return found


def _said(node: Node) -> bytes:
    if isinstance(node, ast.Name):
        return node.id.encode()
    if isinstance(node, ast.Constant):
        return repr(node.value).encode()
    operator = getattr(node, "op", None) or (node.ops[0] if isinstance(node, ast.Compare) else None)
    words = function_of(node) or type(operator or node).__name__
    return b"|".join([words.encode(), *(digest(child) for _, child in children(node))])
