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

Cylinder of an opposed-piston engine, in one piece: wall, flange, length, bolts.

        |<------------- L_cylinder ------------->|
        ==========================================   t_cw wall, t_f flange at both ends
        -> head|  d_TDC  |head <-
        ==========================================

The rule of the source gives the CORE (root) diameter of a bolt; a thread of that nominal diameter is too thin.
Source: Nunes (2017), ch. 4.3, after Khurmi and Gupta (2005); thread: ISO 261 coarse pitches, root diameter
d_3 = d - 1.226869 P (ISO 724).
"""

from typing import Annotated

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities.units import Area, Kelvin, MassFlow, Metre, Newton, Pascal, Pure, Volume, Watt
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

    B: bore. Source: Nunes (2017), eq. 4.2. Valid: t_H < B / 2.

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
    aluminium. Source: Nunes (2017), eq. 4.3, which prints 12.56 for 4 pi.

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
    for cast iron. Source: Nunes (2017), eq. 4.6. Valid: the ranges above.

    >>> [f"{ring_radial_thickness(0.060, *x) * 1e3:.2f}" for x in ((0.025e6, 110e6), (0.042e6, 85e6))]
    ['1.57', '2.31']
    """
    require("wall pressure p_w", p_w, "Pa", low=0.025e6, high=0.042e6)
    require("allowable stress sigma_t", sigma_t, "Pa", low=85e6, high=110e6, hint="the range is for cast iron rings")
    return B * np.sqrt(3 * p_w / sigma_t)


def ring_axial_thickness(B: Metre, n_rings: int) -> Metre:
    """Axial thickness of a ring.

    .. math:: t_2 = B/(10 n)

    B: bore. Source: Nunes (2017), eq. 4.7.

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
    length left. Source: Nunes (2017), eq. 4.12. Print: 88.6 mm comes from d_TDC = 1.2 mm, which is 11.56 mm
    (`cylinder.tdc_gap`). Valid: the opposed pistons of the thesis, each at its top dead centre.

    >>> [f"{rod_length(0.145, 0.013, gap, 0.01375, 0.032) * 1e3:.1f}" for gap in (0.0012, 0.01156)]
    ['88.6', '83.5']
    """
    length = reach - 2 * e - d_TDC / 2 - t_H - ID_cap / 2
    require("rod length", length, "m", above=0, hint="the crank axis must stand further from the middle of the engine")
    return length


def wall_thickness(p: Pascal, B: Metre, sigma_c: Pascal, reboring: Metre) -> Metre:
    r"""Thickness of a thin cylinder wall with an allowance for reboring or a liner.

    .. math:: t_{cw} = \frac{p B}{2\sigma_c} + C

    p: largest pressure. B: bore. sigma_c: allowable hoop stress, 35 to 100 MPa. reboring: allowance C: thickness of a
    dry liner, 0.03 to 0.035 of the bore. Source: Nunes (2017), eqs. 4.13 and 4.14.

    >>> f"{wall_thickness(9.604e6, 0.060, 52.5e6, 0.002) * 1e3:.2f}"
    '7.49'
    """
    require("pressure p", p, "Pa", low=0)
    require("bore B", B, "m", above=0)
    require("allowable stress sigma_c", sigma_c, "Pa", above=0)
    require("reboring allowance", reboring, "m", low=0, high=0.2 * B)
    return p * B / (2 * sigma_c) + reboring


def hoop_stress(p: Pascal, B: Metre, t: Metre) -> Pascal:
    r"""Hoop stress of a thin cylinder wall.

    .. math:: \sigma = \frac{p B}{2 t}

    B: bore; t: thickness that bears, without the reboring allowance.
    Source: Nunes (2017), eq. 4.13 solved for the stress. Valid: t < B / 4; the thin-wall stress is the mean over it.

    >>> f"{hoop_stress(9.604e6, 0.060, 0.0055) / 1e6:.1f}"
    '52.4'
    """
    require("bearing thickness t", t, "m", above=0, below=B / 4, hint="the rule is for thin walls")
    return p * B / (2 * t)


def flange_range(t_cw: Metre) -> tuple[Metre, Metre]:
    r"""Usual thickness of the flange.

    .. math:: 1.2\,t_{cw} \le t_f \le 1.4\,t_{cw}

    t_cw: thickness of the wall. Returns low, high: range. Source: Nunes (2017), ch. 4.3 (Khurmi and Gupta).

    >>> [f"{t * 1e3:.1f}" for t in flange_range(0.0075)]
    ['9.0', '10.5']
    """
    require("wall thickness t_cw", t_cw, "m", above=0)
    return 1.2 * t_cw, 1.4 * t_cw


def tdc_gap(V_c: Volume, A: Area) -> Metre:
    """Distance between the piston heads at top dead centre.

    .. math:: d_{TDC} = V_c / A

    V_c: clearance volume of the cylinder; A: area of the bore.
    Source: Nunes (2017), eq. 4.15. Print: 1.2 mm comes from an area ten times too large (table 3.2); it is 11.56 mm.

    >>> [f"{tdc_gap(3.2673e-5, A) * 1e3:.2f}" for A in (0.02827, 0.0028274)]
    ['1.16', '11.56']
    """
    require("clearance volume V_c", V_c, "m^3", above=0)
    require("area A", A, "m^2", above=0)
    return V_c / A


def cylinder_length(d_TDC: Metre, L_piston: Metre, stroke: Metre) -> Metre:
    """Shortest cylinder that guides both pistons at bottom dead centre, 15 % of a stroke to spare at each end.

    .. math:: L = d_{TDC} + 2 s + 2 (L_{piston} + 0.15 s)

    d_TDC: distance between the heads at top dead centre; L_piston: height of a piston head; stroke: stroke s of one
    piston, half the source's S.
    Source: Nunes (2017), eqs. 4.16 and 4.17. Print: 169.4 mm follows from the wrong gap; it is 179.8 mm.

    >>> [f"{cylinder_length(gap, 0.0243, 0.052) * 1e3:.1f}" for gap in (0.0011558, 0.0115556)]
    ['169.4', '179.8']
    """
    require("gap, height and stroke", [d_TDC, L_piston, stroke], "m", above=0)
    return d_TDC + 2 * L_piston + 2.3 * stroke


# nominal diameter [mm]: coarse pitch [mm] (ISO 261, first choice and 14, 18, 22)
COARSE = {
    3: 0.5, 4: 0.7, 5: 0.8, 6: 1.0, 8: 1.25, 10: 1.5, 12: 1.75, 14: 2.0, 16: 2.0, 18: 2.5, 20: 2.5, 22: 2.5,
    24: 3.0, 30: 3.5, 36: 4.0, 42: 4.5, 48: 5.0, 56: 5.5, 64: 6.0,
}  # fmt: skip


def core_diameter(p: Pascal, B: Metre, n_bolts: int, sigma: Pascal) -> Metre:
    r"""Core diameter of the bolts that hold a cylinder against its pressure.

    .. math:: d_c = \sqrt{\frac{B^2 p}{n\,\sigma}}

    p: largest pressure. B: bore. n_bolts: number of bolts; 0.01 B/mm + 4 to 0.02 B/mm + 4 is usual. sigma: allowable
    tensile stress, 35 to 70 MPa.
    Source: Nunes (2017), eq. 4.18. Print: the source takes it for the nominal diameter and chooses M10.

    >>> [f"{core_diameter(9.604e6, 0.060, 5, s) * 1e3:.2f}" for s in (70e6, 35e6)]
    ['9.94', '14.06']
    """
    require("pressure p", p, "Pa", low=0)
    require("number of bolts", n_bolts, "-", low=2)
    require("allowable stress", sigma, "Pa", above=0)
    return np.sqrt(B**2 * p / (n_bolts * sigma))


def bolt_stress(p: Pascal, B: Metre, n_bolts: int, d_c: Metre) -> Pascal:
    r"""Tensile stress in the core of the bolts.

    .. math:: \sigma = \frac{B^2 p}{n\,d_c^2}

    B: bore; d_c: core diameter. Returns sigma: stress, without preload.
    Source: Nunes (2017), eq. 4.18 solved for the stress.

    >>> f"{bolt_stress(9.604e6, 0.060, 5, root_diameter(10)) / 1e6:.0f}"
    '104'
    """
    require("core diameter d_c", d_c, "m", above=0)
    return B**2 * p / (n_bolts * d_c**2)


def root_diameter(nominal_mm: int) -> Metre:
    r"""Root diameter of a coarse metric thread.

    .. math:: d_3 = d - 1.226869\,P

    nominal_mm: nominal diameter d of the thread [mm]. Raises BadInput: no coarse thread of that size. Source: ISO 724.

    >>> f"{root_diameter(10) * 1e3:.3f}"
    '8.160'
    """
    if nominal_mm not in COARSE:
        raise BadInput(f"thread M{nominal_mm} is not in the list; there are M{', M'.join(map(str, COARSE))}")
    return (nominal_mm - 1.226869 * COARSE[nominal_mm]) * 1e-3


def thread_for(d_c: Metre) -> int:
    """Smallest standard thread whose root is not thinner than asked.

    d_c: core diameter needed. Returns nominal_mm: nominal diameter of the thread [mm]. Raises BadInput: thicker than
    the largest thread in the list. Source: ISO 261 and 724.

    >>> thread_for(9.94e-3), thread_for(14.06e-3)
    (14, 18)
    """
    require("core diameter d_c", d_c, "m", low=0, high=root_diameter(max(COARSE)), hint="take more bolts")
    return next(nominal for nominal in COARSE if root_diameter(nominal) >= d_c)
