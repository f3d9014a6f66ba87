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
"""

import math
from typing import Any

import casadi as ca
import numpy as np

from mechsym.quantities import choice, quantity, record


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
    rolling_arm: float = quantity("m", default=1e-6, low=0, about="rolling resistance moment over normal force")
    moving_mass: float = quantity("kg", default=0.0, low=0, high=10000, about="mass that moves with each roller")


def pressure_angle(rho: np.ndarray, drho: np.ndarray) -> np.ndarray:
    r"""Angle between the contact normal and the radius.

    .. math:: \tan\alpha = \frac{\rho'}{\rho}

    Parameters
    ----------
    rho, drho : ndarray, shape (n,)
        Path [m] and its derivative [m/rad]

    Returns
    -------
    alpha : ndarray, shape (n,)
        Signed [rad]
    """
    return np.arctan2(drho, rho)


def curvature(rho: np.ndarray, drho: np.ndarray, d2rho: np.ndarray) -> np.ndarray:
    r"""Curvature of the path of the roller centres.

    .. math:: \kappa = \frac{\rho^2 + 2\rho'^2 - \rho\rho''}{(\rho^2 + \rho'^2)^{3/2}}

    Parameters
    ----------
    rho, drho, d2rho : ndarray, shape (n,)
        Path [m] and its derivatives [m/rad], [m/rad^2]

    Returns
    -------
    kappa : ndarray, shape (n,)
        Positive around the shaft axis, negative where the path bends inwards [1/m]
    """
    square = rho**2 + drho**2
    return (square + drho**2 - rho * d2rho) / (square * _root(square))


def parallel(rho: np.ndarray, drho: np.ndarray, theta: np.ndarray, distance: float) -> tuple[np.ndarray, np.ndarray]:
    r"""Exact parallel curve outside the path: the cut profile at the roller radius, the path of a cutter nearer.

    .. math:: P = \rho\,e_r + d\,n, \qquad n = \frac{\rho\,e_r - \rho'\,e_\theta}{\sqrt{\rho^2 + \rho'^2}}

    Parameters
    ----------
    rho, drho : ndarray, shape (n,)
        Path [m] and its derivative [m/rad]
    theta : ndarray, shape (n,)
        Angle of the guide's shaft [rad]
    distance : float
        d: roller radius for the profile, roller radius minus cutter radius for the centre of a cutter [m]

    Returns
    -------
    x, y : ndarray, shape (n,)
        In the frame of the track, x along theta = 0 [m]

    Notes
    -----
    A change of rho by the roller radius is not this curve: it misses by the pressure angle.
    """
    s = np.hypot(rho, drho)
    along, across = rho + distance * rho / s, -distance * drho / s
    return along * np.cos(theta) - across * np.sin(theta), along * np.sin(theta) + across * np.cos(theta)


def profile_curvature(kappa: np.ndarray, radius: float) -> np.ndarray:
    r"""Curvature of the cut profile.

    .. math:: \kappa_p = \frac{\kappa}{1 + r\kappa}

    Parameters
    ----------
    kappa : ndarray, shape (n,)
        Curvature of the path, with 1 + r kappa > 0 [1/m]
    radius : float
        Roller radius r [m]

    Returns
    -------
    kappa_p : ndarray, shape (n,)
        Positive where the track is hollow, negative where it bulges towards the roller [1/m]
    """
    return kappa / (1 + radius * kappa)


def _root(value: Any) -> Any:
    return ca.sqrt(value) if isinstance(value, ca.SX | ca.MX) else np.sqrt(value)


def length(a: Any, b: Any) -> Any:
    """Root of the sum of squares, for numbers, arrays and CasADi symbols alike [unit of a]."""
    symbols = isinstance(a, ca.SX | ca.MX) or isinstance(b, ca.SX | ca.MX)
    return ca.hypot(a, b) if symbols else np.hypot(a, b)


def reaction(force: Any, rho: Any, drho: Any) -> Any:
    r"""Contact force of a massless roller on its track, N1 and N2 of the source.

    .. math:: N = \frac{F}{\cos\alpha} = F\sqrt{1 + (\rho'/\rho)^2}

    Parameters
    ----------
    force : ndarray, shape (n,), or casadi.SX
        Spring force F [N]
    rho, drho : ndarray, shape (n,), or casadi.SX
        Path [m] and its derivative [m/rad]

    Returns
    -------
    N : ndarray, shape (n,)
        Along the normal; both rollers of a pair carry the same [N]

    Notes
    -----
    Virtual work: the tangential part N sin(alpha) at the radius rho is F drho/dtheta for each roller.
    """
    return force * _root(1 + (drho / rho) ** 2)


def hertz_stress(N: np.ndarray, kappa: np.ndarray, rollers: RollerParameters) -> np.ndarray:
    r"""Largest pressure in the line contact of roller and track.

    .. math:: p_H = \sqrt{\frac{N E^*}{\pi\,w\,R_e}}, \qquad E^* = \frac{E}{2(1 - \nu^2)}, \qquad
              \frac1{R_e} = \frac1r - \frac{\kappa}{1 + r\kappa} = \frac1{r\,(1 + r\kappa)}

    Parameters
    ----------
    N : ndarray, shape (n,)
        Contact force [N]
    kappa : ndarray, shape (n,)
        Curvature of the path [1/m]

    Returns
    -------
    p_H : ndarray, shape (n,)
        Pressure in the middle of the contact; infinite where the profile is undercut, 0 where nothing presses [Pa]

    Notes
    -----
    Source: K. L. Johnson, Contact Mechanics (1985), section 4.2(c), load per unit width N / w. Valid: both bodies of
    one material, contact much narrower than r, no edge loading.
    """
    modulus = rollers.E / (2 * (1 - rollers.nu**2))
    relative_radius = rollers.radius * np.maximum(1 + rollers.radius * kappa, 0.0)
    with np.errstate(divide="ignore"):
        return np.sqrt(np.maximum(N, 0.0) * modulus / (math.pi * rollers.width * relative_radius))


def tilting_couple(N: np.ndarray, plane_offset: float) -> np.ndarray:
    r"""Couple that tilts two tracks in offset planes.

    .. math:: C = N b

    Parameters
    ----------
    N : ndarray, shape (n,)
        Contact force of each roller; the two are opposite and b apart along the shaft [N]
    plane_offset : float
        Distance b of the planes [m]

    Returns
    -------
    C : ndarray, shape (n,)
        About an axis across the shaft, turning with the spring; the bearings of the hinge carry it [N*m]
    """
    return N * plane_offset


def loss_torque(N: Any, rho: Any, drho: Any, rollers: RollerParameters) -> Any:
    r"""Torque that rolling resistance of one roller takes from the guide's shaft.

    .. math:: M_f = \frac{f N}{r}\,\sqrt{\rho^2 + \rho'^2}

    Parameters
    ----------
    N : ndarray, shape (n,), or casadi.SX
        Contact force [N]
    rho, drho : ndarray, shape (n,), or casadi.SX
        Path [m] and its derivative [m/rad]
    rollers : RollerParameters
        Friction by name; 0 for `none`

    Returns
    -------
    M_f : ndarray, shape (n,)
        Against the rotation [N*m]

    Notes
    -----
    A roller whose centre moves by ds turns by ds / r against the track and loses f N ds / r. f is 1e-6 m in the source.
    """
    if rollers.friction == "none":
        return np.zeros(N.shape)
    return rollers.rolling_arm * N / rollers.radius * length(rho, drho)


def inertia_force(rho: Any, d2rho: Any, omega: Any) -> Any:
    r"""Radial force for each kilogram that moves with a roller: what the massless model leaves out.

    .. math:: f = \omega_\theta^2\,(\rho - \rho'')

    Parameters
    ----------
    rho, d2rho : ndarray, shape (n,), or casadi.SX
        Path [m] and its second derivative [m/rad^2]
    omega : float or casadi.SX
        Speed of the guide's shaft [rad/s]

    Returns
    -------
    f : ndarray, shape (n,)
        Outwards, for a spring that turns with the shaft; without the term rho if the tracks turn instead [N/kg]
    """
    return omega**2 * (rho - d2rho)
