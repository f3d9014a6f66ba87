"""What else happens to a machine: another scavenge pressure, a leak, its controller, a start and a stop.

Rows like those of `scenarios`, at one point each.
"""

import dataclasses

import numpy as np
import scipy

from mechsym.codesign import manoeuvres, running
from mechsym.codesign.control import hold
from mechsym.codesign.loss import machine_at
from mechsym.codesign.points import Point
from mechsym.codesign.running import Running
from mechsym.codesign.scenarios import Scenario, not_running, steady_speed, told
from mechsym.codesign.task import CoDesign
from mechsym.quantities.display import per_cent, quantity_text

_LEAK, _OFF = 0.10, 0.10  # share of the pressure that is lost, or off when a controller begins
_TURNS = 10.0  # turns in which a leak is watched
_PUSH = 1.2  # starting torque by the one that just turns the shaft
_STOPPED = 2.0
_COAST = 60.0  # most turns of a stop


def rows(found: CoDesign, k: int, scavenged: Point | None = None) -> list[Scenario]:
    """Scenarios of a point. scavenged: the same point with a tenth less scavenge pressure and the load as it was."""
    machine = machine_at(found, k)
    made = [] if scavenged is None else [_scavenge_step(found, machine, scavenged, k)]
    made += [_leak(machine, k), _controlled(found, k)]
    return made + ([] if machine.point.misfire is None else [_start(machine, k), _stop(machine, k)])


def _scavenge_step(found: CoDesign, machine: Running, scavenged: Point, k: int) -> Scenario:
    """The load stays, the gas has another shape: how far from it is the guide, and does a pressure help?"""
    name, about = "scavenge step", "scavenge pressure 10 % lower, mean pressure and spring as before"
    start = steady_speed(machine)
    if start is None:
        return not_running(name, about, k)
    other = running.running(scavenged, found.tracks, k, found.flywheel)
    other = dataclasses.replace(other, extra=machine.extra, load=machine.load)
    run = running.run(other, start[0], _TURNS)

    def ripple(share: float) -> float:
        motion = running.steady(
            dataclasses.replace(other, pressures=tuple(share * p for p in other.pressures))
        ).speed_ripple
        return _STOPPED if motion is None else motion

    best = scipy.optimize.minimize_scalar(ripple, bounds=(0.8, 1.2), method="bounded", options={"xatol": 1e-4})
    words = f"ripple {per_cent(ripple(1.0))}, with {per_cent(best.x)} of the pressures {per_cent(best.fun)}"
    return told(name, about, k, start[1], run, lambda r: words)


def _leak(machine: Running, k: int) -> Scenario:
    name, about = "leak", f"every spring {_LEAK:.0%} below its pressure from dead centre on, fuel as before"
    start = steady_speed(machine)
    if start is None:
        return not_running(name, about, k)
    low = dataclasses.replace(machine, pressures=tuple((1 - _LEAK) * p for p in machine.pressures))
    run = running.run(low, start[0], _TURNS)
    ripple = running.ripple_of_last_turn(run, machine.point.period) or _STOPPED
    return told(name, about, k, start[1], run, lambda r: f"ripple {per_cent(ripple)} after {_TURNS:g} turns")


def _controlled(found: CoDesign, k: int) -> Scenario:
    """The controller of one turn, from pressures that are off."""
    held, point = hold(found, k, _OFF, turns=4), found.task.points[k]
    about = f"pressures {_OFF:.0%} off, set after each turn from the speed of that turn"
    errors = ", ".join(f"{100 * e:.2f}" for e in np.abs(held.pressure_error).max(axis=1))
    words = f"error {errors} % turn by turn, ripple {per_cent(held.ripple[0])} to {per_cent(held.ripple[-1])}"
    return told("controller", about, k, point.omega, held.run, lambda r: words)


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
