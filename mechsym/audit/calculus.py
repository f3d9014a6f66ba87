"""Derivatives of trees, by the rules of school; names on a tape have derivatives of their own."""

import ast
from collections.abc import Callable

from mechsym.audit.tree import Node, binary, call, function_of, name, negative, number, value_of
from mechsym.errors import BadInput

Rate = Callable[[str], Node]  # of a letter or a name


def derivative(tree: Node, rate: Rate) -> Node:
    """Derivative of an expression whose letters have given rates."""
    if isinstance(tree, ast.Constant):
        return number(0)
    if isinstance(tree, ast.Name):
        return rate(tree.id)
    if isinstance(tree, ast.UnaryOp):
        return minus(number(0), derivative(tree.operand, rate))
    if isinstance(tree, ast.IfExp):
        body, other = derivative(tree.body, rate), derivative(tree.orelse, rate)
        return number(0) if is_zero(body) and is_zero(other) else ast.IfExp(test=tree.test, body=body, orelse=other)
    if isinstance(tree, ast.Call):
        inner = derivative(tree.args[0], rate)
        return number(0) if is_zero(inner) else times(_outer(str(function_of(tree)), tree), inner)
    assert isinstance(tree, ast.BinOp)
    return _operation(tree, derivative(tree.left, rate), derivative(tree.right, rate))


def _operation(tree: ast.BinOp, left: Node, right: Node) -> Node:
    if isinstance(tree.op, ast.Add):
        return plus(left, right)
    if isinstance(tree.op, ast.Sub):
        return minus(left, right)
    if isinstance(tree.op, ast.Mult):
        return plus(times(left, tree.right), times(tree.left, right))
    if isinstance(tree.op, ast.Div):
        return minus(over(left, tree.right), times(over(tree, tree.right), right))
    return _power(tree, left, right)


def _power(tree: ast.BinOp, left: Node, right: Node) -> Node:
    found: Node = number(0)
    if not is_zero(left):
        exponent = value_of(tree.right)
        less = minus(tree.right, number(1)) if exponent is None else number(exponent - 1)
        found = times(times(tree.right, binary(ast.Pow, tree.left, less)), left)
    if not is_zero(right):
        found = plus(found, times(times(tree, call("log", tree.left)), right))
    return found


def _outer(function: str, tree: ast.Call) -> Node:
    x = tree.args[0]
    square = binary(ast.Pow, x, number(2))
    rules: dict[str, Callable[[], Node]] = {
        "sin": lambda: call("cos", x),
        "cos": lambda: negative(call("sin", x)),
        "tan": lambda: binary(ast.Add, number(1), binary(ast.Pow, tree, number(2))),
        "cot": lambda: negative(binary(ast.Add, number(1), binary(ast.Pow, tree, number(2)))),
        "asin": lambda: over(number(1), call("sqrt", binary(ast.Sub, number(1), square))),
        "acos": lambda: negative(over(number(1), call("sqrt", binary(ast.Sub, number(1), square)))),
        "atan": lambda: over(number(1), binary(ast.Add, number(1), square)),
        "sqrt": lambda: over(number(1), binary(ast.Mult, number(2), tree)),
        "exp": lambda: tree,
        "log": lambda: over(number(1), x),
        "abs": lambda: over(x, tree),
    }
    if function not in rules:
        raise BadInput(f"{function}() has no derivative here; there are {', '.join(rules)}")
    return rules[function]()


def is_zero(tree: Node) -> bool:
    """Whether a tree is the number 0."""
    return value_of(tree) == 0


def plus(left: Node, right: Node) -> Node:
    """Sum without zeros."""
    return right if is_zero(left) else left if is_zero(right) else binary(ast.Add, left, right)


def minus(left: Node, right: Node) -> Node:
    """Difference without zeros."""
    if is_zero(left):
        return right if is_zero(right) else negative(right)
    return left if is_zero(right) else binary(ast.Sub, left, right)


def times(left: Node, right: Node) -> Node:
    """Product without zeros and ones."""
    if is_zero(left) or is_zero(right):
        return number(0)
    return right if value_of(left) == 1 else left if value_of(right) == 1 else binary(ast.Mult, left, right)


def over(left: Node, right: Node) -> Node:
    """Quotient without zeros and ones."""
    return number(0) if is_zero(left) else left if value_of(right) == 1 else binary(ast.Div, left, right)


def by_name(names: dict[str, str]) -> Rate:
    """Rates that are names, 0 for every other letter."""
    return lambda letter: name(names[letter]) if letter in names else number(0)
