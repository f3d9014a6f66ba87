"""What is to be simulated: a mechanism, named parts that act on its inputs, a start, and where to split and to stop.

    part "drive" --+--> input M --> mechanism --> q(t), u(t) = dq/dt
    part "load"  --+                              and the work of every part beside them

Each input of the mechanism is the sum of the parts that name it, so that the work of each part can be told apart.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.record import Mechanism, velocities
from mechsym.quantities import check, choice, quantity


@dataclass(frozen=True, kw_only=True)
class Steps:
    """A value that jumps at known times and is constant between them.

    Parameters
    ----------
    times : tuple of float
        Ascending times of the jumps, none for a constant [s]
    values : tuple of float
        Value before the first jump and after each; one more than times, in the unit of the input
    """

    times: tuple[float, ...] = ()
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.values) != len(self.times) + 1 or list(self.times) != sorted(set(self.times)):
            raise BadInput(
                f"steps: {len(self.times)} times and {len(self.values)} values; times must ascend and there is one "
                "more value than times"
            )


@dataclass(frozen=True, kw_only=True)
class Formula:
    """A value given by a function that takes numbers and CasADi symbols alike, so every backend can use it.

    Parameters
    ----------
    function : callable
        (t, q, u) to value; q and u are sequences of the coordinates and velocities, in the mechanism's order
    """

    function: Callable[[Any, Any, Any], Any]


@dataclass(frozen=True, kw_only=True)
class Periodic:
    """A value that depends on one coordinate only and repeats, such as a gas force over the crank angle.

    Parameters
    ----------
    coordinate : str
        Name of the coordinate
    value : callable
        Vectorised: angles (n,) [rad] to values (n,) in the unit of the input
    period : float
        After which it repeats [rad]
    kinks : tuple of float
        Angles where it is not smooth; it may jump there [rad]
    point : callable, optional
        The same for one float, where there is a fast way; without it a polynomial is fitted to round-off
    """

    coordinate: str
    value: Callable[[np.ndarray], np.ndarray]
    period: float = quantity("rad", above=0, about="period of the value")
    kinks: tuple[float, ...] = ()
    point: Callable[[float], float] | None = None

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, kw_only=True)
class Part:
    """Something that acts on one input of the mechanism and whose work is counted by itself.

    Parameters
    ----------
    name : str
        Name of its column, `work_<name>`
    input : str
        The mechanism's input it adds to
    role : str
        `drive` counts as work in; `load` and `store` (a spring outside the mechanism) do not
    value : Steps, Formula, Periodic or callable
        A plain callable takes floats (t, q, u); only the scipy backends can use it
    """

    name: str
    input: str
    role: str = choice("drive", "load", "store", default="drive", about="side of the energy balance")
    value: Steps | Formula | Periodic | Callable[[float, list[float], list[float]], float]

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, kw_only=True)
class Kinks:
    """Values of a coordinate at which the forces are not smooth; no step of the integrator reaches across one.

    Parameters
    ----------
    coordinate : str
        Name of the coordinate
    angles : tuple of float
        Where the kinks are, within one period [rad]
    period : float
        After which they repeat [rad]
    """

    coordinate: str
    angles: tuple[float, ...]
    period: float = quantity("rad", above=0, about="period of the kinks")

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, kw_only=True)
class Stop:
    """An event that ends the run.

    Parameters
    ----------
    name : str
        What it means, for example `stall`
    of : str
        A coordinate (`phi`) or a velocity (`phid`)
    level : float
        Value that ends the run [rad or rad/s]
    direction : str
        `falling`, `rising` or `either`: how the level is passed
    """

    name: str
    of: str
    level: float = 0.0
    direction: str = choice("falling", "rising", "either", default="either", about="how the level is passed")

    def __post_init__(self) -> None:
        check(self)


@dataclass(frozen=True, kw_only=True)
class Problem:
    """A run from given positions and speeds to a time, a number of turns, or an event.

    Parameters
    ----------
    mechanism : Mechanism
        With its parameters bound
    parts : tuple of Part
        What acts on its inputs; an input that no part names is 0
    q0, u0 : tuple of float
        Coordinates and velocities at the start [rad, rad/s]
    t_end : float
        Last time, at the latest [s]
    t_start : float
        First time [s]
    turns : float or None
        The run also ends when the first coordinate has advanced by so many turns [-]
    breaks : tuple of float
        Known times at which callables jump; the jumps of `Steps` are known without being listed [s]
    kinks : tuple of Kinks
        Where forces are not smooth in a coordinate
    stops : tuple of Stop
        Events that end the run
    output : float or tuple of float
        Spacing of the results in time, or the wanted times themselves [s]
    """

    mechanism: Mechanism
    parts: tuple[Part, ...]
    q0: tuple[float, ...]
    u0: tuple[float, ...]
    t_end: float = quantity("s", about="last time")
    t_start: float = quantity("s", default=0.0, about="first time")
    turns: float | None = quantity("-", default=None, above=0, about="turns of the first coordinate")
    breaks: tuple[float, ...] = ()
    kinks: tuple[Kinks, ...] = ()
    stops: tuple[Stop, ...] = ()
    output: float | tuple[float, ...] = 0.01

    def __post_init__(self) -> None:
        check(self)
        q, u = self.mechanism.coordinates, velocities(self.mechanism)
        if len(self.q0) != len(q) or len(self.u0) != len(q):
            raise BadInput(f"start has {len(self.q0)} coordinates and {len(self.u0)} velocities; needs {', '.join(q)}")
        if self.t_end <= self.t_start:
            raise BadInput(f"t_end = {self.t_end:g} s must be later than t_start = {self.t_start:g} s")
        _known("part", [p.input for p in self.parts], self.mechanism.inputs)
        _known("part", [p.value.coordinate for p in self.parts if isinstance(p.value, Periodic)], q)
        _known("kinks", [k.coordinate for k in self.kinks], q)
        _known("stop", [s.of for s in self.stops], (*q, *u))
        if len({p.name for p in self.parts}) != len(self.parts):
            raise BadInput(f"two parts have one name ({', '.join(p.name for p in self.parts)}); rename one")
        _outputs(self.output)


def _known(what: str, names: list[str], allowed: tuple[str, ...]) -> None:
    for name in names:
        if name not in allowed:
            raise BadInput(f"{what} names {name!r}, which the mechanism has not; it has {', '.join(allowed)}")


def _outputs(output: float | tuple[float, ...]) -> None:
    wanted = np.atleast_1d(output) if isinstance(output, (int, float)) else np.diff(output)
    if not np.all(wanted > 0):
        raise BadInput("output must be a positive spacing in s, or ascending times in s")
