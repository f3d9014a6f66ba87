"""A run that stops because a closed form has no pose beyond: the loop opens there, an event and no failure."""

from dataclasses import replace

import numpy as np

from mechsym.mechanisms.record import Mechanism
from mechsym.simulate.constrained import LOCKED
from mechsym.simulate.phase import Raw

_NEAR = np.concatenate([[0.0], np.geomspace(1e-14, 1e-3, 34)])  # how far off a pose is looked for [rad] or [m]


def ended(mechanism: Mechanism, raw: Raw) -> Raw:
    """A run as it is, or with the event `locked` where it failed at a pose beyond which a loop opens."""
    if not raw.failure or "dynamics" not in mechanism.functions or mechanism.dependents:
        return raw
    whole = np.isfinite(raw.y).all(axis=1)
    if not whole.any():
        return raw
    last, n = int(np.flatnonzero(whole)[-1]), len(mechanism.coordinates)
    if not opens(mechanism, raw.y[last, :n], raw.y[last, n : 2 * n]):
        return raw
    return replace(raw, t=raw.t[: last + 1], y=raw.y[: last + 1], end=LOCKED, failure="")


def posed(mechanism: Mechanism, raw: Raw) -> Raw:
    """A run without a last state that lies on the pose where the loop opens, where no energy is known."""
    if raw.end != LOCKED or mechanism.dependents or len(raw.t) < 2 or "energy" not in mechanism.functions:
        return raw
    n = len(mechanism.coordinates)
    energy = mechanism.functions["energy"].call(list(raw.y[-1, : 2 * n]))
    return raw if np.isfinite([float(e) for e in energy]).all() else replace(raw, t=raw.t[:-1], y=raw.y[:-1])


def opens(mechanism: Mechanism, q: np.ndarray, u: np.ndarray) -> bool:
    """Whether a loop opens at a pose or a thousandth beside it, on the way of the motion or back.

    Parameters
    ----------
    q, u : ndarray, shape (n,)
        Coordinates and velocities [rad, rad/s]
    """
    dynamics = mechanism.functions["dynamics"]
    rest = [0.0] * (dynamics.n_in() - 2 * len(q) if dynamics.n_in() >= 2 * len(q) else 0)
    way = np.where(u == 0, 1.0, np.sign(u))

    def closed(step: float) -> bool:
        return bool(np.isfinite(np.asarray(dynamics.call([*(q + step * way), *u, *rest])[0])).all())

    return not all(closed(sign * step) for step in _NEAR for sign in (1.0, -1.0))
