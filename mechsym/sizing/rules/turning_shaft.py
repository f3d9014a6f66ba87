"""Fatigue of a round section that turns against its bending load: every fibre has its own history, the worst counts.

Source: DE-Goodman (`goodman_factor`); the fibre at angle a of a shaft turned by beta feels M cos(beta + a - direction).

The planet's shaft as a beam on four journals: what the outer journals take, and the bending moment along it.

      F/2 (half of the crankpin's force; the middle does not turn, by symmetry)
       |        inner         gear        outer
    ---+--pin--[web]--seat----|----thin----|
       0                z_i   z_g          z_o

Journals are rigid, webs stiff. Source: beam theory (unit load method); one redundant reaction on each side.

Fatigue of shafts: endurance limit, notches, mean stress, and the factor of a load history (Goodman).

Source: Budynas and Nisbett, Shigley's Mechanical Engineering Design, ch. 6 and 7; notch factors: fits of Peterson's
charts in R. L. Norton, Machine Design, appendix.
"""

from collections.abc import Callable, Mapping

import numpy as np

from mechsym.errors import BadInput
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Array, Metre, Newton, NewtonMetre, Pascal, Pure, Radian, Scalar
from mechsym.sizing.checks import require
from mechsym.sizing.loads import Spans
from mechsym.sizing.rules.crankshaft import bending_stress, torsion_stress

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
    factor at each speed, shape (k,). Source: Shigley, eq. 7-15, without notches.

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
    web: float = quantity("m", above=0, about="web")  #: Thickness of the web [m]
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
    Source: unit load method. A uniform shaft with thin webs and journals at 1 and 3, gear at 2: s_F = 1/(4 + 8/3), s_T
    = (2 + 5/6)/(4 + 8/3).

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
    moment, shape (2, k, n). Source: statics with the redundant reaction of `outer_shares`.

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
    shape (k, n). Source: beam theory. Shigley, table 7-2, allows 0.0008 to 0.0012 rad for rollers under a steady load.

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


# k_a = a * (S_ut/MPa)^b
SURFACES = {"ground": (1.58, -0.085), "machined": (4.51, -0.265), "as-forged": (272.0, -0.995)}
# D/d: (A, b) of K_t = A (r/d)^b for a shoulder fillet
_BENDING = {1.2: (0.97098, -0.21796), 1.5: (0.93836, -0.25759), 2.0: (0.90879, -0.28598), 3.0: (0.89334, -0.30860)}
_TORSION = {1.2: (0.83425, -0.21649), 1.33: (0.84897, -0.23161), 2.0: (0.86331, -0.23865)}


def endurance_limit(S_ut: Pascal, d: Metre, surface: str) -> Pascal:
    r"""Endurance limit of a steel shaft in rotating bending.

    .. math:: S_e = k_a k_b \min(0.5\,S_{ut}, 700\,\mathrm{MPa}), \quad k_a = a (S_{ut}/\mathrm{MPa})^b

    with k_b = (d/7.62 mm)^-0.107 up to 51 mm, 1.51 (d/mm)^-0.157 above, and at most 1. S_ut: ultimate strength, up to
    2400 MPa; d: diameter, up to 254 mm. Source: Shigley, eqs. 6-8, 6-18 to 6-20. Valid: steels, 50 % reliability, room
    temperature. Shigley, example 7-1: k_a = 0.787, k_b = 0.870 and S_ut = 105 kpsi give 35.95 kpsi before the
    reliability; the factors unrounded give 35.99.

    >>> f"{endurance_limit(105 * 6.894757e6, 1.1 * 0.0254, 'machined') / 6.894757e6:.1f}"
    '36.0'
    """
    require("ultimate strength S_ut", S_ut, "Pa", low=200e6, high=2400e6, hint="the rule is for steels")
    require("diameter d", d, "m", low=2e-3, high=0.254)
    if surface not in SURFACES:
        raise BadInput(f"surface = {surface!r} is not an option; options are {', '.join(SURFACES)}")
    a, b = SURFACES[surface]
    size = (d / 7.62e-3) ** -0.107 if d <= 0.051 else 1.51 * (d * 1e3) ** -0.157
    return min(1.0, a * (S_ut / 1e6) ** b) * min(1.0, size) * min(0.5 * S_ut, 700e6)


def fillet_factor_bending(r: Metre, d: Metre, D: Metre) -> Pure:
    """Stress concentration of a shoulder fillet in bending.

    .. math:: K_t = A (r/d)^b

    r: radius of the fillet, 0.01 to 0.3 of d; d, D: smaller and larger diameter. Returns K_t: factor; used for K_f,
    which is on the safe side.
    Source: Norton's fit of Peterson's chart; D/d is taken at the next larger line of the chart, above 3 as 3.

    >>> f"{fillet_factor_bending(0.11, 1.1, 1.65):.2f}"  # Shigley, example 7-1, reads 1.68
    '1.70'
    """
    return _fillet(r, d, D, _BENDING)


def fillet_factor_torsion(r: Metre, d: Metre, D: Metre) -> Pure:
    """Stress concentration of a shoulder fillet in torsion.

    .. math:: K_{ts} = A (r/d)^b

    r: radius of the fillet, 0.01 to 0.3 of d; d, D: smaller and larger diameter. Returns K_ts: factor; used for K_fs.
    Source: Norton's fit of Peterson's chart; D/d is taken at the next larger line of the chart, above 2 as 2.

    >>> f"{fillet_factor_torsion(0.11, 1.1, 1.33 * 1.1):.2f}"  # Shigley, example 7-1, reads 1.42
    '1.45'
    """
    return _fillet(r, d, D, _TORSION)


def stress_cycle(stress: Pascal[Array]) -> tuple[Pascal[Array], Pascal[Array]]:
    r"""Amplitude and mean of a stress history.

    .. math:: \sigma_a = \tfrac12(\sigma_{max} - \sigma_{min}), \qquad \sigma_m = \tfrac12(\sigma_{max} + \sigma_{min})

    stress: signed stress over a period, shape (..., n). Returns amplitude, mean: of the largest cycle in the history,
    shape (...).
    Source: Shigley, eq. 6-36. The largest cycle of a period decides infinite life; smaller ones lie inside it.

    >>> [float(x) for x in stress_cycle(np.array([0.0, 3.0, -1.0]))]
    [2.0, 1.0]
    """
    stress = np.asarray(stress, dtype=float)
    high, low = stress.max(axis=-1), stress.min(axis=-1)
    return (high - low) / 2, (high + low) / 2


def goodman_factor(sigma_a: Pascal[Scalar], sigma_m: Pascal[Scalar], S_e: Pascal, S_ut: Pascal) -> Pure[Scalar]:
    r"""Fatigue safety factor on the modified Goodman line.

    .. math:: \frac1n = \frac{\sigma_a}{S_e} + \frac{\sigma_m}{S_{ut}}

    sigma_a, sigma_m: amplitude and mean of the equivalent stress, notches included; a mean of compression counts as 0.
    S_e: endurance limit. S_ut: ultimate strength. Returns n: safety factor against load, both parts growing alike.
    Source: Shigley, eqs. 6-46 and 7-7 (DE-Goodman). Shigley, problem 7-1 (8th ed.), d = 1.073 in for n = 2: both parts
    as 16/(pi d^3) times 2920 and 2391 lbf.in.

    >>> per = 16 / (np.pi * 1.073**3)
    >>> f"{goodman_factor(per * 2920, per * 2391, 30e3, 100e3):.2f}"
    '2.00'
    """
    require("strengths S_e, S_ut", [S_e, S_ut], "Pa", above=0)
    require("amplitude sigma_a", sigma_a, "Pa", low=0)
    with np.errstate(divide="ignore"):
        return 1 / np.asarray(np.asarray(sigma_a) / S_e + np.maximum(sigma_m, 0) / S_ut)


def shaft_diameter_goodman(
    moments: tuple[NewtonMetre, NewtonMetre, NewtonMetre, NewtonMetre],
    S_e: Pascal,
    S_ut: Pascal,
    n: Pure,
    K_f: Pure = 1.0,
    K_fs: Pure = 1.0,
) -> Metre:
    r"""Diameter of a shaft in bending and torsion for a wanted fatigue factor.

    .. math:: d = \left[\frac{16 n}{\pi}\left(\frac{\sqrt{4 (K_f M_a)^2 + 3 (K_{fs} T_a)^2}}{S_e}
              + \frac{\sqrt{4 (K_f M_m)^2 + 3 (K_{fs} T_m)^2}}{S_{ut}}\right)\right]^{1/3}

    moments: M_a, M_m, T_a, T_m: amplitude and mean of bending moment and torque. S_e, S_ut: endurance limit and
    ultimate strength. n: wanted safety factor. K_f, K_fs: notch factors in bending and torsion. Source: Shigley, eq.
    7-8 (DE-Goodman). Shigley, problem 7-1 (8th ed.): d = 1.073 in (in pounds and inches).

    >>> f"{shaft_diameter_goodman((600, 500, 400, 300), 30e3, 100e3, 2.0, K_f=2.2, K_fs=1.8):.3f}"
    '1.073'
    """
    require("wanted factor n", n, "-", above=0)
    require("notch factors", [K_f, K_fs], "-", low=1)
    M_a, M_m, T_a, T_m = moments
    A = np.sqrt(4 * (K_f * M_a) ** 2 + 3 * (K_fs * T_a) ** 2)
    B = np.sqrt(4 * (K_f * M_m) ** 2 + 3 * (K_fs * T_m) ** 2)
    return (16 * n / np.pi * (A / S_e + B / S_ut)) ** (1 / 3)


def _fillet(r: Metre, d: Metre, D: Metre, chart: Mapping[Pure, tuple[Pure, Pure]]) -> Pure:
    require("diameter d", d, "m", above=0)
    require("ratio D/d", D / d, "-", above=1, hint="without a shoulder there is no fillet")
    require("ratio r/d", r / d, "-", low=0.01, high=0.3, hint="the chart ends there")
    line = next((ratio for ratio in chart if ratio >= D / d - 1e-12), max(chart))
    A, b = chart[line]
    return max(1.0, A * (r / d) ** b)
