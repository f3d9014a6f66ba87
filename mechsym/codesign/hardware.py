"""What a co-designed hinge is made of: gas spring, tracks and rollers, and what they may be asked.

z = c (rho0 - rho)      closing of the spring, moved by c rollers on tracks that turn with the shaft
F, U                    force of the spring on each roller and the energy it stores
m_h                     mass that moves with each roller: roller, pin, half of the spring's piston
"""

from typing import Any

from mechsym.hinge.springs import absolute_pressure
from mechsym.quantities import choice, quantity, record


@record
class Hardware:
    """One guide with its spring and rollers; a second spring has a second one like it."""

    law: str = choice("air_absolute", "air_gauge", default="air_absolute", about="what follows the polytrope")
    A: float = quantity("m^2", above=0, about="piston area of the spring")
    H: float = quantity("m", above=0, about="free height of the gas column")
    n: float = quantity("-", above=1, high=2, about="polytropic index")
    pa: float = quantity("Pa", default=101325.0, low=0, about="pressure outside")
    p0: float = quantity("Pa", above=0, about="excess pressure at free height to start from")
    rho0: float = quantity("m", above=0, about="roller centre to shaft axis at free height")
    z_margin: float = quantity("m", default=0.0, low=0, about="smallest closing")
    count: int = 2  #: rollers c that move the spring
    shaft_ratio: float = quantity("-", default=1.0, above=0, about="turns of the guide's shaft per turn of the crank")
    radius: float = quantity("m", above=0, about="roller radius")
    width: float = quantity("m", above=0, about="width of contact")
    E: float = quantity("Pa", default=2.06e11, above=0, about="Young's modulus of roller and track")
    nu: float = quantity("-", default=0.3, low=0, high=0.5, about="Poisson's ratio of roller and track")
    moving_mass: float = quantity("kg", default=0.0, low=0, about="mass that moves with each roller")
    roller_inertia: float = quantity("kg*m^2", default=0.0, low=0, about="inertia of a roller about its pin")


@record
class Bounds:
    """What spring, track and rollers may be asked, as `[limits]` of a case says."""

    spring_pressure: float = quantity("Pa", above=0, about="excess pressure in the spring")
    closing_share: float = quantity("-", above=0, high=1, about="closing over free height, z / H")
    pressure_angle: float = quantity("rad", above=0, below=1.57, about="pressure angle")
    profile_radius: float = quantity("m", low=0, about="radius of the profile where it bulges towards the roller")
    roller_reaction: float = quantity("N", above=0, about="contact force on a roller")
    hertz_stress: float = quantity("Pa", above=0, about="contact pressure")


def outside(hardware: Hardware) -> float:
    """Pressure that is added to the excess pressure on the polytrope [Pa]: of the paper's gauge law it is 0."""
    return hardware.pa if hardware.law == "air_absolute" else 0.0


def gas_pressure(z: Any, p0: Any, H: Any, n: float, pa: float) -> Any:
    """Excess pressure [Pa] of a closed gas spring; pa = 0 [Pa] gives the law as the paper prints it, z and H in [m]."""
    return absolute_pressure(z, H, p0, n, pa)


def gas_energy(z: Any, p0: Any, H: Any, n: float, pa: float) -> Any:
    r"""Energy of a closed gas spring by piston area; floats, arrays and CasADi symbols.

    .. math:: \frac{U}{A} = \frac{(p_0 + p_a) H}{n - 1}\left[\left(\frac{H}{H - z}\right)^{n - 1} - 1\right] - p_a z

    Parameters
    ----------
    z, H : float, ndarray or casadi.SX
        Closing and free height [m]
    p0 : float or casadi.SX
        Excess pressure at z = 0 [Pa]
    n : float
        Polytropic index, above 1 [-]
    pa : float
        Pressure outside; 0 gives the law as the paper prints it [Pa]

    Returns
    -------
    U : same kind as z
        Stored energy by area, 0 at z = 0 [J/m^2]

    Notes
    -----
    Source: Zotov et al. (2024), left side of eq. (10), with pa = 0. It is affine in p0.

    Examples
    --------
    >>> round(0.031 * gas_energy(0.5, 5e6, 1.0, 1.25, 0.0))
    117308
    """
    return (p0 + pa) * H / (n - 1) * ((H / (H - z)) ** (n - 1) - 1) - pa * z


def roller_inertia(rho: Any, drho: Any, mass: Any, inertia: float, radius: Any, count: int) -> Any:
    r"""Inertia that the rollers add to the shaft of the guide.

    .. math:: I_h = c\,(\rho^2 + \rho'^2)\left(m_h + \frac{J_r}{r^2}\right)

    Parameters
    ----------
    rho, drho : ndarray or casadi.SX
        Path of the roller centres [m] and its derivative [m/rad]
    mass : float or casadi.SX
        m_h of each roller [kg]
    inertia : float
        J_r of each roller about its pin [kg*m^2]
    radius : float or casadi.SX
        Of a roller [m]

    Returns
    -------
    I_h : same kind as rho
        About the axis of the guide's shaft [kg*m^2]

    Notes
    -----
    Spring and rollers turn with the shaft and press outwards on tracks around them; the rollers roll without slip.

    Examples
    --------
    >>> round(roller_inertia(0.7, 0.0, 100.0, 0.0, 0.1, 2), 6)
    98.0
    """
    return count * (rho**2 + drho**2) * (mass + inertia / radius**2)


def rollers_at_rest(h: Hardware) -> float:
    """Inertia about the shaft of the rollers of a guide at free height [kg*m^2]."""
    return h.shaft_ratio**2 * float(roller_inertia(h.rho0, 0.0, h.moving_mass, h.roller_inertia, h.radius, h.count))
