r"""Through a pose where two motions of a linkage meet, as a parallelogram that lies flat.

.. math:: q = P(s), \qquad u = P'(s)\, \dot s, \qquad \ddot q = P'(s)\, \ddot s + P''(s)\, \dot s^2

The Jacobian of the loops has no full rank at s0, but each of the motions that meet there is smooth. Its poses on both
sides give a polynomial P of one coordinate s, and with it equations of motion that know of no singular pose. The motion
goes on in the direction in which it came.
"""

import functools
from collections.abc import Mapping

import casadi as ca
import numpy as np
import scipy
from numpy.polynomial import chebyshev

from mechsym.mechanisms import loops
from mechsym.mechanisms.record import Mechanism
from mechsym.native.runs import Level
from mechsym.periodic.roots import root
from mechsym.quantities import record

_TERMS = 16  # of the polynomial, less where it needs fewer
_NODES = 24
_REACH = (6.0, 3.0, 1.5)  # half widths that are tried, of the way to the meeting pose
_NEAR, _POINTS = 4.5, 8  # steps up to the meeting pose, which none of them meets; poses that foretell the next
_SMALL = 1e-13  # of the largest term
_FAR = 1.0  # from the meeting pose, in the coordinate [rad] or [m]


@record
class Crossing:
    """One of the motions that meet, over the coordinate that goes on best."""

    coordinate: int  #: Index of s
    start: float  #: s where it begins, in the sense of the motion [rad] or [m]
    meet: float  #: s where the motions meet [rad] or [m]
    places: np.ndarray  #: shape (n, terms): Chebyshev's coefficients over the way from `meet`, by its width [SI]

    @property
    def width(self) -> float:
        """From the start to the meeting pose, with its sign [rad] or [m]."""
        return self.meet - self.start

    @property
    def fixed(self) -> tuple[float, ...]:
        """What the equations take of it: the meeting pose, the width, and the terms of each coordinate [SI]."""
        return (self.meet, self.width, *self.places.ravel(order="F"))

    def levels(self, met: bool) -> Mapping[str, Level]:
        """Where a leg on it ends; met: whether it is beyond the meeting pose."""
        way = 1 if self.width > 0 else -1
        ends = {"back": (self.start, -way), "past": (self.meet + self.width, way)}
        ends |= {} if met else {"meet": (self.meet, way)}
        return {name: Level(state=self.coordinate, level=s, direction=d) for name, (s, d) in ends.items()}


@functools.lru_cache(maxsize=64)
def motion(n: int, coordinate: int) -> ca.Function:
    """`motion(s, fixed)`: coordinates, and their first and second derivatives by s."""
    s, fixed = ca.SX.sym("s"), ca.SX.sym("fixed", 2 + n * _TERMS)
    x, terms = (s - fixed[0]) / fixed[1], ca.reshape(fixed[2:], n, _TERMS)
    before, now = ca.SX(n, 1), ca.SX(n, 1)
    for k in range(_TERMS - 1, 0, -1):  # Clenshaw's sum
        before, now = now, terms[:, k] + 2 * x * now - before
    q = terms[:, 0] + x * now - before
    T = ca.jacobian(q, s)
    q[coordinate], T[coordinate] = s, 1
    return ca.Function("motion", [s, fixed], [q, T, ca.jacobian(T, s)])


def crossing(mechanism: Mechanism, q: np.ndarray, u: np.ndarray, held: tuple[str, ...]) -> Crossing | None:
    """The way through the singular pose that the motion is coming to; None where there is none near, or none behind.

    q, u: a closed pose, and velocities [rad or m, by time]; held: coordinates that depend on the one other.
    """
    (i,), others = loops.split(mechanism, held)
    if not u[i]:
        return None
    branch = _Branch(mechanism, i, others)
    branch.add(q)
    if not branch.advance(np.sign(u[i]) * 1e-4):
        return None
    slope = np.diff(branch.determinants)[0] / np.diff(branch.at)[0]
    way = -branch.determinants[0] / slope if slope else np.inf
    if not 0 < way * np.sign(u[i]) < _FAR:
        return None
    for reach in _REACH:
        way_through = _through(_Branch(mechanism, i, others), q, way, reach)
        if way_through is not None:
            return way_through
    return None


class _Branch:
    """Poses along one motion, each closed from where those before foretell it."""

    def __init__(self, mechanism: Mechanism, coordinate: int, others: list[int]) -> None:
        self.mechanism, self.coordinate, self.others = mechanism, coordinate, others
        self.at: list[float] = []
        self.poses: list[np.ndarray] = []
        self.determinants: list[float] = []

    def jacobian(self, q: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Gap of the loops, and their Jacobian."""
        gap, J, _ = self.mechanism.functions["constraints"].call([*q, *([0.0] * len(q))])
        return np.asarray(gap).ravel(), np.asarray(J)

    def closed(self, q: np.ndarray) -> np.ndarray | None:
        """The pose near a guess with the coordinate as it is."""
        q = q.copy()
        for _ in range(8):
            gap, J = self.jacobian(q)
            if not (np.isfinite(gap).all() and np.isfinite(J).all()):
                return None
            step = np.linalg.lstsq(J[:, self.others], gap, rcond=None)[0]
            q[self.others] -= step
            if np.abs(step).max() <= 1e-15 * max(1.0, np.abs(q).max()):
                break
        return q if np.abs(self.jacobian(q)[0]).max() <= 1e-12 * max(1.0, np.abs(q).max()) else None

    def add(self, q: np.ndarray) -> None:
        """Take a pose."""
        J = self.jacobian(q)[1]
        self.at.append(float(q[self.coordinate]))
        self.poses.append(q)
        self.determinants.append(float(np.linalg.det(J[:, self.others])))

    def foretold(self, s: float) -> np.ndarray:
        """Where the poses nearest to a value of the coordinate put that one."""
        near = np.argsort(np.abs(np.array(self.at) - s))[:_POINTS]
        if len(self.at) == 1:
            _, J = self.jacobian(self.poses[0])
            q, ds = self.poses[0].copy(), s - self.at[0]
            q[self.others] -= np.linalg.lstsq(J[:, self.others], J[:, self.coordinate] * ds, rcond=None)[0]
        else:
            at = [self.at[k] for k in near]
            q = scipy.interpolate.BarycentricInterpolator(at, [self.poses[k] for k in near])(s)
        q[self.coordinate] = s
        return q

    def advance(self, step: float) -> bool:
        """Go on by a step of the coordinate; whether the loops close there, on the same motion."""
        guess = self.foretold(self.at[-1] + step)
        q = self.closed(guess)
        if q is None or np.abs(q - guess).max() > 0.2 * np.abs(q - self.poses[-1]).max():
            return False
        self.add(q)
        return True


def _through(branch: _Branch, q: np.ndarray, way: float, reach: float) -> Crossing | None:
    """The way through by poses up to `reach` ways on both sides of the meeting pose, which is a `way` off."""
    step, count = way / _NEAR, int(np.ceil(reach * _NEAR)) + 1
    branch.add(q)
    if not all(branch.advance(step) for _ in range(int(_NEAR) + 1 + count)):
        return None
    signs = np.sign(branch.determinants)
    changes = np.flatnonzero(signs[1:] != signs[:-1])
    if len(changes) != 1:
        return None
    k = int(changes[0])
    near = range(max(k - 3, 0), k + 5)
    value = scipy.interpolate.BarycentricInterpolator(
        [branch.at[j] for j in near], [branch.determinants[j] for j in near]
    )
    meet = root(value, branch.at[k], branch.at[k + 1], xtol=1e-15)
    for turned in (branch.at, branch.poses, branch.determinants):
        turned.reverse()
    if not all(branch.advance(-step) for _ in range(max(count - int(_NEAR), 0))):
        return None
    width = reach * way
    x = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
    poses = [branch.closed(branch.foretold(meet + width * at)) for at in x]
    if any(q is None for q in poses):
        return None
    terms = chebyshev.chebfit(x, np.array(poses), _NODES - 1)
    size = np.abs(terms).max(axis=1)
    if size[_TERMS:].max() > 10 * _SMALL * size.max():
        return None
    terms[size < _SMALL * size.max()] = 0.0
    return Crossing(coordinate=branch.coordinate, start=meet - width, meet=meet, places=terms[:_TERMS].T)
