r"""Equations of motion along the arc length of each angle, where its inertia depends on that angle only.

    J(q) q'' = T - J'(q) q'^2 / 2,   dx = sqrt(J) dq / c,   G = dq/dx = c / sqrt(J)

    x'' = T G / c^2

The term in the square of the speed is gone, and with it a root and a quotient: q(x) - x and G are short series in
cos x and sin x, made for each run and checked against the inertia itself. c is the mean of sqrt(J) over a turn, so that
x turns with q.
"""

import functools
from collections.abc import Callable

import casadi as ca
import numpy as np
from numpy.polynomial import chebyshev

from mechsym.native import evaluate
from mechsym.native.tape import ANALYTIC, read
from mechsym.quantities import record


@record
class Form:
    """Rates in a form for methods that look back."""

    rates: ca.Function  #: (t, y, p) to the rates
    forces: ca.Function  #: (t, y, p) to the torque, or the acceleration where J is constant, and the rates of `read`
    works: ca.Function  #: (t, y, p) to the rates of `unread`
    inertia: tuple[ca.Function | None, ...]  #: For each angle (q, p) to J and dJ/dq; None where it is constant [SI]
    #: States that are angles, and the speed of each
    angles: tuple[int, ...]
    speeds: tuple[int, ...]
    #: Other states, which rates depend on or not
    read: tuple[int, ...]
    unread: tuple[int, ...]


@functools.lru_cache(maxsize=256)
def form(stored: str) -> Form | None:
    """The form of a right-hand side.

    stored: a function (t, y, p) to the rates as CasADi stores it. Returns form: None where nothing moves, or where an
    inertia depends on more than its own angle.
    """
    rates = ca.Function.deserialize(stored)
    tape = read(rates)
    if not {op for op, _ in tape.nodes} <= ANALYTIC:
        return None
    t, y, p = (ca.SX.sym(rates.name_in(i), rates.numel_in(i)) for i in range(3))
    slopes, states = ca.vertsplit(rates(t, y, p)), ca.vertsplit(y)
    # states whose rate is another state that has a rate of its own, and that state
    ends = [tape.nodes[r] for r in tape.results]
    same = {i: args[0] - 1 for i, (op, args) in enumerate(ends) if op == "input" and 1 <= args[0] <= len(states)}
    pairs = [(q, u) for q, u in same.items() if u not in same]
    if len({u for _, u in pairs}) < len(pairs):
        return None
    parts = [_torque(slopes[u], (states[q], states[u]), p) for q, u in pairs]
    good = [part for part in parts if part is not None]
    if not pairs or len(good) < len(parts):
        return None
    used = {args[0] - 1 for op, args in tape.nodes if op == "input"}
    others = [i for i in range(len(states)) if i not in {i for pair in pairs for i in pair}]
    reading, unread = (tuple(i for i in others if (i in used) == wanted) for wanted in (True, False))
    inertia: list[ca.Function | None] = []
    for (_, J), (q, _) in zip(good, pairs, strict=True):
        both = None if J is None else ca.vertcat(J, ca.gradient(J, states[q]))
        inertia.append(both if both is None else ca.Function("inertia", [states[q], p], [both]))
    above = [*(torque for torque, _ in good), *(slopes[i] for i in reading)]
    rest = [slopes[i] for i in unread]
    return Form(
        rates=rates,
        forces=ca.Function(f"{rates.name()}_forces", [t, y, p], [ca.vertcat(ca.SX(0, 1), *above)]),
        works=ca.Function(f"{rates.name()}_works", [t, y, p], [ca.vertcat(ca.SX(0, 1), *rest)]),
        inertia=tuple(inertia),
        angles=tuple(q for q, _ in pairs),
        speeds=tuple(u for _, u in pairs),
        read=reading,
        unread=unread,
    )


def _torque(rate: ca.SX, state: tuple[ca.SX, ca.SX], p: ca.SX) -> tuple[ca.SX, ca.SX | None] | None:
    """Torque and inertia of one angle; the rate itself and None where no inertia changes."""
    q, u = state
    below = rate.dep(1) if not rate.is_leaf() and rate.op() == ca.OP_DIV else ca.SX(1)
    above = rate.dep(0) if ca.depends_on(below, q) else rate
    # with J(q) the square of the speed goes with dJ/dq, which `arcs` holds by numbers
    slope = ca.gradient(above, u)
    square = ca.depends_on(slope, u)
    if above is rate:
        return None if square else (rate, None)
    if any(not ca.depends_on(ca.vertcat(q, p), s) for s in ca.symvar(below)):
        return None
    return ca.substitute(above, u, 0) + u * ca.substitute(slope, u, 0), below


_POINTS = 128  # of a turn, from which a series is made
_CHECKED = 512  # and at which it is checked
# terms that a series may have; a polynomial in the cosine with more of them loses digits
TERMS = (8, 12, 16, 20, 24, 28)
_TAIL = 1e-15  # what may be left away
_TRIED = 32  # rows of held values at which torques and inertias are compared with the rates
_GOOD = 1e-13  # largest difference of G sqrt(J) / c to 1 that is taken
_SAME = 1e-9  # what round-off leaves of terms that cancel
_LEAST, _TIME = 1e-300, 0.5

Array = np.ndarray


@record
class Arcs:
    """Series of the angles with an inertia of their own, for each run, and what else depends on its numbers."""

    terms: int  #: Terms of each series
    even: bool  #: Whether every inertia is the same on both sides of 0
    #: shape (angles, 6, terms, runs): Polynomials in cos x, lowest power first: G, what sin x goes with in G, the same
    #: two of q - x, and of dG/dx [-]
    series: Array
    scale: Array  #: shape (angles, runs): 1/c^2 [SI]
    turns: bool  #: Whether a turn of all angles changes nothing


@functools.lru_cache(maxsize=64)
def arcs(of: Form, held: bytes, shape: tuple[int, int, int]) -> Arcs | None:
    """Series for runs.

    held: held values as doubles, of `shape` (runs, segments, p) [SI].

    Returns arcs: None where a series is too long, where inertia changes from segment to segment, or where the square of
    a speed is not that of an inertia.
    """
    nodes = [node for f in of.inertia if f is not None for node in read(f).nodes]
    letters = sorted({args[0] - 1 for op, args in nodes if op == "input"} - {-1})  # held values that inertias depend on
    table = np.frombuffer(held).reshape(shape)
    _, chosen, back = np.unique(table[:, 0, letters], axis=0, return_index=True, return_inverse=True)
    rows = table[chosen, 0]
    repeats = _repeats(of, table[chosen].reshape(len(chosen) * shape[1], shape[2])[:_TRIED])
    if repeats is None or not (table[:, :, letters] == table[:, :1, letters]).all():
        return None
    functions = [_batch(f) for f in of.inertia if f is not None]
    with np.errstate(all="ignore"):
        spectra = [_spectra(f, rows) for f in functions]
    terms = next((n for n in TERMS if all(np.max(np.abs(g[:, n:])) <= _TAIL for g, _ in spectra)), None)
    if terms is None:
        return None
    even = all(np.max(np.abs(g.imag)) <= _TAIL for g, _ in spectra)
    count = len(spectra)
    waves = [(g.real if even else g)[:, :terms] for g, _ in spectra]
    series = np.array([_polynomials(g) for g in waves]).reshape(count, len(rows), 6, terms)
    scale = np.array([1.0 / c**2 for _, c in spectra]).reshape(count, len(rows))
    if not all(_good(f, rows, s, k) for f, s, k in zip(functions, series, scale, strict=True)):
        return None
    back = back.reshape(-1)
    return Arcs(terms=terms, even=even, series=np.moveaxis(series[:, back], 1, 3), scale=scale[:, back], turns=repeats)


def _batch(function: object) -> Callable[..., Array]:
    batch = evaluate.arrays(function)
    assert batch is not None  # elementary, as the rates are
    return batch


def _root(inertia: Callable[..., Array], rows: Array, q: Array) -> Array:
    """Root of an inertia at angles (runs, n) of runs with held values (runs, p)."""
    held = [np.repeat(column, q.shape[1]) for column in rows.T]
    return np.sqrt(inertia(q.ravel(), *held)[0].reshape(q.shape))


def _spectra(inertia: Callable[..., Array], rows: Array) -> tuple[Array, Array]:
    """Fourier coefficients (runs, terms) of G = dq/dx, and c (runs,).

    g_0 + sum of g_k exp(i k x) and its conjugate, k > 0
    """
    even = np.arange(_POINTS) * (2 * np.pi / _POINTS)
    waves = np.fft.rfft(_root(inertia, rows, np.tile(even, (len(rows), 1)))) / _POINTS
    c = waves[:, 0].real
    most = max(int(np.max(np.nonzero(np.abs(waves / c[:, None]) > _TAIL)[1])), 1)
    order = np.arange(1, most + 1)
    shape = 2 * waves[:, 1 : most + 1] / (1j * order * c[:, None])  # x - q = Re sum of shape_k exp(i k q)
    both = np.stack([shape, 1j * order * shape], axis=1)
    q = np.tile(even, (len(rows), 1))
    for _ in range(20):
        turning = np.multiply.accumulate(np.repeat(np.exp(1j * q)[:, None], most, axis=1), axis=1)
        moved, slope = (both @ turning).real.swapaxes(0, 1)
        off = q + moved - even
        q -= off / (1 + slope)
        if np.max(np.abs(off)) < 1e-13:
            break
    return np.fft.rfft(c[:, None] / _root(inertia, rows, q))[:, : _POINTS // 2] / _POINTS, c


@functools.cache
def _powers(terms: int) -> tuple[Array, Array]:
    """Matrices from coefficients of cos kx, and of sin kx / sin x with k > 0, to powers of cos x."""
    first = np.zeros((terms, terms))
    second = np.zeros((terms, terms))
    for k in range(terms):
        first[k, : k + 1] = chebyshev.cheb2poly(np.eye(k + 1)[k])
    for k in range(1, terms):
        # sin kx = sin x (dT_k/dc) / k
        second[k, :k] = first[k, 1 : k + 1] * np.arange(1, k + 1) / k
    return first, second


def _polynomials(waves: Array) -> Array:
    """The six polynomials (runs, 6, terms) of coefficients (runs, terms) of G."""
    first, second = _powers(waves.shape[1])
    order = np.arange(waves.shape[1])
    cosine = np.where(order, 2, 1) * waves.real
    sine = -2 * waves.imag
    over = np.maximum(order, 1)
    # q - x is the integral of G - 1, without a mean of its own
    angle_cosine, angle_sine = np.where(order, -sine / over, 0), np.where(order, cosine / over, 0)
    pairs = ((cosine, sine), (angle_cosine, angle_sine), (order * sine, -order * cosine))
    return np.stack([row for a, b in pairs for row in (a @ first, b @ second)], axis=1)


def _good(inertia: Callable[..., Array], rows: Array, series: Array, scale: Array) -> bool:
    """Whether G sqrt(J) = c, at angles that are none of those from which the series was made."""
    x = (np.arange(_CHECKED) + 0.5) * (2 * np.pi / _CHECKED)
    powers = np.vander(np.cos(x), series.shape[2], increasing=True)
    values = np.einsum("rfk,nk->frn", series, powers)
    slope, angle = values[0] + np.sin(x) * values[1], x + values[2] + np.sin(x) * values[3]
    miss = slope * _root(inertia, rows, angle) * np.sqrt(scale)[:, None] - 1
    return bool(np.all(np.abs(miss) < _GOOD))


def _repeats(of: Form, rows: Array) -> bool | None:
    """Whether a turn of all angles changes nothing; None where torques and inertias do not give the rates back."""
    n, several = of.rates.numel_in(1), np.repeat(rows, 6, axis=0)
    y = np.random.default_rng(1).uniform(-3.0, 3.0, (n, len(several)))
    y[list(of.speeds)] *= 30.0
    rates, still = _batch(of.rates), y.copy()
    still[list(of.speeds)] = 0.0
    with np.errstate(all="ignore"):
        moving, resting = _accelerations(of, y, several), _accelerations(of, still, several)
        whole, rest = (rates(_TIME, *states, *several.T) for states in (y, still))
        turned = y.copy()
        turned[list(of.angles)] += 2 * np.pi
        later = rates(_TIME, *turned, *several.T)
    speeds = list(of.speeds)
    # what speeds do stands by itself, however stiff a spring beside it is
    for one, other in ((moving, whole[speeds]), (moving - resting, whole[speeds] - rest[speeds])):
        size = np.max(np.abs(other), axis=1, keepdims=True, initial=_LEAST)
        noise = 1e-13 * np.max(np.abs(whole[speeds]), axis=1, keepdims=True)
        if not np.all(np.abs(one - other) <= np.maximum(_SAME * size, noise)):
            return None
    return bool(np.all(np.abs(later - whole) <= _SAME * np.max(np.abs(whole), axis=1, keepdims=True)))


def _accelerations(of: Form, y: Array, held: Array) -> Array:
    """Accelerations (angles, n) from torques and inertias."""
    torques = _batch(of.forces)(_TIME, *y, *held.T)
    for i, (q, u, f) in enumerate(zip(of.angles, of.speeds, of.inertia, strict=True)):
        if f is not None:
            inertia, slope = _batch(f)(y[q], *held.T)
            torques[i] = (torques[i] - slope * y[u] ** 2 / 2) / inertia
    return torques[: len(of.angles)]
