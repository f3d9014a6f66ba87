"""The list of slips: single edits that can be made without knowing the right formula."""

import ast
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

from mechsym.audit.edits import Edit, Spot, is_exponent, is_product, places, scaled
from mechsym.audit.tree import (
    Node,
    binary,
    call,
    function_of,
    is_operation,
    name,
    negative,
    number,
    substitute,
    value_of,
)

FACTORS = tuple(Fraction(*f) for f in ((2, 1), (1, 2), (3, 1), (1, 3), (4, 1), (1, 4), (3, 2), (2, 3)))

CIRCULAR = ("sin", "cos", "tan")
INVERSE = ("asin", "acos", "atan")


def single_edits(tree: Node, siblings: Callable[[str], Sequence[str]]) -> Iterator[Edit]:
    """Every single edit that can be listed without knowing the right formula.

    Parameters
    ----------
    siblings : callable
        Takes a letter and gives the letters it may be mistaken for

    Yields
    ------
    edit : Edit
        Changes; some give the same function
    """
    for place in places(tree):
        for kind, new in node_edits(place, siblings):
            yield Edit(kind=kind, path=place.path, new=new)


def node_edits(place: Spot, siblings: Callable[[str], Sequence[str]]) -> Iterator[tuple[str, Node]]:
    """Every slip at one place: its kind, and what stands there without it."""
    node = place.node
    yield from _signs(place)
    yield from _factors(place)
    if isinstance(node, ast.Name):
        yield from (("letter", name(other)) for other in siblings(node.id))
    if isinstance(node, ast.Constant) and not is_exponent(place) and isinstance(node.value, int):
        yield from (("number", number(n)) for n in (node.value - 1, node.value + 1) if n > 0)
    for kin in (CIRCULAR, INVERSE):
        if function_of(node) in kin:
            others = [f for f in kin if f != function_of(node)]
            yield from (("sine and cosine", call(other, node.args[0])) for other in others)  # type: ignore[attr-defined]
    if function_of(node) == "abs":
        yield "sign", node.args[0]  # type: ignore[attr-defined]
    yield from _powers(place)
    yield from _brackets(node)
    yield from _squares(node)
    yield from _left_out(node)
    yield from _inversions(node)


def _signs(place: Spot) -> Iterator[tuple[str, Node]]:
    node = place.node
    if is_operation(node, ast.Add, ast.Sub):
        other = ast.Sub if is_operation(node, ast.Add) else ast.Add
        yield "sign", binary(other, node.left, node.right)  # type: ignore[attr-defined]
    leads = place.parent is not None and is_operation(place.parent, ast.Add, ast.Sub) and place.path[-1] == "left"
    if place.parent is None or (leads and not is_operation(node, ast.Add, ast.Sub)) or is_exponent(place):
        yield "sign", negative(node)


def _factors(place: Spot) -> Iterator[tuple[str, Node]]:
    if not is_product(place) or isinstance(place.node, ast.UnaryOp):
        return
    in_function = place.parent is not None and function_of(place.parent) in CIRCULAR
    for factor in FACTORS if not in_function else FACTORS[:2]:
        yield "argument" if in_function else "factor", scaled(place.node, factor)
    if in_function:
        yield from (("degrees", new) for new in in_degrees(place.node))


def in_degrees(node: Node) -> Iterator[Node]:
    """An angle phi where it is counted in degrees, and back; pi/180 that stands there already is taken out."""
    pi, half = name("pi"), number(180)
    plain = substitute(node, lambda n: _without_degrees(n))
    if plain is not node:
        yield plain
    yield binary(ast.Div, binary(ast.Mult, node, pi), half)
    yield binary(ast.Div, binary(ast.Mult, node, half), pi)


def _without_degrees(node: Node) -> Node | None:
    def is_degree(a: Node, b: Node) -> bool:
        pair = [n.id if isinstance(n, ast.Name) else value_of(n) for n in (a, b)]
        return pair in (["pi", 180], [180, "pi"])

    if is_operation(node, ast.Mult) and is_operation(node.right, ast.Div):  # type: ignore[attr-defined]
        assert isinstance(node, ast.BinOp) and isinstance(node.right, ast.BinOp)
        return node.left if is_degree(node.right.left, node.right.right) else None
    if is_operation(node, ast.Div) and is_operation(node.left, ast.Mult):  # type: ignore[attr-defined]
        assert isinstance(node, ast.BinOp) and isinstance(node.left, ast.BinOp)
        if is_degree(node.left.right, node.right):
            return node.left.left
        return node.left.right if is_degree(node.left.left, node.right) else None
    return None


def _powers(place: Spot) -> Iterator[tuple[str, Node]]:
    node = place.node
    if is_operation(node, ast.Pow):
        base, exponent = node.left, value_of(node.right)  # type: ignore[attr-defined]
        if exponent is not None:
            for new in dict.fromkeys((exponent - 1, exponent + 1, exponent / 2, exponent * 2, Fraction(1))):
                yield "power", base if new == 1 else binary(ast.Pow, base, number(new)) if new else number(1)
        elif isinstance(node.right, ast.Name):  # type: ignore[attr-defined]
            yield "power", binary(ast.Pow, base, binary(ast.Div, number(1), node.right))  # type: ignore[attr-defined]
    elif _is_factor(place):
        yield from (("power", binary(ast.Pow, node, number(n))) for n in (2, 3, 4))
        yield "power", binary(ast.Pow, node, number(Fraction(3, 2), decimal=True))
        yield "root", call("sqrt", node)
    elif is_product(place) and is_operation(node, ast.Mult, ast.Div):
        yield "power", binary(ast.Pow, node, number(2))
        yield "root", call("sqrt", node)
    if function_of(node) == "sqrt":
        yield "root", node.args[0]  # type: ignore[attr-defined]


def _brackets(node: Node) -> Iterator[tuple[str, Node]]:
    # a*(b + c) read as a*b + c, sqrt(a) + b read as sqrt(a + b), and back
    if not isinstance(node, ast.BinOp):
        if isinstance(node, ast.Call) and is_operation(node.args[0], ast.Add, ast.Sub, ast.Mult, ast.Div):
            inner = node.args[0]
            assert isinstance(inner, ast.BinOp)
            yield "bracket", binary(type(inner.op), call(str(function_of(node)), inner.left), inner.right)
        return
    left, right = node.left, node.right
    yield from (("bracket", new) for new in _closed_too_soon(node))
    if is_operation(node, ast.Add, ast.Sub):
        if is_operation(left, ast.Mult, ast.Div):
            assert isinstance(left, ast.BinOp)
            yield "bracket", binary(type(left.op), left.left, binary(type(node.op), left.right, right))
        if is_operation(left, ast.Add, ast.Sub) and is_operation(left.right, ast.Mult, ast.Div):  # type: ignore[attr-defined]
            assert isinstance(left, ast.BinOp) and isinstance(left.right, ast.BinOp)
            inner = left.right
            bracket = binary(type(inner.op), inner.left, binary(type(node.op), inner.right, right))
            yield "bracket", binary(type(left.op), left.left, bracket)
        if isinstance(left, ast.Call):
            yield "bracket", call(str(function_of(left)), binary(type(node.op), left.args[0], right))
    yield from (("bracket", new) for new in _lost_brackets(node))
    if is_operation(node, ast.Mult, ast.Div) and is_operation(right, ast.Add, ast.Sub):
        assert isinstance(right, ast.BinOp)
        yield "bracket", binary(type(right.op), binary(type(node.op), left, right.left), right.right)


def _closed_too_soon(node: ast.BinOp) -> Iterator[Node]:
    # cos(a*b) printed cos(a)*b, also behind a factor
    if not is_operation(node, ast.Mult, ast.Div):
        return
    left = node.left
    if isinstance(left, ast.Call):
        yield call(str(function_of(left)), binary(type(node.op), left.args[0], node.right))
    if is_operation(left, ast.Mult, ast.Div) and isinstance(left.right, ast.Call):  # type: ignore[attr-defined]
        assert isinstance(left, ast.BinOp) and isinstance(left.right, ast.Call)
        whole = call(str(function_of(left.right)), binary(type(node.op), left.right.args[0], node.right))
        yield binary(type(left.op), left.left, whole)


def _lost_brackets(node: ast.BinOp) -> Iterator[Node]:
    # (a + b)/c printed a/c + b or a + b/c, (a*b)**2 printed a*b**2, and 1/(a*b) printed 1/a*b
    left, right = node.left, node.right
    outer = (ast.Mult, ast.Div, ast.Pow)
    if is_operation(node, ast.Add, ast.Sub):
        if is_operation(left, ast.Mult, ast.Div):
            yield binary(type(left.op), binary(type(node.op), left.left, right), left.right)  # type: ignore[attr-defined]
        if is_operation(right, *outer):
            assert isinstance(right, ast.BinOp)
            yield binary(type(right.op), binary(type(node.op), left, right.left), right.right)
            if is_operation(left, ast.Add, ast.Sub):
                assert isinstance(left, ast.BinOp)
                inner = type(node.op) if is_operation(left, ast.Add) else _opposite(node)
                yield binary(
                    type(left.op), left.left, binary(type(right.op), binary(inner, left.right, right.left), right.right)
                )
    if is_operation(node, ast.Mult, ast.Div) and is_operation(right, ast.Pow):
        assert isinstance(right, ast.BinOp)
        yield binary(ast.Pow, binary(type(node.op), left, right.left), right.right)
    if is_operation(node, ast.Mult) and is_operation(left, ast.Div):
        yield binary(ast.Div, left.left, binary(ast.Mult, left.right, right))  # type: ignore[attr-defined]
    if is_operation(node, ast.Div) and is_operation(right, ast.Mult):
        yield binary(ast.Mult, binary(ast.Div, left, right.left), right.right)  # type: ignore[attr-defined]
    if is_operation(node, ast.Pow) and is_operation(left, ast.Mult, ast.Div, ast.Add, ast.Sub):
        yield binary(type(left.op), left.left, binary(ast.Pow, left.right, right))  # type: ignore[attr-defined]


def _opposite(node: ast.BinOp) -> type[ast.operator]:
    return ast.Sub if is_operation(node, ast.Add) else ast.Add


def _squares(node: Node) -> Iterator[tuple[str, Node]]:
    # the square of a sum or the sum of squares
    argument = node.args[0] if isinstance(node, ast.Call) and function_of(node) == "sum" else None
    if argument is not None:
        yield from (("squares", new) for new in [_sums_squared(argument)] if new is not None)
    if not isinstance(node, ast.BinOp):
        return
    left, right = node.left, node.right
    if is_operation(node, ast.Pow) and is_operation(left, ast.Add, ast.Sub):
        assert isinstance(left, ast.BinOp)
        a, b = (binary(ast.Pow, side, right) for side in (left.left, left.right))
        yield "squares", binary(type(left.op), a, b)
    if is_operation(node, ast.Add, ast.Sub) and all(is_operation(side, ast.Pow) for side in (left, right)):
        assert isinstance(left, ast.BinOp) and isinstance(right, ast.BinOp)
        if value_of(left.right) is not None and value_of(left.right) == value_of(right.right):
            yield "squares", binary(ast.Pow, binary(type(node.op), left.left, right.left), left.right)


def _sums_squared(argument: Node) -> Node | None:
    # sum(a^2 + b^2) as sum(a)^2 + sum(b)^2
    if is_operation(argument, ast.Add, ast.Sub):
        assert isinstance(argument, ast.BinOp)
        left, right = _sums_squared(argument.left), _sums_squared(argument.right)
        return None if left is None or right is None else binary(type(argument.op), left, right)
    if is_operation(argument, ast.Pow):
        assert isinstance(argument, ast.BinOp)
        return binary(ast.Pow, call("sum", argument.left), argument.right)
    return None


def _left_out(node: Node) -> Iterator[tuple[str, Node]]:
    if not is_operation(node, ast.Add, ast.Sub, ast.Mult, ast.Div):
        return
    assert isinstance(node, ast.BinOp)
    yield "left out", node.left
    if is_operation(node, ast.Sub):
        yield "left out", negative(node.right)
    elif is_operation(node, ast.Div):
        yield "left out", binary(ast.Div, number(1), node.right)
    else:
        yield "left out", node.right


def _inversions(node: Node) -> Iterator[tuple[str, Node]]:
    if is_operation(node, ast.Div):
        assert isinstance(node, ast.BinOp)
        yield "inverted", binary(ast.Mult, node.left, node.right)
        yield "inverted", binary(ast.Div, node.right, node.left)
    elif is_operation(node, ast.Mult):
        assert isinstance(node, ast.BinOp)
        yield "inverted", binary(ast.Div, node.left, node.right)


def _is_factor(place: Spot) -> bool:
    # what may carry a power or a root of its own
    if isinstance(place.node, (ast.Constant, ast.UnaryOp)) or is_operation(place.node, ast.Mult, ast.Div, ast.Pow):
        return False
    base = place.parent is not None and is_operation(place.parent, ast.Pow)
    return not base and not is_exponent(place)
