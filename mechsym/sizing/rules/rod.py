"""The straight piston rod: diameter, buckling, length.

Source: Nunes (2017), ch. 4.2, after Khurmi and Gupta (2005); buckling after Shigley, ch. 4.
"""

import numpy as np

from mechsym.sizing.checks import require


def rod_diameter(F: float, sigma: float) -> float:
    r"""Diameter of a straight round rod under axial load.

    .. math:: d_r = \sqrt{\frac{4 F}{\pi\sigma}}

    Parameters
    ----------
    F : float
        Largest axial load [N]
    sigma : float
        Allowable stress [Pa]

    Returns
    -------
    d_r : float
        Diameter [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.5. Print: the text allows 60 MPa (24.00 mm); the printed 26.29 mm needs 75/1.5 = 50 MPa.
    Valid: short rod, loaded along its axis; a long one buckles first (`rod_buckling_load`).

    Examples
    --------
    >>> f"{rod_diameter(27140.0, 50e6) * 1e3:.2f}"
    '26.29'
    """
    require("load F", F, "N", low=0)
    require("allowable stress", sigma, "Pa", above=0)
    return np.sqrt(4 * F / (np.pi * sigma))


def rod_buckling_load(d: float, length: float, E: float, yield_strength: float) -> float:
    r"""Load at which a round rod between hinges buckles (Euler, or Johnson below the tangent point).

    .. math:: F = \begin{cases}\pi^2 E I/l^2 & l/i \ge \sqrt{2\pi^2 E/R_e}\\
              A R_e\left(1 - \frac{R_e (l/i)^2}{4\pi^2 E}\right) & \text{shorter}\end{cases}

    Parameters
    ----------
    d : float
        Diameter [m]
    length : float
        Length between hinges [m]
    E : float
        Modulus of elasticity [Pa]
    yield_strength : float
        Yield strength R_e [Pa]

    Returns
    -------
    F : float
        Buckling load [N]

    Notes
    -----
    Source: Shigley, eqs. 4-42 and 4-43 (Euler and J. B. Johnson columns). Valid: straight round rod, ends free to turn,
    load along its axis.

    Examples
    --------
    >>> f"{rod_buckling_load(0.0265, 0.0834, 71e9, 207e6) / 1e3:.0f}"
    '113'
    """
    require("diameter and length", [d, length], "m", above=0)
    area, slenderness = np.pi * d**2 / 4, length / (d / 4)
    if slenderness**2 >= 2 * np.pi**2 * E / yield_strength:
        return np.pi**2 * E * area / slenderness**2
    return area * yield_strength * (1 - yield_strength * slenderness**2 / (4 * np.pi**2 * E))


def rod_length(reach: float, e: float, d_TDC: float, t_H: float, ID_cap: float) -> float:
    r"""Length of the rod between the piston head and the cap.

    .. math:: L_{rod} = reach - 2 e - \tfrac12 d_{TDC} - t_H - \tfrac12 ID_{cap}

    Parameters
    ----------
    reach : float
        Crank axis to the engine's plane of symmetry, 145 mm in the source [m]
    e : float
        Throw of the hypocycloid's crank, a quarter of the piston's stroke: S/4 = 2 e of the source's S [m]
    d_TDC : float
        Distance between the two piston heads at top dead centre [m]
    t_H : float
        Thickness of the head [m]
    ID_cap : float
        Inner diameter of the rod's cap [m]

    Returns
    -------
    L_rod : float
        Length [m]

    Raises
    ------
    BadInput
        The rod has no length left

    Notes
    -----
    Source: Nunes (2017), eq. 4.12. Print: 88.6 mm comes from d_TDC = 1.2 mm, which is 11.56 mm (`cylinder.tdc_gap`).
    Valid: the opposed pistons of the thesis, each at its top dead centre.

    Examples
    --------
    >>> [f"{rod_length(0.145, 0.013, gap, 0.01375, 0.032) * 1e3:.1f}" for gap in (0.0012, 0.01156)]
    ['88.6', '83.5']
    """
    length = reach - 2 * e - d_TDC / 2 - t_H - ID_cap / 2
    require("rod length", length, "m", above=0, hint="the crank axis must stand further from the middle of the engine")
    return length
