r"""Twist of a shaft in a run, section by section.

    [phi1]--k1,c1--[phi2]-- ... --[phi_f]

.. math:: v_i = \varphi_i - \varphi_{i+1}, \qquad M_i = k_i v_i + c_i \dot v_i

The window is the stretch at the end over which speeds are summed up; the peaks are those of the whole run.
"""

from typing import Any

import numpy as np

from mechsym.mechanisms import shaft
from mechsym.quantities import record
from mechsym.simulate import Result
from mechsym.torsion import modes as torsion


@record
class ShaftSection:
    """Twist of one section of a shaft."""

    section: str  #: The two coordinates at its ends
    #: Mean and half the swing of the twist over the window [rad]
    twist_mean: float
    twist_amplitude: float
    torque_mean: float  #: The same of its torque [N*m]
    torque_amplitude: float  #: The same of its torque [N*m]
    #: Largest absolute values of the whole run [rad, N*m]
    twist_peak: float
    torque_peak: float


def sections(parameters: Any, result: Result, since: float) -> tuple[ShaftSection, ...]:
    """Twist of every section of the shaft in a run.

    Parameters
    ----------
    since : float
        Where the window begins [s]

    Returns
    -------
    sections : tuple of ShaftSection
        From the free end to the flywheel; none for a rigid shaft
    """
    if not shaft.is_elastic(parameters):
        return ()
    k, c = shaft.springs(parameters)
    return tuple(
        _section(result, pair, k_i, c_i, result.t >= since)
        for pair, k_i, c_i in zip(pairs(result, len(k)), k, c, strict=True)
    )


def pairs(result: Result, count: int) -> list[tuple[str, str]]:
    """The coordinates at the ends of each section.

    Parameters
    ----------
    result : Result
        A run, whose first columns are the coordinates

    Returns
    -------
    pairs : list of tuple of str
        From the free end to the flywheel
    """
    names = list(result.columns)[: count + 1]
    return list(zip(names, names[1:], strict=False))


def _section(result: Result, pair: tuple[str, str], k: float, c: float, window: np.ndarray) -> ShaftSection:
    a, b = pair
    twist = result.columns[a] - result.columns[b]
    torque = k * twist + c * (result.columns[f"{a}d"] - result.columns[f"{b}d"])
    return ShaftSection(
        section=f"{a}-{b}",
        twist_mean=_mean(result.t[window], twist[window]),
        twist_amplitude=float(np.ptp(twist[window])) / 2,
        torque_mean=_mean(result.t[window], torque[window]),
        torque_amplitude=float(np.ptp(torque[window])) / 2,
        twist_peak=float(np.abs(twist).max()),
        torque_peak=float(np.abs(torque).max()),
    )


def _mean(t: np.ndarray, values: np.ndarray) -> float:
    return float(np.trapezoid(values, t) / (t[-1] - t[0])) if len(t) > 1 else float(values[-1])


def natural_frequencies(parameters: Any) -> tuple[float, ...]:
    """Natural frequencies of a shaft, with the mean reciprocating inertia.

    Returns
    -------
    frequencies : tuple of float
        Ascending, without that of turning as a whole; none for a rigid shaft [rad/s]
    """
    if not shaft.is_elastic(parameters):
        return ()
    linear = shaft.matrices(parameters)
    return tuple(torsion.modes(linear.inertia_mean, linear.stiffness).frequencies[1:].tolist())
