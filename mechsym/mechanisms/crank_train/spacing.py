"""How the cylinders of a crank train stand to each other: the least distance of two, opposed shafts, unlike values."""

import math
from itertools import combinations

from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each

_ALIKE = ("r", "l1", "l2", "m_rod", "m_piston", "I_rod", "I0", "m0")
_Place = tuple[float, float, float]


def pitch(p: CrankTrainParameters) -> float | None:
    """Least distance of two cylinders on one shaft, at half stroke; None where throws have no place along it [m]."""
    if not any(each(p, "z")):
        return None
    at = [_shaft(p, i) for i in range(len(p.throw))]
    middles = [_half(p, i) for i in range(len(p.throw))]
    near = [math.dist(middles[i], middles[j]) for i, j in combinations(range(len(middles)), 2) if at[i] == at[j]]
    return min(near, default=None)


def unequal(p: CrankTrainParameters) -> dict[str, float]:
    """Largest over least of what is alike in all cylinders and throws, by letter; zeros leave parts away."""
    lists = {name: [value for value in each(p, name) if value > 0] for name in _ALIKE}
    return {name: max(values) / min(values) for name, values in lists.items() if values}


def span(p: CrankTrainParameters) -> float | None:
    """Distance of the shafts of opposed pistons over the length of both rods and throws; None without such [-]."""
    found = []
    for i, j in combinations(range(len(p.throw)), 2):
        facing = math.cos(each(p, "bank")[i] - each(p, "bank")[j]) < -0.99
        apart = math.dist(_shaft(p, i), _shaft(p, j))
        if facing and apart > 0 and _along(p, i, j) and each(p, "z")[p.throw[i] - 1] == each(p, "z")[p.throw[j] - 1]:
            found.append(apart / (_reach(p, i) + _reach(p, j)))
    # the one that is farthest off
    return max(found, key=lambda ratio: abs(math.log(ratio)), default=None)


def _along(p: CrankTrainParameters, i: int, j: int) -> bool:
    """Whether a cylinder's axis points from its own shaft to that of the other."""
    (x1, y1), (x2, y2), bank = _shaft(p, i), _shaft(p, j), each(p, "bank")[i]
    along = (x2 - x1) * math.cos(bank) + (y2 - y1) * math.sin(bank)
    return along > 0.99 * math.dist((x1, y1), (x2, y2))


def _shaft(p: CrankTrainParameters, i: int) -> tuple[float, float]:
    k = p.throw[i] - 1
    return each(p, "axis_x")[k], each(p, "axis_y")[k]


def _reach(p: CrankTrainParameters, i: int) -> float:
    """Throw and rod of a cylinder [m]."""
    return each(p, "r")[i] + each(p, "l1")[i] + each(p, "l2")[i]


def _half(p: CrankTrainParameters, i: int) -> _Place:
    """The piston's pin at half stroke, by its own shaft [m]."""
    half, bank = _reach(p, i) - each(p, "r")[i], each(p, "bank")[i]
    return half * math.cos(bank), half * math.sin(bank), each(p, "z")[p.throw[i] - 1] + each(p, "z_rod")[i]
