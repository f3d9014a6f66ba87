"""Films and friction of the exchangers of a Stirling engine, at each instant as in steady flow.

Diameters of ducts are hydraulic, d = 4 V/A_w; friction factors are Darcy's.
"""

import math
from typing import Any

import numpy as np

_LAMINAR, _TURBULENT = 2300.0, 4000.0


def viscosity(mu_0: float, T_0: float, sutherland: float, T: Any) -> Any:
    r"""Dynamic viscosity of a gas.

    .. math:: \mu = \mu_0 \frac{T_0 + S}{T + S} \left(\frac{T}{T_0}\right)^{3/2}

    Parameters
    ----------
    mu_0 : float
        Viscosity at T_0 [Pa*s]
    T_0, sutherland : float
        Temperature of reference, and constant S [K]
    T : float or ndarray
        Temperature [K]

    Returns
    -------
    mu : float or ndarray
        Viscosity, shape of T [Pa*s]

    Notes
    -----
    Source: W. Sutherland, Phil. Mag. 36 (1893); constants as in Urieli and Berchowitz (1984), appendix A. Valid: dilute
    gas, 200 K to 1200 K.

    Examples
    --------
    >>> round(viscosity(17.08e-6, 273.0, 112.0, 300.0) * 1e6, 2)  # air at 300 K; tables have 18.5
    18.39
    """
    return mu_0 * (T_0 + sutherland) / (T + sutherland) * (T / T_0) ** 1.5


def tube_friction(Re: Any) -> Any:
    r"""Friction factor of Darcy in a smooth tube.

    .. math:: f = 64/Re \ \text{(laminar)}, \qquad f = 0.316\,Re^{-1/4} \ \text{(turbulent)}

    Parameters
    ----------
    Re : float or ndarray
        Reynolds number of diameter and mean speed, above 0 [-]

    Returns
    -------
    f : float or ndarray
        Friction factor, shape of Re; between 2300 and 4000 a straight line in log Re [-]

    Notes
    -----
    Source: Hagen and Poiseuille; P. R. H. Blasius, VDI-Forschungsheft 131 (1913). Valid: steady flow at each instant,
    Re < 1e5.

    Examples
    --------
    >>> [round(float(tube_friction(Re)), 5) for Re in (640.0, 1e4)]
    [0.1, 0.0316]
    """
    Re = np.asarray(Re, dtype=float)
    return _between(Re, 64 / Re, 0.316 * Re**-0.25)


def tube_nusselt(Re: Any, Pr: float) -> Any:
    r"""Nusselt number in a tube of constant wall temperature.

    .. math:: Nu = 3.66, \qquad Nu = \frac{(f/8)(Re - 1000)\,Pr}{1 + 12.7\sqrt{f/8}\,(Pr^{2/3} - 1)},
              \quad f = (0.79 \ln Re - 1.64)^{-2}

    Parameters
    ----------
    Re : float or ndarray
        Reynolds number, above 0 [-]
    Pr : float
        Prandtl number [-]

    Returns
    -------
    Nu : float or ndarray
        Nusselt number, shape of Re: laminar, turbulent, and a straight line in log Re between 2300 and 4000 [-]

    Notes
    -----
    Source: V. Gnielinski, Int. Chem. Eng. 16 (1976) 359. Valid: developed flow, steady at each instant,
    0.5 < Pr < 2000, Re < 5e6.

    Examples
    --------
    >>> [round(float(tube_nusselt(Re, 0.7)), 2) for Re in (1000.0, 1e4)]
    [3.66, 29.82]
    """
    Re = np.asarray(Re, dtype=float)
    safe = np.maximum(Re, _LAMINAR)
    f = (0.79 * np.log(safe) - 1.64) ** -2
    turbulent = f / 8 * (safe - 1000) * Pr / (1 + 12.7 * np.sqrt(f / 8) * (Pr ** (2 / 3) - 1))
    return _between(Re, np.full_like(Re, 3.66), turbulent)


def _between(Re: Any, laminar: Any, turbulent: Any) -> Any:
    share = np.clip(np.log(Re / _LAMINAR) / math.log(_TURBULENT / _LAMINAR), 0.0, 1.0)
    return (1 - share) * laminar + share * turbulent


def screen_friction(Re: Any) -> Any:
    r"""Friction factor of Darcy in a stack of woven screens.

    .. math:: f = \frac{4}{Re}\,(54 + 1.43\,Re^{0.78})

    Parameters
    ----------
    Re : float or ndarray
        Reynolds number of hydraulic diameter and speed in the free area V/L, above 0 [-]

    Returns
    -------
    f : float or ndarray
        Friction factor, shape of Re [-]

    Notes
    -----
    Source: W. M. Kays, A. L. London, Compact Heat Exchangers, 2nd ed. 1964, fig. 7-9, as fitted by Urieli and
    Berchowitz (1984), appendix B (there by a factor 4 smaller, after Fanning). Valid: porosity 0.6 to 0.83,
    1 < Re < 1e3, steady flow.

    Examples
    --------
    >>> round(float(screen_friction(100.0)), 2)
    4.24
    """
    Re = np.asarray(Re, dtype=float)
    return 4 / Re * (54 + 1.43 * Re**0.78)


def screen_stanton(Re: Any, Pr: float) -> Any:
    r"""Stanton number in a stack of woven screens.

    .. math:: St = 0.46\,Re^{-0.4}/Pr

    Parameters
    ----------
    Re : float or ndarray
        Reynolds number as for `screen_friction`, above 0 [-]
    Pr : float
        Prandtl number [-]

    Returns
    -------
    St : float or ndarray
        Stanton number, shape of Re [-]

    Notes
    -----
    Source: Kays and London (1964), fig. 7-9, as fitted by Urieli and Berchowitz (1984), appendix B. Valid: porosity 0.6
    to 0.83, 1 < Re < 1e3.

    Examples
    --------
    >>> round(float(screen_stanton(100.0, 0.7)), 4)
    0.1042
    """
    return 0.46 * np.asarray(Re, dtype=float) ** -0.4 / Pr


def regenerator_effectiveness(ntu: float) -> float:
    r"""Effectiveness of a balanced regenerator with a heavy matrix.

    .. math:: \varepsilon = \frac{NTU}{1 + NTU}, \qquad NTU = \tfrac12\,St\,A_w/A

    Parameters
    ----------
    ntu : float
        Transfer units of matrix to matrix, half of those of one blow [-]

    Returns
    -------
    effectiveness : float
        Share of the heat that comes back [-]

    Notes
    -----
    Source: Kays and London (1964), balanced counter flow; Urieli and Berchowitz (1984), section 5.2. Valid: heat
    capacity of the matrix large against that of the gas of a blow.

    Examples
    --------
    >>> regenerator_effectiveness(99.0)
    0.99
    """
    return ntu / (1 + ntu)
