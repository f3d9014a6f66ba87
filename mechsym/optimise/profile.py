r"""Intervals by profiles: how far a parameter may go while all the others do their best to follow.

.. math:: S(\theta_i) = \min_{\theta_{j \ne i}, x_0} \sum_i r_i^2 \le S_{\min}\,(1 + t^2/\nu)

Where the model is linear in its parameters this is the usual +- t standard errors. Where it is not, it still is how
far the trace lets go; an end that is never reached is open.
"""

import math
from collections.abc import Sequence

import numpy as np

from mechsym.optimise.fit import ClosestMotion, TraceTask, closest

_TRIALS, _CLOSE, _LEAP = 10, 0.02, 3.0  # trials at an end, how close they come, largest leap by the last distance


def profile(
    task: TraceTask, fits: Sequence[ClosestMotion], number: int, far: float, reach: float
) -> tuple[float, float]:
    """Ends of the interval of the parameter of a number.

    Parameters
    ----------
    fits : sequence of ClosestMotion
        The best motion first, then others that the trace does not tell from it
    far : float
        Where the ends would be if the model were straight, from the best value [SI]
    reach : float
        What the sum of squares may grow by [rad^2/s^2]

    Returns
    -------
    low, high : float
        Over all fits; infinite where the trace sets no end, the least value where the model has none below [SI]
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
        there = _held(task, here, number, float(fit.theta[number]) + math.copysign(distance, far))
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


def _held(task: TraceTask, here: ClosestMotion, number: int, value: float) -> ClosestMotion | None:
    """The closest motion with one parameter held, from one nearby."""
    model, theta = task.model, here.theta.copy()
    move = (value - theta[number]) / model.size[number]
    others = np.delete(np.arange(here.slopes.shape[1]), number)
    width = np.linalg.norm(here.slopes[:, others], axis=0)
    width[width == 0] = 1.0
    step = np.zeros(here.slopes.shape[1])
    step[number] = move
    target = here.rest.ravel() - here.slopes[:, number] * move
    step[others] = np.linalg.lstsq(here.slopes[:, others] / width, target, rcond=1e-7)[0] / width
    theta = np.maximum(theta + step[: len(theta)] * model.size, model.low)
    step[: len(theta)] = (theta - here.theta) / model.size
    states = here.states + (here.follow @ step).reshape(here.states.shape, order="F")
    found = closest(task, states, theta, number)
    return found if found.status == "converged" else None
