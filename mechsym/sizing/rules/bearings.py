"""Rolling bearings: equivalent load, rating life, rating of a set, static factor.

Source: ISO 281 and ISO 76; worked examples from Budynas and Nisbett, Shigley's Mechanical Engineering Design, ch. 11.
"""

from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.sizing.checks import require

_RELIABILITY = {0.90: 1.0, 0.95: 0.64, 0.96: 0.55, 0.97: 0.47, 0.98: 0.37, 0.99: 0.25}


def life_exponent(kind: str) -> float:
    """Exponent of the life equation.

    Returns
    -------
    p : float
        3 for balls, 10/3 for rollers [-]

    Notes
    -----
    Source: ISO 281.

    Examples
    --------
    >>> life_exponent("ball")
    3.0
    """
    return 3.0 if kind == "ball" else 10 / 3


def equivalent_load(F: np.ndarray, kind: str, turns: np.ndarray | None = None) -> np.ndarray:
    r"""Constant load with the same life as a load history.

    .. math:: P = \left(\frac{\int |F|^p\,\mathrm{d}\varphi}{\int \mathrm{d}\varphi}\right)^{1/p}

    Parameters
    ----------
    F : ndarray, shape (..., n)
        Radial load at equal steps over a period [N]
    turns : ndarray, shape (n,), optional
        Turning of the bearing in each step, equal when not given [rad]

    Returns
    -------
    P : ndarray, shape (...)
        Equivalent dynamic load [N]

    Notes
    -----
    Source: ISO 281 with the linear damage rule. Valid: pure radial load.

    Examples
    --------
    Half of the turns at 8 kN, half unloaded, in a ball bearing: 8 / 2^(1/3).

    >>> f"{equivalent_load(np.array([8000.0, 0.0]), 'ball'):.0f}"
    '6350'
    """
    p = life_exponent(kind)
    weights = np.ones(np.shape(F)[-1]) if turns is None else np.asarray(turns, dtype=float)
    require("turns", weights, "rad", low=0)
    return (np.sum(np.abs(F) ** p * weights, axis=-1) / weights.sum()) ** (1 / p)


def set_rating(C: float, count: int, kind: str) -> float:
    r"""Dynamic rating of equal bearings side by side.

    .. math:: C_i = i^{7/9}\,C \quad\text{(rollers)}, \qquad i^{0.7}\,C \quad\text{(balls)}

    Parameters
    ----------
    C : float
        Rating of one bearing [N]
    count : int
        Number of bearings i [-]

    Returns
    -------
    C_i : float
        Rating of the set [N]

    Notes
    -----
    Source: ISO 281, clauses 5.1.2 and 7.1.2. Print: Nunes (2017), ch. 4.8, adds the dynamic ratings (30.2 kN for two).

    Examples
    --------
    >>> f"{set_rating(15100.0, 2, 'drawn-cup'):.0f}"
    '25889'
    """
    require("count", count, "-", low=1, high=8)
    return C * count ** (0.7 if kind == "ball" else 7 / 9)


def life_revolutions(C: float, P: Any, kind: str, reliability: float = 0.9) -> Any:
    r"""Rating life in revolutions.

    .. math:: L = a_1\left(\frac{C}{P}\right)^p 10^6

    Parameters
    ----------
    C : float
        Dynamic rating [N]
    P : float or ndarray
        Equivalent load, at most C / 2 for the life to be meant literally [N]
    reliability : float
        0.90, 0.95, 0.96, 0.97, 0.98 or 0.99 [-]

    Returns
    -------
    L : float or ndarray
        Revolutions that this share of bearings survives [-]

    Notes
    -----
    Source: ISO 281:2007, table 12 for a_1.

    Examples
    --------
    Shigley, problem 11-3 (8th ed.): 10.279 kN for 1440e6 revolutions needs C = 91.1 kN in a roller bearing.

    >>> f"{life_revolutions(91.1e3, 10.279e3, 'roller'):.3g}"
    '1.44e+09'
    """
    require("rating C and load P", np.append(np.atleast_1d(P), C), "N", above=0)
    if reliability not in _RELIABILITY:
        raise BadInput(f"reliability = {reliability} is not an option; options are {list(_RELIABILITY)}")
    return _RELIABILITY[reliability] * (C / P) ** life_exponent(kind) * 1e6


def required_rating(P: float, revolutions: float, kind: str) -> float:
    r"""Dynamic rating for a wanted life.

    .. math:: C = P\,(L/10^6)^{1/p}

    Parameters
    ----------
    P : float
        Equivalent load [N]
    revolutions : float
        Wanted life L [-]

    Returns
    -------
    C : float
        Rating [N]

    Notes
    -----
    Source: ISO 281.

    Examples
    --------
    >>> f"{required_rating(10.279e3, 1440e6, 'roller') / 1e3:.1f}"  # Shigley, problem 11-3 (8th ed.)
    '91.1'
    """
    require("load P", P, "N", low=0)
    require("wanted life", revolutions, "-", above=0)
    return P * (revolutions / 1e6) ** (1 / life_exponent(kind))


def life_hours(revolutions: Any, omega: Any) -> Any:
    r"""Life in hours at constant speed.

    .. math:: L_h = \frac{2\pi L}{3600\,|\omega|}

    Parameters
    ----------
    revolutions : float or ndarray
        Life in revolutions [-]
    omega : float or ndarray
        Speed of one ring relative to the other [rad/s]

    Returns
    -------
    L_h : float or ndarray
        Life [h]

    Notes
    -----
    Source: ISO 281.

    Examples
    --------
    >>> f"{life_hours(540e6, 300 * 2 * np.pi / 60):.0f}"  # Shigley, problem 11-1 (8th ed.): 30000 h
    '30000'
    """
    require("speed omega", np.abs(omega), "rad/s", above=0)
    return 2 * np.pi * revolutions / (3600 * np.abs(omega))


def static_factor(C0: float, F: Any) -> float:
    r"""Static safety factor.

    .. math:: s_0 = C_0 / F_{max}

    Parameters
    ----------
    C0 : float
        Static rating of the bearing or of all bearings of a set [N]
    F : float or ndarray
        Loads, of which the largest counts [N]

    Returns
    -------
    s_0 : float
        Factor; ISO 76 wants 1 for balls and 1.5 for rollers in normal service [-]

    Notes
    -----
    Source: ISO 76.

    Examples
    --------
    >>> f"{static_factor(2 * 24000.0, 27140.0):.2f}"
    '1.77'
    """
    require("rating C0", C0, "N", above=0)
    return float(C0 / np.max(np.abs(F)))
