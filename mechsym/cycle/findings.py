"""What a reader of a cycle has to know first: a model that reaches the ceiling of thermodynamics."""

import math
from collections.abc import Iterator

import numpy as np

from mechsym.cycle.figures import CycleFigures
from mechsym.page.finding import LOOK_AT, Finding
from mechsym.periodic import even_angles
from mechsym.quantities import RPM
from mechsym.quantities.display import figure, quantity_text
from mechsym.quantities.units import Pascal, RadPerSecond, Volume, Watt

_SAME = 1e-6  # of an efficiency: nearer to Carnot's no model with losses comes
_TEMPERATURES = ("T_e_max_k", "T_c_min_k")
_BEALE = 0.15  # of machines as built, heater at about 900 K [-]


def beale_power(mean_pressure: Pascal, swept: Volume, omega: RadPerSecond) -> Watt:
    r"""Shaft power that Stirling engines as built give, by the rule of Beale.

    .. math:: P = 0.15\, \bar p V \omega / 2\pi

    mean_pressure: of the gas over a turn; swept: volume that the hot piston sweeps. By G. Walker, Stirling
    Engines, Oxford University Press, 1980.

    >>> round(beale_power(5e5, 763e-6, 62.83), 1)
    572.2
    """
    return _BEALE * mean_pressure * swept * omega / (2 * math.pi)


def of_cycle(found: CycleFigures) -> Iterator[Finding]:
    r"""Unequal strokes, and Carnot's efficiency :math:`1 - T_c/T_e`, whose power is therefore an upper bound."""
    if found.apart:
        words = (
            f"strokes differ by up to {figure(100 * found.apart, 2)} %: every cylinder has the pressure of the first "
            "at the same share of its stroke"
        )
        yield Finding(rank=LOOK_AT, words=words, value=found.apart)
    if not all(name in found for name in (*_TEMPERATURES, "efficiency")):
        return
    hot, cold = (np.asarray(found[name], dtype=float) for name in _TEMPERATURES)
    ceiling = 1.0 - cold / hot
    at = int(np.argmax(found["efficiency"]))
    if abs(float(np.asarray(found["efficiency"])[at] - ceiling[at])) <= _SAME:
        power = quantity_text(1e3 * float(np.max(found["power_kw"])), "W", 4)
        words = (
            f"{figure(100 * ceiling[at], 4)} % is Carnot's efficiency between {figure(cold[at], 4)} and "
            f"{figure(hot[at], 4)} K: the model has no losses, and {power} is an upper bound{_as_built(found)}"
        )
        yield Finding(rank=LOOK_AT, words=words, value=float(ceiling[at]))


def _as_built(found: CycleFigures) -> str:
    """What such machines give as they are built, where the gas is known."""
    if found.source is None:
        return ""
    best = int(np.argmax(found["power_kw"]))
    omega = RPM * float(np.asarray(found["speed_rpm"])[best])
    gas = found.source.at(omega)
    mean = float(np.mean(gas.pressure.absolute(even_angles(gas.pressure.period))))
    power = found.get("cylinders", 1) * beale_power(mean, gas.chamber.displacement, omega)
    return f"; machines as built give about {quantity_text(power, 'W', 2)} (Beale's rule, 0.15 p f V)"
