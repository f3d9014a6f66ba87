r"""The oil film of a main bearing under a load that goes round: orbit of the journal and least film.

A short bearing (Ocvirk 1953) whose film carries pressure on the half that is squeezed and none on the other:

.. math:: \mathbf W = \frac{\mu L^3 R}{c^3} \int_{\mathbf v_s\cdot\mathbf n > 0}
   \frac{(\mathbf v_s\cdot\mathbf n)\,\mathbf n}{(1 - \boldsymbol\varepsilon\cdot\mathbf n)^3}\,d\psi

The load on the journal is W, v_s its velocity as seen from a frame that turns with half the shaft's speed (Booker
1965), c times eps its eccentricity. With Sommerfeld's angle the integral is one of sines and cosines, so it is exact;
the velocity for a load is found from it, where published mobilities are fits. Good for a bearing at most half as wide
as its diameter and eccentricities up to 0.8; beyond, a finite bearing carries less.
"""

import cmath
import math

import numpy as np

from mechsym.forces.mains import Journal, MainShaft
from mechsym.quantities import record
from mechsym.quantities.units import Array, Pure, Radian, RadPerSecond, Watt

WIDE, FAR = 0.5, 0.8  #: Width over diameter and eccentricity up to which a short bearing is good [-]
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


def orbit(journal: Journal, film: MainShaft, omega: RadPerSecond, phi: Radian[Array], period: Radian) -> Orbit:
    """Motion of a journal under its load, run until it repeats.

    phi: crank angles, evenly spaced over the period, those of the loads.
    """
    from scipy.integrate import solve_ivp

    load = journal.x + 1j * journal.y
    unit = film.oil_viscosity * film.bearing_width**3 * film.journal_diameter / 2 * omega / film.clearance**2
    closed = np.append(load, load[0]) / unit
    angles = np.append(phi, period)
    half = 0.5j * journal.sense  # the frame of the squeeze turns with half the speed

    def slope(at: float, e: Array) -> list[float]:
        pull = np.interp(at % period, angles, closed)
        eps = complex(e[0], e[1])
        v = velocity(eps, complex(pull)) + half * eps if pull else half * eps
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
    if wide > WIDE:
        return f"a width of {wide:.2g} diameters: a short bearing is good up to {WIDE}, a wider one carries less"
    if far > FAR:
        return f"an eccentricity of {far:.3g}: a short bearing is good up to {FAR}"
    return "" if orbit.settled else f"its orbit does not repeat within {_CYCLES} cycles"
