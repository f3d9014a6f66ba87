"""What is to be simulated: a mechanism, named parts that act on its inputs, a start, and where to split and to stop.

    part "drive" --+--> input M --> mechanism --> q(t), u(t) = dq/dt
    part "load"  --+                              and the work of every part beside them

Each input of the mechanism is the sum of the parts that name it, so that the work of each part can be told apart.
"""

from collections.abc import Callable

import numpy as np

from mechsym.errors import BadInput
from mechsym.mechanisms.record import Mechanism, velocities
from mechsym.mechanisms.roles import FrictionRole, StopRole
from mechsym.quantities import choice, quantity, record
from mechsym.quantities.units import Array, Scalar, Second


@record
class Steps:
    """A value that jumps at known times and is constant between them."""

    times: tuple[float, ...] = ()  #: Ascending times of the jumps, none for a constant [s]
    #: Value before the first jump and after each; one more than times [unit of the input]
    values: tuple[float, ...]

    def __post_init__(self) -> None:
        if len(self.values) != len(self.times) + 1 or list(self.times) != sorted(set(self.times)):
            raise BadInput(
                f"steps: {len(self.times)} times and {len(self.values)} values; times must ascend and there is one "
                "more value than times"
            )


@record
class FormulaForce:
    """A value given by a function that takes numbers and CasADi symbols alike, so every backend can use it."""

    #: (t, q, u, *numbers) to value; q and u are sequences of the coordinates and velocities, in the mechanism's order
    function: Callable[..., Scalar]
    #: Its last arguments; runs that differ in them share their equations [unit of each]
    numbers: tuple[Scalar, ...] = ()


@record
class Periodic:
    """A value that depends on one coordinate only and repeats, such as a gas force over the crank angle."""

    coordinate: str
    value: Callable[[np.ndarray], np.ndarray]  #: Vectorised: angles (n,) [rad] to values (n,) in the unit of the input
    period: float = quantity("rad", above=0, about="period of the value")
    kinks: tuple[float, ...] = ()  #: Angles where it is not smooth; it may jump there [rad]
    #: The same for one float, where there is a fast way; without it a polynomial is fitted to round-off
    point: Callable[[float], float] | None = None


@record
class Along:
    """A value by a formula of the velocities, of the problem's curves and of its states; numbers and symbols alike."""

    #: (velocities, values of the curves, states) to value, each a sequence in the problem's order
    function: Callable[[Scalar, Scalar, Scalar], Scalar]


@record
class State:
    """What is integrated beside the motion, such as the temperature of a gas."""

    name: str
    unit: str
    start: float  #: [unit]
    rate: Along  #: By time [unit/s]
    #: `inner`, or `heat`: energy that has left a store [J]
    role: str = choice("inner", "heat", default="inner", about="side of the energy balance")


@record
class Part:
    """Something that acts on one input of the mechanism and whose work is counted by itself."""

    name: str
    input: str  #: The mechanism's input it adds to
    #: `drive` counts as work in; `load`, `store` (a spring outside the mechanism) and `loss` (friction) do not
    role: str = choice("drive", "load", "store", "loss", default="drive", about="side of the energy balance")
    #: A plain callable takes floats (t, q, u); only the scipy backends can use it
    value: Steps | FormulaForce | Periodic | Along | Callable[[float, list[float], list[float]], float]


@record
class Kinks:
    """Values of a coordinate at which the forces are not smooth; no step of the integrator reaches across one."""

    coordinate: str
    angles: tuple[float, ...]  #: Where the kinks are, within one period [rad]
    period: float = quantity("rad", above=0, about="period of the kinks")


@record
class Stop:
    """An event that ends the run."""

    name: str  #: What it means, for example `stall`
    of: str  #: A coordinate (`phi`) or a velocity (`phid`)
    level: float = 0.0  #: Value that ends the run [rad or rad/s]
    #: `falling`, `rising` or `either`: how the level is passed
    direction: str = choice("falling", "rising", "either", default="either", about="how the level is passed")


@record
class Problem:
    """A run from given positions and speeds to a time, a number of turns, or an event."""

    mechanism: Mechanism
    parts: tuple[Part, ...]  #: What acts on its inputs; an input that no part names is 0
    curves: tuple[Periodic, ...] = ()  #: What the formulas of `Along` are made of
    states: tuple[State, ...] = ()
    #: Inertia on the one coordinate of the mechanism, of parts that are none of its own [kg*m^2], and its derivative
    inertia: tuple[Periodic, Periodic] | None = None
    stored: Along | None = None  #: Energy in the parts with the role `store` [J]; None takes their work for it
    #: Coordinates and velocities at the start [rad, rad/s]
    q0: tuple[float, ...]
    u0: tuple[float, ...]
    #: Last time, at the latest [s]
    t_end: float = quantity("s", about="last time")
    t_start: float = quantity("s", default=0.0, about="first time")
    #: The run also ends when the first coordinate has advanced by so many turns [-]
    turns: float | None = quantity("-", default=None, above=0, about="turns of the first coordinate")
    #: Known times at which callables jump; the jumps of `Steps` are known without being listed [s]
    breaks: tuple[float, ...] = ()
    kinks: tuple[Kinks, ...] = ()  #: Where forces are not smooth in a coordinate
    stops: tuple[Stop, ...] = ()
    unilateral: tuple[StopRole | FrictionRole, ...] = ()  #: Stops, contacts and friction with events
    output: float | tuple[float, ...] = 0.01  #: Spacing of the results in time, or the wanted times themselves [s]

    def __post_init__(self) -> None:
        q, u = self.mechanism.coordinates, velocities(self.mechanism)
        if len(self.q0) != len(q) or len(self.u0) != len(q):
            raise BadInput(f"start has {len(self.q0)} coordinates and {len(self.u0)} velocities; needs {', '.join(q)}")
        if self.t_end <= self.t_start:
            raise BadInput(f"t_end = {self.t_end:g} s must be later than t_start = {self.t_start:g} s")
        _known("part", [p.input for p in self.parts], self.mechanism.inputs)
        _known("part", [p.value.coordinate for p in self.parts if isinstance(p.value, Periodic)], q)
        _known("kinks", [k.coordinate for k in self.kinks], q)
        _known("stop", [s.of for s in self.stops], (*q, *u))
        if (self.states or self.inertia) and (len(q) > 1 or self.mechanism.dependents):
            raise BadInput(f"{self.mechanism.name}: states and inertia beside a mechanism need one coordinate")
        if len({p.name for p in self.parts}) != len(self.parts):
            raise BadInput(f"two parts have one name ({', '.join(p.name for p in self.parts)}); rename one")
        wanted = np.atleast_1d(self.output) if isinstance(self.output, (int, float)) else np.diff(times_of(self.output))
        if not np.all(wanted > 0):
            raise BadInput("output must be a positive spacing in s, or ascending times in s")


def times_of(output: tuple[Second, ...]) -> Second[Array]:
    """Ascending wanted times as an array made once for runs that share it, and not to be written into."""
    entry = _KEPT.get(id(output))
    if entry is None:
        if len(_KEPT) > 8:
            _KEPT.clear()
        entry = _KEPT[id(output)] = output, np.array(output, dtype=float)  # what is kept keeps its id
        entry[1].flags.writeable = False
    return entry[1]


_KEPT: dict[int, tuple[tuple[float, ...], np.ndarray]] = {}


def period_of(problem: Problem) -> float:
    """Period of what acts over a coordinate; a turn where nothing does [rad]."""
    return max((p.value.period for p in problem.parts if isinstance(p.value, Periodic)), default=2 * np.pi)


def _known(what: str, names: list[str], allowed: tuple[str, ...]) -> None:
    for name in names:
        if name not in allowed:
            raise BadInput(f"{what} names {name!r}, which the mechanism has not; it has {', '.join(allowed)}")
