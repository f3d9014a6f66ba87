"""What makes a spur pair impossible: undercut, pointed tips, and the interferences of an internal pair.

All lengths are in modules. Source: AGMA 908-B89, section 7; internal pairs as in Elements of Metric Gear Technology
(SDP/SI), eqs. 5-3 to 5-7.
"""

import numpy as np

from mechsym.errors import BadInput
from mechsym.sizing.rules.gear_geometry import Pair, action_line, tooth_thickness


def top_land(pair: Pair) -> float:
    r"""Thickness of the pinion's tooth at its tip, in modules.

    .. math:: s_a = 2 R_a\left(\frac{s}{2R} + \mathrm{inv}\,\varphi - \mathrm{inv}\,\varphi_a\right)

    Returns
    -------
    s_a : float
        Top land of the pinion [-]

    Notes
    -----
    Source: involute geometry. AGMA 908-B89 calls a tooth below 0.3 pointed.

    Examples
    --------
    >>> pair = Pair(kind="external", module=1e-3, teeth_1=17, teeth_2=35, pressure_angle=0.4363323129985824, shift=0.5)
    >>> top_land(pair) < 0.3  # table A.4 marks it T
    True
    """
    phi, R = pair.pressure_angle, pair.teeth_1 / 2
    tip = R + 1 + pair.shift
    phi_a = np.arccos(R * np.cos(phi) / tip)
    return float(2 * tip * (tooth_thickness(pair, 1) / (2 * R) + _inv(phi) - _inv(phi_a)))


def undercut_shift(pair: Pair) -> float:
    r"""Shift that a rack-cut pinion needs to keep its involute down to the base circle.

    .. math:: x_{min} = h_a - \rho_a (1 - \sin\varphi) - \tfrac12 z \sin^2\varphi

    Parameters
    ----------
    pair : Pair
        The pair; h_a is the tool's addendum (whole depth - 1)

    Returns
    -------
    x_min : float
        Smallest shift of the pinion without undercut [-]

    Notes
    -----
    Source: rack generation (AGMA 908-B89, section 7). Valid: teeth cut by a rack or hob.

    Examples
    --------
    >>> pair = Pair(kind="external", module=1e-3, teeth_1=12, teeth_2=26, pressure_angle=0.4363323129985824)
    >>> undercut_shift(pair) > 0  # table A.2 marks 12 teeth U
    True
    """
    phi = pair.pressure_angle
    straight = pair.whole_depth - 1 - pair.tip_radius * (1 - np.sin(phi))
    return float(straight - pair.teeth_1 / 2 * np.sin(phi) ** 2)


def interference_margins(pair: Pair) -> dict[str, float]:
    r"""Margins against the three interferences of an internal pair; all must be positive.

    .. math::
        \text{involute} &= \rho_{start}, \qquad
        \text{tip} = \tfrac{z_1}{z_2}\theta_1 + \mathrm{inv}\,\varphi - \mathrm{inv}\,\varphi_{a2} - \theta_2 \\
        \text{base} &= R_{a2} - R_{b2}

    Returns
    -------
    margins : dict of str to float
        `involute` (contact begins outside the pinion's base circle) and `base` (the ring's inner circle outside its
        base circle) in modules [-], `tip` (the tips pass each other, fouling) [rad]

    Raises
    ------
    BadInput
        External pair

    Notes
    -----
    Source: Elements of Metric Gear Technology (SDP/SI), eqs. 5-3 to 5-7; the base circle: Nunes (2017), ch. 4.4.3.

    Examples
    --------
    >>> pair = Pair(kind="internal", module=1e-3, teeth_1=26, teeth_2=52, pressure_angle=0.4363323129985824, shift=0.5)
    >>> all(margin > 0 for margin in interference_margins(pair).values())
    True
    """
    if pair.kind != "internal":
        raise BadInput("interference_margins is for internal pairs; an external pair wants undercut_shift")
    phi = pair.pressure_angle
    R_1, R_2 = pair.teeth_1 / 2, pair.teeth_2 / 2
    a, tip_1, tip_2 = R_2 - R_1, R_1 + 1 + pair.shift, R_2 - 1 + pair.shift
    base_1, base_2 = R_1 * np.cos(phi), R_2 * np.cos(phi)
    margins = {"involute": float(action_line(pair)[0]) if tip_2 > base_2 else tip_2 - base_2, "base": tip_2 - base_2}
    if tip_1 + a <= tip_2 or tip_2 <= base_2:
        return margins | {"tip": 0.0 if tip_2 <= base_2 else np.pi}
    theta_1 = np.arccos((tip_2**2 - tip_1**2 - a**2) / (2 * a * tip_1)) + _inv(np.arccos(base_1 / tip_1)) - _inv(phi)
    theta_2 = np.arccos((a**2 + tip_2**2 - tip_1**2) / (2 * a * tip_2))
    tip = pair.teeth_1 / pair.teeth_2 * theta_1 + _inv(phi) - _inv(np.arccos(base_2 / tip_2)) - theta_2
    return margins | {"tip": float(tip)}


def _inv(angle):
    return np.tan(angle) - angle
