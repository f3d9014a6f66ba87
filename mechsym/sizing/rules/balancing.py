"""Balance: mass moments of a rotor, and the shaking force that counterweights leave in a slider crank.

Source: Nunes (2017), ch. 4.6.1; slider cranks: Taylor, The Internal-Combustion Engine, vol. 2, ch. 8.
"""

from collections.abc import Sequence
from typing import Any

import numpy as np

from mechsym.sizing.checks import require


def unbalance(parts: Sequence[tuple[float, float]]) -> float:
    r"""Static unbalance of parts on one line through the axis.

    .. math:: U = \sum m_i b_i

    Parameters
    ----------
    parts : sequence of (float, float)
        Mass [kg] and signed distance of its centre from the axis [m]

    Returns
    -------
    U : float
        Unbalance [kg*m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.37. Print: "g.mm/s2" is g.mm; the force is U omega^2, and the acceleration that the
    parts share is the centripetal one, not an angular acceleration.

    Examples
    --------
    Table 4.15: shaft, two needle bearings and pinion at 13 mm, the output shaft set at -3.81 mm.

    >>> moving = [(0.0908, 0.013), (0.014, 0.013), (0.014, 0.013), (0.0953, 0.013)]
    >>> f"{unbalance(moving) * 1e6:.1f} {unbalance([(0.7298, -0.00381)]) * 1e6:.1f}"
    '2783.3 -2780.5'
    """
    require("masses", [mass for mass, _ in parts], "kg", low=0)
    return float(sum(mass * distance for mass, distance in parts))


def unbalance_force(U: float, omega: Any) -> Any:
    r"""Rotating force of an unbalance.

    .. math:: F = U\,\omega^2

    Parameters
    ----------
    U : float
        Unbalance [kg*m]
    omega : float or ndarray
        Speed [rad/s]

    Returns
    -------
    F : float or ndarray
        Force on the bearings [N]

    Notes
    -----
    Source: Nunes (2017), eq. 4.36, read as force = mass times centripetal acceleration.

    Examples
    --------
    >>> f"{unbalance_force(2.8e-6, 837.758):.2f}"  # what table 4.15 leaves at 8000 rpm
    '1.97'
    """
    return U * np.asarray(omega) ** 2


def counterweight(U: float, distance: float) -> float:
    r"""Mass of a counterweight.

    .. math:: m = |U| / b

    Parameters
    ----------
    U : float
        Unbalance to take away [kg*m]
    distance : float
        Distance of the counterweight's centre from the axis [m]

    Returns
    -------
    m : float
        Mass [kg]

    Notes
    -----
    Source: Nunes (2017), eq. 4.37 set to zero.

    Examples
    --------
    >>> f"{counterweight(2783.3e-6, 0.00381) * 1e3:.1f}"  # the source's output shaft set has 729.8 g
    '730.5'
    """
    require("distance", distance, "m", above=0)
    return abs(U) / distance


def slider_crank_shaking(
    m_rec: float, m_rot: float, balanced: float, r: float, l: float, theta: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    r"""Shaking force of a slider crank per square of speed, with part of the reciprocating mass balanced.

    .. math::
        F_x/\omega^2 &= (m_{rec} + m_{rot} - U/r)\,r\cos\theta + m_{rec}\,\tfrac{r^2}{l}\cos 2\theta \\
        F_y/\omega^2 &= (m_{rot} - U/r)\,r\sin\theta, \qquad U = (m_{rot} + \kappa\,m_{rec})\,r

    Parameters
    ----------
    m_rec, m_rot : float
        Reciprocating mass, and rotating mass at the crankpin [kg]
    balanced : float
        Share kappa of the reciprocating mass in the counterweight, 0 to 1 [-]
    r, l : float
        Crank radius and rod length [m]
    theta : ndarray
        Crank angle from top dead centre [rad]

    Returns
    -------
    x, y : ndarray
        Force on the frame along the cylinder towards the head, and across, over omega^2 [kg*m]

    Notes
    -----
    Source: Taylor, vol. 2, ch. 8, first two harmonics. Valid: r/l below about 0.4. Two opposed pistons in phase cancel
    the force along the cylinder.

    Examples
    --------
    >>> x, y = slider_crank_shaking(0.25, 0.1, 0.5, 0.026, 0.09, np.array([0.0]))
    >>> f"{x[0]:.6f}"
    '0.005128'
    """
    require("share balanced", balanced, "-", low=0, high=1)
    require("ratio r/l", r / l, "-", above=0, high=0.4, hint="two harmonics are not enough for a shorter rod")
    free = m_rec * (1 - balanced)
    x = free * r * np.cos(theta) + m_rec * r**2 / l * np.cos(2 * theta)
    return x, -balanced * m_rec * r * np.sin(theta)
