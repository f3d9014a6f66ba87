r"""What a real hinge takes from the shaft: bearings of the rollers, seals and guides of the spring, heat of its gas.

    (o)--[=|=====|=]--(o)      (o) roller on a bearing of radius r_b      | seal      = guide of the piston
     r        spring

c rollers move the spring along rho(phi), with the contact force N, the spring's force F and the side force S of the
piston on its guide, each the same for all rollers. All torques are losses on the shaft, positive, and lower the torque
that is left for the load. Friction is taken as a share of its normal force (Coulomb), small enough not to change them.
Without `[losses]` they are computed beside the ideal design; a case that has that section has them in its runs in time
too (`in_time`).
"""

from mechsym.hinge.rollers import length
from mechsym.quantities import quantity, record
from mechsym.quantities.units import (
    Kilogram,
    Metre,
    MetrePerRadian,
    MetrePerRadian2,
    Newton,
    NewtonMetre,
    Pure,
    RadPerSecond,
    Scalar,
)


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


def bearing_torque(
    N: Newton[Scalar],
    rho: Metre[Scalar],
    drho: MetrePerRadian[Scalar],
    mu: Pure,
    bearing_radius: Metre[Scalar],
    radius: Metre[Scalar],
    count: int,
) -> NewtonMetre[Scalar]:
    r"""Torque lost in the bearings of the rollers.

    .. math:: M = c\,\mu_b |N| r_b \left(\frac{\sqrt{\rho^2 + \rho'^2}}{r} + 1\right)

    N: contact force of each roller; rho, drho: path of the roller centres and its derivative; mu: friction of the
    bearing; bearing_radius: r_b, where it acts; radius: r of the roller. Returns torque: on the shaft.
    Source: the roller rolls along the track while its pin turns with the shaft: by the path's length over r the one way
    and by the shaft's angle the other way round, so their speeds add.

    >>> round(float(bearing_torque(1e5, 0.7, 0.0, 0.0018, 0.05, 0.1, 2)), 6)
    144.0
    """
    return count * mu * abs(N) * bearing_radius * (length(rho, drho) / radius + 1)


def seal_torque(force: Newton[Scalar], drho: MetrePerRadian[Scalar], mu: Pure, count: int) -> NewtonMetre[Scalar]:
    r"""Torque lost in the seals of the spring, whose friction follows the pressure.

    .. math:: M = c\,\mu_s |F \rho'|

    force: of the spring on each roller; drho: derivative of the path; mu: friction force by spring force. Returns
    torque: on the shaft.
    Source: definition of mu_s. A spring that closes and opens once in a turn loses 2 mu_s times its swing of energy.

    >>> seal_torque(1e5, -0.1, 0.01, 2)
    200.0
    """
    return count * mu * abs(force * drho)


def side_force(
    force: Newton[Scalar],
    rho: Metre[Scalar],
    drho: MetrePerRadian[Scalar],
    d2rho: MetrePerRadian2[Scalar],
    mass: Kilogram[Scalar],
    omega: RadPerSecond[Scalar],
) -> Newton[Scalar]:
    r"""Force of a piston on the guide of the spring, which carries the torque of the track into the shaft.

    .. math:: S = \left[F + m_h \omega^2 (\rho - \rho'')\right] \frac{\rho'}{\rho} - 2 m_h \omega^2 \rho'

    force: of the spring on each roller; rho, drho, d2rho: path of the roller centres; mass: m_h, moving with each
    roller. Returns S: signed. Source: tangential part of the track's force, less the Coriolis force of the mass. Valid:
    spring and rollers turn with the shaft, without the traction that the roller's own inertia asks for.

    >>> side_force(1e5, 0.8, 0.08, 0.0, 0.0, 10.0)
    10000.0
    """
    pull = mass * omega**2
    return (force + pull * (rho - d2rho)) * drho / rho - 2 * pull * drho


def guide_torque(side: Newton[Scalar], drho: MetrePerRadian[Scalar], mu: Pure, count: int) -> NewtonMetre[Scalar]:
    r"""Torque lost in the guides of the spring's pistons.

    .. math:: M = c\,\mu_g |S\,\rho'|

    side: side force S of each piston; drho: derivative of the path; mu: friction of the guide. Returns torque: on the
    shaft. Source: Coulomb friction.

    >>> guide_torque(1e4, -0.1, 0.05, 2)
    100.0
    """
    return count * mu * abs(side * drho)
