r"""From measured pressure back to combustion: heat release, burn points, exponents, cycle by cycle.

    Q(phi) = [p V/(gamma - 1)] + int p dV        apparent (net) heat release, from the closing of the inlet on
    Q_gross = Q + int dQ_L                        with a heat-transfer law for what the walls took meanwhile

The integral form needs no derivative of the noisy pressure. The burnt fraction is Q between its lowest value before
and its highest value after top dead centre. All of it stands on the dead centre: `sensitivity` says how much.

The figures of a combustion analysis, each with how well it is known.

IMEP +- sqrt(dead centre^2 + scatter^2)        the interval of the dead centre carried through, and the mean's own
COV between its chi bounds                     eleven cycles know it to 0.70 to 1.75 times, a hundred to 0.88 to 1.16
"""

import math
from collections.abc import Sequence
from typing import Annotated

import numpy as np
import scipy

from mechsym.cycle.chamber import Chamber, dvolume_dphi, piston_area, volume
from mechsym.cycle.heat import GasAtWall, Law, heat_flux
from mechsym.cycle.measured.signal import smooth
from mechsym.quantities import record
from mechsym.quantities.results import quantity, result
from mechsym.quantities.units import Array, Joule, Pascal, Pure, Radian

LEVELS = (0.1, 0.5, 0.9)
EARLIEST = math.radians(-45.0)  #: drift of the pressure earlier in compression is no combustion
_COMPRESSION = (math.radians(-90.0), math.radians(-30.0))
_EXPANSION = (math.radians(60.0), math.radians(110.0))


@result
class Combustion:
    """What one cycle's pressure says of its combustion; angles from firing dead centre."""

    work: float = quantity("J")  #: Net work over the period
    mean_indicated: float = quantity("Pa")  #: Work over swept volume
    p_max: float = quantity("Pa")  #: Peak pressure, absolute
    phi_p_max: float = quantity("rad")  #: Where that is
    heat: float = quantity("J")  #: Heat released, apparent or gross
    #: Where 10, 50 and 90 % are burnt; nan where combustion does not get there
    burn_angles: tuple[float, ...] = quantity("rad")
    n_compression: float = quantity("-")  #: Polytropic exponent from -90 to -30 degrees
    n_expansion: float = quantity("-")  #: Polytropic exponent from 60 to 110 degrees


@record
class Walls:
    """What a gross heat release needs to know."""

    law: Law  #: Heat transfer; Woschni's combustion term is left out
    mass: float  #: Mass of gas [kg]
    gas_constant: float  #: Specific gas constant [J/(kg*K)]
    omega: float  #: Crank speed [rad/s]


def heat_release(
    phi: Radian[Array], p: Pascal[Array], cylinder: Chamber, gamma: Pure, walls: Walls | None = None
) -> Joule[Array]:
    r"""Cumulative heat release.

    .. math:: Q(\varphi) = \frac{p V - p_0 V_0}{\gamma - 1} + \int_{\varphi_0}^{\varphi} p\,dV
        + \int_{\varphi_0}^{\varphi} \frac{q A_w}{\omega}\,d\varphi

    phi: ascending crank angles of the closed period, from firing TDC. p: absolute pressure. gamma: ratio of heat
    capacities. walls: adds the heat that went into the walls: gross instead of apparent. Returns q: 0 at phi[0].
    """
    v = volume(cylinder, phi)
    q = (p * v - p[0] * v[0]) / (gamma - 1) + cumulative(phi, p * dvolume_dphi(cylinder, phi))
    return q if walls is None else q + cumulative(phi, _wall_rate(phi, p, cylinder, walls))


def burnt_fraction(phi: Radian[Array], q: Joule[Array]) -> Pure[Array]:
    """Burnt fraction from the cumulative heat release.

    phi: ascending crank angles, from firing TDC. Returns burnt: 0 at the lowest value between 45 degrees before TDC and
    the highest one, 1 there, held outside.
    """
    top = int(np.argmax(q))
    first = min(int(np.searchsorted(phi, EARLIEST)), top)
    bottom = first + int(np.argmin(q[first : top + 1]))
    if q[top] <= q[bottom]:  # nothing burns
        return np.zeros_like(q)
    inside = np.clip((q - q[bottom]) / (q[top] - q[bottom]), 0.0, 1.0)
    return np.where(np.arange(q.size) <= bottom, 0.0, np.where(np.arange(q.size) >= top, 1.0, inside))


def burn_angles(phi: Radian[Array], burnt: Pure[Array], levels: Sequence[Pure] = LEVELS) -> tuple[Radian, ...]:
    """Crank angles at which given shares are burnt.

    phi: ascending crank angles; burnt: burnt fraction. Returns angles: last crossing of each level, straight between
    samples; nan if there is none.
    """
    angles = []
    for level in levels:
        below = np.flatnonzero(burnt < level)
        if not below.size or below[-1] + 1 >= burnt.size:
            angles.append(math.nan)
            continue
        k = int(below[-1])
        angles.append(float(phi[k] + (phi[k + 1] - phi[k]) * (level - burnt[k]) / (burnt[k + 1] - burnt[k])))
    return tuple(angles)


def polytropic_fit(phi: Radian[Array], p: Pascal[Array], cylinder: Chamber, first: Radian, last: Radian) -> Pure:
    r"""Exponent of the line log p over log V between two crank angles.

    .. math:: n = -d\log p/d\log V

    p: absolute pressure; samples that are not positive are left out. first, last: ends of the piece. Returns n:
    least-squares exponent.
    """
    inside = (phi >= first) & (phi <= last) & (p > 0)
    return -float(np.polyfit(np.log(volume(cylinder, phi[inside])), np.log(p[inside]), 1)[0])


def combustion(
    phi: Radian[Array],
    p: Pascal[Array],
    cylinder: Chamber,
    gamma: Pure,
    closed: tuple[Radian, Radian],
    walls: Walls | None = None,
) -> Combustion:
    """Work, peak, heat release, burn points and exponents of one cycle.

    phi: evenly spaced, ascending crank angles of one period, the closed part in one piece; p: absolute pressure; gamma:
    ratio of heat capacities; closed: ends of the closed part.
    """
    work = float(np.sum(p * dvolume_dphi(cylinder, phi)) * (phi[1] - phi[0]))
    inside = (phi >= closed[0]) & (phi <= closed[1])
    at, pressure = phi[inside], p[inside]
    q = heat_release(at, pressure, cylinder, gamma, walls)
    top = int(np.argmax(q))
    first = min(int(np.searchsorted(at, EARLIEST)), top)
    return Combustion(
        work=work,
        mean_indicated=work / cylinder.displacement,
        p_max=float(pressure.max()),
        phi_p_max=float(at[int(np.argmax(pressure))]),
        heat=float(q[top] - q[first : top + 1].min()),
        burn_angles=burn_angles(at, burnt_fraction(at, q)),
        n_compression=polytropic_fit(phi, p, cylinder, *_COMPRESSION),
        n_expansion=polytropic_fit(phi, p, cylinder, *_EXPANSION),
    )


def cumulative(phi: Radian[Array], rate: Annotated[Array, "J/rad"]) -> Joule[Array]:
    """Running integral, 0 at phi[0], by the trapezoidal rule. phi: ascending crank angles; rate: by angle."""
    return np.concatenate([[0.0], np.cumsum(np.diff(phi) * (rate[1:] + rate[:-1]) / 2)])


def wall_heat(phi: Radian[Array], p: Pascal[Array], cylinder: Chamber, walls: Walls) -> Joule:
    """Heat to the walls over angles. phi: ascending, from firing TDC; p: absolute pressure."""
    return float(cumulative(phi, _wall_rate(phi, p, cylinder, walls))[-1])


def _wall_rate(phi: np.ndarray, p: np.ndarray, cylinder: Chamber, walls: Walls) -> np.ndarray:
    v = volume(cylinder, phi)
    t = p * v / (walls.mass * walls.gas_constant)
    speed = cylinder.stroke * walls.omega / math.pi
    flux = heat_flux(walls.law, GasAtWall(p, t, v, walls.gas_constant, cylinder.bore, speed))
    return flux * (2 * piston_area(cylinder.bore) + 4 * v / cylinder.bore) / walls.omega


_LEVEL = 0.975
_DEG = 180 / math.pi
_HALF_TURN = math.pi


@record
class MeanPressures:
    """Mean indicated pressures of every cycle, shape (k,) each."""

    net: np.ndarray  #: Over the whole cycle [Pa]
    gross: np.ndarray  #: Over compression and expansion [Pa]


@result
class CombustionFigures:
    """What a combustion analysis is asked for; intervals hold the truth 19 times in 20."""

    imep_bar: float = quantity("bar", card="IMEP net")  #: Net indicated mean pressure, mean over the cycles
    #: Dead centre's interval and scatter of the cycles together
    imep_interval_bar: list[float] = quantity("bar")
    imep_gross_bar: float = quantity("bar", card="IMEP gross")  #: The same over compression and expansion
    imep_gross_interval_bar: list[float] = quantity("bar")  #: As that of the net one
    pmep_bar: float = quantity("bar", card="PMEP")  #: Net less gross: negative where the gas exchange takes work
    cycles_counted: int = quantity("-")  #: Cycles behind all means and variations
    cov_imep: float | None = quantity("-", card="COV of IMEP")  #: Deviation of the net IMEP by its mean
    cov_imep_interval: list[float] | None = quantity("-")  #: By the chi distribution
    cov_p_max: float | None = quantity("-", card="COV of largest pressure")  #: Deviation of the peak by its mean
    cov_p_max_interval: list[float] | None = quantity("-")  #: By the chi distribution
    p_max_bar: float = quantity("bar", card="largest pressure")  #: Peak, absolute, mean over the cycles
    p_max_highest_bar: float = quantity("bar")  #: Of the cycle with the highest peak
    p_max_deg: float = quantity("deg")  #: Where the peak lies, mean over the cycles
    rise_bar_deg: float = quantity("bar/deg", card="rate of rise")  #: Steepest rise of pressure, mean over the cycles
    ca10_deg: float | None = quantity("deg", card="CA10")  #: A tenth is burnt, mean over the cycles that get there
    ca50_deg: float | None = quantity("deg", card="CA50")  #: Half is burnt
    ca90_deg: float | None = quantity("deg", card="CA90")  #: Nine tenths are burnt
    ca50_interval_deg: list[float] | None = quantity("deg")  #: Dead centre's interval and scatter of the cycles
    wall_heat_j: float | None = quantity("J", card="wall heat")  #: Hohenberg's law, valves closed, walls of 430 K


def mean_pressures(phi: Radian[Array], cycles: Pascal[Array], cylinder: Chamber, later: Radian = 0.0) -> MeanPressures:
    r"""Net and gross mean indicated pressure.

    .. math:: p_{mi} = \frac{1}{V_d} \oint p\,dV, \quad p_{mi,gross} = \frac{1}{V_d} \int_{-\pi}^{\pi} p\,dV

    phi: evenly spaced crank angles of one period from half a turn or more before firing TDC. cycles: shape (k, n).
    later: by how much the dead centre lies behind where the angles have it.
    """
    at, step = phi - later, float(phi[1] - phi[0])
    work = cycles * dvolume_dphi(cylinder, at) * step / cylinder.displacement
    return MeanPressures(net=work.sum(axis=1), gross=work[:, np.abs(at) <= _HALF_TURN].sum(axis=1))


def variation(values: Array) -> tuple[Pure, list[Pure]] | None:
    r"""Coefficient of variation and its 95 % interval.

    .. math:: \frac{s}{\bar x}\left[\sqrt{\frac{n-1}{\chi^2_{0.975}}},\ \sqrt{\frac{n-1}{\chi^2_{0.025}}}\right]

    values: one a cycle [any unit]. Returns cov, interval: None with fewer than two values, or a mean that is not
    positive.
    Source: distribution of the variance of normal values; the mean's own error is left out (small beside it). Valid:
    values about normally distributed; a misfire among them widens it.

    >>> cov, (low, high) = variation(np.arange(11.0))
    >>> print(f"{low / cov:.2f} {high / cov:.2f}")
    0.70 1.75
    """
    n, mean = len(values), float(np.mean(values))
    if n < 2 or mean <= 0:
        return None
    cov = float(np.std(values, ddof=1)) / mean
    return cov, [cov * math.sqrt((n - 1) / scipy.special.chdtri(n - 1, 1 - level)) for level in (_LEVEL, 1 - _LEVEL)]


def interval(values: Array, by_dead_centre: float) -> tuple[float, list[float]]:
    """Mean of some values and its 95 % interval.

    values: one a cycle [any unit]. by_dead_centre: how far half the interval of the dead centre moves the mean [that
    unit]. Returns mean, interval: [that unit].
    """
    n, mean = len(values), float(np.mean(values))
    scatter = 0.0
    if n > 1:
        scatter = float(scipy.special.stdtrit(n - 1, _LEVEL)) * float(np.std(values, ddof=1)) / math.sqrt(n)
    half = math.hypot(by_dead_centre, scatter)
    return mean, [mean - half, mean + half]


def steepest(phi: Radian[Array], cycles: Pascal[Array], period: Radian) -> Array:
    """Steepest rise of pressure of every cycle, noise smoothed out, shape (k,) [Pa/rad]."""
    fine = np.linspace(-math.pi / 3, math.pi / 2, 601)
    rises = []
    for row in cycles:
        spline = smooth(phi, row, period, "spline")
        rises.append(float(spline.derivative()(phi[0] + np.remainder(fine - phi[0], period)).max()))
    return np.array(rises)


def combustion_figures(
    phi: Radian[Array],
    cycles: Pascal[Array],
    cylinder: Chamber,
    period: Radian,
    half: Radian,
    each: tuple[Combustion, ...],
    burn_50_by_angle: Pure,
    wall_heat: float | None,
) -> CombustionFigures:
    """Figures of measured cycles.

    phi, cycles: around compression, shape (n,), (k, n). half: half the interval of the dead centre. each: combustion of
    every cycle. burn_50_by_angle: how the angle of half burnt moves with the dead centre. wall_heat: to the walls [J].
    """
    here, early, late = (mean_pressures(phi, cycles, cylinder, by) for by in (0.0, -half, half))
    net, gross = (
        interval(getattr(here, name), abs(float(np.mean(getattr(early, name) - getattr(late, name)))) / 2)
        for name in ("net", "gross")
    )
    peaks = np.array([c.p_max for c in each])
    of_imep, of_peak = variation(here.net), variation(peaks)
    angles = np.array([c.burn_angles for c in each])
    burnt = [angles[np.isfinite(angles[:, k]), k] for k in range(3)]
    ca10, ca50, ca90 = (float(np.mean(some)) * _DEG if some.size else None for some in burnt)
    around = interval(burnt[1], burn_50_by_angle * half)[1] if burnt[1].size else None
    return CombustionFigures(
        imep_bar=net[0] / 1e5,
        imep_interval_bar=[end / 1e5 for end in net[1]],
        imep_gross_bar=gross[0] / 1e5,
        imep_gross_interval_bar=[end / 1e5 for end in gross[1]],
        pmep_bar=(net[0] - gross[0]) / 1e5,
        cycles_counted=len(each),
        cov_imep=None if of_imep is None else of_imep[0],
        cov_imep_interval=None if of_imep is None else of_imep[1],
        cov_p_max=None if of_peak is None else of_peak[0],
        cov_p_max_interval=None if of_peak is None else of_peak[1],
        p_max_bar=float(peaks.mean()) / 1e5,
        p_max_highest_bar=float(peaks.max()) / 1e5,
        p_max_deg=float(np.mean([c.phi_p_max for c in each])) * _DEG,
        rise_bar_deg=float(steepest(phi, cycles, period).mean()) / 1e5 / _DEG,
        ca10_deg=ca10,
        ca50_deg=ca50,
        ca90_deg=ca90,
        ca50_interval_deg=None if around is None else [end * _DEG for end in around],
        wall_heat_j=wall_heat,
    )
