"""Series of an angle and its slope over the arc length, made for each run and checked against the inertia itself."""

import functools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.polynomial import chebyshev

from mechsym.native import fallback
from mechsym.native.arc import Form
from mechsym.native.tape import read
from mechsym.quantities import record

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

    Parameters
    ----------
    held : bytes
        Held values as doubles, of `shape` (runs, segments, p) [SI]

    Returns
    -------
    arcs : Arcs or None
        None where a series is too long, where inertia changes from segment to segment, or where the square of a speed
        is not that of an inertia
    """
    table, letters = np.frombuffer(held).reshape(shape), _letters(of)
    _, chosen, back = np.unique(table[:, 0, letters], axis=0, return_index=True, return_inverse=True)
    rows = table[chosen, 0]
    repeats = _repeats(of, table[chosen].reshape(len(chosen) * shape[1], shape[2])[:_TRIED])
    if repeats is None or not (table[:, :, letters] == table[:, :1, letters]).all():
        return None
    functions = [_batch(f) for f in of.inertia if f is not None]
    with np.errstate(all="ignore"):
        made = [_spectra(f, rows) for f in functions]
    terms = next((n for n in TERMS if all(np.max(np.abs(g[:, n:])) <= _TAIL for g, _ in made)), None)
    if terms is None:
        return None
    even = all(np.max(np.abs(g.imag)) <= _TAIL for g, _ in made)
    count = len(made)
    waves = [(g.real if even else g)[:, :terms] for g, _ in made]
    series = np.array([_polynomials(g) for g in waves]).reshape(count, len(rows), 6, terms)
    scale = np.array([1.0 / c**2 for _, c in made]).reshape(count, len(rows))
    if not all(_good(f, rows, s, k) for f, s, k in zip(functions, series, scale, strict=True)):
        return None
    back = back.reshape(-1)
    return Arcs(terms=terms, even=even, series=np.moveaxis(series[:, back], 1, 3), scale=scale[:, back], turns=repeats)


def _letters(of: Form) -> list[int]:
    """Held values that inertias depend on."""
    nodes = [node for f in of.inertia if f is not None for node in read(f).nodes]
    return sorted({args[0] - 1 for op, args in nodes if op == "input"} - {-1})


def _batch(function: Any) -> Callable[..., Array]:
    batch = fallback.arrays(function)
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
    return np.stack([found for a, b in pairs for found in (a @ first, b @ second)], axis=1)


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
        found, again = _accelerations(of, y, several), _accelerations(of, still, several)
        whole, rest = (rates(_TIME, *states, *several.T) for states in (y, still))
        turned = y.copy()
        turned[list(of.angles)] += 2 * np.pi
        later = rates(_TIME, *turned, *several.T)
    speeds = list(of.speeds)
    # what speeds do stands by itself, however stiff a spring beside it is
    for one, other in ((found, whole[speeds]), (found - again, whole[speeds] - rest[speeds])):
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
