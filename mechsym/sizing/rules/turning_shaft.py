"""Fatigue of a round section that turns against its bending load: every fibre has its own history, the worst counts.

Source: DE-Goodman as in `fatigue.py`; the fibre at angle a of a shaft turned by beta feels M cos(beta + a - direction).

The planet's shaft as a beam on four journals: what the outer journals take, and the bending moment along it.

      F/2 (half of the crankpin's force; the middle does not turn, by symmetry)
       |        inner         gear        outer
    ---+--pin--[web]--seat----|----thin----|
       0                z_i   z_g          z_o

Journals are rigid, webs stiff. Source: beam theory (unit load method); one redundant reaction on each side.
"""

from collections.abc import Callable

import numpy as np

from mechsym.quantities import quantity, record
from mechsym.quantities.units import Array, Metre, Newton, NewtonMetre, Pascal, Pure, Radian
from mechsym.sizing.checks import require
from mechsym.sizing.loads import Spans
from mechsym.sizing.rules.crankshaft import bending_stress, torsion_stress
from mechsym.sizing.rules.fatigue import stress_cycle

_FIBRES = 24  # an even number: each has one opposite


@record
class Section:
    """A round section and what its material bears."""

    d: float = quantity("m", above=0, about="diameter")
    #: Endurance limit of the part and ultimate strength [Pa]
    S_e: float = quantity("Pa", above=0, about="endurance limit")
    S_ut: float = quantity("Pa", above=0, about="ultimate strength")
    K_f: float = quantity("-", default=1.0, low=1, about="notch factor in bending")
    K_fs: float = quantity("-", default=1.0, low=1, about="notch factor in torsion")
    bore: float = quantity("m", default=0.0, low=0, about="bore")

    def __post_init__(self) -> None:
        require("bore", self.bore, "m", below=self.d, hint="the bore must leave a wall")


def fatigue_factor(
    section: Section, M_x: NewtonMetre[Array], M_y: NewtonMetre[Array], turn: Radian[Array], T: NewtonMetre[Array]
) -> Pure[Array]:
    r"""Fatigue safety factor of a turning section at each speed.

    .. math:: \sigma(\alpha) = \frac{32}{\pi d^3}\left(M_x\cos(\beta + \alpha) + M_y\sin(\beta + \alpha)\right),
              \qquad \frac1n = \max_\alpha\left(\frac{\sigma_a^*}{S_e} + \frac{\sigma_m^*}{S_{ut}}\right)

    with equivalent stresses sigma* of bending and torsion, notches included. M_x, M_y: bending moment by the direction
    of the force that makes it, in a frame that does not turn, shape (k, n); turn: angle of the section in that frame;
    T: torque in the section, shape (k, n). Returns n: safety factor at each speed, shape (k,).
    Source: Shigley, eq. 7-7 (DE-Goodman), fibre by fibre. A constant moment on a turning shaft is fully reversed, a
    constant moment on a standing one is a mean stress.

    >>> section, angle = Section(d=0.01, S_e=1e8, S_ut=4e8), np.linspace(0, 2 * np.pi, 360, endpoint=False)
    >>> M, none = np.full((1, 360), np.pi * 0.01**3 / 32 * 5e7), np.zeros((1, 360))
    >>> [f"{fatigue_factor(section, M, none, turn, none)[0]:.2f}" for turn in (angle, 0 * angle)]
    ['2.00', '8.00']
    """
    hollow = 1 - (section.bore / section.d) ** 4
    tau_a, tau_m = stress_cycle(torsion_stress(np.asarray(T), section.d) / hollow)
    # moments in the section's own axes: turned once, they serve all fibres
    cos, sin, per_moment = np.cos(turn), np.sin(turn), bending_stress(1.0, section.d) / hollow
    along, across = M_x * cos + M_y * sin, M_y * cos - M_x * sin
    used = np.zeros(np.shape(M_x)[0])
    for alpha in np.arange(_FIBRES // 2) * 2 * np.pi / _FIBRES:
        sigma_a, sigma_m = stress_cycle(along * np.cos(alpha) + across * np.sin(alpha))
        # the fibre on the other side has the same amplitude and the opposite mean
        sigma_a, sigma_m = per_moment * sigma_a, per_moment * np.abs(sigma_m)
        amplitude = np.hypot(section.K_f * sigma_a, np.sqrt(3) * section.K_fs * tau_a)
        mean = np.hypot(section.K_f * sigma_m, np.sqrt(3) * section.K_fs * tau_m)
        used = np.maximum(used, amplitude / section.S_e + mean / section.S_ut)
    with np.errstate(divide="ignore"):
        return 1 / used


def static_factor(
    section: Section, M_x: NewtonMetre[Array], M_y: NewtonMetre[Array], T: NewtonMetre[Array], strength: Pascal
) -> Pure[Array]:
    r"""Factor against a static strength at each speed.

    .. math:: n = R / \max_\theta\sqrt{\sigma^2 + 3\tau^2}

    M_x, M_y, T: bending moment and torque, shape (k, n); strength: yield or ultimate strength R. Returns n: safety
    factor at each speed, shape (k,).
    Source: Shigley, eq. 7-15, without notches.

    >>> section, none = Section(d=0.008, S_e=7e8, S_ut=1.985e9), np.zeros((1, 1))
    >>> f"{static_factor(section, none, none, np.full((1, 1), 243.6), 1.565e9)[0]:.2f}"
    '0.37'
    """
    hollow = 1 - (section.bore / section.d) ** 4
    sigma = bending_stress(np.hypot(M_x, M_y), section.d) / hollow
    tau = torsion_stress(np.asarray(T), section.d) / hollow
    with np.errstate(divide="ignore"):
        return strength / np.sqrt(sigma**2 + 3 * tau**2).max(axis=-1)


_Piece = tuple[Metre, Metre, float]  # from, to, and what bends there, 1/I [1/m^4]


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


def outer_shares(shaft: Shaft) -> tuple[Pure, Pure]:
    r"""Shares of the loads that the outer journal takes.

    .. math::
        s_T &= \frac{\delta_T}{\delta_X}, \quad s_F = \frac{\delta_F}{\delta_X}, \quad L = z_o - z_i \\
        \delta_X &= \int_0^{z_i}\frac{L^2}{EI}\,\mathrm{d}z + \int_{z_i}^{z_o}\frac{(z_o - z)^2}{EI}\,\mathrm{d}z \\
        \delta_T &= \int_0^{z_i}\frac{(z_g - z_i) L}{EI}\,\mathrm{d}z
                    + \int_{z_i}^{z_g}\frac{(z_g - z)(z_o - z)}{EI}\,\mathrm{d}z, \quad
        \delta_F = \int_0^{z_i}\frac{(z_i - z) L}{EI}\,\mathrm{d}z

    Returns force, tooth: s_F of the pin's half force (in its own sense) and s_T of the load at the gear (against it).
    Source: unit load method.

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


def moment(
    z: Metre, spans: Spans, shares: tuple[Pure, Pure], force: Newton[Array], pull: Newton[Array]
) -> NewtonMetre[Array]:
    r"""Bending moment along the shaft, by the direction of the forces.

    .. math:: M(z) = -F\,[(z_i - z) - s_F L] + P\,[(z_g - z_i) - s_T L] \quad (z \le z_i)

    and the outer journal's reaction times its lever beyond the gear. z: place, up to the inner journal, or the gear
    itself; force, pull: half of the crankpin's force, and the load at the gear of one side, shape (2, k, n). Returns M:
    moment, shape (2, k, n).
    Source: statics with the redundant reaction of `outer_shares`.

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


def inner_slope(shaft: Shaft, E: Pascal, moment_at: Callable[[float], np.ndarray]) -> Radian[Array]:
    r"""Slope of the shaft at the inner journal.

    .. math:: \beta = \int_0^{z_i}\frac{M}{E I}\,\mathrm{d}z

    E: modulus of elasticity; moment_at: distance from the middle [m] -> moment (2, k, n) [N*m]. Returns beta: slope,
    shape (k, n).
    Source: beam theory. Shigley, table 7-2, allows 0.0008 to 0.0012 rad for rollers under a steady load.

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


def _segments(shaft: Shaft) -> tuple[list[_Piece], list[_Piece]]:
    """Pieces (from, to, 1/I) inside and outside the inner journal; the web is stiff."""
    z = shaft.spans
    pin = 64 / np.pi / (shaft.pin**4 - shaft.pin_bore**4)
    seat, thin = (64 / np.pi / d**4 for d in (shaft.seat, shaft.thin))
    face = shaft.pin_half + shaft.web
    inside = [(0.0, shaft.pin_half, pin), (face, z.inner, seat)]
    outside = [(z.inner, shaft.seat_end, seat), (shaft.seat_end, z.gear, thin), (z.gear, z.outer, thin)]
    return inside, outside


def _integral(pieces: list[_Piece], integrand: Callable[[Metre[Array]], Array]) -> float:
    """Simpson's rule, exact for the quadratics between the breaks."""
    total = 0.0
    for start, end, flexibility in pieces:
        x = np.array([start, (start + end) / 2, end])
        total += flexibility * (end - start) / 6 * float(np.dot([1, 4, 1], integrand(x)))
    return total
