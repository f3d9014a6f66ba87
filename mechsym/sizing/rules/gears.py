"""Bending and pitting of spur gears after AGMA 2101, and the face width they need.

    F_t tangential load    b face width    m module    d pitch diameter of the PINION, for both members
    J, I geometry factors for bending and pitting

Source: Nunes (2017), eqs. 2.76 to 2.79 and 4.26 (AGMA 2101-C95, 2001-D04). External and internal pairs differ only in
I (`gear_geometry.py`) and J. AGMA gives no J for internal teeth; an external tooth of the same thickness is safe.

The factors of AGMA 2101 (metric) and 2001 that multiply the tooth load, and the elastic coefficient. Letters of the
source: b face width, d pitch diameter of the pinion, v pitch line velocity, A_v accuracy grade (6 best to 12; the older
quality number is Q_v = 17 - A_v). Source: AGMA 2101 and 2001-D04 as used by Nunes (2017), ch. 4.4; numbers checked
against Budynas and Nisbett, Shigley's Mechanical Engineering Design, example 14-4.

Stress cycle, reliability, temperature and reversal factors of AGMA 2101 and 2001: what a gear bears for how long.

Source: AGMA 2001-D04 as printed in Budynas and Nisbett, Shigley's Mechanical Engineering Design, ch. 14, and used by
Nunes (2017), ch. 4.4.2, who takes 1 for all of them (1e7 cycles, 99 %, below 120 degC, one-sided load).
"""

import functools
from typing import Annotated

import numpy as np

from mechsym.errors import BadInput
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
    factor; S_F: safety factor. Source: Nunes (2017), eq. 2.77.

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

    F_t: tangential load; m: module; J: geometry factor of the member. Source: Nunes (2017), eqs. 2.76 and 2.77.

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


# a, b, c of C_ma = a + b*FW + c*FW^2, FW in mm (AGMA 2101, table for the empirical method)
ENCLOSURES = {
    "open": (2.47e-1, 0.657e-3, -1.186e-7),
    "commercial": (1.27e-1, 0.622e-3, -1.44e-7),
    "precision": (0.675e-1, 0.504e-3, -1.44e-7),
    "extra-precision": (0.380e-1, 0.402e-3, -1.27e-7),
}


def accuracy_exponent(A_v: Pure) -> Pure:
    r"""Exponent of the dynamic factor.

    .. math:: B = 0.25\,(A_v - 5)^{0.667}

    A_v: transmission accuracy grade, 6 to 12. Source: Nunes (2017), eq. 4.27 (AGMA 2001-D04). Valid: 6 <= A_v <= 12.

    >>> accuracy_exponent(6.0)
    0.25
    """
    require("accuracy grade A_v", A_v, "-", low=6, high=12, hint="AGMA gives the dynamic factor for these grades only")
    return 0.25 * (A_v - 5.0) ** 0.667


def dynamic_factor(
    v: MetrePerSecond[Scalar], A_v: Pure, feet: Annotated[float, "ft*s/(min*m)"] = 196.85
) -> Pure[Scalar]:
    r"""Dynamic factor of a mesh.

    .. math:: K_v = \left(\frac{C + \sqrt{196.85\,v}}{C}\right)^B, \qquad C = 50 + 56 (1 - B)

    v: pitch line velocity; of a planet, its speed relative to the carrier. A_v: transmission accuracy grade, 6 to 12.
    feet: feet per minute in one m/s; AGMA 2101-C95 and the text of the source round it to 200. Returns K_v: dynamic
    factor, at least 1. Raises BadInput: faster than the grade allows, v > (C + 14 - A_v)^2 / 200 (eq. 4.29).
    Source: Nunes (2017), eqs. 4.25 to 4.29. Print: the text and tables 4.11 and 4.12 use 200, table 4.10 uses 196.85.

    >>> f"{dynamic_factor(10.891, 6.0):.4f}"  # table 4.10, pinion at 8000 rpm
    '1.1073'
    """
    B = accuracy_exponent(A_v)
    C = 50.0 + 56.0 * (1.0 - B)
    fastest = (C + 14.0 - A_v) ** 2 / 200.0
    require("pitch line velocity v", v, "m/s", low=0, high=fastest, hint="a finer grade A_v allows more")
    return ((C + np.sqrt(feet * v)) / C) ** B


def pinion_proportion_factor(b: Metre, d: Metre) -> Pure:
    r"""Pinion proportion factor.

    .. math:: C_{pf} = \max\left(\frac{b}{10 d}, 0.05\right) - 0.025 \quad (b \le 25\,\mathrm{mm})

    and -0.0375 + 0.000492 b (b in mm) in place of -0.025 up to 432 mm. b: face width, up to 0.432 m and twice d; d:
    pitch diameter of the pinion.
    Source: Nunes (2017), eqs. 4.22 and 4.23 (AGMA 2101-C95). Valid: b <= 2 d, b <= 0.432 m.

    >>> round(pinion_proportion_factor(0.052, 0.026), 6)
    0.188084
    """
    require("pitch diameter d", d, "m", above=0)
    require("face width b", b, "m", above=0, high=min(0.432, 2 * d), hint="the empirical method ends at b = 2 d")
    ratio = max(b / (10 * d), 0.05)
    return ratio - 0.025 if b <= 0.025 else ratio - 0.0375 + 0.492 * b


def mesh_alignment_factor(b: Metre, enclosure: str) -> Pure:
    r"""Mesh alignment factor.

    .. math:: C_{ma} = a + b_1\,FW + c\,FW^2

    b: face width FW.
    Source: Nunes (2017), eq. 4.24 for extra-precision; the other coefficients from AGMA 2101. Valid: b <= 1.02 m.

    >>> round(mesh_alignment_factor(0.052, "extra-precision"), 6)
    0.058561
    """
    require("face width b", b, "m", above=0, high=1.02)
    if enclosure not in ENCLOSURES:
        raise BadInput(f"enclosure = {enclosure!r} is not an option; options are {', '.join(ENCLOSURES)}")
    a, b1, c = ENCLOSURES[enclosure]
    return a + b1 * (b * 1e3) + c * (b * 1e3) ** 2


def load_distribution_factor(b: Metre, d: Metre, C_pm: Pure, enclosure: str, C_e: Pure = 1.0) -> Pure:
    """Load distribution factor of a mesh with unmodified leads.

    .. math:: K_m = 1 + C_{pf} C_{pm} + C_{ma} C_e

    b: face width; d: pitch diameter of the pinion; C_pm: 1 when the pinion stands within 0.175 of the bearing span of
    its middle, else 1.1; C_e: 0.8 when adjusted at assembly or lapped, else 1. Returns K_m: factor, the same for both
    members of the mesh.
    Source: Nunes (2017), eqs. 4.19 to 4.24 (AGMA 2101-C95). Print: the source gives the ring a K_m of its own, made
    with the ring's diameter; the factor belongs to the mesh. Valid: b <= 2 d, members between bearings.

    >>> round(load_distribution_factor(0.052, 0.026, 1.1, "extra-precision", 0.8), 4)  # table 4.10
    1.2537
    """
    require("proportion modifier C_pm", C_pm, "-", low=1.0, high=1.1)
    require("alignment correction C_e", C_e, "-", low=0.8, high=1.0)
    return 1.0 + pinion_proportion_factor(b, d) * C_pm + mesh_alignment_factor(b, enclosure) * C_e


def elastic_coefficient(E_1: Pascal, nu_1: Pure, E_2: Pascal, nu_2: Pure) -> Annotated[float, "Pa^0.5"]:
    r"""Elastic coefficient of two materials.

    .. math:: Z_E = \left[\pi\left(\frac{1 - \nu_1^2}{E_1} + \frac{1 - \nu_2^2}{E_2}\right)\right]^{-1/2}

    E_1, E_2: moduli of elasticity; nu_1, nu_2: Poisson's ratios.
    Source: Nunes (2017), eq. 4.30. Print: table 4.10 gives the number in (N/mm2)^0.5; it is in Pa^0.5.

    >>> f"{elastic_coefficient(200e9, 0.3, 200e9, 0.3):.5g}"
    '1.8703e+05'
    """
    require("modulus of elasticity", [E_1, E_2], "Pa", above=0)
    require("Poisson's ratio", [nu_1, nu_2], "-", low=0, below=0.5)
    return (np.pi * ((1 - nu_1**2) / E_1 + (1 - nu_2**2) / E_2)) ** -0.5


def rim_factor(t_R: Metre, h_t: Metre) -> Pure:
    r"""Rim thickness factor.

    .. math:: K_B = 1.6\ln(2.242\,h_t/t_R) \quad (t_R < 1.2\,h_t), \qquad 1 \text{ else}

    t_R: thickness of the rim below the tooth root; h_t: whole depth of the tooth. Returns K_B: factor, at least 1.
    Source: AGMA 2001-D04, fig. B.1; Nunes (2017), ch. 4.4.2 uses its upper branch. Valid: t_R >= 0.5 h_t.

    >>> rim_factor(3.15e-3, 2.35e-3)
    1.0
    """
    require("whole depth h_t", h_t, "m", above=0)
    require("rim thickness t_R", t_R, "m", low=0.5 * h_t, hint="below half the whole depth AGMA gives no factor")
    return float(1.0 if t_R >= 1.2 * h_t else max(1.0, 1.6 * np.log(2.242 * h_t / t_R)))


# Y_N = a * N^-e below 3e6 cycles (AGMA 2001-D04, bending), by the surface or core that the curve is for
_Y_N = {
    "160 HB": (2.3194, 0.0538), "250 HB": (4.9404, 0.1045), "nitrided": (3.517, 0.0817),
    "carburized": (6.1514, 0.1192), "400 HB": (9.4518, 0.148),
}  # fmt: skip


# a face width is searched for at the same few hundred speeds
@functools.lru_cache(maxsize=4096)
def life_factor_bending(N: Pure, surface: str = "nitrided") -> Pure:
    r"""Stress cycle factor for bending.

    .. math:: Y_N = 1.3558\,N^{-0.0178} \quad (N > 3\cdot10^6)

    N: number of load cycles of one tooth, 1e3 to 1e10. surface: curve below 3e6 cycles: `160 HB`, `250 HB`, `400 HB`,
    `nitrided` or `carburized`. Returns Y_N: factor, about 1 at 1e7 cycles.
    Source: AGMA 2001-D04, fig. 17 (upper curve above 3e6 cycles), as printed in Shigley, fig. 14-14.

    >>> round(life_factor_bending(1e8, "250 HB"), 3)  # Shigley, example 14-4
    0.977
    """
    require("cycles N", N, "-", low=1e3, high=1e10, hint="AGMA draws the stress cycle factor in this range")
    if surface not in _Y_N:
        raise BadInput(f"surface = {surface!r} is not an option; options are {', '.join(_Y_N)}")
    a, e = _Y_N[surface]
    upper = 1.3558 * N**-0.0178
    return float(upper if N > 3e6 else max(a * N**-e, upper))


@functools.lru_cache(maxsize=4096)
def life_factor_contact(N: Pure, surface: str = "nitrided") -> Pure:
    r"""Stress cycle factor for pitting.

    .. math:: Z_N = 1.4488\,N^{-0.023} \quad (N > 10^7)

    N: number of load cycles of one tooth, 1e4 to 1e10. surface: curve below 1e7 cycles: `nitrided` (1.249 N^-0.0138) or
    `steel` (2.466 N^-0.056). Returns Z_N: factor, 1 at 1e7 cycles.
    Source: AGMA 2001-D04, fig. 18 (upper curve above 1e7 cycles), as printed in Shigley, fig. 14-15.

    >>> round(life_factor_contact(1e8, "steel"), 3)  # Shigley, example 14-4
    0.948
    """
    require("cycles N", N, "-", low=1e4, high=1e10, hint="AGMA draws the stress cycle factor in this range")
    curves = {"nitrided": (1.249, 0.0138), "steel": (2.466, 0.056)}
    if surface not in curves:
        raise BadInput(f"surface = {surface!r} is not an option; options are {', '.join(curves)}")
    a, e = curves[surface]
    return float(1.4488 * N**-0.023 if N > 1e7 else a * N**-e)


def reliability_factor(R: Pure) -> Pure:
    r"""Reliability factor.

    .. math:: K_R = 0.658 - 0.0759\ln(1 - R) \ (R < 0.99), \qquad 0.5 - 0.109\ln(1 - R) \ (R \ge 0.99)

    R: reliability, 0.5 to 0.9999. Source: fit of AGMA 2001-D04, table 11, as printed in Shigley, eq. 14-38.

    >>> round(reliability_factor(0.99), 2), round(reliability_factor(0.9999), 2)
    (1.0, 1.5)
    """
    require("reliability R", R, "-", low=0.5, high=0.9999, hint="AGMA has no factor outside this range")
    return float(0.658 - 0.0759 * np.log(1 - R) if R < 0.99 else 0.5 - 0.109 * np.log(1 - R))
