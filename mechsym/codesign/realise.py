r"""The same works from other hardware: piston, column, pressure, rollers chosen for least loss, force or size.

.. math:: U(z) = S(\varphi) - \min S + U(z_0), \qquad z' = \frac{S'}{F}, \qquad z'' = \frac{S'' - F_z z'^2}{F}

S is the energy that the spring of a co-design stores at the point that asks most. The ripple depends on S and hardly on
how A, H and p0 share it (with the gauge law and rollers without mass not at all), so the hardware can be chosen behind.
"""

import dataclasses
from collections.abc import Callable

import numpy as np
import scipy

from mechsym.codesign.task import CoDesign, Hardware, Track, limit_rows, path_of
from mechsym.errors import BadInput, suggest
from mechsym.hinge.choices import ROOM, Station
from mechsym.hinge.guide import setting_of
from mechsym.hinge.rollers import HingeLosses, bearing_torque
from mechsym.hinge.springs.face import affine_energy
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.results import part, quantity, result
from mechsym.quantities.units import Scalar

#: values of the hardware that `realise` chooses, as far as it has them; p0 is the setting of any spring
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


def _bearing_loss(at: Station) -> float:
    radius, given = at.rollers.radius, HingeLosses()
    torque = bearing_torque(at.reaction, at.rho, at.drho, given.bearing_mu, given.bearing_at(radius), radius, at.count)
    return float(np.mean(torque))


#: what can be made small, in the units of `GOAL_UNITS`
GOALS: dict[str, Callable[[Station], float]] = {
    "bearing_loss": _bearing_loss,
    "roller_reaction": lambda at: float(at.reaction.max()),
    "gas_volume": lambda at: at.spring.area * at.spring.H,
    "spring_pressure": lambda at: float(at.pressure.max()),
}
GOAL_UNITS = {"bearing_loss": "N*m", "roller_reaction": "N", "gas_volume": "m^3", "spring_pressure": "Pa"}


@result
class RealisedGuide:
    """Hardware of one guide that was chosen anew."""

    A: float | None = quantity("m^2")  #: Piston area of its spring; None without gas
    H: float = quantity("m")  #: Free height of the gas column
    p0: float = quantity("Pa")  #: Largest pressure
    rho0: float = quantity("m")  #: Roller centre to shaft axis at free height
    radius: float = quantity("m")  #: Of a roller
    width: float = quantity("m")  #: Of contact


def chosen(hardware: Hardware) -> RealisedGuide:
    """The hardware that was chosen."""
    values: dict[str, Scalar] = {"A": None, **hardware.values(*CHOSEN), "p0": setting_of(hardware.spring)}
    return RealisedGuide(**values)


@result
class RealisedNumbers:
    """Other hardware for the same works."""

    goal: str = part()  #: What was made small
    status: str = part()
    before: tuple[float, ...] = quantity("@unit")  #: Goal of each guide as designed
    after: tuple[float, ...] = quantity("@unit")  #: Goal of each guide as realised
    p0: tuple[tuple[float, ...], ...] = quantity("Pa")  #: Pressures of each spring at each point
    guides: tuple[RealisedGuide, ...] = part()

    @property
    def unit(self) -> str:
        """Of the goal."""
        return GOAL_UNITS[self.goal]


def check_goal(goal: str) -> str:
    """The goal, refused where it is not one of `GOALS`."""
    if goal not in GOALS:
        raise BadInput(f"goal = {goal!r} is not an option; {suggest(goal, GOALS)}")
    return goal


def realise(design: CoDesign, goal: str = "bearing_loss") -> Realised:
    """Hardware with the smallest goal that gives the same works within all limits; `goal` is one of `GOALS`."""
    check_goal(goal)
    if not design.task.hardware.spring.gas and goal in ("gas_volume", "spring_pressure"):
        raise BadInput(f"goal = {goal!r} asks for gas, and there is none in the spring; take bearing_loss")
    omega = max(p.omega for p in design.task.points)
    rows = [_one(design, track, goal, omega) for track in design.tracks]
    failed = [words for words, *_ in rows if words != "optimal"]
    return Realised(
        status=failed[0] if failed else "optimal",
        design=dataclasses.replace(design, tracks=tuple(m[1] for m in rows)),
        before=tuple(m[2] for m in rows),
        after=tuple(m[3] for m in rows),
    )


def _one(design: CoDesign, track: Track, goal: str, omega: float) -> tuple[str, Track, float, float]:
    h, top, period = track.hardware, int(np.argmax(track.p0)), design.task.points[0].period
    phi = np.arange(_FINE) * period / _FINE
    # energy above its least [J] and its derivatives by the crank angle [J/rad, J/rad^2]
    spring, z = track.hardware.charged(float(track.p0[top])), track.z(phi)
    dz, d2z = track.z.derivative()(phi), track.z.derivative(2)(phi)
    U, F = spring.energy(z), spring.force(z)
    stored = U - U.min(), F * dz, spring.stiffness(z) * dz**2 + F * d2z

    def at(x: np.ndarray) -> tuple[Hardware, Station]:
        p0 = float(track.p0[top])
        names = {
            h.spring.setting[0] if name == "p0" else name: float(np.exp(f))
            for name, f in zip(CHOSEN, x[:-1], strict=True)
        }
        values = {**h.values(*names), h.spring.setting[0]: p0}
        new = h.changed({name: value * names[name] for name, value in values.items()})
        least = float(np.exp(x[-1])) * max(h.z_margin, 1e-3 * h.spring.H)
        path = path_of(new, new.rho0, *_closing(new, stored, least))
        return new, new.station(path, new.spring, omega)

    def margins(x: np.ndarray) -> np.ndarray:
        return _margins(design, at(x)[1]) - _MARGIN

    start = np.zeros(len(CHOSEN) + 1)
    before = GOALS[goal](at(start)[1])
    bounds = [(-np.log(_RANGE), np.log(_RANGE))] * len(CHOSEN) + [(0.0, np.log(30.0))]
    best = scipy.optimize.minimize(lambda x: GOALS[goal](at(x)[1]) / before, start, method="SLSQP", bounds=bounds,
                    constraints={"type": "ineq", "fun": margins}, options={"maxiter": 200, "ftol": 1e-8})  # fmt: skip
    good = margins(best.x).min() > -2 * _MARGIN
    new, there = at(best.x)
    words = "optimal" if best.success and good else str(best.message).lower()
    return words, _track(track, new, there.z, phi, period), before, float(best.fun) * before


def _closing(
    h: Hardware, stored: tuple[np.ndarray, np.ndarray, np.ndarray], least: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Closing [m] and derivatives of a spring that stores what is asked beyond a least closing [m]."""
    U, dU, d2U = stored
    spring = h.spring
    grid = spring.H * (1 - np.geomspace(1, 1e-3, 4000))
    base = float(spring.energy(least))
    z = np.interp(U + base, spring.energy(grid), grid)
    for _ in range(4):
        z = np.clip(z - (spring.energy(z) - U - base) / spring.force(z), 0.0, 0.999 * spring.H)
    F = spring.force(z)
    dz = dU / F
    return z, dz, (d2U - spring.stiffness(z) * dz**2) / F


def _margins(design: CoDesign, at: Station) -> np.ndarray:
    """What is left of each limit, by the limit [-]."""
    # the least closing is chosen too, and is none of them
    rows = limit_rows(at, design.task.bounds, 0.0, design.task.widest)[1:]
    above = [high - np.max(values) for values, _, high in rows if np.isfinite(high)]
    below = [np.min(values) - low for values, low, _ in rows if np.isfinite(low)]
    room = at.rho0 - at.spring.H / 2 - at.rollers.radius
    return np.array([*above, *below, room / at.rho0 if ROOM.holds(at.spring, at.count) else 1.0])


def _track(old: Track, h: Hardware, z: np.ndarray, phi: np.ndarray, period: float) -> Track:
    """The new guide, with the pressures whose works are nearest to those of the old one."""
    curve = PPoly.spline(np.append(phi, period), np.append(z, z[0]), periodic=True)
    fixed, by_p0 = affine_energy(h.spring, z)
    wave, settings = by_p0 - by_p0.mean(), []
    for p in old.p0:
        wanted = old.hardware.charged(float(p)).energy(old.z(phi)) - fixed
        settings.append(float((wanted - wanted.mean()) @ wave / (wave @ wave)))
    return Track(hardware=h.changed({h.spring.setting[0]: max(settings)}), z=curve, p0=np.array(settings))
