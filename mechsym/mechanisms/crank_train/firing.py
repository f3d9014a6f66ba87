"""When the cylinders of a crank train fire, and the gas forces that follow."""

import math
from collections.abc import Callable, Sequence

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, dead_centre, each, local_shift

_TURN = 2 * math.pi
# pistons that share a chamber lead or lag each other a little; a cylinder further off is a slip of the data
_LARGEST_LEAD = math.radians(30)


def firing_angles(order: Sequence[int], period: float) -> tuple[float, ...]:
    """Evenly spaced firing angles of a firing order.

    Parameters
    ----------
    order : sequence of int
        Cylinders 1 to n in the order in which they fire
    period : float
        2 pi (two-stroke) or 4 pi (four-stroke) [rad]

    Returns
    -------
    angles : tuple of float
        Shaft angle at which cylinder 1, 2, .. fires [rad]

    Examples
    --------
    >>> [round(math.degrees(a)) for a in firing_angles((1, 5, 3, 6, 2, 4), 4 * math.pi)]
    [0, 480, 240, 600, 120, 360]
    """
    n = len(order)
    if sorted(order) != list(range(1, n + 1)):
        raise BadInput(f"firing order {list(order)} must name the cylinders 1 to {n}, each once")
    place = {cylinder: i for i, cylinder in enumerate(order)}
    return tuple(place[i + 1] * period / n for i in range(n))


def crank_phases(firing: Sequence[float], bank: Sequence[float]) -> tuple[float, ...]:
    """Crank-pin angles that bring every cylinder to top dead centre when it fires.

    Parameters
    ----------
    firing : sequence of float
        Shaft angle at which each cylinder fires [rad]
    bank : sequence of float
        Angle of each cylinder axis [rad]

    Returns
    -------
    phases : tuple of float
        In [0, 2 pi), one a cylinder [rad]
    """
    return tuple((b - f) % _TURN for f, b in zip(firing, bank, strict=True))


def refuse_wrong_firing(parameters: CrankTrainParameters, period: float = _TURN) -> None:
    """Refuse a cylinder that fires far from its top dead centre, with the line that could stand there.

    Parameters
    ----------
    period : float
        2 pi (two-stroke) or 4 pi (four-stroke) [rad]
    """
    if not parameters.firing:
        raise BadInput(
            "firing is missing: gas forces need the shaft angle at which each cylinder fires; "
            f"evenly spaced as far as the cranks allow: {_line(even_firing(parameters, period))}"
        )
    rows = zip(each(parameters, "firing"), local_shift(parameters), dead_centre(parameters), strict=True)
    for i, (fires, shift, top) in enumerate(rows, 1):
        late = math.remainder(fires + shift - top, _TURN)
        if abs(late) > _LARGEST_LEAD:
            raise BadInput(
                f"firing of cylinder {i} = {math.degrees(fires):g} deg is {abs(math.degrees(late)):.4g} deg off its "
                "top dead centre; with these phases and banks, spaced as evenly as they allow: "
                f"{_line(even_firing(parameters, period))}"
            )


def even_firing(parameters: CrankTrainParameters, period: float) -> tuple[float, ...]:
    """Firing angles at the cylinders' top dead centres, spaced as evenly as the cranks allow.

    Parameters
    ----------
    period : float
        2 pi (two-stroke) or 4 pi (four-stroke) [rad]

    Returns
    -------
    angles : tuple of float
        Shaft angle at which cylinder 1, 2, .. fires; of four-stroke cylinders each may fire a turn later [rad]
    """
    tops = [(top - shift) % _TURN for top, shift in zip(dead_centre(parameters), local_shift(parameters), strict=True)]
    turns = round(period / _TURN)
    found = [tops[0]]
    # the next cylinder fires in the turn that leaves it furthest from those that are placed
    for top in tops[1:]:
        places = [top + k * _TURN for k in range(turns)]
        found.append(max(places, key=lambda angle: _room(angle, found, period)))
    return tuple(found)


def _room(angle: float, others: Sequence[float], period: float) -> tuple[float, ...]:
    """Distances to the others, the smallest first [rad]."""
    return tuple(sorted(round(abs(math.remainder(angle - other, period)), 9) for other in others))


def _line(angles: Sequence[float]) -> str:
    return "firing = [" + ", ".join(f'"{round(math.degrees(a), 6):g} deg"' for a in angles) + "]"


def gas_forces(
    parameters: CrankTrainParameters,
    net_pressure: Callable[[np.ndarray], np.ndarray],
    area: float,
    phi: np.ndarray,
    period: float = _TURN,
) -> np.ndarray:
    """Gas force on every piston at shaft angles.

    Parameters
    ----------
    net_pressure : callable
        p - p_back by the angle after the firing dead centre, ndarray to ndarray [Pa]
    area : float
        Area of a piston [m^2]
    phi : ndarray, shape (n,)
        Shaft angles [rad]
    period : float
        2 pi (two-stroke) or 4 pi (four-stroke) [rad]

    Returns
    -------
    F : ndarray, shape (cylinders, n)
        Forces, positive away from the head [N]
    """
    refuse_wrong_firing(parameters, period)
    return np.array([net_pressure(phi - fires) * area for fires in each(parameters, "firing")])


def firing_gaps(parameters: CrankTrainParameters, period: float) -> tuple[float, ...]:
    """Angles between consecutive firings.

    Parameters
    ----------
    period : float
        2 pi (two-stroke) or 4 pi (four-stroke) [rad]

    Returns
    -------
    gaps : tuple of float
        One a cylinder; all equal for even firing [rad]
    """
    angles = np.sort(np.mod(each(parameters, "firing"), period))
    return tuple(float(g) for g in np.diff(angles, append=angles[0] + period))
