r"""The same works from other hardware: piston, column, pressure, rollers chosen for least loss, force or size.

.. math:: U(z) = S(\varphi) - \min S + U(z_0), \qquad z' = \frac{S'}{F}, \qquad z'' = \frac{S'' - F_z z'^2}{F}

S is the energy that the spring of a co-design stores at the point that asks most. The ripple depends on S and hardly on
how A, H and p0 share it (with the gauge law and rollers without mass not at all), so the hardware can be chosen behind.
"""

import dataclasses
from typing import Any

import numpy as np
import scipy

from mechsym.codesign.contact_block import Path, contact_force, curvature, path_of
from mechsym.codesign.hardware import Hardware, gas_energy, gas_pressure, outside
from mechsym.codesign.task import CoDesign, Track
from mechsym.codesign.verify import hertz
from mechsym.errors import BadInput, suggest
from mechsym.hinge.losses import HingeLosses, bearing_torque
from mechsym.quantities import record

#: values of the hardware that `realise` chooses
CHOSEN = ("A", "H", "p0", "rho0", "radius", "width")
_RANGE = 3.0  # each of them at most by this factor larger or smaller
_FINE = 720
_MARGIN = 1e-3  # that is left of each limit


@record
class Realised:
    """Other hardware for the guides of a co-design."""

    status: str  #: `optimal` or the optimiser's words
    design: CoDesign  #: with the new guides and pressures; its ripple is that of the programme no more: verify it
    before: tuple[float, ...]  #: goal of each guide as designed, see `GOAL_UNITS` [-]
    after: tuple[float, ...]  #: goal of each guide as realised [-]


def _bearing_loss(h: Hardware, path: Path, pressure: np.ndarray, N: np.ndarray) -> float:
    given = HingeLosses()
    return float(np.mean(bearing_torque(N, path.rho, path.drho, given.bearing_mu, h.radius / 2, h.radius, h.count)))


#: what can be made small, in the units of `GOAL_UNITS`
GOALS = {
    "bearing_loss": _bearing_loss,
    "roller_reaction": lambda h, path, pressure, N: float(N.max()),
    "gas_volume": lambda h, path, pressure, N: h.A * h.H,
    "spring_pressure": lambda h, path, pressure, N: float(pressure.max()),
}
GOAL_UNITS = {"bearing_loss": "N*m", "roller_reaction": "N", "gas_volume": "m^3", "spring_pressure": "Pa"}


def check_goal(goal: str) -> str:
    """The goal, refused where it is not one of `GOALS`."""
    if goal not in GOALS:
        raise BadInput(f"goal = {goal!r} is not an option; {suggest(goal, GOALS)}")
    return goal


def realise(found: CoDesign, goal: str = "bearing_loss") -> Realised:
    """Hardware with the smallest goal that gives the same works within all limits; `goal` is one of `GOALS`."""
    check_goal(goal)
    omega = max(p.omega for p in found.task.points)
    made = [_one(found, track, goal, omega) for track in found.tracks]
    failed = [words for words, *_ in made if words != "optimal"]
    return Realised(
        status=failed[0] if failed else "optimal",
        design=dataclasses.replace(found, tracks=tuple(m[1] for m in made)),
        before=tuple(m[2] for m in made), after=tuple(m[3] for m in made),
    )  # fmt: skip


def _one(found: CoDesign, track: Track, goal: str, omega: float) -> tuple[str, Track, float, float]:
    h, top, period = track.hardware, int(np.argmax(track.p0)), found.task.points[0].period
    phi = np.arange(_FINE) * period / _FINE
    stored = _stored(track, float(track.p0[top]), phi)
    speed = h.shaft_ratio * omega

    def at(x: np.ndarray) -> tuple[Hardware, Path, np.ndarray, np.ndarray]:
        new = _scaled(h, float(track.p0[top]), x)
        path = path_of(new, new.rho0, *_closing(new, stored, float(np.exp(x[-1])) * max(h.z_margin, 1e-3 * h.H)))
        pressure = gas_pressure(path.z, new.p0, new.H, new.n, outside(new))
        return new, path, pressure, contact_force(path, new.A * pressure, new.moving_mass, speed)

    def margins(x: np.ndarray) -> np.ndarray:
        return _margins(found, *at(x)) - _MARGIN

    start = np.zeros(len(CHOSEN) + 1)
    before = GOALS[goal](*at(start))
    bounds = [(-np.log(_RANGE), np.log(_RANGE))] * len(CHOSEN) + [(0.0, np.log(30.0))]
    best = scipy.optimize.minimize(lambda x: GOALS[goal](*at(x)) / before, start, method="SLSQP", bounds=bounds,
                    constraints={"type": "ineq", "fun": margins}, options={"maxiter": 200, "ftol": 1e-8})  # fmt: skip
    good = margins(best.x).min() > -2 * _MARGIN
    new, path, *_ = at(best.x)
    words = "optimal" if best.success and good else str(best.message).lower()
    return words, _track(track, new, path.z, phi, period), before, float(best.fun) * before


def _scaled(h: Hardware, p0: float, x: np.ndarray) -> Hardware:
    values: dict[str, Any] = {name: (p0 if name == "p0" else getattr(h, name)) * float(np.exp(f))
                              for name, f in zip(CHOSEN, x[:-1], strict=True)}  # fmt: skip
    return dataclasses.replace(h, **values)


def _stored(track: Track, p0: float, phi: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Energy above its least [J] and its derivatives by the crank angle [J/rad, J/rad^2]."""
    h, z = track.hardware, track.z(phi)
    dz, d2z = track.z.derivative()(phi), track.z.derivative(2)(phi)
    U = h.A * gas_energy(z, p0, h.H, h.n, outside(h))
    F, stiff = _force(h, z, p0)
    return U - U.min(), F * dz, stiff * dz**2 + F * d2z


def _force(h: Hardware, z: np.ndarray, p0: float) -> tuple[np.ndarray, np.ndarray]:
    """Force of the spring [N] and its stiffness [N/m]."""
    p, pa = gas_pressure(z, p0, h.H, h.n, outside(h)), outside(h)
    return h.A * p, h.A * h.n * (p + pa) / (h.H - z)


def _closing(
    h: Hardware, stored: tuple[np.ndarray, np.ndarray, np.ndarray], least: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Closing [m] and derivatives of a spring that stores what is asked beyond a least closing [m]."""
    U, dU, d2U = stored
    grid = h.H * (1 - np.geomspace(1, 1e-3, 4000))
    energy = h.A * gas_energy(grid, h.p0, h.H, h.n, outside(h))
    base = float(h.A * gas_energy(least, h.p0, h.H, h.n, outside(h)))
    z = np.interp(U + base, energy, grid)
    for _ in range(4):
        F, _stiff = _force(h, z, h.p0)
        z = np.clip(z - (h.A * gas_energy(z, h.p0, h.H, h.n, outside(h)) - U - base) / F, 0.0, 0.999 * h.H)
    F, stiff = _force(h, z, h.p0)
    dz = dU / F
    return z, dz, (d2U - stiff * dz**2) / F


def _margins(found: CoDesign, h: Hardware, path: Path, pressure: np.ndarray, N: np.ndarray) -> np.ndarray:
    """What is left of each limit, by the limit [-]."""
    b, kappa = found.task.bounds, curvature(path)
    room = (h.rho0 - h.H / 2 - h.radius) / h.rho0 if h.count == 2 else 1.0
    return np.array([
        1 - path.z.max() / (b.closing_share * h.H),
        1 - np.abs(path.drho / path.rho).max() / np.tan(b.pressure_angle),
        1 + kappa.min() * (h.radius + b.profile_radius),
        1 - pressure.max() / b.spring_pressure,
        1 - N.max() / b.roller_reaction,
        N.min() / b.roller_reaction,
        1 - hertz(h, N, kappa).max() / b.hertz_stress,
        1 - h.radius / path.rho.min(),
        room,
    ])  # fmt: skip


def _track(old: Track, h: Hardware, z: np.ndarray, phi: np.ndarray, period: float) -> Track:
    """The new guide, with the pressures whose works are nearest to those of the old one."""
    spline = scipy.interpolate.CubicSpline(np.append(phi, period), np.append(z, z[0]), bc_type="periodic")
    curve = scipy.interpolate.PPoly(spline.c, spline.x, extrapolate="periodic")
    pa, p0 = outside(h), []
    fixed = h.A * gas_energy(z, 0.0, h.H, h.n, pa)
    by_p0 = h.A * gas_energy(z, 1e6, h.H, h.n, pa) / 1e6 - fixed / 1e6
    given = by_p0 - by_p0.mean()
    for p in old.p0:
        o = old.hardware
        wanted = o.A * gas_energy(old.z(phi), float(p), o.H, o.n, outside(o)) - fixed
        p0.append(float((wanted - wanted.mean()) @ given / (given @ given)))
    return Track(hardware=dataclasses.replace(h, p0=max(p0)), z=curve, p0=np.array(p0))
