r"""The co-designed machine as built: its torque and inertia over the angle, and a run in time.

.. math:: I_t \ddot\varphi + \tfrac12 I_t' \dot\varphi^2 = Q(\varphi) - \sum F(z) z' - M_\mathrm{load}(\dot\varphi),
          \qquad I_t = I + J + I_h

Q is the torque of gas and gravity as computed, never what the programme was fitted to. `steady` solves for the energy
over the angle by collocation (mechsym.simulate); `run` integrates this equation over time by a Runge-Kutta method of
order eight. They share the functions of the machine and no method.
"""

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
import scipy

from mechsym import periodic
from mechsym.codesign.contact_block import path_of
from mechsym.codesign.hardware import gas_energy, gas_pressure, outside, roller_inertia
from mechsym.codesign.points import Function, Point
from mechsym.codesign.task import Track
from mechsym.machine.loads import ConstantLoad, PropellerLoad, load_torque
from mechsym.quantities import quantity, record
from mechsym.simulate.angle import Panels, ReducedMachine, tabulate
from mechsym.simulate.steady import Steady, mean_torque, steady_state

_TOLERANCE = 1e-10
_PER_TURN = 1440  # angles at which a run is read
_STALLED = 0.02  # of the mean speed


@record
class Running:
    """A machine at one point, ready to turn."""

    point: Point
    tracks: tuple[Track, ...]
    pressures: tuple[float, ...]  #: excess pressure of each spring at free height [Pa]
    flywheel: float = quantity("kg*m^2", about="inertia added to the engine's own")
    load: ConstantLoad | PropellerLoad
    torque: Function  #: gas and gravity over the angle [N*m]
    kinks: tuple[float, ...]  #: of that torque [rad]
    extra: scipy.interpolate.PPoly | None = (
        None  #: torque of friction, and of a gas with heat beside the polytrope [N*m]
    )


@record
class TimeRun:
    """A run in time."""

    t: np.ndarray  #: [s]
    phi: np.ndarray  #: [rad]
    omega: np.ndarray  #: [rad/s]
    stalled: bool
    energy_residual: float = quantity("-", about="(work in - load - change of energy) / work of the load")


def running(
    point: Point, tracks: Sequence[Track], k: int, flywheel: float, errors: Sequence[float] | None = None
) -> Running:
    """A point of a co-design with its load law; `errors` [-] are shares that each pressure is off."""
    law: ConstantLoad | PropellerLoad = (
        PropellerLoad(torque=point.load_torque, speed=point.omega)
        if point.law == "propeller"
        else ConstantLoad(torque=point.load_torque)
    )
    factors = errors or [0.0] * len(tracks)
    return Running(
        point=point, tracks=tuple(tracks), flywheel=flywheel, load=law, torque=point.torque,
        kinks=point.kinks,
        pressures=tuple(float(t.p0[k]) * (1 + e) for t, e in zip(tracks, factors, strict=True)),
    )  # fmt: skip


def spring_torque(track: Track, p0: float, phi: Any) -> np.ndarray:
    """Torque of one guide on the shaft, positive driving [N*m], at phi [rad] with pressure p0 [Pa]."""
    h, z = track.hardware, track.z(phi)
    return -h.A * gas_pressure(z, p0, h.H, h.n, outside(h)) * track.z.derivative()(phi)


def spring_energy(track: Track, p0: float, phi: Any) -> np.ndarray:
    """Energy in one spring [J] at phi [rad] with pressure p0 [Pa]."""
    h = track.hardware
    return h.A * gas_energy(track.z(phi), p0, h.H, h.n, outside(h))


def added_inertia(track: Track, phi: Any) -> np.ndarray:
    """Inertia of the rollers of one guide about the shaft [kg*m^2] at phi [rad]."""
    h, dz = track.hardware, track.z.derivative()(phi)
    path = path_of(h, h.rho0, track.z(phi), dz, 0 * dz)
    return h.shaft_ratio**2 * roller_inertia(path.rho, path.drho, h.moving_mass, h.roller_inertia, h.radius, h.count)


def inertia(machine: Running, phi: Any) -> np.ndarray:
    """All inertia that turns [kg*m^2] at phi [rad]."""
    return machine.point.inertia(phi) + machine.flywheel + sum(added_inertia(t, phi) for t in machine.tracks)


def torque(machine: Running, phi: Any) -> np.ndarray:
    """Torque of gas, gravity and springs on the shaft [N*m] at phi [rad]."""
    springs = zip(machine.tracks, machine.pressures, strict=True)
    extra = 0.0 if machine.extra is None else machine.extra(phi)
    return machine.torque(phi) + extra + sum(spring_torque(track, p0, phi) for track, p0 in springs)


def panels(machine: Running) -> Panels:
    """The machine over the angle, for `mechsym.simulate`."""
    point = machine.point
    knots = {float(x) for t in machine.tracks for x in t.z.x[:-1] % point.period}
    made = tabulate(
        ReducedMachine(
            inertia=lambda phi: inertia(machine, phi), torque=lambda phi: torque(machine, phi), load=machine.load,
            period=point.period, kinks=tuple(sorted({*machine.kinks, *knots})),
        )
    )  # fmt: skip
    if isinstance(machine.load, ConstantLoad):
        # a governor holds the mean: the load is what these panels integrate
        return dataclasses.replace(made, load=ConstantLoad(torque=mean_torque(made)))
    return made


def steady(machine: Running) -> Steady:
    """The periodic motion of the machine."""
    return steady_state(panels(machine), machine.point.omega)


def run(machine: Running, speed: float, turns: float, phi_start: float = 0.0, stall: float = _STALLED) -> TimeRun:
    """Run the machine in time from a speed [rad/s] and an angle [rad] for some turns; it may stall.

    Parameters
    ----------
    turns : float
        Turns of the crank [-]
    stall : float
        Share of the point's speed below which the run ends [-]
    """
    rates = _rates(machine)
    turned = _event(lambda y: y[0] - phi_start - 2 * np.pi * turns, 1.0)
    stalled = _event(lambda y: y[1] - stall * machine.point.omega, -1.0)
    found = scipy.integrate.solve_ivp(
        lambda t, y: rates(y), (0.0, 20 * turns * 2 * np.pi / speed), [phi_start, speed, 0.0, 0.0], method="DOP853",
        rtol=_TOLERANCE, atol=_TOLERANCE, events=[turned, stalled], dense_output=True,
        max_step=2 * np.pi / machine.point.omega / 90,
    )  # fmt: skip
    t = np.linspace(0, found.t[-1], int(_PER_TURN * turns) + 1)
    phi, omega, gained, taken = found.sol(t)
    ends = np.array([phi[0], phi[-1]])
    stored = sum(np.diff(spring_energy(t_, p0, ends))[0]
                 for t_, p0 in zip(machine.tracks, machine.pressures, strict=True))  # fmt: skip
    kinetic = inertia(machine, ends) * np.array([omega[0], omega[-1]]) ** 2 / 2
    turned_over = abs(taken[-1]) or abs(gained[-1]) or 1e-30
    residual = float((gained[-1] - taken[-1] - np.diff(kinetic)[0] - stored) / turned_over)
    return TimeRun(t=t, phi=phi, omega=omega, stalled=bool(len(found.t_events[1])), energy_residual=residual)


def joined(legs: Sequence[TimeRun]) -> TimeRun:
    """Runs one behind the other as one."""
    times = np.cumsum([0.0, *(leg.t[-1] for leg in legs[:-1])])
    turned = np.cumsum([0.0, *(leg.phi[-1] - leg.phi[0] for leg in legs[:-1])])
    return TimeRun(
        t=np.concatenate([leg.t + t for leg, t in zip(legs, times, strict=True)]),
        phi=np.concatenate([leg.phi + a for leg, a in zip(legs, turned, strict=True)]),
        omega=np.concatenate([leg.omega for leg in legs]),
        stalled=legs[-1].stalled,
        energy_residual=max((leg.energy_residual for leg in legs), key=abs),
    )


def ripple_of_last_turn(found: TimeRun, period: float) -> float | None:
    """(max - min) / mean of the speed over the last period [rad]; None after a stall."""
    if found.stalled:
        return None
    last = found.phi >= found.phi[-1] - period
    mean = float(np.ptp(found.phi[last]) / np.ptp(found.t[last]))
    return float(np.ptp(found.omega[last])) / mean


def _event(value: Callable[[Any], float], direction: float) -> Any:
    def event(t: float, y: Any) -> float:
        return value(y)

    event.terminal, event.direction = True, direction  # type: ignore[attr-defined]
    return event


def _rates(machine: Running) -> Callable[[Any], list[float]]:
    """Rates of angle, speed, work of gas and gravity, and work of the load, as fast functions of floats."""
    point = machine.point
    gas = periodic.scalar(periodic.fit(machine.torque, machine.kinks, point.period, 1e-10))
    engine = periodic.scalar(point.inertia)
    springs = [_spring_rates(t, p0) for t, p0 in zip(machine.tracks, machine.pressures, strict=True)]
    load, flywheel = machine.load, machine.flywheel
    extra = _nothing if machine.extra is None else periodic.scalar(machine.extra)

    def rates(y: Any) -> list[float]:
        phi, omega = float(y[0]), float(y[1])
        driving = gas(phi)[0] + extra(phi)[0]
        own, slope = engine(phi)
        total, rise, push = own + flywheel, slope, 0.0
        for of in springs:
            added, change, pushed = of(phi)
            total, rise, push = total + added, rise + change, push + pushed
        taken = float(load_torque(load, omega))
        return [omega, (driving + push - taken - rise * omega**2 / 2) / total, driving * omega, taken * omega]

    return rates


def _nothing(phi: float) -> tuple[float, float]:
    return 0.0, 0.0


def _spring_rates(track: Track, p0: float) -> Callable[[float], tuple[float, float, float]]:
    """Added inertia [kg*m^2], its derivative [kg*m^2/rad] and the torque [N*m] of one guide at an angle [rad]."""
    h, value, slope = track.hardware, periodic.scalar(track.z), periodic.scalar(track.z.derivative())
    ratio, pa = h.shaft_ratio, outside(h)
    mass = h.count * (h.moving_mass + h.roller_inertia / h.radius**2)

    def rates(phi: float) -> tuple[float, float, float]:
        z, dz = value(phi)
        d2z = slope(phi)[1]
        # radial and tangential velocity of a roller by the crank's speed
        across, along = ratio * (h.rho0 - z / h.count), -dz / h.count
        push = -h.A * gas_pressure(z, p0, h.H, h.n, pa) * dz
        return mass * (across**2 + along**2), 2 * mass * (across * ratio * along - along * d2z / h.count), push

    return rates
