"""Taylor coefficients of a motion by recurrences from the tape: each operator has one, in balls.

a b        sum_j a_j b_{k-j}                          a / b    (a_k - sum_{j<k} q_j b_{k-j}) / b_0
sqrt a     (a_k - sum_{0<j<k} r_j r_{k-j}) / 2 r_0    exp a    sum_j j a_j e_{k-j} / k
sin a      sum_j j a_j c_{k-j} / k                    log a    (a_k - sum_{0<j<k} j l_j a_{k-j} / k) / a_0
cos a      -sum_j j a_j s_{k-j} / k                   a^p      sum_j (j p - k + j) a_j y_{k-j} / (k a_0)
"""

from collections.abc import Callable, Sequence
from operator import mul
from typing import Any

from mechsym.native.tape import Tape
from mechsym.proof.balls import REAL, Ball, arb, refuse_unknown

_ZERO = arb(0)
Rule = Callable[[int], None]  # appends the coefficient of that order
Coefficients = list[Ball]


def _dot(a: Sequence[Ball], b: Sequence[Ball]) -> Ball:
    """Coefficient of a product: first by last, as far as the shorter reaches."""
    return sum(map(mul, a, reversed(b)), _ZERO)


def _product(out: Coefficients, a: Coefficients, b: Coefficients) -> Rule:
    return lambda k: out.append(_dot(a, b))


def _square(out: Coefficients, a: Coefficients) -> Rule:
    def rule(k: int) -> None:
        pairs = 2 * _dot(a[: (k + 1) // 2], a)
        out.append(pairs if k % 2 else pairs + a[k // 2] * a[k // 2])

    return rule


def _quotient(out: Coefficients, a: Coefficients, b: Coefficients) -> Rule:
    return lambda k: out.append((a[k] - _dot(out, b)) / b[0])


def _inverse(out: Coefficients, b: Coefficients) -> Rule:
    return lambda k: out.append(-_dot(out, b) / b[0] if k else 1 / b[0])


def _root(out: Coefficients, a: Coefficients) -> Rule:
    return lambda k: out.append((a[k] - _dot(out[1:], out[1:])) / (2 * out[0]) if k else a[0].sqrt())


def _exponential(out: Coefficients, a: Coefficients) -> Rule:
    slope: Coefficients = []

    def rule(k: int) -> None:
        slope.append(k * a[k])
        out.append(_dot(slope[1:], out) / k if k else a[0].exp())

    return _forgetting(rule, slope)


def _logarithm(out: Coefficients, a: Coefficients) -> Rule:
    def rule(k: int) -> None:
        slope = [j * out[j] for j in range(1, k)]
        out.append((a[k] - _dot(slope, a[1:k]) / k) / a[0] if k else a[0].log())

    return rule


def _power(out: Coefficients, a: Coefficients, p: Ball) -> Rule:
    def rule(k: int) -> None:
        terms = ((j * p - (k - j)) * a[j] * out[k - j] for j in range(1, k + 1))
        out.append(sum(terms, _ZERO) / (k * a[0]) if k else a[0] ** p)

    return rule


def _sine_and_cosine(sine: Coefficients, cosine: Coefficients, a: Coefficients) -> Rule:
    slope: Coefficients = []

    def rule(k: int) -> None:
        slope.append(k * a[k])
        both = (_dot(slope[1:], cosine) / k, -_dot(slope[1:], sine) / k) if k else a[0].sin_cos()
        sine.append(both[0])
        cosine.append(both[1])

    return _forgetting(rule, slope)


def _forgetting(rule: Rule, own: Coefficients) -> Rule:
    def first(k: int) -> None:
        if k == 0:
            own.clear()
        rule(k)

    return first


_LINEAR: dict[str, Callable[..., Ball]] = {"add": lambda a, b: a + b, "sub": lambda a, b: a - b}
_ONE: dict[str, Callable[..., Ball]] = {"neg": lambda a: -a, "twice": lambda a: a + a}
_RULES: dict[str, Callable[..., Rule]] = {
    "mul": _product, "sq": _square, "div": _quotient, "inv": _inverse, "sqrt": _root, "exp": _exponential,
    "log": _logarithm,
}  # fmt: skip
KNOWN = {*_LINEAR, *_ONE, *_RULES, "sin", "cos", "tan", "pow"}


class TaylorMotion:
    """The Taylor coefficients of x' = f(x) with A = df/dx along them; one tape gives f and then A by columns."""

    def __init__(self, tape: Tape, states: int, held: Sequence[Ball]) -> None:
        """states: number of x, the first inputs; held: balls of the inputs behind them."""
        refuse_unknown(tape, dict.fromkeys(KNOWN), tape.name)
        self.tape, self.states, self.held = tape, states, list(held)
        self.x: list[Coefficients] = [[] for _ in range(states)]
        self._lists: list[Coefficients] = [*self.x]
        self._rules: tuple[list[Rule], list[Rule]] = ([], [])  # of f, and what A takes more
        self._build()

    def _build(self) -> None:
        nodes, places = self.tape.nodes, list[Any]()  # a ball that stays, or a list of coefficients
        of_f = _needed(self.tape, self.states)
        pairs: dict[int, tuple[Coefficients, Coefficients]] = {}
        for i, (op, args) in enumerate(nodes):
            rules = self._rules[0 if i in of_f else 1]
            if op == "input":
                places.append(self.x[args[0]] if args[0] < self.states else self.held[args[0] - self.states])
            elif op == "constant":
                places.append(arb(args[0]))
            elif not any(isinstance(places[a], list) for a in args):
                places.append(REAL[op](*[places[a] for a in args]))
            elif op in ("sin", "cos", "tan"):
                if args[0] not in pairs:
                    pairs[args[0]] = self._new(), self._new()
                    # before both its users: what A alone asks for may not come later in f
                    both = self._rules[0 if any(j in of_f for j in _users(nodes, args[0])) else 1]
                    both.append(_sine_and_cosine(*pairs[args[0]], places[args[0]]))
                sine, cosine = pairs[args[0]]
                places.append(sine if op == "sin" else cosine)
                if op == "tan":
                    places[-1] = self._new()
                    rules.append(_quotient(places[-1], sine, cosine))
            else:
                places.append(self._new())
                rules.append(_rule(op, places[-1], [places[a] for a in args]))
        results = [places[r] for r in self.tape.results]
        self.f, self.A = results[: self.states], results[self.states :]

    def _new(self) -> Coefficients:
        self._lists.append([])
        return self._lists[-1]

    def expand(self, start: Sequence[Ball], order: int, order_of_A: int) -> None:
        """Fill the lists from an exact start: x to an order as midpoints, f to one less, A to its own."""
        for coefficients in self._lists:
            coefficients.clear()
        for x, value in zip(self.x, start, strict=True):
            x.append(value)
        for k in range(order):
            for rule in self._rules[0]:
                rule(k)
            if k < order_of_A:
                for rule in self._rules[1]:
                    rule(k)
            following = [(coefficient(f, k) / (k + 1)).mid() for f in self.f]
            for x, value in zip(self.x, following, strict=True):
                x.append(value)


def coefficient(series: Any, k: int) -> Ball:
    """The coefficient of order k of a list, or of a ball that stays."""
    if isinstance(series, list):
        return series[k]
    return series if k == 0 else _ZERO


def _rule(op: str, out: Coefficients, args: list[Any]) -> Rule:
    if op in _ONE:
        one = _ONE[op]
        return lambda k: out.append(one(args[0][k]))
    if op == "pow":
        return _power(out, args[0], args[1])
    staying = [i for i, a in enumerate(args) if not isinstance(a, list)]
    if op in _LINEAR:
        act = _LINEAR[op]
        return lambda k: out.append(act(coefficient(args[0], k), coefficient(args[1], k)))
    if op == "mul" and staying:
        factor, series = args[staying[0]], args[1 - staying[0]]
        return lambda k: out.append(factor * series[k])
    if op == "div" and staying == [1]:
        return lambda k: out.append(args[0][k] / args[1])
    if op == "div" and staying == [0]:
        return lambda k: out.append((coefficient(args[0], k) - _dot(out, args[1])) / args[1][0])
    return _RULES[op](out, *args)


def _needed(tape: Tape, results: int) -> set[int]:
    """The nodes that the first results hang on."""
    needed, stack = set[int](), list(tape.results[:results])
    while stack:
        node = stack.pop()
        if node not in needed:
            needed.add(node)
            op, args = tape.nodes[node]
            stack += args if op not in ("input", "constant") else ()
    return needed


def _users(nodes: Sequence[Any], place: int) -> list[int]:
    return [j for j, (op, args) in enumerate(nodes) if op in ("sin", "cos", "tan") and args[0] == place]
