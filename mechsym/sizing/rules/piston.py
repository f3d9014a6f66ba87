"""Piston head and rings of a piston without skirt (the hypocycloid's rod moves straight).

        |<------- B ------->|
        +-------------------+   ---
        |       t_H         |    |  b_1 top land
        +--+-------------+--+    |
        |[]|             |[]|    |  n rings of t_1 x t_2, lands b_2
        |[]|    |d_r|    |[]|    |  L_piston
        +--+----|   |----+--+   ---
                |   |  rod

Source: Nunes (2017), ch. 4.2, after Khurmi and Gupta (2005).
"""

import numpy as np

from mechsym.sizing.checks import require


def head_thickness_strength(p: float, B: float, sigma_t: float) -> float:
    r"""Thickness of a piston head that bears the gas pressure (Grashof).

    .. math:: t_H = \sqrt{\frac{3 p B^2}{16 \sigma_t}}

    Parameters
    ----------
    p : float
        Largest pressure on the head [Pa]
    B : float
        Bore [m]
    sigma_t : float
        Allowable bending stress at the head's temperature [Pa]

    Returns
    -------
    t_H : float
        Thickness [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.2.

    Examples
    --------
    >>> f"{head_thickness_strength(9.604e6, 0.060, 60e6) * 1e3:.2f}"
    '10.39'
    """
    require("pressure p", p, "Pa", low=0)
    require("bore B", B, "m", above=0)
    require("allowable stress sigma_t", sigma_t, "Pa", above=0)
    return np.sqrt(3 * p * B**2 / (16 * sigma_t))


def head_stress(p: float, B: float, t_H: float) -> float:
    r"""Bending stress of a piston head of given thickness, the inverse of Grashof's formula.

    .. math:: \sigma = \frac{3 p B^2}{16\,t_H^2}

    Parameters
    ----------
    p : float
        Pressure on the head [Pa]
    B : float
        Bore [m]
    t_H : float
        Thickness [m]

    Returns
    -------
    sigma : float
        Stress [Pa]

    Notes
    -----
    Source: Nunes (2017), eq. 4.2. Valid: t_H < B / 2.

    Examples
    --------
    >>> f"{head_stress(9.604e6, 0.060, 0.01375) / 1e6:.1f}"
    '34.3'
    """
    require("pressure p", p, "Pa", low=0)
    require("thickness t_H", t_H, "m", above=0, below=B / 2, hint="the rule is for a plate")
    return 3 * p * B**2 / (16 * t_H**2)


def head_heat(fuel_flow: float, heating_value: float, share: float = 0.05) -> float:
    r"""Heat that flows through one piston head.

    .. math:: H = C\,\dot m_f\,H_u

    Parameters
    ----------
    fuel_flow : float
        Fuel burnt for this piston: half the cylinder's in an opposed-piston engine [kg/s]
    heating_value : float
        Heating value of the fuel [J/kg]
    share : float
        Share C of the heat that goes through the head [-]

    Returns
    -------
    H : float
        Heat flow [W]

    Notes
    -----
    Source: Nunes (2017), eq. 4.4. Print: the symbol is not explained; the printed 13.74 mm needs HALF the fuel flow.

    Examples
    --------
    >>> f"{head_heat(2.3923e-5 * 8000 / 120 / 2, 43.5e6):.0f}"
    '1734'
    """
    require("fuel flow", fuel_flow, "kg/s", low=0)
    require("heating value", heating_value, "J/kg", above=0)
    require("share", share, "-", low=0, high=1)
    return share * fuel_flow * heating_value


def head_thickness_heat(H: float, k: float, dT: float) -> float:
    r"""Thickness of a piston head that conducts the heat to its edge.

    .. math:: t_H = \frac{H}{4\pi k\,\Delta T}

    Parameters
    ----------
    H : float
        Heat flow through the head [W]
    k : float
        Thermal conductivity [W/(m*K)]
    dT : float
        Temperature of the middle above the edge, 75 K for aluminium [K]

    Returns
    -------
    t_H : float
        Thickness [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.3, which prints 12.56 for 4 pi.

    Examples
    --------
    >>> f"{head_thickness_heat(1734.4, 134.0, 75.0) * 1e3:.2f}"
    '13.73'
    """
    require("heat flow H", H, "W", low=0)
    require("conductivity k", k, "W/(m*K)", above=0)
    require("temperature difference dT", dT, "K", above=0)
    return H / (4 * np.pi * k * dT)


def ring_radial_thickness(B: float, p_w: float, sigma_t: float) -> float:
    r"""Radial thickness of a compression ring.

    .. math:: t_1 = B\sqrt{3 p_w/\sigma_t}

    Parameters
    ----------
    B : float
        Bore [m]
    p_w : float
        Pressure of the ring on the wall, 0.025 to 0.042 MPa [Pa]
    sigma_t : float
        Allowable bending stress, 85 to 110 MPa for cast iron [Pa]

    Returns
    -------
    t_1 : float
        Radial thickness [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.6. Valid: the ranges above.

    Examples
    --------
    >>> [f"{ring_radial_thickness(0.060, *x) * 1e3:.2f}" for x in ((0.025e6, 110e6), (0.042e6, 85e6))]
    ['1.57', '2.31']
    """
    require("wall pressure p_w", p_w, "Pa", low=0.025e6, high=0.042e6)
    require("allowable stress sigma_t", sigma_t, "Pa", low=85e6, high=110e6, hint="the range is for cast iron rings")
    return B * np.sqrt(3 * p_w / sigma_t)


def ring_axial_thickness(B: float, n_rings: int) -> float:
    r"""Axial thickness of a ring.

    .. math:: t_2 = B/(10 n)

    Parameters
    ----------
    B : float
        Bore [m]
    n_rings : int
        Number of rings [-]

    Returns
    -------
    t_2 : float
        Axial thickness [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.7.

    Examples
    --------
    >>> ring_axial_thickness(0.060, 3)
    0.002
    """
    require("number of rings", n_rings, "-", low=1, high=8)
    return B / (10 * n_rings)


def barrel_thickness(B: float, t_1: float) -> float:
    r"""Largest thickness of the piston barrel.

    .. math:: t_3 = 0.03 B + t_1 + 4.9\,\mathrm{mm}

    Parameters
    ----------
    B : float
        Bore [m]
    t_1 : float
        Radial thickness of the rings [m]

    Returns
    -------
    t_3 : float
        Thickness [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.9: groove depth t_1 + 0.4 mm (eq. 4.8) plus 4.5 mm.

    Examples
    --------
    >>> f"{barrel_thickness(0.060, 0.002) * 1e3:.1f}"
    '8.7'
    """
    require("bore B", B, "m", above=0)
    require("ring thickness t_1", t_1, "m", above=0)
    return 0.03 * B + t_1 + 4.9e-3


def head_height(b_1: float, b_2: float, t_2: float, n_rings: int) -> float:
    r"""Height of the piston head.

    .. math:: L_{piston} = b_1 + n (t_2 + b_2)

    Parameters
    ----------
    b_1, b_2 : float
        Top land (t_H to 1.2 t_H) and the other lands (0.75 t_2 to t_2) [m]
    t_2 : float
        Axial thickness of a ring [m]
    n_rings : int
        Number of rings [-]

    Returns
    -------
    L_piston : float
        Height [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.10.

    Examples
    --------
    >>> f"{head_height(0.01375, 0.0015, 0.002, 3) * 1e3:.2f}"
    '24.25'
    """
    require("lands and ring", [b_1, b_2, t_2], "m", above=0)
    return b_1 + n_rings * (t_2 + b_2)
