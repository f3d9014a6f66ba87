r"""What a real hinge takes from the shaft: bearings of the rollers, seals and guides of the spring, heat of its gas.

    (o)--[=|=====|=]--(o)      (o) roller on a bearing of radius r_b      | seal      = guide of the piston
     r        spring

c rollers move the spring along rho(phi), with the contact force N, the spring's force F and the side force S of the
piston on its guide, each the same for all rollers. All torques are losses on the shaft, positive, and lower the torque
that is left for the load. Friction is taken as a share of its normal force (Coulomb), small enough not to change them.
Without `[losses]` they are computed beside the ideal design; a case that has that section has them in its runs in time
too (`in_time`).
"""

import math
from typing import Any

from mechsym.hinge.rollers import length
from mechsym.quantities import quantity, record


@record
class HingeLosses:
    """Friction of a hinge: `[losses]` of a case. The defaults are assumed, usual values."""

    bearing_mu: float = quantity("-", default=0.0018, low=0, high=0.1, about="friction of the rollers' bearings")
    bearing_radius: float = quantity(
        "m", default=0.0, low=0, about="where their friction acts; 0 stands for half the roller's radius"
    )
    seal_mu: float = quantity("-", default=0.01, low=0, high=0.5, about="friction of the seals by the spring's force")
    guide_mu: float = quantity("-", default=0.05, low=0, high=0.5, about="friction of the spring's piston on its guide")
    tau: float = quantity(
        "s", default=0.0, low=0, about="time of the gas to take the wall's temperature; 0: from the index of the spring"
    )
    gamma: float = quantity("-", default=1.4, above=1, below=2, about="ratio of specific heats of the gas")
    wall_temperature: float = quantity("K", default=320.0, above=200, below=800, about="wall of the gas spring")


@record
class LossTorques:
    """Mean torques that a hinge takes from the shaft."""

    bearing: float = quantity("N*m", low=0, about="bearings of the rollers")
    seal: float = quantity("N*m", low=0, about="seals of the spring")
    guide: float = quantity("N*m", low=0, about="guides of the spring's pistons")
    rolling: float = quantity("N*m", low=0, about="rolling resistance of rollers and track")
    gas: float = quantity("N*m", low=0, about="heat exchange of the gas")

    @property
    def total(self) -> float:
        """All of them [N*m]."""
        return self.bearing + self.seal + self.guide + self.rolling + self.gas


def bearing_torque(N: Any, rho: Any, drho: Any, mu: float, bearing_radius: float, radius: float, count: int) -> Any:
    r"""Torque lost in the bearings of the rollers.

    .. math:: M = c\,\mu_b |N| r_b \left(\frac{\sqrt{\rho^2 + \rho'^2}}{r} + 1\right)

    Parameters
    ----------
    N : ndarray, shape (n,), or casadi.SX
        Contact force of each roller [N]
    rho, drho : ndarray, shape (n,), or casadi.SX
        Path of the roller centres [m] and its derivative [m/rad]
    mu : float
        Friction of the bearing [-]
    bearing_radius : float
        r_b, where it acts [m]
    radius : float
        r of the roller [m]

    Returns
    -------
    torque : ndarray, shape (n,), or casadi.SX
        On the shaft [N*m]

    Notes
    -----
    Source: the roller rolls along the track while its pin turns with the shaft: by the path's length over r the one
    way and by the shaft's angle the other way round, so their speeds add.

    Examples
    --------
    >>> round(float(bearing_torque(1e5, 0.7, 0.0, 0.0018, 0.05, 0.1, 2)), 6)
    144.0
    """
    return count * mu * abs(N) * bearing_radius * (length(rho, drho) / radius + 1)


def seal_torque(force: Any, drho: Any, mu: float, count: int) -> Any:
    r"""Torque lost in the seals of the spring, whose friction follows the pressure.

    .. math:: M = c\,\mu_s |F \rho'|

    Parameters
    ----------
    force : ndarray, shape (n,), or casadi.SX
        Of the spring on each roller [N]
    drho : ndarray, shape (n,), or casadi.SX
        Derivative of the path [m/rad]
    mu : float
        Friction force by spring force [-]

    Returns
    -------
    torque : ndarray, shape (n,), or casadi.SX
        On the shaft [N*m]

    Notes
    -----
    Source: definition of mu_s. A spring that closes and opens once in a turn loses 2 mu_s times its swing of energy.

    Examples
    --------
    >>> seal_torque(1e5, -0.1, 0.01, 2)
    200.0
    """
    return count * mu * abs(force * drho)


def side_force(force: Any, rho: Any, drho: Any, d2rho: Any, mass: float, omega: Any) -> Any:
    r"""Force of a piston on the guide of the spring, which carries the torque of the track into the shaft.

    .. math:: S = \left[F + m_h \omega^2 (\rho - \rho'')\right] \frac{\rho'}{\rho} - 2 m_h \omega^2 \rho'

    Parameters
    ----------
    force : ndarray, shape (n,), or casadi.SX
        Of the spring on each roller [N]
    rho, drho, d2rho : ndarray, shape (n,), or casadi.SX
        Path of the roller centres [m], [m/rad], [m/rad^2]
    mass : float
        m_h, moving with each roller [kg]
    omega : float or casadi.SX
        Speed of the shaft [rad/s]

    Returns
    -------
    S : ndarray, shape (n,), or casadi.SX
        Signed [N]

    Notes
    -----
    Source: tangential part of the track's force, less the Coriolis force of the mass. Valid: spring and rollers turn
    with the shaft, without the traction that the roller's own inertia asks for.

    Examples
    --------
    >>> side_force(1e5, 0.8, 0.08, 0.0, 0.0, 10.0)
    10000.0
    """
    pull = mass * omega**2
    return (force + pull * (rho - d2rho)) * drho / rho - 2 * pull * drho


def guide_torque(side: Any, drho: Any, mu: float, count: int) -> Any:
    r"""Torque lost in the guides of the spring's pistons.

    .. math:: M = c\,\mu_g |S\,\rho'|

    Parameters
    ----------
    side : ndarray, shape (n,), or casadi.SX
        Side force S of each piston [N]
    drho : ndarray, shape (n,), or casadi.SX
        Derivative of the path [m/rad]
    mu : float
        Friction of the guide [-]

    Returns
    -------
    torque : ndarray, shape (n,), or casadi.SX
        On the shaft [N*m]

    Notes
    -----
    Source: Coulomb friction.

    Examples
    --------
    >>> guide_torque(1e4, -0.1, 0.05, 2)
    100.0
    """
    return count * mu * abs(side * drho)


def monotone_seal_torque(swing: float, mu: float, period: float = 2 * math.pi) -> float:
    r"""Mean torque lost in the seals of a spring that closes once and opens once in a period.

    .. math:: \bar M = \frac{2 \mu_s \Delta U}{T}

    Parameters
    ----------
    swing : float
        Largest less smallest energy in the spring [J]
    mu : float
        Friction force by spring force [-]
    period : float
        Angle in which it closes and opens [rad]

    Returns
    -------
    torque : float
        On the shaft [N*m]

    Notes
    -----
    Source: the mean of `seal_torque`, integrated.

    Examples
    --------
    >>> round(monotone_seal_torque(65e3, 0.01), 1)
    206.9
    """
    return 2 * mu * swing / period
