"""Bending and pitting of spur gears after AGMA 2101, and the face width they need.

    F_t tangential load    b face width    m module    d pitch diameter of the PINION, for both members
    J, I geometry factors for bending and pitting

Source: Nunes (2017), eqs. 2.76 to 2.79 and 4.26 (AGMA 2101-C95, 2001-D04). External and internal pairs differ only in
I (`gear_geometry.py`) and J. AGMA gives no J for internal teeth; an external tooth of the same thickness is safe.
"""

from typing import Any

import numpy as np

from mechsym.quantities import quantity, record
from mechsym.sizing.checks import require


@record
class LoadFactors:
    """Factors that multiply the tangential load."""

    K_o: float = quantity("-", default=1.0, low=1, about="overload")
    K_v: float = quantity("-", default=1.0, low=1, about="dynamic")
    K_s: float = quantity("-", default=1.0, low=1, about="size")
    K_m: float = quantity("-", default=1.0, low=1, about="load distribution")
    K_B: float = quantity("-", default=1.0, low=1, about="rim thickness, bending only")
    C_f: float = quantity("-", default=1.0, low=1, about="surface condition, pitting only")


def mesh_speed(d: float, omega: Any) -> Any:
    r"""Pitch line velocity of a hypocycloid's planet relative to its carrier.

    .. math:: v = \tfrac12 d\,(2\omega) = d\,\omega

    Parameters
    ----------
    d : float
        Pitch diameter of the planet [m]
    omega : float or ndarray
        Crank speed; the planet turns by -omega, the carrier by omega [rad/s]

    Returns
    -------
    v : float or ndarray
        Velocity, the same for planet and ring [m/s]

    Notes
    -----
    Print: Nunes (2017), eq. 4.26 with the planet's diameter and the crank speed gives half of this.

    Examples
    --------
    >>> f"{mesh_speed(0.026, 837.758):.2f}"
    '21.78'
    """
    require("pitch diameter d", d, "m", above=0)
    return d * np.abs(omega)


def bending_stress(F_t: float, b: float, m: float, J: float, factors: LoadFactors) -> float:
    r"""Bending stress number at the tooth root.

    .. math:: \sigma_F = F_t K_o K_v K_s \frac{1}{b\,m}\frac{K_m K_B}{J}

    Parameters
    ----------
    F_t : float
        Tangential load [N]
    b : float
        Face width [m]
    m : float
        Module [m]
    J : float
        Geometry factor of the member [-]

    Returns
    -------
    sigma_F : float
        Stress [Pa]

    Notes
    -----
    Source: Nunes (2017), eq. 2.76 (AGMA 2101-C95).

    Examples
    --------
    >>> round(bending_stress(9368.4, 0.052, 0.001, 0.5385, LoadFactors()) / 1e6, 1)
    334.6
    """
    return face_width_bending(F_t, m, J, 1.0, factors) / _width(b)


def contact_stress(F_t: float, b: float, d: float, I: float, Z_E: float, factors: LoadFactors) -> float:
    r"""Contact stress number on the tooth flank.

    .. math:: \sigma_H = Z_E\sqrt{F_t K_o K_v K_s \frac{K_m}{d\,b}\frac{C_f}{I}}

    Parameters
    ----------
    F_t : float
        Tangential load [N]
    b : float
        Face width [m]
    d : float
        Pitch diameter of the pinion [m]
    I : float
        Geometry factor of the pair [-]
    Z_E : float
        Elastic coefficient [Pa^0.5]

    Returns
    -------
    sigma_H : float
        Stress [Pa]

    Notes
    -----
    Source: Nunes (2017), eq. 2.78 (AGMA 2101-C95). Print: the source puts the ring's diameter for the ring.

    Examples
    --------
    >>> round(contact_stress(9368.4 / 2, 0.039, 0.026, 0.1278, 187030.0, LoadFactors()) / 1e6)
    1124
    """
    return np.sqrt(face_width_contact(F_t, d, I, Z_E, 1.0, factors) / _width(b))


def bending_limit(sigma_FP: float, Y_N: float = 1.0, S_F: float = 1.0, K_T: float = 1.0, K_R: float = 1.0) -> float:
    r"""Bending stress number that a tooth may have.

    .. math:: \sigma_F \le \frac{\sigma_{FP} Y_N}{S_F K_T K_R}

    Parameters
    ----------
    sigma_FP : float
        Allowable bending stress number of the material [Pa]
    Y_N, K_T, K_R : float
        Stress cycle, temperature and reliability factor [-]
    S_F : float
        Safety factor [-]

    Returns
    -------
    limit : float
        Limit [Pa]

    Notes
    -----
    Source: Nunes (2017), eq. 2.77.

    Examples
    --------
    >>> bending_limit(454.7125e6)
    454712500.0
    """
    require("allowable stress sigma_FP", sigma_FP, "Pa", above=0)
    require("Y_N, S_F, K_T, K_R", [Y_N, S_F, K_T, K_R], "-", above=0)
    return sigma_FP * Y_N / (S_F * K_T * K_R)


def contact_limit(
    sigma_HP: float, Z_N: float = 1.0, S_H: float = 1.0, C_H: float = 1.0, K_T: float = 1.0, K_R: float = 1.0
) -> float:
    r"""Contact stress number that a flank may have.

    .. math:: \sigma_H \le \frac{\sigma_{HP} Z_N C_H}{S_H K_T K_R}

    Parameters
    ----------
    sigma_HP : float
        Allowable contact stress number of the material [Pa]
    Z_N, C_H, K_T, K_R : float
        Stress cycle, hardness ratio, temperature and reliability factor [-]
    S_H : float
        Safety factor against the stress; against the load it is S_H^2 [-]

    Returns
    -------
    limit : float
        Limit [Pa]

    Notes
    -----
    Source: Nunes (2017), eq. 2.79.

    Examples
    --------
    >>> contact_limit(1300e6)
    1300000000.0
    """
    require("allowable stress sigma_HP", sigma_HP, "Pa", above=0)
    require("Z_N, S_H, C_H, K_T, K_R", [Z_N, S_H, C_H, K_T, K_R], "-", above=0)
    return sigma_HP * Z_N * C_H / (S_H * K_T * K_R)


def face_width_bending(F_t: float, m: float, J: float, limit: float, factors: LoadFactors) -> float:
    r"""Face width that keeps the bending stress at its limit.

    .. math:: b = F_t K_o K_v K_s \frac{K_m K_B}{m\,J\,\sigma_F}

    Parameters
    ----------
    F_t : float
        Tangential load [N]
    m : float
        Module [m]
    J : float
        Geometry factor of the member [-]
    limit : float
        From `bending_limit` [Pa]

    Returns
    -------
    b : float
        Face width [m]

    Notes
    -----
    Source: Nunes (2017), eqs. 2.76 and 2.77.

    Examples
    --------
    >>> round(face_width_bending(9368.4, 0.001, 0.4385, 454.7125e6, LoadFactors()) * 1e3, 2)
    46.98
    """
    require("tangential load F_t", F_t, "N", low=0, hint="give its magnitude")
    require("module m", m, "m", above=0)
    require("geometry factor J", J, "-", above=0, below=1)
    require("limit", limit, "Pa", above=0)
    return F_t * factors.K_o * factors.K_v * factors.K_s * factors.K_m * factors.K_B / (m * J * limit)


def face_width_contact(F_t: float, d: float, I: float, Z_E: float, limit: float, factors: LoadFactors) -> float:
    r"""Face width that keeps the contact stress at its limit.

    .. math:: b = F_t K_o K_v K_s \frac{K_m C_f}{d\,I}\left(\frac{Z_E}{\sigma_H}\right)^2

    Parameters
    ----------
    F_t : float
        Tangential load [N]
    d : float
        Pitch diameter of the pinion [m]
    I : float
        Geometry factor of the pair [-]
    Z_E : float
        Elastic coefficient [Pa^0.5]
    limit : float
        From `contact_limit` [Pa]

    Returns
    -------
    b : float
        Face width [m]

    Notes
    -----
    Source: Nunes (2017), eqs. 2.78 and 2.79.

    Examples
    --------
    >>> round(face_width_contact(9368.4, 0.026, 0.1168, 187030.0, 1300e6, LoadFactors()) * 1e3, 2)
    63.85
    """
    require("tangential load F_t", F_t, "N", low=0, hint="give its magnitude")
    require("pitch diameter d", d, "m", above=0)
    require("geometry factor I", I, "-", above=0, below=1)
    require("Z_E and limit", [Z_E, limit], "-", above=0)
    return F_t * factors.K_o * factors.K_v * factors.K_s * factors.K_m * factors.C_f / (d * I) * (Z_E / limit) ** 2


def _width(b):
    require("face width b", b, "m", above=0)
    return b
