"""What a fit leaves over: whether it is noise, and what of the estimates looks wrong."""

import math

import numpy as np

from mechsym.optimise.trace import Trace
from mechsym.plausible import Doubt
from mechsym.quantities import record

_DURBIN = 3.0  # standard errors by which the statistic of white noise may miss 2
_EXACT = 1e-6  # of the speed, below which what is left over is rounding
_OUTLIER = 6.0  # standard deviations
_LOOSE, _T95 = 0.5, 2.0  # standard error by the value, beyond which a parameter is hardly known; interval by it


@record
class Estimate:
    """One parameter."""

    name: str
    unit: str
    value: float  #: [SI]
    error: float  #: Standard error [SI]
    #: 95 % interval, infinite where the trace sets no end [SI]
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
    band = _DURBIN * 2 / math.sqrt(rest.size)
    return rounding(rest, trace) or abs(durbin_watson(rest) - 2) < band


def rounding(rest: np.ndarray, trace: Trace) -> bool:
    """Whether what is left over is rounding and no noise; `rest` as in `white_noise` [rad/s]."""
    return float(np.std(rest)) < _EXACT * max(float(np.abs(v).max()) for v in trace.speeds.values())


def doubts(
    rest: np.ndarray, trace: Trace, estimates: tuple[Estimate, ...], least: np.ndarray, ways: int
) -> tuple[Doubt, ...]:
    """What of a fit looks wrong: residuals that are no noise, outliers, parameters hardly known or impossible.

    Parameters
    ----------
    rest : ndarray, shape (speeds, samples)
        Measured less fitted speeds [rad/s]
    least : ndarray, shape (k,)
        Least values of the parameters [SI]
    ways : int
        How many motions explain the trace, each with its own place of the dead centre
    """
    white, worst = durbin_watson(rest), float(np.abs(rest).max()) / max(float(np.std(rest)), 1e-300)
    band, found = _DURBIN * 2 / math.sqrt(rest.size), []
    if not white_noise(rest, trace):
        why = "what is left over is no noise: the model misses something, and the intervals are too narrow"
        usual = f"{2 - band:.2f} to {2 + band:.2f}"
        found.append(Doubt(code="residuals", quantity="durbin_watson", value=white, usual=usual, why=why))
    if worst > _OUTLIER and not rounding(rest, trace):
        why = "samples lie far off; look for bad readings, they pull the parameters"
        found.append(Doubt(code="outlier", quantity="residual / noise", value=worst, usual="at most 6", why=why))
    if ways > 1:
        why = "the trace does not tell where the dead centre lies: the intervals hold the values of each place"
        found.append(Doubt(code="ambiguous", quantity="motions", value=float(ways), usual="1", why=why))
    one_by_one = (_of_estimate(e, low) for e, low in zip(estimates, least.tolist(), strict=True))
    return (*found, *(doubt for doubt in one_by_one if doubt is not None))


def _of_estimate(e: Estimate, least: float) -> Doubt | None:
    if e.value <= least + 1e-6 * e.error:
        why = f"{e.name} ends at its least value: the model asks for an impossible one"
        return Doubt(code="bound", quantity=e.name, value=e.value, usual=f"above {least:g}", why=why)
    if not math.isfinite(e.high - e.low) or e.low <= least:
        side = "above" if math.isinf(e.high) else "below"
        return Doubt(code="open", quantity=e.name, value=e.value, usual="an interval with two ends",
                     why=f"the trace sets {e.name} no end {side}: free fewer, or measure longer")  # fmt: skip
    if e.high - e.low > 2 * _LOOSE * _T95 * abs(e.value):
        return Doubt(code="loose", quantity=e.name, value=(e.high - e.low) / max(abs(e.value), 1e-300),
                     usual="an interval below twice the value",
                     why=f"{e.name} is hardly determined by this trace")  # fmt: skip
    if e.name.startswith("friction") and e.high < 0:
        why = f"{e.name} would drive the shaft: a torque is missing among what is known"
        return Doubt(code="drives", quantity=e.name, value=e.value, usual="above 0", why=why)
    return None
