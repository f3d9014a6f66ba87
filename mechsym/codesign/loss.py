r"""What friction and heat take from a co-designed hinge at each of its points.

The ripple with friction and heat by two ways: over the angle, and in time with the gas as a state of its own.

.. math:: \dot T = -(\gamma - 1)\,T\,\frac{\dot V}{V} - \frac{T - T_w}{\tau}, \qquad
          p = (p_0 + p_a) \frac{H}{H - z} \frac{T}{T_w} - p_a

Over the angle the gas relaxes as at the mean speed; in time it relaxes in time, friction is taken at the speed of the
moment, and the first law of each gas is in the residual of the run.
"""

import dataclasses
from collections.abc import Sequence

import casadi as ca
import numpy as np

from mechsym.codesign import running
from mechsym.codesign.points import Point
from mechsym.codesign.running import Running, TimeRun, ripple_of_last_turn
from mechsym.codesign.task import CoDesign, Path, Track, fine_path, path_of
from mechsym.hinge.balance import least_ripple
from mechsym.hinge.price import FILLS
from mechsym.hinge.rollers import HingeLosses, LossTorques, friction_torques
from mechsym.hinge.springs.air_thermal import AirThermal
from mechsym.hinge.springs.face import GasTurn, Spring
from mechsym.machine.loads import load_torque
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Newton, RadPerSecond, Scalar

KINDS = tuple(field.name for field in dataclasses.fields(LossTorques))


@record
class Real:
    """A machine with friction and heat in its torque, its load lowered by what they take."""

    machine: Running
    taken: LossTorques


def friction(
    track: Track, path: Path, force: Newton[Scalar], omega: RadPerSecond[Scalar], given: HingeLosses
) -> dict[str, Scalar]:
    """Torques on the crank that bearings, seals and guides take [N*m]. force: of the spring on each roller."""
    h, at = track.hardware, (path.rho, path.drho, path.d2rho)
    torques = friction_torques(force, at, h.shaft_ratio * omega, h, h.count, given)
    return {kind: h.shaft_ratio * torque for kind, torque in torques.items()}


def gas_turn(track: Track, p0: float, point: Point, given: HingeLosses) -> GasTurn | None:
    """The gas of one spring, filled to p0 [Pa], over a period; None of a law without heat."""
    phi, path = fine_path(track, point.period)
    walled = track.hardware.walled(p0, given, point.omega)
    if walled is None:
        return None
    turn: GasTurn = walled.turn(path.z, np.full(phi.size, point.period / phi.size), point.omega)
    return turn


def real(machine: Running, given: HingeLosses, fill: float = 1.0) -> Real:
    """Friction, and a gas with heat in place of the polytrope, over the angle; `fill` [-] by the pressures."""
    point, taken = machine.point, dict.fromkeys(KINDS, 0.0)
    phi = fine_path(machine.tracks[0], point.period)[0]
    extra = np.zeros(phi.size)
    for track, p0 in zip(machine.tracks, machine.pressures, strict=True):
        path, gas = fine_path(track, point.period)[1], gas_turn(track, fill * p0, point, given)
        ideal, spring = track.hardware.charged(p0).force(path.z), track.hardware.charged(fill * p0)
        force = spring.force(path.z) if gas is None else spring.area * gas.pressure
        rubbed = friction(track, path, force, point.omega, given)
        extra = extra - (force - ideal) * track.z.derivative()(phi) - sum(rubbed.values())
        for kind, torque in rubbed.items():
            taken[kind] += float(np.mean(torque))
        taken["gas"] += 0.0 if gas is None else max(0.0, gas.loss / point.period)
    lost = LossTorques(**taken)
    left = dataclasses.replace(machine.load, torque=point.load_torque - lost.total)
    return Real(machine=dataclasses.replace(machine, extra=_periodic(phi, extra, point.period), load=left), taken=lost)


def machine_at(design: CoDesign, k: int, flywheel: float | None = None) -> Running:
    """A point of a design ready to turn, with friction and heat where its programme had them; flywheel [kg*m^2]."""
    machine = running.running(
        design.task.points[k], design.tracks, k, design.flywheel if flywheel is None else flywheel
    )
    return machine if design.task.losses is None else real(machine, design.task.losses).machine


def losses(design: CoDesign, given: HingeLosses) -> tuple[LossTorques, ...]:
    """All guides together, at each point: of the polytropic spring, or as the programme had them."""
    if design.task.losses is None:
        return tuple(_beside(design, k, point, given) for k, point in enumerate(design.task.points))
    machines = [running.running(p, design.tracks, k, design.flywheel) for k, p in enumerate(design.task.points)]
    return tuple(real(machine, design.task.losses).taken for machine in machines)


def _beside(design: CoDesign, k: int, point: Point, given: HingeLosses) -> LossTorques:
    taken = dict.fromkeys(KINDS, 0.0)
    for track in design.tracks:
        path = fine_path(track, point.period)[1]
        force = track.hardware.charged(float(track.p0[k])).force(path.z)
        for kind, torque in friction(track, path, force, point.omega, given).items():
            taken[kind] += float(np.mean(torque))
        gas = gas_turn(track, float(track.p0[k]), point, given)
        taken["gas"] += 0.0 if gas is None else max(0.0, gas.loss / point.period)
    return LossTorques(**taken)


def _periodic(phi: np.ndarray, values: np.ndarray, period: float) -> PPoly:
    return PPoly.spline(np.append(phi, period), np.append(values, values[0]), periodic=True)


_TURNS, _PER_TURN = 2, 1440


@record
class Lossy:
    """A point with friction and heat, its load lowered by what they take."""

    ripple: float | None = quantity("-", about="over the angle; None where there is no steady motion")
    time_ripple: float | None = quantity("-", about="run in time; None where there is no steady motion or a stall")
    energy_residual: float | None = quantity("-", about="of that run")
    fill: float = quantity("-", about="fill of the springs by that of the schedule, for the least ripple")


def with_losses(design: CoDesign, k: int, given: HingeLosses) -> Lossy:
    """A point with friction and heat; the fill is set anew unless the programme had them in it."""
    inside, point = design.task.losses, design.task.points[k]
    machine = running.running(point, design.tracks, k, design.flywheel)
    assumed = inside or given
    if real(machine, assumed).taken.total >= abs(point.load_torque):  # the hinge takes more than the machine gives
        return Lossy(ripple=None, time_ripple=None, energy_residual=None, fill=1.0)

    def ripple(fill: float) -> float | None:
        return running.steady(real(machine, assumed, fill).machine).speed_ripple

    fill = 1.0 if inside else least_ripple(ripple, *FILLS)[0]
    lossy = real(machine, assumed, fill).machine
    motion = running.steady(lossy)
    if motion.speed_ripple is None:
        return Lossy(ripple=None, time_ripple=None, energy_residual=None, fill=fill)
    filled = dataclasses.replace(lossy, pressures=tuple(fill * p for p in machine.pressures))
    run = in_time(filled, assumed, float(motion.omega[0]), _TURNS)
    return Lossy(ripple=motion.speed_ripple, time_ripple=ripple_of_last_turn(run, point.period),
                 energy_residual=run.energy_residual, fill=fill)  # fmt: skip


def in_time(machine: Running, given: HingeLosses, speed: RadPerSecond, periods: int) -> TimeRun:
    """Run a machine of `real` from dead centre for some periods, each gas a state. speed: at the start."""
    point = machine.point
    gases = [t.hardware.walled(p, given, point.omega) for t, p in zip(machine.tracks, machine.pressures, strict=True)]
    turns = [gas_turn(t, p, point, given) for t, p in zip(machine.tracks, machine.pressures, strict=True)]
    starts = [1.0 if turn is None else turn.warmth[0] for turn in turns]
    springs = [gas or t.hardware.charged(p) for t, gas, p in zip(machine.tracks, gases, machine.pressures, strict=True)]
    end = periods * point.period
    turning = running.Turning(
        rates=_rates(machine, springs, gases, given), kinks=running.bends(machine), period=point.period,
        tables=running.tables_of(dataclasses.replace(machine, extra=None)), start=(0.0, speed, 0.0, 0.0, *starts),
        turned=end, stalled=0.0, longest=5 * end / speed,
    )  # fmt: skip
    t_end, states, stalled = running.turn(turning)
    t = np.linspace(0, t_end, round(_PER_TURN * end / (2 * np.pi)) + 1)
    phi, omega, gained, lost, *T = states(t)
    ends = np.array([phi[0], phi[-1]])
    kinetic = np.diff(running.inertia(machine, ends) * np.array([omega[0], omega[-1]]) ** 2 / 2)[0]
    stored = sum(float(np.diff(spring.energy(t.z(ends), warm[[0, -1]]))[0])
                 for t, spring, warm in zip(machine.tracks, springs, T, strict=True))  # fmt: skip
    residual = float((gained[-1] - lost[-1] - kinetic - stored) / (abs(lost[-1]) or 1.0))
    return TimeRun(
        t=t, phi=phi, omega=omega, stalled=stalled, energy_residual=residual,
        dense=lambda times: (states(times)[:1], states(times)[1:2]),
    )  # fmt: skip


def _rates(
    machine: Running, springs: Sequence[Spring], gases: Sequence[AirThermal | None], given: HingeLosses
) -> ca.Function:
    """Rates of angle, speed, work of the engine, work of load, friction and heat, and of each T / T_w."""
    y, p = ca.SX.sym("y", 4 + len(springs)), ca.SX.sym("p", 4 + 3 * len(springs))
    omega, (driving, _, total, rise, *closings) = y[1], ca.vertsplit(p)
    total, push, away, warming = total + machine.flywheel, ca.SX(0), ca.SX(0), []
    for i, (track, spring, gas) in enumerate(zip(machine.tracks, springs, gases, strict=True)):
        (z, dz, d2z), warm, h = closings[3 * i : 3 * i + 3], y[4 + i], track.hardware
        path: Path = path_of(h, h.rho0, z, dz, d2z)
        mass, across, along = h.count * (h.moving_mass + h.roller_inertia / h.radius**2), path.rho, -dz / h.count
        across = h.shaft_ratio * across
        total += mass * (across**2 + along**2)
        rise += 2 * mass * (across * h.shaft_ratio * along - along * d2z / h.count)
        force = spring.force(z, warm)
        rubbed = sum(friction(track, path, force, omega, given).values())
        push += -force * dz - rubbed
        away += rubbed * omega + (0.0 if gas is None else gas.heat(warm))
        warming.append(ca.SX(0.0 if gas is None else gas.warming(warm, z, -dz * omega)))
    taken = load_torque(machine.load, omega)
    rate = (driving + push - taken - rise * omega**2 / 2) / total
    rates = ca.vertcat(omega, rate, driving * omega, taken * omega + away, *warming)
    return ca.Function("lossy", [ca.SX.sym("t"), y, p], [rates])
