"""What friction and heat take from a co-designed hinge at each of its points."""

import dataclasses

import numpy as np
import scipy

from mechsym.codesign import running
from mechsym.codesign.contact_block import Path, fine_path
from mechsym.codesign.points import Point
from mechsym.codesign.running import Running
from mechsym.codesign.task import CoDesign, Track
from mechsym.hinge import losses as law
from mechsym.hinge.losses import HingeLosses, LossTorques
from mechsym.hinge.rollers import contact_force
from mechsym.hinge.setting import with_setting
from mechsym.hinge.springs.air_thermal import AirThermal
from mechsym.hinge.springs.face import GasTurn
from mechsym.quantities import record
from mechsym.quantities.units import Newton, RadPerSecond, Scalar

KINDS = ("bearing", "seal", "guide", "rolling", "gas")


@record
class Real:
    """A machine with friction and heat in its torque, its load lowered by what they take."""

    machine: Running
    taken: LossTorques


def friction(
    track: Track, path: Path, force: Newton[Scalar], omega: RadPerSecond, given: HingeLosses
) -> dict[str, Scalar]:
    """Torques on the crank that bearings, seals and guides take, arrays or numbers as the force is [N*m].

    force: of the spring on each roller.
    """
    h = track.hardware
    speed = h.shaft_ratio * omega
    N = contact_force(force, path.rho, path.drho, path.d2rho, h.moving_mass, speed)
    side = law.side_force(force, path.rho, path.drho, path.d2rho, h.moving_mass, speed)
    r_b = given.bearing_radius or h.radius / 2
    bearing = law.bearing_torque(N, path.rho, path.drho, given.bearing_mu, r_b, h.radius, h.count)
    return {
        "bearing": h.shaft_ratio * bearing,
        "seal": h.shaft_ratio * law.seal_torque(force, path.drho, given.seal_mu, h.count),
        "guide": h.shaft_ratio * law.guide_torque(side, path.drho, given.guide_mu, h.count),
    }


def spring_with_heat(track: Track, p0: float, omega: float, given: HingeLosses) -> AirThermal | None:
    """The spring of a guide, filled to p0 [Pa], with a wall at the speed omega [rad/s]; None if its law has none."""
    walled: AirThermal | None = with_setting(track.hardware.spring, p0).with_wall(given, omega)
    return walled


def gas_turn(track: Track, p0: float, point: Point, given: HingeLosses) -> GasTurn | None:
    """The gas of one spring, filled to p0 [Pa], over a period; None of a law without heat."""
    phi, path = fine_path(track, point.period)
    walled = spring_with_heat(track, p0, point.omega, given)
    if walled is None:
        return None
    return walled.turn(path.z, np.full(phi.size, point.period / phi.size), point.omega)


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


def machine_at(found: CoDesign, k: int, flywheel: float | None = None) -> Running:
    """A point of a design ready to turn, with friction and heat where its programme had them; flywheel [kg*m^2]."""
    made = running.running(found.task.points[k], found.tracks, k, found.flywheel if flywheel is None else flywheel)
    return made if found.task.losses is None else real(made, found.task.losses).machine


def losses(found: CoDesign, given: HingeLosses) -> tuple[LossTorques, ...]:
    """All guides together, at each point: of the polytropic spring, or as the programme had them."""
    if found.task.losses is None:
        return tuple(_beside(found, k, point, given) for k, point in enumerate(found.task.points))
    machines = [running.running(p, found.tracks, k, found.flywheel) for k, p in enumerate(found.task.points)]
    return tuple(real(machine, found.task.losses).taken for machine in machines)


def _beside(found: CoDesign, k: int, point: Point, given: HingeLosses) -> LossTorques:
    taken = dict.fromkeys(KINDS, 0.0)
    for track in found.tracks:
        path = fine_path(track, point.period)[1]
        force = track.hardware.charged(float(track.p0[k])).force(path.z)
        for kind, torque in friction(track, path, force, point.omega, given).items():
            taken[kind] += float(np.mean(torque))
        gas = gas_turn(track, float(track.p0[k]), point, given)
        taken["gas"] += 0.0 if gas is None else max(0.0, gas.loss / point.period)
    return LossTorques(**taken)


def _periodic(phi: np.ndarray, values: np.ndarray, period: float) -> "scipy.interpolate.PPoly":
    spline = scipy.interpolate.CubicSpline(np.append(phi, period), np.append(values, values[0]), bc_type="periodic")
    return scipy.interpolate.PPoly(spline.c, spline.x, extrapolate="periodic")
