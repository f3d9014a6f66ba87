"""Hertz contact of two cylinders along a line: pressure, width, and the load a contact bears.

Source: K. L. Johnson, Contact Mechanics (1985), ch. 4.2; example: R. L. Norton, Machine Design, example 7-2.
"""

import numpy as np

from mechsym.sizing.checks import require


def contact_modulus(E_1: float, nu_1: float, E_2: float, nu_2: float) -> float:
    r"""Contact modulus of two materials.

    .. math:: \frac{1}{E^*} = \frac{1 - \nu_1^2}{E_1} + \frac{1 - \nu_2^2}{E_2}

    Parameters
    ----------
    E_1, E_2 : float
        Moduli of elasticity [Pa]
    nu_1, nu_2 : float
        Poisson's ratios [-]

    Returns
    -------
    E_star : float
        Contact modulus [Pa]

    Notes
    -----
    Source: Johnson (1985), eq. 4.3.

    Examples
    --------
    >>> f"{contact_modulus(210e9, 0.3, 210e9, 0.3):.4g}"
    '1.154e+11'
    """
    require("modulus of elasticity", [E_1, E_2], "Pa", above=0)
    require("Poisson's ratio", [nu_1, nu_2], "-", low=0, below=0.5)
    return 1 / ((1 - nu_1**2) / E_1 + (1 - nu_2**2) / E_2)


def line_pressure(F: float, length: float, R_1: float, R_2: float, E_star: float) -> float:
    r"""Largest pressure between two parallel cylinders.

    .. math:: p_0 = \sqrt{\frac{F E^*}{\pi\,l}\left(\frac{1}{R_1} + \frac{1}{R_2}\right)}

    Parameters
    ----------
    F : float
        Normal load [N]
    length : float
        Length of the contact [m]
    R_1, R_2 : float
        Radii; negative for a hollow cylinder around the other, inf for a plane [m]
    E_star : float
        From `contact_modulus` [Pa]

    Returns
    -------
    p_0 : float
        Pressure in the middle of the contact [Pa]

    Raises
    ------
    BadInput
        The hollow cylinder is not larger than the one inside

    Notes
    -----
    Source: Johnson (1985), eq. 4.46. Valid: elastic, no friction, contact narrow against both radii.

    Examples
    --------
    A 12 in train wheel on its rail (Norton, example 7-2): 70243 psi.

    >>> E_star = contact_modulus(30e6, 0.28, 30e6, 0.28)
    >>> round(line_pressure(5000, 0.875, 6.0, float("inf"), E_star) / 1e2)
    702
    """
    require("load F", F, "N", low=0)
    require("contact length", length, "m", above=0)
    return np.sqrt(F * E_star / (np.pi * length) * _curvature(R_1, R_2))


def line_half_width(F: float, length: float, R_1: float, R_2: float, E_star: float) -> float:
    r"""Half width of the contact strip of two parallel cylinders.

    .. math:: a = \sqrt{\frac{4 F}{\pi\,l\,E^*\left(1/R_1 + 1/R_2\right)}}

    Parameters
    ----------
    F : float
        Normal load [N]
    length : float
        Length of the contact [m]
    R_1, R_2 : float
        Radii as in `line_pressure` [m]
    E_star : float
        From `contact_modulus` [Pa]

    Returns
    -------
    a : float
        Half width [m]

    Notes
    -----
    Source: Johnson (1985), eq. 4.43; a p_0 pi / 2 = F / l.

    Examples
    --------
    >>> E_star = contact_modulus(30e6, 0.28, 30e6, 0.28)
    >>> f"{line_half_width(5000, 0.875, 6.0, float('inf'), E_star):.4f}"  # Norton, example 7-2: 0.0518 in
    '0.0518'
    """
    require("load F", F, "N", low=0)
    require("contact length", length, "m", above=0)
    return np.sqrt(4 * F / (np.pi * length * E_star * _curvature(R_1, R_2)))


def _curvature(R_1, R_2):
    curvature = 1 / R_1 + 1 / R_2
    require("curvature 1/R_1 + 1/R_2", curvature, "1/m", above=0, hint="a hollow cylinder must be the larger")
    return curvature
