"""Formulas as Python syntax trees with a short list of allowed nodes, edited by replacing one node.

A tree keeps the form that its author printed, which a computer algebra system would lose. Nodes are `ast` nodes and
are never changed in place; trees share what they have in common. Numbers are exact: `0.25` means 1/4. What else a
formula may hold (two arguments, degrees, cases) is a tree of the few functions that trees hold.
"""

import ast
from collections.abc import Callable, Iterator, Mapping, Sequence
from fractions import Fraction
from functools import cache
from hashlib import blake2b
from typing import TypeGuard

from mechsym.errors import BadInput

Node = ast.expr
Path = tuple[str, ...]  # steps from the root: left, right, operand, argument, test, body, orelse, less, more
# what is known of a node is kept with it, for nodes never change
_DIGEST, _LETTERS = "_digest", "_letters"


def name(text: str) -> ast.Name:
    """A letter."""
    return ast.Name(id=text, ctx=ast.Load())


def number(value: Fraction | int, decimal: bool = False) -> Node:
    """A number as an author writes it: a constant, tenths and smaller parts by a point, or a quotient of constants."""
    value = Fraction(value)
    if value < 0:
        return negative(number(-value, decimal))
    if value.denominator == 1:
        return ast.Constant(value=int(value))
    if (decimal or value.denominator % 10 == 0) and Fraction(repr(float(value))) == value:
        return ast.Constant(value=float(value))
    return binary(ast.Div, ast.Constant(value=value.numerator), ast.Constant(value=value.denominator))


def negative(node: Node) -> Node:
    """The negative of an expression; two signs cancel."""
    return node.operand if isinstance(node, ast.UnaryOp) else ast.UnaryOp(op=ast.USub(), operand=node)


def binary(operator: type[ast.operator], left: Node, right: Node) -> ast.BinOp:
    """An operation on two expressions."""
    return ast.BinOp(left=left, op=operator(), right=right)


def call(function: str, argument: Node) -> ast.Call:
    """A function of one expression."""
    return ast.Call(func=name(function), args=[argument], keywords=[])


def is_operation(node: Node, *operators: type[ast.operator]) -> TypeGuard[ast.BinOp]:
    """Whether a node is one of the named operations."""
    return isinstance(node, ast.BinOp) and isinstance(node.op, operators)


def function_of(node: Node) -> str | None:
    """Name of the function that a node calls, if it is a call."""
    return node.func.id if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) else None


def argument_of(node: Node, *functions: str) -> Node | None:
    """What a node is a function of, if it calls one of the named functions, or any where none is named."""
    called = function_of(node)
    return node.args[0] if isinstance(node, ast.Call) and (not functions or called in functions) else None


@cache
def as_printed(constant: object) -> Fraction:
    """The number that a constant is printed as: 0.1 is a tenth."""
    return Fraction(str(constant))


def value_of(node: Node) -> Fraction | None:
    """Exact value of a number, a negative number or a quotient of numbers; None of anything else."""
    if isinstance(node, (ast.Name, ast.Call)):
        return None
    if isinstance(node, ast.Constant):
        return as_printed(node.value)
    if isinstance(node, ast.UnaryOp):
        inner = value_of(node.operand)
        return None if inner is None else -inner
    if is_operation(node, ast.Div):
        above, below = value_of(node.left), value_of(node.right)
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
    if isinstance(node, ast.UnaryOp):
        return [("operand", node.operand)]
    if isinstance(node, ast.IfExp):
        return [("test", node.test), ("body", node.body), ("orelse", node.orelse)]
    return []


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
    """The tree with every node that `change` answers to replaced; None of it keeps a node and looks at its operands."""
    new = change(tree)
    if new is not None:
        return new
    for step, child in children(tree):
        below = substitute(child, change)
        if below is not child:
            tree = replace(tree, (step,), below)
    return tree


def renamed(tree: Node, meant: Mapping[str, str]) -> Node:
    """A tree with other names for some of its letters."""
    return substitute(tree, lambda n: name(meant[n.id]) if isinstance(n, ast.Name) and n.id in meant else None)


def without_double_signs(tree: Node) -> Node:
    """A tree with a + b in the place of a - -b, and a - b in that of a + -b."""

    def turned(node: Node) -> Node | None:
        if not is_operation(node, ast.Add, ast.Sub):
            return None
        path: list[str] = []
        while is_operation(first := at(node.right, tuple(path)), ast.Mult, ast.Div):
            path.append("left")
        if not isinstance(first, ast.UnaryOp) or not isinstance(first.op, ast.USub):
            return None
        right = replace(node.right, tuple(path), first.operand)
        sign = ast.Add if isinstance(node.op, ast.Sub) else ast.Sub
        return binary(sign, without_double_signs(node.left), without_double_signs(right))

    return substitute(tree, turned)


def with_one_number(tree: Node) -> Node:
    """A tree with a in the place of a - 1 + 1, and a + 1 in that of a - 1 + 2."""

    def added(node: Node) -> Node | None:
        if not is_operation(node, ast.Add, ast.Sub) or not is_operation(node.left, ast.Add, ast.Sub):
            return None
        last, first = value_of(node.right), value_of(node.left.right)
        if last is None or first is None:
            return None
        total = (last if isinstance(node.op, ast.Add) else -last) + (
            first if isinstance(node.left.op, ast.Add) else -first
        )
        below = with_one_number(node.left.left)
        return binary(ast.Add if total > 0 else ast.Sub, below, number(abs(total))) if total else below

    return substitute(tree, added)


def letters(tree: Node) -> tuple[str, ...]:
    """Letters of an expression in the order of their first use."""
    known: tuple[str, ...] | None = tree.__dict__.get(_LETTERS)
    if known is None:
        below = (tree.id,) if isinstance(tree, ast.Name) else (k for _, c in children(tree) for k in letters(c))
        known = tree.__dict__[_LETTERS] = tuple(dict.fromkeys(below))
    return known


def summands(tree: Node) -> list[Node]:
    """Parts of a sum, without their signs."""
    if is_operation(tree, ast.Add, ast.Sub):
        return [*summands(tree.left), *summands(tree.right)]
    return [tree.operand] if isinstance(tree, ast.UnaryOp) else [tree]


def factors(tree: Node) -> list[Node]:
    """Parts of a product."""
    return [*factors(tree.left), *factors(tree.right)] if is_operation(tree, ast.Mult) else [tree]


def digest(tree: Node) -> bytes:
    """What an expression says in sixteen bytes: the same for two nodes that say the same."""
    known: bytes | None = tree.__dict__.get(_DIGEST)
    if known is not None:
        return known
    if isinstance(tree, ast.Name):
        said = tree.id.encode()
    elif isinstance(tree, ast.Constant):
        said = repr(tree.value).encode()
    else:
        operator = getattr(tree, "op", None) or (tree.ops[0] if isinstance(tree, ast.Compare) else None)
        words = function_of(tree) or type(operator or tree).__name__
        said = b"|".join([words.encode(), *(digest(child) for _, child in children(tree))])
    known = tree.__dict__[_DIGEST] = blake2b(said, digest_size=16).digest()
    return known


FUNCTIONS = ("sin", "cos", "tan", "cot", "asin", "acos", "atan", "sqrt", "exp", "log", "abs", "sum")
OPERATORS = (ast.Add, ast.Sub, ast.Mult, ast.Div, ast.Pow)
COMPARISONS = (ast.Lt, ast.LtE, ast.Gt, ast.GtE)
MODULES = ("np", "numpy", "math", "cmath", "sp", "sympy", "Math", "Modelica", "mpmath", "std", "torch", "jnp")
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
        # a bool is an int, but no number of a formula
        plain = isinstance(node.value, (int, float)) and not isinstance(node.value, bool)
        if not plain or not (node.value == 0 or LEAST < node.value < LARGEST):  # type: ignore[operator]
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


def _atan2(y: Node, x: Node) -> Node:
    # exact but on the negative x axis, where the angle jumps
    length = call("sqrt", binary(ast.Add, _square(x), _square(y)))
    return binary(ast.Mult, number(2), call("atan", binary(ast.Div, y, binary(ast.Add, length, x))))


def _extreme(sign: type[ast.operator]) -> Callable[[Node, Node], Node]:
    def of(a: Node, b: Node) -> Node:
        spread = call("abs", binary(ast.Sub, a, b))
        return binary(ast.Div, binary(sign, binary(ast.Add, a, b), spread), number(2))

    return of


def _hyperbolic(sign: type[ast.operator]) -> Callable[[Node], Node]:
    return lambda a: binary(ast.Div, binary(sign, call("exp", a), call("exp", negative(a))), number(2))


def _square(a: Node) -> Node:
    return binary(ast.Pow, a, number(2))


def _radians(a: Node) -> Node:
    return binary(ast.Div, binary(ast.Mult, a, name("pi")), number(180))


def _degrees(a: Node) -> Node:
    return binary(ast.Div, binary(ast.Mult, a, number(180)), name("pi"))


def _power(a: Node, b: Node) -> Node:
    return binary(ast.Pow, a, b)


MEANINGS: dict[str, tuple[int, Callable[..., Node]]] = {
    "atan2": (2, _atan2),
    "arctan2": (2, _atan2),
    "pow": (2, _power),
    "power": (2, _power),
    "hypot": (2, lambda a, b: call("sqrt", binary(ast.Add, _square(a), _square(b)))),
    "max": (2, _extreme(ast.Add)),
    "fmax": (2, _extreme(ast.Add)),
    "min": (2, _extreme(ast.Sub)),
    "fmin": (2, _extreme(ast.Sub)),
    "square": (1, _square),
    "sqr": (1, _square),
    "cbrt": (1, lambda a: binary(ast.Pow, a, binary(ast.Div, number(1), number(3)))),
    "radians": (1, _radians),
    "deg2rad": (1, _radians),
    "degrees": (1, _degrees),
    "rad2deg": (1, _degrees),
    "sec": (1, lambda a: binary(ast.Div, number(1), call("cos", a))),
    "csc": (1, lambda a: binary(ast.Div, number(1), call("sin", a))),
    "sinh": (1, _hyperbolic(ast.Sub)),
    "cosh": (1, _hyperbolic(ast.Add)),
    "tanh": (1, lambda a: binary(ast.Div, _hyperbolic(ast.Sub)(a), _hyperbolic(ast.Add)(a))),
    "log10": (1, lambda a: binary(ast.Div, call("log", a), call("log", number(10)))),
    "sind": (1, lambda a: call("sin", _radians(a))),
    "cosd": (1, lambda a: call("cos", _radians(a))),
    "tand": (1, lambda a: call("tan", _radians(a))),
    "asind": (1, lambda a: _degrees(call("asin", a))),
    "acosd": (1, lambda a: _degrees(call("acos", a))),
    "atand": (1, lambda a: _degrees(call("atan", a))),
}


def meaning(function: str, arguments: Sequence[Node]) -> Node | None:
    """A function of several arguments as a tree; None where it is not in the list."""
    if function == "piecewise":
        return piecewise(arguments)
    if function not in MEANINGS:
        return None
    count, make = MEANINGS[function]
    if len(arguments) != count:
        shown = ", ".join("abc"[:count])
        raise BadInput(f"{function} takes {count} arguments, not {len(arguments)}; write {function}({shown})")
    return make(*arguments)


def piecewise(arguments: Sequence[Node]) -> Node:
    """`piecewise(a < b, x, c < d, y, z)`: x where a < b, else y where c < d, else z."""
    if len(arguments) == 1 and not isinstance(arguments[0], ast.Compare):
        return arguments[0]
    if len(arguments) < 3 or not isinstance(arguments[0], ast.Compare):
        raise BadInput("piecewise takes condition, value, .., and last the value otherwise, as piecewise(a < b, x, y)")
    return ast.IfExp(test=arguments[0], body=arguments[1], orelse=piecewise(arguments[2:]))
