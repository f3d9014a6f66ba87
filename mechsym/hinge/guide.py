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

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
import scipy

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import ROLLERS, GuideParameters, refuse_open_track
from mechsym.hinge.law_path import LawSpring, can_be_given, law_path, takes_work, work_range
from mechsym.hinge.law_path import status as law_status
from mechsym.hinge.springs import law
from mechsym.hinge.thermal import AirThermal, GasTurn, thermal_pressure
from mechsym.hinge.thermal_guide import ThermalPath, gas_on, thermal_path, warmth_of
from mechsym.hinge.torque import Hinge
from mechsym.quantities import record

Spring = LawSpring | AirThermal


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
    #: Path of the roller centres over the angle theta of the guide's shaft [m]; None unless cut
    rho: "scipy.interpolate.PPoly | None"
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
    if isinstance(spring, AirThermal):
        return _cut_thermal(wanted, spring, parameters)
    low, high = work_range(wanted)
    at_start = 0.0 if parameters.start == "as_printed" else float(law(spring).energy(parameters.z_margin)) + high
    status, reason = law_status(wanted, spring, parameters, at_start - high, at_start - low)
    rho, closure = law_path(wanted, spring, parameters, at_start) if status == "cut" else (None, 0.0)
    return Guide(
        parameters=parameters,
        spring=spring,
        omega=wanted.omega,
        rollers=rollers,
        status=status,
        reason=reason,
        rho=rho,
        closure=closure,
    )


def _cut_thermal(wanted: Hinge | Balance, spring: AirThermal, parameters: GuideParameters) -> Guide:
    if can_be_given(wanted):
        found = thermal_path(wanted, spring, parameters)
    else:
        found = ThermalPath(rho=None, status="takes_work", reason=takes_work(wanted), kept=0.0, closure=0.0)
    return Guide(
        parameters=parameters, spring=spring, omega=wanted.omega, rollers=ROLLERS[parameters.arrangement],
        status=found.status, reason=found.reason, rho=found.rho, closure=found.closure,
    )  # fmt: skip


def refit(guide: Guide, spring: Spring) -> Guide:
    """The same track with another spring in it, or the same one set anew; what it was cut for stays in `omega`."""
    return replace(guide, spring=spring)


def path(guide: Guide) -> "scipy.interpolate.PPoly":
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


def spring_state(guide: Guide, theta: np.ndarray, z: np.ndarray) -> tuple[np.ndarray, np.ndarray | None]:
    """Force of the spring on each roller [N] and excess pressure in it [Pa]; a gas that exchanges heat runs steadily.

    Parameters
    ----------
    theta : ndarray, shape (n,)
        Angle of the guide's shaft, which a spring with a law of its closing does not ask for [rad]
    z : ndarray, shape (n,)
        Closing [m]
    """
    spring = guide.spring
    if not isinstance(spring, AirThermal):
        functions = law(spring)
        return functions.force(z), None if functions.pressure is None else functions.pressure(z)
    pressure = thermal_pressure(z, spring.H, spring.p0, spring.pa, warmth(guide, spring)(theta))
    return spring.A * pressure, pressure


def gas_turn(guide: Guide, spring: AirThermal) -> GasTurn:
    """Steady turn of a gas in the spring of a guide at its speed, at even angles of a period."""
    return gas_on(spring, path(guide), partial(closing, guide), guide.omega * guide.parameters.shaft_ratio)


def warmth(guide: Guide, spring: AirThermal) -> "scipy.interpolate.PPoly":
    """Temperature of that gas by the wall's [-] over the angle of the guide's shaft."""
    return warmth_of(spring, gas_turn(guide, spring), path(guide))


def kept_torque(guide: Guide) -> float:
    """Mean torque on the crank that a gas keeps as heat, 0 for springs that give all back [N*m]."""
    if not isinstance(guide.spring, AirThermal) or guide.rho is None:
        return 0.0
    period = float(guide.rho.x[-1] - guide.rho.x[0])
    return guide.parameters.shaft_ratio * gas_turn(guide, guide.spring).loss / period


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
    force, _ = spring_state(guide, theta, closing(guide, rho(theta)))
    return ratio * guide.rollers * force * rho.derivative()(theta)


def torque_function(guide: Guide) -> Callable[[float], float]:
    """The same torque as a fast function of one float, for time simulations.

    Returns
    -------
    torque : callable
        Crank angle, any real number [rad], to torque on the crank [N*m]; about 1.5 microseconds
    """
    point, force = periodic.scalar(path(guide)), _force_at(guide)
    c, rho0, ratio = guide.rollers, guide.parameters.rho0, guide.parameters.shaft_ratio

    def torque(phi: float) -> float:
        rho, slope = point(ratio * phi)
        return ratio * c * force(c * (rho0 - rho), ratio * phi) * slope

    return torque


def _force_at(guide: Guide) -> Callable[[float, float], float]:
    """Force [N] by closing [m] and angle of the guide's shaft [rad]."""
    spring = guide.spring
    if not isinstance(spring, AirThermal):
        force = law(spring).force
        return lambda z, theta: force(z)
    warm, A, H, p0, pa = periodic.scalar(warmth(guide, spring)), spring.A, spring.H, spring.p0, spring.pa
    return lambda z, theta: A * thermal_pressure(z, H, p0, pa, warm(theta)[0])
