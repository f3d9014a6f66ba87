"""What happens to the machine: a lost combustion, a jump of the load, spread of the cycles, loss of pressure, start.

Every row is a run in time of the machine as built, from its steady motion; speeds are shares of the mean speed.

What else happens to a machine: another scavenge pressure, a leak, its controller, a start and a stop. Rows like those
before, at one point each.
"""

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np

from mechsym.codesign import manoeuvres, running
from mechsym.codesign.loss import machine_at
from mechsym.codesign.manoeuvres import hold
from mechsym.codesign.points import Point
from mechsym.codesign.running import Running, TimeRun
from mechsym.codesign.task import CoDesign
from mechsym.hinge.balance import least_ripple, or_stopped
from mechsym.machine.loads import ConstantLoad, PropellerLoad
from mechsym.periodic.pieces import PPoly
from mechsym.periodic.roots import root
from mechsym.quantities import quantity, record
from mechsym.quantities.display import per_cent, quantity_text
from mechsym.quantities.units import Inertia

_SETTLE = 20.0  # turns after which a start or a coast has told what there is to tell


@record
class Scenario:
    """One thing that happens at one point."""

    name: str
    about: str
    point: int
    speed_min: float | None = quantity("-", about="lowest speed by the mean speed before; None after a stall")
    speed_max: float | None = quantity("-", about="highest speed by the mean speed before; None after a stall")
    outcome: str  #: what came of it, in words
    run: TimeRun | None  #: None where the shaft cannot even be started


def misfire(design: CoDesign, k: int, flywheel: float | None = None) -> Scenario:
    """One period without combustion from dead centre at a point; `flywheel` [kg*m^2] in place of the design's."""
    point, inertia = design.task.points[k], design.flywheel if flywheel is None else flywheel
    machine = machine_at(design, k, inertia)
    return _lost_combustion(machine, point, k)


def misfire_shares(design: CoDesign, flywheel: Inertia | None = None) -> list[float | None]:
    """Lowest speed after a lost combustion by the mean speed at each point [-]; 0 for a stall, None if not known.

    flywheel: in place of the design's.
    """
    return [_share(design, k, flywheel) for k in range(len(design.task.points))]


def misfire_flywheel(design: CoDesign, share: float, least: Inertia | None = None) -> Inertia | None:
    """Flywheel with which a lost combustion leaves a share [-] of the speed at every point, guides unchanged [kg*m^2].

    least: what it is at least, by default the design's. Returns inertia: None where a point does not know its misfire.
    """
    if any(p.misfire is None for p in design.task.points):
        return None

    def short(flywheel: float) -> float:
        return min(_share(design, k, flywheel) or 0.0 for k in range(len(design.task.points))) - share

    low = design.flywheel if least is None else least
    if short(low) >= 0:
        return low
    high = max(2 * low, 100.0)
    while short(high) < 0:
        high *= 2
    return root(short, low, high, xtol=min(1.0, 1e-3 * high))


def table(design: CoDesign, ks: Sequence[int] | None = None) -> list[Scenario]:
    """All scenarios at some points, by default at the first and the last."""
    rows = []
    for k in ks if ks is not None else sorted({0, len(design.task.points) - 1}):
        point = design.task.points[k]
        machine = machine_at(design, k)
        if point.misfire is not None:
            rows.append(_lost_combustion(machine, point, k))
        rows += [_load_step(machine, k), _governed(machine, k), _scatter(machine, k, 0.01), _scatter(machine, k, 0.03)]
        rows += [_vented(machine, k), _standstill(machine, k), _astern(machine, k)]
    return rows


def _share(design: CoDesign, k: int, flywheel: float | None) -> float | None:
    if design.task.points[k].misfire is None:
        return None
    return misfire(design, k, flywheel).speed_min or 0.0


def steady_speed(machine: Running) -> tuple[float, float] | None:
    """Speed at dead centre and mean speed of the steady motion [rad/s]; None where there is none."""
    motion = running.steady(machine)
    return None if motion.speed_mean is None else (float(motion.omega[0]), motion.speed_mean)


def told(name: str, about: str, k: int, mean: float, run: TimeRun, words: Callable[[TimeRun], str]) -> Scenario:
    """A run as a scenario, its speeds as shares of `mean` [rad/s]; `words` tell how it went unless it stopped."""
    low, high = (None, None) if run.stalled else (speed / mean for speed in running.extremes(run))
    angle = np.degrees(run.phi[-1] - run.phi[0])
    text = f"the shaft stops after {angle:.0f} deg" if run.stalled else words(run)
    return Scenario(name=name, about=about, point=k, speed_min=low, speed_max=high, outcome=text, run=run)


def not_running(name: str, about: str, k: int) -> Scenario:
    """A scenario of a machine without steady motion."""
    return Scenario(name=name, about=about, point=k, speed_min=None, speed_max=None, run=None,
                    outcome="there is no steady motion to start from")  # fmt: skip


def _lost_combustion(machine: Running, point: Point, k: int) -> Scenario:
    name, about = "misfire", "one turn without combustion, propeller or constant load as before"
    start = steady_speed(machine)
    if start is None or point.misfire is None:
        return not_running(name, about, k)
    without = dataclasses.replace(machine, torque=point.misfire, kinks=point.misfire_kinks)
    run = running.run(without, start[0], point.period / (2 * np.pi))
    lowest = running.extremes(run)[0] / start[1]
    return told(name, about, k, start[1], run, lambda r: f"lowest speed {per_cent(lowest)} of the mean")


def _load_step(machine: Running, k: int) -> Scenario:
    """The load jumps up by a tenth of its torque and stays; the combustion stays too: where does the speed settle?"""
    name, about = "load step", "load 10 % higher from dead centre on, fuel as before, no governor"
    start = steady_speed(machine)
    if start is None:
        return not_running(name, about, k)
    heavier = dataclasses.replace(machine, load=_heavier(machine.load, 1.1))
    run = running.run(heavier, start[0], 10.0)
    return told(
        name, about, k, start[1], run, lambda r: f"{per_cent(r.omega[-1] / start[1])} of the speed after 10 turns"
    )


def _governed(machine: Running, k: int) -> Scenario:
    name, about = "load step, governed", "load 10 % higher from dead centre on, a governor sets the fuel of each turn"
    start = steady_speed(machine)
    if start is None:
        return not_running(name, about, k)
    heavier = dataclasses.replace(machine, load=_heavier(machine.load, 1.1))
    run = manoeuvres.governed(heavier, start[0], 40)
    return told(
        name, about, k, start[1], run, lambda r: f"{per_cent(_last_turn(r) / start[1])} of the speed after 40 turns"
    )


def _standstill(machine: Running, k: int) -> Scenario:
    """No run: where the shaft rests, and what turns it from there."""
    stop = manoeuvres.standstill(machine)
    angles, load = ", ".join(f"{np.degrees(a):.0f}" for a in stop.angles), abs(machine.point.load_torque)
    torque, vented = (quantity_text(value, "N*m", 3) for value in (stop.torque, stop.vented))
    return Scenario(
        name="standing still", about="springs under pressure, no fuel, no friction", point=k, speed_min=None,
        speed_max=None, run=None,
        outcome=f"rests at {angles} deg; a constant {torque} ({stop.torque / load:.2f} of the load's) "
                f"turns it from there for good, {vented} with the springs vented",
    )  # fmt: skip


def _astern(machine: Running, k: int) -> Scenario:
    """The same pressures; the engine is fired in the other sense, the guide is met backwards."""
    name, about = "astern", "turned the other way on the same guide, propeller or constant load as ahead"
    motion = running.steady(manoeuvres.astern(machine))
    words = "there is no steady motion: the shaft stops" if motion.speed_ripple is None else (
        f"ripple {per_cent(motion.speed_ripple)}")  # fmt: skip
    return Scenario(name=name, about=about, point=k, speed_min=None, speed_max=None, run=None, outcome=words)


def _last_turn(run: TimeRun) -> float:
    """Mean speed of the last turn [rad/s]."""
    last = run.phi >= run.phi[-1] - 2 * np.pi
    return float(np.ptp(run.phi[last]) / np.ptp(run.t[last]))


def _scatter(machine: Running, k: int, share: float) -> Scenario:
    """Every turn another mean indicated pressure: 20 turns of one fixed sequence of normal numbers."""
    name, about = f"scatter {share:.0%}", f"gas torque of each turn scattered by {share:.0%} (one sigma), 20 turns"
    start = steady_speed(machine)
    if start is None:
        return not_running(name, about, k)
    whole = running.fitted(machine.torque, machine.kinks, machine.point.period)
    factors = 1 + share * np.random.default_rng(20).standard_normal(20)
    speed = start[0]
    legs: list[TimeRun] = []
    for factor in factors:
        scaled = dataclasses.replace(machine, torque=PPoly(factor * whole.c, whole.x, "periodic"))
        leg = running.run(scaled, speed, machine.point.period / (2 * np.pi))
        legs.append(leg)
        speed = float(leg.omega[-1])
        if leg.stalled:
            break
    run = running.joined(legs)
    return told(
        name, about, k, start[1], run, lambda r: f"ripple over all turns {per_cent(np.ptp(r.omega) / start[1])}"
    )


def _vented(machine: Running, k: int) -> Scenario:
    """The springs lose their pressure at speed and the fuel is cut: does the shaft coast down, or stop at once?"""
    name, about = "burst", "springs without pressure and fuel cut from dead centre on"
    start = steady_speed(machine)
    if start is None or machine.point.misfire is None:
        return not_running(name, about, k)
    empty = dataclasses.replace(
        machine, torque=machine.point.misfire, kinks=machine.point.misfire_kinks,
        pressures=tuple(1e3 for _ in machine.pressures), extra=None,
    )  # fmt: skip
    run = running.run(empty, start[0], _SETTLE)
    return told(name, about, k, start[1], run, lambda r: f"still {r.omega[-1] / start[1]:.2f} after {_SETTLE:g} turns")


def _heavier(load: ConstantLoad | PropellerLoad, factor: float) -> ConstantLoad | PropellerLoad:
    return dataclasses.replace(load, torque=factor * (load.torque or 0.0))


_LEAK, _OFF = 0.10, 0.10  # share of the pressure that is lost, or off when a controller begins
_TURNS = 10.0  # turns in which a leak is watched
_PUSH = 1.2  # starting torque by the one that just turns the shaft
_COAST = 60.0  # most turns of a stop


def rows(design: CoDesign, k: int, scavenged: Point | None = None) -> list[Scenario]:
    """Scenarios of a point. scavenged: the same point with a tenth less scavenge pressure and the load as it was."""
    machine = machine_at(design, k)
    scenarios = [] if scavenged is None else [_scavenge_step(design, machine, scavenged, k)]
    # the controller of one turn, from pressures that are off
    held, point = hold(design, k, _OFF, turns=4), design.task.points[k]
    about = f"pressures {_OFF:.0%} off, set after each turn from the speed of that turn"
    errors = ", ".join(f"{100 * e:.2f}" for e in np.abs(held.pressure_error).max(axis=1))
    words = f"error {errors} % turn by turn, ripple {per_cent(held.ripple[0])} to {per_cent(held.ripple[-1])}"
    scenarios += [_leak(machine, k), told("controller", about, k, point.omega, held.run, lambda r: words)]
    return scenarios + ([] if machine.point.misfire is None else [_start(machine, k), _stop(machine, k)])


def _scavenge_step(design: CoDesign, machine: Running, scavenged: Point, k: int) -> Scenario:
    """The load stays, the gas has another shape: how far from it is the guide, and does a pressure help?"""
    name, about = "scavenge step", "scavenge pressure 10 % lower, mean pressure and spring as before"
    start = steady_speed(machine)
    if start is None:
        return not_running(name, about, k)
    other = running.running(scavenged, design.tracks, k, design.flywheel)
    other = dataclasses.replace(other, extra=machine.extra, load=machine.load)
    run = running.run(other, start[0], _TURNS)

    def ripple(share: float) -> float | None:
        charged = dataclasses.replace(other, pressures=tuple(share * p for p in other.pressures))
        return running.steady(charged).speed_ripple

    own, (best, least) = ripple(1.0), least_ripple(ripple, 0.8, 1.2)
    words = "no steady motion" if own is None else f"ripple {per_cent(own)}"
    words += "" if least is None else f", with {per_cent(best)} of the pressures {per_cent(least)}"
    return told(name, about, k, start[1], run, lambda r: words)


def _leak(machine: Running, k: int) -> Scenario:
    name, about = "leak", f"every spring {_LEAK:.0%} below its pressure from dead centre on, fuel as before"
    start = steady_speed(machine)
    if start is None:
        return not_running(name, about, k)
    low = dataclasses.replace(machine, pressures=tuple((1 - _LEAK) * p for p in machine.pressures))
    run = running.run(low, start[0], _TURNS)
    ripple = or_stopped(running.ripple_of_last_turn(run, machine.point.period))
    return told(name, about, k, start[1], run, lambda r: f"ripple {per_cent(ripple)} after {_TURNS:g} turns")


def _start(machine: Running, k: int) -> Scenario:
    """Starting air is taken as a constant torque: which cylinder gets it, and when, is not known here."""
    torque = _PUSH * manoeuvres.standstill(machine).torque
    run = manoeuvres.start(machine, _PUSH)
    pushed = quantity_text(torque, "N*m", 3)
    about = f"from rest under a constant {pushed}, {_PUSH:g} of what just turns the shaft; no fuel, no load"
    return told("start", about, k, machine.point.omega, run,
                lambda r: f"{per_cent(r.omega[-1] / machine.point.omega)} of the speed after two turns")  # fmt: skip


def _stop(machine: Running, k: int) -> Scenario:
    name, about = "stop", "fuel cut at dead centre, springs under pressure, load brakes on"
    start, point = steady_speed(machine), machine.point
    if start is None or point.misfire is None:
        return not_running(name, about, k)
    coasting = dataclasses.replace(machine, torque=point.misfire, kinks=point.misfire_kinks)
    run = running.run(coasting, start[0], _COAST)
    if not run.stalled:
        return told(name, about, k, start[1], run, lambda r: f"still turning after {_COAST:g} turns")
    angle, turned = float(run.phi[-1] % point.period), float(run.phi[-1] - run.phi[0]) / (2 * np.pi)
    rest = np.degrees(manoeuvres.rest_from(machine, angle))
    words = (
        f"turns {turned:.2f} turns more, stands at {np.degrees(angle):.0f} deg, swings back and rests at {rest:.0f} deg"
    )
    return dataclasses.replace(told(name, about, k, start[1], run, str), outcome=words)
