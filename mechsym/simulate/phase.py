"""The one task of a backend: integrate a smooth phase, stop at the first surface it meets, return wanted points."""

from dataclasses import dataclass

import numpy as np

from mechsym.simulate.equations import System


@dataclass(frozen=True, kw_only=True)
class Surface:
    """A level of one state at which a phase ends.

    Parameters
    ----------
    state : int
        Index of the state
    level : float
        Its value there
    direction : int
        1 rising, -1 falling, 0 either
    """

    state: int
    level: float
    direction: int


@dataclass(frozen=True, kw_only=True)
class Span:
    """An interval of one coordinate beyond which callables must not be asked in a phase.

    Parameters
    ----------
    state : int
        Index of the coordinate
    low, high : float
        Its ends, just inside the kinks
    """

    state: int
    low: float
    high: float


@dataclass(frozen=True, kw_only=True)
class Phase:
    """A stretch of time in which the equations are smooth.

    Parameters
    ----------
    system : System
        Equations
    t_start, t_end : float
        Where it begins, and ends at the latest [s]
    y : ndarray, shape (m,)
        State at its start
    w : ndarray, shape (k,)
        Held values
    surfaces : tuple of Surface
        The first that is met ends the phase
    spans : tuple of Span
        Where callables may be asked
    times : ndarray, shape (n,)
        Wanted times in (t_start, t_end] [s]
    tolerance : float
        Relative and absolute tolerance of a step [-]
    first_step : float or None
        Step to begin with [s]
    max_steps : int
        Limit of accepted steps
    """

    system: System
    t_start: float
    t_end: float
    y: np.ndarray
    w: np.ndarray
    surfaces: tuple[Surface, ...] = ()
    spans: tuple[Span, ...] = ()
    times: np.ndarray
    tolerance: float
    first_step: float | None = None
    max_steps: int = 5_000_000


@dataclass(frozen=True, kw_only=True)
class Leg:
    """What came out of a phase.

    Parameters
    ----------
    t : float
        Where it ended [s]
    y : ndarray, shape (m,)
        State there
    samples : ndarray, shape (n, m)
        States at the wanted times up to t
    steps : int
        Accepted steps
    met : int or None
        Index of the surface that ended it
    step : float or None
        Last step, a hint for the next phase [s]
    failure : str
        Empty, or why it could not go on
    """

    t: float
    y: np.ndarray
    samples: np.ndarray
    steps: int
    met: int | None = None
    step: float | None = None
    failure: str = ""


@dataclass(frozen=True, kw_only=True)
class Raw:
    """A whole run before it is audited.

    Parameters
    ----------
    t : ndarray, shape (n,)
        Start, wanted times up to the end, and the end [s]
    y : ndarray, shape (n, m)
        States there
    steps : int
        Accepted steps
    end : str
        `t_end`, `turns`, the name of a stop, or `failure`
    failure : str
        Empty, or why it could not go on
    """

    t: np.ndarray
    y: np.ndarray
    steps: int
    end: str
    failure: str
