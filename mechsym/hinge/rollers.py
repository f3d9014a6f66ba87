r"""Rollers of finite radius on the guide: cut profile, pressure angle, curvature, contact forces and stress.

              n, outward normal
        ..----^----..        cut profile, at the roller radius r from the path
      .'     (o)     '.      (o) roller, pressed outwards by the spring
     |   .-------.     |     path of the roller centres, rho(theta), seen from the shaft axis
     '--'         '---'

The path turns counter-clockwise with theta; its curvature kappa is positive where it bends around the shaft axis like
a circle, 1/rho for a circle. Where kappa < 0 the path bends inwards and the cut profile is undercut unless
1 + r kappa > 0. With that condition around the whole turn the profile is star-shaped, so it cannot cross itself:
the cross product of a profile point with its tangent is (1 + r kappa)(rho^2/s + r) s > 0, s = hypot(rho, rho').

Not in the source, which sets the roller radius to zero and names the large reactions N1, N2 as the open problem (Zotov
et al. 2024, section 3). Neglected: mass of rollers, spring pistons and gas (see `inertia_force`), bearing friction.

What a real hinge takes from the shaft: bearings of the rollers, seals and guides of the spring, heat of its gas.

    (o)--[=|=====|=]--(o)      (o) roller on a bearing of radius r_b      | seal      = guide of the piston
     r        spring

c rollers move the spring along rho(phi), with the contact force N, the spring's force F and the side force S of the
piston on its guide, each the same for all rollers. All torques are losses on the shaft, positive, and lower the torque
that is left for the load. Friction is taken as a share of its normal force (Coulomb), small enough not to change them.
Without `[losses]` they are computed beside the ideal design; a case that has that section has them in its runs in time
too (`trials`).
"""

import math
from typing import Annotated, Protocol

import casadi as ca
import numpy as np

from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import (
    Array,
    Kilogram,
    Metre,
    MetrePerRadian,
    MetrePerRadian2,
    Newton,
    NewtonMetre,
    Pascal,
    Pure,
    Radian,
    RadPerSecond,
    Scalar,
)


@record
class RollerParameters:
    """Rollers and tracks."""

    radius: float = quantity("m", above=0, about="roller radius")
    width: float = quantity("m", above=0, about="width of contact")
    plane_offset: float = quantity("m", default=0.0, low=0, about="distance of the track planes along the shaft")
    E: float = quantity("Pa", default=2.06e11, above=0, about="Young's modulus of roller and track")
    nu: float = quantity("-", default=0.3, low=0, high=0.5, about="Poisson's ratio of roller and track")
    #: `none`, or `rolling` with the resistance of `rolling_arm`
    friction: str = choice("none", "rolling", default="none", about="friction between roller and track")
    rolling_arm: float = quantity(
        "m", default=1e-6, low=0, about="rolling resistance moment over normal force", only=("friction", "rolling")
    )
    moving_mass: float = quantity("kg", default=0.0, low=0, high=10000, about="mass that moves with each roller")


def pressure_angle(rho: Metre[Array], drho: MetrePerRadian[Array]) -> Radian[Array]:
    r"""Angle between the contact normal and the radius.

    .. math:: \tan\alpha = \frac{\rho'}{\rho}

    rho, drho: path and its derivative. Returns alpha: signed.
    """
    return np.arctan2(drho, rho)


def curvature(
    rho: Metre[Scalar], drho: MetrePerRadian[Scalar], d2rho: MetrePerRadian2[Scalar]
) -> Annotated[Scalar, "1/m"]:
    r"""Curvature of the path of the roller centres.

    .. math:: \kappa = \frac{\rho^2 + 2\rho'^2 - \rho\rho''}{(\rho^2 + \rho'^2)^{3/2}}

    rho, drho, d2rho: path and its derivatives. Returns kappa: positive around the shaft axis, negative where the path
    bends inwards.
    """
    square = rho**2 + drho**2
    return (square + drho**2 - rho * d2rho) / (square * _root(square))


def parallel(
    rho: Metre[Array], drho: MetrePerRadian[Array], theta: Radian[Array], distance: Metre
) -> tuple[Metre[Array], Metre[Array]]:
    r"""Exact parallel curve outside the path: the cut profile at the roller radius, the path of a cutter nearer.

    .. math:: P = \rho\,e_r + d\,n, \qquad n = \frac{\rho\,e_r - \rho'\,e_\theta}{\sqrt{\rho^2 + \rho'^2}}

    rho, drho: path and its derivative. theta: angle of the guide's shaft. distance: d: roller radius for the profile,
    roller radius minus cutter radius for the centre of a cutter. Returns x, y: in the frame of the track, x along theta
    = 0. A change of rho by the roller radius is not this curve: it misses by the pressure angle.
    """
    s = np.hypot(rho, drho)
    along, across = rho + distance * rho / s, -distance * drho / s
    return along * np.cos(theta) - across * np.sin(theta), along * np.sin(theta) + across * np.cos(theta)


def _root(value: Scalar) -> Scalar:
    return ca.sqrt(value) if isinstance(value, ca.SX | ca.MX) else np.sqrt(value)


def length(a: Scalar, b: Scalar) -> Scalar:
    """Root of the sum of squares, for numbers, arrays and CasADi symbols alike [unit of a]."""
    symbols = isinstance(a, ca.SX | ca.MX) or isinstance(b, ca.SX | ca.MX)
    return ca.hypot(a, b) if symbols else np.hypot(a, b)


def reaction(force: Newton[Scalar], rho: Metre[Scalar], drho: MetrePerRadian[Scalar]) -> Newton[Scalar]:
    r"""Contact force of a massless roller on its track, N1 and N2 of the source.

    .. math:: N = \frac{F}{\cos\alpha} = F\sqrt{1 + (\rho'/\rho)^2}

    force: spring force F; rho, drho: path and its derivative. Returns N: along the normal; both rollers of a pair carry
    the same. Virtual work: the tangential part N sin(alpha) at the radius rho is F drho/dtheta for each roller.
    """
    return force * _root(1 + (drho / rho) ** 2)


class Rolling(Protocol):
    """Numbers of a roller and its track."""

    @property
    def radius(self) -> float:
        """Of the roller [m]."""

    @property
    def width(self) -> float:
        """Of contact [m]."""

    @property
    def E(self) -> float:
        """Young's modulus of both [Pa]."""

    @property
    def nu(self) -> float:
        """Poisson's ratio of both [-]."""


def contact_modulus(rollers: Rolling) -> float:
    """Modulus E* of a contact of two bodies of one material [Pa]."""
    return rollers.E / (2 * (1 - rollers.nu**2))


def hertz_stress(N: Newton[Array], kappa: Annotated[Array, "1/m"], rollers: Rolling) -> Pascal[Array]:
    r"""Largest pressure in the line contact of roller and track.

    .. math:: p_H = \sqrt{\frac{N E^*}{\pi\,w\,R_e}}, \qquad E^* = \frac{E}{2(1 - \nu^2)}, \qquad
              \frac1{R_e} = \frac1r - \frac{\kappa}{1 + r\kappa} = \frac1{r\,(1 + r\kappa)}

    kappa: curvature of the path. Returns p_H: pressure in the middle of the contact; infinite where the profile is
    undercut, 0 where nothing presses. Source: K. L. Johnson, Contact Mechanics (1985), section 4.2(c), load per unit
    width N / w. Valid: both bodies of one material, contact much narrower than r, no edge loading.
    """
    relative_radius = rollers.radius * np.maximum(1 + rollers.radius * kappa, 0.0)
    with np.errstate(divide="ignore"):
        return np.sqrt(np.maximum(N, 0.0) * contact_modulus(rollers) / (math.pi * rollers.width * relative_radius))


def contact_force(
    force: Newton[Scalar],
    rho: Metre[Scalar],
    drho: MetrePerRadian[Scalar],
    d2rho: MetrePerRadian2[Scalar],
    mass: Kilogram[Scalar],
    omega: RadPerSecond[Scalar],
) -> Newton[Scalar]:
    r"""Contact force of a roller with mass that turns with the shaft and is pressed outwards by it too.

    .. math:: N = \left[F + m_h \omega^2 (\rho - \rho'')\right] \sqrt{1 + (\rho'/\rho)^2}

    force: spring force F on each roller; rho, drho, d2rho: path and its derivatives; mass: m_h, moving with the roller;
    omega: speed of the guide's shaft. Returns N: along the normal of the track. The torque of the track on the shaft is
    N sin(alpha) rho less the Coriolis force on the spring's guide; together they are F rho' - omega^2 I_h'/2 for each
    roller. Without the traction that the roller's own inertia asks for.
    """
    return reaction(force + mass * inertia_force(rho, d2rho, omega), rho, drho)


def tilting_couple(N: Newton[Array], plane_offset: Metre) -> NewtonMetre[Array]:
    """Couple that tilts two tracks in offset planes.

    .. math:: C = N b

    N: contact force of each roller; the two are opposite and b apart along the shaft. Returns C: about an axis across
    the shaft, turning with the spring; the bearings of the hinge carry it.
    """
    return N * plane_offset


def loss_torque(
    N: Newton[Scalar], rho: Metre[Scalar], drho: MetrePerRadian[Scalar], rollers: RollerParameters
) -> NewtonMetre[Scalar]:
    r"""Torque that rolling resistance of one roller takes from the guide's shaft.

    .. math:: M_f = \frac{f N}{r}\,\sqrt{\rho^2 + \rho'^2}

    N: contact force. rho, drho: path and its derivative. rollers: friction by name; 0 for `none`. Returns M_f: against
    the rotation. A roller whose centre moves by ds turns by ds / r against the track and loses f N ds / r. f is 1e-6 m
    in the source.
    """
    if rollers.friction == "none":
        return np.zeros(N.shape)
    return rollers.rolling_arm * N / rollers.radius * length(rho, drho)


def inertia_force(
    rho: Metre[Scalar], d2rho: MetrePerRadian2[Scalar], omega: RadPerSecond[Scalar]
) -> Annotated[Scalar, "N/kg"]:
    r"""Radial force for each kilogram that moves with a roller: what the massless model leaves out.

    .. math:: f = \omega_\theta^2\,(\rho - \rho'')

    rho, d2rho: path and its second derivative; omega: speed of the guide's shaft. Returns f: outwards, for a spring
    that turns with the shaft; without the term rho if the tracks turn instead.
    """
    return omega**2 * (rho - d2rho)


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

    def bearing_at(self, radius: Metre[Scalar]) -> Metre[Scalar]:
        """Where the friction of the bearings acts in a roller."""
        return self.bearing_radius or radius / 2


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


class MovingRoller(Protocol):
    """Numbers of a roller that moves with its part of the spring."""

    @property
    def radius(self) -> Scalar:
        """Of the roller [m]."""

    @property
    def moving_mass(self) -> Scalar:
        """That moves with it [kg]."""


def friction_torques(
    force: Newton[Scalar],
    path: tuple[Metre[Scalar], MetrePerRadian[Scalar], MetrePerRadian2[Scalar]],
    omega: RadPerSecond[Scalar],
    rollers: MovingRoller,
    count: int,
    given: HingeLosses,
    steep: MetrePerRadian[Scalar] | None = None,
) -> dict[str, NewtonMetre[Scalar]]:
    """Torques that bearings, seals and guides take from the guide's shaft, by kind.

    force: of the spring on each roller; path: rho and its derivatives; omega: speed of the guide's shaft; rollers: each
    of `count`; steep: |drho| of the seals, where it has to be smooth.
    """
    rho, drho, d2rho = path
    N = contact_force(force, rho, drho, d2rho, rollers.moving_mass, omega)
    side = side_force(force, rho, drho, d2rho, rollers.moving_mass, omega)
    acts, radius = given.bearing_at(rollers.radius), rollers.radius
    return {
        "bearing": bearing_torque(N, rho, drho, given.bearing_mu, acts, radius, count),
        "seal": seal_torque(force, drho if steep is None else steep, given.seal_mu, count),
        "guide": guide_torque(side, drho, given.guide_mu, count),
    }
