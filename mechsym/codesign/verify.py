"""Is it true? Every number of a co-design found again by other ways; how sure is it, with small errors drawn?

Ripple: by the programme, by collocation over the angle (`mechsym.simulate.steady`), and by a run in time. Contact: the
limits that the programme kept at its angles and hardest point, at half a degree and at every point.
"""

import dataclasses
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from mechsym import periodic
from mechsym.codesign import running
from mechsym.codesign.loss import in_time, machine_at
from mechsym.codesign.points import Point, even_angles, speed
from mechsym.codesign.running import inertia_of
from mechsym.codesign.task import CoDesign, Track, fine_path
from mechsym.hinge.balance import STOPPED, or_stopped, ripple
from mechsym.hinge.choices import CENTRE, GuideLimit, Station, asked
from mechsym.hinge.rollers import side_force
from mechsym.quantities import quantity, record
from mechsym.quantities.units import Pure
from mechsym.simulate.steady import Steady

#: what may be off, and by how much at one sigma: shares, and 0.01 for the index
_ERRORS = {"load": 0.01, "moving_mass": 0.05, "flywheel": 0.01}
_SETTING, _OTHER = 0.005, 0.01  # of the setting of a spring, and of what else it is sensitive to
_SEED = 12


@record
class Spread:
    """Largest ripple of all points, under errors."""

    samples: np.ndarray  #: shape (m,), ascending [-]
    alone: dict[str, tuple[float, float]]  #: each error alone at minus and plus two sigma [-]
    errors: dict[str, float]  #: one sigma of each [-]

    @property
    def p95(self) -> float:
        """Ripple that 19 of 20 keep [-]."""
        return float(np.quantile(self.samples, 0.95))


def spread(design: CoDesign, count: int = 200, errors: dict[str, Pure] | None = None) -> Spread:
    """Ripple of a co-design whose pressures are set as designed, while the machine is a little off.

    errors: one sigma of some in place of their own; pressures are off by one share for all springs.
    """
    first, *others = design.task.hardware.spring.sensitive
    sigma = {first: _SETTING, **dict.fromkeys(others, _OTHER), **_ERRORS, **(errors or {})}
    draws = np.random.default_rng(_SEED).standard_normal((count, len(sigma)))
    seen = _Seen.of(design)
    samples = [seen.worst(dict(zip(sigma, row * list(sigma.values()), strict=True))) for row in draws]
    alone = {name: (seen.worst({name: -2 * s}), seen.worst({name: 2 * s})) for name, s in sigma.items()}
    return Spread(samples=np.sort(samples), alone=alone, errors=sigma)


def worst(design: CoDesign, off: dict[str, float]) -> float:
    """Largest ripple of all points with errors by name [-]; 2 where the shaft stops."""
    return _Seen.of(design).worst(off)


@record
class _Seen:
    """A co-design at even angles: what no error of it changes is asked for once."""

    design: CoDesign
    left: tuple[Point, ...]  #: the points, with the load that friction and heat leave
    work: np.ndarray  #: wanted by all but the engine's masses, shape (k, n) [J]
    lost: np.ndarray  #: by friction and heat beside their mean, shape (k, n) [J]
    inertia: np.ndarray  #: of the engine, shape (k, n) [kg*m^2]
    closed: tuple[tuple[np.ndarray, np.ndarray], ...]  #: of each guide z and its slope, shape (n,) each [m, m/rad]

    @classmethod
    def of(cls, design: CoDesign) -> "_Seen":
        points, work, lost, left = design.task.points, [], [], []
        phi = even_angles(points[0])
        for k, point in enumerate(points):
            # of friction and heat, where the programme had them
            extra = machine_at(design, k).extra
            taken = 0.0 if extra is None else -periodic.mean(extra)
            lost.append(0.0 * phi if extra is None else extra.antiderivative()(phi) + taken * phi)
            work.append(point.work(phi) - point.omega**2 / 2 * point.inertia(phi))
            left.append(dataclasses.replace(point, load_torque=point.load_torque - taken))
        return cls(
            design=design, left=tuple(left), work=np.array(work), lost=np.array(lost),
            inertia=np.array([p.inertia(phi) for p in points]),
            closed=tuple((t.z(phi), t.z.derivative()(phi)) for t in design.tracks),
        )  # fmt: skip

    def worst(self, off: dict[str, float]) -> float:
        """Largest ripple of all points with errors by name [-]; 2 where the shaft stops."""
        tracks = [_changed(track, off) for track in self.design.tracks]
        rollers = sum(inertia_of(t.hardware, *at) for t, at in zip(tracks, self.closed, strict=True))
        flywheel, largest = self.design.flywheel * (1 + off.get("flywheel", 0.0)), 0.0
        for k, point in enumerate(self.left):
            # more load is more work of the gas, not of the engine's masses
            gas = self.work[k] * (1 + off.get("load", 0.0)) - self.lost[k]
            missing = gas + point.omega**2 / 2 * (self.inertia[k] + rollers)
            for track, (z, _) in zip(tracks, self.closed, strict=True):
                p0 = float(track.p0[k]) * (1 + off.get(track.hardware.spring.setting[0], 0.0))
                missing = missing + track.hardware.charged(p0).energy(z)
            motion = speed(point, missing - missing.mean(), self.inertia[k] + flywheel + rollers)
            largest = max(largest, or_stopped(ripple(motion)))
        return largest


def _changed(track: Track, off: dict[str, float]) -> Track:
    """A guide with other numbers of its spring, an index by what it is off, any other by its share; and other mass."""
    h, changed = track.hardware, {"moving_mass": track.hardware.moving_mass * (1 + off.get("moving_mass", 0.0))}
    for field in (f for f in dataclasses.fields(h.spring) if f.name in off and f.name != h.spring.setting[0]):
        value = getattr(h.spring, field.name)
        changed[field.name] = value + off[field.name] * (1.0 if field.metadata["unit"] == "-" else value)
    return dataclasses.replace(track, hardware=h.changed(changed))


PERIODS = 2  # of each run in time; it starts in the steady motion
_SLACK = 5e-3  # a limit between the angles of the programme may be passed by this share


@record
class GuideLoads:
    """What one guide asks of its rollers at each point, arrays of shape (k,)."""

    reaction_max: np.ndarray  #: [N]
    reaction_min: np.ndarray  #: a roller leaves its track where this is not positive [N]
    pressure_max: np.ndarray | None  #: excess pressure in the spring [Pa]; None without gas
    hertz_max: np.ndarray  #: [Pa]
    side_force_max: np.ndarray  #: of a piston on its guide [N]
    pressure_angle_max: float = quantity("rad")
    curvature_min: float = quantity("1/m", about="negative where the path bends inwards")
    z_min: float = quantity("m")
    z_max: float = quantity("m")
    rho_min: float = quantity("m")
    rho_max: float = quantity("m")


@record
class Verified:
    """The ripple of each point by three ways, arrays of shape (k,), and what the contact asks."""

    steady: tuple[Steady, ...]  #: motions, or why there is none
    programme_ripple: np.ndarray  #: [-]
    steady_ripple: np.ndarray  #: nan where there is no steady motion [-]
    time_ripple: np.ndarray  #: nan after a stall [-]
    energy_residual: np.ndarray  #: of the runs in time [-]
    contacts: tuple[GuideLoads, ...]  #: one for each guide
    broken: tuple[str, ...]  #: limits that are passed, in words
    used: Mapping[str, float]  #: share of each limit that is used; negative where a path never bends inwards [-]

    @property
    def difference(self) -> float:
        """Largest difference of the three ripples, by the largest ripple [-]."""
        three = np.array([self.programme_ripple, self.steady_ripple, self.time_ripple])
        three = np.nan_to_num(three, nan=STOPPED)
        return float(np.max(np.ptp(three, axis=0)) / max(float(np.max(three)), 1e-12))


def verify(design: CoDesign) -> Verified:
    """Run a co-design as built at all its points: ripples and residuals [-], contact, limits that are passed."""
    steady, time_ripple, residual = [], [], []
    for k, point in enumerate(design.task.points):
        machine = machine_at(design, k)
        motion = running.steady(machine)
        steady.append(motion)
        if motion.speed_mean is None:
            time_ripple.append(np.nan)
            residual.append(np.nan)
            continue
        start, inside = float(motion.omega[0]), design.task.losses
        run = (
            in_time(machine, inside, start, PERIODS)
            if inside
            else running.run(machine, start, PERIODS * point.period / (2 * np.pi))
        )
        ripple = running.ripple_of_last_turn(run, point.period)
        time_ripple.append(np.nan if ripple is None else ripple)
        residual.append(run.energy_residual)
    contacts = tuple(contact(track, design.task.points) for track in design.tracks)
    return Verified(
        steady=tuple(steady),
        programme_ripple=design.ripple,
        steady_ripple=np.array([np.nan if s.speed_ripple is None else s.speed_ripple for s in steady]),
        time_ripple=np.array(time_ripple),
        energy_residual=np.array(residual),
        contacts=contacts,
        broken=tuple(words for c, t in zip(contacts, design.tracks, strict=True) for words in _broken(c, t, design)),
        used=used(design),
    )


def contact(track: Track, points: Sequence[Point]) -> GuideLoads:
    """What a guide asks of its rollers at each point."""
    stations = _stations(track, points)
    at, N = stations[0], [s.reaction for s in stations]
    side = [side_force(s.force, s.rho, s.drho, s.d2rho, track.hardware.moving_mass, s.omega) for s in stations]
    return GuideLoads(
        reaction_max=np.array([n.max() for n in N]),
        reaction_min=np.array([n.min() for n in N]),
        pressure_max=None if at.pressure is None else np.array([s.pressure.max() for s in stations]),
        hertz_max=np.array([s.hertz_stress.max() for s in stations]),
        side_force_max=np.array([np.abs(s).max() for s in side]),
        pressure_angle_max=float(np.abs(at.pressure_angle).max()),
        curvature_min=float(at.curvature.min()),
        z_min=float(at.z.min()), z_max=float(at.z.max()),
        rho_min=float(at.rho.min()), rho_max=float(at.rho.max()),
    )  # fmt: skip


def _stations(track: Track, points: Sequence[Point]) -> list[Station]:
    """A guide at fine angles, at each point."""
    h, path = track.hardware, fine_path(track, points[0].period)[1]
    return [h.station(path, h.charged(float(p0)), q.omega) for p0, q in zip(track.p0, points, strict=True)]


def passed(design: CoDesign) -> dict[str, float]:
    """Limits that a design passes between the angles of its programme or at its easier points, by what share [-]."""
    return {key: share - 1 for key, share in used(design).items() if share > 1 + _SLACK}


def used(design: CoDesign) -> dict[str, float]:
    """Share of each limit that the guide uses which uses most of it [-]."""
    shares: dict[str, float] = {}
    for track in design.tracks:
        for key, _, setting, share, _ in _asked(track, design):
            # the contact pressure of an undercut profile is said by the undercut
            if setting is not None and np.isfinite(share):
                shares[key] = max(shares.get(key, -np.inf), share)
    return shares


def _asked(track: Track, design: CoDesign) -> Iterator[tuple[str, GuideLimit, float, float, Station]]:
    """Key, limit, setting, the largest share that is used [-] and the point where it is."""
    stations = _stations(track, design.task.points)
    for key, limit, setting in asked(design.task.bounds, CENTRE):
        if limit.holds(track.hardware.spring, track.hardware.count):
            tops = [float(np.max(limit.share(at, setting))) for at in stations]
            most = int(np.argmax(tops))
            yield key, limit, setting, tops[most], stations[most]


def _broken(c: GuideLoads, track: Track, design: CoDesign) -> list[str]:
    h, words, reach = track.hardware, [], c.rho_max + track.hardware.radius
    for _, limit, setting, share, at in _asked(track, design):
        if share > 1 + _SLACK:
            most = float(np.min(limit.most(at, setting)))
            words.append(limit.told(share * most, most, setting, at))
    if reach > (1 + _SLACK) * design.task.widest:
        words.append(f"radius that the rollers reach {1e3 * reach:.4g} of at most {1e3 * design.task.widest:.4g} mm")
    if c.reaction_min.min() <= 0:
        words.append(f"a roller leaves its track (contact force {c.reaction_min.min() / 1e3:.4g} kN)")
    if c.z_min < h.z_margin - _SLACK * h.spring.H:
        words.append(f"smallest closing {c.z_min * 1e3:.4g} mm, at least {h.z_margin * 1e3:.4g} mm")
    return words
