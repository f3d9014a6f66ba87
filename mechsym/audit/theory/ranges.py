"""Values of entries that take a whole turn or range: harmonics, integrals, the largest and the least value."""

from collections.abc import Callable, Sequence
from functools import cache

import mpmath
import numpy as np

from mechsym.audit.read.algebra import FLOATS, SYMBOLS, Algebra, Values, evaluate
from mechsym.audit.theory.tape import Harmonic, Ranged
from mechsym.errors import BadInput

_POINTS = 32
_GRID = 256  # places of a range, between which its largest value is narrowed
# of Gauss and Legendre: points, and with digits n for 3*2**(n - 1) of them
_ORDERS = {"float": (32, 64, 128, 256), "digits": (5, 6, 7, 8)}
_GROWN = 0.01  # share by which the integral of the absolute value may still change [-]
_GOLDEN = (5**0.5 - 1) / 2
_STEPS = {"float": 80, "digits": 260}  # of the golden section: a kink's place is needed to all digits

Fill = Callable[[dict[str, Values]], None]


def harmonic(entry: Harmonic, names: dict[str, Values], algebra: Algebra, fill: Fill) -> Values:
    """Fourier coefficient of a name at all states, in its unit; nan where the points of a turn do not suffice."""
    if algebra is SYMBOLS:
        raise BadInput("a harmonic is decided by its digits alone")
    close = 1e-12 if algebra is FLOATS else mpmath.mpf(10) ** (6 - mpmath.mp.dps)
    before: Values = None
    total, count = 0, _POINTS
    while count <= 16 * _POINTS:
        # every other place of a grid is one of the grid before
        places = range(count) if before is None else range(1, count, 2)
        total = total + sum(_term(entry, names, algebra, fill, k, count) for k in places)
        now = total * (2 if entry.order else 1) / count
        if before is not None and np.all(np.abs(now - before) <= close * (1 + np.abs(now))):
            return now
        before, count = now, 2 * count
    return now * (np.nan if algebra is FLOATS else mpmath.nan)


def _term(entry: Harmonic, names: dict[str, Values], algebra: Algebra, fill: Fill, k: int, count: int) -> Values:
    angle = 2 * algebra.pi() * k / count
    like = names[entry.angle]
    turned = {n: v for n, v in names.items() if n in entry.free} | {"pi": names["pi"], entry.angle: like * 0 + angle}
    fill(turned)
    function = algebra.functions["sin" if entry.sine else "cos"]
    return turned[entry.of] * function(like * 0 + entry.order * angle)


def ranged(entry: Ranged, names: dict[str, Values], algebra: Algebra, fill: Fill) -> Values:
    """Integral, largest or least value of an expression at all states, in its unit; nan where it does not converge."""
    if algebra is SYMBOLS:
        raise BadInput(f"{'an integral' if entry.kind == 'integral' else 'an extreme'} is decided by its digits alone")
    some = next(v for k, v in names.items() if k != "pi")
    low, high = (evaluate(end, names, algebra) + some * 0 for end in (entry.low, entry.high))
    fixed = {k: v for k, v in names.items() if k in entry.free} if entry.by in entry.free else dict(names)

    def at(place: Values) -> Values:
        there = {**fixed, "pi": names["pi"], entry.by: place}
        fill(there)
        return evaluate(entry.of, there, algebra) + some * 0

    if entry.kind == "integral":
        return _integral(at, low, high, algebra)
    return _extreme(at, low, high, algebra, 1 if entry.kind == "peak" else -1)


def _integral(at: Callable[[Values], Values], low: Values, high: Values, algebra: Algebra) -> Values:
    kind = "float" if algebra is FLOATS else "digits"
    close = 1e-12 if algebra is FLOATS else mpmath.mpf(10) ** (6 - mpmath.mp.dps)
    middle, half = (high + low) / 2, (high - low) / 2
    before: Values = None
    before_size: Values = None
    for order in _ORDERS[kind]:
        now, size = half * 0, half * 0
        for place, weight in _nodes(kind, order, mpmath.mp.prec):
            value = at(middle + half * place)
            now, size = now + weight * value, size + weight * abs(value)
        now, size = now * half, size * abs(half)
        if before is not None and np.all(np.abs(now - before) <= close * (size + np.abs(now))):
            # of a pole, whose sides cancel, the sizes go on growing
            return np.where(np.abs(size - before_size) <= _GROWN * size, now, now * np.nan)
        before, before_size = now, size
    return now * (np.nan if algebra is FLOATS else mpmath.nan)


@cache
def _nodes(kind: str, order: int, bits: int) -> Sequence[tuple[Values, Values]]:
    if kind == "float":
        places, weights = np.polynomial.legendre.leggauss(order)
        return tuple(zip(places.tolist(), weights.tolist(), strict=True))
    return tuple(mpmath.calculus.quadrature.GaussLegendre(mpmath.mp).calc_nodes(order, bits))


def _extreme(at: Callable[[Values], Values], low: Values, high: Values, algebra: Algebra, sign: int) -> Values:
    # the best of a grid, then its neighbourhood by the golden section, which asks for no derivative
    best, value = low, sign * at(low)
    step = (high - low) / _GRID
    for k in range(1, _GRID + 1):
        place = low + k * step
        now = sign * at(place)
        better = now > value
        best, value = np.where(better, place, best), np.where(better, now, value)
    left, right = np.maximum(best - step, low), np.minimum(best + step, high)
    share = _GOLDEN if algebra is FLOATS else (mpmath.sqrt(5) - 1) / 2
    a, b = right - share * (right - left), left + share * (right - left)
    of_a, of_b = sign * at(a), sign * at(b)
    for _ in range(_STEPS["float" if algebra is FLOATS else "digits"]):
        value = np.maximum(value, np.maximum(of_a, of_b))
        nearer = of_a > of_b
        left, right = np.where(nearer, left, a), np.where(nearer, b, right)
        new = np.where(nearer, right - share * (right - left), left + share * (right - left))
        of_new = sign * at(new)
        a, b = np.where(nearer, new, b), np.where(nearer, a, new)
        of_a, of_b = np.where(nearer, of_new, of_b), np.where(nearer, of_a, of_new)
    return sign * value
