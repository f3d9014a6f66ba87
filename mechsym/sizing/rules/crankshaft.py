"""Centre crankshaft: crankpin between two webs, shafts on both sides, straight beam statics.

             d_bearing
        |<-------------->|
        R       F        R        F on the middle of the pin, R = F/2 at the bearings
        ^   |===|====|   ^
     ---+---|web|pin |---+---     l_pin, d_pin;  web t x w

Source: Nunes (2017), ch. 4.5 and 4.6, after Khurmi and Gupta (2005).
"""

from typing import Any

import numpy as np

from mechsym.sizing.checks import require


def bearing_reaction(F: float, d_force: float, d_bearing: float) -> float:
    r"""Reaction of a bearing on the crankpin's load.

    .. math:: R = F\,d_{force}/d_{bearing}

    Parameters
    ----------
    F : float
        Load on the crankpin [N]
    d_force : float
        From the other bearing to the load [m]
    d_bearing : float
        Between the two bearings [m]

    Returns
    -------
    R : float
        Reaction [N]

    Notes
    -----
    Source: Nunes (2017), eq. 4.31. Print: F = 27410 N has two digits exchanged; it is 27140 N, R = 13570 N.
    Valid: two bearings, each free to tilt, all loads in one plane.

    Examples
    --------
    >>> bearing_reaction(27140.0, 0.043, 0.086)
    13570.0
    """
    require("distance between bearings", d_bearing, "m", above=0)
    require("distance of the load", d_force, "m", low=0, high=d_bearing, hint="the load must be between the bearings")
    return F * d_force / d_bearing


def crankpin_diameter(R: float, arm: float, sigma_b: float) -> float:
    r"""Diameter of a crankpin in bending.

    .. math:: d = \sqrt[3]{\frac{32 R\,a}{\pi\sigma_b}}

    Parameters
    ----------
    R : float
        Reaction at the bearing [N]
    arm : float
        From the bearing to the middle of the pin [m]
    sigma_b : float
        Allowable bending stress [Pa]

    Returns
    -------
    d : float
        Diameter [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.32. Valid: crank at dead centre, no torsion in the pin.

    Examples
    --------
    >>> [f"{crankpin_diameter(F / 2, 0.043, 454.7125e6) * 1e3:.2f}" for F in (27410.0, 27140.0)]
    ['23.63', '23.56']
    """
    require("reaction R", R, "N", low=0)
    require("arm", arm, "m", above=0)
    require("allowable stress sigma_b", sigma_b, "Pa", above=0)
    return (32 * R * arm / (np.pi * sigma_b)) ** (1 / 3)


def web_width(d_pin: float) -> float:
    r"""Usual width of a crank web.

    .. math:: w = 1.125\,d + 12.7\,\mathrm{mm}

    Parameters
    ----------
    d_pin : float
        Diameter of the crankpin [m]

    Returns
    -------
    w : float
        Width [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.33. Valid: a start for small forged crankshafts; the stress decides (`web_stress`).

    Examples
    --------
    >>> f"{web_width(0.025) * 1e3:.2f}"
    '40.83'
    """
    require("crankpin diameter", d_pin, "m", above=0)
    return 1.125 * d_pin + 12.7e-3


def web_stress(R: float, arm: float, l_pin: float, t: float, w: float) -> float:
    r"""Bending and direct stress of a crank web.

    .. math:: \sigma = \frac{6 R\left(a - \frac{l}{2} - \frac{t}{2}\right)}{w t^2} + \frac{R}{w t}

    Parameters
    ----------
    R : float
        Reaction at the bearing [N]
    arm : float
        From the bearing to the middle of the pin [m]
    l_pin : float
        Length of the crankpin [m]
    t, w : float
        Thickness and width of the web [m]

    Returns
    -------
    sigma : float
        Stress [Pa]

    Notes
    -----
    Source: Nunes (2017), eq. 4.34. Print: 118.074 MPa holds for F = 27410 N and w = 65 mm; the printed mass of the
    crankshaft leaves webs of 614 mm2: the outline of pin and shaft (`masses.web_outline`), not a disc of 65 mm.
    Valid: crank at dead centre, rectangular web, fillets without effect.

    Examples
    --------
    >>> f"{web_stress(27410.0 / 2, 0.043, 0.034, 0.015, 0.065) / 1e6:.3f}"
    '118.074'
    """
    require("web t and w", [t, w], "m", above=0)
    lever = arm - l_pin / 2 - t / 2
    require("lever of the web", lever, "m", low=0, hint="the bearing must stand outside the web")
    return 6 * R * lever / (w * t**2) + R / (w * t)


def shaft_diameter(T: float, tau: float) -> float:
    r"""Diameter of a round shaft in torsion.

    .. math:: d = \sqrt[3]{\frac{16 T}{\pi\tau}}

    Parameters
    ----------
    T : float
        Largest torque [N*m]
    tau : float
        Allowable shear stress [Pa]

    Returns
    -------
    d : float
        Diameter [m]

    Notes
    -----
    Source: Nunes (2017), eq. 4.35. Print: 7.82 mm is not what 243.6 N.m and 1250/1.5 MPa give; 78.2 N.m would.
    Valid: round solid shaft, torsion alone, elastic.

    Examples
    --------
    >>> [f"{shaft_diameter(T, 1250e6 / 1.5) * 1e3:.2f}" for T in (243.6, 78.2)]
    ['11.42', '7.82']
    """
    require("torque T", T, "N*m", low=0)
    require("allowable stress tau", tau, "Pa", above=0)
    return (16 * T / (np.pi * tau)) ** (1 / 3)


def bending_stress(M: Any, d: float) -> Any:
    r"""Bending stress of a round shaft.

    .. math:: \sigma = \frac{32 M}{\pi d^3}

    Parameters
    ----------
    M : float or ndarray
        Bending moment [N*m]
    d : float
        Diameter [m]

    Returns
    -------
    sigma : float or ndarray
        Stress at the surface [Pa]

    Notes
    -----
    Source: beam theory; eq. 4.32 of Nunes (2017) solved for the stress. Valid: round solid section, elastic.

    Examples
    --------
    >>> f"{bending_stress(13570 * 0.043, 0.025) / 1e6:.1f}"
    '380.4'
    """
    require("diameter d", d, "m", above=0)
    return 32 * M / (np.pi * d**3)


def torsion_stress(T: Any, d: float) -> Any:
    r"""Shear stress of a round shaft in torsion.

    .. math:: \tau = \frac{16 T}{\pi d^3}

    Parameters
    ----------
    T : float or ndarray
        Torque [N*m]
    d : float
        Diameter [m]

    Returns
    -------
    tau : float or ndarray
        Stress at the surface [Pa]

    Notes
    -----
    Source: eq. 4.35 of Nunes (2017) solved for the stress: his 8 mm shaft has 2423 MPa against 1250 MPa ultimate.
    Valid: round solid section, elastic.

    Examples
    --------
    >>> f"{torsion_stress(243.6, 0.008) / 1e6:.0f}"
    '2423'
    """
    require("diameter d", d, "m", above=0)
    return 16 * T / (np.pi * d**3)


def equivalent_stress(sigma: Any, tau: Any) -> Any:
    r"""Equivalent stress of distortion energy.

    .. math:: \sigma_v = \sqrt{\sigma^2 + 3\tau^2}

    Parameters
    ----------
    sigma, tau : float or ndarray
        Normal and shear stress [Pa]

    Returns
    -------
    sigma_v : float or ndarray
        Equivalent stress [Pa]

    Notes
    -----
    Source: von Mises; Shigley, eq. 5-15. Valid: ductile material, bending and torsion at one point.

    Examples
    --------
    >>> round(float(equivalent_stress(100.0, 0.0)))
    100
    """
    return np.sqrt(np.asarray(sigma) ** 2 + 3 * np.asarray(tau) ** 2)
