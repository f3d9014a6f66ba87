r"""What friction leaves of the work of the gas: brake figures, and the one mechanical efficiency.

.. math:: p_{IMEP,gross} + p_{PMEP} = p_{IMEP,net}, \qquad p_{IMEP,net} - p_{FMEP} = p_{BMEP}, \qquad
          \eta_m = p_{BMEP}/p_{IMEP,net}

PMEP is negative where gas exchange costs work, and so no part of the mechanical efficiency. (Heywood 1988, section
2.7, divides by the gross work and counts pumping as friction.)
"""

import math

import numpy as np

from mechsym.files import Json
from mechsym.quantities.units import Joule, Kilogram, Pascal, Pure, Radian, RadPerSecond, Scalar, Volume, Watt


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
