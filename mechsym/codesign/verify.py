"""Is it true? Every number of a co-design found again by other ways, at all points and at finer angles.

Ripple: by the programme, by collocation over the angle (`mechsym.simulate.steady`), and by a run in time. Contact: the
limits that the programme kept at its angles and hardest point, at half a degree and at every point.
"""

from collections.abc import Mapping, Sequence

import numpy as np

from mechsym.codesign import running
from mechsym.codesign.contact_block import contact_force, curvature, fine_path
from mechsym.codesign.hardware import Hardware, gas_pressure, outside
from mechsym.codesign.loss import machine_at
from mechsym.codesign.points import Point
from mechsym.codesign.real import in_time
from mechsym.codesign.task import CoDesign, Track
from mechsym.hinge.losses import side_force
from mechsym.quantities import quantity, record
from mechsym.simulate.steady import Steady

PERIODS = 2  # of each run in time; it starts in the steady motion
_STOPPED = 2.0  # ripple of a shaft that stops
_SLACK = 5e-3  # a limit between the angles of the programme may be passed by this share


@record
class GuideLoads:
    """What one guide asks of its rollers at each point, arrays of shape (k,)."""

    reaction_max: np.ndarray  #: [N]
    reaction_min: np.ndarray  #: a roller leaves its track where this is not positive [N]
    pressure_max: np.ndarray  #: excess pressure in the spring [Pa]
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
        three = np.nan_to_num(three, nan=_STOPPED)
        return float(np.max(np.ptp(three, axis=0)) / max(float(np.max(three)), 1e-12))


def verify(found: CoDesign) -> Verified:
    """Run a co-design as built at all its points.

    Returns
    -------
    verified : Verified
        Ripples and residuals [-], contact, limits that are passed
    """
    steady, time_ripple, residual = [], [], []
    for k, point in enumerate(found.task.points):
        machine = machine_at(found, k)
        motion = running.steady(machine)
        steady.append(motion)
        if motion.speed_mean is None:
            time_ripple.append(np.nan)
            residual.append(np.nan)
            continue
        start, inside = float(motion.omega[0]), found.task.losses
        run = (
            in_time(machine, inside, start, PERIODS)
            if inside
            else running.run(machine, start, PERIODS * point.period / (2 * np.pi))
        )
        ripple = running.ripple_of_last_turn(run, point.period)
        time_ripple.append(np.nan if ripple is None else ripple)
        residual.append(run.energy_residual)
    contacts = tuple(contact(track, found.task.points) for track in found.tracks)
    return Verified(
        steady=tuple(steady),
        programme_ripple=found.ripple,
        steady_ripple=np.array([np.nan if s.speed_ripple is None else s.speed_ripple for s in steady]),
        time_ripple=np.array(time_ripple),
        energy_residual=np.array(residual),
        contacts=contacts,
        broken=tuple(words for c, t in zip(contacts, found.tracks, strict=True) for words in _broken(c, t, found)),
        used=_used(contacts, found),
    )


def contact(track: Track, points: Sequence[Point]) -> GuideLoads:
    """What a guide asks of its rollers at each point."""
    h, path = track.hardware, fine_path(track, points[0].period)[1]
    kappa = curvature(path)
    pressures = [gas_pressure(path.z, p0, h.H, h.n, outside(h)) for p0 in track.p0]
    asked = [(h.A * p, h.moving_mass, h.shaft_ratio * q.omega) for p, q in zip(pressures, points, strict=True)]
    N = [contact_force(path, *a) for a in asked]
    side = [side_force(force, path.rho, path.drho, path.d2rho, mass, omega) for force, mass, omega in asked]
    return GuideLoads(
        reaction_max=np.array([n.max() for n in N]),
        reaction_min=np.array([n.min() for n in N]),
        pressure_max=np.array([p.max() for p in pressures]),
        hertz_max=np.array([hertz(h, n, kappa).max() for n in N]),
        side_force_max=np.array([np.abs(s).max() for s in side]),
        pressure_angle_max=float(np.arctan(np.abs(path.drho / path.rho).max())),
        curvature_min=float(kappa.min()),
        z_min=float(path.z.min()), z_max=float(path.z.max()),
        rho_min=float(path.rho.min()), rho_max=float(path.rho.max()),
    )  # fmt: skip


def hertz(hardware: Hardware, N: np.ndarray, kappa: np.ndarray) -> np.ndarray:
    """Contact pressure [Pa] for contact forces [N] and curvatures of the path [1/m]; see `mechsym.hinge.rollers`."""
    modulus = hardware.E / (2 * (1 - hardware.nu**2))
    relative = hardware.radius * np.maximum(1 + hardware.radius * kappa, 1e-12)
    return np.sqrt(np.maximum(N, 0.0) * modulus / (np.pi * hardware.width * relative))


def passed(found: CoDesign) -> dict[str, float]:
    """Limits that a design passes between the angles of its programme or at its easier points, by what share [-]."""
    used = _used([contact(track, found.task.points) for track in found.tracks], found)
    return {key: share - 1 for key, share in used.items() if share > 1 + _SLACK}


def _used(contacts: Sequence[GuideLoads], found: CoDesign) -> dict[str, float]:
    """Share of each limit that the guide uses which uses most of it [-]."""
    shares: dict[str, float] = {}
    for c, track in zip(contacts, found.tracks, strict=True):
        for key, _, value, most, _ in _asked(c, track, found):
            if key:
                shares[key] = max(shares.get(key, -np.inf), float(value / most))
    return shares


def _asked(c: GuideLoads, track: Track, found: CoDesign) -> list[tuple[str, str, float, float, str]]:
    """Key of a limit, words, value and limit in a unit."""
    b, h = found.task.bounds, track.hardware
    return [
        ("spring_pressure", "spring pressure", c.pressure_max.max() / 1e6, b.spring_pressure / 1e6, "MPa"),
        ("closing_share", "closing z/H", c.z_max / h.H, b.closing_share, ""),
        ("pressure_angle", "pressure angle", np.degrees(c.pressure_angle_max), np.degrees(b.pressure_angle), "deg"),
        ("roller_reaction", "roller reaction", c.reaction_max.max() / 1e3, b.roller_reaction / 1e3, "kN"),
        ("hertz_stress", "contact pressure", c.hertz_max.max() / 1e6, b.hertz_stress / 1e6, "MPa"),
        ("", "roller radius beside the path's smallest radius", 1e3 * h.radius, 1e3 * c.rho_min, "mm"),
        ("profile_radius", "bend inwards", -c.curvature_min * (h.radius + b.profile_radius), 1.0,
         "of what the roller allows"),
    ]  # fmt: skip


def _broken(c: GuideLoads, track: Track, found: CoDesign) -> list[str]:
    h = track.hardware
    words = [f"{name} {value:.4g} of at most {most:.4g} {unit}".rstrip()
             for _, name, value, most, unit in _asked(c, track, found) if value > (1 + _SLACK) * most]  # fmt: skip
    if c.reaction_min.min() <= 0:
        words.append(f"a roller leaves its track (contact force {c.reaction_min.min() / 1e3:.4g} kN)")
    if c.z_min < h.z_margin - _SLACK * h.H:
        words.append(f"smallest closing {c.z_min * 1e3:.4g} mm, at least {h.z_margin * 1e3:.4g} mm")
    return words
