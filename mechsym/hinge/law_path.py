"""The path of a guide for a spring whose force is a law of its closing alone, or the reason why there is none."""

import functools

import numpy as np
import scipy

from mechsym import periodic
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import ROLLERS, GuideParameters
from mechsym.hinge.springs import AirAbsolute, AirGauge, Coil, law
from mechsym.hinge.torque import Hinge, exists

LawSpring = AirGauge | AirAbsolute | Coil

FULL = 1 - 1e-6  # share of the closing beyond which rounding would decide the force of a gas spring


# the springs of a sweep share what they have to give
@functools.lru_cache(maxsize=8)
def work_range(wanted: Hinge | Balance) -> tuple[float, float]:
    """Smallest and largest work that the hinge takes [J]."""
    low, _, high, _ = periodic.extremes(wanted.work)
    return low, high


@functools.lru_cache(maxsize=8)
def can_be_given(wanted: Hinge | Balance) -> bool:
    """Whether a spring can give the torque: its mean is 0."""
    return exists(wanted.torque)


def takes_work(wanted: Hinge | Balance) -> str:
    """Why no spring gives a torque whose mean is not 0."""
    return f"the torque has a mean of {periodic.mean(wanted.torque):.6g} N*m; no spring gives that"


def status(
    wanted: Hinge | Balance, spring: LawSpring, parameters: GuideParameters, energy_min: float, energy_max: float
) -> tuple[str, str]:
    """Status and reason of a guide, as in `Guide`, whose spring goes through these energies [J].

    Parameters
    ----------
    energy_min, energy_max : float
        Stored energy that the turn asks for [J]
    """
    functions = law(spring)
    if not can_be_given(wanted):
        return "takes_work", takes_work(wanted)
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
    if z_max >= FULL * functions.z_high:
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


def law_path(
    wanted: Hinge | Balance, spring: LawSpring, parameters: GuideParameters, at_start: float
) -> "tuple[scipy.interpolate.PPoly, float]":
    """Path over the guide's angle [m] and the gap that its slope would leave after a period [m].

    Parameters
    ----------
    at_start : float
        Stored energy where the angle begins [J]
    """
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
