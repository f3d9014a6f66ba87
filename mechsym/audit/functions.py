"""Functions of several arguments and other spellings, as trees of the few functions that everything is made of."""

import ast
from collections.abc import Callable, Sequence

from mechsym.audit.tree import Node, binary, call, name, negative, number
from mechsym.errors import BadInput

MODULES = ("np", "numpy", "math", "cmath", "sp", "sympy", "Math", "Modelica", "mpmath", "std", "torch", "jnp")


def _atan2(y: Node, x: Node) -> Node:
    # exact but on the negative x axis, where the angle jumps
    length = call("sqrt", binary(ast.Add, _square(x), _square(y)))
    return binary(ast.Mult, number(2), call("atan", binary(ast.Div, y, binary(ast.Add, length, x))))


def _extreme(sign: type[ast.operator]) -> Callable[[Node, Node], Node]:
    def of(a: Node, b: Node) -> Node:
        spread = call("abs", binary(ast.Sub, a, b))
        return binary(ast.Div, binary(sign, binary(ast.Add, a, b), spread), number(2))

    return of


def _square(a: Node) -> Node:
    return binary(ast.Pow, a, number(2))


def _degrees(above: Node, below: Node) -> Callable[[Node], Node]:
    return lambda a: binary(ast.Div, binary(ast.Mult, a, above), below)


MEANINGS: dict[str, tuple[int, Callable[..., Node]]] = {
    "atan2": (2, _atan2),
    "arctan2": (2, _atan2),
    "pow": (2, lambda a, b: binary(ast.Pow, a, b)),
    "power": (2, lambda a, b: binary(ast.Pow, a, b)),
    "hypot": (2, lambda a, b: call("sqrt", binary(ast.Add, _square(a), _square(b)))),
    "max": (2, _extreme(ast.Add)),
    "fmax": (2, _extreme(ast.Add)),
    "min": (2, _extreme(ast.Sub)),
    "fmin": (2, _extreme(ast.Sub)),
    "square": (1, _square),
    "sqr": (1, _square),
    "cbrt": (1, lambda a: binary(ast.Pow, a, binary(ast.Div, number(1), number(3)))),
    "radians": (1, _degrees(name("pi"), number(180))),
    "deg2rad": (1, _degrees(name("pi"), number(180))),
    "degrees": (1, _degrees(number(180), name("pi"))),
    "rad2deg": (1, _degrees(number(180), name("pi"))),
    "sec": (1, lambda a: binary(ast.Div, number(1), call("cos", a))),
    "csc": (1, lambda a: binary(ast.Div, number(1), call("sin", a))),
    "sinh": (
        1,
        lambda a: binary(ast.Div, binary(ast.Sub, call("exp", a), call("exp", negative(a))), number(2)),
    ),
    "cosh": (
        1,
        lambda a: binary(ast.Div, binary(ast.Add, call("exp", a), call("exp", negative(a))), number(2)),
    ),
    "log10": (1, lambda a: binary(ast.Div, call("log", a), call("log", number(10)))),
    "sind": (1, lambda a: call("sin", _degrees(name("pi"), number(180))(a))),
    "cosd": (1, lambda a: call("cos", _degrees(name("pi"), number(180))(a))),
    "tand": (1, lambda a: call("tan", _degrees(name("pi"), number(180))(a))),
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
