"""Names that no formula gives: roots of equations by Newton's method, harmonics by the trapezoidal rule."""

import ast
from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np

from mechsym.audit.algebra import DIGITS, FLOATS, SYMBOLS, Algebra, evaluate
from mechsym.audit.calculus import derivative
from mechsym.audit.theory.tape import Harmonic, Root
from mechsym.audit.tree import number
from mechsym.errors import BadInput

_DIVIDE = ast.Div
_STEPS = 60
_POINTS = 32


def root(entry: Root, names: dict[str, Any], algebra: Algebra) -> Any:
    """Values of the unknown at all states; nan where Newton's method does not converge.

    Returns
    -------
    values : array, shape (n,)
        In the unit of the unknown [unit]
    """
    if algebra is SYMBOLS:
        raise BadInput("a root of an equation is decided by its digits alone")
    slope = derivative(entry.equation, lambda k: number(int(k == entry.unknown)))
    start = evaluate(entry.start, names, algebra)
    floats = {k: np.asarray(v, dtype=float) for k, v in names.items()}
    found = _newton(entry, slope, floats, np.asarray(start, dtype=float), FLOATS, _STEPS)
    if algebra is FLOATS:
        return found
    steps = 2 + int(np.log2(max(mpmath.mp.dps / 14, 1)) + 1)
    digits = np.array([mpmath.mpf(float(v)) for v in np.atleast_1d(found)])
    return _newton(entry, slope, names, digits, DIGITS, steps)


def _newton(entry: Root, slope: Any, names: dict[str, Any], value: Any, algebra: Algebra, steps: int) -> Any:
    divide = algebra.operations[_DIVIDE]
    for _ in range(steps):
        now = {**names, entry.unknown: value}
        step = divide(evaluate(entry.equation, now, algebra), evaluate(slope, now, algebra))
        value = value - step
        if algebra is FLOATS and not np.any(np.abs(step) > 1e-15 * (1 + np.abs(value))):
            break
    if algebra is FLOATS:
        left = np.abs(evaluate(entry.equation, {**names, entry.unknown: value}, algebra))
        value = np.where(left < 1e-9 * (1 + np.max(np.where(np.isfinite(left), left, 0.0))), value, np.nan)
    return value


def harmonic(entry: Harmonic, names: dict[str, Any], algebra: Algebra, fill: Callable[[dict[str, Any]], None]) -> Any:
    """Fourier coefficient of a name at all states; nan where the points of a turn do not suffice.

    Returns
    -------
    values : array, shape (n,)
        In the unit of the name [unit]
    """
    if algebra is SYMBOLS:
        raise BadInput("a harmonic is decided by its digits alone")
    close = 1e-12 if algebra is FLOATS else mpmath.mpf(10) ** (6 - mpmath.mp.dps)
    before: Any = None
    count = _POINTS
    while count <= 16 * _POINTS:
        now = sum(_term(entry, names, algebra, fill, k, count) for k in range(count))
        now = now * (2 if entry.order else 1) / count
        if before is not None and np.all(np.abs(now - before) <= close * (1 + np.abs(now))):
            return now
        before, count = now, 2 * count
    return now * (np.nan if algebra is FLOATS else mpmath.nan)


def _term(entry: Harmonic, names: dict[str, Any], algebra: Algebra, fill: Any, k: int, count: int) -> Any:
    angle = 2 * algebra.pi() * k / count
    like = names[entry.angle]
    turned = {n: v for n, v in names.items() if n in entry.free} | {"pi": names["pi"], entry.angle: like * 0 + angle}
    fill(turned)
    function = algebra.functions["sin" if entry.sine else "cos"]
    return turned[entry.of] * function(like * 0 + entry.order * angle)
