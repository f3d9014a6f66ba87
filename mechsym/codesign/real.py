r"""The ripple with friction and heat by two ways: over the angle, and in time with the gas as a state of its own.

.. math:: \dot T = -(\gamma - 1)\,T\,\frac{\dot V}{V} - \frac{T - T_w}{\tau}, \qquad
          p = (p_0 + p_a) \frac{H}{H - z} \frac{T}{T_w} - p_a

Over the angle the gas relaxes as at the mean speed; in time it relaxes in time, friction is taken at the speed of the
moment, and the first law of each gas is in the residual of the run.
"""

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
import scipy

from mechsym import periodic
from mechsym.codesign import running
from mechsym.codesign.contact_block import Path, path_of
from mechsym.codesign.loss import friction, gas_turn, real, spring_with_heat
from mechsym.codesign.running import Running, TimeRun, ripple_of_last_turn
from mechsym.codesign.task import CoDesign, Track
from mechsym.hinge.losses import HingeLosses
from mechsym.hinge.thermal import AirThermal
from mechsym.machine.loads import load_torque
from mechsym.quantities import quantity, record

_RESET = (0.7, 1.3)  # fills that are tried, by that of the schedule
_STOPPED = 2.0
_TOLERANCE, _TURNS, _PER_TURN = 1e-9, 2, 1440


@record
class Lossy:
    """A point with friction and heat, its load lowered by what they take."""

    ripple: float | None = quantity("-", about="over the angle; None where there is no steady motion")
    time_ripple: float | None = quantity("-", about="run in time; None where there is no steady motion or a stall")
    energy_residual: float | None = quantity("-", about="of that run")
    fill: float = quantity("-", about="fill of the springs by that of the schedule, for the least ripple")


def with_losses(found: CoDesign, k: int, given: HingeLosses) -> Lossy:
    """A point with friction and heat; the fill is set anew unless the programme had them in it."""
    inside, point = found.task.losses, found.task.points[k]
    machine = running.running(point, found.tracks, k, found.flywheel)
    assumed = inside or given
    if real(machine, assumed).taken.total >= abs(point.load_torque):  # the hinge takes more than the machine gives
        return Lossy(ripple=None, time_ripple=None, energy_residual=None, fill=1.0)

    def ripple(fill: float) -> float:
        motion = running.steady(real(machine, assumed, fill).machine)
        return _STOPPED if motion.speed_ripple is None else motion.speed_ripple

    fill = 1.0 if inside else float(
        scipy.optimize.minimize_scalar(ripple, bounds=_RESET, method="bounded", options={"xatol": 1e-4}).x)  # fmt: skip
    made = real(machine, assumed, fill).machine
    motion = running.steady(made)
    if motion.speed_ripple is None:
        return Lossy(ripple=None, time_ripple=None, energy_residual=None, fill=fill)
    filled = dataclasses.replace(made, pressures=tuple(fill * p for p in machine.pressures))
    run = in_time(filled, assumed, float(motion.omega[0]), _TURNS)
    return Lossy(ripple=motion.speed_ripple, time_ripple=ripple_of_last_turn(run, point.period),
                 energy_residual=run.energy_residual, fill=fill)  # fmt: skip


def in_time(machine: Running, given: HingeLosses, speed: float, periods: int) -> TimeRun:
    """Run a machine of `real` from dead centre at a speed [rad/s] for some periods, each gas a state."""
    point = machine.point
    gases = [spring_with_heat(t, p, point.omega, given) for t, p in zip(machine.tracks, machine.pressures, strict=True)]
    starts = [gas_turn(t, g.p0, point, given).temperature[0] for t, g in zip(machine.tracks, gases, strict=True)]
    rates, end = _rates(machine, gases, given), periods * point.period

    def turned(t: float, y: Any) -> float:
        return float(y[0]) - end

    turned.terminal = True  # type: ignore[attr-defined]
    found = scipy.integrate.solve_ivp(
        lambda t, y: rates(y), (0.0, 5 * end / speed), [0.0, speed, 0.0, 0.0, *starts], method="DOP853",
        rtol=_TOLERANCE, atol=_TOLERANCE * np.array([1, point.omega, *[abs(point.load_torque)] * 2, *starts]),
        events=turned, dense_output=True, max_step=point.period / point.omega / 60,
    )  # fmt: skip
    t = np.linspace(0, found.t[-1], round(_PER_TURN * end / (2 * np.pi)) + 1)
    phi, omega, gained, lost, *T = found.sol(t)
    ends = np.array([phi[0], phi[-1]])
    kinetic = np.diff(running.inertia(machine, ends) * np.array([omega[0], omega[-1]]) ** 2 / 2)[0]
    stored = sum(float(np.diff(_stored(track, gas, ends, T_[[0, -1]]))[0])
                 for track, gas, T_ in zip(machine.tracks, gases, T, strict=True))  # fmt: skip
    residual = float((gained[-1] - lost[-1] - kinetic - stored) / (abs(lost[-1]) or 1.0))
    return TimeRun(t=t, phi=phi, omega=omega, stalled=not len(found.t_events[0]), energy_residual=residual)


def _stored(track: Track, gas: AirThermal, phi: np.ndarray, T: np.ndarray) -> np.ndarray:
    """Heat in the gas less the work of the air outside [J] at phi [rad] and temperatures T [K]."""
    warm = (gas.p0 + gas.pa) * gas.A * gas.H / (gas.gamma - 1) / gas.wall_temperature
    return np.asarray(warm * T - gas.pa * gas.A * track.z(phi))


def _rates(machine: Running, gases: list[AirThermal], given: HingeLosses) -> Callable[[Any], list[float]]:
    """Rates of angle, speed, work of the engine, work of load, friction and heat, and of each temperature."""
    point = machine.point
    engine = periodic.scalar(periodic.fit(machine.torque, machine.kinks, point.period, 1e-10))
    own = periodic.scalar(point.inertia)
    springs = [_spring(t, g, given) for t, g in zip(machine.tracks, gases, strict=True)]

    def rates(y: Any) -> list[float]:
        phi, omega = float(y[0]), float(y[1])
        driving, (total, rise) = engine(phi)[0], own(phi)
        total, push, away, warming = total + machine.flywheel, 0.0, 0.0, []
        for of, T in zip(springs, y[4:], strict=True):
            inertia, change, torque, lost, rate = of(phi, omega, float(T))
            total, rise, push, away = total + inertia, rise + change, push + torque, away + lost
            warming.append(rate)
        taken = float(load_torque(machine.load, omega)) * omega
        return [omega, (driving + push - taken / omega - rise * omega**2 / 2) / total, driving * omega, taken + away,
                *warming]  # fmt: skip

    return rates


def _spring(track: Track, gas: AirThermal, given: HingeLosses) -> Callable[[float, float, float], tuple[float, ...]]:
    """Of one guide at angle [rad], speed [rad/s] and temperature [K]: inertia, its slope, torque, power lost, dT/dt."""
    h, value, slope = track.hardware, periodic.scalar(track.z), periodic.scalar(track.z.derivative())
    mass, ratio = h.count * (h.moving_mass + h.roller_inertia / h.radius**2), h.shaft_ratio
    capacity = (gas.p0 + gas.pa) * gas.A * gas.H / (gas.gamma - 1) / gas.wall_temperature

    def at(phi: float, omega: float, T: float) -> tuple[float, ...]:
        z, dz = value(phi)
        d2z = slope(phi)[1]
        path: Path = path_of(h, h.rho0, z, dz, d2z)
        across, along = ratio * path.rho, -dz / h.count
        force = h.A * ((gas.p0 + gas.pa) * gas.H / (gas.H - z) * T / gas.wall_temperature - gas.pa)
        rubbed = sum(friction(track, path, force, omega, given).values())
        exchanged = (T - gas.wall_temperature) / gas.tau
        cooling = -(gas.gamma - 1) * T * (-dz * omega) / (gas.H - z) - exchanged
        inertia = mass * (across**2 + along**2)
        change = 2 * mass * (across * ratio * along - along * d2z / h.count)
        return inertia, change, -force * dz - float(rubbed), float(rubbed) * omega + capacity * exchanged, cooling

    return at
