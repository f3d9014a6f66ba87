"""Cylinder of an opposed-piston engine, in one piece: wall, flange, length, bolts.

        |<------------- L_cylinder ------------->|
        ==========================================   t_cw wall, t_f flange at both ends
        -> head|  d_TDC  |head <-
        ==========================================

The rule of the source gives the CORE (root) diameter of a bolt; a thread of that nominal diameter is too thin.
Source: Nunes (2017), ch. 4.3, after Khurmi and Gupta (2005); thread: ISO 261 coarse pitches, root diameter
d_3 = d - 1.226869 P (ISO 724).
"""

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities.units import Area, Metre, Pascal, Volume
from mechsym.sizing.checks import require


def wall_thickness(p: Pascal, B: Metre, sigma_c: Pascal, reboring: Metre) -> Metre:
    r"""Thickness of a thin cylinder wall with an allowance for reboring or a liner.

    .. math:: t_{cw} = \frac{p B}{2\sigma_c} + C

    p: largest pressure. B: bore. sigma_c: allowable hoop stress, 35 to 100 MPa. reboring: allowance C: thickness of a
    dry liner, 0.03 to 0.035 of the bore.
    Source: Nunes (2017), eqs. 4.13 and 4.14.

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

    t_cw: thickness of the wall. Returns low, high: range.
    Source: Nunes (2017), ch. 4.3 (Khurmi and Gupta).

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

    nominal_mm: nominal diameter d of the thread [mm]. Raises BadInput: no coarse thread of that size.
    Source: ISO 724.

    >>> f"{root_diameter(10) * 1e3:.3f}"
    '8.160'
    """
    if nominal_mm not in COARSE:
        raise BadInput(f"thread M{nominal_mm} is not in the list; there are M{', M'.join(map(str, COARSE))}")
    return (nominal_mm - 1.226869 * COARSE[nominal_mm]) * 1e-3


def thread_for(d_c: Metre) -> int:
    """Smallest standard thread whose root is not thinner than asked.

    d_c: core diameter needed. Returns nominal_mm: nominal diameter of the thread [mm]. Raises BadInput: thicker than
    the largest thread in the list.
    Source: ISO 261 and 724.

    >>> thread_for(9.94e-3), thread_for(14.06e-3)
    (14, 18)
    """
    require("core diameter d_c", d_c, "m", low=0, high=root_diameter(max(COARSE)), hint="take more bolts")
    return next(nominal for nominal in COARSE if root_diameter(nominal) >= d_c)
