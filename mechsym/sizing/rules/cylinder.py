"""Cylinder of an opposed-piston engine, in one piece: wall, flange, length.

        |<------------- L_cylinder ------------->|
        ==========================================   t_cw wall, t_f flange at both ends
        -> head|  d_TDC  |head <-
        ==========================================

Source: Nunes (2017), ch. 4.3, after Khurmi and Gupta (2005).
"""

from mechsym.sizing.checks import require


def wall_thickness(p: float, B: float, sigma_c: float, reboring: float) -> float:
    r"""Thickness of a thin cylinder wall with an allowance for reboring or a liner.

    .. math:: t_{cw} = \frac{p B}{2\sigma_c} + C

    Parameters
    ----------
    p : float
        Largest pressure [Pa]
    B : float
        Bore [m]
    sigma_c : float
        Allowable hoop stress, 35 to 100 MPa [Pa]
    reboring : float
        Allowance C: thickness of a dry liner, 0.03 to 0.035 of the bore [m]

    Returns
    -------
    t_cw : float
        Thickness [m]

    Notes
    -----
    Source: Nunes (2017), eqs. 4.13 and 4.14.

    Examples
    --------
    >>> f"{wall_thickness(9.604e6, 0.060, 52.5e6, 0.002) * 1e3:.2f}"
    '7.49'
    """
    require("pressure p", p, "Pa", low=0)
    require("bore B", B, "m", above=0)
    require("allowable stress sigma_c", sigma_c, "Pa", above=0)
    require("reboring allowance", reboring, "m", low=0, high=0.2 * B)
    return p * B / (2 * sigma_c) + reboring


def hoop_stress(p: float, B: float, t: float) -> float:
    r"""Hoop stress of a thin cylinder wall.

    .. math:: \sigma = \frac{p B}{2 t}

    Parameters
    ----------
    p : float
        Pressure [Pa]
    B : float
        Bore [m]
    t : float
        Thickness that bears, without the reboring allowance [m]

    Returns
    -------
    sigma : float
        Stress [Pa]

    Notes
    -----
    Source: Nunes (2017), eq. 4.13 solved for the stress. Valid: t < B / 4; the thin-wall stress is the mean over it.

    Examples
    --------
    >>> f"{hoop_stress(9.604e6, 0.060, 0.0055) / 1e6:.1f}"
    '52.4'
    """
    require("bearing thickness t", t, "m", above=0, below=B / 4, hint="the rule is for thin walls")
    return p * B / (2 * t)


def flange_range(t_cw: float) -> tuple[float, float]:
    r"""Usual thickness of the flange.

    .. math:: 1.2\,t_{cw} \le t_f \le 1.4\,t_{cw}

    Parameters
    ----------
    t_cw : float
        Thickness of the wall [m]

    Returns
    -------
    low, high : float
        Range [m]

    Notes
    -----
    Source: Nunes (2017), ch. 4.3 (Khurmi and Gupta).

    Examples
    --------
    >>> [f"{t * 1e3:.1f}" for t in flange_range(0.0075)]
    ['9.0', '10.5']
    """
    require("wall thickness t_cw", t_cw, "m", above=0)
    return 1.2 * t_cw, 1.4 * t_cw


def tdc_gap(V_c: float, A: float) -> float:
    r"""Distance between the piston heads at top dead centre.

    .. math:: d_{TDC} = V_c / A

    Parameters
    ----------
    V_c : float
        Clearance volume of the cylinder [m^3]
    A : float
        Area of the bore [m^2]

    Returns
    -------
    d_TDC : float
        Distance [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.15. Print: 1.2 mm comes from an area ten times too large (table 3.2); it is 11.56 mm.

    Examples
    --------
    >>> [f"{tdc_gap(3.2673e-5, A) * 1e3:.2f}" for A in (0.02827, 0.0028274)]
    ['1.16', '11.56']
    """
    require("clearance volume V_c", V_c, "m^3", above=0)
    require("area A", A, "m^2", above=0)
    return V_c / A


def cylinder_length(d_TDC: float, L_piston: float, stroke: float) -> float:
    r"""Shortest cylinder that guides both pistons at bottom dead centre, 15 % of a stroke to spare at each end.

    .. math:: L = d_{TDC} + 2 s + 2 (L_{piston} + 0.15 s)

    Parameters
    ----------
    d_TDC : float
        Distance between the heads at top dead centre [m]
    L_piston : float
        Height of a piston head [m]
    stroke : float
        Stroke s of one piston, half the source's S [m]

    Returns
    -------
    L : float
        Length [m]

    Notes
    -----
    Source: Nunes (2017), eqs. 4.16 and 4.17. Print: 169.4 mm follows from the wrong gap; it is 179.8 mm.

    Examples
    --------
    >>> [f"{cylinder_length(gap, 0.0243, 0.052) * 1e3:.1f}" for gap in (0.0011558, 0.0115556)]
    ['169.4', '179.8']
    """
    require("gap, height and stroke", [d_TDC, L_piston, stroke], "m", above=0)
    return d_TDC + 2 * L_piston + 2.3 * stroke
