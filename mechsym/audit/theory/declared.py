"""Theories that anyone declares: a TOML file of letters and definitions, or a mechanism in a Python file.

angle = "phi"                       # runs over a turn; phid and phidd are its rates
not_of = ["opposed piston"]         # of a shipped theory: words of texts that are about something else, and
only_of = ["slider crank"]          # words of which a text has one; small letters. A named theory is always asked
small = ["lam"]                     # numbers that go to zero; rods = ["l"]: lengths that grow without limit
[letters]
r = "30 mm"                         # a value with its unit; "rad" alone: the value is 1
F = { unit = "N", value = 100.0, sign = "any", domain = [0.0, 200.0] }
[define]
s = "r*(1 - cos(phi))"              # arithmetic, and what stands below
[units]
s = "m"                             # only where dimensions do not tell it
[conditions]
"no friction" = ["mu"]              # what sources take for granted
[symbols]
"\\omega" = "phid"                  # letters of a paper: here the author's omega is phid
[words]
"phid*30/pi" = ["rpm"]              # what programs call a letter, a quantity or what is made of them

In [define] a name may also be:
d(e, phi), d(e, phi, 2)            derivative by a letter
dt(e)                              derivative in time
root("equation", u, start)         the u near start for which the equation vanishes; only as a whole definition
curve(x, y).curvature .radius      of the curve that the angle runs through
curve(x, y).normal.x  .offset(R).y its unit normal, to the left of its sense, and the curve at a distance along it
sum(e, k, 1, 4)                    e for k = 1 to 4
integral(e, u, a, b)               of e over u, a letter of its own or of the theory; only as a whole definition
peak(e, u, a, b) least(e, u, a, b) largest and least value over that range; peak(e) over a turn
table(e, [0, 1, 3], [2, 5, 4])     a curve through points by e, straight between them, held beyond its ends
piecewise(a < b, e, f)             e where a < b, else f; also atan2, min, max, hypot, radians
"""

import ast
import re
import tomllib
from collections.abc import Mapping
from fractions import Fraction
from functools import partial
from itertools import pairwise
from pathlib import Path

from mechsym.audit.read.reader import RESERVED
from mechsym.audit.read.spelling import from_greek
from mechsym.audit.read.tree import Node, binary, call, check, letters, meaning, name, number, substitute, value_of
from mechsym.audit.theory.record import Letter, Theory
from mechsym.audit.theory.tape import Entry, Ranged, Root, TheoryTape, derivative, minus, over, plus, times
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.files.inputs import read_text
from mechsym.quantities import dimension, parse

_ALIASES = {"arcsin": "asin", "arccos": "acos", "arctan": "atan", "ln": "log"}
_MOST = 40  # terms of a sum
_EXAMPLE = "'2*r*(1 - cos(phi))'"
_WORDS = "d(e, phi), dt(e), root, curve, integral, peak, least, table, sum(e, k, 1, 4) and piecewise(a < b, e, f)"
_RANGED = ("integral", "peak", "least")


def define(own: str, text: str, tape: TheoryTape) -> Entry:
    """What a definition puts on the tape; earlier names of the tape and its letters may be used."""
    tree = _parsed(text)
    if isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and tree.func.id == "root":
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
    if isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name) and tree.func.id in _RANGED:
        return _over_range(tree.func.id, tree, tape)
    expanded = _expanded(tree, tape)
    _check(expanded, tape, ())
    return expanded


def _over_range(kind: str, tree: ast.Call, tape: TheoryTape) -> Ranged:
    arguments = list(tree.args)
    if kind != "integral" and len(arguments) == 1 and tape.angle:
        arguments += [name(tape.angle), number(0), _parsed("2*pi")]
    if len(arguments) != 4 or not isinstance(arguments[1], ast.Name):
        raise BadInput(f"{kind} is written {kind}(e, u, from, to)")
    by = arguments[1].id
    if by in tape:
        raise BadInput(f"{kind}(.., {by}, ..): {by} is defined above; take a free letter, or a new one")
    within = tape if by in tape.free else tape.like(tape.base, {**tape.free, by: None})
    of, low, high = _expanded(arguments[0], within), *(_expanded(end, tape) for end in arguments[2:])
    _check(of, tape, (by,))
    for end in (low, high):
        _check(end, tape, ())
    return Ranged(kind=kind, of=of, by=by, low=low, high=high, free=frozenset(tape.free))


def _tabulated(node: ast.Call, tape: TheoryTape) -> Node:
    lists = [[value_of(v) for v in a.elts] if isinstance(a, ast.List) else [] for a in node.args[1:]]
    if len(lists) != 2 or len(lists[0]) != len(lists[1]) or len(lists[0]) < 2 or None in lists[0] + lists[1]:
        raise BadInput("a table is written table(e, [0, 1, 3], [2, 5, 4]): where, and how much there")
    places, values = ([Fraction(v) for v in column if v is not None] for column in lists)
    if any(a >= b for a, b in pairwise(places)):
        raise BadInput("the places of a table ascend")
    x, curve = _expanded(node.args[0], tape), number(values[-1])
    for (a, b), (y, z) in reversed(list(zip(pairwise(places), pairwise(values), strict=True))):
        line = plus(number(y), times(number((z - y) / (b - a)), minus(x, number(a))))
        curve = ast.IfExp(test=ast.Compare(left=x, ops=[ast.Lt()], comparators=[number(b)]), body=line, orelse=curve)
    low = ast.Compare(left=x, ops=[ast.Lt()], comparators=[number(places[0])])
    return ast.IfExp(test=low, body=number(values[0]), orelse=curve)


def _parsed(text: str) -> ast.expr:
    try:
        return ast.parse(from_greek(text).replace("^", "**").strip(), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError) as error:
        text = text.strip()
        if not text:
            raise BadInput("the definition is empty; write an expression, as 'r*sin(phi)'") from None
        why, place = getattr(error, "msg", "nested too deep"), getattr(error, "offset", None)
        near = f" near {text[max(0, place - 8) : place + 4]!r}" if place else ""
        way = f"write a * between factors, and brackets in pairs, as {_EXAMPLE}"
        raise BadInput(f"{text[:60]!r} cannot be read: {why}{near}; {way}") from None


def _check(tree: Node, tape: TheoryTape, also: tuple[str, ...]) -> None:
    check(tree)
    for letter in letters(tree):
        if letter not in tape.free and letter not in tape and letter != "pi" and letter not in also:
            known = ", ".join([*tape.free, *tape])
            raise BadInput(f"unknown letter {letter!r}; letters and names defined above it are {known}")


def _expanded(node: ast.expr, tape: TheoryTape) -> Node:
    if isinstance(node, (ast.Constant, ast.Name)):
        return node
    if isinstance(node, ast.UnaryOp):
        inner = _expanded(node.operand, tape)
        return inner if isinstance(node.op, ast.UAdd) else ast.UnaryOp(op=node.op, operand=inner)
    if isinstance(node, ast.BinOp):
        return binary(type(node.op), _expanded(node.left, tape), _expanded(node.right, tape))
    if isinstance(node, ast.Compare) and len(node.ops) == 1:
        right = _expanded(node.comparators[0], tape)
        return ast.Compare(left=_expanded(node.left, tape), ops=node.ops, comparators=[right])
    if isinstance(node, ast.Attribute) or (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
        return _of_curve(node, tape)
    if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and not node.keywords:
        return _called(node.func.id, node, tape)
    raise BadInput(
        f"{ast.unparse(node)[:60]!r} is not read in a definition; it is arithmetic of letters with functions, {_WORDS}"
    )


def _called(function: str, node: ast.Call, tape: TheoryTape) -> Node:
    if function == "sum":
        if len(node.args) != 4 or not isinstance(node.args[1], ast.Name):
            raise BadInput("a sum is written sum(e, k, 1, 4)")
        first, last = (value_of(a) for a in node.args[2:])
        if first is None or last is None or not 0 <= last - first < _MOST:
            raise BadInput(f"a sum runs between whole numbers and has at most {_MOST} terms")
        index, total = node.args[1].id, number(0)
        inner = tape.like(tape.base, {**tape.free, index: None})
        body = _expanded(node.args[0], inner)
        for k in range(int(first), int(last) + 1):
            total = plus(total, substitute(body, partial(_numbered, index, number(k))))
        return total
    if function in ("d", "dt"):
        return _derived(function, node, tape)
    if function == "table":
        return _tabulated(node, tape)
    if function in (*_RANGED, "root"):
        raise BadInput(f"{function} is a definition of its own; give it a name and use that")
    arguments = [_expanded(a, tape) for a in node.args]
    several = meaning(function, arguments)
    if several is not None:
        return several
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


def _numbered(index: str, value: Node, node: Node) -> Node | None:
    return value if isinstance(node, ast.Name) and node.id == index else None


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


_KEYS = tuple("name about source angle not_of only_of small rods letters define units conditions symbols words".split())
_NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_VALUE = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)?\s*(.*?)\s*$")


def read_theory(path: Path) -> Theory:
    """A theory from a TOML file; its name is the file's unless it says another."""
    return theory_of(read_text(path, "--theory"), path.stem, str(path))


def theory_of(text: str, stem: str, where: str) -> Theory:
    """A theory from the text of a TOML file."""
    try:
        content = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise BadInput(f"{where}: not valid TOML: {error}") from None
    unknown = sorted(content.keys() - set(_KEYS))
    if unknown:
        raise BadInput(f"{where}: {unknown[0]!r} is not a key of a theory; keys are {', '.join(_KEYS)}")
    try:
        return _theory(content, str(content.get("name", stem)), where)
    except BadInput as error:
        raise BadInput(f"{where}: {error}") from None


def _theory(content: Json, name: str, where: str) -> Theory:
    angle = content.get("angle", "")
    own_letters = {}
    for letter, about in _table(content, "letters").items():
        if not _NAME.fullmatch(letter) or letter in RESERVED:
            raise BadInput(f"letters.{letter}: a letter is a name of letters and digits, and not pi nor a function")
        own_letters[letter] = _letter(letter, about)
    turning = {f"{angle}d": Letter(unit="rad/s", value=10.0), f"{angle}dd": Letter(unit="rad/s^2", value=3.0)}
    turning[angle] = Letter(unit="rad", value=1.0)
    letters = own_letters | {k: v for k, v in turning.items() if angle and k not in own_letters}
    tape = TheoryTape({}, letters, angle, declared=True)
    for own, text in _table(content, "define").items():
        if not _NAME.fullmatch(own) or own in (*letters, *RESERVED):
            raise BadInput(f"define.{own}: a name of letters and digits that is no letter or function yet is needed")
        if not isinstance(text, (str, int, float)) or isinstance(text, bool):
            raise BadInput(f"define.{own} is a text in quotes, such as 'r*sin(phi)'")
        try:
            tape.base[own] = define(own, str(text), tape)
        except BadInput as error:
            raise BadInput(f"define.{own}: {error}") from None
    if not tape.base:
        raise BadInput("there is nothing in [define]; write a quantity, as x = 'r*(1 - cos(phi))'")
    units = _table(content, "units")
    for unit in units.values():
        dimension(str(unit))
    return Theory(
        name=name,
        letters=letters,
        tape=tape,
        results=tuple(tape.base),
        units={k: str(u) for k, u in units.items()},
        angle=angle,
        rods=_among(content.get("rods", []), "rods", letters),
        small=_among(content.get("small", []), "small", letters),
        conditions={k: _among(v, f"conditions.{k}", letters) for k, v in _table(content, "conditions").items()},
        data=where,
        words={k: tuple(map(str, v)) for k, v in _table(content, "words").items() if isinstance(v, list)},
    )


def _table(content: Json, key: str) -> Json:
    table = content.get(key, {})
    if not isinstance(table, dict):
        raise BadInput(f"[{key}] must be a table")
    return table


def _among(listed: object, key: str, letters: Mapping[str, Letter]) -> tuple[str, ...]:
    if not isinstance(listed, list) or not all(isinstance(k, str) and k in letters for k in listed):
        raise BadInput(f"{key} is a list of free letters; letters are {', '.join(letters)}")
    return tuple(listed)


def _letter(own: str, about: object) -> Letter:
    if not isinstance(about, dict):
        if isinstance(about, (int, float)) and not isinstance(about, bool):
            return Letter(unit="-", value=float(about))
        if not isinstance(about, str):
            raise BadInput(f"letters.{own} is a value with its unit, as '30 mm', or a table")
        match = _VALUE.fullmatch(about)
        written = (match[2] if match else "") or "-"
        dimension(written)
        value = parse(about, _si(written), f"letters.{own}") if match and match[1] else 1.0
        return Letter(unit=_si(written), value=value)
    unknown = sorted(about.keys() - {"unit", "value", "sign", "domain", "about"})
    if unknown or about.get("sign", "") not in ("", "any", "positive"):
        raise BadInput(
            f'letters.{own} has unit, value, sign ("any" or "positive"), domain and about; found {sorted(about)}'
        )
    unit, domain = str(about.get("unit", "-")), about.get("domain")
    dimension(unit)
    if domain is not None:
        if not isinstance(domain, list) or len(domain) != 2:
            raise BadInput(f"letters.{own}.domain is a list of two ends, as [0.0, 1.5]")
        low, high = (parse(end, unit, f"letters.{own}.domain") for end in domain)
        if not low < high:
            raise BadInput(f"letters.{own}.domain: the first end must be below the second")
        domain = (low, high)
    value = parse(about.get("value", sum(domain) / 2 if domain else 1.0), unit, f"letters.{own}.value")
    return Letter(unit=unit, value=value, sign=about.get("sign", ""), domain=domain)


def _si(unit: str) -> str:
    # the SI unit of the same dimension: parse gives values in it
    mass, length, time, kelvin = dimension(unit)
    if parse(f"1 {unit}" if unit != "-" else 1.0, unit) == 1.0 and unit not in ("deg", "rpm"):
        return unit
    if unit in ("deg", "rev"):
        return "rad"
    if unit == "rpm":
        return "rad/s"
    names = ("Pa", "N", "N/m", "J" if "J" in unit else "N*m", "W", "J/kg/K")
    if same := next((name for name in names if dimension(name) == dimension(unit)), ""):
        return same
    powers = [(u, p) for u, p in zip(("kg", "m", "s", "K"), (mass, length, time, kelvin), strict=True) if p]
    above = "*".join(u if p == 1 else f"{u}^{p}" for u, p in powers if p > 0) or "1"
    return above + "".join(f"/{u}" if p == -1 else f"/{u}^{-p}" for u, p in powers if p < 0)
