"""Start-up of an elastic shaft by a weak drive: which resonances it passes, which hold it, and what to think of it.

speed |            . rigid            The mean speed follows the rigid shaft until an order k of the excitation
      |         .      ___,----       meets a natural frequency. There the drive feeds the vibration instead of
      |      ,--------'  released     the speed: the shaft is held ("captured") at omega_n / k, the twist grows.
      |   .    captured
      | .
      +---------------------------- t
"""

from dataclasses import replace

import numpy as np

from mechsym.mechanisms.crankshaft_flywheel import CrankshaftFlywheelParameters, build
from mechsym.page import Shown
from mechsym.quantities import quantity, record
from mechsym.simulate import Result
from mechsym.simulate.settings import StepTorque
from mechsym.torsion import modes as torsion
from mechsym.torsion.modes import Critical

_BAND = 0.02  # a mean speed this close to a critical one counts as being at it [-]
_LONGER = 3.0  # held: it stays so many times longer than the rigid shaft would
AVERAGE = 1.0  # the mean speed is taken over this time [s]


@record
class StartUpClaim:
    """Section `[startup]`: what the source says of a start-up, and what the model can bear."""

    claim_speed: float | None = quantity("rad/s", default=None, above=0, about="speed that the source reports")
    claim_time: float | None = quantity("s", default=None, above=0, about="time from which it is said to hold")
    #: Twist beyond which a linear spring is no model of the shaft [rad]
    twist_limit: float = quantity("rad", default=0.1, above=0, about="largest twist of the linear shaft")


@record
class Capture:
    """A stay at a critical speed."""

    critical: Critical
    #: From when until when the mean speed is at it [s]
    t_start: float
    t_end: float
    released: bool  #: Whether the shaft left it within the run


@record
class StartUp(Shown):
    """A start-up, explained."""

    c1: float  #: Torsional damping of the run [N*m*s/rad]
    drive: StepTorque
    claim: StartUpClaim  #: What the source says, and the limit of the model
    result: Result
    #: shape (m,): Times and mean speed of the crank over a second [s, rad/s]
    t: np.ndarray
    speed_mean: np.ndarray
    twist_amplitude: np.ndarray  #: shape (m,): Largest twist within that second [rad]
    #: Natural frequency without and with the mean reciprocating inertia [rad/s]
    natural_bare: float
    natural: float
    criticals: tuple[Critical, ...]  #: Where the orders meet the latter
    holding_damping: tuple[float, ...]  #: For each of them: with a weaker damper the drive is held there [N*m*s/rad]
    rigid_rate: float  #: Acceleration of a rigid shaft [rad/s^2]
    captures: tuple[Capture, ...]  #: Critical speeds that held the shaft
    #: Largest twist and torque of the shaft [rad, N*m]
    twist_peak: float
    torque_peak: float
    #: Extreme speeds of the crank [rad/s]
    speed_min: float
    speed_max: float


def start_up(
    parameters: CrankshaftFlywheelParameters, drive: StepTorque, claim: StartUpClaim, result: Result
) -> StartUp:
    """Explain the finished run of a start-up."""
    linear = _linear(parameters)
    modes = torsion.modes(linear.mass, linear.stiffness)
    bare = _linear(replace(parameters, m0=0.0))
    excitation = torsion.orders(build(parameters))
    criticals = torsion.critical_speeds(modes, excitation, linear.damping)
    unit = float(modes.shapes[:, -1] @ _linear(replace(parameters, c1=1.0)).damping @ modes.shapes[:, -1])
    rate = drive.torque / float(linear.mass.sum())
    t, speed, twist = series(result)
    peak = float(np.abs(result.columns["phi0"] - result.columns["phi2"]).max())
    return StartUp(
        c1=parameters.c1,
        drive=drive,
        claim=claim,
        result=result,
        t=t,
        speed_mean=speed,
        twist_amplitude=twist,
        natural_bare=float(torsion.modes(bare.mass, bare.stiffness).frequencies[-1]),
        natural=float(modes.frequencies[-1]),
        criticals=criticals,
        holding_damping=tuple(torsion.holding_damping(c, drive.torque, unit) for c in criticals),
        rigid_rate=rate,
        captures=find_captures(t, speed, criticals, rate),
        twist_peak=peak,
        torque_peak=peak * parameters.k1,
        speed_min=float(result.columns["phi0d"].min()),
        speed_max=float(result.columns["phi0d"].max()),
    )


def _linear(parameters: CrankshaftFlywheelParameters) -> torsion.Matrices:
    return torsion.matrices(build(parameters))


def series(result: Result) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean speed of the crank and largest twist, each over a second.

    Parameters
    ----------
    result : Result
        A run longer than a second

    Returns
    -------
    t, speed_mean, twist_amplitude : ndarray, shape (m,)
        Every tenth of a second, from half a second after the start to half a second before the end
        [s, rad/s, rad]
    """
    half = AVERAGE / 2
    count = int((result.t[-1] - result.t[0] - AVERAGE) / 0.1 + 1e-9)
    t = result.t[0] + half + 0.1 * np.arange(count + 1)
    phi = np.interp(np.stack([t - half, t + half]), result.t, result.columns["phi0"])
    twist = np.abs(result.columns["phi0"] - result.columns["phi2"])
    first, last = np.searchsorted(result.t, [t - half, t + half])
    largest = np.array([twist[a:b].max() for a, b in zip(first, np.maximum(last, first + 1), strict=True)])
    return t, (phi[1] - phi[0]) / AVERAGE, largest


def find_captures(
    t: np.ndarray, speed: np.ndarray, criticals: tuple[Critical, ...], rate: float
) -> tuple[Capture, ...]:
    """Critical speeds at which the mean speed stays much longer than a rigid shaft would.

    Parameters
    ----------
    t, speed : ndarray, shape (m,)
        Times and mean speed [s, rad/s]
    rate : float
        Acceleration of the rigid shaft [rad/s^2]
    """
    found = []
    for critical in criticals:
        near = np.abs(speed - critical.speed) <= _BAND * critical.speed
        jumps = np.flatnonzero(np.diff(np.concatenate([[False], near, [False]]).astype(int)))
        for a, b in zip(jumps[::2], jumps[1::2], strict=True):
            usual = 2 * _BAND * critical.speed / rate
            if t[b - 1] - t[a] > _LONGER * usual:
                released = bool(b < len(t))
                found.append(Capture(critical=critical, t_start=float(t[a]), t_end=float(t[b - 1]), released=released))
    return tuple(sorted(found, key=lambda c: c.t_start))
