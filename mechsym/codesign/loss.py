"""Losses of a co-designed hinge at each of its points, and the ripple that is left with them."""

import dataclasses

import numpy as np
import scipy

from mechsym.codesign import running
from mechsym.codesign.contact_block import contact_force
from mechsym.codesign.hardware import gas_pressure, outside
from mechsym.codesign.points import Point
from mechsym.codesign.running import Running
from mechsym.codesign.task import CoDesign, Track
from mechsym.codesign.verify import fine_path
from mechsym.hinge import losses as law
from mechsym.hinge.losses import HingeLosses, LossTorques
from mechsym.hinge.thermal import AirThermal, GasTurn, turn, x_of_index
from mechsym.quantities import quantity, record

_KINDS = ("bearing", "seal", "guide", "rolling", "gas")
_RESET = (0.7, 1.3)  # fills that are tried, by that of the schedule
_STOPPED = 2.0


@record
class Lossy:
    """A point with friction and heat, its springs filled anew for the least ripple."""

    ripple: float | None = quantity("-", about="None where there is no steady motion")
    fill: float = quantity("-", about="fill of the springs by that of the schedule")


def friction(track: Track, k: int, point: Point, given: HingeLosses) -> dict[str, np.ndarray]:
    """Torques on the crank that bearings, seals and guides take at the k-th point, each of shape (n,) [N*m]."""
    h, path = track.hardware, fine_path(track, point.period)[1]
    force = h.A * gas_pressure(path.z, track.p0[k], h.H, h.n, outside(h))
    omega = h.shaft_ratio * point.omega
    N = contact_force(path, force, h.moving_mass, omega)
    side = law.side_force(force, path.rho, path.drho, path.d2rho, h.moving_mass, omega)
    r_b = given.bearing_radius or h.radius / 2
    bearing = law.bearing_torque(N, path.rho, path.drho, given.bearing_mu, r_b, h.radius, h.count)
    return {
        "bearing": h.shaft_ratio * bearing,
        "seal": h.shaft_ratio * law.seal_torque(force, path.drho, given.seal_mu, h.count),
        "guide": h.shaft_ratio * law.guide_torque(side, path.drho, given.guide_mu, h.count),
    }


def gas_turn(track: Track, k: int, point: Point, given: HingeLosses, fill: float = 1.0) -> GasTurn:
    """The gas of one spring at its k-th point with a wall that exchanges heat; `fill` [-] is by that of the schedule.

    Without a time of its own the exchange is what would show the index of the spring at this speed.
    """
    h, (phi, path) = track.hardware, fine_path(track, point.period)
    spring = AirThermal(
        A=h.A, H=h.H, p0=fill * float(track.p0[k]), pa=h.pa, tau=relaxation_time(h.n, point.omega, given),
        gamma=given.gamma, wall_temperature=given.wall_temperature,
    )  # fmt: skip
    return turn(spring, path.z, np.full(phi.size, point.period / phi.size), point.omega)


def relaxation_time(n: float, omega: float, given: HingeLosses) -> float:
    """Time [s] of the gas to take the wall's temperature: given, or such that the index n [-] shows at omega [rad/s].

    An index at gamma or above leaves no exchange, one at 1 a very fast one.
    """
    if given.tau > 0:
        return given.tau
    inside = min(max(n, 1 + 1e-6), given.gamma - 1e-6)
    return x_of_index(inside, given.gamma) / omega


def losses(found: CoDesign, given: HingeLosses) -> tuple[LossTorques, ...]:
    """All guides together, at each point."""
    return tuple(_at_point(found, k, point, given) for k, point in enumerate(found.task.points))


def with_losses(found: CoDesign, k: int, given: HingeLosses) -> Lossy:
    """Ripple of a point with friction and heat in its motion, the load lowered by what they take, the fill set anew."""
    point = found.task.points[k]
    machine = running.running(point, found.tracks, k, found.flywheel)
    taken = _at_point(found, k, point, given).total
    if taken >= abs(point.load_torque):  # the hinge takes more than the machine gives
        return Lossy(ripple=None, fill=1.0)
    load = dataclasses.replace(machine.load, torque=point.load_torque - taken)

    def ripple(fill: float) -> float:
        motion = running.steady(dataclasses.replace(_real(machine, found, k, given, fill), load=load))
        return _STOPPED if motion.speed_ripple is None else motion.speed_ripple

    best = scipy.optimize.minimize_scalar(ripple, bounds=_RESET, method="bounded", options={"xatol": 1e-4})
    return Lossy(ripple=None if best.fun >= _STOPPED else float(best.fun), fill=float(best.x))


def _at_point(found: CoDesign, k: int, point: Point, given: HingeLosses) -> LossTorques:
    taken = dict.fromkeys(_KINDS, 0.0)
    for track in found.tracks:
        for kind, torque in friction(track, k, point, given).items():
            taken[kind] += float(np.mean(torque))
        taken["gas"] += max(0.0, gas_turn(track, k, point, given).loss / point.period)
    return LossTorques(**taken)


def _real(machine: Running, found: CoDesign, k: int, given: HingeLosses, fill: float) -> Running:
    """The machine with the torque of friction, and of the gas with heat in place of the polytrope."""
    point, extra = machine.point, 0.0
    for track in found.tracks:
        h, (phi, path) = track.hardware, fine_path(track, point.period)
        ideal = gas_pressure(path.z, track.p0[k], h.H, h.n, outside(h))
        change = gas_turn(track, k, point, given, fill).pressure - ideal
        extra = extra - h.A * change * track.z.derivative()(phi) - sum(friction(track, k, point, given).values())

    def torque(angle: np.ndarray) -> np.ndarray:
        more = np.interp(np.asarray(angle) % point.period, phi, extra, period=point.period)
        return np.asarray(machine.torque(angle) + more)

    return dataclasses.replace(machine, torque=torque)
