r"""Friction of piston rings by a named rule, for one piston.

`patton1989` is a mean pressure fitted to small spark-ignition engines; `contact_pressure` is Coulomb's law with the
pressure of the rings on the wall, elastic and from the gas behind them.
"""

from typing import TYPE_CHECKING

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import quantity, record

if TYPE_CHECKING:
    from mechsym.cycle.gas import Gas


@record
class NoRings:
    """Section `[rings]`, `law = "none"`: sealing without friction."""


@record
class Patton1989:
    """Section `[rings]`, `law = "patton1989"`."""

    intake_ratio: float = quantity("-", default=1.0, above=0, about="intake over atmospheric pressure")


@record
class ContactPressure:
    """Section `[rings]`, `law = "contact_pressure"`."""

    mu: float = quantity("-", low=0, about="coefficient of friction of the rings")
    heights: tuple[float, ...] = quantity("m", above=0, about="axial height of each ring")
    gas_shares: tuple[float, ...] = quantity("-", low=0, high=1, about="part of the gas pressure behind each ring")
    #: Pressure of a ring's own tension on the wall [Pa]
    elastic: float = quantity("Pa", low=0, about="pressure of a ring's own tension")

    def __post_init__(self) -> None:
        if not self.heights or len(self.heights) != len(self.gas_shares):
            given = f"{len(self.heights)} heights and {len(self.gas_shares)} gas_shares"
            raise BadInput(f'{given}: rings need one of each, at least one; law = "none" leaves rings away')


Rings = NoRings | Patton1989 | ContactPressure


def ring_power(law: Rings, gas: "Gas", phi: np.ndarray, speed: np.ndarray, omega: float) -> np.ndarray:
    r"""Power lost at the rings of one piston.

    .. math::
        \text{Patton:}\; & f = 4.06\cdot10^4 \Bigl(1 + \frac{500}{n}\Bigr)\frac{1}{B^2}
            + 6.89\,\frac{p_i}{p_a}\bigl(0.088\,r_c + 0.182\,r_c^{\,1.33 - 0.0238\,\bar S_p}\bigr) \;\text{kPa},\\
        \text{contact:}\; & P = \mu\,\pi B \sum_i h_i\,(p_{el} + \kappa_i (p - p_{back}))\,|\dot x|

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Angles from the piston's firing dead centre, evenly spaced over a period [rad]
    speed : ndarray, shape (n,)
        Speed of the piston [m/s]
    omega : float
        Crank speed [rad/s]

    Returns
    -------
    power : ndarray, shape (n,)
        A mean rule is spread over the cycle like the speed of the piston [W]

    Notes
    -----
    Source: Patton, Nitschke, Heywood, SAE 890836 (1989), n in rpm, B in mm; four-stroke, bore 70 to 110 mm.
    """
    if isinstance(law, NoRings):
        return np.zeros_like(phi)
    if isinstance(law, ContactPressure):
        excess = np.maximum(gas.pressure.absolute(phi) - gas.p_back, 0.0)
        rows = zip(law.heights, law.gas_shares, strict=True)
        press = sum((h * (law.elastic + share * excess) for h, share in rows), np.zeros_like(phi))
        return law.mu * np.pi * gas.chamber.bore * press * np.abs(speed)
    mean = patton_pressure(law, gas, omega) * gas.chamber.area * gas.chamber.stroke * omega / gas.pressure.period
    return mean * np.abs(speed) / np.abs(speed).mean()


def patton_pressure(law: Patton1989, gas: "Gas", omega: float) -> float:
    """Mean pressure of ring friction after Patton, Nitschke and Heywood (1989).

    Parameters
    ----------
    omega : float
        Crank speed [rad/s]

    Returns
    -------
    fmep : float
        Friction mean effective pressure of the rings [Pa]

    Examples
    --------
    A bore of 80 mm at 3000 rpm: ring tension alone costs 7.4 kPa.
    """
    rpm, bore = omega * 30 / np.pi, gas.chamber.bore * 1e3
    mean_speed = gas.chamber.stroke * omega / np.pi
    tension = 4.06e4 * (1 + 500 / rpm) / bore**2
    ratio = gas.chamber.compression_ratio
    loading = 6.89 * law.intake_ratio * (0.088 * ratio + 0.182 * ratio ** (1.33 - 0.0238 * mean_speed))
    return float(1e3 * (tension + loading))
