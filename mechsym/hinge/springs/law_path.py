"""The path of a guide for a spring whose force is a law of its closing alone, or the reason why there is none."""

import functools
from typing import Protocol

import numpy as np

from mechsym import periodic
from mechsym.hinge.balance import Balance
from mechsym.hinge.choices import GuideParameters
from mechsym.hinge.torque import Hinge, exists
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.units import Scalar

FULL = 1 - 1e-6  # share of the closing beyond which rounding would decide the force of a gas spring


class ByClosing(Protocol):
    """What a path asks of a spring whose force follows from the closing alone."""

    @property
    def H(self) -> float:
        """Closing at which it is full [m]."""

    @property
    def energy_low(self) -> Scalar:
        """Stored energy below which it would pull [J]."""

    @property
    def energy_high(self) -> Scalar:
        """Stored energy at its full closing [J]."""

    def force(self, z: Scalar) -> Scalar:
        """Outwards [N] at a closing [m]."""

    def energy(self, z: Scalar) -> Scalar:
        """Stored energy [J] at a closing [m]."""

    def closing(self, U: Scalar) -> Scalar:
        """Closing [m] at a stored energy [J]."""


@record
class TrackPath:
    """Path of the roller centres, or the reason why there is none."""

    #: `cut`; or why not: `takes_work` (no spring gives this torque), `spring_bottoms`, `spring_pulls` (this spring
    #: cannot hold the work), `crosses_axis` (rho would not stay positive)
    status: str
    reason: str = ""
    #: Over the angle of the guide's shaft [m]; None unless cut
    rho: PPoly | None = None
    closure: float = 0.0  #: Gap of the path after a period, before it is closed [m]


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


def law_path(wanted: Hinge | Balance, spring: ByClosing, parameters: GuideParameters) -> TrackPath:
    r"""Path for a spring whose force follows from its closing alone.

    .. math:: U(z) = U_0 - W(\varphi), \qquad \rho = \rho_0 - z / c, \qquad
              \frac{d\rho}{d\theta} = \frac{M_h}{\text{shaft ratio}\; c\, F(z)}

    wanted: torque to give with its work. Source: Zotov et al. (2024), eqs. (9) to (11): U_0 = 0, c = 2, gauge law. The
    slope is fitted and the path is its exact integral, so that the torque of the path is exact too.
    """
    low, high = work_range(wanted)
    at_start = 0.0 if parameters.start == "as_printed" else float(spring.energy(parameters.z_margin)) + high
    status, reason = _status(wanted, spring, parameters, at_start - high, at_start - low)
    if status != "cut":
        return TrackPath(status=status, reason=reason)
    ratio, rollers = parameters.shaft_ratio, parameters.rollers

    def z(theta: np.ndarray) -> np.ndarray:
        return np.asarray(spring.closing(at_start - wanted.work(theta / ratio)))

    slope = periodic.fit(
        lambda theta: wanted.torque(theta / ratio) / (ratio * rollers * spring.force(z(theta))),
        wanted.torque.x * ratio,
        wanted.period * ratio,
    )
    rho = periodic.antiderivative(slope)
    edges = rho.x[:-1]
    rho.c[-1] += np.mean(parameters.rho0 - z(edges) / rollers - rho(edges))
    return TrackPath(status="cut", rho=rho, closure=abs(periodic.mean(slope)) * float(slope.x[-1]))


def _status(
    wanted: Hinge | Balance, spring: ByClosing, parameters: GuideParameters, energy_min: float, energy_max: float
) -> tuple[str, str]:
    """Status and reason where the turn asks for these stored energies [J]."""
    if not can_be_given(wanted):
        return "takes_work", takes_work(wanted)
    if energy_max >= spring.energy_high:
        return "spring_bottoms", (
            f"the spring would have to store {energy_max:.6g} J and holds {spring.energy_high:.6g} J at its full "
            f"closing of {spring.H:.6g} m; make it stiffer or longer"
        )
    if energy_min <= spring.energy_low:
        return "spring_pulls", (
            f"the spring would have to relax to {energy_min:.6g} J, but its force vanishes at "
            f"{spring.energy_low:.6g} J; place the start, or raise its preload or z_margin"
        )
    z_max = float(spring.closing(energy_max))
    if z_max >= FULL * spring.H:
        return "spring_bottoms", (
            f"the spring would have to store {energy_max:.6g} J, which closes it fully, by {spring.H:.6g} m; "
            "make it stiffer or longer"
        )
    return crossing(parameters, z_max)


def crossing(parameters: GuideParameters, z_max: float) -> tuple[str, str]:
    """Status and reason of a path by the largest closing [m]: it stays on its side of the shaft, or not."""
    rho_min = parameters.rho0 - z_max / parameters.rollers
    if rho_min > 0:
        return "cut", ""
    return "crosses_axis", (
        f"the path crosses the shaft axis: its smallest rho would be {rho_min * 1e3:.4g} mm; "
        "enlarge rho0, stiffen the spring, or let two rollers share its closing"
    )
