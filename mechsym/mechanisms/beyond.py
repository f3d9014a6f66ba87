"""A mechanism whose loops close by constraint in place of closed forms, so that no dead point ends its motion.

A closed form has one of two ways to close a loop. Where both meet, it ends (the links are in line and go no further
this way), or it would leave the motion it is on (a parallelogram that lies flat).
"""

from collections.abc import Mapping

import numpy as np

from mechsym.mechanisms import loops, own
from mechsym.mechanisms.plan import plan_of
from mechsym.mechanisms.record import Mechanism
from mechsym.periodic.roots import minimum
from mechsym.quantities.records import Record

_GRID = 720  # angles of a turn
_MEET = 1e-6  # of its largest value, what is 0 where two ways meet


def meets(mechanism: Mechanism) -> bool:
    """Whether the two ways to close a loop meet within a turn of the one coordinate, and both go on from there."""
    sides = mechanism.functions.get("sides")
    if sides is None or len(mechanism.coordinates) > 1 or mechanism.units.get(mechanism.coordinates[0], "rad") != "rad":
        return False
    of = [i for i, name in enumerate(sides.name_out()) if name.startswith("root_")]

    def roots(angle: np.ndarray) -> np.ndarray:
        values = sides.map(angle.size).call([angle.reshape(1, -1)])
        return np.array([np.asarray(values[i]).ravel() for i in of])

    at = np.arange(-1, _GRID + 1) * 2 * np.pi / _GRID
    for i, row in enumerate(roots(at)):
        value, largest = np.nan_to_num(row), np.nanmax(row, initial=0.0)
        ends = np.isfinite(row[:-2]) & np.isfinite(row[2:])
        before, middle, after = value[:-2], value[1:-1], value[2:]
        # what comes down to 0 between two angles, as a parabola or as a V, is at most half of its neighbour
        low = (middle <= before) & (middle <= after) & (middle <= 0.55 * np.maximum(before, after))
        for k in np.flatnonzero(ends & low) + 1:

            def length(x: float, i: int = i) -> float:
                return float(np.nan_to_num(roots(np.array([x]))[i, 0]))

            _, least = minimum(length, at[k - 1], at[k + 1], 1e-9)
            if least < _MEET * largest:
                return True
    return False


def by_constraint(
    name: str, mechanism: Mechanism, parameters: Mapping[str, float], start: Mapping[str, float]
) -> tuple[str, Record, dict[str, float]]:
    """The same mechanism by constraint: its name, its numbers, and the coordinates of a pose [rad] or [m].

    start: the coordinates of the mechanism there.
    """
    held = own.by_constraint(name)
    numbers = plan_of(held).parameters(**parameters)
    sides = mechanism.functions["sides"]
    turned = dict(zip(sides.name_out(), sides.call([start[q] for q in mechanism.coordinates]), strict=True))
    angles = {f"theta_{n.removeprefix('turn_')}": float(v) for n, v in turned.items() if n.startswith("turn_")}
    whole = plan_of(held).build(numbers)
    links = {q: angles[q.rstrip("_")] for q in whole.dependents if q.rstrip("_") in angles}
    pose = {**whole.dependents, **links, **start}
    if pose.keys() - links.keys() - start.keys():  # ways along lines, which follow from the angles
        closed = loops.close(whole, {**start, **links}, pose)
        pose = pose if closed is None else dict(zip(whole.coordinates, closed, strict=True))
    return held, numbers, {q: float(pose[q]) for q in whole.coordinates}
