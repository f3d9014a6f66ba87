"""The tape of a theory: named expressions, and by themselves their slopes, rates and harmonics.

`dx_dphi`, `d2x_dphi2` by any letter, `x_d`, `x_dd` in time (the letter phi has the rates phid, phidd), `x_mean`,
`x_cos2`, `x_sin2` over a turn of the angle. Each is made when it is first asked for, and its own parts are names again.
Where a declaration calls something else so (a volume V beside a displacement V_d), the derivative goes by `V_d_`.
"""

import ast
import re
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace

from mechsym.audit.read.slopes import Slope, slope_in
from mechsym.audit.read.tree import (
    Node,
    binary,
    call,
    function_of,
    letters,
    name,
    negative,
    number,
    substitute,
    value_of,
)
from mechsym.errors import BadInput
from mechsym.quantities import record

#: Ends the name of a letter that is to be had from quantities which hang on it, as a swept volume from a power
BY_OTHERS = "_by_others"

Rate = Callable[[str], Node]  # of a letter or a name
_ZERO, _ONE = number(0), number(1)


def slope_by(tree: Node, letter: str) -> Node:
    """Partial derivative of an expression by one of its letters."""
    return derivative(tree, lambda k: _ONE if k == letter else _ZERO)


def derivative(tree: Node, rate: Rate) -> Node:
    """Derivative of an expression whose letters have given rates."""
    if isinstance(tree, ast.Name):
        return rate(tree.id)
    if all(is_zero(rate(letter)) for letter in letters(tree)):
        return _ZERO
    if isinstance(tree, ast.UnaryOp):
        return minus(number(0), derivative(tree.operand, rate))
    if isinstance(tree, ast.IfExp):
        body, other = derivative(tree.body, rate), derivative(tree.orelse, rate)
        return number(0) if is_zero(body) and is_zero(other) else ast.IfExp(test=tree.test, body=body, orelse=other)
    if isinstance(tree, ast.Call):
        inner = derivative(tree.args[0], rate)
        return number(0) if is_zero(inner) else times(_outer(str(function_of(tree)), tree), inner)
    assert isinstance(tree, ast.BinOp)
    left = derivative(tree.left, rate)
    right = derivative(tree.right, rate)
    if isinstance(tree.op, ast.Add):
        return plus(left, right)
    if isinstance(tree.op, ast.Sub):
        return minus(left, right)
    if isinstance(tree.op, ast.Mult):
        return plus(times(left, tree.right), times(tree.left, right))
    if isinstance(tree.op, ast.Div):
        return minus(over(left, tree.right), times(over(tree, tree.right), right))
    total: Node = number(0)
    if not is_zero(left):
        exponent = value_of(tree.right)
        less = minus(tree.right, number(1)) if exponent is None else number(exponent - 1)
        total = times(times(tree.right, binary(ast.Pow, tree.left, less)), left)
    if not is_zero(right):
        total = plus(total, times(times(tree, call("log", tree.left)), right))
    return total


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
    value = value_of(tree)
    return value is not None and not value


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


@record
class Root:
    """The name `unknown` for which an equation vanishes; `start` picks the branch."""

    equation: Node
    unknown: str
    start: Node


@record
class Harmonic:
    """One Fourier coefficient of a name over a turn of an angle; order 0 is the mean."""

    of: str
    angle: str
    order: int
    free: frozenset[str]
    sine: bool = False


@record
class Ranged:
    """What an expression comes to over a range of a letter, which may be its own: `integral`, `peak` or `least`."""

    kind: str
    of: Node
    by: str
    low: Node
    high: Node
    free: frozenset[str]


Entry = Node | tuple[Node, ...] | Root | Harmonic | Ranged
_TIMED = re.compile(r"(?P<of>\w+?)_(?P<dots>d{1,3})$")
_HARMONIC = re.compile(r"(?P<of>\w+?)_(?:mean|(?P<kind>cos|sin)(?P<order>[1-9]\d?))$")


class TheoryTape(Mapping[str, Entry]):
    """Entries by name; the derived ones are made on demand and do not show in iteration."""

    def __init__(
        self, base: Mapping[str, Entry], free: Mapping[str, object], angle: str, declared: bool = False
    ) -> None:
        self.base, self.free, self.angle = dict(base), dict(free), angle
        #: Whether the names are an author's, so that none of them is a derivative because it is called like one
        self.declared = declared
        self.made: dict[str, Entry | None] = {}

    def like(self, base: Mapping[str, Entry], free: Mapping[str, object]) -> "TheoryTape":
        """A tape of other names and letters, whose author and angle are the same."""
        return TheoryTape(base, free, self.angle, self.declared)

    def __getitem__(self, key: str) -> Entry:
        if key in self.base:
            return self.base[key]
        if key in self.free:
            raise KeyError(key)
        if key not in self.made:
            self.made[key] = None  # a name that is derived from itself is none
            self.made[key] = self._derived(key)
        entry = self.made[key]
        if entry is None:
            raise KeyError(key)
        return entry

    def __contains__(self, key: object) -> bool:
        try:
            return isinstance(key, str) and self[key] is not None
        except (KeyError, BadInput):  # BadInput: a mean over a turn, of which something would be derived
            return False

    def __iter__(self) -> Iterator[str]:
        return iter(self.base)

    def __len__(self) -> int:
        return len(self.base)

    def _derived(self, key: str) -> Entry | None:
        if key.endswith(BY_OTHERS) and key.removesuffix(BY_OTHERS) in self.free:
            return name(key.removesuffix(BY_OTHERS))
        if key.endswith("_") and self._taken(key[:-1]):
            key = key[:-1]
        for by in self.free:
            if (slope := slope_in(key, by)) and (of := slope.integrated) in self:
                return self.slope(self._unlike(of) if key[1:2].isdigit() else of, by)
        if (match := _TIMED.match(key)) and match["of"] in self:
            less = match["dots"][:-1]
            return self.timed(self._unlike(f"{match['of']}_{less}") if less else match["of"])
        if (match := _HARMONIC.match(key)) and self.angle and match["of"] in self:
            order, sine = int(match["order"] or 0), match["kind"] == "sin"
            return Harmonic(of=match["of"], angle=self.angle, order=order, free=frozenset(self.free), sine=sine)
        return None

    def _taken(self, derived: str) -> bool:
        return derived in self.free or self._is_authors(derived)

    def _is_authors(self, key: str) -> bool:
        return self.declared and key in self.base

    def _unlike(self, key: str) -> str:
        # the derivative itself, where something else is called so
        match = _TIMED.match(key)
        of = match["of"] if match else next((s.of for by in self.free if (s := slope_in(key, by))), "")
        return f"{key}_" if of in self.base and self._taken(key) else key

    def slope(self, of: str, by: str) -> Entry | None:
        """Derivative of a name by a letter; None where it has none."""
        return self._rate(of, lambda k: number(1) if k == by else self.slope_of(k, by))

    def timed(self, of: str) -> Entry | None:
        """Derivative of a name in time; None where nothing turns."""
        return self._rate(of, lambda k: name(f"{k}d") if f"{k}d" in self.free else self.rate_of(k))

    def slope_of(self, of: str, by: str) -> Node:
        """Name of the derivative of a name by a letter, or 0."""
        return self.rate_name(of, f"d{of}_d{by}" if self._is_authors(of) else _next(of, by))

    def rate_of(self, of: str) -> Node:
        """Name of the derivative of a name in time, or 0."""
        return self.rate_name(of, f"{of}d" if _TIMED.match(of) and not self._is_authors(of) else f"{of}_d")

    def _rate(self, of: str, rate: Rate) -> Entry | None:
        entry = self[of]
        if isinstance(entry, Ranged):
            return self._under_integral(entry, rate) if entry.kind == "integral" and entry.by not in self.free else None
        if isinstance(entry, Root):
            inside = derivative(entry.equation, lambda k: number(0) if k == entry.unknown else rate(k))
            across = slope_by(entry.equation, entry.unknown)
            return negative(over(inside, across)) if not is_zero(inside) else number(0)
        if isinstance(entry, (tuple, Harmonic)):
            return None
        return derivative(entry, rate)

    def _under_integral(self, entry: Ranged, rate: Rate) -> Entry:
        # Leibniz: the integral of the derivative, and what the ends bring
        def end(at: Node) -> Node:
            there = substitute(entry.of, lambda n: at if isinstance(n, ast.Name) and n.id == entry.by else None)
            return times(there, derivative(at, rate))

        inside = derivative(entry.of, lambda k: number(0) if k == entry.by else rate(k))
        ends = minus(end(entry.high), end(entry.low))
        if is_zero(inside):
            return ends
        within = replace(entry, of=inside)
        if is_zero(ends):
            return within
        key = f"within_{len(self.made)}"
        self.made[key] = within
        return plus(name(key), ends)

    def rate_name(self, of: str, derived: str) -> Node:
        """Name of a derivative; the number 0 where it vanishes, or where `of` is a letter."""
        if of in self.free or of == "pi" or of not in self.made and of not in self:
            return number(0)
        derived = f"{derived}_" if self._taken(derived) else derived
        entry = self.get(derived)
        if entry is None:
            raise BadInput(f"{of} has no derivative {derived}")
        return number(0) if not isinstance(entry, (tuple, Root, Harmonic, Ranged)) and is_zero(entry) else name(derived)


def retaped(tape: Mapping[str, Entry], more: Mapping[str, Entry], free: Mapping[str, object], angle: str) -> TheoryTape:
    """A tape with more names, by the same author."""
    if isinstance(tape, TheoryTape):
        return tape.like({**tape.base, **more}, free)
    return TheoryTape({**tape, **more}, free, angle)


def needed(entry: Entry) -> list[str]:
    """Letters and names that an entry is made of."""
    if isinstance(entry, Root):
        return [k for k in dict.fromkeys([*letters(entry.equation), *letters(entry.start)]) if k != entry.unknown]
    if isinstance(entry, Harmonic):
        return [entry.of]
    if isinstance(entry, Ranged):
        inside = [k for k in letters(entry.of) if k != entry.by]
        return list(dict.fromkeys([*inside, *letters(entry.low), *letters(entry.high)]))
    return [k for part in (entry if isinstance(entry, tuple) else (entry,)) for k in letters(part)]


def _next(of: str, by: str) -> str:
    slope = slope_in(of, by)
    return slope.once_more if slope else Slope(of, by).name
