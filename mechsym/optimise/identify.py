r"""Parameters of a machine out of measured speeds, with intervals that hold the truth as often as they say.

.. math:: \min_{x, \theta} \sum_i \frac{(\omega_i - u(t_i))^2}{\sigma^2}\quad\text{with the equations of motion},
          \qquad \mathrm{cov}(\theta) = s^2 (S^T S)^{-1},\quad S = \frac{d u(t_i)}{d(\theta, x_0)}

The equations hold exactly (`collocation`), the noise sits on the speeds alone. s comes from what the fit leaves over.
The standard errors are those of a straight model; the intervals are not (`profile`).
"""

import math
from collections.abc import Mapping

import casadi as ca
import numpy as np
from scipy.special import stdtrit

from mechsym.errors import BadInput
from mechsym.optimise.collocation import grid
from mechsym.optimise.fit import RANK, ClosestMotion, TracedMotion, TraceTask, approach, closest
from mechsym.optimise.profile import profile
from mechsym.optimise.residuals import Estimate, doubts, durbin_watson, rounding
from mechsym.optimise.trace import Trace
from mechsym.plausible import Doubt
from mechsym.quantities import record

_LONGEST = 0.5  # of an interval: radians of the fastest motion
_STARTS = 4  # angles that are tried
_SAME, _BESIDE = 0.1, 0.2  # standard errors and radians of the first angle within which two fits are one


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
    task = TraceTask(model, trace, grid(trace.t, model.breaks, _longest(model, trace)))
    # speeds do not tell where the dead centre lies: a search from each quarter
    starts = [model.angle + k * 2 * math.pi / _STARTS for k in range(_STARTS)]
    fits = sorted((closest(task, *approach(task, angle)) for angle in starts), key=lambda fit: fit.left)
    return _result(task, fits)


def _longest(model: TracedMotion, trace: Trace) -> float:
    """Length of an interval that follows the fastest motion: turning, or swinging of an elastic shaft [s]."""
    n = len(model.velocities)
    x = ca.SX.sym("x", 2 * n)
    slope = ca.jacobian(model.rate(x, model.known(trace.t[:1])[:, 0], model.start), x)
    rates = np.linalg.eigvals(np.asarray(ca.Function("slope", [x], [slope])(ca.DM([model.angle] * n + [0.0] * n))))
    turning = 2 * max(float(np.abs(v).max()) for v in trace.speeds.values())
    return _LONGEST / max(float(np.abs(rates).max()), turning, 1e-9)


def _covariance(model: TracedMotion, trace: Trace, slopes: np.ndarray) -> np.ndarray:
    """Inverse of the information of the parameters, by their sizes; refused where one of them is not determined."""
    columns = np.linalg.norm(slopes, axis=0)
    columns[columns == 0] = 1.0
    _, singular, directions = np.linalg.svd(slopes / columns, full_matrices=False)
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
    return (inverse @ inverse.T / np.outer(columns, columns))[:k, :k]


def _result(task: TraceTask, fits: list[ClosestMotion]) -> Identified:
    model, trace, best = task.model, task.trace, fits[0]
    if best.status.startswith("no motion"):
        raise BadInput(f"{trace.file}: {best.status}: see whether [drive], units and the values of the case fit it")
    dof = best.rest.size - best.slopes.shape[1]
    noise = math.sqrt(best.left / dof)
    covariance = noise**2 * _covariance(model, trace, best.slopes) * np.outer(model.size, model.size)
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
        status="found" if best.status == "converged" else "not converged", reason=best.status, estimates=estimates,
        correlation=covariance / np.outer(errors, errors), noise=noise, durbin_watson=durbin_watson(best.rest),
        samples=best.rest.size, intervals=len(task.points.edges) - 1, t=trace.t, measured=measured,
        fitted={name: measured[name] - rest for name, rest in zip(measured, best.rest, strict=True)},
        doubts=doubts(best.rest, trace, estimates, model.low, len(alike)),
    )  # fmt: skip


def _alike(fits: list[ClosestMotion], reach: float, errors: np.ndarray) -> list[ClosestMotion]:
    """The best fit and those that the trace does not tell from it, each once."""
    found = fits[:1]
    for fit in fits[1:]:
        near = fit.status == "converged" and fit.left - fits[0].left < reach**2
        if near and not any(_one(fit, other, errors) for other in found):
            found.append(fit)
    return found


def _one(a: ClosestMotion, b: ClosestMotion, errors: np.ndarray) -> bool:
    turned = abs(math.remainder(float(a.states[0, 0] - b.states[0, 0]), 2 * math.pi))
    return turned < _BESIDE or bool((np.abs(a.theta - b.theta) < _SAME * errors).all())
