"""What a fit leaves over: whether it is noise, and what of the estimates looks wrong."""

import math

import numpy as np

from mechsym.optimise.trace import Trace
from mechsym.plausible import Doubt
from mechsym.quantities import record

_DURBIN = 3.0  # standard errors by which the statistic of white noise may miss 2
_EXACT = 1e-6  # of the speed, below which what is left over is rounding
_OUTLIER = 6.0  # standard deviations
_LOOSE = 0.5  # standard error by the value, beyond which a parameter is hardly known


@record
class Estimate:
    """One parameter."""

    name: str
    unit: str
    value: float  #: [SI]
    error: float  #: Standard error [SI]
    #: 95 % interval [SI]
    low: float
    high: float


def durbin_watson(rest: np.ndarray) -> float:
    """Statistic of Durbin and Watson of residuals [rad/s], 2 where they are white noise."""
    return float(np.sum(np.diff(rest, axis=1) ** 2) / max(np.sum(rest**2), 1e-300))


def white_noise(rest: np.ndarray, trace: Trace) -> bool:
    """Whether what is left over may be white noise; its Durbin-Watson statistic is 2 with the error 2/sqrt(n).

    Parameters
    ----------
    rest : ndarray, shape (speeds, samples)
        Measured less fitted speeds [rad/s]
    """
    scale = max(float(np.abs(v).max()) for v in trace.speeds.values())
    band = _DURBIN * 2 / math.sqrt(rest.size)
    return float(np.std(rest)) < _EXACT * scale or abs(durbin_watson(rest) - 2) < band


def doubts(rest: np.ndarray, trace: Trace, estimates: tuple[Estimate, ...], least: np.ndarray) -> tuple[Doubt, ...]:
    """What of a fit looks wrong: residuals that are no noise, outliers, parameters hardly known or impossible.

    Parameters
    ----------
    rest : ndarray, shape (speeds, samples)
        Measured less fitted speeds [rad/s]
    least : ndarray, shape (k,)
        Least values of the parameters [SI]
    """
    found, white, worst = [], durbin_watson(rest), float(np.abs(rest).max())
    noise, band = float(np.std(rest)), _DURBIN * 2 / math.sqrt(rest.size)
    if not white_noise(rest, trace):
        why = "what is left over is no noise: the model misses something, and the intervals are too narrow"
        found.append(
            Doubt(
                code="residuals",
                quantity="durbin_watson",
                value=white,
                usual=f"{2 - band:.2f} to {2 + band:.2f}",
                why=why,
            )
        )
    if worst > _OUTLIER * noise:
        why = "samples lie far off; look for bad readings, they pull the parameters"
        found.append(
            Doubt(code="outlier", quantity="residual / noise", value=worst / noise, usual="at most 6", why=why)
        )
    for estimate, low in zip(estimates, least.tolist(), strict=True):
        if estimate.error > _LOOSE * abs(estimate.value):
            why = f"{estimate.name} is hardly determined by this trace"
            ratio = estimate.error / max(abs(estimate.value), 1e-300)
            found.append(Doubt(code="loose", quantity=estimate.name, value=ratio, usual="error at most half", why=why))
        elif estimate.name.startswith("friction") and estimate.high < 0:
            why = f"{estimate.name} would drive the shaft: a torque is missing among what is known"
            found.append(Doubt(code="drives", quantity=estimate.name, value=estimate.value, usual="above 0", why=why))
        elif estimate.value <= low + 1e-6 * estimate.error:
            why = f"{estimate.name} ends at its least value: the model asks for an impossible one"
            found.append(
                Doubt(code="bound", quantity=estimate.name, value=estimate.value, usual=f"above {low:g}", why=why)
            )
    return tuple(found)
