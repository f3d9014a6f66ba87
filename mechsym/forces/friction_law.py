r"""The mechanism's own friction as a law of the engine cycle.

The cycle knows friction as a mean pressure by a named correlation, `[friction_pressure]`. Here the coefficients of Chen
and Flynn's form are fitted to the friction that joints and rings have at several speeds; the record can be
used wherever the cycle takes a correlation, or written into the case.
"""

import math
from collections.abc import Sequence

import numpy as np
import scipy

from mechsym.cycle.friction import ChenFlynn, friction_pressure
from mechsym.errors import BadInput
from mechsym.forces.friction import Friction, losses
from mechsym.forces.loads import loads
from mechsym.forces.rings import Rings
from mechsym.forces.turn import Turn
from mechsym.quantities import record


@record
class FittedLaw:
    """A correlation fitted to a mechanism's friction."""

    law: ChenFlynn  #: For `[friction_pressure]` of the case
    #: shape (k,): Speeds [rad/s], friction mean pressure of the mechanism and of the law [Pa]
    omega: np.ndarray
    computed: np.ndarray
    fitted: np.ndarray
    misfit: float  #: Largest difference over the largest value [-]


def fit(turns: Sequence[Turn], friction: Friction, rings: Rings) -> FittedLaw:
    r"""Chen and Flynn's coefficients, none negative, that come closest to a mechanism's friction.

    .. math:: p_{mf} \approx A + B\,p_{max} + C\,\bar S_p + D\,\bar S_p^2

    Parameters
    ----------
    turns : sequence of Turn
        One machine with gas at several speeds; a single one gives a constant

    Returns
    -------
    fitted : FittedLaw
        Law and how close it comes
    """
    omega = np.array([one.omega for one in turns])
    computed = np.array([_mean_pressure(one, friction, rings) for one in turns])
    p_max = np.array([one.gas.pressure.absolute(one.phi).max() for one in turns if one.gas])
    piston_speed = np.array([one.gas.chamber.stroke * one.omega / math.pi for one in turns if one.gas])
    columns = np.array([np.ones_like(p_max), p_max, piston_speed, piston_speed**2])
    columns = columns if len(turns) > 1 else columns * [[1], [0], [0], [0]]
    scale = np.maximum(columns.max(axis=1), 1e-300)
    found = scipy.optimize.nnls((columns / scale[:, None]).T, computed)[0] / scale
    names = ("constant", "per_peak_pressure", "per_speed", "per_speed_squared")
    law = ChenFlynn(**dict(zip(names, found.tolist(), strict=True)))
    fitted = friction_pressure(law, p_max, piston_speed, omega)
    misfit = float(np.abs(fitted - computed).max() / computed.max()) if computed.max() > 0 else 0.0
    return FittedLaw(law=law, omega=omega, computed=computed, fitted=fitted, misfit=misfit)


def _mean_pressure(one: Turn, friction: Friction, rings: Rings) -> float:
    found = losses(one, loads(one), friction, rings).friction_mean_pressure
    if found is None:
        raise BadInput("a friction mean pressure needs a gas on the pistons")
    return found
