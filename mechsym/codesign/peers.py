r"""What else evens a shaft out at the same points: a cam with coil springs, a flywheel behind noncircular gears.

.. math:: \text{coil springs:}\; \min_S \max_k \frac{\mathrm{ptp}(W_k - S)}{\omega_k^2}, \qquad
          \text{gears:}\; \min_S \max_k \mathrm{ptp}\Bigl(\frac{W_k}{\omega_k^2} - S\Bigr), \quad I_f = C - 2 S

A coil spring stores one work S at every point, whatever the speed and the load: nobody sets it anew. A flywheel behind
noncircular gears of the ratio g'(phi) stores I_f omega^2/2, I_f = J_f g'^2: it follows the square of the speed by
itself, and the load not at all. Both shapes are the best there are, by a linear programme; the motion is exact. A cam
of coil springs without mass and gears without limits but that of their ratio: no real one does better.
"""

import dataclasses
from collections.abc import Callable, Sequence

import numpy as np
import scipy

from mechsym.codesign.front import front
from mechsym.codesign.points import Function, Point, bare_flywheel, motion, sample
from mechsym.codesign.task import CoDesignTask
from mechsym.hinge.balance import ripple
from mechsym.quantities.results import part, quantity, result
from mechsym.quantities.units import Array, Inertia

_ANGLES = 180  # of a turn
_RATIO = 3.0  # largest by smallest ratio of noncircular gears (assumed)
_STOPPED, _MOST = 10.0, 1e8


@result
class Rival:
    """Another way to keep a ripple at the same points."""

    name: str = part()
    ripple: float = quantity("-")  #: That it keeps
    flywheel_inertia: float | None = quantity("kg*m^2")  #: Added; None where it cannot keep the ripple
    about: str = part()  #: What is assumed
    swing: float | None  #: What its shape leaves of the works by the square of the speed [kg*m^2]


def peers(points: Sequence[Point], ripples: Sequence[float]) -> list[Rival]:
    """A plain flywheel, a cam with coil springs and a flywheel behind noncircular gears, for each ripple [-]."""
    phi, cam, gears = _shapes(points)
    left_cam, left_gears = _left(points, phi, cam, None), _left(points, phi, gears, 2.0)
    rows = []
    for wanted in sorted(ripples):
        rows += [
            Rival(name="plain flywheel", ripple=wanted, flywheel_inertia=bare_flywheel(points, wanted),
                 swing=_left(points, phi, 0 * cam, None), about="no hinge"),
            Rival(name="cam with coil springs", ripple=wanted, flywheel_inertia=cam_flywheel(points, phi, cam, wanted),
                 swing=left_cam, about="one preload for all points, massless, any shape, no limit of contact"),
            Rival(name="noncircular gears", ripple=wanted, flywheel_inertia=gear_flywheel(points, phi, gears, wanted),
                 swing=left_gears, about=f"ratio within {_RATIO:g} to 1 (assumed), teeth without play or loss"),
        ]  # fmt: skip
    return rows


def springs_of(task: CoDesignTask, ripples: Sequence[float], springs: int) -> list[Rival]:
    """Co-designed guides with another number of springs, for each ripple [-]; within the limits of the task."""
    designs = front(dataclasses.replace(task, springs=springs), ripples)
    words = {1: "one spring", 2: "two springs", 3: "three springs"}[springs]
    about = "co-designed within the same limits, a pressure for each point and spring"
    return [
        Rival(
            name=words,
            ripple=d.task.ripple,
            flywheel_inertia=d.flywheel if d.status == "optimal" else None,
            swing=None,
            about=about,
        )
        for d in designs
    ]


def cam_flywheel(points: Sequence[Point], phi: np.ndarray, stored: np.ndarray, wanted: float) -> float | None:
    """Flywheel [kg*m^2] beside a work [J] over angles [rad] that is the same at every point, for a ripple [-]."""

    def of(point: Point, flywheel: float) -> float:
        fixed = _at(point, phi, stored)
        return _ripple(point, lambda x: point.work(x) - fixed(x), lambda x: point.inertia(x) + flywheel)

    def worst(flywheel: float) -> float:
        return max(of(p, flywheel) for p in points)

    return _least(worst, wanted)


def gear_flywheel(points: Sequence[Point], phi: np.ndarray, shape: Inertia[Array], wanted: float) -> float | None:
    """Inertia J_f of a flywheel whose gears turn it as the square of the speed asks, for a ripple [-].

    shape: work by the square of the speed.
    """

    def reduced(more: float) -> np.ndarray:
        # I_f takes the shape away; what is more of it is a plain flywheel
        return np.asarray(2 * (shape.max() - shape) + least + more)

    # the lightest that the ratio allows
    least = 2 * float(np.ptp(shape)) / (_RATIO**2 - 1)

    def of(point: Point, more: float) -> float:
        turned, half = _at(point, phi, reduced(more)), point.omega**2 / 2
        return _ripple(point, lambda x: point.work(x) + half * turned(x), lambda x: point.inertia(x) + turned(x))

    def worst(more: float) -> float:
        return max(of(p, more) for p in points)

    more = _least(worst, wanted)
    # the flywheel turns as often as the shaft: the mean of its ratio is one
    return None if more is None else float(np.mean(np.sqrt(reduced(more)))) ** 2


def _shapes(points: Sequence[Point]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Angles [rad], the best fixed work [J] and the best work by the square of the speed [kg*m^2]."""
    samples = sample(points, round(_ANGLES * points[0].period / (2 * np.pi)))
    square = samples.omega[:, None] ** 2
    return samples.phi, _best(samples.work, square), _best(samples.work / square, np.ones_like(square))


def _best(works: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """S with the smallest max_k ptp(works_k - S) / scale_k, a linear programme."""
    sparse, (k, n) = scipy.sparse, works.shape
    size = float(np.ptp(works / scale, axis=1).max()) or 1.0
    weight = 1 / scale.ravel()
    columns = sparse.csr_matrix(weight[:, None])
    by_shape, by_low = (
        sparse.kron(columns, sparse.identity(n)),
        sparse.kron(sparse.identity(k), np.ones((n, 1))),
    )
    target = (works / scale).ravel() / size
    # low_k <= (works - S)/scale <= low_k + D, S in units of its own
    ones = sparse.csr_matrix(np.ones((k * n, 1)))
    unit = float(scale.mean())
    matrix = sparse.vstack([
        sparse.hstack([unit * by_shape, by_low, 0 * ones]),
        sparse.hstack([-unit * by_shape, -by_low, -ones]),
    ]).tocsr()  # fmt: skip
    cost = np.concatenate([np.zeros(n + k), [1.0]])
    found = scipy.optimize.linprog(
        cost, A_ub=matrix, b_ub=np.concatenate([target, -target]), bounds=(None, None), method="highs"
    )
    return np.asarray(found.x[:n]) * unit * size


def _left(points: Sequence[Point], phi: np.ndarray, shape: np.ndarray, power: float | None) -> float:
    """Largest swing [kg*m^2] that a shape leaves, which goes with the speed to a power, or not at all."""
    return max(
        float(np.ptp(p.work(phi) / p.omega**2 - shape * (1.0 if power else 1 / p.omega**2))) for p in points
    )  # fmt: skip


def _at(point: Point, phi: np.ndarray, values: np.ndarray) -> Function:
    def function(angle: np.ndarray) -> np.ndarray:
        return np.interp(np.asarray(angle) % point.period, phi, values, period=point.period)

    return function


def _ripple(point: Point, missing: Function, inertia: Function) -> float:
    def centred(phi: np.ndarray) -> np.ndarray:
        work = missing(phi)
        return np.asarray(work - work.mean())

    found = ripple(motion(point, centred, inertia)[1])
    return _STOPPED if found is None else found


def _least(worst: Callable[[float], float], wanted: float) -> float | None:
    """The smallest inertia [kg*m^2] with which `worst` is at most what is wanted [-]."""
    if worst(0.0) <= wanted:
        return 0.0
    high = 100.0
    while worst(high) > wanted:
        high *= 3
        if high > _MOST:
            return None
    return float(scipy.optimize.brentq(lambda x: worst(x) - wanted, 0.0, high, xtol=1e-6 * high))
