"""Steady turning of a machine: the periodic speed, the ripple, and the flywheel for a wanted ripple.

`speed_ripple` (see `mechsym.simulate.speed`) is that of a period in steady state. Under constant load every speed
repeats when the torques balance (the motion is neutral), so the wanted mean speed is a choice; under a load that grows
with speed there is one steady motion, found by Newton's method on the map of one turn.

This is the machine as built, under any load law. While a guide is being designed only the work that it leaves over is
known; the closed forms of `mechsym.hinge.balance` give the speed then, for constant and propeller load.
"""

from dataclasses import replace

import numpy as np

from mechsym.machine.loads import ConstantLoad, load_torque
from mechsym.periodic.roots import root
from mechsym.quantities import record
from mechsym.quantities.units import Inertia, NewtonMetre, Pure, RadPerSecond
from mechsym.simulate.angle import AngleTurn, Panels, extremes, gauss, lowest_energy, speeds, stop_angle, turn
from mechsym.simulate.speed import Speed

# a constant load is in balance when a turn gains less than this part of the work that swings in it
_BALANCE = 1e-6
_STANDING = 1e6  # stands for the ripple of a shaft that does not turn; one that nearly stops has up to about ten
_TRIES = 50  # periods after which a shaft that still turns is not followed further


@record
class Steady:
    """A steady motion, or why there is none."""

    status: str  #: `steady` (disturbances die out), `neutral` (they stay), `unstable` (they grow) or `none`
    reason: str
    #: shape (m,): Speed around the turn, empty when there is none [rad, rad/s]
    phi: np.ndarray
    omega: np.ndarray
    speed_mean: float | None  #: Period by duration [rad/s]
    speed_ripple: float | None  #: (max - min) / mean [-]
    multiplier: float | None  #: What is left of a small disturbance of the energy after one period [-]


@record
class Flywheel:
    """A flywheel that does what was asked, or why none does."""

    status: str
    reason: str
    inertia: float | None  #: Inertia to be added to the shaft [kg*m^2]
    speed_ripple: float | None  #: Ripple with it [-]


def steady_state(panels: Panels, speed: RadPerSecond, flywheel: Inertia = 0.0) -> Steady:
    """The periodic motion of a machine.

    speed: mean speed under constant load, first guess of the speed under any other; flywheel: inertia added to the
    shaft. Returns steady: motion, or the reason why there is none.
    """
    if isinstance(panels.load, ConstantLoad):
        return _neutral(panels, speed, flywheel)
    driving, braking = mean_torque(panels), float(load_torque(panels.load, speed))
    if driving <= _BALANCE * abs(braking) and braking > 0:
        return _none(f"the mean torque is {driving:.6g} N*m and the load takes {braking:.6g} N*m: nothing drives it")
    energy = 0.5 * (float(np.mean(panels.inertia)) + flywheel) * speed**2
    for _ in range(50):
        whole_turn = turn(panels, flywheel, energy)
        gain = float(whole_turn.energy_edges[-1]) - energy
        slope = 1.0 - whole_turn.multiplier
        step = gain / float(np.copysign(max(abs(slope), 1e-6), slope))
        if abs(step) <= 1e-12 * abs(energy) or energy < 1e-9 * abs(gain):
            break
        energy = max(energy + step, 0.1 * energy)
    else:
        return _none(f"Newton's method on one turn did not settle (last step {step:.3g} J)")
    if lowest_energy(whole_turn) <= 0:
        return _stopped(panels, speed, flywheel)
    status = "steady" if abs(whole_turn.multiplier) < 1 else "unstable"
    return _steady(panels, flywheel, whole_turn, status, "the motion repeats every period")


def _neutral(panels: Panels, speed: float, flywheel: float) -> Steady:
    rest = turn(panels, flywheel, 0.0)
    gain, low = float(rest.energy_edges[-1]), lowest_energy(rest)
    swing = max(float(np.ptp(rest.energy)), float(np.ptp(rest.energy_edges)))
    # where nothing swings, the rounding of a torque is measured by the energy that turns
    swing = max(swing, 1e-6 * 0.5 * float(np.mean(panels.inertia)) * speed**2)
    if abs(gain) > _BALANCE * swing:
        way = "gains speed for ever" if gain > 0 else "slows down until it stops"
        return _none(f"under constant load the energy changes by {gain:.6g} J in a period: the shaft {way}")

    def surplus(energy: float) -> float:
        mean = (panels.edges[-1] - panels.edges[0]) / speeds(panels, flywheel, turn(panels, flywheel, energy))[2]
        return float(mean - speed)

    top = -low + 0.5 * (float(np.max(panels.inertia)) + flywheel) * speed**2
    bottom = -low + 1e-9 * top
    if surplus(bottom) > 0:
        return _none(f"no start keeps the mean speed at {speed:.6g} rad/s: the shaft stops before it is so slow")
    energy = root(surplus, bottom, top * (1 + 1e-9), xtol=1e-300, rtol=1e-14)
    reason = "constant load in balance: any speed repeats; this is the motion with the wanted mean speed"
    return _steady(panels, flywheel, turn(panels, flywheel, energy), "neutral", reason)


def _steady(panels: Panels, flywheel: float, motion: AngleTurn, status: str, reason: str) -> Steady:
    phi, omega, time = speeds(panels, flywheel, motion)
    mean = float(panels.edges[-1] - panels.edges[0]) / time
    low, high = extremes(panels, phi, omega)
    return Steady(
        status=status, reason=reason, phi=phi, omega=omega, speed_mean=mean,
        speed_ripple=Speed(mean=mean, min=low, max=high).ripple, multiplier=motion.multiplier,
    )  # fmt: skip


def _none(reason: str) -> Steady:
    nothing = np.empty(0)
    return Steady(
        status="none", reason=reason, phi=nothing, omega=nothing, speed_mean=None, speed_ripple=None, multiplier=None
    )


def _stopped(panels: Panels, speed: float, flywheel: float) -> Steady:
    """Tell where a shaft stops that is started at a speed, the reason why it has no steady motion."""
    energy, period = 0.5 * (float(panels.inertia_edges[0]) + flywheel) * speed**2, panels.edges[-1] - panels.edges[0]
    for count in range(_TRIES):
        whole_turn = turn(panels, flywheel, energy)
        angle = stop_angle(panels, whole_turn)
        if angle is not None:
            where = f"started at {speed:.6g} rad/s it stops after {np.degrees(count * period + angle):.1f} deg"
            return _none(f"{where}: the work that swings is more than its kinetic energy; add a flywheel")
        energy = float(whole_turn.energy_edges[-1])
    return _none(f"started at {speed:.6g} rad/s it slows down for {_TRIES} periods and has no steady motion")


def mean_torque(panels: Panels) -> NewtonMetre:
    """Mean over the angle of the torque without load: the load torque that keeps a balance."""
    return float(_free(panels)[-1] / (panels.edges[-1] - panels.edges[0]))


def mean_inertia(panels: Panels) -> Inertia:
    """Mean over the angle of the inertia: each panel by its width."""
    return float(np.diff(panels.edges) / 2 @ (panels.inertia @ gauss()[1]) / np.ptp(panels.edges))


def _free(panels: Panels) -> np.ndarray:
    """Work of the torque without load, from the start to each end of a panel."""
    return turn(replace(panels, load=ConstantLoad(torque=0.0)), 0.0, 0.0).energy_edges


def flywheel_for_ripple(panels: Panels, speed: RadPerSecond, target: Pure = 1 / 50) -> Flywheel:
    """Flywheel with which the steady motion at a mean speed has a wanted ripple (max - min) / mean."""

    def excess(inertia: float) -> float:
        ripple = steady_state(panels, speed, inertia).speed_ripple
        return (_STANDING if ripple is None else ripple) - target

    bare = steady_state(panels, speed)
    if bare.speed_ripple is not None and bare.speed_ripple <= target:
        return Flywheel(status="not needed", reason=bare.reason, inertia=0.0, speed_ripple=bare.speed_ripple)
    # the usual estimate: work that swings = ripple * inertia * speed^2
    top = max(_swing(panels) / (target * speed**2), 1e-3 * float(np.mean(panels.inertia)))
    for _ in range(40):
        if excess(top) <= 0:
            break
        top *= 2
    else:
        why = steady_state(panels, speed, top)
        return Flywheel(status="none", reason=why.reason, inertia=None, speed_ripple=why.speed_ripple)
    bottom = top
    while excess(bottom) <= 0:
        bottom = bottom / 2 if bottom > 1e-6 * top else 0.0
    inertia = root(excess, bottom, top, rtol=1e-12, xtol=1e-300)
    reason = f"ripple {target:.6g} in steady motion"
    return Flywheel(status="found", reason=reason, inertia=inertia, speed_ripple=excess(inertia) + target)


def _swing(panels: Panels) -> float:
    """Work that swings in a period about the mean torque."""
    return float(np.ptp(_free(panels) - mean_torque(panels) * (panels.edges - panels.edges[0])))


def smallest_flywheel_that_turns(panels: Panels, speed: RadPerSecond, turns: int = 10) -> Flywheel:
    """The smallest flywheel with which the shaft, started at a speed where the panels begin, does not stop.

    panels: machine without flywheel; `tabulate(machine, phi_start)` sets where it starts. speed: speed at the start.
    Returns flywheel: inertia at which the shaft just stops short; anything larger turns.
    """

    def lowest(inertia: float) -> float:
        energy = 0.5 * (float(panels.inertia_edges[0]) + inertia) * speed**2
        least = energy
        for _ in range(turns):
            motion = turn(panels, inertia, energy)
            least, energy = min(least, lowest_energy(motion)), float(motion.energy_edges[-1])
            if least < 0:
                break
        return least

    if lowest(0.0) > 0:
        return Flywheel(status="not needed", reason="it turns without", inertia=0.0, speed_ripple=None)
    top = 2 * _swing(panels) / speed**2
    for _ in range(40):
        if lowest(top) > 0:
            inertia = root(lowest, 0.0, top, rtol=1e-12, xtol=1e-300)
            reason = f"started at {speed:.6g} rad/s, it completes {turns} periods"
            return Flywheel(status="found", reason=reason, inertia=inertia, speed_ripple=None)
        top *= 2
    reason = f"even {top:.3g} kg*m^2 stop within {turns} periods: the load takes more than the engine gives"
    return Flywheel(status="none", reason=reason, inertia=None, speed_ripple=None)
