r"""Poses in which a mechanism stays at rest, and whether it comes back to them.

.. math:: \ddot q(q, 0) = 0, \qquad \dot x = \begin{pmatrix} 0 & 1 \\ A & C \end{pmatrix} x

Forces are those of the end of the run. One angle is scanned half a turn both ways; other coordinates are looked for
from the start and from poses about it, those that no force feels stay at the start. The scan ends where the loops are
singular: accelerations have a pole there, which changes its sign and is no rest, and behind it more than one way goes
on. The eigenvalues of the linear motion about a pose judge it.
"""

import itertools
import math
from collections.abc import Callable, Mapping
from functools import partial

import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.mechanisms import loops
from mechsym.mechanisms.record import velocities
from mechsym.periodic.roots import root
from mechsym.quantities import record
from mechsym.quantities.results import Columns, part, quantity, result
from mechsym.simulate import constrained, equations
from mechsym.simulate.problem import Problem

_GRID = 720  # angles of half a turn
_STARTS = 60  # of the search beside the start
_STEP = 1e-5  # of a difference, of a radian or of the size of a length
_ZERO = 1e-4  # of the largest eigenvalue: one below it is of neither sign
_SINGULAR = 1e-6  # least singular value of closed loops by the largest
_SAME = 1e-6  # rad or of the size of a length: poses nearer are one


@result
class RestPose:
    """A pose at rest."""

    at: Columns = part()  #: Coordinates
    kind: str = part()  #: `stable`, `unstable` or `indifferent`
    frequencies: list[float] = quantity("rad/s")  #: Of the small oscillations about it
    growth: float = quantity("1/s")  #: Rate of the fastest departure, below 0 where it dies out
    potential_energy: float | None = quantity("J")  #: Of gravity and springs


@result
class RestPoses:
    """What `mechsym simulate --rest` tells."""

    case: str = part()
    rests: list[RestPose] = part()
    complete: bool = part()  #: Whether a whole turn was scanned; else there may be more
    singular: list[float] = quantity("rad")  #: Angles at which singular poses of the loops end the scan


@record
class _Motion:
    """Accelerations of the independent coordinates, over closed poses."""

    problem: Problem
    free: list[int]
    close: Callable[[np.ndarray, np.ndarray], np.ndarray | None]  #: independent values and a pose near: whole pose
    rates: Callable[[float, np.ndarray], np.ndarray]
    columns: int

    def condition(self, pose: np.ndarray) -> float:
        """Least singular value of the loops' rows by the largest, 0 where they are singular, 1 without loops."""
        mechanism = self.problem.mechanism
        if not mechanism.dependents:
            return 1.0
        values = mechanism.functions["constraints"].call([*pose, *np.zeros(len(pose))])
        held = [i for i in range(len(pose)) if i not in self.free]
        sizes = np.linalg.svd(loops.scaled(mechanism, np.asarray(values[1]))[:, held], compute_uv=False)
        return float(sizes[-1] / sizes[0])

    def at(self, pose: np.ndarray, speeds: np.ndarray | None = None) -> np.ndarray:
        """Accelerations of the independent coordinates at a closed pose [rad/s^2] or [m/s^2]."""
        n, y = len(pose), np.zeros(self.columns)
        y[:n] = pose
        y[[n + i for i in self.free]] = 0.0 if speeds is None else speeds
        return self.rates(self.problem.t_end, y)[[n + i for i in self.free]]


def rests(problem: Problem, case: str) -> RestPoses:
    """The poses of a problem at rest, those of one turn where its one independent coordinate is an angle.

    Raises BadInput: stops, contacts or friction hold it elsewhere too, or the loops do not close at the start.
    """
    if problem.unilateral:
        why = f"{problem.unilateral[0].name} holds it at rest in whole ranges"
        raise BadInput(f"{problem.mechanism.name}: {why}; simulate it with a damper, and see where it ends")
    motion = _motion(problem)
    units = [problem.mechanism.units.get(q, "rad") for q in problem.mechanism.coordinates]
    start, turning = np.array(constrained.start(problem)[0] if problem.mechanism.dependents else problem.q0), len(
        motion.free
    ) == 1 and units[motion.free[0]] == "rad"  # fmt: skip
    sizes = np.array([1.0 if u == "rad" else max(abs(x), 0.1) for u, x in zip(units, start, strict=True)])
    poses, ends = _round(motion, start) if turning else (_from_many(motion, start, sizes, units), [])
    judged = [_judged(motion, pose, sizes) for pose in poses if motion.condition(pose) > _SINGULAR]
    return RestPoses(case=case, rests=judged, complete=turning and not ends, singular=ends)


def _motion(problem: Problem) -> _Motion:
    mechanism = problem.mechanism
    held = tuple(mechanism.dependents)
    free, _ = loops.split(mechanism, held)
    system = constrained.system(problem, held) if held else equations.system(problem)
    names = mechanism.coordinates

    def close(values: np.ndarray, near: np.ndarray) -> np.ndarray | None:
        if not held:
            return np.array(values, dtype=float)
        given = {names[i]: float(x) for i, x in zip(free, values, strict=True)}
        return loops.close(mechanism, given, dict(zip(names, near.tolist(), strict=True)))

    rates = equations.right_side(system, equations.held(system, problem.t_end), math.inf)
    return _Motion(problem=problem, free=free, close=close, rates=rates, columns=len(system.columns))


def _way(motion: _Motion, start: np.ndarray, step: float) -> tuple[list[np.ndarray | None], list[float]]:
    """Poses over half a turn from the start, None where the loops are open; the angle of a singular pose at its end."""
    (i,) = motion.free
    way: list[np.ndarray | None] = [start]
    last = now = motion.condition(start)
    for k in range(1, _GRID + 1):
        near = next(p for p in reversed(way) if p is not None)
        pose = motion.close(np.array([start[i] + k * step]), near)
        if pose is not None:
            last, now = now, motion.condition(pose)
            if now < max(_SINGULAR, last - now):  # reached within the next step
                return way, [float(start[i] + (k + now / max(last - now, now, 1e-300)) * step)]
        way.append(pose)
    return way, []


def _round(motion: _Motion, start: np.ndarray) -> tuple[list[np.ndarray], list[float]]:
    """Where the acceleration over one angle changes its sign without a jump, half a turn both ways from the start."""
    (i,) = motion.free
    ways, ends = zip(*(_way(motion, start, side * np.pi / _GRID) for side in (-1, 1)), strict=True)
    poses = [*ways[0][:0:-1], *ways[1]]
    rows = [(p, motion.at(p)[0] if p is not None else math.nan) for p in poses]
    largest = max((abs(a) for _, a in rows if math.isfinite(a)), default=0.0)
    rest_poses = []
    for (p, a), (r, b) in itertools.pairwise(rows):
        if p is None or r is None or not a * b <= 0 or a == b == 0 or (b == 0 and r is not rows[-1][0]):
            continue
        try:
            angle = root(partial(_along, motion, near=p), p[i], r[i], xtol=1e-14)
        except ValueError:  # the loop opens in between
            continue
        pose = motion.close(np.array([angle]), p)
        if pose is not None and abs(motion.at(pose)[0]) <= 1e-6 * largest:
            rest_poses.append(pose)
    same = len(rest_poses) > 1 and abs(rest_poses[-1][i] - rest_poses[0][i] - 2 * np.pi) < _SAME
    return rest_poses[:-1] if same else rest_poses, [*ends[0], *ends[1]]


def _along(motion: _Motion, angle: float, near: np.ndarray) -> float:
    pose = motion.close(np.array([angle]), near)
    return math.nan if pose is None else float(motion.at(pose)[0])


def _from_many(motion: _Motion, start: np.ndarray, sizes: np.ndarray, units: list[str]) -> list[np.ndarray]:
    """Poses at which a search for no acceleration ends, from the start and from poses about it, each once."""
    turns, random = np.array([u == "rad" for u in units]), np.random.default_rng(0)
    starts = [start, *(start + sizes * random.uniform(-np.pi, np.pi, len(start)) for _ in range(_STARTS))]
    size = max(1.0, *(np.abs(motion.at(q)).max() for q in starts if np.isfinite(motion.at(q)).all()))
    felt = np.array([any(np.abs(_slope(motion, q, j, sizes)).max() > _ZERO * size for q in starts[:4])
                     for j in range(len(motion.free))])  # fmt: skip
    poses: list[np.ndarray] = []
    for guess in starts if felt.any() else ():
        values = start[motion.free]

        def missing(x: np.ndarray, near: np.ndarray = guess, values: np.ndarray = values) -> np.ndarray:
            values[felt] = x
            pose = motion.close(values, near)
            return np.full(len(values), 1e6) if pose is None else np.nan_to_num(motion.at(pose), nan=1e6)

        best = scipy.optimize.least_squares(missing, guess[motion.free][felt], xtol=1e-15, ftol=1e-15, gtol=1e-15)
        at_rest = np.abs(missing(best.x)).max() < 1e-8 * size
        pose = motion.close(values, guess) if at_rest else None
        if pose is None:
            continue
        pose = np.where(turns, np.mod(pose + np.pi, 2 * np.pi) - np.pi, pose)
        away = (np.abs(pose - other) for other in poses)
        if all((np.where(turns, np.minimum(d, 2 * np.pi - d), d) / sizes).max() > 1e3 * _SAME for d in away):
            poses.append(pose)
    return poses


def _slope(motion: _Motion, pose: np.ndarray, j: int, sizes: np.ndarray) -> np.ndarray:
    """Derivative of the accelerations by an independent coordinate, 0 where no force feels it."""
    step, ends = _STEP * sizes[motion.free[j]], []
    for side in (step, -step):
        moved = motion.close(pose[motion.free] + side * np.eye(len(motion.free))[j], pose)
        ends.append(motion.at(pose if moved is None else moved))
    return np.nan_to_num((ends[0] - ends[1]) / (2 * step))


def _judged(motion: _Motion, pose: np.ndarray, sizes: np.ndarray) -> RestPose:
    mechanism, free = motion.problem.mechanism, motion.free
    k = len(free)
    matrix = np.zeros((2 * k, 2 * k))
    matrix[:k, k:] = np.eye(k)
    for j, i in enumerate(free):
        step = _STEP * sizes[i] * np.eye(k)[j]
        rates = (motion.at(pose, step) - motion.at(pose, -step)) / (2 * step[j])
        matrix[k:, [j, k + j]] = np.transpose([_slope(motion, pose, j, sizes), rates])
    values = np.linalg.eigvals(matrix)
    size, growth = float(np.abs(values).max()), float(values.real.max())
    kind = "unstable" if growth > _ZERO * size else "indifferent" if np.abs(values).min() <= _ZERO * size else "stable"
    q = mechanism.coordinates
    energy = None
    if "energy" in mechanism.functions:
        letters: Mapping[str, float] = dict(zip((*q, *velocities(mechanism)), [*pose, *np.zeros(len(q))], strict=True))
        function = mechanism.functions["energy"]
        energy = float(function.call([letters[n] for n in function.name_in()])[1])
    return RestPose(
        at=Columns(dict(zip(q, pose.tolist(), strict=True)), dict(zip(q, mechanism.state_units, strict=False))),
        kind=kind, growth=growth if abs(growth) > _ZERO * size else 0.0, potential_energy=energy,
        frequencies=sorted(float(v.imag) for v in values if v.imag > _ZERO * size),
    )  # fmt: skip
