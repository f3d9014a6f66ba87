r"""The states that a motion can have, enclosed from step to step.

A set of states is x + B c: a point, a matrix, a box of half-widths c, all exact. For a step h from it
p(t) and W(t) are polynomials near the motion from x and its derivative by the start; they need not be right:

.. math:: d = \sup |f(p) - p'|, \qquad D = \sup |A(p) W - W'|, \qquad A = \partial f / \partial x

is measured. Coefficients below the order are there in balls; those beyond are at most F / rho^k, F a bound of f(p) on
the disc of complex times |t| <= rho, where one evaluation in complex balls shows it to be analytic (Cauchy). With L a
bound of A over all x within R of p, and a set of size s = |B c|, as long as the inclusion (s + h d) exp(L h) <= R holds
(Gronwall),

.. math:: x(h) \in p(h) + W(h) B c + w (h d + s V) e^{L h}, \qquad V = h (D + L |W| \frac{r/R}{1 - r/R})

r the inclusion's left side: A changes by that share of L within r of p (Cauchy again). The next set has B' = W(h) B, as
it is computed, and c grows by |B'^-1| times the last term: nothing wraps, what is lost is a condition number.
p comes by Newton's method: where it has k coefficients, the next k are those of e, e' = A e + f(p) - p'. Norms are the
largest |x_i| / w_i. Bounds are sums of doubles of one sign, each product of them rounded up by `UP`.
"""

import math
from collections.abc import Iterator, Sequence
from fractions import Fraction
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.native.tape import Tape
from mechsym.proof import balls
from mechsym.proof.balls import UP, Ball, acb, arb, arb_mat, ctx, ratio, upper
from mechsym.quantities import record

_REACH = 0.03  # R at most: how far in the norm around p the equations are bounded [-]
_LADDER = (1.2, 1.0, 1 / 1.2)  # radii of the disc that a step tries, by that of the last
_SHORTEST = 1e-9  # step, and radius of a disc [s]
_LOW = 64  # bits for what is only a bound


@record
class EnclosureMethod:
    """How a motion is enclosed."""

    bits: int = 110  #: of the midpoints
    order: int = 32  #: of p
    order_of_W: int = 20
    noise: float = 1e-25  #: h d that a step may have, in the norm [-]
    skew: float = 1e-15  #: V that a step may have [-]
    longest: float = 0.05  #: step [s]


@record
class Set:
    """The states x + B c at a time."""

    t: Fraction
    x: tuple[Ball, ...]  #: shape (n,)
    B: Any  #: shape (n, n), balls of radius 0
    c: np.ndarray  #: shape (n,), half-widths along the columns of B [-]

    @property
    def half_widths(self) -> np.ndarray:
        """Of each state [SI]."""
        return magnitudes(self.B) @ self.c * UP

    @property
    def balls(self) -> list[Ball]:
        """The states."""
        return [x + arb(0, width) for x, width in zip(self.x, self.half_widths.tolist(), strict=True)]


@record
class Step:
    """A step from one set to the next, with all states on its way."""

    start: Set
    end: Set
    length: Fraction
    low: np.ndarray  #: shape (n,), no state is below during the step [SI]
    high: np.ndarray  #: nor above [SI]


def magnitudes(matrix: Any) -> np.ndarray:
    """Upper bounds of the entries of a matrix of balls [unit of each]."""
    return np.array([[upper(entry) for entry in row] for row in matrix.tolist()])


def _identity(n: int) -> Any:
    return arb_mat([[arb(i == j) for j in range(n)] for i in range(n)])


def point(t: Fraction, x: Sequence[Ball]) -> Set:
    """A set from a state in balls, such as the decimals of a case."""
    return Set(t=t, x=tuple(b.mid() for b in x), B=_identity(len(x)), c=np.array([upper(b - b.mid()) for b in x]))


def grown(A: Sequence[Any], first: Any, rests: Sequence[Any], at: int) -> tuple[list[Any], list[Any]]:
    """Coefficients of Y' = A Y + rest from that of order `at` on, exact matrices; A Y + rest in balls from there on."""
    Y, slopes = [first], []
    for k, slope in enumerate(rests, at + 1):
        for a, y in zip(A, reversed(Y), strict=False):
            slope = slope + a * y
        slopes.append(slope)
        Y.append((slope * (1 / arb(k))).mid())
    return Y, slopes


class TaylorMotion:
    """The Taylor coefficients of x' = f(x) with A = df/dx along them; one tape gives f and then A by columns."""

    def __init__(self, tape: Tape, states: int, held: Sequence[Ball]) -> None:
        """states: number of x, the first inputs; held: balls of the inputs behind them."""
        balls.refuse_unknown(tape, balls.SERIES, tape.name)
        self.tape, self.states, self.held = tape, states, list(held)
        self.x: list[list[Ball]] = []
        self.f: list[Any] = []  # columns in balls, and matrices
        self.A: list[Any] = []

    def expand(self, start: Sequence[Ball], order: int, order_of_A: int) -> None:
        """x from an exact start to an order, exact coefficients; f along it to one less, A to its own."""
        self.x, sizes = [[value] for value in start], [order + 1]
        while sizes[0] > 2:
            sizes.insert(0, (sizes[0] + 1) // 2)
        for size in sizes:
            k = len(self.x[0])
            self._along(size - 1, size - k)
            columns, _ = grown(self.A, (self.f[k - 1] * (1 / arb(k))).mid(), self.f[k:], k)
            for i, coefficients in enumerate(self.x):
                coefficients += [column[i, 0] for column in columns]
        self._along(order, order_of_A)

    def _along(self, order: int, order_of_A: int) -> None:
        series, n = balls.coefficients(self.tape, balls.SERIES, [*self.x, *self.held], order), self.states
        self.f = [arb_mat([[v[k]] for v in series[:n]]) for k in range(order)]
        self.A = [arb_mat([[v[k] for v in series[n + i :: n]] for i in range(n)]) for k in range(order_of_A)]


class Enclosure:
    """Steps of a motion whose held inputs stay."""

    def __init__(self, motion: TaylorMotion, method: EnclosureMethod, weights: np.ndarray) -> None:
        """weights: w, the size of each state in the norm [SI]."""
        self.motion, self.method, self.w, self.rho, self.reach = motion, method, weights, method.longest, _REACH
        self.n = motion.states

    def steps(self, start: Set, until: Fraction) -> Iterator[Step]:
        """Steps to a time exactly. Raises BadInput: the set has grown beyond what can be enclosed."""
        with ctx.workprec(self.method.bits):
            while start.t < until:
                step = self.step(start, until - start.t)
                yield step
                start = step.end

    def step(self, start: Set, most: Fraction) -> Step:
        """One step, at most so long."""
        self.motion.expand(start.x, self.method.order, self.method.order_of_W)
        W, A_W = self._derivative()
        size = self.norm(magnitudes(start.B) @ start.c)
        h, self.reach = 0.0, min(_REACH, 2 * self.reach)
        while not h > 0:
            h, rho, bounds = max((self._length(W, share * self.rho) for share in _LADDER), key=lambda length: length[0])
            if h > 0:
                self.rho = rho
                break
            if all(map(math.isfinite, self._bounded(0.0, 0.0))):
                self.rho /= 2
            else:
                self.reach /= 2
            if min(self.rho, self.reach) < _SHORTEST:
                raise BadInput(f"at {float(start.t):g} s the equations cannot be enclosed on any disc of times")
        length = min(Fraction(math.ldexp(math.floor(math.ldexp(h, 40)), -40)), most)
        while True:
            noise, reach = self._noise(length, bounds, size, W, A_W)
            if reach <= self.reach:
                return self._next(start, length, W, noise, reach)
            length /= 2
            if length < _SHORTEST:
                raise BadInput(
                    f"at {float(start.t):g} s the enclosure is {2 * size:.2g} wide and grows within a step beyond what "
                    "its equations are bounded on; give more digits"
                )

    def norm(self, values: np.ndarray) -> float:
        """Largest of magnitudes [SI] by the weights [-]."""
        return float((values / self.w).max()) * UP

    def matrix_norm(self, values: np.ndarray) -> float:
        """Norm of a matrix of magnitudes [-]."""
        return float((values @ self.w / self.w).max()) * UP

    def _derivative(self) -> tuple[list[Any], list[float]]:
        """Coefficients of W, exact matrices, and the norms of those of A W - W' that balls leave below its order."""
        n, order = self.n, self.method.order_of_W
        W, slopes = grown(self.motion.A, _identity(n), [arb_mat(n, n)] * order, 0)
        left = [slope - matrix * arb(k) for k, (slope, matrix) in enumerate(zip(slopes, W[1:], strict=True), 1)]
        return W, [self.matrix_norm(magnitudes(matrix)) for matrix in left]

    def _bounded(self, real: float, imaginary: float) -> tuple[float, float]:
        """Norms of f and A within R of p: at times up to `real` alone, or on a disc of times where both are alike."""
        inputs = []
        with ctx.workprec(_LOW):
            for p, w in zip(self.motion.x, self.w, strict=True):
                radii = (
                    sum(upper(c) * t**k for k, c in enumerate(p) if k) * UP + self.reach * w for t in (real, imaginary)
                )
                inputs.append(acb(arb(p[0], next(radii)), arb(0, next(radii))))
            values = [upper(v) for v in balls.evaluate(self.motion.tape, balls.COMPLEX, [*inputs, *self.motion.held])]
        A = np.array(values[self.n :]).reshape(self.n, self.n).T
        return self.norm(np.array(values[: self.n])), self.matrix_norm(A)

    def _length(self, W: list[Any], rho: float) -> tuple[float, float, tuple[float, float, float, float]]:
        """Step that a disc of times allows; its radius, bounds of f, A and W on it."""
        method = self.method
        F, L = self._bounded(rho, rho)
        if not (math.isfinite(F) and math.isfinite(L)):
            return 0.0, rho, (F, L, 0.0, rho)
        size = sum(self.matrix_norm(magnitudes(matrix)) * rho**k for k, matrix in enumerate(W)) * UP
        by_x = rho * (method.noise / max(F * rho, 1e-300)) ** (1 / (method.order + 1))
        by_W = rho * (method.skew / max(L * size * rho, 1e-300)) ** (1 / (method.order_of_W + 1))
        return min(by_x, by_W, rho / 2, method.longest), rho, (F, L, size, rho)

    def _noise(
        self, length: Fraction, bounds: tuple[float, ...], size: float, W: list[Any], A_W: list[float]
    ) -> tuple[float, float]:
        """What a step adds, in the norm, and how far from p the set gets on the way."""
        (F, K, W_size, rho), h, order = bounds, float(length) * UP, self.method.order
        L = self._bounded(h, 0.0)[1]
        growth, ratio = math.exp(L * h) * UP, h / rho
        left = [
            self.norm(np.array([upper(f[i, 0] - p[k] * k) for i, p in enumerate(self.motion.x)]))
            for k, f in enumerate(self.motion.f, 1)
        ]
        d = (_at(left, h) + F * ratio**order / (1 - ratio)) * UP
        D = (_at(A_W, h) + K * W_size * ratio**self.method.order_of_W / (1 - ratio)) * UP
        reach = (size + h * d) * growth * UP
        share = reach / self.reach
        within = sum(self.matrix_norm(magnitudes(matrix)) * h**k for k, matrix in enumerate(W)) * UP
        V = h * (D + L * within * share / (1 - share)) * UP if share < 1 else math.inf
        return (h * d + size * V) * growth * UP, reach

    def _next(self, start: Set, length: Fraction, W: list[Any], noise: float, reach: float) -> Step:
        h = ratio(length)
        there = [_value(p, h) for p in self.motion.x]
        moved = W[-1]
        for matrix in reversed(W[:-1]):
            moved = moved * h + matrix
        exact = moved * start.B
        B = exact.mid()
        lost = noise * self.w + magnitudes(exact - B) @ start.c + np.array([upper(b - b.mid()) for b in there])
        c = (start.c + magnitudes(B.inv()) @ lost) * UP
        low, high = self._range(h, reach)
        end = Set(t=start.t + length, x=tuple(b.mid() for b in there), B=B, c=c)
        return Step(start=start, end=end, length=length, low=low, high=high)

    def _range(self, h: Ball, reach: float) -> tuple[np.ndarray, np.ndarray]:
        """Bounds of the states over the step: of four parts of it, by the mean value."""
        low, high = np.full(self.n, np.inf), np.full(self.n, -np.inf)
        with ctx.workprec(_LOW):
            eighth = h / 8
            for i, p in enumerate(self.motion.x):
                slopes = [k * c for k, c in enumerate(p)][1:]
                for part in (1, 3, 5, 7):
                    middle = eighth * part
                    about = middle + eighth * arb(0, 1)
                    value = _value(p, middle) + _value(slopes, about) * eighth * arb(0, 1) + arb(0, reach * self.w[i])
                    low[i] = min(low[i], float(value.lower()))
                    high[i] = max(high[i], float(value.upper()))
        wide = 1e-15 * np.maximum(np.abs(low), np.abs(high))  # doubles are nearest to a ball's ends
        return low - wide, high + wide


def _value(p: Sequence[Ball], t: Ball) -> Ball:
    """A polynomial by Horner's rule."""
    value = p[-1]
    for c in reversed(p[:-1]):
        value = value * t + c
    return value


def _at(magnitudes_: Sequence[float], h: float) -> float:
    return sum(m * h**k for k, m in enumerate(magnitudes_)) * UP


def weights(motion: TaylorMotion, start: Set, coordinates: int) -> np.ndarray:
    """Sizes of the states in the norm [SI]: 1 for coordinates, for velocities the fastest rate of their equations."""
    motion.expand(start.x, 1, 1)
    rate = math.sqrt(max(1.0, float(magnitudes(motion.A[0])[coordinates : 2 * coordinates, :coordinates].max())))
    w = np.ones(motion.states)
    w[coordinates : 2 * coordinates] = rate
    return w


def kept(start: Set) -> dict[str, Any]:
    """A set as plain numbers, exactly."""
    entries = [[_exact(b) for b in row] for row in start.B.tolist()]
    return {"t": str(start.t), "x": [_exact(b) for b in start.x], "B": entries, "c": [float(v).hex() for v in start.c]}


def restored(numbers: dict[str, Any]) -> Set:
    """The set of `kept`."""
    B = arb_mat([[_ball(text) for text in row] for row in numbers["B"]])
    c = np.array([float.fromhex(text) for text in numbers["c"]])
    return Set(t=Fraction(numbers["t"]), x=tuple(_ball(text) for text in numbers["x"]), B=B, c=c)


def _exact(ball: Ball) -> str:
    mantissa, exponent = ball.man_exp()
    return f"{mantissa} {exponent}"


def _ball(text: str) -> Ball:
    mantissa, exponent = (int(part) for part in text.split())
    # precision may be below the mantissa's length: a product with a power of two is exact then all the same
    with ctx.workprec(max(2, mantissa.bit_length() + 2)):
        return arb(mantissa) * arb(2) ** exponent
