"""The factors of AGMA 2101 (metric) and 2001 that multiply the tooth load, and the elastic coefficient.

Letters of the source: b face width, d pitch diameter of the pinion, v pitch line velocity, A_v accuracy grade
(6 best to 12; the older quality number is Q_v = 17 - A_v).
Source: AGMA 2101 and 2001-D04 as used by Nunes (2017), ch. 4.4; numbers checked against Budynas and Nisbett,
Shigley's Mechanical Engineering Design, example 14-4.
"""

from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.sizing.checks import require

# a, b, c of C_ma = a + b*FW + c*FW^2, FW in mm (AGMA 2101, table for the empirical method)
ENCLOSURES = {
    "open": (2.47e-1, 0.657e-3, -1.186e-7),
    "commercial": (1.27e-1, 0.622e-3, -1.44e-7),
    "precision": (0.675e-1, 0.504e-3, -1.44e-7),
    "extra-precision": (0.380e-1, 0.402e-3, -1.27e-7),
}


def accuracy_exponent(A_v: float) -> float:
    r"""Exponent of the dynamic factor.

    .. math:: B = 0.25\,(A_v - 5)^{0.667}

    Parameters
    ----------
    A_v : float
        Transmission accuracy grade, 6 to 12 [-]

    Returns
    -------
    B : float
        Exponent [-]

    Notes
    -----
    Source: Nunes (2017), eq. 4.27 (AGMA 2001-D04). Valid: 6 <= A_v <= 12.

    Examples
    --------
    >>> accuracy_exponent(6.0)
    0.25
    """
    require("accuracy grade A_v", A_v, "-", low=6, high=12, hint="AGMA gives the dynamic factor for these grades only")
    return 0.25 * (A_v - 5.0) ** 0.667


def dynamic_factor(v: Any, A_v: float, feet: float = 196.85) -> Any:
    r"""Dynamic factor of a mesh.

    .. math:: K_v = \left(\frac{C + \sqrt{196.85\,v}}{C}\right)^B, \qquad C = 50 + 56 (1 - B)

    Parameters
    ----------
    v : float or ndarray
        Pitch line velocity; of a planet, its speed relative to the carrier [m/s]
    A_v : float
        Transmission accuracy grade, 6 to 12 [-]
    feet : float
        Feet per minute in one m/s; AGMA 2101-C95 and the text of the source round it to 200 [ft*s/(min*m)]

    Returns
    -------
    K_v : float or ndarray
        Dynamic factor, at least 1 [-]

    Raises
    ------
    BadInput
        Faster than the grade allows, v > (C + 14 - A_v)^2 / 200 (eq. 4.29)

    Notes
    -----
    Source: Nunes (2017), eqs. 4.25 to 4.29. Print: the text and tables 4.11 and 4.12 use 200, table 4.10 uses 196.85.

    Examples
    --------
    >>> f"{dynamic_factor(10.891, 6.0):.4f}"  # table 4.10, pinion at 8000 rpm
    '1.1073'
    """
    B = accuracy_exponent(A_v)
    C = 50.0 + 56.0 * (1.0 - B)
    fastest = (C + 14.0 - A_v) ** 2 / 200.0
    require("pitch line velocity v", v, "m/s", low=0, high=fastest, hint="a finer grade A_v allows more")
    return ((C + np.sqrt(feet * v)) / C) ** B


def pinion_proportion_factor(b: float, d: float) -> float:
    r"""Pinion proportion factor.

    .. math:: C_{pf} = \max\left(\frac{b}{10 d}, 0.05\right) - 0.025 \quad (b \le 25\,\mathrm{mm})

    and -0.0375 + 0.000492 b (b in mm) in place of -0.025 up to 432 mm.

    Parameters
    ----------
    b : float
        Face width, up to 0.432 m and twice d [m]
    d : float
        Pitch diameter of the pinion [m]

    Returns
    -------
    C_pf : float
        Factor [-]

    Notes
    -----
    Source: Nunes (2017), eqs. 4.22 and 4.23 (AGMA 2101-C95). Valid: b <= 2 d, b <= 0.432 m.

    Examples
    --------
    >>> round(pinion_proportion_factor(0.052, 0.026), 6)
    0.188084
    """
    require("pitch diameter d", d, "m", above=0)
    require("face width b", b, "m", above=0, high=min(0.432, 2 * d), hint="the empirical method ends at b = 2 d")
    ratio = max(b / (10 * d), 0.05)
    return ratio - 0.025 if b <= 0.025 else ratio - 0.0375 + 0.492 * b


def mesh_alignment_factor(b: float, enclosure: str) -> float:
    r"""Mesh alignment factor.

    .. math:: C_{ma} = a + b_1\,FW + c\,FW^2

    Parameters
    ----------
    b : float
        Face width FW [m]

    Returns
    -------
    C_ma : float
        Factor [-]

    Notes
    -----
    Source: Nunes (2017), eq. 4.24 for extra-precision; the other coefficients from AGMA 2101. Valid: b <= 1.02 m.

    Examples
    --------
    >>> round(mesh_alignment_factor(0.052, "extra-precision"), 6)
    0.058561
    """
    require("face width b", b, "m", above=0, high=1.02)
    if enclosure not in ENCLOSURES:
        raise BadInput(f"enclosure = {enclosure!r} is not an option; options are {', '.join(ENCLOSURES)}")
    a, b1, c = ENCLOSURES[enclosure]
    return a + b1 * (b * 1e3) + c * (b * 1e3) ** 2


def load_distribution_factor(b: float, d: float, C_pm: float, enclosure: str, C_e: float = 1.0) -> float:
    r"""Load distribution factor of a mesh with unmodified leads.

    .. math:: K_m = 1 + C_{pf} C_{pm} + C_{ma} C_e

    Parameters
    ----------
    b : float
        Face width [m]
    d : float
        Pitch diameter of the pinion [m]
    C_pm : float
        1 when the pinion stands within 0.175 of the bearing span of its middle, else 1.1 [-]
    C_e : float
        0.8 when adjusted at assembly or lapped, else 1 [-]

    Returns
    -------
    K_m : float
        Factor, the same for both members of the mesh [-]

    Notes
    -----
    Source: Nunes (2017), eqs. 4.19 to 4.24 (AGMA 2101-C95). Print: the source gives the ring a K_m of its own, made
    with the ring's diameter; the factor belongs to the mesh. Valid: b <= 2 d, members between bearings.

    Examples
    --------
    >>> round(load_distribution_factor(0.052, 0.026, 1.1, "extra-precision", 0.8), 4)  # table 4.10
    1.2537
    """
    require("proportion modifier C_pm", C_pm, "-", low=1.0, high=1.1)
    require("alignment correction C_e", C_e, "-", low=0.8, high=1.0)
    return 1.0 + pinion_proportion_factor(b, d) * C_pm + mesh_alignment_factor(b, enclosure) * C_e


def elastic_coefficient(E_1: float, nu_1: float, E_2: float, nu_2: float) -> float:
    r"""Elastic coefficient of two materials.

    .. math:: Z_E = \left[\pi\left(\frac{1 - \nu_1^2}{E_1} + \frac{1 - \nu_2^2}{E_2}\right)\right]^{-1/2}

    Parameters
    ----------
    E_1, E_2 : float
        Moduli of elasticity [Pa]
    nu_1, nu_2 : float
        Poisson's ratios [-]

    Returns
    -------
    Z_E : float
        Elastic coefficient [Pa^0.5]

    Notes
    -----
    Source: Nunes (2017), eq. 4.30. Print: table 4.10 gives the number in (N/mm2)^0.5; it is in Pa^0.5.

    Examples
    --------
    >>> f"{elastic_coefficient(200e9, 0.3, 200e9, 0.3):.5g}"
    '1.8703e+05'
    """
    require("modulus of elasticity", [E_1, E_2], "Pa", above=0)
    require("Poisson's ratio", [nu_1, nu_2], "-", low=0, below=0.5)
    return (np.pi * ((1 - nu_1**2) / E_1 + (1 - nu_2**2) / E_2)) ** -0.5


def rim_factor(t_R: float, h_t: float) -> float:
    r"""Rim thickness factor.

    .. math:: K_B = 1.6\ln(2.242\,h_t/t_R) \quad (t_R < 1.2\,h_t), \qquad 1 \text{ else}

    Parameters
    ----------
    t_R : float
        Thickness of the rim below the tooth root [m]
    h_t : float
        Whole depth of the tooth [m]

    Returns
    -------
    K_B : float
        Factor, at least 1 [-]

    Notes
    -----
    Source: AGMA 2001-D04, fig. B.1; Nunes (2017), ch. 4.4.2 uses its upper branch. Valid: t_R >= 0.5 h_t.

    Examples
    --------
    >>> rim_factor(3.15e-3, 2.35e-3)
    1.0
    """
    require("whole depth h_t", h_t, "m", above=0)
    require("rim thickness t_R", t_R, "m", low=0.5 * h_t, hint="below half the whole depth AGMA gives no factor")
    return float(1.0 if t_R >= 1.2 * h_t else max(1.0, 1.6 * np.log(2.242 * h_t / t_R)))


def size_factor(b: float, m: float, Y: float) -> float:
    r"""Size factor.

    .. math:: K_s = 1.192\,(b\,m\,\sqrt{Y})^{0.0535} \quad \text{(b, m in inches)}

    Parameters
    ----------
    b : float
        Face width [m]
    m : float
        Module [m]
    Y : float
        Lewis form factor [-]

    Returns
    -------
    K_s : float
        Factor, at least 1 [-]

    Notes
    -----
    Source: Shigley, eq. (a) of ch. 14-10; AGMA 2101 and the source take 1 for a proper choice of steel.

    Examples
    --------
    >>> round(size_factor(1.5 * 0.0254, 0.00254, 0.303), 3)  # Shigley, example 14-4
    1.043
    """
    require("face width b", b, "m", above=0)
    require("module m", m, "m", above=0)
    require("Lewis form factor Y", Y, "-", above=0, below=1)
    return float(max(1.0, 1.192 * (b * m / 0.0254**2 * np.sqrt(Y)) ** 0.0535))
