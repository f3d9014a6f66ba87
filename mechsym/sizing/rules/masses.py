"""Masses: volumes of simple bodies, roll-up of an engine, power to weight.

Source: Nunes (2017), ch. 4.2, 4.10 and 5.1.2.

Balance: mass moments of a rotor, and the shaking force that counterweights leave in a slider crank.

Source: Nunes (2017), ch. 4.6.1; slider cranks: Taylor, The Internal-Combustion Engine, vol. 2, ch. 8.
"""

from collections.abc import Mapping, Sequence
from typing import Annotated

import numpy as np

from mechsym.quantities.units import Area, Array, Kilogram, Metre, Scalar, Watt
from mechsym.sizing.checks import require


def cylinder_mass(density: Annotated[float, "kg/m^3"], d: Metre, length: Metre, bore: Metre = 0.0) -> Kilogram:
    r"""Mass of a round bar or tube.

    .. math:: m = \rho\,\tfrac{\pi}{4}(d^2 - d_i^2)\,l

    d, length: outer diameter and length; bore: inner diameter.
    Source: geometry; the shaft of table 4.15 (15 mm, 77 mm, 6675 kg/m3) has 90.8 g.

    >>> f"{cylinder_mass(6675.0, 0.015, 0.077) * 1e3:.1f}"
    '90.8'
    """
    require("diameter and length", [d, length], "m", low=0)
    require("bore", bore, "m", low=0, high=d, hint="the bore cannot be larger than the bar")
    return density * np.pi / 4 * (d**2 - bore**2) * length


def web_outline(d_1: Metre, d_2: Metre, e: Metre, points: int = 256) -> tuple[Metre[Array], Metre[Array]]:
    r"""Outline of the leanest crank web: two circles and their outer tangents.

    .. math:: \sin\beta = (R_1 - R_2)/e

    d_1, d_2: diameters of the circles around crankpin and shaft; e: distance of their centres. Returns x, y: points,
    the crankpin at the origin, the shaft at (e, 0), shape (points,). Source: geometry.

    >>> x, y = web_outline(0.025, 0.015, 0.013)
    >>> f"{x.max() * 1e3:.2f}"
    '20.50'
    """
    require("diameters", [d_1, d_2], "m", above=0)
    require("distance e", e, "m", low=abs(d_1 - d_2) / 2, hint="one circle would lie inside the other")
    touch = np.pi / 2 - np.arcsin((d_1 - d_2) / 2 / e)  # where the tangents touch, from the line of centres
    far = np.linspace(touch, 2 * np.pi - touch, points // 2)
    near = np.linspace(-touch, touch, points - points // 2)
    x = np.concatenate([d_1 / 2 * np.cos(far), e + d_2 / 2 * np.cos(near)])
    return x, np.concatenate([d_1 / 2 * np.sin(far), d_2 / 2 * np.sin(near)])


def area_and_centre(x: Metre[Array], y: Metre[Array]) -> tuple[Area, Metre]:
    r"""Area of a polygon and where its centre lies along x.

    .. math:: A = \tfrac12\sum (x_i y_{i+1} - x_{i+1} y_i)

    x, y: corners in order. Source: geometry. Print: the masses of table 4.14 of Nunes (2017) leave 614 mm2 for each
    web; the outline of bare pin and shaft has 613 mm2, the printed disc of 65 mm has 3318.

    >>> area, centre = area_and_centre(*web_outline(0.025, 0.015, 0.013))
    >>> f"{area * 1e6:.0f} {centre * 1e3:.1f}"
    '613 3.0'
    """
    u, v = np.roll(x, -1), np.roll(y, -1)
    cross = x * v - u * y
    area = float(cross.sum() / 2)
    return abs(area), float(((x + u) * cross).sum() / (6 * area))


def roll_up(parts: Mapping[str, tuple[float, int]]) -> Kilogram:
    r"""Mass of an assembly.

    .. math:: m = \sum n_i m_i

    parts: part to its mass [kg] and how many there are [-]. Source: Nunes (2017), ch. 5.1.2.

    >>> f"{roll_up({'piston': (0.2947, 2), 'cylinder': (1.9024, 1)}):.4f}"
    '2.4918'
    """
    require("masses", [mass for mass, _ in parts.values()], "kg", low=0)
    return float(sum(mass * count for mass, count in parts.values()))


def power_to_weight(power: Watt[Scalar], mass: Kilogram) -> Annotated[Scalar, "W/kg"]:
    """Power per mass.

    .. math:: P/m

    Returns ratio: power to weight. Source: Nunes (2017), fig. 5.13.

    >>> f"{power_to_weight(31.009e3, 13.4066) / 1e3:.3f}"
    '2.313'
    """
    require("mass", mass, "kg", above=0)
    return power / mass


def unbalance(parts: Sequence[tuple[float, float]]) -> Annotated[float, "kg*m"]:
    r"""Static unbalance of parts on one line through the axis.

    .. math:: U = \sum m_i b_i

    parts: mass [kg] and signed distance of its centre from the axis [m]. Source: Nunes (2017), eq. 4.37. Print:
    "g.mm/s2" is g.mm; the force is U omega^2, and the acceleration that the parts share is the centripetal one, not an
    angular acceleration. Table 4.15: shaft, two needle bearings and pinion at 13 mm, the output shaft set at -3.81 mm.

    >>> moving = [(0.0908, 0.013), (0.014, 0.013), (0.014, 0.013), (0.0953, 0.013)]
    >>> f"{unbalance(moving) * 1e6:.1f} {unbalance([(0.7298, -0.00381)]) * 1e6:.1f}"
    '2783.3 -2780.5'
    """
    require("masses", [mass for mass, _ in parts], "kg", low=0)
    return float(sum(mass * distance for mass, distance in parts))
