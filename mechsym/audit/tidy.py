"""A mended formula without what nobody writes: a factor of one, a power of one, m - 1 + 1."""

import ast
from math import gcd

from mechsym.audit.tree import Node, binary, children, is_operation, number, replace, value_of, walk


def tidy(tree: Node, printed: Node) -> Node:
    """A formula of which the parts that its author did not print are written plainly.

    Parameters
    ----------
    printed : Node
        The formula as it was printed; its parts stay as they are
    """
    return _tidy(tree, {id(node) for _, node in walk(printed)})


def _tidy(node: Node, printed: set[int]) -> Node:
    if id(node) in printed:
        return node
    for step, child in children(node):
        below = _tidy(child, printed)
        if below is not child:
            node = replace(node, (step,), below)
    return _plain(node)


def _plain(node: Node) -> Node:
    if not isinstance(node, ast.BinOp):
        return node
    left, right = value_of(node.left), value_of(node.right)
    if is_operation(node, ast.Add, ast.Sub):
        return _sum(node)
    if right == 1 and is_operation(node, ast.Mult, ast.Div, ast.Pow):
        return node.left
    if left == 1 and is_operation(node, ast.Mult):
        return node.right
    if left is not None and right is not None and is_operation(node, ast.Mult):
        return number(left * right, decimal=True)
    if is_operation(node, ast.Div) and left is not None and right and left.denominator == right.denominator == 1:
        return node if gcd(int(left), int(right)) == 1 else number(left / right)
    return node


def _sum(node: ast.BinOp) -> Node:
    # x + 0, (x - 1) + 1
    right, plus = value_of(node.right), isinstance(node.op, ast.Add)
    if right is None:
        return node.right if plus and value_of(node.left) == 0 else node
    added = right if plus else -right
    base = node.left
    if is_operation(base, ast.Add, ast.Sub):
        assert isinstance(base, ast.BinOp)
        inner = value_of(base.right)
        if inner is not None:
            added += inner if isinstance(base.op, ast.Add) else -inner
            base = base.left
    elif value_of(base) is not None:
        return number(value_of(base) + added)  # type: ignore[operator]
    if not added:
        return base
    return binary(ast.Add if added > 0 else ast.Sub, base, number(abs(added)))
