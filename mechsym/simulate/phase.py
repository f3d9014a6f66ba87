"""The one task of a backend: integrate a smooth phase, stop at the first surface it meets, return wanted points.

Surfaces are stops, the wanted number of turns, and the kinks on both sides of a coordinate:

       low                    high          Between two kinks the forces are smooth. The surfaces lie one digit
--------|----- phase ----------|------- q   beyond the kinks, so a phase that ends at one leaves its state in the
       <|                      |>           next interval, and callables are never asked beyond either kink.
"""

import numpy as np

from mechsym.native.runs import LastSteps, Level
from mechsym.quantities import record
from mechsym.simulate.equations import System
from mechsym.simulate.problem import Kinks, Problem


@record
class Span:
    """An interval of one coordinate beyond which callables must not be asked in a phase."""

    state: int
    #: Its ends, just inside the kinks [unit of the coordinate]
    low: float
    high: float


@record
class Phase:
    """A stretch of time in which the equations are smooth."""

    system: System
    #: Where it begins, and ends at the latest [s]
    t_start: float
    t_end: float
    y: np.ndarray  #: shape (m,): State at its start [SI]
    w: np.ndarray  #: shape (k,): Held values [SI]
    surfaces: tuple[Level, ...] = ()  #: The first that is met ends the phase
    spans: tuple[Span, ...] = ()
    times: np.ndarray  #: shape (n,): Wanted times in (t_start, t_end] [s]
    tolerance: float  #: Relative and absolute tolerance of a step [-]
    first_step: float | None = None  #: Step to begin with [s]
    max_steps: int = 5_000_000


@record
class Leg:
    """What came out of a phase."""

    t: float  #: Where it ended [s]
    y: np.ndarray  #: shape (m,): State there [SI]
    samples: np.ndarray  #: shape (n, m): States at the wanted times up to t [SI]
    steps: int
    met: int | None = None  #: Index of the surface that ended it
    step: float | None = None  #: Last step, a hint for the next phase [s]
    failure: str = ""  #: Empty, or why it could not go on


@record
class Raw:
    """A whole run before it is audited."""

    t: np.ndarray  #: shape (n,): Start, wanted times up to the end, and the end [s]
    y: np.ndarray  #: shape (n, m): States there [SI]
    steps: int
    end: str  #: `t_end`, `turns`, the name of a stop, or `failure`
    failure: str  #: Empty, or why it could not go on
    last: LastSteps | None = None  #: Coordinates and velocities along its last steps, where they are known


_DIRECTION = {"falling": -1, "rising": 1, "either": 0}
_MARGIN = 8  # digits that a callable may lose when it takes an angle modulo the period


@record
class Watch:
    """Levels around a state."""

    surfaces: tuple[Level, ...]
    ends: tuple[str, ...]  #: Name of the end that each means; empty for a kink, behind which the run goes on
    spans: tuple[Span, ...]  #: Interval between kinks for each coordinate that has some


def watch(problem: Problem, columns: tuple[str, ...], y: np.ndarray) -> Watch:
    """Surfaces to watch from a state y [SI, by column], shape (m,), their meanings, intervals between kinks."""
    always = ends_watched(problem, columns)
    surfaces, ends, spans = list(always.surfaces), list(always.ends), []
    for kinks in (k for k in problem.kinks if k.angles):
        state = columns.index(kinks.coordinate)
        low, high = _between(kinks, float(y[state]))
        surfaces.append(Level(state=state, level=float(np.nextafter(high, np.inf)), direction=1))
        surfaces.append(Level(state=state, level=float(np.nextafter(low, -np.inf)), direction=-1))
        margin = _MARGIN * float(np.spacing(max(abs(low), abs(high))))
        spans.append(Span(state=state, low=low + margin, high=high - margin))
        ends += ["", ""]
    return Watch(surfaces=tuple(surfaces), ends=tuple(ends), spans=tuple(spans))


def ends_watched(problem: Problem, columns: tuple[str, ...]) -> Watch:
    """What ends a run wherever it stands: stops, and the wanted number of turns."""
    surfaces = [
        Level(state=columns.index(s.of), level=s.level, direction=_DIRECTION[s.direction]) for s in problem.stops
    ]
    ends = [s.name for s in problem.stops]
    if problem.turns is not None:
        surfaces.append(Level(state=0, level=problem.q0[0] + 2 * np.pi * problem.turns, direction=1))
        ends.append("turns")
    return Watch(surfaces=tuple(surfaces), ends=tuple(ends), spans=())


def _between(kinks: Kinks, angle: float) -> tuple[float, float]:
    """The kinks on both sides of an angle; one that lies on a kink is at the low side."""
    turn = np.floor(angle / kinks.period)
    once = np.array(sorted({a % kinks.period for a in kinks.angles}))
    levels = np.concatenate([once + kinks.period * (turn + k) for k in (-1, 0, 1, 2)])
    above = int(np.searchsorted(levels, angle, side="right"))
    return float(levels[above - 1]), float(levels[above])
