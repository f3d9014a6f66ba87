"""Spring laws of the elastic hinge: force, stored energy and its inverse against the closing z.

         |<------ H ------>|
         |<- z ->|<- H-z ->|           z = 0: the spring has its free height H
    =====|-------|#########|=====      z > 0: it is shorter, F pushes the rollers outwards

A law is data: `law` turns a parameter record into a record of functions, all of them of z alone. Three laws, by name:
`air_gauge` (the paper's, which takes the excess pressure for the whole pressure), `air_absolute` (a real gas spring
with the atmosphere outside) and `coil`. A fourth, `air_thermal`, has a temperature besides and stands in `thermal`.

Source: Zotov et al. (2024), eq. (9).
"""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from mechsym.quantities import quantity, record


@record
class AirGauge:
    """Air spring as the paper prints it: the gauge pressure alone follows the polytrope."""

    A: float = quantity("m^2", low=1e-8, high=100, about="piston area")
    H: float = quantity("m", low=1e-4, high=100, about="free height of the gas column")
    p0: float = quantity("Pa", low=1, high=1e12, about="excess pressure at free height")
    n: float = quantity("-", low=1, high=2, about="polytropic index")


@record
class AirAbsolute:
    """Air spring with the absolute pressure on the polytrope and the atmosphere on the other side of the piston."""

    A: float = quantity("m^2", low=1e-8, high=100, about="piston area")
    H: float = quantity("m", low=1e-4, high=100, about="free height of the gas column")
    p0: float = quantity("Pa", low=1, high=1e12, about="excess pressure at free height")
    n: float = quantity("-", low=1, high=2, about="polytropic index")
    pa: float = quantity("Pa", default=101325.0, above=0, about="pressure outside")


@record
class Coil:
    """Linear coil spring."""

    k: float = quantity("N/m", above=0, about="stiffness")
    F0: float = quantity("N", low=0, about="preload at z = 0")
    H: float = quantity("m", low=1e-4, high=100, about="closing at which the coils touch")


@record
class SpringLaw:
    """Functions of one spring, or of many whose values are arrays; `force` on a float is plain Python and fast."""

    force: Callable[[Any], Any]  #: Closing z [m] to force, positive outwards [N]
    energy: Callable[[Any], Any]  #: Closing z [m] to stored energy, 0 at z = 0 [J]
    closing: Callable[[Any], Any]  #: Stored energy [J] to closing z [m], the inverse of `energy`
    pressure: Callable[[Any], Any] | None  #: Closing z [m] to excess pressure [Pa]; None for a spring without gas
    #: The law holds strictly between these closings; -inf where there is no bound [m]
    z_low: float
    z_high: float
    #: Stored energy at these bounds; +-inf where there is no bound [J]
    energy_low: float
    energy_high: float


def law(spring: AirGauge | AirAbsolute | Coil) -> SpringLaw:
    """The functions of a spring."""
    return LAWS[type(spring)](spring)


def gauge_pressure(z: Any, H: Any, p0: Any, n: Any) -> Any:
    r"""Excess pressure of the paper's air spring, for numbers and symbols alike.

    .. math:: p = p_0 \left(\frac{H}{H - z}\right)^n

    Parameters
    ----------
    z, H : float, ndarray or casadi.SX
        Closing and free height [m]
    p0 : float or casadi.SX
        Excess pressure at free height [Pa]
    n : float or casadi.SX
        Polytropic index [-]

    Returns
    -------
    p : same kind as z
        Excess pressure [Pa]

    Notes
    -----
    Source: Zotov et al. (2024), eq. (9).

    Examples
    --------
    >>> gauge_pressure(0.5, 1.0, 5e6, 1.0)
    10000000.0
    """
    return p0 * (H / (H - z)) ** n


def absolute_pressure(z: Any, H: Any, p0: Any, n: Any, pa: Any) -> Any:
    r"""Excess pressure of a real gas spring, for numbers and symbols alike.

    .. math:: p = (p_0 + p_a) \left(\frac{H}{H - z}\right)^n - p_a

    Parameters
    ----------
    z, H : float, ndarray or casadi.SX
        Closing and free height [m]
    p0, pa : float or casadi.SX
        Excess pressure at free height, and the pressure outside [Pa]
    n : float or casadi.SX
        Polytropic index [-]

    Returns
    -------
    p : same kind as z
        Excess pressure [Pa]

    Examples
    --------
    >>> absolute_pressure(0.5, 1.0, 5e6, 1.0, 1e5)
    10100000.0
    """
    return (p0 + pa) * (H / (H - z)) ** n - pa


def coil_force(z: Any, k: Any, F0: Any) -> Any:
    r"""Force of a linear spring, for numbers and symbols alike.

    .. math:: F = F_0 + k z

    Parameters
    ----------
    z : float, ndarray or casadi.SX
        Closing [m]
    k, F0 : float or casadi.SX
        Stiffness [N/m] and preload [N]

    Returns
    -------
    F : same kind as z
        Force outwards [N]

    Examples
    --------
    >>> coil_force(0.5, 10.0, 2.0)
    7.0
    """
    return F0 + k * z


def air_gauge(spring: AirGauge) -> SpringLaw:
    r"""Law of the paper: only the excess pressure counts.

    .. math:: F = A p_0 \left(\frac{H}{H - z}\right)^n, \qquad
              U = \frac{A p_0 H}{n - 1}\left[\left(\frac{H}{H - z}\right)^{n - 1} - 1\right]

    Returns
    -------
    law : SpringLaw
        With the inverse in closed form

    Notes
    -----
    Source: Zotov et al. (2024), eq. (9) and the left side of (10). At n = 1 the energy is the logarithm it tends to.
    """
    A, H, p0, n = spring.A, spring.H, spring.p0, spring.n
    full = A * p0 * H

    def energy(z: Any) -> Any:
        return full * _power_integral(-np.log1p(-np.asarray(z) / H), n - 1)

    def closing(U: Any) -> Any:
        return -H * np.expm1(-_inverse_power_integral(np.asarray(U) / full, n - 1))

    return SpringLaw(
        force=lambda z: A * gauge_pressure(z, H, p0, n),
        energy=energy,
        closing=closing,
        pressure=lambda z: gauge_pressure(z, H, p0, n),
        z_low=-math.inf,
        z_high=H,
        energy_low=-_inverse(full, n - 1),
        energy_high=math.inf,
    )


def air_absolute(spring: AirAbsolute) -> SpringLaw:
    r"""Law of a real gas spring: absolute pressure inside, the atmosphere outside.

    .. math:: F = A\left[(p_0 + p_a)\left(\frac{H}{H - z}\right)^n - p_a\right], \qquad
              U = A\left\{\frac{(p_0 + p_a) H}{n - 1}\left[\left(\frac{H}{H - z}\right)^{n - 1} - 1\right]
              - p_a z\right\}

    Returns
    -------
    law : SpringLaw
        With the inverse found by Newton's method

    Notes
    -----
    Below `z_low` the gas would pull. With s = -ln(1 - z/H) the energy is convex and increasing in s; dropping the work
    against the atmosphere, at most pa A H, gives a start to the right of the root, from where Newton's method
    falls onto it without overshooting.
    """
    A, H, p0, n, pa = spring.A, spring.H, spring.p0, spring.n, spring.pa
    full = A * (p0 + pa) * H
    s_low: Any = -np.log1p(p0 / pa) / n

    def energy_of(s: Any) -> Any:
        return full * _power_integral(s, n - 1) + A * pa * H * np.expm1(-s)

    def closing(U: Any) -> Any:
        U = np.asarray(U, dtype=float)
        s = _inverse_power_integral((U + A * pa * H) / full, n - 1)
        last, done = math.inf, np.zeros(np.shape(U), bool)
        for _ in range(60):
            step = (energy_of(s) - U) / (full * np.exp((n - 1) * s) - A * pa * H * np.exp(-s))
            s = s - step
            size = np.abs(step)
            # the steps fall until only rounding is left, which near z_low is more than the last digit of s
            done = done | (size <= 4e-16 * (1 + np.abs(s))) | (size >= last)
            if done.all():
                break
            last = size
        return -H * np.expm1(-s)

    return SpringLaw(
        force=lambda z: A * absolute_pressure(z, H, p0, n, pa),
        energy=lambda z: energy_of(-np.log1p(-np.asarray(z) / H)),
        closing=closing,
        pressure=lambda z: absolute_pressure(z, H, p0, n, pa),
        z_low=-H * np.expm1(-s_low),
        z_high=H,
        energy_low=energy_of(s_low),
        energy_high=math.inf,
    )


def coil(spring: Coil) -> SpringLaw:
    r"""Law of a linear spring.

    .. math:: F = F_0 + k z, \qquad U = F_0 z + \tfrac12 k z^2

    Returns
    -------
    law : SpringLaw
        With the inverse in closed form
    """
    k, F0, H = spring.k, spring.F0, spring.H

    def closing(U: Any) -> Any:
        # 2 U / (F0 + root) keeps its digits where (root - F0) / k would lose them; at F0 = U = 0 both are 0
        root = np.sqrt(F0**2 + 2 * k * np.asarray(U))
        if np.ndim(F0) == 0:
            return (root - F0) / k if F0 == 0 else 2 * np.asarray(U) / (F0 + root)
        return np.where(F0 == 0, root / k, 2 * np.asarray(U) / np.where(F0 == 0, 1.0, F0 + root))

    return SpringLaw(
        force=lambda z: coil_force(z, k, F0),
        energy=lambda z: F0 * z + k * z**2 / 2,
        closing=closing,
        pressure=None,
        z_low=-F0 / k,
        z_high=H,
        energy_low=-(F0**2) / (2 * k),
        energy_high=F0 * H + k * H**2 / 2,
    )


def _power_integral(s: Any, e: Any) -> Any:
    """Integral of exp(e s) from 0 to s: (exp(e s) - 1) / e, and s at e = 0."""
    if np.ndim(e):
        safe = np.where(e > 0, e, 1.0)
        return np.where(e > 0, np.expm1(safe * s) / safe, s)
    return np.expm1(e * s) / e if e > 0 else s


def _inverse_power_integral(q: Any, e: Any) -> Any:
    if np.ndim(e):
        safe = np.where(e > 0, e, 1.0)
        return np.where(e > 0, np.log1p(safe * q) / safe, q)
    return np.log1p(e * q) / e if e > 0 else q


def _inverse(full: Any, e: Any) -> Any:
    """full / e, infinite at e = 0."""
    if np.ndim(e):
        return np.where(e > 0, full / np.where(e > 0, e, 1.0), math.inf)
    return full / e if e > 0 else math.inf


LAWS: dict[type, Callable[[Any], SpringLaw]] = {AirGauge: air_gauge, AirAbsolute: air_absolute, Coil: coil}
