r"""From measured pressure back to combustion: heat release, burn points, exponents, cycle by cycle.

    Q(phi) = [p V/(gamma - 1)] + int p dV        apparent (net) heat release, from the closing of the inlet on
    Q_gross = Q + int dQ_L                        with a heat-transfer law for what the walls took meanwhile

The integral form needs no derivative of the noisy pressure. The burnt fraction is Q between its lowest value before
and its highest value after top dead centre. All of it stands on the dead centre: `sensitivity` says how much.
"""

import math
from collections.abc import Sequence
from typing import Annotated

import numpy as np

from mechsym.cycle.chamber import Chamber, dvolume_dphi, piston_area, volume
from mechsym.cycle.heat import GasAtWall, Law, heat_flux
from mechsym.quantities import record
from mechsym.quantities.results import quantity, result
from mechsym.quantities.units import Array, Joule, Pascal, Pure, Radian

LEVELS = (0.1, 0.5, 0.9)
_EARLIEST = math.radians(-45.0)  # drift of the pressure earlier in compression is no combustion
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
    first = min(int(np.searchsorted(phi, _EARLIEST)), top)
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
    first = min(int(np.searchsorted(at, _EARLIEST)), top)
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
