"""The language of `define` lines: arithmetic with derivatives, roots of equations, curves, sums and cases.

d(e, phi), d(e, phi, 2)            derivative by a letter
dt(e)                              derivative in time
root("equation", u, start)         the u near start for which the equation vanishes; only as a whole definition
curve(x, y).curvature .radius      of the curve that the angle runs through
curve(x, y).normal.x  .offset(R).y its unit normal, to the left of its sense, and the curve at a distance along it
sum(e, k, 1, 4)                    e for k = 1 to 4
piecewise(a < b, e, f)             e where a < b, else f; also atan2, min, max, hypot, radians
"""

import ast

from mechsym.audit import limits
from mechsym.audit.calculus import derivative, minus, over, plus, times
from mechsym.audit.functions import meaning
from mechsym.audit.spelling import from_greek
from mechsym.audit.theory.tape import Entry, Root, TheoryTape
from mechsym.audit.tree import Node, binary, call, letters, name, number, substitute, value_of
from mechsym.errors import BadInput

_ALIASES = {"arcsin": "asin", "arccos": "acos", "arctan": "atan", "ln": "log"}
_MOST = 40  # terms of a sum
_EXAMPLE = "'2*r*(1 - cos(phi))'"
_WORDS = "d(e, phi), dt(e), root, curve, sum(e, k, 1, 4) and piecewise(a < b, e, f)"


def define(own: str, text: str, tape: TheoryTape) -> Entry:
    """What a definition puts on the tape; earlier names of the tape and its letters may be used."""
    tree = _parsed(text)
    if isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and tree.func.id == "root":
        return _root(own, tree, tape)
    found = _expanded(tree, tape)
    _check(found, tape, ())
    return found


def _parsed(text: str) -> ast.expr:
    try:
        return ast.parse(from_greek(text).replace("^", "**").strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        raise BadInput(_unread(text.strip(), error)) from None


def _unread(text: str, error: Exception) -> str:
    if not text:
        return "the definition is empty; write an expression, as 'r*sin(phi)'"
    why, place = getattr(error, "msg", "nested too deep"), getattr(error, "offset", None)
    near = f" near {text[max(0, place - 8) : place + 4]!r}" if place else ""
    return f"{text[:60]!r} cannot be read: {why}{near}; write a * between factors, and brackets in pairs, as {_EXAMPLE}"


def _check(tree: Node, tape: TheoryTape, also: tuple[str, ...]) -> None:
    limits.check(tree)
    for letter in letters(tree):
        if letter not in tape.free and letter not in tape and letter != "pi" and letter not in also:
            known = ", ".join([*tape.free, *tape])
            raise BadInput(f"unknown letter {letter!r}; letters and names defined above it are {known}")


def _root(own: str, tree: ast.Call, tape: TheoryTape) -> Root:
    if len(tree.args) != 3 or not isinstance(tree.args[0], ast.Constant) or not isinstance(tree.args[1], ast.Name):
        raise BadInput('root is written root("equation that vanishes", unknown, start near the root)')
    unknown = tree.args[1].id
    free = tape.like({**tape.base, unknown: number(0)}, tape.free)
    renamed = substitute(
        _expanded(_parsed(str(tree.args[0].value)), free),
        lambda n: name(own) if isinstance(n, ast.Name) and n.id == unknown else None,
    )
    start = _expanded(tree.args[2], tape)
    _check(renamed, tape, (own,))
    _check(start, tape, ())
    if own not in letters(renamed):
        raise BadInput(f"the unknown {unknown} does not stand in the equation of {own}")
    return Root(equation=renamed, unknown=own, start=start)


def _expanded(node: ast.expr, tape: TheoryTape) -> Node:
    if isinstance(node, (ast.Constant, ast.Name)):
        return node
    if isinstance(node, ast.UnaryOp):
        inner = _expanded(node.operand, tape)
        return inner if isinstance(node.op, ast.UAdd) else ast.UnaryOp(op=node.op, operand=inner)
    if isinstance(node, ast.BinOp):
        return binary(type(node.op), _expanded(node.left, tape), _expanded(node.right, tape))
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        compared = _expanded(node.left, tape), [_expanded(node.comparators[0], tape)]
        return ast.Compare(left=compared[0], ops=node.ops, comparators=compared[1])
    if isinstance(node, ast.Attribute) or (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
        return _of_curve(node, tape)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        return _called(node.func.id, node, tape)
    raise BadInput(
        f"{ast.unparse(node)[:60]!r} is not read in a definition; it is arithmetic of letters with functions, {_WORDS}"
    )


def _called(function: str, node: ast.Call, tape: TheoryTape) -> Node:
    if function == "sum":
        return _sum(node, tape)
    if function in ("d", "dt"):
        return _derived(function, node, tape)
    arguments = [_expanded(a, tape) for a in node.args]
    found = meaning(function, arguments)
    if found is not None:
        return found
    if len(arguments) != 1:
        raise BadInput(f"{function} is not a function of {len(arguments)} arguments here")
    return call(_ALIASES.get(function, function), arguments[0])


def _derived(function: str, node: ast.Call, tape: TheoryTape) -> Node:
    if function == "dt" and len(node.args) == 1:
        return in_time(_expanded(node.args[0], tape), tape)
    order = value_of(node.args[2]) if len(node.args) == 3 else 1
    if len(node.args) not in (2, 3) or not isinstance(node.args[1], ast.Name) or order not in (1, 2, 3):
        raise BadInput("derivatives are written d(e, phi), d(e, phi, 2) or dt(e)")
    by, tree = node.args[1].id, _expanded(node.args[0], tape)
    if by not in tape.free:
        raise BadInput(f"d(.., {by}): {by} is not a free letter; letters are {', '.join(tape.free)}")
    for _ in range(int(order)):
        tree = by_letter(tree, by, tape)
    return tree


def by_letter(tree: Node, by: str, tape: TheoryTape) -> Node:
    """Derivative of an expression by a letter; names on the tape change with it."""
    return derivative(tree, lambda k: number(1) if k == by else tape.slope_of(k, by))


def in_time(tree: Node, tape: TheoryTape) -> Node:
    """Derivative of an expression in time."""
    return derivative(tree, lambda k: name(f"{k}d") if f"{k}d" in tape.free else tape.rate_of(k))


def _sum(node: ast.Call, tape: TheoryTape) -> Node:
    if len(node.args) != 4 or not isinstance(node.args[1], ast.Name):
        raise BadInput("a sum is written sum(e, k, 1, 4)")
    first, last = (value_of(a) for a in node.args[2:])
    if first is None or last is None or not 0 <= last - first < _MOST:
        raise BadInput(f"a sum runs between whole numbers and has at most {_MOST} terms")
    index, found = node.args[1].id, number(0)
    inner = tape.like(tape.base, {**tape.free, index: None})
    body = _expanded(node.args[0], inner)
    for k in range(int(first), int(last) + 1):
        put = number(k)
        found = plus(found, substitute(body, lambda n, p=put: p if isinstance(n, ast.Name) and n.id == index else None))  # type: ignore[misc]
    return found


def _of_curve(node: ast.expr, tape: TheoryTape) -> Node:
    asked = node.attr if isinstance(node, ast.Attribute) else ""
    inside = node.value if isinstance(node, ast.Attribute) else node
    if asked in ("x", "y") and isinstance(inside, (ast.Attribute, ast.Call)):
        points = _points(inside, tape)
        return points[asked == "y"]
    x, y = _points(inside, tape)
    dx, dy = (by_letter(p, tape.angle, tape) for p in (x, y))
    turning = minus(times(dx, by_letter(dy, tape.angle, tape)), times(dy, by_letter(dx, tape.angle, tape)))
    cube = binary(ast.Pow, _square_sum(dx, dy), binary(ast.Div, number(3), number(2)))
    if asked == "curvature":
        return over(turning, cube)
    if asked == "radius":
        return over(cube, turning)
    raise BadInput(f"a curve has curvature, radius, x, y, normal and offset(R), not {asked or 'a value of its own'!r}")


def _points(node: ast.expr, tape: TheoryTape) -> tuple[Node, Node]:
    # x and y of curve(x, y), of its offset or of its normal
    if not tape.angle:
        raise BadInput('a curve needs the angle that runs through it: angle = "phi"')
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id == "curve":
        if len(node.args) != 2:
            raise BadInput("a curve is written curve(x, y)")
        return _expanded(node.args[0], tape), _expanded(node.args[1], tape)
    if isinstance(node, ast.Attribute) and node.attr == "normal":
        return _normal(*_points(node.value, tape), tape)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and node.func.attr == "offset":
        if len(node.args) != 1:
            raise BadInput("an offset is written curve(x, y).offset(R)")
        (x, y), distance = _points(node.func.value, tape), _expanded(node.args[0], tape)
        across = _normal(x, y, tape)
        return plus(x, times(distance, across[0])), plus(y, times(distance, across[1]))
    raise BadInput(f"{ast.unparse(node)[:60]!r} is no curve; write curve(x, y)")


def _normal(x: Node, y: Node, tape: TheoryTape) -> tuple[Node, Node]:
    dx, dy = (by_letter(p, tape.angle, tape) for p in (x, y))
    length = call("sqrt", _square_sum(dx, dy))
    return minus(number(0), over(dy, length)), over(dx, length)


def _square_sum(a: Node, b: Node) -> Node:
    return plus(*(binary(ast.Pow, e, number(2)) for e in (a, b)))
