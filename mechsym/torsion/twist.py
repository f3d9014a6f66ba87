r"""Twist of a shaft in a run, section by section.

    [phi1]--k1,c1--[phi2]-- ... --[phi_f]

.. math:: v_i = \varphi_i - \varphi_{i+1}, \qquad M_i = k_i v_i + c_i \dot v_i

The window is the stretch at the end over which speeds are summed up; the peaks are those of the whole run.

`settling` says where an engine settles after a start, and whether a critical speed holds it there. Held means: the mean
speed stays at an order of a natural frequency although the same engine on a rigid shaft would settle elsewhere, for the
work that should raise the speed goes into the vibration.
"""

import numpy as np

from mechsym.mechanisms.shaft import ElasticShaft, elastic, matrices
from mechsym.quantities.display import quantity_text
from mechsym.quantities.records import Record
from mechsym.quantities.results import part, quantity, result
from mechsym.quantities.units import Radian, RadPerSecond, Second
from mechsym.simulate import Result
from mechsym.torsion import modes as torsion


@result
class ShaftSection:
    """Twist of one section of a shaft."""

    section: str = part()  #: The two coordinates at its ends
    twist_mean: float = quantity("rad")  #: Over the window
    twist_amplitude: float = quantity("rad")  #: Half the swing over the window
    torque_mean: float = quantity("N*m")  #: Over the window
    torque_amplitude: float = quantity("N*m")  #: Half the swing over the window
    twist_peak: float = quantity("rad", card="twist of section")  #: Largest twist of the whole run, without its sign
    torque_peak: float = quantity("N*m")  #: Largest torque of the whole run, without its sign


def sections(shaft: ElasticShaft, result: Result, since: Second) -> tuple[ShaftSection, ...]:
    """Twist of the shaft's sections in a run, free end to flywheel. since: where the window begins."""
    return tuple(
        _section(result, pair, k, c, result.t >= since)
        for pair, k, c in zip(pairs(result, len(shaft.k)), shaft.k, shaft.c, strict=True)
    )


def pairs(result: Result, count: int) -> list[tuple[str, str]]:
    """Coordinates at the ends of each section from the free end on. result: its first columns are coordinates."""
    names = list(result.columns)[: count + 1]
    return list(zip(names, names[1:], strict=False))


def section_words(place: int, count: int) -> str:
    """A section of the shaft in words: of so many, from the free end on.

    >>> section_words(0, 1), section_words(0, 2), section_words(1, 2)
    ('free end to flywheel', 'throw 1 to throw 2', 'throw 2 to flywheel')
    """
    if count == 1:
        return "free end to flywheel"
    return f"throw {place + 1} to {'flywheel' if place == count - 1 else f'throw {place + 2}'}"


def _section(result: Result, pair: tuple[str, str], k: float, c: float, window: np.ndarray) -> ShaftSection:
    a, b = pair
    twist = result.columns[a] - result.columns[b]
    torque = k * twist + c * (result.columns[f"{a}d"] - result.columns[f"{b}d"])
    return ShaftSection(
        section=f"{a}-{b}",
        twist_mean=_mean(result.t[window], twist[window]),
        twist_amplitude=float(np.ptp(twist[window])) / 2,
        torque_mean=_mean(result.t[window], torque[window]),
        torque_amplitude=float(np.ptp(torque[window])) / 2,
        twist_peak=float(np.abs(twist).max()),
        torque_peak=float(np.abs(torque).max()),
    )


def _mean(t: np.ndarray, values: np.ndarray) -> float:
    return float(np.trapezoid(values, t) / (t[-1] - t[0])) if len(t) > 1 else float(values[-1])


def natural_frequencies(mechanism: str, parameters: Record) -> tuple[RadPerSecond, ...]:
    """Natural frequencies with the mean reciprocating inertia, without turning as a whole; none if rigid."""
    if elastic(mechanism, parameters) is None:
        return ()
    linear = matrices(mechanism, parameters)
    return tuple(torsion.modes(linear.inertia_mean, linear.stiffness).frequencies[1:].tolist())


_NEAR = 0.02  # a mean speed this close to a critical one counts as being at it [-]
_ELSEWHERE = 0.02  # and this far from that of the rigid shaft it is not there by its own balance [-]
_STEADY = 2e-3  # change of the mean speed over the last tenth of the run that counts as settled [-]
_HIGHEST = 6  # orders above are too weak to hold an engine


@result
class Settling:
    """Mean speeds of a start, and what they meet."""

    speed_start: float = quantity("rad/s")  #: Over the first period
    speed_end: float = quantity("rad/s")  #: Over the last period
    settled: bool = part()
    speed_rigid: float | None = quantity("rad/s")  #: Steady speed of the same engine on a rigid shaft, if it has one
    passed: tuple[tuple[float, float], ...] = quantity("-, rad/s")  #: Order and critical speed of what it passed
    at: tuple[float, float] | None = quantity("-, rad/s")  #: Order and critical speed that it runs at, if any
    held: bool = part()


def settling(
    result: Result, coordinate: str, period: Radian, natural: tuple[RadPerSecond, ...], speed_rigid: RadPerSecond | None
) -> Settling:
    """Judge a finished start.

    period: of the gas; natural: natural frequencies of the shaft; speed_rigid: steady speed on a rigid shaft.
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
        speed_start=float(first),
        speed_end=float(last),
        settled=bool(abs(last / before - 1) < _STEADY),
        speed_rigid=speed_rigid,
        passed=passed,
        at=at,
        held=at is not None and elsewhere,
    )


def _speed(value: float) -> str:
    return quantity_text(value, "rad/s", 4)


def sentences(start: Settling) -> tuple[str, ...]:
    """What a reader of the run should know."""
    lines = [
        f"from {_speed(start.speed_start)} the engine {'settles at' if start.settled else 'has come to'} "
        f"{_speed(start.speed_end)}{'' if start.settled else ', which still changes'}"
    ]
    if start.speed_rigid is not None:
        lines.append(f"on a rigid shaft gas and load are in balance at {_speed(start.speed_rigid)}")
    lines += [f"order {order:g} at {_speed(speed)} is passed" for order, speed in start.passed]
    if start.at is None:
        lines.append("it runs at no critical speed")
    elif start.held:
        lines.append(f"order {start.at[0]:g} holds it at its critical speed of {_speed(start.at[1])}")
    else:
        lines.append(
            f"order {start.at[0]:g} has a critical speed of {_speed(start.at[1])}, within 2 % of where it runs: the "
            "balance of gas and load puts it there, the critical does not hold it, but it vibrates"
        )
    return tuple(lines)
