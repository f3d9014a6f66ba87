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

Arrangements: `two_tracks` (c = 2; two tracks half a turn apart in offset planes), `one_roller` (c = 1; against a fixed
spring seat), `half_speed_pi_periodic` (c = 2; both rollers on one plane track, which repeats every half turn and so
turns at half the speed of the cycle). Start: `as_printed` (z = 0 at phi = 0, the paper's) or `placed` (the constant is
chosen so that the spring is never longer than its free height).

Source: Zotov et al. (2024), eqs. (9) to (14), for the first arrangement with the first start.
"""

import dataclasses
import math
from collections.abc import Callable

import numpy as np
from scipy.interpolate import PPoly

from mechsym import periodic
from mechsym.balance import KINDS, Balance
from mechsym.errors import BadInput
from mechsym.quantities import check, choice, quantity
from mechsym.springs import AirAbsolute, AirGauge, Coil, law

Spring = AirGauge | AirAbsolute | Coil

# arrangement: (rollers that move the spring, track periods in one turn of its shaft must be a multiple of this)
_ARRANGEMENTS = {"two_tracks": (2, 1), "one_roller": (1, 1), "half_speed_pi_periodic": (2, 2)}
_STARTS = ("placed", "as_printed")


@dataclasses.dataclass(frozen=True, kw_only=True)
class GuideParameters:
    """What is chosen about the guide.

    Parameters
    ----------
    arrangement : str
        `two_tracks`, `one_roller` or `half_speed_pi_periodic`
    start : str
        `placed` or `as_printed`
    rho0 : float
        Shaft axis to roller centre where the spring has its free height [m]
    z_margin : float
        Smallest closing that a placed start keeps [m]
    shaft_ratio : float
        Turns of the guide's shaft per turn of the crank [-]
    balance : str
        Part of the torque to balance, `whole_cycle` or `every_turn`
    """

    arrangement: str = choice(*_ARRANGEMENTS, about="how the track carries the spring")
    start: str = choice(*_STARTS, default="placed", about="where the turn starts on the spring's curve")
    rho0: float = quantity("m", above=0, about="roller centre to shaft axis at free height")
    z_margin: float = quantity("m", default=0.0, low=0, about="smallest closing of a placed start")
    shaft_ratio: float = quantity("-", default=1.0, above=0, about="turns of the guide's shaft per turn of the crank")
    balance: str = choice(*KINDS, default="whole_cycle", about="part of the torque to balance")

    def __post_init__(self) -> None:
        check(self)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Guide:
    """A guide, or the reason why there is none.

    Parameters
    ----------
    parameters : GuideParameters
        What was chosen
    spring : AirGauge, AirAbsolute or Coil
        Spring that it was made for
    rollers : int
        Rollers c that move the spring
    status : str
        `cut`, or `spring_bottoms`, `spring_pulls`: the spring cannot hold the work
    reason : str
        The numbers behind the status
    energy_min, energy_max : float
        Stored energy that the turn asks for [J]
    rho : PPoly or None
        Path of the roller centres over the angle theta of the guide's shaft [m]; None unless cut
    closure : float
        Gap of the path after a period, before it is closed [m]
    """

    parameters: GuideParameters
    spring: Spring
    rollers: int
    status: str
    reason: str
    energy_min: float
    energy_max: float
    rho: PPoly | None
    closure: float


def build(balance: Balance, spring: Spring, parameters: GuideParameters) -> Guide:
    r"""Guide that makes a spring give a torque.

    .. math:: U(z) = U_0 - W(\varphi), \qquad \rho = \rho_0 - z / c, \qquad
              \frac{d\rho}{d\theta} = \frac{M_h}{\text{shaft ratio}\; c\, F(z)}

    Parameters
    ----------
    balance : Balance
        Torque to give, with its work
    spring : AirGauge, AirAbsolute or Coil
        Parameters of the spring
    parameters : GuideParameters
        Arrangement, start, rho0 and the rest

    Returns
    -------
    guide : Guide
        The path, or status and reason

    Raises
    ------
    BadInput
        The track would not close after a turn of its shaft

    Notes
    -----
    Source: Zotov et al. (2024), eqs. (9) to (11): U_0 = 0, c = 2, gauge law. The slope is fitted and the path is its
    exact integral, so that the torque of the path is exact too. Massless rollers and spring, no friction.
    """
    rollers, _ = _ARRANGEMENTS[parameters.arrangement]
    _refuse_open_track(balance, parameters)
    low, _, high, _ = periodic.extremes(balance.work)
    at_start = _energy_at_start(spring, parameters, high)
    status, reason = _held(spring, at_start - high, at_start - low)
    rho, closure = _path(balance, spring, parameters, at_start) if status == "cut" else (None, 0.0)
    return Guide(
        parameters=parameters,
        spring=spring,
        rollers=rollers,
        status=status,
        reason=reason,
        energy_min=at_start - high,
        energy_max=at_start - low,
        rho=rho,
        closure=closure,
    )


def path(guide: Guide) -> PPoly:
    """The path of the roller centres of a guide that could be cut.

    Parameters
    ----------
    guide : Guide
        With status `cut`

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
        raise BadInput(f"the guide has no path: {guide.reason}")
    return guide.rho


def closing(guide: Guide, rho: np.ndarray) -> np.ndarray:
    r"""Closing of the spring.

    .. math:: z = c\,(\rho_0 - \rho)

    Parameters
    ----------
    guide : Guide
        Arrangement and rho0
    rho : ndarray
        Distance of the roller centres [m]

    Returns
    -------
    z : ndarray
        Shape of `rho` [m]
    """
    return guide.rollers * (guide.parameters.rho0 - rho)


def crank_torque(guide: Guide, spring: Spring, phi: np.ndarray) -> np.ndarray:
    r"""Torque of a guide on the crank by virtual work, with the spring it was cut for or another.

    .. math:: M_h^* = \text{shaft ratio}\; c\, F(z)\, \frac{d\rho}{d\theta}

    Parameters
    ----------
    guide : Guide
        With status `cut`
    spring : AirGauge, AirAbsolute or Coil
        Spring that works in it
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
    return ratio * guide.rollers * law(spring).force(closing(guide, rho(theta))) * rho.derivative()(theta)


def torque_function(guide: Guide, spring: Spring) -> Callable[[float], float]:
    """The same torque as a fast function of one float, for time simulations.

    Parameters
    ----------
    guide : Guide
        With status `cut`
    spring : AirGauge, AirAbsolute or Coil
        Spring that works in it

    Returns
    -------
    torque : callable
        Crank angle, any real number [rad], to torque on the crank [N*m]; about 1.5 microseconds
    """
    point, force = periodic.scalar(path(guide)), law(spring).force
    c, rho0, ratio = guide.rollers, guide.parameters.rho0, guide.parameters.shaft_ratio

    def torque(phi: float) -> float:
        rho, slope = point(ratio * phi)
        return ratio * c * force(c * (rho0 - rho)) * slope

    return torque


def _refuse_open_track(balance: Balance, parameters: GuideParameters) -> None:
    _, multiple = _ARRANGEMENTS[parameters.arrangement]
    periods = 2 * math.pi / (balance.period * parameters.shaft_ratio)
    if round(periods) < 1 or abs(periods - round(periods)) > 1e-9 or round(periods) % multiple:
        right = 2 * math.pi / (balance.period * multiple)
        raise BadInput(
            f"guide.shaft_ratio = {parameters.shaft_ratio:g}: the {parameters.arrangement} track does not close, since "
            f"the torque repeats every {balance.period / (2 * math.pi):g} turns of the crank; use {right:g}"
        )


def _energy_at_start(spring: Spring, parameters: GuideParameters, work_max: float) -> float:
    match parameters.start:
        case "as_printed":
            return 0.0
        case _:
            return float(law(spring).energy(parameters.z_margin)) + work_max


def _held(spring: Spring, energy_min: float, energy_max: float) -> tuple[str, str]:
    """Status and reason: does the spring hold these energies?"""
    functions = law(spring)
    if energy_max >= functions.energy_high:
        return "spring_bottoms", (
            f"the spring would have to store {energy_max:.6g} J and holds {functions.energy_high:.6g} J at its full "
            f"closing of {functions.z_high:.6g} m; make it stiffer or longer"
        )
    if energy_min <= functions.energy_low:
        return "spring_pulls", (
            f"the spring would have to give {-energy_min:.6g} J beyond its free height and can give "
            f"{-functions.energy_low:.6g} J; place the start or raise its preload"
        )
    return "cut", ""


def _path(balance: Balance, spring: Spring, parameters: GuideParameters, at_start: float) -> tuple[PPoly, float]:
    """Path over the guide's angle and the gap that its slope would leave after a period."""
    functions, ratio = law(spring), parameters.shaft_ratio
    rollers, _ = _ARRANGEMENTS[parameters.arrangement]

    def z(theta: np.ndarray) -> np.ndarray:
        return functions.closing(at_start - balance.work(theta / ratio))

    slope = periodic.fit(
        lambda theta: balance.torque(theta / ratio) / (ratio * rollers * functions.force(z(theta))),
        balance.torque.x * ratio,
        balance.period * ratio,
    )
    rho = periodic.antiderivative(slope)
    edges = rho.x[:-1]
    rho.c[-1] += np.mean(parameters.rho0 - z(edges) / rollers - rho(edges))
    return rho, abs(periodic.mean(slope)) * slope.x[-1]
