r"""Mechanisms with constraints: closure, accelerations, and multipliers only as far as the rank determines them.

.. math:: M \ddot q + h = Q + J^T \mu, \qquad J \ddot q + \gamma = 0

Where J lacks rank, the accelerations are still unique but the multipliers (joint forces) are not: mu plus any vector
of the null space of J^T balances the bodies as well. A least-squares solver hides that; here it is reported.
"""

from collections.abc import Mapping

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms import loops
from mechsym.mechanisms.record import Mechanism, listing, velocities
from mechsym.quantities import record
from mechsym.quantities.display import quantity_text

_TOLERANCE = 1e-9  # relative: below it a singular value or a component counts as zero


@record
class Solution:
    """Motion and joint forces of a constrained mechanism at one state."""

    acceleration: np.ndarray  #: shape (n,): Accelerations of the coordinates [m/s^2] or [rad/s^2]
    #: Generalised force of each constraint on the coordinates; None where the rank does not determine it
    multipliers: dict[str, float | None]
    #: Rank of the constraints, and how many there are
    rank: int
    count: int
    #: shape (count, count - rank): Columns: combinations of multipliers in balance with themselves; c . mu is
    #: determined where c . free = 0 [-]
    free: np.ndarray
    #: shape (count,): The shortest of all multipliers that balance the bodies, for determined ones only [N] or [N*m]
    particular: np.ndarray
    names: tuple[str, ...]


def close(mechanism: Mechanism, values: Mapping[str, float]) -> dict[str, float]:
    """Coordinates and velocities that satisfy the constraints; those that are given are kept."""
    q, u = mechanism.coordinates, velocities(mechanism)
    guesses = mechanism.dependents
    position = np.array([float(values.get(n, guesses.get(n, 0.0))) for n in q])
    free = [i for i, n in enumerate(q) if n not in values and (not guesses or n in guesses)]
    if not _closed(mechanism, position, free) and guesses and free:
        # the guesses are meant for where the others start
        kept = {n: float(values.get(n, 0.0)) for i, n in enumerate(q) if i not in free}
        pose = loops.followed(mechanism, kept, guesses)
        position = position if pose is None else pose
        _closed(mechanism, position, free)
    gap, jacobian, _ = _constraints(mechanism, position, np.zeros(len(q)))
    if not np.abs(gap).max() <= _TOLERANCE * max(1.0, np.abs(position).max()):
        given = ", ".join(n for n in q if n in values) or "none"
        gapped = f" (gap {np.abs(gap).max():.3g})" if np.isfinite(gap).all() else ""
        follow = ", ".join(n for n in q if n in values and n in guesses)
        away = ", ".join(f"{n}=.." for n in q if n not in values and n not in guesses)
        way_out = f"give another pose, or leave {follow} to follow" if follow else "give another pose"
        if away and guesses:
            way_out = f"say where it stands: m.pose({away}), [start] of a case, or --set of eval"
        way_out += _as_guessed(mechanism, values)
        raise BadInput(f"{mechanism.name}: the loop does not close with {given} given{gapped}; {way_out}")
    rates = _rates(mechanism, jacobian, [values.get(n) for n in u])
    return dict(values) | dict(zip(q, position, strict=True)) | dict(zip(u, rates, strict=True))


def _as_guessed(mechanism: Mechanism, values: Mapping[str, float]) -> str:
    """With which values of the coordinates loops close where the others stand as guessed, if they do."""
    q, guesses = mechanism.coordinates, mechanism.dependents
    places = [i for i, n in enumerate(q) if n not in guesses]
    position = np.array([float(guesses.get(n, values.get(n, 0.0))) for n in q])
    if not guesses or not _closed(mechanism, position, places):
        return ""
    fitting = (f"{q[i]} = {quantity_text(position[i], mechanism.units.get(q[i], 'rad'), 4)}" for i in places)
    return f"; as its links are said to stand roughly, it closes with {', '.join(fitting)}"


def _closed(mechanism: Mechanism, position: np.ndarray, free: list[int]) -> bool:
    """Close the loop by Newton's method in place; whether it came to an end."""
    for _ in range(50):
        gap, jacobian, _ = _constraints(mechanism, position, np.zeros(len(position)))
        if not (np.isfinite(gap).all() and np.isfinite(jacobian).all()):
            return False
        if not free or np.abs(gap).max() <= 1e-14 * max(1.0, np.abs(position).max()):
            break
        position[free] -= np.linalg.lstsq(jacobian[:, free], gap, rcond=None)[0]
    return bool(np.abs(gap).max() <= _TOLERANCE * max(1.0, np.abs(position).max()))


def _rates(mechanism: Mechanism, jacobian: np.ndarray, given: list[float | None]) -> np.ndarray:
    # what nothing determines stands still: the shortest completion
    free = [i for i, v in enumerate(given) if v is None]
    rates = np.array([0.0 if v is None else float(v) for v in given])
    if free:
        rates[free] = np.linalg.lstsq(jacobian[:, free], -jacobian @ rates, rcond=None)[0]
    if np.abs(jacobian @ rates).max() > _TOLERANCE * max(1.0, np.abs(rates).max()):
        raise BadInput(f"{mechanism.name}: the given velocities break the constraints; give fewer of them")
    return rates


def _constraints(mechanism: Mechanism, q: np.ndarray, u: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    values = mechanism.functions["constraints"].call([float(v) for v in [*q, *u]])
    gap, jacobian, bias = (np.asarray(v) for v in values)
    return gap.ravel(), jacobian, bias.ravel()


def solve(mechanism: Mechanism, values: Mapping[str, float]) -> Solution:
    """Accelerations and multipliers at a state that satisfies the constraints.

    values: all coordinates and velocities (see `close`); inputs that are not named are 0. Returns solution: with the
    rank of the constraints.
    """
    q, u = mechanism.coordinates, velocities(mechanism)
    dynamics = mechanism.functions["dynamics"]
    mass, bias, force = (np.asarray(v) for v in dynamics.call([float(values.get(n, 0.0)) for n in dynamics.name_in()]))
    state = [np.array([values[n] for n in names]) for names in (q, u)]
    _, jacobian, gamma = _constraints(mechanism, *state)
    scale = np.abs(jacobian).max(axis=0)  # so that the rank does not depend on metres against radians
    scale[scale == 0] = 1.0
    left, sizes, right = np.linalg.svd(jacobian / scale)
    rank = int((sizes > _TOLERANCE * sizes.max()).sum())
    motions = right[rank:].T / scale[:, None]  # columns: motions that the constraints allow
    particular = right[:rank].T @ (-(left[:, :rank].T @ gamma) / sizes[:rank]) / scale
    reduced = motions.T @ mass @ motions
    if motions.size and np.linalg.cond(reduced) > 1e14:
        raise BadInput(f"{mechanism.name}: a free motion has no mass; give each moving body a mass or an inertia")
    drive = motions.T @ (force.ravel() - bias.ravel() - mass @ particular)
    acceleration = particular + motions @ np.linalg.solve(reduced, drive)
    joint = mass @ acceleration + bias.ravel() - force.ravel()
    shortest = left[:, :rank] @ ((right[:rank] @ (joint / scale)) / sizes[:rank])
    return _solution(mechanism, acceleration, shortest, left[:, rank:])


def _solution(mechanism: Mechanism, acceleration: np.ndarray, shortest: np.ndarray, free: np.ndarray) -> Solution:
    names = tuple(listing(mechanism.name)["constraints"])
    unique = [not free.size or np.abs(free[i]).max() < _TOLERANCE for i in range(len(names))]
    pairs = zip(names, shortest, unique, strict=True)
    return Solution(
        acceleration=acceleration,
        multipliers={n: float(v) if known else None for n, v, known in pairs},
        rank=len(names) - free.shape[1],
        count=len(names),
        free=free,
        particular=shortest,
        names=names,
    )


def motion(
    mechanism: Mechanism, values: Mapping[str, float]
) -> tuple[dict[str, float], np.ndarray, dict[str, float | None]]:
    """Closed state, accelerations and named joint forces in one step.

    Returns values: the same with all coordinates and velocities. acceleration: accelerations of the coordinates [m/s^2]
    or [rad/s^2]. outputs: `force_<constraint>` by name (None: not determined), `constraint_rank`, `constraint_count`.
    """
    closed = close(mechanism, values)
    solution = solve(mechanism, closed)
    forces = {f"force_{n}": v for n, v in solution.multipliers.items()}
    ranks = {"constraint_rank": float(solution.rank), "constraint_count": float(solution.count)}
    return closed, solution.acceleration, forces | ranks
