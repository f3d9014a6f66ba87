"""Start-up of an elastic shaft by a weak drive: which resonances it passes, which hold it, and what to think of it.

speed |            . rigid            The mean speed follows the rigid shaft until an order k of the excitation
      |         .      ___,----       meets a natural frequency. There the drive feeds the vibration instead of
      |      ,--------'  released     the speed: the shaft is held ("captured") at omega_n / k, the twist grows.
      |   .    captured
      | .
      +---------------------------- t
"""

import math
from collections.abc import Mapping
from dataclasses import replace
from typing import Annotated

import numpy as np

from mechsym import mechanisms
from mechsym.mechanisms.shaft import elastic as shaft_of
from mechsym.page import Shown
from mechsym.plausible import Doubt
from mechsym.quantities import record
from mechsym.quantities.display import figure, quantity_text
from mechsym.quantities.records import Record
from mechsym.quantities.results import Columns, part, quantity, result
from mechsym.simulate import Result
from mechsym.simulate.result import RunNumbers, extremes_of
from mechsym.simulate.settings import StepTorque
from mechsym.torsion import modes as torsion
from mechsym.torsion.modes import Critical
from mechsym.torsion.twist import Settling, ShaftSection, TrainVibration, pairs, sections

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


def start_up(mechanism: str, parameters: Record, drive: StepTorque, claim: StartUpClaim, result: Result) -> StartUp:
    """Explain a finished start-up. mechanism: declares two discs, with a letter for the damping between them."""
    (role,) = mechanisms.roles_of(mechanism).shafts

    def linear_with(**letters: float) -> torsion.Matrices:
        return torsion.matrices(mechanisms.build(mechanism, replace(parameters, **letters)))

    linear, damping = linear_with(), str(role.damping[0])
    modes = torsion.modes(linear.mass, linear.stiffness)
    bare = linear_with(**dict.fromkeys(role.masses, 0.0))
    excitation = torsion.orders(mechanisms.build(mechanism, parameters))
    criticals = torsion.critical_speeds(modes, excitation, linear.damping)
    unit = float(modes.shapes[:, -1] @ linear_with(**{damping: 1.0}).damping @ modes.shapes[:, -1])
    rate = drive.torque / float(linear.mass.sum())
    t, speed, twist = series(result)
    elastic = shaft_of(mechanism, parameters)
    assert elastic is not None  # whose role is given
    (shaft,), ((crank, _),) = sections(elastic, result, float(result.t[0])), pairs(result, 1)
    least, greatest = extremes_of(result, lambda columns: columns[f"{crank}d"][None])
    return StartUp(
        c1=getattr(parameters, damping),
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
        twist_peak=shaft.twist_peak,
        torque_peak=shaft.torque_peak,
        speed_min=float(least[0]),
        speed_max=float(greatest[0]),
    )


def series(result: Result) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean speed of the crank and largest twist, each over a second.

    result: a run longer than a second. Returns t, speed_mean, twist_amplitude: every tenth of a second, from half a
    second after the start to half a second before the end [s, rad/s, rad], shape (m,).
    """
    half = AVERAGE / 2
    count = int((result.t[-1] - result.t[0] - AVERAGE) / 0.1 + 1e-9)
    t = result.t[0] + half + 0.1 * np.arange(count + 1)
    crank, flywheel = (result.columns[name] for name in pairs(result, 1)[0])
    phi = np.interp(np.stack([t - half, t + half]), result.t, crank)
    twist = np.abs(crank - flywheel)
    first, last = np.searchsorted(result.t, [t - half, t + half])
    largest = np.array([twist[a:b].max() for a, b in zip(first, np.maximum(last, first + 1), strict=True)])
    return t, (phi[1] - phi[0]) / AVERAGE, largest


def find_captures(
    t: np.ndarray, speed: np.ndarray, criticals: tuple[Critical, ...], rate: Annotated[float, "rad/s^2"]
) -> tuple[Capture, ...]:
    """Critical speeds at which the mean speed stays much longer than a rigid shaft would.

    t, speed: times and mean speed [s, rad/s], shape (m,); rate: acceleration of the rigid shaft.
    """
    captures = []
    for critical in criticals:
        near = np.abs(speed - critical.speed) <= _BAND * critical.speed
        jumps = np.flatnonzero(np.diff(np.concatenate([[False], near, [False]]).astype(int)))
        for a, b in zip(jumps[::2], jumps[1::2], strict=True):
            usual, start, end = 2 * _BAND * critical.speed / rate, float(t[a]), float(t[b - 1])
            if end - start > _LONGER * usual:
                captures.append(Capture(critical=critical, t_start=start, t_end=end, released=bool(b < len(t))))
    return tuple(sorted(captures, key=lambda c: c.t_start))


_SPOKEN = 4  # orders above are too weak to speak of


def findings(start: StartUp) -> tuple[str, ...]:
    """What happens and whether the model bears it."""
    end = float(start.result.t[-1])
    times = start.torque_peak / abs(start.drive.torque) if start.drive.torque else float("inf")
    lines = [
        f"largest twist {quantity_text(start.twist_peak, 'rad', 3)}, shaft torque "
        f"{quantity_text(start.torque_peak, 'N*m', 4)}, {figure(times, 3)} times the drive's"
    ]
    limit = start.claim.twist_limit
    if start.twist_peak > limit:
        lines.append(
            f"the model does not hold: the twist is beyond {quantity_text(limit, 'rad', 3)}, no linear spring nor a "
            "whole shaft"
        )
    if start.speed_min < -1e-3 * start.speed_max:
        lines.append(f"the crank runs backwards within a turn (down to {_speed(start.speed_min)})")
    return (
        f"natural frequency {_hertz(start.natural_bare)} bare, {_hertz(start.natural)} with the mean reciprocating "
        "inertia",
        f"a rigid shaft would gain {_speed(start.rigid_rate)} each second and reach {_speed(_rigid(start, end))} at "
        f"{end:g} s at most",
        *_passages(start),
        *lines,
        *_claim(start),
    )


@result
class HoldingOrder:
    """A critical speed of a start-up."""

    order: float = quantity("-")  #: Oscillations per turn
    speed: float = quantity("rad/s")  #: Natural frequency by the order
    held_below_c1: float = quantity("N*m*s/rad")  #: With a weaker damper the drive is held there


@result
class Stay:
    """A stay at a critical speed."""

    order: float = quantity("-")  #: That held the shaft
    t_start: float = quantity("s")  #: When the mean speed came to it
    t_end: float = quantity("s")  #: When the mean speed left it, or the run ended
    released: bool = part()


@result
class StartUpNumbers:
    """The numbers of a start-up, for files and scripts."""

    c1: float = quantity("N*m*s/rad")  #: Torsional damping of the run
    natural_bare: float = quantity("rad/s")  #: Natural frequency without the reciprocating inertia
    natural: float = quantity("rad/s")  #: Natural frequency with the mean reciprocating inertia
    rigid_speed_end: float = quantity("rad/s")  #: What a rigid shaft would reach
    criticals: tuple[HoldingOrder, ...] = part()
    captures: tuple[Stay, ...] = part()
    speed_mean_end: float = quantity("rad/s")  #: Mean over the last second
    speed_min: float = quantity("rad/s")  #: Least speed of the crank
    speed_max: float = quantity("rad/s")  #: Greatest speed of the crank
    twist_peak: float = quantity("rad")  #: Largest twist of the shaft
    torque_peak: float = quantity("N*m")  #: Largest torque of the shaft
    model_holds: bool = part()
    energy_residual: float | None = quantity("-")  #: Work less dissipation less change of energy, by the work
    tolerance_difference: float | None = quantity("-")  #: Of a speed to the run at a hundredth of the tolerance
    status: str = part()


def numbers(start: StartUp) -> StartUpNumbers:
    """The numbers of a start-up."""
    pairs = zip(start.criticals, start.holding_damping, strict=True)
    return StartUpNumbers(
        c1=start.c1,
        natural_bare=start.natural_bare,
        natural=start.natural,
        rigid_speed_end=_rigid(start, float(start.result.t[-1])),
        criticals=tuple(HoldingOrder(order=c.order, speed=c.speed, held_below_c1=d) for c, d in pairs),
        captures=tuple(
            Stay(order=c.critical.order, t_start=c.t_start, t_end=c.t_end, released=c.released) for c in start.captures
        ),
        speed_mean_end=float(start.speed_mean[-1]),
        speed_min=start.speed_min,
        speed_max=start.speed_max,
        twist_peak=start.twist_peak,
        torque_peak=start.torque_peak,
        model_holds=start.twist_peak <= start.claim.twist_limit,
        energy_residual=start.result.energy.residual,
        tolerance_difference=start.result.tolerance_difference,
        status=start.result.status,
    )


def _speed(value: float) -> str:
    return quantity_text(value, "rad/s", 4)


def _hertz(value: float) -> str:
    return f"{figure(value / math.tau, 4)} Hz"


def _rigid(start: StartUp, t: float) -> float:
    return start.rigid_rate * max(t - start.drive.time, 0.0)


def _passages(start: StartUp) -> list[str]:
    lines, held = [], {c.critical.order for c in start.captures}
    reached = float(start.speed_mean.max())
    for critical, damping in zip(start.criticals, start.holding_damping, strict=True):
        if critical.order in held:
            lines.append(
                f"order {critical.order:g} can hold a drive of {start.drive.torque:g} N*m at "
                f"{_speed(critical.speed)} while c1 < {damping:.3f} N*m*s/rad (c1 = {start.c1:g})"
            )
        elif critical.speed < reached and critical.order <= _SPOKEN:
            lines.append(f"order {critical.order:g} at {_speed(critical.speed)} is passed")
    for c in start.captures:
        left = "then leaves it" if c.released else "and is still held at the end"
        lines.append(
            f"from {c.t_start:.1f} s to {c.t_end:.1f} s the shaft is held at order {c.critical.order:g}, "
            f"{_speed(c.critical.speed)}: the drive feeds the vibration, not the speed; {left}"
        )
    return lines or ["no resonance is reached"]


def _claim(start: StartUp) -> list[str]:
    speed, since, end = start.claim.claim_speed, start.claim.claim_time, float(start.result.t[-1])
    if speed is None or since is None:
        return []
    allowed = _rigid(start, max(since, end))
    line = (
        f"the source's {speed:g} rad/s ({_speed(speed)}) from {since:g} s on is "
        f"{'beyond' if speed > allowed else 'within'} what the drive's work allows ({_speed(_rigid(start, since))} "
        f"then, {_speed(allowed)} at {max(since, end):g} s)"
    )
    after = start.t >= since
    if after.any():
        low, high = start.speed_mean[after].min(), start.speed_mean[after].max()
        line += (
            f"; the mean speed found there is {_speed(float(low))} to {_speed(float(high))}, and the crank peaks at "
            f"{_speed(start.speed_max)} in the whole run"
        )
    return [line]


@record
class EngineSpeed:
    """What an engine's speed is looked at by."""

    coordinate: str  #: Its shaft
    words: str  #: Its name for people, empty where there is one shaft only
    period: float  #: A turn, or two of a four-stroke engine [rad]
    wanted: float  #: Speed of operation [rad/s]


@result
class FinishedRun(Shown):
    """A finished run and what is said of it."""

    case: str = part()
    backend: str = part()
    tolerance: float = quantity("-")  #: Of a step of the integrator
    summary: RunNumbers = part(inline=True)
    final_state: Columns = part()  #: Coordinates and velocities at the end, under the names of `[start]`
    natural_frequencies: tuple[float, ...] = quantity("rad/s")  #: Of an elastic shaft
    twist: tuple[ShaftSection, ...] = part()
    vibration: TrainVibration | None = part()  #: Criticals of a crank train
    findings: tuple[str, ...] = part()
    start_up: tuple[StartUpNumbers, ...] = part()  #: That of the run first, then one for each further damper
    settling: Settling | None = part()  #: Where an engine settles after a start against a load
    #: Least and largest value and that at the end of the outputs of a user's machine that is no engine
    outputs: Mapping[str, Columns] = part(optional=True)
    result: Result  # its columns
    start_ups: tuple[StartUp, ...]
    engine: EngineSpeed | None  # of an engine
    alone: bool = False  # whether no shaft stands for it, so that each coordinate is looked at by itself
    doubts: tuple[Doubt, ...] = part(default=())  #: Of gas and window, that no number of the summary tells

    @property
    def speed(self) -> Columns:
        """Mean, least and greatest speed at the end, of the engine's shaft or of the first coordinate [its unit]."""
        speeds = self.summary.speeds
        return speeds[self.engine.coordinate if self.engine else next(iter(speeds))]
