"""Records of integrations in C: what to run, and what came out.

Runs of one right-hand side y' = f(t, y, p) differ in start, held values p, times and constants. A held value is
constant in a segment of time, or follows a state as a periodic piecewise polynomial (a pressure over the crank angle).
"""

import dataclasses
from collections.abc import Sequence

import casadi
import numpy as np

STATUS = (
    "done",
    "met a surface",
    "the number of steps was not enough; allow more steps or a larger tolerance",
    "the step became too small; the equations are not smooth there, or not finite",
    "the equations are not finite",
    "the implicit equations of a step have no solution; use smaller steps",
    "the implicit equations converge slowly, as they do with strong damping; use dop853",
)


@dataclasses.dataclass(frozen=True, kw_only=True)
class Table:
    """A held value that follows a state periodically.

    Parameters
    ----------
    held, state : int
        Index of the held value and of the state
    polynomials : tuple of (ndarray, ndarray)
        For each run, or one for all: breaks (k + 1,) from the start to the end of one period, and coefficients
        (terms, k) in the distance from the left break, highest power first, as in `scipy.interpolate.PPoly`
    """

    held: int
    state: int
    polynomials: tuple[tuple[np.ndarray, np.ndarray], ...]


@dataclasses.dataclass(frozen=True, kw_only=True)
class Surface:
    """A level of a state at which a run ends.

    Parameters
    ----------
    state : int
        Index of the state
    level : float or ndarray, shape (runs,)
        Its value there
    direction : int
        1 rising, -1 falling, 0 either
    """

    state: int
    level: float | np.ndarray
    direction: int = 0


@dataclasses.dataclass(frozen=True, kw_only=True)
class Kinks:
    """Values of one state at which the equations are not smooth.

    Parameters
    ----------
    state : int
        Index of the state
    angles : ndarray, shape (k,) or (runs, k)
        Within one period
    period : float
        After which they repeat
    """

    state: int
    angles: np.ndarray
    period: float


@dataclasses.dataclass(frozen=True, kw_only=True)
class Runs:
    """Runs to integrate, in one lane each.

    Parameters
    ----------
    rhs : casadi.Function, or a sequence of one for each run
        (t, y, p) -> dy/dt; functions of a sequence may differ in their constants
    start : ndarray, shape (n,) or (runs, n)
        States at the start
    t : float
        Time at the start [s]
    until : ndarray, shape (segments,) or (runs, segments)
        Ends of the segments, ascending; the last is the end of the run [s]
    held : ndarray, shape (segments, p) or (runs, segments, p)
        Held values in each segment; empty when there are none
    times : ndarray, shape (m,) or (runs, m)
        Wanted times after the start, ascending; fill up with infinity where a run has fewer [s]
    tables, surfaces : tuple of Table, of Surface
        See there
    kinks : tuple of Kinks
        Where no step may reach across
    rtol, atol : float
        Relative and absolute tolerance of a step [-]
    first_step : float
        First step of every segment; 0 lets the integrator choose [s]
    max_steps : int
        Limit of tries for each run
    """

    rhs: casadi.Function | Sequence[casadi.Function]
    start: np.ndarray
    until: np.ndarray
    t: float = 0.0
    held: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros((1, 0)))
    times: np.ndarray = dataclasses.field(default_factory=lambda: np.zeros(0))
    tables: tuple[Table, ...] = ()
    surfaces: tuple[Surface, ...] = ()
    kinks: tuple[Kinks, ...] = ()
    rtol: float = 1e-10
    atol: float = 1e-10
    first_step: float = 0.0
    max_steps: int = 5_000_000


@dataclasses.dataclass(frozen=True, kw_only=True)
class Outcome:
    """What came out of runs.

    Parameters
    ----------
    t : ndarray, shape (runs,)
        Where each ended [s]
    y : ndarray, shape (runs, n)
        State there
    samples : ndarray, shape (runs, m, n)
        States at the wanted times; those after the end of a run are not a number
    steps, rejected : ndarray, shape (runs,)
        Steps accepted and thrown away
    met : ndarray, shape (runs,)
        Index of the surface that ended the run, or -1
    last_step : ndarray, shape (runs,)
        Last step that was not cut short [s]
    status : ndarray, shape (runs,)
        Index into `STATUS`: 0 and 1 are success
    """

    t: np.ndarray
    y: np.ndarray
    samples: np.ndarray
    steps: np.ndarray
    rejected: np.ndarray
    met: np.ndarray
    last_step: np.ndarray
    status: np.ndarray
