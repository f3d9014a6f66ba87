"""Bolts: core diameter from the load, and the standard thread that has it.

The rule of the source gives the CORE (root) diameter; a thread of that nominal diameter is too thin.
Source: Nunes (2017), ch. 4.3; thread: ISO 261 coarse pitches, root diameter d_3 = d - 1.226869 P (ISO 724).
"""

import numpy as np

from mechsym.errors import BadInput
from mechsym.sizing.checks import require

# nominal diameter [mm]: coarse pitch [mm] (ISO 261, first choice and 14, 18, 22)
COARSE = {
    3: 0.5, 4: 0.7, 5: 0.8, 6: 1.0, 8: 1.25, 10: 1.5, 12: 1.75, 14: 2.0, 16: 2.0, 18: 2.5, 20: 2.5, 22: 2.5,
    24: 3.0, 30: 3.5, 36: 4.0, 42: 4.5, 48: 5.0, 56: 5.5, 64: 6.0,
}  # fmt: skip


def core_diameter(p: float, B: float, n_bolts: int, sigma: float) -> float:
    r"""Core diameter of the bolts that hold a cylinder against its pressure.

    .. math:: d_c = \sqrt{\frac{B^2 p}{n\,\sigma}}

    Parameters
    ----------
    p : float
        Largest pressure [Pa]
    B : float
        Bore [m]
    n_bolts : int
        Number of bolts; 0.01 B/mm + 4 to 0.02 B/mm + 4 is usual [-]
    sigma : float
        Allowable tensile stress, 35 to 70 MPa [Pa]

    Returns
    -------
    d_c : float
        Core diameter [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.18. Print: the source takes it for the nominal diameter and chooses M10.

    Examples
    --------
    >>> [f"{core_diameter(9.604e6, 0.060, 5, s) * 1e3:.2f}" for s in (70e6, 35e6)]
    ['9.94', '14.06']
    """
    require("pressure p", p, "Pa", low=0)
    require("number of bolts", n_bolts, "-", low=2)
    require("allowable stress", sigma, "Pa", above=0)
    return np.sqrt(B**2 * p / (n_bolts * sigma))


def bolt_stress(p: float, B: float, n_bolts: int, d_c: float) -> float:
    r"""Tensile stress in the core of the bolts.

    .. math:: \sigma = \frac{B^2 p}{n\,d_c^2}

    Parameters
    ----------
    p : float
        Pressure [Pa]
    B : float
        Bore [m]
    n_bolts : int
        Number of bolts [-]
    d_c : float
        Core diameter [m]

    Returns
    -------
    sigma : float
        Stress, without preload [Pa]

    Notes
    -----
    Source: Nunes (2017), eq. 4.18 solved for the stress.

    Examples
    --------
    >>> f"{bolt_stress(9.604e6, 0.060, 5, root_diameter(10)) / 1e6:.0f}"
    '104'
    """
    require("core diameter d_c", d_c, "m", above=0)
    return B**2 * p / (n_bolts * d_c**2)


def root_diameter(nominal_mm: int) -> float:
    r"""Root diameter of a coarse metric thread.

    .. math:: d_3 = d - 1.226869\,P

    Parameters
    ----------
    nominal_mm : int
        Nominal diameter d of the thread [mm]

    Returns
    -------
    d_3 : float
        Root diameter [m]

    Raises
    ------
    BadInput
        No coarse thread of that size

    Notes
    -----
    Source: ISO 724.

    Examples
    --------
    >>> f"{root_diameter(10) * 1e3:.3f}"
    '8.160'
    """
    if nominal_mm not in COARSE:
        raise BadInput(f"thread M{nominal_mm} is not in the list; there are M{', M'.join(map(str, COARSE))}")
    return (nominal_mm - 1.226869 * COARSE[nominal_mm]) * 1e-3


def thread_for(d_c: float) -> int:
    """Smallest standard thread whose root is not thinner than asked.

    Parameters
    ----------
    d_c : float
        Core diameter needed [m]

    Returns
    -------
    nominal_mm : int
        Nominal diameter of the thread [mm]

    Raises
    ------
    BadInput
        Thicker than the largest thread in the list

    Notes
    -----
    Source: ISO 261 and 724.

    Examples
    --------
    >>> thread_for(9.94e-3), thread_for(14.06e-3)
    (14, 18)
    """
    require("core diameter d_c", d_c, "m", low=0, high=root_diameter(max(COARSE)), hint="take more bolts")
    return next(nominal for nominal in COARSE if root_diameter(nominal) >= d_c)
