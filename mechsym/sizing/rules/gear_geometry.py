"""Geometry of a spur pair, external or internal, at the standard centre distance: contact and pitting factor.

                 external                          internal (hypocycloid: d_2 = 2 d_1)
        O1 --- R_1 --- P --- R_2 --- O2       O2 --- O1 --- P      O2 O1 = R_2 - R_1

    rho_1, rho_2 radii of curvature of the flanks, counted along the line of action from the base circles
    x shift of the pinion, -x of the gear: long addendum on the pinion, short addendum on the gear

All lengths inside are in modules. Source: AGMA 908-B89, sections 4 and 5.

What makes a spur pair impossible: undercut, pointed tips, and the interferences of an internal pair.

All lengths are in modules. Source: AGMA 908-B89, section 7; internal pairs as in Elements of Metric Gear Technology
(SDP/SI), eqs. 5-3 to 5-7.
"""

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Pure, Radian, Scalar
from mechsym.sizing.checks import require


@record
class Pair:
    """A spur pair with long addendum pinion and short addendum gear."""

    kind: str = choice("external", "internal", about="gear with outer or inner teeth")
    module: float = quantity("m", above=0, about="module")
    teeth_1: float = quantity("-", low=6, about="teeth of the pinion")
    teeth_2: float = quantity("-", low=6, about="teeth of the gear")
    pressure_angle: float = quantity("rad", low=0.24, high=0.53, about="pressure angle, 14 to 30 degrees")
    #: Addendum modification of the pinion, the gear has the opposite [-]
    shift: float = quantity("-", default=0.0, low=-0.6, high=0.6, about="addendum modification of the pinion")
    whole_depth: float = quantity("-", default=2.35, low=2.0, high=2.6, about="whole depth in modules")
    tip_radius: float = quantity("-", default=0.27, low=0, high=0.4, about="tool tip radius in modules")
    thinning: float = quantity("-", default=0.024, low=0, high=0.1, about="tooth thinning in modules")

    def __post_init__(self) -> None:
        if self.teeth_1 % 1 or self.teeth_2 % 1:
            raise BadInput(f"teeth = {self.teeth_1:g}/{self.teeth_2:g} must be whole numbers")
        if self.kind == "internal" and self.teeth_2 <= self.teeth_1:
            raise BadInput(
                f"teeth_2 = {self.teeth_2:g} must be more than teeth_1 = {self.teeth_1:g} in an internal pair"
            )


def action_line(pair: Pair) -> tuple[Pure, Pure, Pure]:
    r"""Ends of contact on the line of action, as radii of curvature of the pinion's flank.

    .. math:: \rho_{end} = \sqrt{R_{a1}^2 - R_{b1}^2}, \qquad
              \rho_{start} = \pm\left(C\sin\varphi - \sqrt{R_{a2}^2 - R_{b2}^2}\right)

    pair: the pair; the upper sign is for an external, the lower for an internal one. Returns start, end, pitch: where
    the gear's tip and the pinion's tip end contact, and the base pitch, in modules.
    Source: AGMA 908-B89, section 4 (C_1, C_5, p_b).

    >>> pair = Pair(kind="external", module=1e-3, teeth_1=26, teeth_2=52, pressure_angle=0.4363323129985824)
    >>> "{:.4f} {:.4f} {:.4f}".format(*action_line(pair))
    '3.3011 7.5620 2.8472'
    """
    phi, sign = pair.pressure_angle, 1 if pair.kind == "external" else -1
    R_1, R_2 = pair.teeth_1 / 2, pair.teeth_2 / 2
    tip_1, tip_2 = R_1 + 1 + pair.shift, R_2 + sign * (1 - pair.shift)
    end = _flank(tip_1, R_1 * np.cos(phi))
    start = sign * ((R_2 + sign * R_1) * np.sin(phi) - _flank(tip_2, R_2 * np.cos(phi)))
    return start, end, np.pi * np.cos(phi)


def contact_ratio(pair: Pair) -> Pure:
    r"""Transverse contact ratio.

    .. math:: m_p = (\rho_{end} - \rho_{start}) / p_b

    Returns m_p: mean number of tooth pairs in contact. Source: AGMA 908-B89, section 4. A pair wants at least 1.2.

    >>> pair = Pair(kind="internal", module=1e-3, teeth_1=26, teeth_2=52, pressure_angle=0.4363323129985824)
    >>> f"{contact_ratio(pair):.3f}"
    '1.653'
    """
    start, end, pitch = action_line(pair)
    return (end - start) / pitch


def pitting_geometry_factor(pair: Pair) -> Pure:
    r"""Geometry factor for pitting resistance, at the lowest point of single tooth contact of the pinion.

    .. math:: I = \frac{\cos\varphi}{\left(\frac{1}{\rho_1} \pm \frac{1}{\rho_2}\right) d_1}, \qquad
              \rho_1 = \rho_{end} - p_b, \quad \rho_2 = C\sin\varphi \mp \rho_1

    pair: the pair; upper signs for an external, lower for an internal one. Raises BadInput: Contact ratio below 1 or
    not below 2.
    Source: AGMA 908-B89, section 4, spur gears. It gives every legible I of the source's annex (tables A.2 to A.4) to
    the printed digit. Print: Nunes (2017) takes I of an external pair for the internal one. Valid: 1 <= m_p < 2.

    >>> pair = Pair(kind="external", module=1e-3, teeth_1=26, teeth_2=55, pressure_angle=0.4363323129985824)
    >>> round(float(pitting_geometry_factor(pair)), 3)
    0.119
    """
    require(
        "contact ratio", contact_ratio(pair), "-", low=1, below=2, hint="the factor holds for one to two tooth pairs"
    )
    phi, sign = pair.pressure_angle, 1 if pair.kind == "external" else -1
    _, end, pitch = action_line(pair)
    rho_1 = end - pitch
    rho_2 = (pair.teeth_2 + sign * pair.teeth_1) / 2 * np.sin(phi) - sign * rho_1
    return np.cos(phi) / ((1 / rho_1 + sign / rho_2) * pair.teeth_1)


def tooth_thickness(pair: Pair, member: int) -> Pure:
    r"""Tooth thickness on the pitch circle, in modules.

    .. math:: s = \pi/2 \pm 2 x \tan\varphi - \Delta s

    Source: AGMA 908-B89, section 5.

    >>> pair = Pair(kind="external", module=1e-3, teeth_1=26, teeth_2=52, pressure_angle=0.4363323129985824)
    >>> round(float(tooth_thickness(pair, 1)), 4)
    1.5468
    """
    shift = pair.shift if member == 1 else -pair.shift
    return np.pi / 2 + 2 * shift * np.tan(pair.pressure_angle) - pair.thinning


def _flank(radius: Pure, base: Pure) -> Pure:
    require(
        "tip radius", radius, "-", low=base, hint="the tip lies inside the base circle: take more teeth or less shift"
    )
    return float(np.sqrt(radius**2 - base**2))


def top_land(pair: Pair) -> Pure:
    r"""Thickness of the pinion's tooth at its tip, in modules.

    .. math:: s_a = 2 R_a\left(\frac{s}{2R} + \mathrm{inv}\,\varphi - \mathrm{inv}\,\varphi_a\right)

    Returns s_a: top land of the pinion. Source: involute geometry. AGMA 908-B89 calls a tooth below 0.3 pointed.

    >>> pair = Pair(kind="external", module=1e-3, teeth_1=17, teeth_2=35, pressure_angle=0.4363323129985824, shift=0.5)
    >>> top_land(pair) < 0.3  # table A.4 marks it T
    True
    """
    phi, R = pair.pressure_angle, pair.teeth_1 / 2
    tip = R + 1 + pair.shift
    phi_a = np.arccos(R * np.cos(phi) / tip)
    return float(2 * tip * (tooth_thickness(pair, 1) / (2 * R) + _inv(phi) - _inv(phi_a)))


def undercut_shift(pair: Pair) -> Pure:
    r"""Shift that a rack-cut pinion needs to keep its involute down to the base circle.

    .. math:: x_{min} = h_a - \rho_a (1 - \sin\varphi) - \tfrac12 z \sin^2\varphi

    pair: the pair; h_a is the tool's addendum (whole depth - 1). Returns x_min: smallest shift of the pinion without
    undercut. Source: rack generation (AGMA 908-B89, section 7). Valid: teeth cut by a rack or hob.

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

    Returns margins: `involute` (contact begins outside the pinion's base circle) and `base` (the ring's inner circle
    outside its base circle) in modules [-], `tip` (the tips pass each other, fouling) [rad]. Raises BadInput: external
    pair.
    Source: Elements of Metric Gear Technology (SDP/SI), eqs. 5-3 to 5-7; the base circle: Nunes (2017), ch. 4.4.3.

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


def _inv(angle: Radian[Scalar]) -> Radian[Scalar]:
    return np.tan(angle) - angle
