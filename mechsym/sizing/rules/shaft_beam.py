"""The planet's shaft as a beam on four journals: what the outer journals take, and the bending moment along it.

      F/2 (half of the crankpin's force; the middle does not turn, by symmetry)
       |        inner         gear        outer
    ---+--pin--[web]--seat----|----thin----|
       0                z_i   z_g          z_o

Journals are rigid, webs stiff. Source: beam theory (unit load method); one redundant reaction on each side.
"""

from collections.abc import Callable

import numpy as np

from mechsym.quantities import quantity, record
from mechsym.sizing.checks import require
from mechsym.sizing.loads import Spans


@record
class Shaft:
    """Diameters and lengths of half a crankshaft, from the middle outwards."""

    spans: Spans
    pin: float = quantity("m", above=0, about="crankpin")
    pin_bore: float = quantity("m", low=0, about="its bore")
    pin_half: float = quantity("m", above=0, about="half its length")
    #: Thickness of the web [m]
    web: float = quantity("m", above=0, about="web")
    #: Shaft from the web through the inner journal: diameter and where it ends [m]
    seat: float = quantity("m", above=0, about="shaft at the inner journal")
    seat_end: float = quantity("m", above=0, about="end of the seat")
    thin: float = quantity("m", above=0, about="shaft beyond")

    def __post_init__(self) -> None:
        face = self.pin_half + self.web
        require("inner journal", self.spans.inner, "m", above=face, hint="it must stand outside the web")
        require("end of the seat", self.seat_end, "m", low=self.spans.inner, high=self.spans.gear)


def outer_shares(shaft: Shaft) -> tuple[float, float]:
    r"""Shares of the loads that the outer journal takes.

    .. math::
        s_T &= \frac{\delta_T}{\delta_X}, \quad s_F = \frac{\delta_F}{\delta_X}, \quad L = z_o - z_i \\
        \delta_X &= \int_0^{z_i}\frac{L^2}{EI}\,\mathrm{d}z + \int_{z_i}^{z_o}\frac{(z_o - z)^2}{EI}\,\mathrm{d}z \\
        \delta_T &= \int_0^{z_i}\frac{(z_g - z_i) L}{EI}\,\mathrm{d}z
                    + \int_{z_i}^{z_g}\frac{(z_g - z)(z_o - z)}{EI}\,\mathrm{d}z, \quad
        \delta_F = \int_0^{z_i}\frac{(z_i - z) L}{EI}\,\mathrm{d}z

    Returns
    -------
    force, tooth : float
        s_F of the pin's half force (in its own sense) and s_T of the load at the gear (against it) [-]

    Notes
    -----
    Source: unit load method.

    Examples
    --------
    A uniform shaft with thin webs and journals at 1 and 3, gear at 2: s_F = 1/(4 + 8/3), s_T = (2 + 5/6)/(4 + 8/3).

    >>> spans = Spans(inner=1.0, gear=2.0, outer=3.0, outboard=4.0)
    >>> shaft = Shaft(spans=spans, pin=1.0, pin_bore=0.0, pin_half=0.5, web=1e-9, seat=1.0, seat_end=1.0, thin=1.0)
    >>> "{:.4f} {:.4f}".format(*outer_shares(shaft))
    '0.1500 0.4250'
    """
    z = shaft.spans
    length, gear = z.outer - z.inner, z.gear - z.inner
    inside, outside = _segments(shaft)
    reaction = _integral(inside, lambda x: length**2 + 0 * x) + _integral(outside, lambda x: (z.outer - x) ** 2)
    tooth = _integral(inside, lambda x: gear * length + 0 * x)
    tooth += _integral(outside, lambda x: np.maximum(z.gear - x, 0) * (z.outer - x))
    force = _integral(inside, lambda x: (z.inner - x) * length)
    return force / reaction, tooth / reaction


def moment(z: float, spans: Spans, shares: tuple[float, float], force: np.ndarray, pull: np.ndarray) -> np.ndarray:
    r"""Bending moment along the shaft, by the direction of the forces.

    .. math:: M(z) = -F\,[(z_i - z) - s_F L] + P\,[(z_g - z_i) - s_T L] \quad (z \le z_i)

    and the outer journal's reaction times its lever beyond the gear.

    Parameters
    ----------
    z : float
        Place, up to the inner journal, or the gear itself [m]
    shares : (float, float)
        From `outer_shares` [-]
    force, pull : ndarray, shape (2, k, n)
        Half of the crankpin's force, and the load at the gear of one side [N]

    Returns
    -------
    M : ndarray, shape (2, k, n)
        Moment [N*m]

    Notes
    -----
    Source: statics with the redundant reaction of `outer_shares`.

    Examples
    --------
    >>> spans = Spans(inner=1.0, gear=2.0, outer=3.0, outboard=4.0)
    >>> float(moment(0.0, spans, (0.15, 0.425), np.array(-10.0), np.array(0.0)))
    7.0
    """
    length = spans.outer - spans.inner
    if z <= spans.inner:
        near, far = (spans.inner - z) - shares[0] * length, (spans.gear - spans.inner) - shares[1] * length
        return -near * np.asarray(force) + far * np.asarray(pull)
    require(
        "place z",
        z,
        "m",
        low=spans.gear,
        high=spans.outer,
        hint="the moment is given up to the journal and at the gear",
    )
    return (spans.outer - z) * (shares[0] * np.asarray(force) - shares[1] * np.asarray(pull))


def inner_slope(shaft: Shaft, E: float, moment_at: Callable[[float], np.ndarray]) -> np.ndarray:
    r"""Slope of the shaft at the inner journal.

    .. math:: \beta = \int_0^{z_i}\frac{M}{E I}\,\mathrm{d}z

    Parameters
    ----------
    E : float
        Modulus of elasticity [Pa]
    moment_at : callable
        Distance from the middle [m] -> moment (2, k, n) [N*m]

    Returns
    -------
    beta : ndarray, shape (k, n)
        Slope [rad]

    Notes
    -----
    Source: beam theory. Shigley, table 7-2, allows 0.0008 to 0.0012 rad for rollers under a steady load.

    Examples
    --------
    >>> spans = Spans(inner=1.0, gear=2.0, outer=3.0, outboard=4.0)
    >>> shaft = Shaft(spans=spans, pin=1.0, pin_bore=0.0, pin_half=0.5, web=1e-9, seat=1.0, seat_end=1.0, thin=1.0)
    >>> uniform = lambda z: np.full((2, 1, 1), np.pi / 64) * np.array([1, 0])[:, None, None]
    >>> round(float(inner_slope(shaft, 1.0, uniform)[0, 0]), 6)
    1.0
    """
    require("modulus E", E, "Pa", above=0)
    slope = np.zeros_like(np.asarray(moment_at(0.0), dtype=float))
    for start, end, flexibility in _segments(shaft)[0]:
        places = (start, (start + end) / 2, end)
        ends = sum(weight * moment_at(z) for weight, z in zip((1, 4, 1), places, strict=True))
        slope = slope + flexibility / E * (end - start) / 6 * ends
    return np.hypot(*slope)


def _segments(shaft):
    """Pieces (from, to, 1/I) inside and outside the inner journal; the web is stiff."""
    z = shaft.spans
    pin = 64 / np.pi / (shaft.pin**4 - shaft.pin_bore**4)
    seat, thin = (64 / np.pi / d**4 for d in (shaft.seat, shaft.thin))
    face = shaft.pin_half + shaft.web
    inside = [(0.0, shaft.pin_half, pin), (face, z.inner, seat)]
    outside = [(z.inner, shaft.seat_end, seat), (shaft.seat_end, z.gear, thin), (z.gear, z.outer, thin)]
    return inside, outside


def _integral(pieces, integrand):
    """Simpson's rule, exact for the quadratics between the breaks."""
    total = 0.0
    for start, end, flexibility in pieces:
        x = np.array([start, (start + end) / 2, end])
        total += flexibility * (end - start) / 6 * float(np.dot([1, 4, 1], integrand(x)))
    return total
