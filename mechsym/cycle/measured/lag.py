r"""Lag of a sensor, told by cycles of different speeds: a lag moves the line of a cycle by its speed.

.. math:: \varphi_k = \varphi_0 + \tau\,\omega_k

One speed gives the sum of dead centre and lag, which is what the work needs; only a range of speeds separates them.
"""

import math
from collections.abc import Sequence

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber
from mechsym.cycle.measured.alignment import between
from mechsym.cycle.measured.dead_centre import THROUGH, DeadCentre
from mechsym.cycle.measured.diagram import Diagram, line_prior
from mechsym.cycle.measured.joint_fit import JointFit, Prior, joint_fit, pulls
from mechsym.cycle.measured.measure import MeasuredCycles, around_compression
from mechsym.cycle.measured.smoothing import noise
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pascal, Radian, RadPerSecond

_Z, _LEVEL = 1.96, 0.975
_FEWEST = 4
_SEEN = math.radians(0.05)  # cycles whose lines a usual lag moves by less are of one speed: no line is known so well
#: 19 lags in 20 lie between 0 and 0.1 ms: 20 mm of passage at 500 m/s take 0.04 ms, a filter of 3 kHz 0.05 ms [s]
USUAL = (0.0, 1e-4)
# How much n0, n1, loss, sharpness (in the order of the fit's covariance) and drift may change where the speed changes
# e-fold (assumed): 0.02 are 200 K of the charge; heat lost per radian goes as speed to -0.2 to -0.7, blow-by to -1
_BY_SPEED = np.array([0.0, 0.02, 0.02, 0.06, 0.2, 0.0, 0.0, 0.0025])


@record
class SensorLag:
    """Lag of the sensor between the cylinder and the file."""

    lag: float  #: Middle of the interval [s]
    half: float  #: Half the 95 % interval [s]
    omega: float  #: Speed at which the cycles tell the sum of dead centre and lag [rad/s]
    speeds: tuple[float, float]  #: Lowest and highest [rad/s]

    @property
    def told(self) -> bool:
        """Whether the cycles tell more of the lag than is known of any sensor."""
        return self.half < (USUAL[1] - USUAL[0]) / 2


def lag_of(measured: MeasuredCycles, cylinder: Chamber, diagram: Diagram) -> SensorLag | None:
    """Lag of the sensor of a record; None where its speeds are one, or its angles are spread evenly over each turn."""
    speeds, alignment = measured.speeds, measured.alignment
    if speeds is None or alignment.spread is not None or len(speeds) < _FEWEST or not _differ(speeds):
        return None
    phi, rows = around_compression(measured.phi, measured.cycles, measured.period)
    ends, prior = THROUGH if alignment.motored else between(diagram), line_prior(diagram)
    return sensor_lag(cycle_fits(phi, rows, cylinder, ends, prior), speeds, prior)


def without_lag(found: DeadCentre, lag: SensorLag) -> tuple[Radian, Radian]:
    """Dead centre of a record less the lag in it.

    found: of the mean cycle, by its own line. Returns angle, half: angle of the file and half its 95 % interval.
    """
    return found.angle - lag.lag * lag.omega, math.hypot((found.high - found.low) / 2, lag.half * lag.omega)


def _differ(speeds: np.ndarray) -> bool:
    return bool(USUAL[1] * np.ptp(speeds) > _SEEN)


def cycle_fits(
    phi: Radian[Array], rows: Pascal[Array], cylinder: Chamber, ends: tuple[Radian, Radian], prior: Prior
) -> list[JointFit]:
    """Charge line of every cycle by itself.

    phi: ascending angles from the dead centre of the mean cycle, compression in one piece; rows: pressure of each
    cycle, shape (k, n).
    """
    return [joint_fit(phi, row, cylinder, ends, noise(row), prior, [0.0]) for row in rows]


def sensor_lag(fits: Sequence[JointFit], speeds: RadPerSecond[Array], prior: Prior) -> SensorLag | None:
    r"""Lag of the sensor from dead centres at several speeds, by weighted regression.

    .. math:: \tau = \sum_k b_k \varphi_k, \quad b_k = \frac{w_k (\omega_k - \bar\omega)}
        {\sum_i w_i (\omega_i - \bar\omega)^2}, \quad
        h^2 = t_{K-2}^2 s^2 + 1.96^2 \sum_j \left(\sum_k b_k g_{kj} c_j \ln\frac{\omega_k}{\bar\omega}\right)^2

    fits: line of every cycle, of one or several records of one sensor and encoder, on one scale of angles; speeds:
    their speeds, shape (k,). Returns lag: None with fewer than four cycles or a single speed. Weights w are one over
    the variance that the noise leaves of each dead centre; s is the deviation of tau by the scatter about the straight
    line. What is assumed of the charge (pull g on the dead centre) is in all cycles alike and goes out with phi_0, but
    for c_j, by which it may change with speed. Source: least squares; c of the losses from the exponents of speed of
    Woschni, Annand and Eichelberg, else assumed. Valid: a lag that is short beside compression (tau omega below about 3
    degrees), on an encoder that follows the shaft inside a turn.

    >>> sensor_lag([], np.array([]), Prior()) is None
    True
    """
    if len(fits) < _FEWEST or not _differ(speeds):
        return None
    at = np.array([fit.tdc for fit in fits])
    weight = 1 / np.array([fit.covariance[0, 0] * (1 - fit.prior_share) for fit in fits])
    middle = float(weight @ speeds / weight.sum())
    b = weight * (speeds - middle) / (weight @ (speeds - middle) ** 2)
    lag = float(b @ at)
    left = at - weight @ at / weight.sum() - lag * (speeds - middle)
    scatter = float(weight @ left**2) / (len(fits) - 2) / float(weight @ (speeds - middle) ** 2)
    pulled = np.array([pulls(fit, prior) for fit in fits]) * _BY_SPEED * np.log(speeds / middle)[:, None]
    half = math.hypot(
        scipy.special.stdtrit(len(fits) - 2, _LEVEL) * math.sqrt(scatter), _Z * np.linalg.norm(b @ pulled)
    )
    return SensorLag(lag=lag, half=half, omega=middle, speeds=(float(speeds.min()), float(speeds.max())))
