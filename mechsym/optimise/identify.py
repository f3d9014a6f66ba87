r"""Parameters of a machine out of measured speeds, with intervals that hold the truth as often as they say.

.. math:: \min_{x, \theta} \sum_i \frac{(\omega_i - u(t_i))^2}{\sigma^2}\quad\text{with the equations of motion},
          \qquad \mathrm{cov}(\theta) = s^2 (S^T S)^{-1},\quad S = \frac{d u(t_i)}{d(\theta, x_0)}

The equations hold exactly (`collocation`), the noise sits on the speeds alone. s comes from what the fit leaves over.
The standard errors are those of a straight model; the intervals are not, they go by profiles: how far a parameter may
go while all the others do their best to follow.

.. math:: S(\theta_i) = \min_{\theta_{j \ne i}, x_0} \sum_i r_i^2 \le S_{\min}\,(1 + t^2/\nu)

Where the model is linear in its parameters this is the usual +- t standard errors. Where it is not, it still is how
far the trace lets go; an end that is never reached is open.
"""

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated

import casadi as ca
import numpy as np
from scipy.special import stdtrit

from mechsym import budget
from mechsym.errors import BadInput
from mechsym.optimise.fit import (
    DEGREE,
    RANK,
    ClosestMotion,
    TracedMotion,
    TraceTask,
    approach,
    closest,
    grid,
    pulled,
    unit_columns,
)
from mechsym.optimise.preview import require_plausible
from mechsym.optimise.trace import Trace
from mechsym.plausible import Doubt
from mechsym.quantities.results import part, quantity, result
from mechsym.quantities.units import Array, RadPerSecond

_DURBIN = 3.0  # standard errors by which the statistic of white noise may miss 2
_EXACT = 1e-6  # of the speed, below which what is left over is rounding
_OUTLIER = 6.0  # standard deviations
_LOOSE, _T95 = 0.5, 2.0  # standard error by the value, beyond which a parameter is hardly known; interval by it


@result
class Estimate:
    """One parameter."""

    name: str
    value: float = quantity("@unit")  #: Where the fit is closest
    error: float = quantity("@unit")  #: Standard error
    low: float = quantity("@unit")  #: Least of the 95 % interval, infinite where the trace sets no end
    high: float = quantity("@unit")  #: Largest of the 95 % interval, infinite where the trace sets no end
    unit: str = part()


def durbin_watson(rest: np.ndarray) -> float:
    """Statistic of Durbin and Watson of residuals [rad/s], 2 where they are white noise."""
    return float(np.sum(np.diff(rest, axis=1) ** 2) / max(np.sum(rest**2), 1e-300))


def white_noise(rest: RadPerSecond[Array], trace: Trace) -> bool:
    """Whether what is left over may be white noise; its Durbin-Watson statistic is 2 with the error 2/sqrt(n).

    rest: measured less fitted speeds, shape (speeds, samples).
    """
    band = _DURBIN * 2 / math.sqrt(rest.size)
    return rounding(rest, trace) or abs(durbin_watson(rest) - 2) < band


def rounding(rest: np.ndarray, trace: Trace) -> bool:
    """Whether what is left over is rounding and no noise; `rest` as in `white_noise` [rad/s]."""
    return float(np.std(rest)) < _EXACT * max(float(np.abs(v).max()) for v in trace.speeds.values())


def doubts(
    rest: RadPerSecond[Array],
    trace: Trace,
    estimates: tuple[Estimate, ...],
    least: np.ndarray,
    ways: int,
    spent: int = 0,
) -> tuple[Doubt, ...]:
    """What of a fit looks wrong: residuals that are no noise, outliers, parameters hardly known or impossible.

    rest: measured less fitted speeds, shape (speeds, samples); least: least values of the parameters [SI], shape (k,);
    ways: how many motions explain the trace, each with its own place of the dead centre; spent: evaluations after which
    the fit was given up, 0 where it came to its end.
    """
    white, worst = durbin_watson(rest), float(np.abs(rest).max()) / max(float(np.std(rest)), 1e-300)
    band, raised = _DURBIN * 2 / math.sqrt(rest.size), []
    if not white_noise(rest, trace):
        why = "what is left over is no noise: the model misses something, and the intervals are too narrow"
        usual = f"{2 - band:.2f} to {2 + band:.2f}"
        raised.append(Doubt(code="residuals", quantity="durbin_watson", value=white, usual=usual, why=why))
    if worst > _OUTLIER and not rounding(rest, trace):
        why = "samples lie far off; look for bad readings, they pull the parameters"
        raised.append(Doubt(code="outlier", quantity="residual / noise", value=worst, usual="at most 6", why=why))
    if spent:
        why = "the fit was given up: ends that it has not reached are left open; --budget '1 h' lets it go on"
        raised.append(Doubt(code="work", quantity="evaluations", value=float(spent), usual="a fit that ends", why=why))
    if ways > 1:
        why = "the trace does not tell where the dead centre lies: the intervals hold the values of each place"
        raised.append(Doubt(code="ambiguous", quantity="motions", value=float(ways), usual="1", why=why))
    one_by_one = (_of_estimate(e, low) for e, low in zip(estimates, least.tolist(), strict=True))
    # an end that was given up says nothing of the trace
    return (*raised, *(d for d in one_by_one if d is not None and not (spent and d.code == "open")))


def _of_estimate(e: Estimate, least: float) -> Doubt | None:
    if e.value <= least + 1e-6 * e.error:
        why = f"{e.name} ends at its least value: the model asks for an impossible one"
        return Doubt(code="bound", quantity=e.name, value=e.value, usual=f"above {least:g}", why=why)
    if not math.isfinite(e.high - e.low) or e.low <= least:
        side = "above" if math.isinf(e.high) else "below"
        return Doubt(code="open", quantity=e.name, value=e.value, usual="an interval with two ends",
                     why=f"the trace sets {e.name} no end {side}: free fewer, or measure longer")  # fmt: skip
    if e.high - e.low > 2 * _LOOSE * _T95 * abs(e.value):
        return Doubt(
            code="loose",
            quantity=e.name,
            value=(e.high - e.low) / max(abs(e.value), 1e-300),
            usual="an interval below twice the value",
            why=f"{e.name} is hardly determined by this trace",
        )
    if e.name.startswith("friction") and e.high < 0:
        why = f"{e.name} would drive the shaft: a torque is missing among what is known"
        return Doubt(code="drives", quantity=e.name, value=e.value, usual="above 0", why=why)
    return None


_LONGEST = 0.5  # of an interval: radians of the fastest motion
_STARTS = 4  # angles that are tried
# time for each number of the linear system from each start [s], and how many times it is held: measured, 1e3 to 1e5
# intervals of one and two coordinates
_PER_NUMBER, _COPIES = 1e-5, 20
# numbers of the linear system that a fit may take within the usual budget (measured: 15 s), evaluations from each start
# that it may take however large it is, and the share of the starts: the ends of the intervals have the rest
_NUMBERS, _EACH_START, _FOR_STARTS = 4e7, 50, 0.6
_SAME, _BESIDE = 0.1, 0.2  # standard errors and radians of the first angle within which two fits are one


@result
class Identified:
    """What a trace tells."""

    status: str = part()  #: `found` or `not converged`
    reason: str = part()
    parameters: Mapping[str, Estimate] = part()
    correlation: np.ndarray = quantity("-")  #: Of two parameters, shape (k, k)
    noise: float = quantity("@unit")  #: Standard deviation of what the fit leaves over
    durbin_watson: float = quantity("-")  #: 2 where the rest is white noise
    samples: int = quantity("-")  #: Measured speeds
    intervals: int = quantity("-")  #: Of the collocation
    doubts: tuple[Doubt, ...] = part()
    unit: str  # of the measured speeds
    t: np.ndarray  #: shape (n,) [s]
    measured: Mapping[str, np.ndarray]  #: velocities, each of shape (n,) [unit]
    fitted: Mapping[str, np.ndarray]  #: The same of the model [unit]

    @property
    def estimates(self) -> tuple[Estimate, ...]:
        """The parameters, in the order in which they were asked for."""
        return tuple(self.parameters.values())


def identify(model: TracedMotion, trace: Trace) -> Identified:
    """Find the parameters of a machine in a trace.

    Raises BadInput: the trace is too short for them, or does not determine one of them.
    """
    # whether the equations of motion hold each coordinate: where a rotor starts, its speed does not know
    held = _columns_in(model, 0)
    seen = [k in held for k in range(len(model.velocities))]
    count = sum(map(len, trace.speeds.values()))
    unknown = len(model.names) + len(model.velocities) + sum(seen)
    if count < 10 * unknown:
        raise BadInput(f"{trace.file}: {count} samples for {unknown} unknowns; give ten times as many, or free fewer")
    _require_seen(model, trace)
    # speeds do not tell where the dead centre lies: a search from each quarter, unless no speed depends on it
    angular = any(turns and in_it for turns, in_it in zip(model.turning, seen, strict=True))
    angles = [k * 2 * math.pi / _STARTS for k in range(_STARTS if angular else 1)]
    longest = _longest(model, trace, angles)
    require_plausible(model, trace, angles, longest)
    # how often a fit may solve its linear system; refused where it takes longer or more memory than its budget
    starts = len(angles)
    intervals, states = (float(trace.t[-1] - trace.t[0]) / longest, 2 * len(model.velocities))
    columns = len(model.names) + states + 1
    numbers = intervals * (DEGREE + 1) * states * columns
    seconds, size = _PER_NUMBER * numbers * starts, 8 * _COPIES * numbers
    what = f"{trace.file}: a fit over about {intervals:.3g} intervals"
    budget.require(what, seconds, size, "give a shorter stretch of the trace")
    most = round(max(_NUMBERS / numbers, _EACH_START * starts) * budget.allowed().seconds / budget.Budget().seconds)
    task = TraceTask(model, trace, grid(trace.t, model.breaks, longest), round(_FOR_STARTS * most))
    near = [place for angle in angles if (place := approach(task, angle)) is not None]
    fits = sorted((fit for place in near if (fit := closest(task, *place)) is not None), key=lambda fit: fit.left)
    if not fits:
        why = "no motion follows the trace" if near else "a loop is open on the way that the trace tells"
        way_out = "give simulation.phi_start or [start] the pose of its first sample"
        raise BadInput(
            f"{trace.file}: {why} from {_pose(model)} or a quarter turn on; {way_out}, and see whether [drive], units "
            "and the values of the case fit it"
        )
    walked = [len(model.names) + i for i, turns in enumerate(seen) if turns]
    fits = sorted([*fits, *(fit for i in walked for fit in _behind(task, fits[0], i))], key=lambda fit: fit.left)
    task.most = most
    return _result(task, fits)


# a start's walk: first step in standard errors, each by the last, the widest, how many, and how high it climbs [reach]
_FIRST, _GROWS, _WIDEST, _MOST, _RIDGE = 2.0, 1.3, 0.25, 24, 30.0


def _behind(task: TraceTask, best: ClosestMotion, number: int) -> Iterator[ClosestMotion]:
    """Fits behind ridges: a start walks both ways from the best one, all else follows, until nothing explains it."""
    variance = best.left / best.rest.size
    error = math.sqrt(float(np.linalg.pinv(best.slopes.T @ best.slopes)[number, number]) * variance)
    reach = _T95**2 * variance
    for side in (1, -1):
        here, inside = best, True
        for k in range(_MOST):
            step = min(_FIRST * error * _GROWS**k, _WIDEST)
            there = None if task.spent else pulled(task, here, number, side * step)
            if there is None or there.left - best.left > _RIDGE * reach:
                break
            here, was_inside, inside = there, inside, there.left - best.left < reach
            if inside and not was_inside and (fit := closest(task, here.states, here.theta)) is not None:
                yield fit


def _pose(model: TracedMotion) -> str:
    names = (name.removesuffix("d") for name in model.velocities)
    return ", ".join(f"{name} = {value:.4g}" for name, value in zip(names, model.pose, strict=True))


def _columns_in(model: TracedMotion, number: int) -> set[int]:
    """Which entries of the input of a number the rates of a motion hold."""
    inputs = [ca.SX.sym(name, *shape) for name, shape in zip("xwz", map(model.rate.size_in, range(3)), strict=True)]
    return set(ca.jacobian(model.rate(*inputs), inputs[number]).sparsity().get_col())


def _require_seen(model: TracedMotion, trace: Trace) -> None:
    """Refuse parameters that are in no equation of motion."""
    held = _columns_in(model, 2)
    unseen = [name for i, name in enumerate(model.names) if i not in held]
    if unseen:
        why = f"no motion shows {', '.join(unseen)}: the equations of motion do not hold it"
        raise BadInput(f"{trace.file}: {why}; leave it out of --free")


def _longest(model: TracedMotion, trace: Trace, angles: list[float]) -> float:
    """Length of an interval that follows the fastest motion: turning, or swinging of an elastic shaft [s]."""
    n = len(model.velocities)
    x = ca.SX.sym("x", 2 * n)
    slope = ca.Function("slope", [x], [ca.jacobian(model.rate(x, model.known(trace.t[:1])[:, 0], model.start), x)])
    slopes = (np.asarray(slope(np.append(model.turned(angle), np.zeros(n)))) for angle in angles)
    closed = next((matrix for matrix in slopes if np.isfinite(matrix).all()), None)
    if closed is None:
        why = f"a loop is open at {_pose(model)}, where the search starts, and at each quarter turn on"
        raise BadInput(f"{trace.file}: {why}; give simulation.phi_start or [start] a pose in which it closes")
    angular = [name for name, turns in zip(model.velocities, model.turning, strict=True) if turns]
    turning = 2 * max((float(np.abs(v).max()) for name, v in trace.speeds.items() if name in angular), default=0.0)
    return _LONGEST / max(float(np.abs(np.linalg.eigvals(closed)).max()), turning, 1e-9)


def _covariance(model: TracedMotion, trace: Trace, slopes: np.ndarray) -> tuple[np.ndarray, int]:
    """Inverse of the information of the parameters, by their sizes, and how many unknowns the trace has settled.

    Refused where a parameter is not determined; a start that no speed shows is no unknown.
    """
    columns, width = unit_columns(slopes)
    _, singular, directions = np.linalg.svd(columns, full_matrices=False)
    weak = singular < RANK * singular[0]
    k = len(model.names)
    lost = np.abs(directions[weak][:, :k]).max(axis=0) if weak.any() else np.zeros(k)
    if (lost > 1e-3).any():
        names = ", ".join(name for name, share in zip(model.names, lost, strict=True) if share > 1e-3)
        raise BadInput(
            f"{trace.file}: the trace does not determine {names}: other values give the same speeds; free fewer, or "
            "measure a torque or another speed too"
        )
    inverse = directions[~weak].T / singular[~weak]
    return (inverse @ inverse.T / np.outer(width, width))[:k, :k], int(np.count_nonzero(~weak))


def _result(task: TraceTask, fits: list[ClosestMotion]) -> Identified:
    model, trace, best = task.model, task.trace, fits[0]
    inverse, settled = _covariance(model, trace, best.slopes)
    dof = best.rest.size - settled
    noise = math.sqrt(best.left / dof)
    covariance = noise**2 * inverse * np.outer(model.size, model.size)
    errors, wide = np.sqrt(np.diag(covariance)), float(stdtrit(dof, 0.975))
    alike = _alike(fits, noise * wide, errors)
    ends = [(v - wide * e, v + wide * e) for v, e in zip(best.theta.tolist(), errors.tolist(), strict=True)]
    if not rounding(best.rest, trace):  # else nothing grows but rounding
        ends = [profile(task, alike, i, wide * error, (noise * wide) ** 2) for i, error in enumerate(errors.tolist())]
    rows = zip(model.names, model.units, best.theta.tolist(), errors.tolist(), ends, strict=True)
    estimates = tuple(
        Estimate(name=name, unit=unit, value=value, error=error, low=low, high=high)
        for name, unit, value, error, (low, high) in rows
    )
    measured = {name: np.asarray(v) for name, v in trace.speeds.items()}
    return Identified(
        status="found" if best.status == "converged" else "not converged", reason=best.status,
        parameters={one.name: one for one in estimates},
        correlation=covariance / np.outer(errors, errors), noise=noise,
        unit=trace.unit, durbin_watson=durbin_watson(best.rest),
        samples=best.rest.size, intervals=len(task.points.edges) - 1, t=trace.t, measured=measured,
        fitted={name: measured[name] - rest for name, rest in zip(measured, best.rest, strict=True)},
        doubts=doubts(best.rest, trace, estimates, model.low, len(alike), task.evaluations if task.spent else 0),
    )  # fmt: skip


def _alike(fits: list[ClosestMotion], reach: float, errors: np.ndarray) -> list[ClosestMotion]:
    """The best fit and those that the trace does not tell from it, each once."""
    alike = fits[:1]
    for fit in fits[1:]:
        near = fit.status == "converged" and fit.left - fits[0].left < reach**2
        if near and not any(_one(fit, other, errors) for other in alike):
            alike.append(fit)
    return alike


def _one(a: ClosestMotion, b: ClosestMotion, errors: np.ndarray) -> bool:
    turned = abs(math.remainder(float(a.states[0, 0] - b.states[0, 0]), 2 * math.pi))
    return turned < _BESIDE or bool((np.abs(a.theta - b.theta) < _SAME * errors).all())


_TRIALS, _CLOSE, _LEAP = 10, 0.02, 3.0  # trials at an end, how close they come, largest leap by the last distance


def profile(
    task: TraceTask, fits: Sequence[ClosestMotion], number: int, far: float, reach: Annotated[float, "rad^2/s^2"]
) -> tuple[float, float]:
    """Ends of the interval of the parameter of a number.

    fits: the best motion first, then others that the trace does not tell from it; far: where the ends would be if the
    model were straight, from the best value [SI]; reach: what the sum of squares may grow by. Returns low, high: over
    all fits; infinite where the trace sets no end, the least value where the model has none below [SI].
    """
    least = fits[0].left
    low = min(fit.theta[number] - _distance(task, fit, number, -far, least, reach) for fit in fits)
    return float(low), float(max(fit.theta[number] + _distance(task, fit, number, far, least, reach) for fit in fits))


def _distance(task: TraceTask, fit: ClosestMotion, number: int, far: float, least: float, reach: float) -> float:
    """How far the parameter may go to one side, by the secant's rule: the root of the growth is nearly straight."""
    wide = math.sqrt(reach)
    room = math.inf if far > 0 else float(fit.theta[number] - task.model.low[number])
    # a second motion starts from what it misses already
    inner, outer, here = (0.0, math.sqrt(max(fit.left - least, 0.0))), (math.inf, math.inf), fit
    distance = min(abs(far), room)
    for _ in range(_TRIALS):
        if task.spent:  # a trial that was not finished bounds nothing
            return outer[0] if math.isfinite(outer[1]) else math.inf
        target = float(fit.theta[number]) + math.copysign(distance, far)
        there = pulled(task, here, number, (target - float(here.theta[number])) / task.model.size[number])
        growth = math.inf if there is None else math.sqrt(max(there.left - least, 0.0))
        if abs(growth - wide) < _CLOSE * wide or (growth < wide and distance >= room):
            return distance
        if there is not None and growth < wide:
            ahead = (wide - growth) * (distance - inner[0]) / max(growth - inner[1], 1e-300)
            inner, here = (distance, growth), there
            distance = min(distance + min(1.1 * ahead, _LEAP * distance), room)
        else:
            outer = (distance, growth)
        if math.isfinite(outer[0]):
            share = (wide - inner[1]) / (outer[1] - inner[1]) if math.isfinite(outer[1]) else 0.5
            distance = inner[0] + min(max(share, 0.1), 0.9) * (outer[0] - inner[0])
    return outer[0]
