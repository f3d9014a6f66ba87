r"""The oil film of a main bearing under a load that goes round: orbit of the journal and least film.

A short bearing (Ocvirk 1953) whose film carries pressure on the half that is squeezed and none on the other:

.. math:: \mathbf W = \frac{\mu L^3 R}{c^3} \int_{\mathbf v_s\cdot\mathbf n > 0}
   \frac{(\mathbf v_s\cdot\mathbf n)\,\mathbf n}{(1 - \boldsymbol\varepsilon\cdot\mathbf n)^3}\,d\psi

The load on the journal is W, v_s its velocity as seen from a frame that turns with half the shaft's speed (Booker
1965), c times eps its eccentricity. With Sommerfeld's angle the integral is one of sines and cosines, so it is exact;
the velocity for a load is found from it, where published mobilities are fits. Good for a bearing at most half as wide
as its diameter and eccentricities up to 0.8; beyond, a finite bearing carries less, and `finite_velocity` has
Butenschoen's fits for it.
"""

import cmath
import math
from functools import partial

import numpy as np

from mechsym.forces.mains import Journal, MainShaft
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pure, Radian, RadPerSecond, Watt

WIDE, FAR = 0.5, 0.8  #: Width over diameter and eccentricity up to which a short bearing is good [-]
FINITE, FINITE_FAR = (0.25, 1.0), 0.95  #: The same of the fits for a finite one, from and to [-]
_TOUCHING = 1 - 1e-9  # a step of the integrator may try more
_CYCLES = 12
_CLOSED = 1e-4  # change of the eccentricity from one cycle to the next


@record
class Orbit:
    """Where a journal is in its bearing over a cycle that repeats."""

    eccentricity: np.ndarray  #: shape (n,): x + iy in the block, over the clearance [-]
    thinnest: float  #: Least film over the cycle [m]
    power: float  #: Mean power that squeezing and shearing a full film take: an upper estimate of the heat [W]
    settled: bool  #: Whether two cycles agree


def impedance(eccentricity: Pure, direction: Radian) -> complex:
    """The integral above for an eccentricity along x and a velocity of 1 in a direction, x + iy [-]."""
    e, root = eccentricity, 1 - eccentricity * eccentricity
    low, high = (_sommerfeld(e, direction + side * math.pi / 2) for side in (-1, 1))
    sin_l, cos_l, sin_h, cos_h = math.sin(low), math.cos(low), math.sin(high), math.cos(high)
    doubled = sin_h * cos_h - sin_l * cos_l  # half of what sin(2 g) grows by
    cc = ((e * e + 0.5) * (high - low) + 2 * e * (sin_h - sin_l) + doubled / 2) / root**2.5
    cs = (e * (cos_l - cos_h) + (cos_l * cos_l - cos_h * cos_h) / 2) / root**2
    ss = (high - low - doubled) / 2 / root**1.5
    c, s = math.cos(direction), math.sin(direction)
    return complex(cc * c + cs * s, cs * c + ss * s)


def _sommerfeld(e: float, psi: float) -> float:
    """Sommerfeld's angle for 1 - e cos(psi), continuous for psi from -2 pi to 2 pi."""
    return 2 * math.atan2(math.sqrt((1 + e) / (1 - e)) * math.sin(psi / 2), math.cos(psi / 2))


def velocity(eccentricity: complex, load: complex) -> complex:
    """Velocity of the journal for a load, both over their units: (mu L^3 R/c^3) v = W.

    The load drives the motion, so the velocity stands within a quarter turn of it, and the direction of the impedance
    grows with that of the velocity.
    """
    from scipy.optimize import brentq

    e, turned = min(abs(eccentricity), _TOUCHING), (eccentricity / abs(eccentricity) if eccentricity else 1.0)
    seen = load / turned  # with the eccentricity along x
    across = (seen / abs(seen)).conjugate()
    beta = cmath.phase(seen)
    alpha = brentq(
        lambda alpha: (impedance(e, alpha) * across).imag, beta - math.pi / 2, beta + math.pi / 2, xtol=1e-12
    )
    return complex(turned * abs(seen) / abs(impedance(e, alpha)) * cmath.rect(1.0, alpha))


def rotation(eccentricity: Pure, width: Pure) -> tuple[Pure, Radian]:
    r"""Sommerfeld number over the eccentricity, and attitude, of a finite bearing in which the shaft turns.

    .. math:: \frac{So}{\varepsilon} = \frac{b^2}{2 (1 - \varepsilon^2)^2}
              \sqrt{\pi^2 (1 - \varepsilon^2) + 16 \varepsilon^2}\; \frac{a_1 (\varepsilon - 1)}{a_2 + \varepsilon},
              \qquad So = \frac{F \psi^2}{B D \eta\, \omega}

    eccentricity: over the clearance; width: b = B/D. Returns both: So over eps, and the angle from the load to the
    narrowest gap. Source: H.-J. Butenschoen, thesis, Karlsruhe (1976); coefficients as in the multibody code MBDyn.
    Valid: full bearing, film that ends where its pressure and slope are 0. Against a solution of Reynolds' equation,
    eccentricity 0.1 to 0.95: So within 6 % at B/D of 0.25, 0.5 and 1, 10 % at 0.75; the angle within 5 degrees.

    >>> so, angle = rotation(0.8, 0.5)
    >>> round(0.8 * so, 3), round(math.degrees(angle), 1)
    (1.784, 31.2)
    """
    e, b = eccentricity, width
    a1 = 1.1642 - 1.9456 * b + 7.1161 * b**2 - 10.1073 * b**3 + 5.0141 * b**4
    a2 = -1.000026 - 0.023634 * b - 0.4215 * b**2 - 0.038817 * b**3 - 0.090551 * b**4
    so = b**2 / (2 * (1 - e * e) ** 2) * math.sqrt(math.pi**2 * (1 - e * e) + 16 * e * e) * a1 * (e - 1) / (a2 + e)
    fit = (
        (1.152624 - 0.104565 * b)
        + (-2.5905 + 0.798745 * b) * e
        + (8.73393 - 2.3291 * b) * e**2
        + (-13.3414 + 3.424337 * b) * e**3
        + (6.6294 - 1.591732 * b) * e**4
    )
    return so, math.atan2(math.pi * math.sqrt(1 - e * e), 2 * e) * fit


def squeeze(eccentricity: Pure, width: Pure) -> Pure:
    r"""Sommerfeld number of a finite bearing whose gap is squeezed.

    .. math:: So_v = \frac{4 b^2}{(1 - \varepsilon^2)^{5/2}} \left[\left(\tfrac\pi2 - \tfrac12 \arccos\varepsilon\right)
              (1 + 2\varepsilon^2) + \tfrac32 \varepsilon \sqrt{1 - \varepsilon^2}\right]
              \frac{a_8 (1 - \varepsilon)}{-a_9 - \varepsilon}, \qquad
              So_v = \frac{F \psi^2}{B D \eta\, \dot\varepsilon}

    eccentricity: over the clearance, negative where it shrinks; width: b = B/D. Source and validity: as `rotation`;
    within 5 % at B/D of 0.25, 0.5 and 1, 19 % too large at 0.75.

    >>> round(squeeze(0.8, 0.5), 2)
    27.33
    """
    e, b = eccentricity, width
    a8 = 0.70038 + 3.2415 * b - 12.2486 * b**2 + 18.895 * b**3 - 9.3561 * b**4
    a9 = -0.999935 + 0.0157434 * b - 0.74224 * b**2 + 0.42278 * b**3 - 0.368928 * b**4
    half = (math.pi / 2 - math.acos(e) / 2) * (1 + 2 * e * e) + 1.5 * e * math.sqrt(1 - e * e)
    return 4 * b**2 * (1 - e * e) ** -2.5 * half * a8 * (1 - e) / (-a9 - e)


def finite_velocity(eccentricity: complex, load: complex, width: Pure) -> complex:
    """The same as `velocity`, for the same unit of the load, of a bearing of finite width B/D.

    The load across the line of centres says how fast the film turns, what is left along it how fast it is squeezed.
    """
    e = min(abs(eccentricity), _TOUCHING)
    turned = eccentricity / abs(eccentricity) if eccentricity else 1.0
    seen = 2 * width**2 * load / turned  # over B D eta omega / psi^2
    so, attitude = rotation(e, width)
    across = seen.imag / (2 * so * math.sin(attitude))
    left = seen.real - abs(seen.imag) / math.tan(attitude)
    return turned * complex(left / squeeze(math.copysign(e, left), width), across)


def orbit(journal: Journal, film: MainShaft, omega: RadPerSecond, phi: Radian[Array], period: Radian) -> Orbit:
    """Motion of a journal under its load, run until it repeats. phi: crank angles of the loads, evenly spaced."""
    from scipy.integrate import solve_ivp

    load = journal.x + 1j * journal.y
    unit = film.oil_viscosity * film.bearing_width**3 * film.journal_diameter / 2 * omega / film.clearance**2
    closed = np.append(load, load[0]) / unit
    angles = np.append(phi, period)
    half = 0.5j * journal.sense  # the frame of the squeeze turns with half the speed
    width = film.bearing_width / film.journal_diameter
    law = velocity if film.film == "short" else partial(finite_velocity, width=width)

    def slope(at: float, e: Array) -> list[float]:
        pull = np.interp(at % period, angles, closed)
        eps = complex(e[0], e[1])
        v = law(eps, complex(pull)) + half * eps if pull else half * eps
        return [v.real, v.imag]

    start, before = [0.3, 0.0], np.zeros(len(phi), dtype=complex)
    for cycle in range(_CYCLES):
        run = solve_ivp(slope, (0.0, period), start, "LSODA", angles, rtol=1e-6, atol=1e-8, max_step=period / 60)
        now = run.y[0, :-1] + 1j * run.y[1, :-1]
        settled = bool(cycle and np.abs(now - before).max() < _CLOSED)
        if settled:
            break
        start, before = run.y[:, -1].tolist(), now
    return Orbit(
        eccentricity=now,
        thinnest=film.clearance * (1 - float(np.abs(now).max())),
        power=_power(film, omega, now, load, journal.sense, period),
        settled=settled,
    )


def _power(film: MainShaft, omega: float, e: Array, load: Array, sense: float, period: float) -> Watt:
    radius = film.journal_diameter / 2
    shear = 2 * math.pi * film.oil_viscosity * omega**2 * radius**3 * film.bearing_width / film.clearance
    slopes = np.gradient(np.append(e, e[0]), np.linspace(0, period, len(e) + 1))[:-1]
    squeezed = (slopes - 0.5j * sense * e) * omega * film.clearance
    work = load.real * squeezed.real + load.imag * squeezed.imag
    return float(np.mean(shear / np.sqrt(1 - np.abs(e) ** 2) + work))


def beyond(film: MainShaft, orbit: Orbit) -> str:
    """What a short bearing is no longer good for; empty within its range."""
    wide, far = film.bearing_width / film.journal_diameter, float(np.abs(orbit.eccentricity).max())
    if film.film == "finite":
        low, high = FINITE
        if not low <= wide <= high:
            return f"a width of {wide:.2g} diameters: the law of a finite bearing is fitted from {low} to {high:g}"
        if far > FINITE_FAR:
            return f"an eccentricity of {far:.3g}: the law of a finite bearing is good up to {FINITE_FAR}"
    elif wide > WIDE:
        return (
            f"a width of {wide:.2g} diameters: a short bearing is good up to {WIDE}, a wider one carries less; take "
            "shaft.film = 'finite'"
        )
    elif far > FAR:
        return f"an eccentricity of {far:.3g}: a short bearing is good up to {FAR}"
    return "" if orbit.settled else f"its orbit does not repeat within {_CYCLES} cycles"
