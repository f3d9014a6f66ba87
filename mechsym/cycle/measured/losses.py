"""What the walls and the rings take of a charge that does not burn: expected before anything is measured."""

import math

import numpy as np

from mechsym.cycle.chamber import Chamber, wall_area
from mechsym.cycle.heat import Annand, GasAtWall, Hohenberg, Woschni, heat_flux
from mechsym.quantities.units import Pure, RadPerSecond

_BOTTOM, _CHARGE, _WALL = 0.9e5, 340.0, 430.0  # Pa and K of a fresh charge, K of a wall: usual
_GAMMA, _R = 1.35, 287.0
#: By how much heat and blow-by change with the speed, and heat with the pressure, as exponents
HEAT_BY_SPEED, LEAK_BY_SPEED, HEAT_BY_PRESSURE = -0.3, -1.0, -0.2
_LEAK, _BORE, _PISTON_SPEED = 0.012, 0.08, 8.0


_HEAT, _LEAKS = 1.75, 2.2  # factors of a standard deviation: laws of heat differ by two to three, worn rings by more


def expected_losses(cylinder: Chamber, omega: RadPerSecond) -> tuple[tuple[float, float], tuple[float, float]]:
    r"""Losses of an unfired charge by three laws of heat transfer and a usual blow-by.

    .. math:: k_h = \frac{(\gamma - 1) q A_w}{p V \omega}, \quad
        k_l = 0.012\,\frac{80\,\mathrm{mm}}{B}\,\frac{8\,\mathrm{m/s}}{\bar S_p}

    Returns heat, leak: shares of the pressure lost at top dead centre to the walls, as the mean of the laws, and past
    the rings, each the middle of a log-normal distribution [1/rad] and its factor of a standard deviation [-].

    Sources: Woschni (1967), Annand (1963), Hohenberg (1979), without radiation; they differ by a factor of two to three
    (Heywood 1988, section 12.4). Blow-by: about 1 % of the charge at rated speed (Heywood 1988, section 8.6), through
    gaps that grow with the bore.
    Valid: charge of about 1 bar and 340 K, walls of 430 K.
    """
    t = _CHARGE * cylinder.compression_ratio ** (_GAMMA - 1)
    p = _BOTTOM * cylinder.compression_ratio**_GAMMA
    speed = cylinder.stroke * omega / math.pi
    state = GasAtWall(p, t, cylinder.clearance, _R, cylinder.bore, speed)
    laws = (
        Woschni(wall_temperature=_WALL),
        Annand(wall_temperature=_WALL, radiation=0.0),
        Hohenberg(wall_temperature=_WALL),
    )
    by = (_GAMMA - 1) * wall_area(cylinder, cylinder.clearance) / (p * cylinder.clearance * omega)
    shares = np.array([float(heat_flux(law, state)) for law in laws]) * by
    heat, leak = float(shares.mean()), _LEAK * _BORE / cylinder.bore * _PISTON_SPEED / speed
    return (heat, _HEAT), (leak, _LEAKS)


def log_normal(of: tuple[float, float], at: float) -> tuple[float, float]:
    """Middle and deviation of the normal distribution that is like a log-normal one near a value.

    of: middle [1/rad] and factor [-] of the log-normal one; at: the value [1/rad]. Returns normal: middle and
    deviation of the normal one [1/rad].

    >>> log_normal((0.1, math.e), 0.1)
    (0.1, 0.1)
    """
    middle, factor = of
    at = min(max(at, middle / factor**3), middle * factor**3)
    return at * (1 + math.log(middle / at)), at * math.log(factor)


def by_state(speed: Pure, pressure: Pure) -> tuple[Pure, Pure]:
    """Factors on heat and blow-by at another speed and pressure of the charge, each by that of the middle record."""
    return speed**HEAT_BY_SPEED * pressure**HEAT_BY_PRESSURE, speed**LEAK_BY_SPEED
