"""Records of integrations in C: what to run, and what came out.

Runs of one right-hand side y' = f(t, y, p) differ in start, held values p, times and constants. A held value is
constant in a segment of time, or follows a state as a periodic piecewise polynomial (a pressure over the crank angle).
"""

import dataclasses
from collections.abc import Sequence

import casadi
import numpy as np

from mechsym.quantities import record

STATUS = (
    "done",
    "met a surface",
    "the number of steps was not enough; allow more steps or a larger tolerance",
    "the step became too small; the equations are not smooth there, or not finite",
    "the equations are not finite",
    "the implicit equations of a step have no solution; use smaller steps",
    "the implicit equations converge slowly, as they do with strong damping; use dop853",
)


@record
class Table:
    """A held value that follows a state periodically."""

    #: Index of the held value and of the state
    held: int
    state: int
    #: For each run, or one for all: breaks (k + 1,) from the start to the end of one period, and coefficients (terms,
    #: k) in the distance from the left break, highest power first, as in `scipy.interpolate.PPoly` [SI]
    polynomials: tuple[tuple[np.ndarray, np.ndarray], ...]


@record
class Level:
    """A level of a state at which a run ends."""

    state: int
    level: float | np.ndarray  #: shape (runs,): Its value there [SI]
    direction: int = 0  #: 1 rising, -1 falling, 0 either


@record
class Breaks:
    """Values of one state at which the equations are not smooth."""

    state: int
    angles: np.ndarray  #: shape (k,) or (runs, k): Within one period [rad]
    period: float  #: [rad]


@record
class Runs:
    """Runs to integrate, in one lane each."""

    #: (t, y, p) -> dy/dt; functions of a sequence may differ in their constants
    rhs: casadi.Function | Sequence[casadi.Function]
    start: np.ndarray  #: shape (n,) or (runs, n): States at the start [SI]
    #: shape (segments,) or (runs, segments): Ends of the segments, ascending; the last is the end of the run [s]
    until: np.ndarray
    t: float = 0.0  #: Time at the start [s]
    #: shape (segments, p) or (runs, segments, p): Held values in each segment; empty when there are none [SI]
    held: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros((1, 0)))
    #: shape (m,) or (runs, m): Wanted times after the start, ascending; fill up with infinity where a run has fewer [s]
    times: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(0))
    tables: tuple[Table, ...] = ()
    surfaces: tuple[Level, ...] = ()
    kinks: tuple[Breaks, ...] = ()  #: Where no step may reach across
    #: Relative and absolute tolerance of a step [-]
    rtol: float = 1e-10
    atol: float = 1e-10
    first_step: float = 0.0  #: First step of every segment; 0 lets the integrator choose [s]
    max_steps: int = 5_000_000  #: Limit of tries for each run


@record
class Outcome:
    """What came out of runs."""

    t: np.ndarray  #: shape (runs,): Where each ended [s]
    y: np.ndarray  #: shape (runs, n): State there [SI]
    #: shape (runs, m, n): States at the wanted times; those after the end of a run are not a number [SI]
    samples: np.ndarray
    #: shape (runs,): Steps accepted and thrown away [-]
    steps: np.ndarray
    rejected: np.ndarray
    met: np.ndarray  #: shape (runs,): Index of the surface that ended the run, or -1 [-]
    last_step: np.ndarray  #: shape (runs,): Last step that was not cut short [s]
    status: np.ndarray  #: shape (runs,): Index into `STATUS`: 0 and 1 are success [-]
