"""The list of slips: edits of one place that need no knowledge of the right formula, and of several parts at once.

The wider ones (runs of a sum or a product, letters throughout, complements) are tried when no slip of one place mends
the formula, and count only where they make it exact.
"""

import ast
from collections.abc import Callable, Iterator, Sequence
from fractions import Fraction

from mechsym.audit.judge.dimensions import ANGLE, kind_of_letter
from mechsym.audit.judge.question import Question
from mechsym.audit.read.tree import (
    Node,
    Path,
    argument_of,
    binary,
    call,
    function_of,
    is_operation,
    letters,
    name,
    negative,
    number,
    substitute,
    value_of,
)
from mechsym.audit.repair.edits import Edit, Spot, is_exponent, is_product, is_term, places, scaled
from mechsym.audit.theory.record import dependencies

FACTORS = tuple(Fraction(*f) for f in ((2, 1), (1, 2), (3, 1), (1, 3), (4, 1), (1, 4), (3, 2), (2, 3)))

CIRCULAR = ("sin", "cos", "tan")
INVERSE = ("asin", "acos", "atan")


def single_edits(tree: Node, siblings: Callable[[str], Sequence[str]]) -> Iterator[Edit]:
    """Every single edit that can be listed without knowing the right formula; some give the same function."""
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
        if (argument := argument_of(node, *kin)) is not None:
            yield from (("sine and cosine", call(f, argument)) for f in kin if f != function_of(node))
    if (argument := argument_of(node, "abs")) is not None:
        yield "sign", argument
    yield from _powers(place)
    yield from (("bracket", new) for new in _brackets(node))
    yield from _squares(node)
    if is_operation(node, ast.Add, ast.Sub, ast.Mult, ast.Div):
        one_over = binary(ast.Div, number(1), node.right) if isinstance(node.op, ast.Div) else node.right
        yield "left out", node.left
        yield "left out", negative(node.right) if isinstance(node.op, ast.Sub) else one_over
    # a b for a + b, where a sign was lost, and 2 a for a^2
    if is_operation(node, ast.Mult):
        yield from (("operator", binary(operator, node.left, node.right)) for operator in (ast.Add, ast.Sub, ast.Pow))
    elif is_operation(node, ast.Add, ast.Sub, ast.Pow) and not is_exponent(place):
        yield "operator", binary(ast.Mult, node.left, node.right)
    if is_operation(node, ast.Div):
        yield "inverted", binary(ast.Mult, node.left, node.right)
        yield "inverted", binary(ast.Div, node.right, node.left)
    elif is_operation(node, ast.Mult):
        yield "inverted", binary(ast.Div, node.left, node.right)


def _signs(place: Spot) -> Iterator[tuple[str, Node]]:
    node = place.node
    if is_operation(node, ast.Add, ast.Sub):
        other = ast.Sub if is_operation(node, ast.Add) else ast.Add
        yield "sign", binary(other, node.left, node.right)
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

    if is_operation(node, ast.Mult) and is_operation(node.right, ast.Div):
        return node.left if is_degree(node.right.left, node.right.right) else None
    if is_operation(node, ast.Div) and is_operation(node.left, ast.Mult):
        if is_degree(node.left.right, node.right):
            return node.left.left
        return node.left.right if is_degree(node.left.left, node.right) else None
    return None


def _powers(place: Spot) -> Iterator[tuple[str, Node]]:
    node = place.node
    if is_operation(node, ast.Pow):
        base, exponent = node.left, value_of(node.right)
        if exponent is not None:
            for new in dict.fromkeys((exponent - 1, exponent + 1, exponent / 2, exponent * 2, Fraction(1))):
                yield "power", base if new == 1 else binary(ast.Pow, base, number(new)) if new else number(1)
        elif isinstance(node.right, ast.Name):
            yield "power", binary(ast.Pow, base, binary(ast.Div, number(1), node.right))
    elif _is_factor(place):
        yield from (("power", binary(ast.Pow, node, number(n))) for n in (2, 3, 4))
        yield "power", binary(ast.Pow, node, number(Fraction(3, 2), decimal=True))
        yield "root", call("sqrt", node)
    elif is_product(place) and is_operation(node, ast.Mult, ast.Div):
        yield "power", binary(ast.Pow, node, number(2))
        yield "root", call("sqrt", node)
    if (argument := argument_of(node, "sqrt")) is not None:
        yield "root", argument


def _brackets(node: Node) -> Iterator[Node]:
    # a*(b + c) read as a*b + c, sqrt(a) + b read as sqrt(a + b), and back; cos(a*b) printed cos(a)*b, also behind a
    # factor; (a + b)/c printed a/c + b or a + b/c, (a*b)**2 printed a*b**2, and 1/(a*b) printed 1/a*b
    if not isinstance(node, ast.BinOp):
        inner = argument_of(node)
        if inner is not None and is_operation(inner, ast.Add, ast.Sub, ast.Mult, ast.Div):
            yield binary(type(inner.op), call(str(function_of(node)), inner.left), inner.right)
        return
    left, right, operator = node.left, node.right, type(node.op)
    if is_operation(node, ast.Mult, ast.Div):
        if isinstance(left, ast.Call):
            yield _around(left, operator, right)
        if is_operation(left, ast.Mult, ast.Div) and isinstance(left.right, ast.Call):
            yield binary(type(left.op), left.left, _around(left.right, operator, right))
    if is_operation(node, ast.Add, ast.Sub):
        yield from _of_terms(left, operator, right)
    if is_operation(node, ast.Mult, ast.Div) and is_operation(right, ast.Pow):
        yield binary(ast.Pow, binary(operator, left, right.left), right.right)
    if is_operation(node, ast.Mult) and is_operation(left, ast.Div):
        yield binary(ast.Div, left.left, binary(ast.Mult, left.right, right))
    if is_operation(node, ast.Div) and is_operation(right, ast.Mult):
        yield binary(ast.Mult, binary(ast.Div, left, right.left), right.right)
    if is_operation(node, ast.Pow) and is_operation(left, ast.Mult, ast.Div, ast.Add, ast.Sub):
        yield binary(type(left.op), left.left, binary(ast.Pow, left.right, right))
    if is_operation(node, ast.Mult, ast.Div) and is_operation(right, ast.Add, ast.Sub):
        yield binary(type(right.op), binary(operator, left, right.left), right.right)


def _of_terms(left: Node, operator: type[ast.operator], right: Node) -> Iterator[Node]:
    if is_operation(left, ast.Mult, ast.Div):
        yield binary(type(left.op), left.left, binary(operator, left.right, right))
    if is_operation(left, ast.Add, ast.Sub) and is_operation(left.right, ast.Mult, ast.Div):
        inner = left.right
        bracket = binary(type(inner.op), inner.left, binary(operator, inner.right, right))
        yield binary(type(left.op), left.left, bracket)
    if isinstance(left, ast.Call):
        yield _around(left, operator, right)
    if is_operation(left, ast.Mult, ast.Div):
        yield binary(type(left.op), binary(operator, left.left, right), left.right)
    if is_operation(right, ast.Mult, ast.Div, ast.Pow):
        yield binary(type(right.op), binary(operator, left, right.left), right.right)
        if is_operation(left, ast.Add, ast.Sub):
            sign = ast.Add if type(left.op) is operator else ast.Sub
            bracket = binary(type(right.op), binary(sign, left.right, right.left), right.right)
            yield binary(type(left.op), left.left, bracket)


def _around(function: ast.Call, operator: type[ast.operator], right: Node) -> Node:
    return call(str(function_of(function)), binary(operator, function.args[0], right))


def _squares(node: Node) -> Iterator[tuple[str, Node]]:
    # the square of a sum or the sum of squares
    argument = argument_of(node, "sum")
    if argument is not None and (new := _sums_squared(argument)) is not None:
        yield "squares", new
    if not isinstance(node, ast.BinOp):
        return
    left, right = node.left, node.right
    if is_operation(node, ast.Pow) and is_operation(left, ast.Add, ast.Sub):
        a, b = (binary(ast.Pow, side, right) for side in (left.left, left.right))
        yield "squares", binary(type(left.op), a, b)
    if is_operation(node, ast.Add, ast.Sub) and is_operation(left, ast.Pow) and is_operation(right, ast.Pow):
        if value_of(left.right) is not None and value_of(left.right) == value_of(right.right):
            yield "squares", binary(ast.Pow, binary(type(node.op), left.left, right.left), left.right)


def _sums_squared(argument: Node) -> Node | None:
    # sum(a^2 + b^2) as sum(a)^2 + sum(b)^2
    if is_operation(argument, ast.Add, ast.Sub):
        left, right = _sums_squared(argument.left), _sums_squared(argument.right)
        return None if left is None or right is None else binary(type(argument.op), left, right)
    if is_operation(argument, ast.Pow):
        return binary(ast.Pow, call("sum", argument.left), argument.right)
    return None


def _is_factor(place: Spot) -> bool:
    # what may carry a power or a root of its own
    if isinstance(place.node, (ast.Constant, ast.UnaryOp)) or is_operation(place.node, ast.Mult, ast.Div, ast.Pow):
        return False
    base = place.parent is not None and is_operation(place.parent, ast.Pow)
    return not base and not is_exponent(place)


_LONGEST = 7  # of a sum or a product of which every run is tried
_SIGN = {True: ast.Add, False: ast.Sub}
_FACTOR = {True: ast.Mult, False: ast.Div}

Siblings = Callable[[str], Sequence[str]]
Run = list[tuple[bool, Node]]  # terms or factors, each with whether it is added or multiplied


def wider_edits(question: Question, tree: Node, siblings: Siblings) -> list[Edit]:
    """Slips of several parts at once; some give the same function."""
    edits = []
    # two letters for each other, or one for another wherever it stands
    used = [k for k in letters(tree) if k != "pi"]
    kinds = {k: kind_of_letter(question, k) for k in used}
    for i, one in enumerate(used):
        for other in used[i + 1 :]:
            if kinds[one] is not None and kinds[one] == kinds[other]:
                told = f"{one} and {other} are taken for each other"
                edits.append(_renamed(tree, {one: other, other: one}, told))
        if sum(isinstance(p.node, ast.Name) and p.node.id == one for p in places(tree)) > 1:
            for other in siblings(one):
                edits.append(_renamed(tree, {one: other}, f"{one} becomes {other} wherever it stands"))
    needed = dependencies(question.theory, [question.quantity])
    needed |= {k for k in question.theory.tape if needed & {f"sin_{k}", f"cos_{k}"}}
    usable = dict.fromkeys([*question.formula.letters, *(k for k in question.theory.letters if k in needed)])
    known = dict.fromkeys([*question.formula.letters, *question.theory.letters, *question.theory.tape])
    angles = [k for k in known if (k in needed or k in used) and kind_of_letter(question, k) == ANGLE]
    for place in places(tree):
        node, path = place.node, place.path
        if is_operation(node, ast.Add, ast.Sub) and is_term(place):
            edits += _of_sum(path, _parts(node, ast.Add, ast.Sub))
        if is_operation(node, ast.Mult, ast.Div) and (is_product(place) or is_term(place)):
            edits += _of_product(path, _parts(node, ast.Mult, ast.Div))
        # x for 1 - x
        if value_of(node) is None and not isinstance(node, ast.UnaryOp) and not is_exponent(place):
            edits.append(Edit(kind="put back", path=path, new=binary(ast.Sub, number(1), node)))
        # sin(phi) for sin(phi + beta), sin(2*pi*phi) for sin(2*pi*phi/duration)
        if place.parent is not None and function_of(place.parent) in CIRCULAR:
            more = [binary(operator, node, name(k)) for k in angles for operator in (ast.Add, ast.Sub)]
            more += [binary(operator, node, name(k)) for k in usable for operator in (ast.Mult, ast.Div)]
            edits += [Edit(kind="argument", path=path, new=new) for new in more]
    return edits


def _renamed(tree: Node, instead: dict[str, str], about: str) -> Edit:
    new = substitute(tree, lambda n: name(instead[n.id]) if isinstance(n, ast.Name) and n.id in instead else None)
    return Edit(kind="everywhere", path=(), new=new, about=about)


def _parts(node: Node, more: type[ast.operator], less: type[ast.operator], first: bool = True) -> Run:
    """Terms of a sum or factors of a product, through brackets of the same kind."""
    if not is_operation(node, more, less):
        return [(first, node)]
    last = first == isinstance(node.op, more)
    return [*_parts(node.left, more, less, first), *_parts(node.right, more, less, last)]


def _of_sum(path: Path, terms: Run) -> Iterator[Edit]:
    # sqrt(a) + b - c for sqrt(a + b - c); a - b - c for a - (b - c)
    for before, inside, after in _cuts(terms):
        plus = inside[0][0]
        whole = _joined([(sign == plus, term) for sign, term in inside], _SIGN)
        yield Edit(kind="root", path=path, new=_joined([*before, (plus, call("sqrt", whole)), *after], _SIGN))
        if before:
            turned = [inside[0], *((not sign, term) for sign, term in inside[1:])]
            yield Edit(kind="bracket", path=path, new=_joined([*before, *turned, *after], _SIGN))
        if len(inside) > 1 and not (before and after):
            square = binary(ast.Pow, whole, number(2))
            yield Edit(kind="power", path=path, new=_joined([*before, (plus, square), *after], _SIGN))


def _of_product(path: Path, factors: Run) -> Iterator[Edit]:
    # a*b/c for a/(b/c), a*sqrt(b*c), a*(1 - b*c)
    for before, inside, after in _cuts(factors):
        if bool(before) != bool(after) and all(above for above, _ in factors):
            # a b c for a + b c
            sums = [_joined(run, _FACTOR) for run in (before, inside, after) if run]
            yield Edit(kind="operator", path=path, new=binary(ast.Add, *sums))
        upright = [(above == inside[0][0], factor) for above, factor in inside]
        turned = [(not above, factor) for above, factor in inside]
        yield Edit(kind="inverted", path=path, new=_joined([*before, *turned, *after], _FACTOR))
        whole = _joined(upright, _FACTOR)
        for kind, new in (
            ("root", call("sqrt", whole)),
            ("power", binary(ast.Pow, whole, number(2))),
            ("put back", binary(ast.Sub, number(1), whole)),
        ):
            yield Edit(kind=kind, path=path, new=_joined([*before, (inside[0][0], new), *after], _FACTOR))


def _cuts(parts: Run) -> Iterator[tuple[Run, Run, Run]]:
    for start in range(len(parts) if len(parts) <= _LONGEST else 0):
        for end in range(start + 2, len(parts) + 1):
            yield parts[:start], parts[start:end], parts[end:]


def _joined(parts: Run, operators: dict[bool, type[ast.operator]]) -> Node:
    # what is added or multiplied first, then the rest; a product has one fraction bar
    first, rest = ([part for sign, part in parts if sign == plus] for plus in (True, False))
    if operators is _FACTOR:
        above = _chained(first, ast.Mult) if first else number(1)
        return binary(ast.Div, above, _chained(rest, ast.Mult)) if rest else above
    if not first:
        return negative(_chained(rest, ast.Add))
    tree = _chained(first, ast.Add)
    for part in rest:
        tree = binary(ast.Sub, tree, part)
    return tree


def _chained(parts: list[Node], operator: type[ast.operator]) -> Node:
    tree = parts[0]
    for part in parts[1:]:
        tree = binary(operator, tree, part)
    return tree
