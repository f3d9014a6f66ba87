r"""The ripple with friction and heat by two ways: over the angle, and in time with the gas as a state of its own.

.. math:: \dot T = -(\gamma - 1)\,T\,\frac{\dot V}{V} - \frac{T - T_w}{\tau}, \qquad
          p = (p_0 + p_a) \frac{H}{H - z} \frac{T}{T_w} - p_a

Over the angle the gas relaxes as at the mean speed; in time it relaxes in time, friction is taken at the speed of the
moment, and the first law of each gas is in the residual of the run.
"""

import dataclasses
from collections.abc import Callable

import numpy as np
import scipy

from mechsym import periodic
from mechsym.codesign import running
from mechsym.codesign.contact_block import Path, path_of
from mechsym.codesign.loss import friction, gas_turn, real, spring_with_heat
from mechsym.codesign.running import Running, TimeRun, ripple_of_last_turn
from mechsym.codesign.task import CoDesign, Track
from mechsym.hinge.losses import HingeLosses
from mechsym.hinge.springs.air_thermal import AirThermal
from mechsym.hinge.springs.face import Spring
from mechsym.machine.loads import load_torque
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Scalar

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
    turns = [gas_turn(t, p, point, given) for t, p in zip(machine.tracks, machine.pressures, strict=True)]
    starts = [1.0 if turn is None else turn.warmth[0] for turn in turns]
    rates, end = _rates(machine, gases, given), periods * point.period

    def turned(t: float, y: Scalar) -> float:
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
    springs = [gas or t.hardware.charged(p)
               for t, gas, p in zip(machine.tracks, gases, machine.pressures, strict=True)]  # fmt: skip
    stored = sum(float(np.diff(spring.energy(t.z(ends), warm[[0, -1]]))[0])
                 for t, spring, warm in zip(machine.tracks, springs, T, strict=True))  # fmt: skip
    residual = float((gained[-1] - lost[-1] - kinetic - stored) / (abs(lost[-1]) or 1.0))
    return TimeRun(t=t, phi=phi, omega=omega, stalled=not len(found.t_events[0]), energy_residual=residual,
                   dense=lambda times: (found.sol(times)[:1], found.sol(times)[1:2]))  # fmt: skip


def _rates(machine: Running, gases: list[AirThermal | None], given: HingeLosses) -> Callable[[Scalar], list[float]]:
    """Rates of angle, speed, work of the engine, work of load, friction and heat, and of each T / T_w."""
    point = machine.point
    engine = periodic.scalar(periodic.fit(machine.torque, machine.kinks, point.period, 1e-10))
    own = periodic.scalar(point.inertia)
    springs = [_spring(t, g or t.hardware.charged(p), g, given)
               for t, g, p in zip(machine.tracks, gases, machine.pressures, strict=True)]  # fmt: skip

    def rates(y: Scalar) -> list[float]:
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


def _spring(
    track: Track, spring: Spring, gas: AirThermal | None, given: HingeLosses
) -> Callable[[float, float, float], tuple[float, ...]]:
    """Of a guide at angle [rad], speed [rad/s] and T / T_w: inertia, its slope, torque, power lost, rate of T / T_w."""
    h, value, slope = track.hardware, periodic.scalar(track.z), periodic.scalar(track.z.derivative())
    mass, ratio = h.count * (h.moving_mass + h.roller_inertia / h.radius**2), h.shaft_ratio

    def at(phi: float, omega: float, warm: float) -> tuple[float, ...]:
        z, dz = value(phi)
        d2z = slope(phi)[1]
        path: Path = path_of(h, h.rho0, z, dz, d2z)
        across, along = ratio * path.rho, -dz / h.count
        force = spring.force(z, warm)
        rubbed = sum(friction(track, path, force, omega, given).values())
        heat, warming = (0.0, 0.0) if gas is None else (gas.heat(warm), gas.warming(warm, z, -dz * omega))
        inertia = mass * (across**2 + along**2)
        change = 2 * mass * (across * ratio * along - along * d2z / h.count)
        return inertia, change, -force * dz - float(rubbed), float(rubbed) * omega + heat, warming

    return at
