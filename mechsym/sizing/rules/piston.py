"""Piston head and rings of a piston without skirt (the hypocycloid's rod moves straight), and its rod.

        |<------- B ------->|
        +-------------------+   ---
        |       t_H         |    |  b_1 top land
        +--+-------------+--+    |
        |[]|             |[]|    |  n rings of t_1 x t_2, lands b_2
        |[]|    |d_r|    |[]|    |  L_piston
        +--+----|   |----+--+   ---
                |   |  rod

Source: Nunes (2017), ch. 4.2, after Khurmi and Gupta (2005); buckling after Shigley, ch. 4.
"""

from typing import Annotated

import numpy as np

from mechsym.quantities.units import Kelvin, MassFlow, Metre, Newton, Pascal, Pure, Watt
from mechsym.sizing.checks import require


def head_thickness_strength(p: Pascal, B: Metre, sigma_t: Pascal) -> Metre:
    r"""Thickness of a piston head that bears the gas pressure (Grashof).

    .. math:: t_H = \sqrt{\frac{3 p B^2}{16 \sigma_t}}

    p: largest pressure on the head; B: bore; sigma_t: allowable bending stress at the head's temperature.
    Source: Nunes (2017), eq. 4.2.

    >>> f"{head_thickness_strength(9.604e6, 0.060, 60e6) * 1e3:.2f}"
    '10.39'
    """
    require("pressure p", p, "Pa", low=0)
    require("bore B", B, "m", above=0)
    require("allowable stress sigma_t", sigma_t, "Pa", above=0)
    return np.sqrt(3 * p * B**2 / (16 * sigma_t))


def head_stress(p: Pascal, B: Metre, t_H: Metre) -> Pascal:
    r"""Bending stress of a piston head of given thickness, the inverse of Grashof's formula.

    .. math:: \sigma = \frac{3 p B^2}{16\,t_H^2}

    B: bore.
    Source: Nunes (2017), eq. 4.2. Valid: t_H < B / 2.

    >>> f"{head_stress(9.604e6, 0.060, 0.01375) / 1e6:.1f}"
    '34.3'
    """
    require("pressure p", p, "Pa", low=0)
    require("thickness t_H", t_H, "m", above=0, below=B / 2, hint="the rule is for a plate")
    return 3 * p * B**2 / (16 * t_H**2)


def head_heat(fuel_flow: MassFlow, heating_value: Annotated[float, "J/kg"], share: Pure = 0.05) -> Watt:
    r"""Heat that flows through one piston head.

    .. math:: H = C\,\dot m_f\,H_u

    fuel_flow: fuel burnt for this piston: half the cylinder's in an opposed-piston engine. heating_value: heating value
    of the fuel. share: share C of the heat that goes through the head. Returns H: heat flow.
    Source: Nunes (2017), eq. 4.4. Print: the symbol is not explained; the printed 13.74 mm needs HALF the fuel flow.

    >>> f"{head_heat(2.3923e-5 * 8000 / 120 / 2, 43.5e6):.0f}"
    '1734'
    """
    require("fuel flow", fuel_flow, "kg/s", low=0)
    require("heating value", heating_value, "J/kg", above=0)
    require("share", share, "-", low=0, high=1)
    return share * fuel_flow * heating_value


def head_thickness_heat(H: Watt, k: Annotated[float, "W/(m*K)"], dT: Kelvin) -> Metre:
    r"""Thickness of a piston head that conducts the heat to its edge.

    .. math:: t_H = \frac{H}{4\pi k\,\Delta T}

    H: heat flow through the head; k: thermal conductivity; dT: temperature of the middle above the edge, 75 K for
    aluminium.
    Source: Nunes (2017), eq. 4.3, which prints 12.56 for 4 pi.

    >>> f"{head_thickness_heat(1734.4, 134.0, 75.0) * 1e3:.2f}"
    '13.73'
    """
    require("heat flow H", H, "W", low=0)
    require("conductivity k", k, "W/(m*K)", above=0)
    require("temperature difference dT", dT, "K", above=0)
    return H / (4 * np.pi * k * dT)


def ring_radial_thickness(B: Metre, p_w: Pascal, sigma_t: Pascal) -> Metre:
    r"""Radial thickness of a compression ring.

    .. math:: t_1 = B\sqrt{3 p_w/\sigma_t}

    B: bore; p_w: pressure of the ring on the wall, 0.025 to 0.042 MPa; sigma_t: allowable bending stress, 85 to 110 MPa
    for cast iron.
    Source: Nunes (2017), eq. 4.6. Valid: the ranges above.

    >>> [f"{ring_radial_thickness(0.060, *x) * 1e3:.2f}" for x in ((0.025e6, 110e6), (0.042e6, 85e6))]
    ['1.57', '2.31']
    """
    require("wall pressure p_w", p_w, "Pa", low=0.025e6, high=0.042e6)
    require("allowable stress sigma_t", sigma_t, "Pa", low=85e6, high=110e6, hint="the range is for cast iron rings")
    return B * np.sqrt(3 * p_w / sigma_t)


def ring_axial_thickness(B: Metre, n_rings: int) -> Metre:
    """Axial thickness of a ring.

    .. math:: t_2 = B/(10 n)

    B: bore.
    Source: Nunes (2017), eq. 4.7.

    >>> ring_axial_thickness(0.060, 3)
    0.002
    """
    require("number of rings", n_rings, "-", low=1, high=8)
    return B / (10 * n_rings)


def barrel_thickness(B: Metre, t_1: Metre) -> Metre:
    r"""Largest thickness of the piston barrel.

    .. math:: t_3 = 0.03 B + t_1 + 4.9\,\mathrm{mm}

    B: bore; t_1: radial thickness of the rings.
    Source: Nunes (2017), eq. 4.9: groove depth t_1 + 0.4 mm (eq. 4.8) plus 4.5 mm.

    >>> f"{barrel_thickness(0.060, 0.002) * 1e3:.1f}"
    '8.7'
    """
    require("bore B", B, "m", above=0)
    require("ring thickness t_1", t_1, "m", above=0)
    return 0.03 * B + t_1 + 4.9e-3


def head_height(b_1: Metre, b_2: Metre, t_2: Metre, n_rings: int) -> Metre:
    """Height of the piston head.

    .. math:: L_{piston} = b_1 + n (t_2 + b_2)

    b_1, b_2: top land (t_H to 1.2 t_H) and the other lands (0.75 t_2 to t_2); t_2: axial thickness of a ring.
    Source: Nunes (2017), eq. 4.10.

    >>> f"{head_height(0.01375, 0.0015, 0.002, 3) * 1e3:.2f}"
    '24.25'
    """
    require("lands and ring", [b_1, b_2, t_2], "m", above=0)
    return b_1 + n_rings * (t_2 + b_2)


def rod_diameter(F: Newton, sigma: Pascal) -> Metre:
    r"""Diameter of a straight round rod under axial load.

    .. math:: d_r = \sqrt{\frac{4 F}{\pi\sigma}}

    F: largest axial load; sigma: allowable stress.
    Source: Nunes (2017), eq. 4.5. Print: the text allows 60 MPa (24.00 mm); the printed 26.29 mm needs 75/1.5 = 50 MPa.
    Valid: short rod, loaded along its axis; a long one buckles first (`rod_buckling_load`).

    >>> f"{rod_diameter(27140.0, 50e6) * 1e3:.2f}"
    '26.29'
    """
    require("load F", F, "N", low=0)
    require("allowable stress", sigma, "Pa", above=0)
    return np.sqrt(4 * F / (np.pi * sigma))


def rod_buckling_load(d: Metre, length: Metre, E: Pascal, yield_strength: Pascal) -> Newton:
    r"""Load at which a round rod between hinges buckles (Euler, or Johnson below the tangent point).

    .. math:: F = \begin{cases}\pi^2 E I/l^2 & l/i \ge \sqrt{2\pi^2 E/R_e}\\
              A R_e\left(1 - \frac{R_e (l/i)^2}{4\pi^2 E}\right) & \text{shorter}\end{cases}

    d: diameter; E: modulus of elasticity; yield_strength: yield strength R_e. Returns F: buckling load.
    Source: Shigley, eqs. 4-42 and 4-43 (Euler and J. B. Johnson columns). Valid: straight round rod, ends free to turn,
    load along its axis.

    >>> f"{rod_buckling_load(0.0265, 0.0834, 71e9, 207e6) / 1e3:.0f}"
    '113'
    """
    require("diameter and length", [d, length], "m", above=0)
    area, slenderness = np.pi * d**2 / 4, length / (d / 4)
    if slenderness**2 >= 2 * np.pi**2 * E / yield_strength:
        return np.pi**2 * E * area / slenderness**2
    return area * yield_strength * (1 - yield_strength * slenderness**2 / (4 * np.pi**2 * E))


def rod_length(reach: Metre, e: Metre, d_TDC: Metre, t_H: Metre, ID_cap: Metre) -> Metre:
    r"""Length of the rod between the piston head and the cap.

    .. math:: L_{rod} = reach - 2 e - \tfrac12 d_{TDC} - t_H - \tfrac12 ID_{cap}

    reach: crank axis to the engine's plane of symmetry, 145 mm in the source. e: throw of the hypocycloid's crank, a
    quarter of the piston's stroke: S/4 = 2 e of the source's S. d_TDC: distance between the two piston heads at top
    dead centre. t_H: thickness of the head. ID_cap: inner diameter of the rod's cap. Raises BadInput: the rod has no
    length left.
    Source: Nunes (2017), eq. 4.12. Print: 88.6 mm comes from d_TDC = 1.2 mm, which is 11.56 mm (`cylinder.tdc_gap`).
    Valid: the opposed pistons of the thesis, each at its top dead centre.

    >>> [f"{rod_length(0.145, 0.013, gap, 0.01375, 0.032) * 1e3:.1f}" for gap in (0.0012, 0.01156)]
    ['88.6', '83.5']
    """
    length = reach - 2 * e - d_TDC / 2 - t_H - ID_cap / 2
    require("rod length", length, "m", above=0, hint="the crank axis must stand further from the middle of the engine")
    return length
