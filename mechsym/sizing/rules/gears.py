"""Bending and pitting of spur gears after AGMA 2101, and the face width they need.

    F_t tangential load    b face width    m module    d pitch diameter of the PINION, for both members
    J, I geometry factors for bending and pitting

Source: Nunes (2017), eqs. 2.76 to 2.79 and 4.26 (AGMA 2101-C95, 2001-D04). External and internal pairs differ only in
I (`gear_geometry.py`) and J. AGMA gives no J for internal teeth; an external tooth of the same thickness is safe.
"""

from typing import Annotated

import numpy as np

from mechsym.quantities import quantity, record
from mechsym.quantities.units import Metre, MetrePerSecond, Newton, Pascal, Pure, RadPerSecond, Scalar
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


def mesh_speed(d: Metre, omega: RadPerSecond[Scalar]) -> MetrePerSecond[Scalar]:
    r"""Pitch line velocity of a hypocycloid's planet relative to its carrier.

    .. math:: v = \tfrac12 d\,(2\omega) = d\,\omega

    d: pitch diameter of the planet. omega: crank speed; the planet turns by -omega, the carrier by omega. Returns v:
    velocity, the same for planet and ring. Print: Nunes (2017), eq. 4.26 with the planet's diameter and the crank speed
    gives half of this.

    >>> f"{mesh_speed(0.026, 837.758):.2f}"
    '21.78'
    """
    require("pitch diameter d", d, "m", above=0)
    return d * np.abs(omega)


def bending_limit(sigma_FP: Pascal, Y_N: Pure = 1.0, S_F: Pure = 1.0, K_T: Pure = 1.0, K_R: Pure = 1.0) -> Pascal:
    r"""Bending stress number that a tooth may have.

    .. math:: \sigma_F \le \frac{\sigma_{FP} Y_N}{S_F K_T K_R}

    sigma_FP: allowable bending stress number of the material; Y_N, K_T, K_R: stress cycle, temperature and reliability
    factor; S_F: safety factor.
    Source: Nunes (2017), eq. 2.77.

    >>> bending_limit(454.7125e6)
    454712500.0
    """
    require("allowable stress sigma_FP", sigma_FP, "Pa", above=0)
    require("Y_N, S_F, K_T, K_R", [Y_N, S_F, K_T, K_R], "-", above=0)
    return sigma_FP * Y_N / (S_F * K_T * K_R)


def contact_limit(
    sigma_HP: Pascal, Z_N: Pure = 1.0, S_H: Pure = 1.0, C_H: Pure = 1.0, K_T: Pure = 1.0, K_R: Pure = 1.0
) -> Pascal:
    r"""Contact stress number that a flank may have.

    .. math:: \sigma_H \le \frac{\sigma_{HP} Z_N C_H}{S_H K_T K_R}

    sigma_HP: allowable contact stress number of the material. Z_N, C_H, K_T, K_R: stress cycle, hardness ratio,
    temperature and reliability factor. S_H: safety factor against the stress; against the load it is S_H^2.
    Source: Nunes (2017), eq. 2.79.

    >>> contact_limit(1300e6)
    1300000000.0
    """
    require("allowable stress sigma_HP", sigma_HP, "Pa", above=0)
    require("Z_N, S_H, C_H, K_T, K_R", [Z_N, S_H, C_H, K_T, K_R], "-", above=0)
    return sigma_HP * Z_N * C_H / (S_H * K_T * K_R)


def face_width_bending(F_t: Newton, m: Metre, J: Pure, limit: Pascal, factors: LoadFactors) -> Metre:
    r"""Face width that keeps the bending stress at its limit.

    .. math:: b = F_t K_o K_v K_s \frac{K_m K_B}{m\,J\,\sigma_F}

    F_t: tangential load; m: module; J: geometry factor of the member.
    Source: Nunes (2017), eqs. 2.76 and 2.77.

    >>> round(face_width_bending(9368.4, 0.001, 0.4385, 454.7125e6, LoadFactors()) * 1e3, 2)
    46.98
    """
    require("tangential load F_t", F_t, "N", low=0, hint="give its magnitude")
    require("module m", m, "m", above=0)
    require("geometry factor J", J, "-", above=0, below=1)
    require("limit", limit, "Pa", above=0)
    return F_t * factors.K_o * factors.K_v * factors.K_s * factors.K_m * factors.K_B / (m * J * limit)


def face_width_contact(
    F_t: Newton, d: Metre, I: Pure, Z_E: Annotated[float, "Pa^0.5"], limit: Pascal, factors: LoadFactors
) -> Metre:
    r"""Face width that keeps the contact stress at its limit.

    .. math:: b = F_t K_o K_v K_s \frac{K_m C_f}{d\,I}\left(\frac{Z_E}{\sigma_H}\right)^2

    F_t: tangential load; d: pitch diameter of the pinion; I: geometry factor of the pair; Z_E: elastic coefficient.
    Source: Nunes (2017), eqs. 2.78 and 2.79.

    >>> round(face_width_contact(9368.4, 0.026, 0.1168, 187030.0, 1300e6, LoadFactors()) * 1e3, 2)
    63.85
    """
    require("tangential load F_t", F_t, "N", low=0, hint="give its magnitude")
    require("pitch diameter d", d, "m", above=0)
    require("geometry factor I", I, "-", above=0, below=1)
    require("Z_E and limit", [Z_E, limit], "-", above=0)
    return F_t * factors.K_o * factors.K_v * factors.K_s * factors.K_m * factors.C_f / (d * I) * (Z_E / limit) ** 2
