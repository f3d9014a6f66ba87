r"""Blows: velocities behind an impact, by Newton's restitution at every stop that closes.

.. math:: \Delta u = M^{-1} W \Lambda,\qquad v^+ \ge -e\,v^-,\quad \Lambda \ge 0,\quad
          \Lambda\,(v^+ + e\,v^-) = 0

With friction the impulse along a face keeps it from sliding, or has \mu \Lambda against what slides behind the blow.
"""

from itertools import product

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.roles import FrictionRole
from mechsym.quantities import record
from mechsym.quantities.units import Array
from mechsym.simulate.laws import Numbers

_TOLERANCE = 1e-9


@record
class Blow:
    """What an impact does."""

    change: np.ndarray  #: Of the velocities [rad/s]
    lost: float  #: Energy [J]


def solve(elements: tuple[Numbers, ...], touching: set[int], v: Array, mass: Array, W: Array, along: Array) -> Blow:
    """The blow of stops that touch.

    v: speed along each element, below 0 where a stop closes [m/s]; mass: mass matrix [kg, kg*m^2]; W: generalised
    force by each element's own [-]; along: velocities that its impulse changes [1/kg]. Returns blow: of several that
    are hit at once the one in which each keeps its own restitution; others may be as right.

    Raises BadInput: no impulses satisfy all conditions, or friction would give energy to the bodies.
    """
    stops = sorted(touching)
    sliding = [i for i, e in enumerate(elements) if isinstance(e.role, FrictionRole) and e.contact in touching]
    G = W.T @ along
    wanted = {i: -elements[i].sizes.get("restitution", 0.0) * min(v[i], 0.0) for i in stops}
    scale = max(float(np.abs(v).max()), 1e-300)
    for states in product((True, False), repeat=len(stops)):
        pressed = {i for i, on in zip(stops, states, strict=True) if on}
        rubbed = [k for k in sliding if elements[k].contact in pressed]
        for ways in product((0, 1, -1), repeat=len(rubbed)):
            size = _impulses(elements, G, v, {i: wanted[i] for i in pressed}, dict(zip(rubbed, ways, strict=True)))
            if size is None:
                continue
            after = v + G @ size
            free = all(after[i] >= wanted[i] - _TOLERANCE * scale for i in set(stops) - pressed)
            if free and _holds(elements, size, after, pressed, dict(zip(rubbed, ways, strict=True)), scale):
                return _checked(along @ size, -float(size @ (v + after)) / 2, scale**2 * float(np.abs(mass).max()))
    names = " and ".join(elements[i].role.name for i in stops)
    raise BadInput(f"no impulses satisfy the blow on {names}; give one of them stiffness and damping")


def _impulses(
    elements: tuple[Numbers, ...], G: Array, v: Array, wanted: dict[int, float], ways: dict[int, int]
) -> Array | None:
    """Impulses for which the speeds of stops are as wanted, and friction keeps still or slides a way."""
    rows, right = np.eye(len(v)), np.zeros(len(v))
    for i, speed in wanted.items():
        rows[i], right[i] = G[i], speed - v[i]
    for k, way in ways.items():
        if way:
            rows[k, elements[k].contact] = way * elements[k].sizes["mu_k"]
        else:
            rows[k], right[k] = G[k], elements[k].sizes.get("speed", 0.0) - v[k]
    size = np.linalg.lstsq(rows, right, rcond=None)[0]
    return size if np.allclose(rows @ size, right, atol=1e-9 * max(1.0, float(np.abs(v).max()))) else None


def _holds(
    elements: tuple[Numbers, ...], size: Array, after: Array, pressed: set[int], ways: dict[int, int], scale: float
) -> bool:
    least = -_TOLERANCE * max(float(np.abs(size).max()), 1e-300)
    if any(size[i] < least for i in pressed):
        return False
    for k, way in ways.items():
        sizes, normal = elements[k].sizes, size[elements[k].contact]
        slides = after[k] - sizes.get("speed", 0.0)
        if abs(size[k]) > sizes["mu_s"] * normal - least if way == 0 else way * slides < -_TOLERANCE * scale:
            return False
    return True


def _checked(change: Array, lost: float, scale: float) -> Blow:
    if lost < -1e-9 * scale:
        raise BadInput(f"friction in a blow would give {-lost:.3g} J to the bodies; leave out its restitution")
    return Blow(change=change, lost=max(lost, 0.0))


def stay(W: Array, along: Array, u: Array) -> Array:
    """Velocities u [m/s] without those along columns of W [-], by impulses that change those `along` [1/kg]."""
    return u - along @ np.linalg.lstsq(W.T @ along, W.T @ u, rcond=None)[0]
