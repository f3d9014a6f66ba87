"""What the machine code returns at random points, against 60 digits: what a bound must not be below."""

import math
import types
from collections.abc import Callable, Sequence
from types import ModuleType

import numpy as np

from mechsym.native.evaluate import numpy_function
from mechsym.native.tape import Tape
from mechsym.proof.balls import REAL, Ball, arb, ctx

_BITS = 200  # 60 digits
ALL = 20_000  #: Points that are all held against 60 digits; of more, those that are farthest off
_CHUNK, _FARTHEST = 10_000, 10  # points at a time, and how many of them for each output
Exact = Callable[..., Sequence[Ball]]


def exact_function(module: ModuleType, function: str) -> Exact:
    """A plain generated function for balls: its own text with arithmetic of balls in place of casadi's, so that neither
    the tape nor what casadi makes of it is part of the comparison."""
    plain = getattr(module, function)
    arithmetic = types.SimpleNamespace(**REAL, fabs=abs)
    return types.FunctionType(plain.__code__, {**plain.__globals__, "ca": arithmetic})


def farthest(code: Callable[..., np.ndarray], tape: Tape, points: np.ndarray) -> np.ndarray:
    """Of many points (inputs, n) [SI] those where code is farthest off, for each output, told by the tape in extended
    precision (64 bits); all of few points, or where the processor has no such numbers."""
    if points.shape[1] <= ALL or np.finfo(np.longdouble).nmant < 63:
        return points
    run, far = numpy_function(tape), []
    for start in range(0, points.shape[1], _CHUNK):
        some = np.ascontiguousarray(points[:, start : start + _CHUNK])
        near = np.empty((len(tape.results), some.shape[1]), np.longdouble)
        with np.errstate(all="ignore"):
            run([*some.astype(np.longdouble)], near)
            computed = code(*some)
            off = np.where(computed == near, 0, np.nan_to_num(np.abs(computed - near), nan=np.inf))
        far.append(some[:, np.unique(np.argsort(off, axis=1)[:, -_FARTHEST:])])
    return np.hstack(far)


def errors(
    code: Callable[..., np.ndarray],
    exact: Exact,
    points: np.ndarray,
    progress: Callable[[int], object] = lambda _: None,
) -> tuple[np.ndarray, np.ndarray]:
    """How far code is off at points (inputs, n), and the sizes of the exact values: both (outputs, n) [SI]."""
    computed = code(*np.ascontiguousarray(points))
    off, sizes = np.zeros(computed.shape), np.zeros(computed.shape)
    with ctx.workprec(_BITS):
        for j in range(points.shape[1]):
            values = exact(*[arb(v) for v in points[:, j].tolist()])
            for i, value in enumerate(values):
                returned, ball = float(computed[i, j]), arb(value)  # an integer is a value too: 0 by symmetry
                if ball.is_finite():
                    off[i, j] = float(abs(arb(returned) - ball).upper()) if math.isfinite(returned) else math.inf
                    sizes[i, j] = float(abs(ball).mid())
                else:  # no limit asks anything there
                    off[i, j] = 0.0 if returned == float(ball) else math.inf
            progress(1)
    return off, sizes


def points_in(boxes: Sequence[Sequence[tuple[float, float]]], count: int, seed: int) -> np.ndarray:
    """Random points (inputs, n) [SI] of boxes; half of their values are at the ends."""
    random = np.random.default_rng(seed)
    ends = np.array(boxes, dtype=float)
    which = random.integers(len(boxes), size=count)
    low, high = ends[which, :, 0], ends[which, :, 1]
    share = random.random(low.shape)
    share = np.where(random.random(low.shape) < 0.5, np.round(share), share)
    return np.clip(low + share * (high - low), low, high).T
