"""Stress cycle, reliability, temperature and reversal factors of AGMA 2101 and 2001: what a gear bears for how long.

Source: AGMA 2001-D04 as printed in Budynas and Nisbett, Shigley's Mechanical Engineering Design, ch. 14, and used by
Nunes (2017), ch. 4.4.2, who takes 1 for all of them (1e7 cycles, 99 %, below 120 degC, one-sided load).
"""

import functools

import numpy as np

from mechsym.errors import BadInput
from mechsym.sizing.checks import require

# Y_N = a * N^-e below 3e6 cycles (AGMA 2001-D04, bending), by the surface or core that the curve is for
_Y_N = {
    "160 HB": (2.3194, 0.0538), "250 HB": (4.9404, 0.1045), "nitrided": (3.517, 0.0817),
    "carburized": (6.1514, 0.1192), "400 HB": (9.4518, 0.148),
}  # fmt: skip


# a face width is searched for at the same few hundred speeds
@functools.lru_cache(maxsize=4096)
def life_factor_bending(N: float, surface: str = "nitrided") -> float:
    r"""Stress cycle factor for bending.

    .. math:: Y_N = 1.3558\,N^{-0.0178} \quad (N > 3\cdot10^6)

    Parameters
    ----------
    N : float
        Number of load cycles of one tooth, 1e3 to 1e10 [-]
    surface : str
        Curve below 3e6 cycles: `160 HB`, `250 HB`, `400 HB`, `nitrided` or `carburized`

    Returns
    -------
    Y_N : float
        Factor, about 1 at 1e7 cycles [-]

    Notes
    -----
    Source: AGMA 2001-D04, fig. 17 (upper curve above 3e6 cycles), as printed in Shigley, fig. 14-14.

    Examples
    --------
    >>> round(life_factor_bending(1e8, "250 HB"), 3)  # Shigley, example 14-4
    0.977
    """
    require("cycles N", N, "-", low=1e3, high=1e10, hint="AGMA draws the stress cycle factor in this range")
    if surface not in _Y_N:
        raise BadInput(f"surface = {surface!r} is not an option; options are {', '.join(_Y_N)}")
    a, e = _Y_N[surface]
    upper = 1.3558 * N**-0.0178
    return float(upper if N > 3e6 else max(a * N**-e, upper))


@functools.lru_cache(maxsize=4096)
def life_factor_contact(N: float, surface: str = "nitrided") -> float:
    r"""Stress cycle factor for pitting.

    .. math:: Z_N = 1.4488\,N^{-0.023} \quad (N > 10^7)

    Parameters
    ----------
    N : float
        Number of load cycles of one tooth, 1e4 to 1e10 [-]
    surface : str
        Curve below 1e7 cycles: `nitrided` (1.249 N^-0.0138) or `steel` (2.466 N^-0.056)

    Returns
    -------
    Z_N : float
        Factor, 1 at 1e7 cycles [-]

    Notes
    -----
    Source: AGMA 2001-D04, fig. 18 (upper curve above 1e7 cycles), as printed in Shigley, fig. 14-15.

    Examples
    --------
    >>> round(life_factor_contact(1e8, "steel"), 3)  # Shigley, example 14-4
    0.948
    """
    require("cycles N", N, "-", low=1e4, high=1e10, hint="AGMA draws the stress cycle factor in this range")
    curves = {"nitrided": (1.249, 0.0138), "steel": (2.466, 0.056)}
    if surface not in curves:
        raise BadInput(f"surface = {surface!r} is not an option; options are {', '.join(curves)}")
    a, e = curves[surface]
    return float(1.4488 * N**-0.023 if N > 1e7 else a * N**-e)


def reliability_factor(R: float) -> float:
    r"""Reliability factor.

    .. math:: K_R = 0.658 - 0.0759\ln(1 - R) \ (R < 0.99), \qquad 0.5 - 0.109\ln(1 - R) \ (R \ge 0.99)

    Parameters
    ----------
    R : float
        Reliability, 0.5 to 0.9999 [-]

    Returns
    -------
    K_R : float
        Factor, 1 at 99 % [-]

    Notes
    -----
    Source: fit of AGMA 2001-D04, table 11, as printed in Shigley, eq. 14-38.

    Examples
    --------
    >>> round(reliability_factor(0.99), 2), round(reliability_factor(0.9999), 2)
    (1.0, 1.5)
    """
    require("reliability R", R, "-", low=0.5, high=0.9999, hint="AGMA has no factor outside this range")
    return float(0.658 - 0.0759 * np.log(1 - R) if R < 0.99 else 0.5 - 0.109 * np.log(1 - R))


def temperature_factor(T: float) -> float:
    """Temperature factor: 1 up to 120 degC.

    Parameters
    ----------
    T : float
        Temperature of the gear blank, 273 to 393 K [K]

    Returns
    -------
    K_T : float
        1 [-]

    Raises
    ------
    BadInput
        Hotter: AGMA asks for a factor above 1 and gives no number

    Notes
    -----
    Source: Nunes (2017), ch. 4.4.2 (AGMA 2101-C95).

    Examples
    --------
    >>> temperature_factor(353.15)
    1.0
    """
    require("blank temperature T", T, "K", low=273.15, high=393.15, hint="AGMA gives no factor above 120 degC: cool it")
    return 1.0


def reversed_bending_factor(F_max: float, F_min: float) -> float:
    r"""What a tooth root bears of its allowable stress when the load on it also turns round.

    .. math:: Y_M = \frac{1}{1 - \tfrac{3}{7} R}, \qquad R = F_{min}/F_{max} \in [-1, 0]

    Parameters
    ----------
    F_max : float
        Larger load on one tooth over its cycle, in magnitude [N]
    F_min : float
        Largest load of the opposite sign, 0 or negative [N]

    Returns
    -------
    Y_M : float
        1 for one-sided, 0.7 for fully reversed load [-]

    Notes
    -----
    Source: 0.7 for reversed loading: AGMA 2001-D04, clause 16.2; the line between: ISO 6336-3, annex B with M = 0.4.

    Examples
    --------
    >>> round(reversed_bending_factor(9000.0, -9000.0), 3), reversed_bending_factor(9000.0, 0.0)
    (0.7, 1.0)
    """
    require("tooth load F_max", F_max, "N", above=0)
    require("opposite load F_min", F_min, "N", low=-F_max, high=0, hint="swap the flanks: F_max is the larger one")
    return 1.0 / (1.0 - 3.0 / 7.0 * (F_min / F_max))
