"""Where an engine on an elastic shaft settles after a start, and whether a critical speed holds it there.

Held means: the mean speed stays at an order of a natural frequency although the same engine on a rigid shaft would
settle elsewhere, for the work that should raise the speed goes into the vibration.
"""

import numpy as np

from mechsym.quantities import record
from mechsym.quantities.display import quantity_text
from mechsym.simulate import Result

_NEAR = 0.02  # a mean speed this close to a critical one counts as being at it [-]
_ELSEWHERE = 0.02  # and this far from that of the rigid shaft it is not there by its own balance [-]
_STEADY = 2e-3  # change of the mean speed over the last tenth of the run that counts as settled [-]
_HIGHEST = 6  # orders above are too weak to hold an engine


@record
class Settling:
    """Mean speeds of a start, and what they meet."""

    speed_start: float  #: Over the first period [rad/s]
    speed_end: float  #: Over the last period [rad/s]
    settled: bool
    speed_rigid: float | None  #: Steady speed of the same engine on a rigid shaft; None where it has none [rad/s]
    passed: tuple[tuple[float, float], ...]  #: Order and critical speed of what it passed [-, rad/s]
    at: tuple[float, float] | None  #: Order and critical speed that it runs at, if any [-, rad/s]
    held: bool


def settling(
    result: Result, coordinate: str, period: float, natural: tuple[float, ...], speed_rigid: float | None
) -> Settling:
    """Judge a finished start.

    Parameters
    ----------
    period : float
        Of the gas [rad]
    natural : tuple of float
        Natural frequencies of the shaft [rad/s]
    speed_rigid : float or None
        Steady speed on a rigid shaft [rad/s]
    """
    t, phi = result.t, result.columns[coordinate]
    edges = np.arange(phi[0], phi[-1] + 1e-9, period)
    speeds = period / np.diff(np.interp(edges, phi, t))
    first, last, before = speeds[0], speeds[-1], speeds[-1 - max(1, len(speeds) // 10)]
    step = 2 * np.pi / period
    criticals = [(k * step, f / (k * step)) for f in natural for k in range(1, int(_HIGHEST / step) + 1)]
    near = [c for c in criticals if abs(last / c[1] - 1) <= _NEAR]
    at = min(near, key=lambda c: abs(last - c[1]), default=None)
    elsewhere = speed_rigid is None or bool(abs(last / speed_rigid - 1) > _ELSEWHERE)
    low, high = sorted((float(first), float(last)))
    passed = tuple(c for c in sorted(criticals, key=lambda c: c[1]) if low < c[1] < high and c != at)
    return Settling(
        speed_start=float(first), speed_end=float(last), settled=bool(abs(last / before - 1) < _STEADY),
        speed_rigid=speed_rigid, passed=passed,
        at=at, held=at is not None and elsewhere,
    )  # fmt: skip


def _speed(value: float) -> str:
    return quantity_text(value, "rad/s", 4)


def sentences(found: Settling) -> tuple[str, ...]:
    """What a reader of the run should know."""
    lines = [
        f"from {_speed(found.speed_start)} the engine {'settles at' if found.settled else 'has come to'} "
        f"{_speed(found.speed_end)}{'' if found.settled else ', which still changes'}"
    ]
    if found.speed_rigid is not None:
        lines.append(f"on a rigid shaft gas and load are in balance at {_speed(found.speed_rigid)}")
    lines += [f"order {order:g} at {_speed(speed)} is passed" for order, speed in found.passed]
    if found.at is None:
        lines.append("it runs at no critical speed")
    elif found.held:
        lines.append(f"order {found.at[0]:g} holds it at its critical speed of {_speed(found.at[1])}")
    else:
        lines.append(
            f"order {found.at[0]:g} has a critical speed of {_speed(found.at[1])}, within 2 % of where it runs: the "
            "balance of gas and load puts it there, the critical does not hold it, but it vibrates"
        )
    return tuple(lines)
