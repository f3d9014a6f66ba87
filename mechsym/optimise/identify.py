r"""Parameters of a machine out of measured speeds, with intervals that hold the truth as often as they say.

.. math:: \min_{x, \theta} \sum_i \frac{(\omega_i - u(t_i))^2}{\sigma^2}\quad\text{with the equations of motion},
          \qquad \mathrm{cov}(\theta) = s^2 (S^T S)^{-1},\quad S = \frac{d u(t_i)}{d(\theta, x_0)}

The equations hold exactly (`collocation`), the noise sits on the speeds alone. s comes from what the fit leaves over.
"""

import math
from collections.abc import Callable, Mapping
from typing import NamedTuple

import casadi as ca
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu
from scipy.stats import t as student

from mechsym.errors import BadInput
from mechsym.optimise.collocation import Intervals, grid
from mechsym.optimise.residuals import Estimate, doubts, durbin_watson, white_noise
from mechsym.optimise.trace import Trace
from mechsym.plausible import Doubt
from mechsym.quantities import record

_RANK = 1e-7  # singular value by the largest, below which a direction is not determined
_LONGEST = 0.5  # of an interval: radians of the fastest motion
_STEPS, _SETTLING = 60, 3  # steps at most, and those before the parameters may move
_STRIDE, _STILL = 0.5, 1e-8  # largest change of a parameter in one step, and that of the last one, by its size


@record
class TracedMotion:
    """The equations of a machine with parameters that are looked for."""

    #: (coordinates and velocities (2 n,), inputs (m,), parameters (k,)) -> their rates
    rate: ca.Function
    velocities: tuple[str, ...]
    inputs: tuple[str, ...]
    names: tuple[str, ...]  #: Parameters that are looked for
    units: tuple[str, ...]  #: Their SI units
    start: np.ndarray  #: shape (k,): Where the search starts [SI]
    size: np.ndarray  #: shape (k,): Their sizes [SI]
    low: np.ndarray  #: shape (k,): Least values [SI]
    known: Callable[[np.ndarray], np.ndarray]  #: Times (n,) [s] to inputs (m, n) [SI]
    breaks: tuple[float, ...] = ()  #: Times at which they jump [s]
    angle: float = 0.0  #: Of all coordinates at the first sample [rad]


@record
class Identified:
    """What a trace tells."""

    status: str  #: `found` or `not converged`
    reason: str
    estimates: tuple[Estimate, ...]
    correlation: np.ndarray  #: shape (k, k), in the order of the estimates [-]
    noise: float  #: Standard deviation of what the fit leaves over [rad/s]
    durbin_watson: float  #: 2 where the rest is white noise [-]
    samples: int
    intervals: int
    t: np.ndarray  #: shape (n,) [s]
    measured: Mapping[str, np.ndarray]  #: Velocities, each of shape (n,) [rad/s]
    fitted: Mapping[str, np.ndarray]  #: The same of the model [rad/s]
    doubts: tuple[Doubt, ...]


class _Fit(NamedTuple):
    """A fit: states at all points, parameters, what is left over."""

    states: np.ndarray
    theta: np.ndarray
    rest: np.ndarray  # measured less model, shape (speeds, samples)
    status: str


def identify(model: TracedMotion, trace: Trace) -> Identified:
    """Find the parameters of a machine in a trace.

    Raises
    ------
    BadInput
        The trace is too short for them, or does not determine one of them
    """
    count, unknown = sum(map(len, trace.speeds.values())), len(model.names) + 2 * len(model.velocities)
    if count < 10 * unknown:
        raise BadInput(f"{trace.file}: {count} samples for {unknown} unknowns; give ten times as many, or free fewer")
    points = grid(trace.t, model.breaks, _longest(model, trace))
    fits = [_solve(model, trace, points, model.angle)]
    if not white_noise(fits[0].rest, trace):  # the dead centre may lie elsewhere
        fits += [_solve(model, trace, points, model.angle + k * math.pi / 2) for k in (1, 2, 3)]
    best = min(fits, key=lambda fit: float(np.sum(fit.rest**2)))
    return _result(model, trace, points, best)


def _longest(model: TracedMotion, trace: Trace) -> float:
    """Length of an interval that follows the fastest motion: turning, or swinging of an elastic shaft [s]."""
    n = len(model.velocities)
    x = ca.SX.sym("x", 2 * n)
    slope = ca.jacobian(model.rate(x, model.known(trace.t[:1])[:, 0], model.start), x)
    rates = np.linalg.eigvals(np.asarray(ca.Function("slope", [x], [slope])(ca.DM([model.angle] * n + [0.0] * n))))
    turning = 2 * max(float(np.abs(v).max()) for v in trace.speeds.values())
    return _LONGEST / max(float(np.abs(rates).max()), turning, 1e-9)


def _guess(model: TracedMotion, trace: Trace, points: Intervals, angle: float) -> np.ndarray:
    """States at all points of the intervals: measured speeds, the others like the first, and their integrals."""
    h = np.diff(points.edges)
    times = np.sort(np.append(points.nodes, points.edges[:-1]))
    assert len(times) == len(h) * (len(points.nodes) // len(h) + 1)
    first = next(iter(trace.speeds.values()))
    speeds = np.array([np.interp(times, trace.t, trace.speeds.get(name, first)) for name in model.velocities])
    along = np.concatenate([[0.0], np.cumsum(np.diff(times) * (speeds[0, 1:] + speeds[0, :-1]) / 2)])
    return np.vstack([np.tile(angle + along, (len(model.velocities), 1)), speeds])


class _Linear(NamedTuple):
    """The equations about states and parameters: what they leave over, and how all states follow the free values."""

    misses: np.ndarray
    shift: np.ndarray  # of the speeds at the samples that removes the misses
    slopes: np.ndarray  # of the speeds at the samples over parameters, by their sizes, and start
    move: np.ndarray  # of all states that removes the misses
    follow: np.ndarray  # of all states over parameters, by their sizes, and start


def _linear(model: TracedMotion, trace: Trace, points: Intervals, states: np.ndarray, theta: np.ndarray) -> _Linear:
    n, k = states.shape[0], len(model.names)
    rates, by_state, by_theta = _slopes(model, points, states, theta)
    h = points.lengths
    misses = np.concatenate([
        (states @ points.slopes - rates * h).ravel("F"), (states @ points.gaps).ravel("F")
    ])  # fmt: skip
    count = len(h)
    blocks = sp.bsr_matrix((by_state * h[:, None, None], np.arange(count), np.arange(count + 1)))
    each = sp.identity(n)
    inside = sp.kron(points.slopes.T, each) - blocks @ sp.kron(points.inner.T, each)
    whole = sp.csc_matrix(sp.vstack([inside, sp.kron(points.gaps.T, each)]))
    free = np.zeros((whole.shape[0], k + n))
    free[: count * n, :k] = (-by_theta * h[:, None, None] * model.size).reshape(-1, k)
    free[:, k:] = whole[:, :n].toarray()
    # the first state is free; all the others follow from it and from the parameters
    solved = -splu(sp.csc_matrix(whole[:, n:])).solve(np.column_stack([misses, free]))
    all_states = np.vstack([np.zeros((n, k + n + 1)), solved])
    all_states[:n, k + 1 :] = np.eye(n)
    seen = np.vstack([
        np.asarray(points.samples.T @ all_states[row::n])
        for row in (n // 2 + model.velocities.index(name) for name in trace.speeds)
    ])  # fmt: skip
    return _Linear(misses, seen[:, 0], seen[:, 1:], all_states[:, 0], all_states[:, 1:])


def _slopes(model: TracedMotion, points: Intervals, states: np.ndarray, theta: np.ndarray) -> tuple[np.ndarray, ...]:
    """Rates at the nodes (n, N), and their slopes over states (N, n, n) and parameters (N, n, k)."""
    n, count, k = states.shape[0], len(points.nodes), len(model.names)
    x, w, z = ca.SX.sym("x", n), ca.SX.sym("w", len(model.inputs)), ca.SX.sym("z", k)
    rate = model.rate(x, w, z)
    both = ca.Function("slopes", [x, w, z], [rate, ca.jacobian(rate, x), ca.jacobian(rate, z)])
    found = both(states @ points.inner, model.known(points.nodes), np.tile(theta[:, None], (1, count)))
    rates, by_state, by_theta = (np.asarray(v) for v in found)
    return (
        rates,
        by_state.reshape(n, count, n).transpose(1, 0, 2),
        by_theta.reshape(n, count, k).transpose(1, 0, 2),
    )


def _rest(model: TracedMotion, trace: Trace, points: Intervals, states: np.ndarray) -> np.ndarray:
    """Measured speeds less those of the states, shape (speeds, samples)."""
    rows = [len(model.velocities) + model.velocities.index(name) for name in trace.speeds]
    return np.asarray(np.array(list(trace.speeds.values())) - states[rows] @ points.samples)


def _solve(model: TracedMotion, trace: Trace, points: Intervals, angle: float) -> _Fit:
    """Gauss and Newton's steps with the equations linearised, which hold only at the end."""
    states, theta = _guess(model, trace, points, angle), model.start.copy()
    k, status = len(theta), f"no steady values after {_STEPS} steps"
    scale = max(float(np.abs(v).max()) for v in trace.speeds.values())
    for turn in range(_STEPS):
        here = _linear(model, trace, points, states, theta)
        if turn < _SETTLING:  # a motion that goes with the values at the start, before they are let loose
            here = here._replace(slopes=np.hstack([np.zeros_like(here.slopes[:, :k]), here.slopes[:, k:]]))
        rest = _rest(model, trace, points, states).ravel() - here.shift
        width = np.linalg.norm(here.slopes, axis=0)
        width[width == 0] = 1.0
        step = np.linalg.lstsq(here.slopes / width, rest, rcond=_RANK)[0] / width
        # what starts at nothing has no size to go by
        longest = float(np.abs(step[:k][model.start != 0]).max(initial=0.0))
        limit = min(1.0, _STRIDE / max(longest, 1e-300))
        change = (here.move + here.follow @ step) * limit
        if not np.isfinite(change).all():
            status = "the equations of motion leave their range"
            break
        states = states + change.reshape(states.shape, order="F")
        theta = np.maximum(theta + limit * step[:k] * model.size, model.low)
        if (
            turn >= _SETTLING
            and limit == 1.0
            and np.abs(step[:k]).max() < _STILL
            and np.abs(change).max() < 1e-7 * scale
        ):
            status = "converged"
            break
    return _Fit(states, theta, _rest(model, trace, points, states), status)


def _covariance(model: TracedMotion, trace: Trace, slopes: np.ndarray) -> np.ndarray:
    """Inverse of the information of the parameters, by their sizes; refused where one of them is not determined."""
    columns = np.linalg.norm(slopes, axis=0)
    columns[columns == 0] = 1.0
    _, singular, directions = np.linalg.svd(slopes / columns, full_matrices=False)
    weak = singular < _RANK * singular[0]
    k = len(model.names)
    lost = np.abs(directions[weak][:, :k]).max(axis=0) if weak.any() else np.zeros(k)
    if (lost > 1e-3).any():
        names = ", ".join(name for name, share in zip(model.names, lost, strict=True) if share > 1e-3)
        raise BadInput(
            f"{trace.file}: the trace does not determine {names}: other values give the same speeds; free fewer, or "
            "measure a torque or another speed too"
        )
    inverse = directions[~weak].T / singular[~weak]
    return (inverse @ inverse.T / np.outer(columns, columns))[:k, :k]


def _result(model: TracedMotion, trace: Trace, points: Intervals, fit: _Fit) -> Identified:
    slopes = _linear(model, trace, points, fit.states, fit.theta).slopes
    dof = fit.rest.size - slopes.shape[1]
    noise = math.sqrt(float(np.sum(fit.rest**2)) / dof)
    covariance = noise**2 * _covariance(model, trace, slopes) * np.outer(model.size, model.size)
    errors = np.sqrt(np.diag(covariance))
    wide = float(student.ppf(0.975, dof))
    rows = zip(model.names, model.units, fit.theta.tolist(), errors.tolist(), strict=True)
    estimates = tuple(
        Estimate(name=name, unit=unit, value=value, error=error, low=value - wide * error, high=value + wide * error)
        for name, unit, value, error in rows
    )
    measured = {name: np.asarray(v) for name, v in trace.speeds.items()}
    return Identified(
        status="found" if fit.status == "converged" else "not converged", reason=fit.status, estimates=estimates,
        correlation=covariance / np.outer(errors, errors), noise=noise, durbin_watson=durbin_watson(fit.rest),
        samples=fit.rest.size, intervals=len(points.edges) - 1, t=trace.t, measured=measured,
        fitted={name: measured[name] - rest for name, rest in zip(measured, fit.rest, strict=True)},
        doubts=doubts(fit.rest, trace, estimates, model.low),
    )  # fmt: skip
