r"""What doubles can lose in a generated function: a bound for each output, by running error analysis on its tape.

Values stay in balls over a box of inputs. An operation of IEEE arithmetic adds half a unit in the last place of the
largest result there, an elementary function its stated bound (`c/elementary.h`; tests hold it against 60 digits; of
`acos` and `atan` the C library's). The text is compiled with -ffp-contract=off: nothing else is done to an operation.
What was added before is carried on, twice, and the smaller bound counts:

.. math:: |\tilde y - y| \le \sum_k \sup \Bigl|\frac{\partial f}{\partial x_k}\Bigr| e_k + \delta, \qquad
          |\tilde y - y| \le \sum_i \sup \Bigl|\frac{\partial y}{\partial v_i}\Bigr| \delta_i

operation by operation forwards, and backwards from an output to all nodes v_i, where errors of a value that is used
twice may cancel. Derivatives are taken over all that may be computed, so both are the mean value theorem. Bounds are
sums of doubles of one sign, rounded up by `UP`.
"""

import math
from collections.abc import Callable, Collection, Sequence
from typing import NamedTuple

from mechsym.errors import BadInput
from mechsym.native.tape import Node, Tape
from mechsym.proof.balls import REAL, UP, Ball, arb, ctx, upper

#: Units in the last place that an elementary function may be off; powers where |y log x| < 30, 16 beyond
ULPS = {"sin": 2.0, "cos": 2.0, "tan": 3.0, "exp": 1.5, "log": 1.5, "asin": 3.0, "acos": 1.0, "atan": 1.0,
        "hypot": 2.0, "pow": 1.5, "pow_broken": 1.5, "add": 0.5, "sub": 0.5, "mul": 0.5, "div": 0.5, "inv": 0.5,
        "sq": 0.5, "sqrt": 0.5}  # fmt: skip
_FAR_POWER, _FAR_ULPS = 30.0, 16.0
_ANGLE = 1e8  # largest argument of sine and cosine that their bound is for [rad]
_BITS = 64
_NO, _ZERO, _ONE, _EITHER = arb("nan"), arb(0), arb(1), arb(0.5, 0.5)

#: Values of the operators that have one everywhere; comparisons stand apart
VALUES: dict[str, Callable[..., Ball]] = {op: REAL[op] for op in REAL if op in ULPS} | {
    "neg": REAL["neg"], "twice": REAL["twice"], "fabs": abs, "fmin": lambda a, b: a.min(b),
    "fmax": lambda a, b: a.max(b), "pow_broken": REAL["pow"], "hypot": lambda a, b: (a * a + b * b).sqrt(),
}  # fmt: skip
#: Derivatives by each operand
_SLOPES: dict[str, Callable[..., tuple[Ball, ...]]] = {
    "add": lambda a, b: (_ONE, _ONE), "sub": lambda a, b: (_ONE, -_ONE), "mul": lambda a, b: (b, a),
    "div": lambda a, b: (1 / b, -a / (b * b)), "neg": lambda a: (-_ONE,), "twice": lambda a: (2 * _ONE,),
    "sq": lambda a: (2 * a,), "inv": lambda a: (-1 / (a * a),), "sqrt": lambda a: (1 / (2 * a.sqrt()),),
    "fabs": lambda a: (a.sgn() if not a.overlaps(_ZERO) else arb(0, 1),),
    "sin": lambda a: (a.cos(),), "cos": lambda a: (-a.sin(),), "tan": lambda a: (1 + a.tan() ** 2,),
    "exp": lambda a: (a.exp(),), "log": lambda a: (1 / a,), "asin": lambda a: (1 / (1 - a * a).sqrt(),),
    "acos": lambda a: (-1 / (1 - a * a).sqrt(),), "atan": lambda a: (1 / (1 + a * a),),
    "hypot": lambda a, b: (arb(0, 1), arb(0, 1)), "pow": lambda a, b: _power_slopes(a, b),
    "pow_broken": lambda a, b: _power_slopes(a, b),
    "fmin": lambda a, b: (_ONE, _ZERO) if a < b else (_ZERO, _ONE) if b < a else (_EITHER, _EITHER),
    "fmax": lambda a, b: (_ONE, _ZERO) if a > b else (_ZERO, _ONE) if b > a else (_EITHER, _EITHER),
}  # fmt: skip
_COMPARED = ("lt", "le", "eq", "ne", "not", "and", "or", "sign")
KNOWN = {*VALUES, *_COMPARED, "if_else_zero", "input", "constant"}


class Rounded(NamedTuple):
    """A value and how far what is computed may be from it; infinite where it may be anything."""

    ball: Ball
    error: float = 0.0  #: [unit of the value]
    own: float = 0.0  #: What the operation itself adds [unit of the value]
    slopes: tuple[Ball, ...] = ()  #: By its operands, over all that may be computed; none where nothing is carried

    @property
    def computed(self) -> Ball:
        """All that may come out."""
        return self.ball + arb(0, self.error) if self.error else self.ball


_NOTHING = Rounded(ball=_NO, error=math.inf)


def half_ulp(size: float, ulps: float = 0.5) -> float:
    """So many units in the last place of a double of that size [unit of the value]."""
    if not math.isfinite(size):
        return math.inf
    return ulps * max(math.ldexp(1.0, math.frexp(size)[1] - 53), 5e-324) if size else 0.0


def bounds(
    tape: Tape, box: Sequence[tuple[float, float]], along: Sequence[int] = (), wanted: Collection[int] | None = None
) -> tuple[list[Rounded], Callable[[], int]]:
    """The outputs over a box of inputs [SI]: balls of their values and bounds of what they may be off; and what tells
    the input that the box is best halved by.

    along: inputs whose width decides; without them, where many have one, values are enclosed by the mean value too.
    wanted: numbers of the outputs that are bounded backwards too; None takes all.
    """
    unknown = sorted({op for op, _ in tape.nodes} - KNOWN)
    if unknown:
        raise BadInput(f"{tape.name}: no bound of rounding is stated for {', '.join(unknown)}")
    with ctx.workprec(_BITS):
        inputs = [arb(low).union(arb(high)) if low != high else arb(low) for low, high in box]
        values: list[Rounded] = []
        middles = None if along else _Middles(inputs)
        for node in tape.nodes:
            op, args = node
            leaf = op in ("input", "constant")
            values.append(_leaf(node, inputs) if leaf else _node(op, [values[a] for a in args], always=not along))
            if middles:
                values[-1] = middles.narrowed(node, values[-1])
        bounded = [
            _backwards(tape, values, r)
            if 0 < values[r].error < math.inf and (wanted is None or i in wanted)
            else values[r]
            for i, r in enumerate(tape.results)
        ]
        return bounded, middles.widest if middles else lambda: max(along, key=lambda k: box[k][1] - box[k][0])


def _leaf(node: Node, inputs: Sequence[Ball]) -> Rounded:
    return Rounded(ball=inputs[node[1][0]] if node[0] == "input" else arb(node[1][0]))


def _node(op: str, of: list[Rounded], always: bool = False) -> Rounded:
    """A node from its operands; `always` whether slopes are wanted though nothing is carried."""
    if op == "if_else_zero":
        return _chosen(*of)
    for zero, other in (of, of[::-1]) if op == "add" else ():
        if zero.computed.is_zero():  # exact, and what is added may be infinite
            return Rounded(ball=other.ball, error=other.error, slopes=(_ONE, _ONE))
    if not all(v.ball.is_finite() and math.isfinite(v.error) for v in of):
        return _NOTHING
    if op in _COMPARED:
        return _compared(op, *[v.computed for v in of])
    balls = [v.ball for v in of]
    ball = VALUES[op](*balls)
    carried, slopes = 0.0, tuple[Ball, ...]()
    if always or any(v.error for v in of):
        slopes = _SLOPES[op](*[v.computed for v in of])
        carried = sum(upper(d) * v.error for d, v in zip(slopes, of, strict=True) if v.error) * UP
    if not ball.is_finite() or not math.isfinite(carried):
        return _NOTHING
    own = _own(op, [v.computed for v in of], upper(ball) + carried)
    return Rounded(ball=ball, error=(carried + own) * UP, own=own, slopes=slopes)


def _own(op: str, of: list[Ball], size: float) -> float:
    """What an operation on what is computed adds, where its result is of a size."""
    powers_of_two = (b.is_exact() and abs(b.man_exp()[0]) == 1 for b in of)
    if (op == "mul" and any(powers_of_two)) or (op in ("add", "sub") and any(b.is_zero() for b in of)):
        return 0.0
    if op in ("sin", "cos", "tan") and upper(of[0]) > _ANGLE:
        return math.inf
    if op == "pow":
        exponent = float(of[1].mid()) if of[1].is_exact() else math.nan
        square = half_ulp(upper(of[0]) ** 2 * UP)
        if exponent in (0.5, 2.0):  # a root, a product
            return half_ulp(size)
        if exponent == 3.0:
            return (upper(of[0]) * square + half_ulp(size)) * UP
        if exponent == 4.0:
            return ((2 * upper(of[0]) ** 2 + square) * square + half_ulp(size)) * UP
    if op in ("pow", "pow_broken"):
        near = of[0] > 0 and upper(of[1] * of[0].log()) < _FAR_POWER
        return half_ulp(size, ULPS[op] if near else _FAR_ULPS)
    return half_ulp(size, ULPS.get(op, 0.0))


def _power_slopes(a: Ball, b: Ball) -> tuple[Ball, Ball]:
    return b * a ** (b - 1), _ZERO if b.is_exact() else a**b * a.log()


def _backwards(tape: Tape, values: list[Rounded], result: int) -> Rounded:
    """An output with the smaller of both bounds."""
    reached: dict[int, Ball] = {result: _ONE}
    total = 0.0
    for i in range(result, -1, -1):
        if i not in reached:
            continue
        value = values[i]
        total += upper(reached[i]) * value.own if value.own else 0.0
        for a, slope in zip(tape.nodes[i][1], value.slopes, strict=False):
            if values[a].error:
                reached[a] = reached.get(a, _ZERO) + reached[i] * slope
    error = values[result].error
    return Rounded(ball=values[result].ball, error=min(error, total * UP) if total == total else error)


class _Middles:
    """The same program at the middle of its box, and its derivatives by the inputs over the box."""

    def __init__(self, inputs: Sequence[Ball]) -> None:
        self.inputs, self.widths = inputs, [ball - ball.mid() for ball in inputs]
        self.values: list[Ball] = []
        self.slopes: list[dict[int, Ball]] = []

    def widest(self) -> int:
        """The input whose width moves the values of all nodes most, each by its size."""
        moved = dict.fromkeys(range(len(self.inputs)), 0.0)
        for value, slopes in zip(self.values, self.slopes, strict=True):
            for j, by in slopes.items():
                share = upper(by) * float(self.inputs[j].rad()) / (upper(value) or 1.0)
                moved[j] += min(share, 1.0) if share == share else 0.0
        return max(moved, key=lambda j: moved[j])

    def narrowed(self, node: Node, value: Rounded) -> Rounded:
        """A value in the ball that holds by the mean value too."""
        op, args = node
        if op == "input":
            ball = self.inputs[args[0]]
            self.values.append(ball.mid())
            self.slopes.append({} if ball.is_exact() else {args[0]: _ONE})
            return value
        if op == "constant" or not value.slopes:
            self.values.append(value.ball.mid() if value.ball.is_exact() else _NO)
            self.slopes.append({})
            return value
        chosen = op == "if_else_zero"  # then the second operand
        self.values.append(self.values[args[1]] if chosen else VALUES[op](*[self.values[a] for a in args]))
        slopes: dict[int, Ball] = {}
        for a, slope in zip(args, value.slopes, strict=True):
            for j, by in self.slopes[a].items():
                moved = by if slope is _ONE else slope * by
                slopes[j] = slopes[j] + moved if j in slopes else moved
        self.slopes.append(slopes)
        ball = sum((by * self.widths[j] for j, by in slopes.items()), self.values[-1])
        if not ball.is_finite():
            return value
        return Rounded(ball=ball.intersection(value.ball), error=value.error, own=value.own, slopes=value.slopes)


def _compared(op: str, a: Ball, b: Ball = _ZERO) -> Rounded:
    """A comparison that comes out alike for all that may be computed and for the exact values, or none."""
    sure: bool | None = None
    if op in ("lt", "le"):
        less, more = (a < b, a >= b) if op == "lt" else (a <= b, a > b)
        sure = True if less else False if more else None
    elif op in ("eq", "ne", "not"):
        apart, same = not a.overlaps(b), bool(a.is_exact() and b.is_exact() and a == b)
        sure = (apart if op == "ne" else same) if apart or same else None
    elif op in ("and", "or"):
        truth = [True if not v.overlaps(_ZERO) else False if v.is_zero() else None for v in (a, b)]
        sure = None if None in truth else (all if op == "and" else any)(truth)
    elif not a.overlaps(_ZERO):
        return Rounded(ball=arb(1 if a > 0 else -1))
    return _NOTHING if sure is None else Rounded(ball=arb(int(sure)))


def _chosen(condition: Rounded, value: Rounded) -> Rounded:
    if condition.ball.is_zero():
        return Rounded(ball=_ZERO)
    if not (condition.ball.is_exact() and condition.ball == 1 and math.isfinite(value.error)):
        return _NOTHING
    return Rounded(ball=value.ball, error=value.error, slopes=(_ZERO, _ONE))
