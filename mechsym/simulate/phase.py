"""The one task of a backend: integrate a smooth phase, stop at the first surface it meets, return wanted points."""

import numpy as np

from mechsym.quantities import record
from mechsym.simulate.equations import System


@record
class Surface:
    """A level of one state at which a phase ends."""

    state: int
    level: float  #: in the unit of the state [SI]
    direction: int  #: 1 rising, -1 falling, 0 either


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
    surfaces: tuple[Surface, ...] = ()  #: The first that is met ends the phase
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
