"""Losses of a co-designed hinge at each of its points, and what they do to the shaft."""

import numpy as np

from mechsym.codesign.contact_block import contact_force
from mechsym.codesign.hardware import gas_pressure, outside
from mechsym.codesign.points import Point
from mechsym.codesign.task import CoDesign, Track
from mechsym.codesign.verify import fine_path
from mechsym.hinge import losses as law
from mechsym.hinge.losses import Losses, LossTorques
from mechsym.hinge.thermal import AirThermal, GasTurn, turn, x_of_index


def at_point(track: Track, k: int, point: Point, given: Losses) -> LossTorques:
    """Mean torques that one guide takes at its k-th point."""
    h, (_, path) = track.hardware, fine_path(track, point.period)
    force = h.A * gas_pressure(path.z, track.p0[k], h.H, h.n, outside(h))
    omega = h.shaft_ratio * point.omega
    N = contact_force(path, force, h.moving_mass, omega)
    side = law.side_force(force, path.rho, path.drho, path.d2rho, h.moving_mass, omega)
    r_b = given.bearing_radius or h.radius / 2
    means = [
        law.bearing_torque(N, path.rho, path.drho, given.bearing_mu, r_b, h.radius, h.count),
        law.seal_torque(force, path.drho, given.seal_mu, h.count),
        law.guide_torque(side, path.drho, given.guide_mu, h.count),
    ]
    bearing, seal, guide = (h.shaft_ratio * float(np.mean(m)) for m in means)
    gas = gas_turn(track, k, point, given).loss / point.period
    return LossTorques(bearing=bearing, seal=seal, guide=guide, rolling=0.0, gas=max(0.0, gas))


def gas_turn(track: Track, k: int, point: Point, given: Losses) -> GasTurn:
    """The gas of one spring at its k-th point with a wall that exchanges heat.

    Without a time of its own the exchange is what would show the index of the spring at this speed.
    """
    h, (phi, path) = track.hardware, fine_path(track, point.period)
    step = np.full(phi.size, point.period / phi.size)
    spring = AirThermal(
        A=h.A, H=h.H, p0=float(track.p0[k]), pa=h.pa, tau=relaxation_time(h.n, point.omega, given),
        gamma=given.gamma, wall_temperature=given.wall_temperature,
    )  # fmt: skip
    return turn(spring, path.z, step, point.omega)


def relaxation_time(n: float, omega: float, given: Losses) -> float:
    """Time [s] of the gas to take the wall's temperature: given, or such that the index n [-] shows at omega [rad/s].

    An index at gamma or above leaves no exchange, one at 1 a very fast one.
    """
    if given.tau > 0:
        return given.tau
    inside = min(max(n, 1 + 1e-6), given.gamma - 1e-6)
    return x_of_index(inside, given.gamma) / omega


def losses(found: CoDesign, given: Losses) -> tuple[LossTorques, ...]:
    """All guides together, at each point."""
    rows = []
    for k, point in enumerate(found.task.points):
        parts = [at_point(track, k, point, given) for track in found.tracks]
        rows.append(LossTorques(**{
            name: sum(getattr(p, name) for p in parts) for name in ("bearing", "seal", "guide", "rolling", "gas")
        }))  # fmt: skip
    return tuple(rows)
