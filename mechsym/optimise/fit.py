r"""The motion of a machine that comes closest to a trace, by Levenberg and Marquardt's steps.

.. math:: \min_{\theta, x_0} \sum_i (\omega_i - u(t_i; \theta, x_0))^2, \qquad
          (A^T A + \mu\,\mathrm{diag}(A^T A))\,\delta = A^T r, \quad A = \frac{\partial u}{\partial(\theta, x_0)}

Every motion that is compared solves the equations: after each step the states are put right for the new parameters and
start. The first steps alone go through states that do not, from the measured speeds. The motion itself is the unknowns
of one sparse system, by direct collocation with the emitted equations:

.. math:: \sum_{j=0}^{d} C_{jk}\,x_{ij} = h_i\,f(x_{ik}, w_{ik}, \theta), \qquad
          x_{i+1,0} = \sum_j D_j\,x_{ij}

On each interval the state is a polynomial of degree d through its start and d Legendre points, which solves the
equations at those points; order 2 d at the ends of the intervals.
"""

import functools
import math
from collections.abc import Callable
from typing import NamedTuple

import casadi as ca
import numpy as np
import scipy.sparse as sp

from mechsym.native.evaluate import arrays
from mechsym.optimise.trace import Trace
from mechsym.quantities import record
from mechsym.quantities.units import Array, Radian, Second

DEGREE = 5
RANK = 1e-7  # singular value by the largest, below which a direction is not determined
_APPROACH, _SETTLING, _STEPS = 20, 3, 60  # first steps, those before the parameters may move, and steps that follow
_STRIDE, _NEAR = 0.5, 1e-3  # largest change of a parameter in a first step, and that of the last one, by its size
_CORRECTIONS, _SOLVED = 12, 1e-9  # of states after a step, and their size at the end by the largest speed
_GAIN = 1e-5  # what a last step would take off the sum of squares, by the variance: three thousandths of an error
_DAMPING, _STIFFEST = 1e-4, 1e8
_SHORTER = 0.5 ** np.arange(10)  # parts of a first step that are tried


@functools.cache
def legendre() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Start and Legendre points of a unit interval [-], their slopes by columns, and what its end is made of."""
    tau = np.append(0.0, ca.collocation_points(DEGREE, "legendre"))
    slopes, end, _ = (np.asarray(m) for m in ca.collocation_coeff(tau[1:].tolist()))
    return tau, slopes, end.ravel()


class Intervals(NamedTuple):
    """Intervals, the points at which the equations hold, and the map from the states to the samples."""

    edges: np.ndarray  # shape (N + 1,) [s]
    nodes: np.ndarray  # times of the collocation points, shape (N d,) [s]
    samples: sp.csc_matrix  # states (N (d + 1),) to those at the samples

    @property
    def lengths(self) -> np.ndarray:
        """Of each interval, shape (N,) [s]."""
        return np.diff(self.edges)


def grid(t: Second[Array], breaks: tuple[Second, ...], longest: Second) -> Intervals:
    """Intervals over samples. breaks: times at which the equations change; longest: length of an interval at most."""
    inside = sorted({float(t[0]), float(t[-1]), *(b for b in breaks if t[0] < b < t[-1])})
    parts = [
        np.linspace(a, b, max(2, int(np.ceil((b - a) / longest)) + 1)) for a, b in zip(inside, inside[1:], strict=False)
    ]
    edges = np.unique(np.concatenate(parts))
    count, h = len(edges) - 1, np.diff(edges)
    tau, _, _ = legendre()
    interval = np.clip(np.searchsorted(edges, t, side="right") - 1, 0, count - 1)
    place = (t - edges[interval]) / h[interval]
    # Lagrange's polynomials; scipy's interpolator orders its nodes at random, and with them the rounding
    own = np.eye(len(tau), dtype=bool)
    basis = np.where(own, 1.0, (place[:, None] - tau)[:, None, :]).prod(axis=2)
    basis /= np.where(own, 1.0, tau[:, None] - tau).prod(axis=1)
    rows = (interval[:, None] * len(tau) + np.arange(len(tau))).ravel()
    columns = np.repeat(np.arange(len(t)), len(tau))
    return Intervals(
        edges=edges,
        nodes=(edges[:-1, None] + h[:, None] * tau[1:]).ravel(),
        samples=sp.csc_matrix((basis.ravel(), (rows, columns)), shape=(count * len(tau), len(t))),
    )


@record
class TracedMotion:
    """The equations of a machine with parameters that are looked for."""

    #: (coordinates and velocities (2 n,), inputs (m,), parameters (k,)) -> their rates
    rate: ca.Function
    velocities: tuple[str, ...]
    turning: tuple[bool, ...]  #: Whether a coordinate is an angle, and no length
    inputs: tuple[str, ...]
    names: tuple[str, ...]  #: Parameters that are looked for
    units: tuple[str, ...]  #: Their SI units
    start: np.ndarray  #: shape (k,): Where the search starts [SI]
    size: np.ndarray  #: shape (k,): Their sizes [SI]
    low: np.ndarray  #: shape (k,): Least values [SI]
    known: Callable[[np.ndarray], np.ndarray]  #: Times (n,) [s] to inputs (m, n) [SI]
    #: (states, inputs, parameters) -> kinetic energy [J] and power of all known forces [W]
    energy: ca.Function
    lossy: bool  #: Whether friction or damping is looked for
    pose: np.ndarray  #: shape (n,): Coordinates at the first sample, where the search starts [rad] or [m]
    breaks: tuple[float, ...] = ()  #: Times at which they jump [s]

    def turned(self, angle: float) -> np.ndarray:
        """The pose at the first sample with all angles further on [rad] or [m], shape (n,)."""
        return self.pose + angle * np.array(self.turning)


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
    """A trace, the equations for it, their sparse parts that stay, and the work put into them."""

    def __init__(self, model: TracedMotion, trace: Trace, points: Intervals, most: int = 10**9) -> None:
        self.model, self.trace, self.points = model, trace, points
        self.evaluations, self.most = 0, most  # of the linear system, and how many a fit may take
        n = 2 * len(model.velocities)
        x, w, z = ca.SX.sym("x", n), ca.SX.sym("w", len(model.inputs)), ca.SX.sym("z", len(model.names))
        rate = model.rate(x, w, z)[n // 2 :]
        every = ca.vertcat(rate, *(ca.vec(ca.densify(ca.jacobian(rate, of))) for of in (x, z)))
        function = ca.Function("rates", [ca.vertcat(x, w, z)], [every])
        self._rates = arrays(function) or (lambda *rows: function(np.vstack(np.broadcast_arrays(*rows))).full())
        self._known = model.known(points.nodes)
        self._rows = [n // 2 + model.velocities.index(name) for name in trace.speeds]
        self.measured = np.array(list(trace.speeds.values()))
        self.scale = max(float(np.abs(self.measured).max()), 1e-9)

    @property
    def spent(self) -> bool:
        """Whether the fit has taken all the evaluations that it may."""
        return self.evaluations >= self.most

    def rest(self, states: np.ndarray) -> np.ndarray:
        """Measured speeds less those of the states, shape (speeds, samples) [rad/s]."""
        return np.asarray(self.measured - states[self._rows] @ self.points.samples)

    def linear(self, states: np.ndarray, theta: np.ndarray) -> _Linear | None:
        """The equations about states (2 n, points) and parameters (k,) [SI]; None where a loop is open."""
        n, k, (_, _, end) = states.shape[0], len(theta), legendre()
        placed = states.reshape(n, -1, DEGREE + 1)
        self.evaluations += 1
        with np.errstate(over="ignore", invalid="ignore"):  # of a motion that runs away
            solved = self._inside(placed, theta)
            if solved is None:
                return None
            count = len(solved)
            # the first state is free; from its start an interval follows, and from its end the start of the next one
            carry = np.tensordot(end[1:], solved, axes=(0, 1))
            carry[..., k + 1 :] += end[0] * np.eye(n)
            carry[:-1, :, 0] += (placed[:, :-1] @ end - placed[:, 1:, 0]).T
            inside = solved.reshape(count, DEGREE * n, -1)
            every = np.zeros((count, (DEGREE + 1) * n, k + 1 + n))
            every[:, :n] = _chained(carry[..., k + 1 :], carry[..., : k + 1])
            every[:, n:] = inside[..., k + 1 :] @ every[:, :n]
            every[:, n:, : k + 1] += inside[..., : k + 1]
        if not np.isfinite(every).all():
            return None
        rows = every.reshape(-1, n, k + 1 + n)
        seen = np.vstack([np.asarray(self.points.samples.T @ rows[:, row]) for row in self._rows])
        follow = rows.reshape(-1, k + 1 + n)
        return _Linear(follow[:, 0], follow[:, 1:], seen[:, 0], seen[:, 1:])

    def _inside(self, placed: np.ndarray, theta: np.ndarray) -> np.ndarray | None:
        """How the points of each interval follow 1, the parameters and its start, shape (N, d, 2 n, 1 + k + 2 n)."""
        n, k, (_, slopes, _) = placed.shape[0], len(theta), legendre()
        m, h, inverse = n // 2, self.points.lengths, np.linalg.inv(slopes[1:].T)
        count = len(h)
        values = self._rates(*placed[:, :, 1:].reshape(n, -1), *self._known, *theta)
        if not (np.isfinite(placed).all() and np.isfinite(values).all()):
            return None
        # of each point: accelerations and what they follow, times the length of the interval
        values = (values.reshape(-1, count, DEGREE) * h[:, None]).transpose(1, 2, 0)
        rates, by_state, by_theta = np.split(values, [m, m + m * n], axis=-1)
        by_state = by_state.reshape(count, DEGREE, n, m).swapaxes(2, 3)
        by_theta = by_theta.reshape(count, DEGREE, k, m).swapaxes(2, 3) * self.model.size
        by_place, by_speed = by_state[..., :m], by_state[..., m:]
        # places follow from speeds, q = q(0) + h inverse u, so that a place that nothing feels is in no equation
        drift = inverse @ (placed[:m] @ slopes - placed[m:, :, 1:] * h[:, None]).transpose(1, 2, 0)
        misses = (placed[m:] @ slopes).transpose(1, 2, 0) - rates
        constant = -misses[..., None] - by_place @ drift[..., None]
        by_start = np.broadcast_to(-slopes[0][:, None, None] * np.eye(m), by_place.shape)
        right = np.concatenate([constant, by_theta, by_place, by_start], axis=-1)
        blocks = slopes[1:].T[:, None, :, None] * np.eye(m)[:, None, :] - np.einsum(
            "Nkil,kj,N->Nkijl", by_place, inverse, h
        )
        own = np.arange(DEGREE)
        blocks[:, own, :, own] -= by_speed.swapaxes(0, 1)
        flat = (count, DEGREE * m, -1)
        try:
            speeds = np.linalg.solve(blocks.reshape(flat), right.reshape(flat)).reshape(right.shape)
        except np.linalg.LinAlgError:  # one state follows from no other
            return None
        places = np.einsum("kj,N,Njic->Nkic", inverse, h, speeds)
        places[..., 0] -= drift
        places[..., k + 1 : k + 1 + m] += np.eye(m)
        return np.concatenate([places, speeds], axis=2)

    def guess(self, angle: float) -> np.ndarray:
        """States at all points: measured speeds, others of a kind like the first, their way from a pose [rad]."""
        h, points = np.diff(self.points.edges), self.points
        times = np.sort(np.append(points.nodes, points.edges[:-1]))
        assert len(times) == len(h) * (len(points.nodes) // len(h) + 1)
        return followed(self.model, self.trace, times, angle)


def _chained(turns: np.ndarray, pushes: np.ndarray) -> np.ndarray:
    """What starts of intervals are of 1, parameters and the first start, which goes on by x' = turn x + push.

    turns: shape (N, n, n); pushes: shape (N, n, m). Returns starts: shape (N, n, m + n). Stretches of as many
    intervals as there are stretches go side by side, so that numpy has few and large products to take.
    """
    (count, n, m), long = pushes.shape, math.isqrt(len(pushes) - 1) + 1
    short = -(-count // long)
    turns, pushes = (np.resize(v, (short * long, *v.shape[1:])).reshape(short, long, n, -1) for v in (turns, pushes))
    within = np.zeros((short, long + 1, n, m + n))
    within[:, 0, :, m:] = np.eye(n)
    for i in range(long):
        within[:, i + 1] = turns[:, i] @ within[:, i]
        within[:, i + 1, :, :m] += pushes[:, i]
    first = within[:, 0].copy()
    for i in range(short - 1):
        first[i + 1] = within[i, long, :, m:] @ first[i]
        first[i + 1, :, :m] += within[i, long, :, :m]
    starts = within[:, :long, :, m:] @ first[:, None]
    starts[..., :m] += within[:, :long, :, :m]
    return np.asarray(starts.reshape(-1, n, m + n)[:count])


def followed(model: TracedMotion, trace: Trace, times: np.ndarray, angle: float) -> np.ndarray:
    """States at times: measured speeds, others of a kind like the first, their way from a pose turned on [SI].

    Returns states: coordinates and velocities, shape (2 n, times).
    """
    kinds = dict(zip(model.velocities, model.turning, strict=True))
    first = {kinds[name]: values for name, values in reversed(list(trace.speeds.items()))}
    nothing = np.zeros_like(trace.t)
    like = [trace.speeds.get(name, first.get(kind, nothing)) for name, kind in kinds.items()]
    speeds = np.array([np.interp(times, trace.t, values) for values in like])
    ways = np.cumsum(np.diff(times) * (speeds[:, 1:] + speeds[:, :-1]) / 2, axis=1)
    return np.vstack([model.turned(angle)[:, None] + np.pad(ways, ((0, 0), (1, 0))), speeds])


def approach(task: TraceTask, angle: Radian) -> tuple[np.ndarray, np.ndarray] | None:
    """States and parameters near a motion: Gauss and Newton's steps whose equations hold only at the end.

    angle: how far beyond the pose of the model the first sample lies. Returns states, theta: [SI]; None where a loop is
    open on the way that the measured speeds tell.
    """
    model = task.model
    states, theta, k = task.guess(angle), model.start.copy(), len(model.start)
    here = task.linear(states, theta)
    if here is None:
        return None
    for turn in range(_APPROACH):
        slopes = here.slopes.copy()
        if turn < _SETTLING:  # a motion that goes with the values at the start, before they are let loose
            slopes[:, :k] = 0.0
        columns, width = unit_columns(slopes)
        step = np.linalg.lstsq(columns, task.rest(states).ravel() - here.shift, rcond=RANK)[0] / width
        # what starts at nothing has no size to go by
        longest = float(np.abs(step[:k][model.start != 0]).max(initial=0.0))
        limit = min(1.0, _STRIDE / max(longest, 1e-300))
        change = (here.move + here.follow @ step).reshape(states.shape, order="F")
        for part in limit * _SHORTER:  # a loop may be open a whole step ahead
            moved = states + part * change, np.maximum(theta + part * step[:k] * model.size, model.low)
            there = task.linear(*moved)
            if there is not None:
                break
        else:
            break
        (states, theta), here = moved, there
        if turn > _SETTLING and part == 1.0 and np.abs(step[:k]).max() < _NEAR:
            break
    return states, theta


def unit_columns(columns: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Columns divided by their lengths, and these; 1 in place of 0 [unit of the columns]."""
    # by powers of two first: slopes of a motion that runs away are not squared as they are
    power = np.frexp(np.abs(columns).max(axis=0, initial=0.0))[1]
    near = np.ldexp(columns, -power)
    width = np.linalg.norm(near, axis=0)
    width[width == 0] = 1.0
    return near / width, np.ldexp(width, power)


def closest(task: TraceTask, states: np.ndarray, theta: np.ndarray, held: int | None = None) -> ClosestMotion | None:
    """The motion that comes closest to the trace, from one nearby; None where there is no motion nearby.

    states: coordinates and velocities [rad, rad/s], shape (2 n, points); theta: parameters [SI], shape (k,). What
    has the number `held` among parameters and start stays.
    """
    here, damping = _motion(task, states, theta), _DAMPING
    if here is None:
        return None
    for _ in range(_STEPS):
        # numbers of the values that may move: not the held one, none that its least value holds
        k = len(task.model.start)
        downhill = here.slopes.T @ here.rest.ravel()
        stays = [i for i in range(k) if here.theta[i] <= task.model.low[i] and downhill[i] <= 0]
        free = np.setdiff1d(np.arange(here.slopes.shape[1]), stays if held is None else [*stays, held])
        columns, width = unit_columns(here.slopes[:, free])
        # what Gauss and Newton's step would take off the sum of squares, and that step
        left, singular, right = np.linalg.svd(columns, full_matrices=False)
        keep = singular > RANK * singular[0]
        along = left.T[keep] @ here.rest.ravel()
        gain, full = float(along @ along), right[keep].T @ (along / singular[keep])
        if (
            gain <= _GAIN * here.left / (here.rest.size - len(free))
            or float(np.abs(full).max(initial=0.0)) < 1e-13 * task.scale
        ):
            return here._replace(status="converged")
        if task.spent:
            return here._replace(status=f"given up after {task.evaluations} evaluations")
        trial, step = _step(task, here, free, damping, here.rest.ravel())
        if trial is not None and trial.left >= here.left:
            # a valley bends: the same step again, with what the trace misses by the bend put into its aim
            trial, _ = _step(task, here, free, damping, trial.rest.ravel() + here.slopes @ step)
        if trial is not None and trial.left < here.left:
            here, damping = trial, damping / 10
        elif damping > _STIFFEST:
            return here._replace(status="no step comes closer")
        else:
            damping *= 10
    return here._replace(status=f"no steady values after {_STEPS} steps")


def pulled(task: TraceTask, here: ClosestMotion, number: int, move: float) -> ClosestMotion | None:
    """The closest motion with a parameter or a start moved on, by its size [-] or by itself [SI]."""
    model, k = task.model, len(here.theta)
    others = np.delete(np.arange(here.slopes.shape[1]), number)
    columns, width = unit_columns(here.slopes[:, others])
    step = np.zeros(here.slopes.shape[1])
    step[number] = move
    target = here.rest.ravel() - here.slopes[:, number] * move
    step[others] = np.linalg.lstsq(columns, target, rcond=1e-7)[0] / width
    theta = np.maximum(here.theta + step[:k] * model.size, model.low)
    step[:k] = (theta - here.theta) / model.size
    states = here.states + (here.follow @ step).reshape(here.states.shape, order="F")
    motion = closest(task, states, theta, number)
    return motion if motion is not None and motion.status == "converged" else None


def _step(
    task: TraceTask, here: ClosestMotion, free: np.ndarray, damping: float, aim: np.ndarray
) -> tuple[ClosestMotion | None, np.ndarray]:
    """Where a damped step towards a change of the speeds leads, and the step."""
    model, k = task.model, len(task.model.start)
    columns, width = unit_columns(here.slopes[:, free])
    rows = np.vstack([columns, math.sqrt(damping) * np.eye(len(free))])
    target = np.append(aim, np.zeros(len(free)))
    step = np.zeros(here.slopes.shape[1])
    with np.errstate(over="ignore"):  # what hardly moves the trace would have to go without end
        step[free] = np.linalg.lstsq(rows, target, rcond=None)[0] / width
        theta = np.maximum(here.theta + step[:k] * model.size, model.low)
    if not (np.isfinite(step).all() and np.isfinite(theta).all()):
        return None, step
    step[:k] = (theta - here.theta) / model.size
    states = here.states + (here.follow @ step).reshape(here.states.shape, order="F")
    return _motion(task, states, theta), step


def _motion(task: TraceTask, states: np.ndarray, theta: np.ndarray) -> ClosestMotion | None:
    """The motion from the first of the states; None where Newton's steps do not find it."""
    for _ in range(_CORRECTIONS):
        here = task.linear(states, theta)
        if here is None:
            return None
        if float(np.abs(here.move).max()) < _SOLVED * task.scale:
            return ClosestMotion(states, theta, task.rest(states), here.slopes, here.follow)
        states = states + here.move.reshape(states.shape, order="F")
    return None
