"""How sure is the ripple? Small errors of pressure, index, mass and load drawn at random, and each by itself."""

import dataclasses

import numpy as np
import scipy

from mechsym import periodic
from mechsym.codesign.loss import machine_at
from mechsym.codesign.points import Point, motion
from mechsym.codesign.running import added_inertia, spring_energy
from mechsym.codesign.task import CoDesign, Track
from mechsym.hinge.ripple import ripple
from mechsym.quantities import record
from mechsym.quantities.units import Pure

#: what may be off, and by how much at one sigma: shares, and 0.01 for the index
_ERRORS = {"load": 0.01, "moving_mass": 0.05, "flywheel": 0.01}
_SETTING, _OTHER = 0.005, 0.01  # of the setting of a spring, and of what else it is sensitive to
_SEED = 12
_STOPPED = 2.0  # ripple of a shaft that stops


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


def spread(found: CoDesign, count: int = 200, errors: dict[str, Pure] | None = None) -> Spread:
    """Ripple of a co-design whose pressures are set as designed, while the machine is a little off.

    errors: one sigma of some in place of their own; pressures are off by one share for all springs.
    """
    first, *others = found.task.hardware.spring.sensitive
    sigma = {first: _SETTING, **dict.fromkeys(others, _OTHER), **_ERRORS, **(errors or {})}
    draws = np.random.default_rng(_SEED).standard_normal((count, len(sigma)))
    lost = _lost(found)
    samples = [_worst(found, dict(zip(sigma, row * list(sigma.values()), strict=True)), lost) for row in draws]
    alone = {
        name: (_worst(found, {name: -2 * s}, lost), _worst(found, {name: 2 * s}, lost)) for name, s in sigma.items()
    }
    return Spread(samples=np.sort(samples), alone=alone, errors=sigma)


def worst(found: CoDesign, off: dict[str, float]) -> float:
    """Largest ripple of all points with errors by name [-]; 2 where the shaft stops."""
    return _worst(found, off, _lost(found))


def _worst(found: CoDesign, off: dict[str, float], lost: "list[scipy.interpolate.PPoly | None]") -> float:
    tracks = [_changed(track, off) for track in found.tracks]
    flywheel = found.flywheel * (1 + off.get("flywheel", 0.0))
    rows = [_ripple(p, tracks, k, flywheel, off, extra) for k, (p, extra) in
            enumerate(zip(found.task.points, lost, strict=True))]  # fmt: skip
    return max(_STOPPED if r is None else r for r in rows)


def _lost(found: CoDesign) -> "list[scipy.interpolate.PPoly | None]":
    """Torque of friction and heat at each point [N*m], where the programme had them."""
    return [machine_at(found, k).extra for k in range(len(found.task.points))]


def _ripple(
    point: Point,
    tracks: list[Track],
    k: int,
    flywheel: float,
    off: dict[str, float],
    extra: scipy.interpolate.PPoly | None,
) -> float | None:
    taken = 0.0 if extra is None else -periodic.mean(extra)
    gone = None if extra is None else extra.antiderivative()
    half, load = point.omega**2 / 2, 1 + off.get("load", 0.0)

    def missing(phi: np.ndarray) -> np.ndarray:
        # more load is more work of the gas, not of the engine's masses
        own = half * point.inertia(phi)
        w = own + load * (point.work(phi) - own)
        for track in tracks:
            p0 = float(track.p0[k]) * (1 + off.get(track.hardware.spring.setting[0], 0.0))
            w = w + spring_energy(track, p0, phi) + half * added_inertia(track, phi)
        if gone is not None:
            w = w - gone(phi) - taken * phi
        return np.asarray(w - w.mean())

    def total(phi: np.ndarray) -> np.ndarray:
        return np.asarray(point.inertia(phi) + flywheel + sum(added_inertia(t, phi) for t in tracks))

    left = dataclasses.replace(point, load_torque=point.load_torque - taken)
    return ripple(motion(left, missing, total)[1])


def _changed(track: Track, off: dict[str, float]) -> Track:
    """A guide with other numbers of its spring, an index by what it is off, any other by its share; and other mass."""
    h, changed = track.hardware, {"moving_mass": track.hardware.moving_mass * (1 + off.get("moving_mass", 0.0))}
    for field in (f for f in dataclasses.fields(h.spring) if f.name in off and f.name != h.spring.setting[0]):
        value = getattr(h.spring, field.name)
        changed[field.name] = value + off[field.name] * (1.0 if field.metadata["unit"] == "-" else value)
    return dataclasses.replace(track, hardware=h.changed(changed))
