r"""The motion of a machine that comes closest to a trace, by Levenberg and Marquardt's steps.

.. math:: \min_{\theta, x_0} \sum_i (\omega_i - u(t_i; \theta, x_0))^2, \qquad
          (A^T A + \mu\,\mathrm{diag}(A^T A))\,\delta = A^T r, \quad A = \frac{\partial u}{\partial(\theta, x_0)}

Every motion that is compared solves the equations (`collocation`): after each step the states are put right for the
new parameters and start. The first steps alone go through states that do not, from the measured speeds.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import casadi as ca
import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import splu

from mechsym.optimise.collocation import Intervals
from mechsym.optimise.trace import Trace
from mechsym.quantities import record

RANK = 1e-7  # singular value by the largest, below which a direction is not determined
_APPROACH, _SETTLING, _STEPS = 20, 3, 60  # first steps, those before the parameters may move, and steps that follow
_STRIDE, _NEAR = 0.5, 1e-3  # largest change of a parameter in a first step, and that of the last one, by its size
_CORRECTIONS, _SOLVED = 12, 1e-9  # of states after a step, and their size at the end by the largest speed
_GAIN = 1e-5  # what a last step would take off the sum of squares, by the variance: three thousandths of an error
_DAMPING, _STIFFEST = 1e-4, 1e8


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


class ClosestMotion(NamedTuple):
    """A motion: states at all points, parameters, what is left over, and how that follows them and the start."""

    states: np.ndarray
    theta: np.ndarray
    rest: np.ndarray  # measured less model, shape (speeds, samples)
    slopes: np.ndarray  # of the speeds at the samples over parameters, by their sizes, and start
    follow: np.ndarray  # of all states over the same
    status: str = ""

    @property
    def left(self) -> float:
        """Sum of the squares of what is left over [rad^2/s^2]."""
        return float(np.sum(self.rest**2))


class _Linear(NamedTuple):
    """The equations about states and parameters: how all states follow the free values, and what puts them right."""

    move: np.ndarray
    follow: np.ndarray
    shift: np.ndarray  # both for the speeds at the samples
    slopes: np.ndarray


class TraceTask:
    """A trace, the equations for it, and their sparse parts that stay."""

    def __init__(self, model: TracedMotion, trace: Trace, points: Intervals) -> None:
        self.model, self.trace, self.points = model, trace, points
        n, each = 2 * len(model.velocities), sp.identity(2 * len(model.velocities))
        x, w, z = ca.SX.sym("x", n), ca.SX.sym("w", len(model.inputs)), ca.SX.sym("z", len(model.names))
        rate = model.rate(x, w, z)
        self._rates = ca.Function("rates", [x, w, z], [rate, ca.jacobian(rate, x), ca.jacobian(rate, z)])
        self._known = model.known(points.nodes)
        self._slopes, self._inner, self._gaps = (sp.csr_matrix(sp.kron(m.T, each))
                                                 for m in (points.slopes, points.inner, points.gaps))  # fmt: skip
        self._rows = [n // 2 + model.velocities.index(name) for name in trace.speeds]
        self.measured = np.array(list(trace.speeds.values()))
        self.scale = max(float(np.abs(self.measured).max()), 1e-9)

    def rest(self, states: np.ndarray) -> np.ndarray:
        """Measured speeds less those of the states, shape (speeds, samples) [rad/s]."""
        return np.asarray(self.measured - states[self._rows] @ self.points.samples)

    def linear(self, states: np.ndarray, theta: np.ndarray) -> _Linear:
        """The equations about states (2 n, points) and parameters (k,) [SI]."""
        n, k, count = states.shape[0], len(theta), len(self.points.nodes)
        found = self._rates(states @ self.points.inner, self._known, np.tile(theta[:, None], (1, count)))
        rates, by_state, by_theta = (np.asarray(v) for v in found)
        h = self.points.lengths
        misses = np.concatenate([
            (states @ self.points.slopes - rates * h).ravel("F"), (states @ self.points.gaps).ravel("F")
        ])  # fmt: skip
        by_state = by_state.reshape(n, count, n).transpose(1, 0, 2) * h[:, None, None]
        blocks = sp.bsr_matrix((by_state, np.arange(count), np.arange(count + 1)))
        whole = sp.csc_matrix(sp.vstack([self._slopes - blocks @ self._inner, self._gaps]))
        free = np.zeros((whole.shape[0], k + n))
        by_theta = by_theta.reshape(n, count, k).transpose(1, 0, 2)
        free[: count * n, :k] = (-by_theta * h[:, None, None] * self.model.size).reshape(-1, k)
        free[:, k:] = whole[:, :n].toarray()
        # the first state is free; all the others follow from it and from the parameters
        solved = -splu(sp.csc_matrix(whole[:, n:])).solve(np.column_stack([misses, free]))
        every = np.vstack([np.zeros((n, k + n + 1)), solved])
        every[:n, k + 1 :] = np.eye(n)
        seen = np.vstack([np.asarray(self.points.samples.T @ every[row::n]) for row in self._rows])
        return _Linear(every[:, 0], every[:, 1:], seen[:, 0], seen[:, 1:])

    def guess(self, angle: float) -> np.ndarray:
        """States at all points: measured speeds, the others like the first, and their integrals from an angle [rad]."""
        h, trace = np.diff(self.points.edges), self.trace
        times = np.sort(np.append(self.points.nodes, self.points.edges[:-1]))
        assert len(times) == len(h) * (len(self.points.nodes) // len(h) + 1)
        first, names = next(iter(trace.speeds.values())), self.model.velocities
        speeds = np.array([np.interp(times, trace.t, trace.speeds.get(name, first)) for name in names])
        along = np.concatenate([[0.0], np.cumsum(np.diff(times) * (speeds[0, 1:] + speeds[0, :-1]) / 2)])
        return np.vstack([np.tile(angle + along, (len(names), 1)), speeds])


def approach(task: TraceTask, angle: float) -> tuple[np.ndarray, np.ndarray]:
    """States and parameters near a motion: Gauss and Newton's steps whose equations hold only at the end.

    Parameters
    ----------
    angle : float
        Of all coordinates at the first sample [rad]
    """
    model = task.model
    states, theta, k = task.guess(angle), model.start.copy(), len(model.start)
    for turn in range(_APPROACH):
        here = task.linear(states, theta)
        slopes = here.slopes.copy()
        if turn < _SETTLING:  # a motion that goes with the values at the start, before they are let loose
            slopes[:, :k] = 0.0
        width = np.linalg.norm(slopes, axis=0)
        width[width == 0] = 1.0
        step = np.linalg.lstsq(slopes / width, task.rest(states).ravel() - here.shift, rcond=RANK)[0] / width
        # what starts at nothing has no size to go by
        longest = float(np.abs(step[:k][model.start != 0]).max(initial=0.0))
        limit = min(1.0, _STRIDE / max(longest, 1e-300))
        change = (here.move + here.follow @ step) * limit
        if not np.isfinite(change).all():
            break
        states = states + change.reshape(states.shape, order="F")
        theta = np.maximum(theta + limit * step[:k] * model.size, model.low)
        if turn > _SETTLING and limit == 1.0 and np.abs(step[:k]).max() < _NEAR:
            break
    return states, theta


def closest(task: TraceTask, states: np.ndarray, theta: np.ndarray, held: int | None = None) -> ClosestMotion:
    """The motion that comes closest to the trace, from one nearby.

    Parameters
    ----------
    states : ndarray, shape (2 n, points)
        Coordinates and velocities [rad, rad/s]
    theta : ndarray, shape (k,)
        Parameters, the one of number `held` stays [SI]
    """
    here, damping = _motion(task, states, theta), _DAMPING
    if here is None:
        return ClosestMotion(
            states, theta, task.rest(states), np.zeros((0, 0)), np.zeros((0, 0)), "no motion follows the trace"
        )
    for _ in range(_STEPS):
        free = _free(task.model, here, held)
        columns = here.slopes[:, free]
        width = np.linalg.norm(columns, axis=0)
        width[width == 0] = 1.0
        gain, full = _gain(columns / width, here.rest.ravel())
        if (
            gain <= _GAIN * here.left / (here.rest.size - len(free))
            or float(np.abs(full).max(initial=0.0)) < 1e-13 * task.scale
        ):
            return here._replace(status="converged")
        trial = _step(task, here, free, width, damping)
        if trial is not None and trial.left < here.left:
            here, damping = trial, damping / 10
        elif damping > _STIFFEST:
            return here._replace(status="no step comes closer")
        else:
            damping *= 10
    return here._replace(status=f"no steady values after {_STEPS} steps")


def _gain(columns: np.ndarray, rest: np.ndarray) -> tuple[float, np.ndarray]:
    """What Gauss and Newton's step would take off the sum of squares, and that step."""
    left, singular, right = np.linalg.svd(columns, full_matrices=False)
    keep = singular > RANK * singular[0]
    along = left.T[keep] @ rest
    return float(along @ along), right[keep].T @ (along / singular[keep])


def _free(model: TracedMotion, here: ClosestMotion, held: int | None) -> np.ndarray:
    """Numbers of the values that may move: not the held one, none that its least value holds."""
    k = len(model.start)
    downhill = here.slopes.T @ here.rest.ravel()
    stays = [i for i in range(k) if i == held or (here.theta[i] <= model.low[i] and downhill[i] <= 0)]
    return np.setdiff1d(np.arange(here.slopes.shape[1]), stays)


def _step(
    task: TraceTask, here: ClosestMotion, free: np.ndarray, width: np.ndarray, damping: float
) -> ClosestMotion | None:
    model, k = task.model, len(task.model.start)
    rows = np.vstack([here.slopes[:, free] / width, math.sqrt(damping) * np.eye(len(free))])
    target = np.append(here.rest.ravel(), np.zeros(len(free)))
    step = np.zeros(here.slopes.shape[1])
    step[free] = np.linalg.lstsq(rows, target, rcond=None)[0] / width
    theta = np.maximum(here.theta + step[:k] * model.size, model.low)
    step[:k] = (theta - here.theta) / model.size
    states = here.states + (here.follow @ step).reshape(here.states.shape, order="F")
    return _motion(task, states, theta)


def _motion(task: TraceTask, states: np.ndarray, theta: np.ndarray) -> ClosestMotion | None:
    """The motion from the first of the states; None where Newton's steps do not find it."""
    for _ in range(_CORRECTIONS):
        with np.errstate(all="ignore"):
            here: Any = task.linear(states, theta) if np.isfinite(states).all() else None
        if here is None or not np.isfinite(here.follow).all():
            return None
        if float(np.abs(here.move).max()) < _SOLVED * task.scale:
            return ClosestMotion(states, theta, task.rest(states), here.slopes, here.follow)
        states = states + here.move.reshape(states.shape, order="F")
    return None
