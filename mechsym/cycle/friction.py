r"""Friction mean pressure by a named correlation, for brake figures where the mechanism itself declares no friction.

What friction leaves of the work of the gas: brake figures, and the one mechanical efficiency.

.. math:: p_{IMEP,gross} + p_{PMEP} = p_{IMEP,net}, \qquad p_{IMEP,net} - p_{FMEP} = p_{BMEP}, \qquad
          \eta_m = p_{BMEP}/p_{IMEP,net}

PMEP is negative where gas exchange costs work, and so no part of the mechanical efficiency. (Heywood 1988, section
2.7, divides by the gross work and counts pumping as friction.)
"""

import math

import numpy as np

from mechsym.files import Json
from mechsym.quantities import quantity, record
from mechsym.quantities.units import (
    Joule,
    Kilogram,
    MetrePerSecond,
    Pascal,
    Pure,
    Radian,
    RadPerSecond,
    Scalar,
    Volume,
    Watt,
)


@record
class NoFriction:
    """Section `[friction_pressure]`, `law = "none"`: brake figures equal indicated figures."""


@record
class MechanismFriction:
    """Section `[friction_pressure]`, `law = "mechanism"`: Chen and Flynn's form fitted to the friction of the joints.

    A case with it needs `[friction]`; `cycle.engine` puts the fitted `ChenFlynn` in its place.
    """


@record
class ChenFlynn:
    """Section `[friction_pressure]`, `law = "chen_flynn"`."""

    #: Part that is always there [Pa]
    constant: float = quantity("Pa", default=0.4e5, low=0, about="constant part")
    per_peak_pressure: float = quantity("-", default=0.005, low=0, about="share of the peak pressure")
    #: Part proportional to the mean piston speed [Pa*s/m]
    per_speed: float = quantity("Pa*s/m", default=0.09e5, low=0, about="per mean piston speed")
    per_speed_squared: float = quantity("Pa*s^2/m^2", default=0.0009e5, low=0, about="per its square")


@record
class Heywood:
    """`[friction_pressure] law = "heywood"`: motored four-cylinder spark-ignition engines of 0.8 to 2 litres."""

    #: fmep = constant + per_speed n + per_speed_squared n^2 [Pa], n in 1000 rpm
    constant: float = quantity("Pa", default=0.97e5, low=0, about="constant part")
    per_speed: float = quantity("Pa", default=0.15e5, low=0, about="per 1000 rpm")
    per_speed_squared: float = quantity("Pa", default=0.05e5, low=0, about="per (1000 rpm)^2")


Friction = NoFriction | ChenFlynn | Heywood


def friction_pressure(
    law: Friction, p_max: Pascal[Scalar], piston_speed: MetrePerSecond[Scalar], omega: RadPerSecond[Scalar]
) -> Pascal[Scalar]:
    r"""Friction mean effective pressure.

    .. math::
        \text{Chen-Flynn:}\quad & f = A + B\,p_{max} + C\,\bar S_p + D\,\bar S_p^2 \\
        \text{Heywood:}\quad & f = 0.97 + 0.15\,n + 0.05\,n^2 \;\text{bar}, \; n \text{ in 1000 rpm}

    p_max: peak pressure. Sources: Chen and Flynn (1965), SAE 650733, with coefficients of usual size; Heywood (1988),
    eq. (13.6).
    """
    match law:
        case NoFriction():
            return 0.0 * omega
        case ChenFlynn():
            speed = law.per_speed * piston_speed + law.per_speed_squared * piston_speed**2
            return law.constant + law.per_peak_pressure * p_max + speed
        case Heywood():
            n = omega * 60 / (2 * 3.141592653589793) / 1000
            return law.constant + law.per_speed * n + law.per_speed_squared * n**2
    raise TypeError(f"no friction correlation for {type(law).__name__}")


def brake_figures(
    work: Joule[Scalar],
    friction: Pascal[Scalar],
    displacement: Volume[Scalar],
    angle: Radian,
    omega: RadPerSecond[Scalar],
    fuel: tuple[Kilogram[Scalar], Joule[Scalar]] = (math.nan, math.nan),
) -> Json:
    """Figures after friction under the names of `columns.CycleColumns`; nan of what is not known.

    work: net work of the gas in a cycle; friction: friction mean effective pressure; displacement: swept volume;
    angle: of a cycle; fuel: of a cycle, and its heating value.
    """
    left = work - friction * displacement
    gives = np.where(left > 0, left, np.nan)
    return {
        "friction_mep_kpa": friction / 1e3,
        "brake_mep_kpa": left / displacement / 1e3,
        "brake_torque": left / angle,
        "brake_power_kw": left / angle * omega / 1e3,
        "brake_sfc_g_kwh": (3.6e9 * fuel[0] / gives)[()],
        "brake_efficiency": left / fuel[1],
        "mechanical_efficiency": mechanical_efficiency(left, work),
    }


def mechanical_efficiency(brake: Watt[Scalar], indicated: Watt[Scalar]) -> Pure[Scalar]:
    """Brake by net indicated power, works and mean pressures alike; nan without power, or where no friction is known.

    >>> float(mechanical_efficiency(0.97, 1.15)), float(mechanical_efficiency(1.15, 1.15))
    (0.8434782608695652, nan)
    """
    known = (np.asarray(indicated) > 0) & (np.asarray(brake) != np.asarray(indicated))
    return (brake / np.where(known, indicated, np.nan))[()]
