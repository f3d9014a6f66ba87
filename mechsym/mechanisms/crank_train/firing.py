"""When the cylinders of a crank train fire, and the gas forces that follow."""

import math
from collections.abc import Sequence

from mechsym.errors import BadInput
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, dead_centre, each, local_shift
from mechsym.quantities.units import Radian

_TURN = 2 * math.pi
# pistons that share a chamber lead or lag each other a little; a cylinder further off is a slip of the data
_LARGEST_LEAD = math.radians(30)


def firing_angles(order: Sequence[int], period: Radian) -> tuple[Radian, ...]:
    """Evenly spaced firing angles of a firing order.

    order: cylinders 1 to n in the order in which they fire; period: 2 pi (two-stroke) or 4 pi (four-stroke). Returns
    angles: shaft angle at which cylinder 1, 2.. fires.

    >>> [round(math.degrees(a)) for a in firing_angles((1, 5, 3, 6, 2, 4), 4 * math.pi)]
    [0, 480, 240, 600, 120, 360]
    """
    n = len(order)
    if sorted(order) != list(range(1, n + 1)):
        raise BadInput(f"firing order {list(order)} must name the cylinders 1 to {n}, each once")
    place = {cylinder: i for i, cylinder in enumerate(order)}
    return tuple(place[i + 1] * period / n for i in range(n))


def crank_phases(firing: Sequence[Radian], bank: Sequence[Radian]) -> tuple[Radian, ...]:
    """Crank-pin angles that bring every cylinder to top dead centre when it fires.

    firing: shaft angle at which each cylinder fires; bank: angle of each cylinder axis. Returns phases: in [0, 2 pi),
    one a cylinder.
    """
    return tuple((b - f) % _TURN for f, b in zip(firing, bank, strict=True))


def refuse_wrong_firing(parameters: CrankTrainParameters, period: Radian = _TURN) -> None:
    """Refuse a cylinder that fires far from its top dead centre, with the line that could stand there.

    period: 2 pi (two-stroke) or 4 pi (four-stroke).
    """
    if not parameters.firing:
        raise BadInput(
            "firing is missing: gas forces need the shaft angle at which each cylinder fires; "
            f"evenly spaced as far as the cranks allow: {_line(even_firing(parameters, period))}"
        )
    for i, (fires, late) in enumerate(zip(each(parameters, "firing"), lateness(parameters), strict=True), 1):
        if abs(late) > _LARGEST_LEAD:
            raise BadInput(
                f"firing of cylinder {i} = {math.degrees(fires):g} deg is {abs(math.degrees(late)):.4g} deg off its "
                "top dead centre; with these phases and banks, spaced as evenly as they allow: "
                f"{_line(even_firing(parameters, period))}"
            )


def lateness(parameters: CrankTrainParameters) -> tuple[Radian, ...]:
    """How far behind its top dead centre each cylinder fires."""
    rows = zip(each(parameters, "firing"), local_shift(parameters), dead_centre(parameters), strict=True)
    return tuple(math.remainder(fires + shift - top, _TURN) for fires, shift, top in rows)


def even_firing(parameters: CrankTrainParameters, period: Radian) -> tuple[Radian, ...]:
    """Firing angles at the cylinders' top dead centres, spaced as evenly as the cranks allow.

    period: 2 pi (two-stroke) or 4 pi (four-stroke). Returns angles: shaft angle at which cylinder 1, 2.. fires; of
    four-stroke cylinders each may fire a turn later.
    """
    tops = [(top - shift) % _TURN for top, shift in zip(dead_centre(parameters), local_shift(parameters), strict=True)]
    turns = round(period / _TURN)
    angles = [tops[0]]
    # the next cylinder fires in the turn that leaves it furthest from those that are placed
    for top in tops[1:]:
        places = [top + k * _TURN for k in range(turns)]
        angles.append(max(places, key=lambda angle: _room(angle, angles, period)))
    return tuple(angles)


def _room(angle: float, others: Sequence[float], period: float) -> tuple[float, ...]:
    """Distances to the others, the smallest first [rad]."""
    return tuple(sorted(round(abs(math.remainder(angle - other, period)), 9) for other in others))


def _line(angles: Sequence[float]) -> str:
    return "firing = [" + ", ".join(f'"{round(math.degrees(a), 6):g} deg"' for a in angles) + "]"
