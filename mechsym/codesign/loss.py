"""What friction and heat take from a co-designed hinge at each of its points."""

import dataclasses
from typing import Any

import numpy as np
import scipy

from mechsym.codesign import running
from mechsym.codesign.contact_block import Path, contact_force, fine_path
from mechsym.codesign.hardware import gas_pressure, outside
from mechsym.codesign.points import Point
from mechsym.codesign.running import Running
from mechsym.codesign.task import CoDesign, Track
from mechsym.hinge import losses as law
from mechsym.hinge.losses import HingeLosses, LossTorques
from mechsym.hinge.thermal import AirThermal, GasTurn, turn, x_of_index
from mechsym.quantities import record

KINDS = ("bearing", "seal", "guide", "rolling", "gas")


@record
class Real:
    """A machine with friction and heat in its torque, its load lowered by what they take."""

    machine: Running
    taken: LossTorques


def friction(track: Track, path: Path, force: Any, omega: float, given: HingeLosses) -> dict[str, Any]:
    """Torques on the crank that bearings, seals and guides take, arrays or numbers as the force is [N*m].

    Parameters
    ----------
    force : ndarray, shape (n,), or float
        Of the spring on each roller [N]
    omega : float
        Speed of the crank [rad/s]
    """
    h = track.hardware
    speed = h.shaft_ratio * omega
    N = contact_force(path, force, h.moving_mass, speed)
    side = law.side_force(force, path.rho, path.drho, path.d2rho, h.moving_mass, speed)
    r_b = given.bearing_radius or h.radius / 2
    bearing = law.bearing_torque(N, path.rho, path.drho, given.bearing_mu, r_b, h.radius, h.count)
    return {
        "bearing": h.shaft_ratio * bearing,
        "seal": h.shaft_ratio * law.seal_torque(force, path.drho, given.seal_mu, h.count),
        "guide": h.shaft_ratio * law.guide_torque(side, path.drho, given.guide_mu, h.count),
    }


def spring_with_heat(track: Track, p0: float, omega: float, given: HingeLosses) -> AirThermal:
    """The spring of a guide, filled to p0 [Pa], with a wall that exchanges heat at the speed omega [rad/s].

    Without a time of its own the exchange is what would show the index of the spring at this speed.
    """
    h = track.hardware
    return AirThermal(
        A=h.A, H=h.H, p0=p0, pa=outside(h), tau=relaxation_time(h.n, omega, given), gamma=given.gamma,
        wall_temperature=given.wall_temperature,
    )  # fmt: skip


def gas_turn(track: Track, p0: float, point: Point, given: HingeLosses) -> GasTurn:
    """The gas of one spring, filled to p0 [Pa], over a period."""
    phi, path = fine_path(track, point.period)
    return turn(spring_with_heat(track, p0, point.omega, given), path.z, np.full(phi.size, point.period / phi.size),
                point.omega)  # fmt: skip


def relaxation_time(n: float, omega: float, given: HingeLosses) -> float:
    """Time [s] of the gas to take the wall's temperature: given, or such that the index n [-] shows at omega [rad/s].

    An index at gamma or above leaves no exchange, one at 1 a very fast one.
    """
    if given.tau > 0:
        return given.tau
    inside = min(max(n, 1 + 1e-6), given.gamma - 1e-6)
    return x_of_index(inside, given.gamma) / omega


def real(machine: Running, given: HingeLosses, fill: float = 1.0) -> Real:
    """Friction, and a gas with heat in place of the polytrope, over the angle; `fill` [-] by the pressures."""
    point, taken = machine.point, dict.fromkeys(KINDS, 0.0)
    phi = fine_path(machine.tracks[0], point.period)[0]
    extra = np.zeros(phi.size)
    for track, p0 in zip(machine.tracks, machine.pressures, strict=True):
        h, path = track.hardware, fine_path(track, point.period)[1]
        gas = gas_turn(track, fill * p0, point, given)
        rubbed = friction(track, path, h.A * gas.pressure, point.omega, given)
        ideal = gas_pressure(path.z, p0, h.H, h.n, outside(h))
        extra = extra - h.A * (gas.pressure - ideal) * track.z.derivative()(phi) - sum(rubbed.values())
        for kind, torque in rubbed.items():
            taken[kind] += float(np.mean(torque))
        taken["gas"] += max(0.0, gas.loss / point.period)
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
        h, path = track.hardware, fine_path(track, point.period)[1]
        force = h.A * gas_pressure(path.z, track.p0[k], h.H, h.n, outside(h))
        for kind, torque in friction(track, path, force, point.omega, given).items():
            taken[kind] += float(np.mean(torque))
        taken["gas"] += max(0.0, gas_turn(track, float(track.p0[k]), point, given).loss / point.period)
    return LossTorques(**taken)


def _periodic(phi: np.ndarray, values: np.ndarray, period: float) -> "scipy.interpolate.PPoly":
    spline = scipy.interpolate.CubicSpline(np.append(phi, period), np.append(values, values[0]), bc_type="periodic")
    return scipy.interpolate.PPoly(spline.c, spline.x, extrapolate="periodic")
