r"""The guide of an elastic hinge: the path rho(theta) of the roller centres that makes a spring give the wanted torque.

         ___ track ___
       /     _____     \         theta = shaft_ratio * phi: angle of the guide's shaft
      |   .-       -.   |        rho:   shaft axis to roller centre
      |(o)==[spring]==(o)        z:     closing of the spring, z = c (rho0 - rho), c rollers move it
      |   `-_______-'   |        F:     spring force, outwards on each roller
       \ ____     ____ /
             -----

The spring gives the work that the torque takes: U(z) = const - W(phi), so z follows from W alone, and

.. math:: M_\theta = c\,F(z)\,\frac{d\rho}{d\theta} = \frac{M_h}{\text{shaft ratio}}

Source: Zotov et al. (2024), eqs. (9) to (14), for `two_tracks` with the start `as_printed`; the names are explained in
`mechsym.hinge.choices`.
"""

import functools
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.interpolate import PPoly

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import ROLLERS, GuideParameters, refuse_open_track
from mechsym.hinge.springs import AirAbsolute, AirGauge, Coil, law
from mechsym.hinge.torque import Hinge, exists
from mechsym.quantities import record

Spring = AirGauge | AirAbsolute | Coil

_FULL = 1 - 1e-6  # share of the closing beyond which rounding would decide the force of a gas spring


@record
class Guide:
    """A guide, or the reason why there is none."""

    parameters: GuideParameters
    spring: Spring  #: Spring in it: the one it was cut for, or another (see `refit`)
    omega: float  #: Crank speed that it was made for [rad/s]
    rollers: int  #: Rollers c that move the spring
    #: `cut`; or why not: `takes_work` (no spring gives this torque), `spring_bottoms`, `spring_pulls` (this spring
    #: cannot hold the work), `crosses_axis` (rho would not stay positive)
    status: str
    reason: str
    #: Stored energy that the turn asks for [J]
    energy_min: float
    energy_max: float
    rho: PPoly | None  #: Path of the roller centres over the angle theta of the guide's shaft [m]; None unless cut
    closure: float  #: Gap of the path after a period, before it is closed [m]


def cut(wanted: Hinge | Balance, spring: Spring, parameters: GuideParameters) -> Guide:
    r"""Guide that makes a spring give a torque.

    .. math:: U(z) = U_0 - W(\varphi), \qquad \rho = \rho_0 - z / c, \qquad
              \frac{d\rho}{d\theta} = \frac{M_h}{\text{shaft ratio}\; c\, F(z)}

    Parameters
    ----------
    wanted : Hinge or Balance
        Torque to give with its work: all of it, or the part that was chosen

    Returns
    -------
    guide : Guide
        The path, or status and reason

    Raises
    ------
    BadInput
        The track would not close after a turn of its shaft, or z_margin leaves no spring

    Notes
    -----
    Source: Zotov et al. (2024), eqs. (9) to (11): U_0 = 0, c = 2, gauge law. The slope is fitted and the path is its
    exact integral, so that the torque of the path is exact too. Massless rollers and spring, no friction.
    """
    rollers = ROLLERS[parameters.arrangement]
    refuse_open_track(parameters, wanted.period)
    if parameters.z_margin >= spring.H:
        raise BadInput(f"guide.z_margin = {parameters.z_margin:g} m is not below spring.H = {spring.H:g} m")
    low, high = _work_range(wanted)
    at_start = 0.0 if parameters.start == "as_printed" else float(law(spring).energy(parameters.z_margin)) + high
    status, reason = _status(wanted, spring, parameters, at_start - high, at_start - low)
    rho, closure = _path(wanted, spring, parameters, at_start) if status == "cut" else (None, 0.0)
    return Guide(
        parameters=parameters,
        spring=spring,
        omega=wanted.omega,
        rollers=rollers,
        status=status,
        reason=reason,
        energy_min=at_start - high,
        energy_max=at_start - low,
        rho=rho,
        closure=closure,
    )


def refit(guide: Guide, spring: Spring) -> Guide:
    """The same track with another spring in it, or the same one set anew; what it was cut for stays in `omega`."""
    return replace(guide, spring=spring)


def path(guide: Guide) -> PPoly:
    """The path of the roller centres.

    Returns
    -------
    rho : PPoly
        Over the angle of the guide's shaft [m]

    Raises
    ------
    BadInput
        There is no path; the message says why
    """
    if guide.rho is None:
        raise BadInput(f"there is no guide: {guide.reason}")
    return guide.rho


def closing(guide: Guide, rho: np.ndarray) -> np.ndarray:
    r"""Closing of the spring.

    .. math:: z = c\,(\rho_0 - \rho)

    Parameters
    ----------
    rho : ndarray
        Distance of the roller centres [m]

    Returns
    -------
    z : ndarray
        Shape of `rho` [m]
    """
    return guide.rollers * (guide.parameters.rho0 - rho)


def crank_torque(guide: Guide, phi: np.ndarray) -> np.ndarray:
    r"""Torque of a guide on the crank by virtual work, with the spring that is in it.

    .. math:: M_h^* = \text{shaft ratio}\; c\, F(z)\, \frac{d\rho}{d\theta}

    Parameters
    ----------
    phi : ndarray, shape (n,)
        Crank angle [rad]

    Returns
    -------
    torque : ndarray, shape (n,)
        On the crank, positive driving [N*m]

    Notes
    -----
    Source: Zotov et al. (2024), eqs. (12) to (14). For the gauge law it is proportional to p0, for the others not.
    """
    rho, ratio = path(guide), guide.parameters.shaft_ratio
    theta = ratio * np.asarray(phi, dtype=float)
    return ratio * guide.rollers * law(guide.spring).force(closing(guide, rho(theta))) * rho.derivative()(theta)


def torque_function(guide: Guide) -> Callable[[float], float]:
    """The same torque as a fast function of one float, for time simulations.

    Returns
    -------
    torque : callable
        Crank angle, any real number [rad], to torque on the crank [N*m]; about 1.5 microseconds
    """
    point, force = periodic.scalar(path(guide)), law(guide.spring).force
    c, rho0, ratio = guide.rollers, guide.parameters.rho0, guide.parameters.shaft_ratio

    def torque(phi: float) -> float:
        rho, slope = point(ratio * phi)
        return ratio * c * force(c * (rho0 - rho)) * slope

    return torque


# the springs of a sweep share what they have to give
@functools.lru_cache(maxsize=8)
def _work_range(wanted: Hinge | Balance) -> tuple[float, float]:
    """Smallest and largest work that the hinge takes [J]."""
    low, _, high, _ = periodic.extremes(wanted.work)
    return low, high


@functools.lru_cache(maxsize=8)
def _exists(wanted: Hinge | Balance) -> bool:
    return exists(wanted.torque)


def _status(
    wanted: Hinge | Balance, spring: Spring, parameters: GuideParameters, energy_min: float, energy_max: float
) -> tuple[str, str]:
    functions = law(spring)
    if not _exists(wanted):
        return "takes_work", f"the torque has a mean of {periodic.mean(wanted.torque):.6g} N*m; no spring gives that"
    if energy_max >= functions.energy_high:
        return "spring_bottoms", (
            f"the spring would have to store {energy_max:.6g} J and holds {functions.energy_high:.6g} J at its full "
            f"closing of {functions.z_high:.6g} m; make it stiffer or longer"
        )
    if energy_min <= functions.energy_low:
        return "spring_pulls", (
            f"the spring would have to relax to {energy_min:.6g} J, but its force vanishes at "
            f"{functions.energy_low:.6g} J; place the start, or raise its preload or z_margin"
        )
    z_max = float(functions.closing(energy_max))
    if z_max >= _FULL * functions.z_high:
        return "spring_bottoms", (
            f"the spring would have to store {energy_max:.6g} J, which closes it fully, by {functions.z_high:.6g} m; "
            "make it stiffer or longer"
        )
    rho_min = parameters.rho0 - z_max / ROLLERS[parameters.arrangement]
    if rho_min <= 0:
        return "crosses_axis", (
            f"the path crosses the shaft axis: its smallest rho would be {rho_min * 1e3:.4g} mm; "
            "enlarge rho0, stiffen the spring, or let two rollers share its closing"
        )
    return "cut", ""


def _path(wanted: Hinge | Balance, spring: Spring, parameters: GuideParameters, at_start: float) -> tuple[PPoly, float]:
    """Path over the guide's angle and the gap that its slope would leave after a period."""
    functions, ratio = law(spring), parameters.shaft_ratio
    rollers = ROLLERS[parameters.arrangement]

    def z(theta: np.ndarray) -> np.ndarray:
        return functions.closing(at_start - wanted.work(theta / ratio))

    slope = periodic.fit(
        lambda theta: wanted.torque(theta / ratio) / (ratio * rollers * functions.force(z(theta))),
        wanted.torque.x * ratio,
        wanted.period * ratio,
    )
    rho = periodic.antiderivative(slope)
    edges = rho.x[:-1]
    rho.c[-1] += np.mean(parameters.rho0 - z(edges) / rollers - rho(edges))
    return rho, abs(periodic.mean(slope)) * float(slope.x[-1])
