r"""What spring, track and rollers allow, as constraints of the programme: each a ratio to its limit.

.. math:: N = \left[F + m_h \omega^2 (\rho - \rho'')\right] \sqrt{1 + (\rho'/\rho)^2}, \qquad
          p_H^2 = \frac{N E^*}{\pi w r (1 + r \kappa)}

Rollers that turn with the shaft inside the track are pressed outwards by their own mass too.
"""

import math
from typing import Any

import casadi as ca
import numpy as np

from mechsym.codesign.hardware import Bounds, Hardware, gas_pressure, outside
from mechsym.codesign.task import Track
from mechsym.quantities import record

_FINE = 720  # angles of a turn on which a finished guide is looked at


@record
class Path:
    """Path of the roller centres on the angles of the programme, symbols or arrays of shape (n,)."""

    z: Any  #: closing of the spring [m]
    rho: Any  #: shaft axis to roller centre [m]
    drho: Any  #: its derivative by the angle of the guide's shaft [m/rad]
    d2rho: Any  #: and the second [m/rad^2]


def path_of(hardware: Hardware, rho0: Any, z: Any, dz: Any, d2z: Any) -> Path:
    """Path of the rollers of a closing z [m] and its derivatives by the crank angle [m/rad, m/rad^2]; rho0 in [m]."""
    c, ratio = hardware.count, hardware.shaft_ratio
    return Path(z=z, rho=rho0 - z / c, drho=-dz / (c * ratio), d2rho=-d2z / (c * ratio**2))


def fine_path(track: Track, period: float) -> tuple[np.ndarray, Path]:
    """Even angles [rad] of a turn and the path of a guide there."""
    phi = np.arange(round(_FINE * period / (2 * np.pi))) * 2 * np.pi / _FINE
    z, h = track.z(phi), track.hardware
    return phi, path_of(h, h.rho0, z, track.z.derivative()(phi), track.z.derivative(2)(phi))


def curvature(path: Path) -> Any:
    r"""Curvature of the path of the roller centres, positive for a circle around the shaft.

    .. math:: \kappa = \frac{\rho^2 + 2\rho'^2 - \rho\rho''}{(\rho^2 + \rho'^2)^{3/2}}

    Returns
    -------
    kappa : same kind as the path
        [1/m]

    Notes
    -----
    The same text as `mechsym.hinge.rollers.curvature`, for symbols too.
    """
    rho, drho = path.rho, path.drho
    return (rho**2 + 2 * drho**2 - rho * path.d2rho) / (rho**2 + drho**2) ** 1.5


def contact_force(path: Path, force: Any, mass: Any, omega: float) -> Any:
    r"""Contact force of a roller that has mass.

    .. math:: N = \left[F + m_h \omega^2 (\rho - \rho'')\right] \sqrt{1 + (\rho'/\rho)^2}

    Parameters
    ----------
    force : same kind
        Of the spring on each roller [N]
    mass : float or casadi.SX
        m_h [kg]
    omega : float
        Speed of the guide's shaft [rad/s]

    Returns
    -------
    N : same kind
        Along the normal of the track [N]

    Notes
    -----
    The torque of the track on the shaft is N sin(alpha) rho less the Coriolis force on the spring's guide; together
    they are F rho' - omega^2 I_h'/2 for each roller. Without the traction that J_r asks for.
    """
    return (force + mass * omega**2 * (path.rho - path.d2rho)) * (1 + (path.drho / path.rho) ** 2) ** 0.5


def ratios(path: Path, hardware: Hardware, bounds: Bounds, p0: Any, omega: float, free: dict[str, Any]) -> dict:
    """Each limit as (values over the limit or over its scale, lowest, highest); see `LIMITS` for names and units.

    Parameters
    ----------
    p0 : float or casadi.SX
        Excess pressure at free height [Pa]
    omega : float
        Speed of the guide's shaft [rad/s]
    free : dict
        Numbers or symbols of the hardware: A [m^2], H [m], radius [m], width [m], moving_mass [kg]
    """
    r, H = free["radius"], free["H"]
    pressure = gas_pressure(path.z, p0, H, hardware.n, outside(hardware))
    kappa = curvature(path)
    N = contact_force(path, free["A"] * pressure, free["moving_mass"], omega)
    modulus = hardware.E / (2 * (1 - hardware.nu**2))
    slope, steep = path.drho / path.rho, ca.tan(bounds.pressure_angle)
    return {
        "free_height": ((path.z - hardware.z_margin) / H, 0.0, np.inf),
        "closing": (path.z / (bounds.closing_share * H), -np.inf, 1.0),
        "pressure_angle": (ca.vertcat(slope, -slope) / steep, -np.inf, 1.0),
        "undercut": (-kappa * (r + bounds.profile_radius), -np.inf, 1.0),
        "spring_pressure": (pressure / bounds.spring_pressure, -np.inf, 1.0),
        "roller_reaction": (N / bounds.roller_reaction, 0.0, 1.0),
        "hertz_stress": (
            N * modulus / (math.pi * free["width"] * r * bounds.hertz_stress**2) - (r * kappa), -np.inf, 1.0
        ),
        "centre": (r / path.rho, -np.inf, 1.0),
    }  # fmt: skip


#: limit: (key of `Bounds` that a multiplier belongs to, its unit, what one such unit is called)
LIMITS = {
    "free_height": ("z_margin", "m"),
    "closing": ("closing_share", "-"),
    "pressure_angle": ("pressure_angle", "rad"),
    "undercut": ("profile_radius", "m"),
    "spring_pressure": ("spring_pressure", "Pa"),
    "roller_reaction": ("roller_reaction", "N"),
    "hertz_stress": ("hertz_stress", "Pa"),
    "centre": ("radius", "m"),
}
