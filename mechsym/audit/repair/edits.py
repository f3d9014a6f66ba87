"""Single edits of a printed formula: what an author, a typesetter or a scanner most often gets wrong."""

import ast
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import reduce
from math import gcd

from mechsym.audit.read.tree import (
    Node,
    Path,
    binary,
    call,
    children,
    function_of,
    is_operation,
    name,
    negative,
    number,
    replace,
    value_of,
    walk,
)
from mechsym.quantities import record


@record
class Edit:
    """One change of a formula."""

    kind: str
    path: Path
    new: Node
    about: str = ""  #: What was changed, where the whole formula is given anew


@record
class Spot:
    """A node with what surrounds it."""

    path: Path
    node: Node
    parent: Node | None


def places(tree: Node) -> Iterator[Spot]:
    """Every node with its parent, a node before its operands."""
    waiting = [Spot(path=(), node=tree, parent=None)]
    while waiting:
        place = waiting.pop()
        yield place
        below = [Spot(path=(*place.path, s), node=c, parent=place.node) for s, c in children(place.node)]
        waiting += reversed(below)


def chained(operator: type[ast.operator], parts: Sequence[Node]) -> Node:
    """Parts joined by one operator, from the left."""
    return reduce(lambda left, right: binary(operator, left, right), parts)


def apply(tree: Node, edit: Edit) -> Node:
    """The formula after an edit."""
    return replace(tree, edit.path, edit.new)


def without_double_signs(tree: Node) -> Node:
    """The same formula with `a - -b*c` written `a + b*c`."""
    for step, child in children(tree):
        below = without_double_signs(child)
        if below is not child:
            tree = replace(tree, (step,), below)
    if not is_operation(tree, ast.Add, ast.Sub):
        return tree
    positive = _without_leading_sign(tree.right)
    if positive is None:
        return tree
    return binary(ast.Sub if is_operation(tree, ast.Add) else ast.Add, tree.left, positive)


def _without_leading_sign(node: Node) -> Node | None:
    if isinstance(node, ast.UnaryOp):
        return node.operand
    if is_operation(node, ast.Mult, ast.Div):
        left = _without_leading_sign(node.left)
        return None if left is None else binary(type(node.op), left, node.right)
    return None


def is_term(place: Spot) -> bool:
    """Whether a node is the top of a sum, or no part of one."""
    return place.parent is None or not is_operation(place.parent, ast.Add, ast.Sub)


def is_product(place: Spot) -> bool:
    """Whether a node is the top of a product or of a divisor: a factor here could not be put further up."""
    parent, step = place.parent, place.path[-1:]
    if parent is None or step == ("argument",):
        return True
    if isinstance(parent, ast.UnaryOp) or is_operation(parent, ast.Mult) or is_exponent(place):
        return False
    return not (is_operation(parent, ast.Div) and step == ("left",))


def is_exponent(place: Spot) -> bool:
    """Whether a node is an exponent."""
    return place.parent is not None and is_operation(place.parent, ast.Pow) and place.path[-1] == "right"


def scaled(node: Node, factor: Fraction) -> Node:
    """An expression times a number, the number merged with one that is there already."""
    if factor == 1:
        return node
    own = value_of(node)
    if own is not None:
        return number(own * factor, decimal=isinstance(node, ast.Constant) and isinstance(node.value, float))
    if is_operation(node, ast.Mult, ast.Div) and _leading_number(node) is not None:
        left = scaled(node.left, factor)
        if value_of(left) == 1 and isinstance(node.op, ast.Mult):
            return node.right
        return binary(type(node.op), left, node.right)
    if is_operation(node, ast.Div) and (below := value_of(node.right)) is not None:
        divisor = below / factor
        if divisor == 1:
            return node.left
        if divisor.denominator == 1:
            return binary(ast.Div, node.left, number(divisor))
    if factor.numerator == 1:
        return binary(ast.Div, node, number(factor.denominator))
    return _led_by(number(factor), node)


def _led_by(factor: Node, node: Node) -> Node:
    # 2*a*b, not 2*(a*b)
    if is_operation(node, ast.Mult, ast.Div):
        return binary(type(node.op), _led_by(factor, node.left), node.right)
    return binary(ast.Mult, factor, node)


def _leading_number(node: Node) -> Fraction | None:
    while is_operation(node, ast.Mult, ast.Div) and value_of(node) is None:
        node = node.left
    return value_of(node)


def tidy(tree: Node, printed: Node) -> Node:
    """A formula whose parts that its author did not print are written plainly."""
    return _tidy(tree, {id(node) for _, node in walk(printed)})


def _tidy(node: Node, printed: set[int]) -> Node:
    if id(node) in printed:
        return node
    for step, child in children(node):
        below = _tidy(child, printed)
        if below is not child:
            node = replace(node, (step,), below)
    if (function := function_of(node)) in ("sin", "cos", "tan") and isinstance(node, ast.Call):
        inner = node.args[0]  # the sine of -x
        if isinstance(inner, ast.UnaryOp):
            plain = call(function, inner.operand)
            return plain if function == "cos" else negative(plain)
    if is_operation(node, ast.Mult) and isinstance(node.right, ast.UnaryOp):
        return _negated(binary(ast.Mult, node.left, node.right.operand))
    if not isinstance(node, ast.BinOp):
        return node
    left, right = value_of(node.left), value_of(node.right)
    if is_operation(node, ast.Add, ast.Sub):
        return _added_up(node)
    if right == 1 and is_operation(node, ast.Mult, ast.Div, ast.Pow):
        return node.left
    if left == 1 and is_operation(node, ast.Mult):
        return node.right
    if is_operation(node, ast.Mult) and (square := _squared(node)) is not None:
        return square
    if left is not None and right is not None and is_operation(node, ast.Mult):
        return number(left * right, decimal=True)
    if is_operation(node, ast.Div) and left is not None and right and left.denominator == right.denominator == 1:
        return node if gcd(int(left), int(right)) == 1 else number(left / right)
    if is_operation(node, ast.Div) and is_operation(node.left, ast.Div):  # (1/2)/pi, (a/b)/2
        one, other = (node.right, node.left.right) if right is not None else (node.left.right, node.right)
        return binary(ast.Div, node.left.left, _led_by(one, other))
    return _with_one_pi(node)


def _squared(node: ast.BinOp) -> Node | None:
    # a*x*x
    before = node.left.right if is_operation(node.left, ast.Mult) else node.left
    last = node.right
    if not isinstance(last, ast.Name) or not isinstance(before, ast.Name) or before.id != last.id:
        return None
    square = binary(ast.Pow, last, number(2))
    return square if before is node.left else binary(ast.Mult, node.left.left, square)  # type: ignore[attr-defined]


def _added_up(node: ast.BinOp) -> Node:
    # x + 0, (x - 1) + 1
    last, plus = value_of(node.right), isinstance(node.op, ast.Add)
    if last is None:
        return node.right if plus and value_of(node.left) == 0 else node
    added, base = last if plus else -last, node.left
    if is_operation(base, ast.Add, ast.Sub):
        inner = value_of(base.right)
        if inner is not None:
            added += inner if isinstance(base.op, ast.Add) else -inner
            base = base.left
    elif (whole := value_of(base)) is not None:
        return number(whole + added)
    if not added:
        return base
    return binary(ast.Add if added > 0 else ast.Sub, base, number(abs(added)))


def _negated(node: Node) -> Node:
    # -a b, not -(a b)
    if is_operation(node, ast.Mult, ast.Div):
        return binary(type(node.op), _negated(node.left), node.right)
    return negative(node)


def _with_one_pi(node: ast.BinOp) -> Node:
    # pi*omega/(2*pi**2): what was multiplied in stands on the other side already
    above, below = ([_split_power(factor) for factor in factors(node, side)] for side in (True, False))
    powers = [sum(power for base, power in side if _is_pi(base)) for side in (above, below)]
    if not all(powers):
        return node
    sides = []
    for side, more in ((above, powers[0] - powers[1]), (below, powers[1] - powers[0])):
        every = [(base, power) for base, power in side if not _is_pi(base) and value_of(base) != 1]
        every += [(name("pi"), more)] if more > 0 else []
        raised = [base if power == 1 else binary(ast.Pow, base, number(power)) for base, power in every]
        sides.append(reduce(lambda one, other: binary(ast.Mult, one, other), raised or [number(1)]))
    return sides[0] if value_of(sides[1]) == 1 else binary(ast.Div, *sides)


def _is_pi(node: Node) -> bool:
    return isinstance(node, ast.Name) and node.id == "pi"


def factors(node: Node, above: bool) -> Iterator[Node]:
    """Factors of a product that stand above the stroke, or below it."""
    if is_operation(node, ast.Mult, ast.Div):
        yield from factors(node.left, above)
        yield from factors(node.right, above == isinstance(node.op, ast.Mult))
    elif above:
        yield node


def _split_power(node: Node) -> tuple[Node, int]:
    """Base and power of a factor, the power 1 where it is no whole number."""
    if is_operation(node, ast.Pow):
        power = value_of(node.right)
        if power is not None and power.denominator == 1:
            return node.left, int(power)
    return node, 1
