"""What the integrators in C take and give: runs with their tables, levels and breaks, and the structure of c/run.h."""

import ctypes
import dataclasses
from collections.abc import Sequence

import casadi
import numpy as np

from mechsym.quantities import record
from mechsym.quantities.units import Array, Pure, Second

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
    #: k) in the distance from the left break, highest power first, as in `PPoly` [SI]
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
    #: Last steps whose dense output is kept, and how many of the first states; only steps of `dop853` are
    keep: int = 0
    kept_states: int = 0


@record
class LastSteps:
    """Dense output of the last steps of a run."""

    t: np.ndarray  #: shape (k,): Where each begins [s]
    step: np.ndarray  #: shape (k,): Its length [s]
    terms: np.ndarray  #: shape (8, n, k): Of the first states, see `ms_inside` in c/dop853.h [SI]

    def hold(self, times: Second[Array]) -> bool:
        """Whether ascending times lie within them."""
        return bool(len(self.t)) and self.t[0] <= times[0] and times[-1] <= (self.t[-1] + self.step[-1]) * (1 + 1e-12)

    def at(self, times: Second[Array]) -> np.ndarray:
        """The states at ascending times within them, shape (n, m) [SI]."""
        k = np.maximum(np.searchsorted(self.t, times, side="right") - 1, 0)
        u = (times - self.t[k]) / self.step[k]
        y = self.terms[7][:, k]
        for j in range(6, 0, -1):
            y = self.terms[j][:, k] + (1 - u if j % 2 else u) * y
        return self.terms[0][:, k] + u * y


@record
class Outcome:
    """What came out of runs."""

    t: np.ndarray  #: shape (runs,): Where each ended [s]
    y: np.ndarray  #: shape (runs, n): State there [SI]
    #: shape (runs, m, n): States at the wanted times up to the last that a run reached; those after the end of a run
    #: are not a number [SI]
    samples: np.ndarray
    #: shape (runs,): Steps accepted and thrown away [-]
    steps: np.ndarray
    rejected: np.ndarray
    met: np.ndarray  #: shape (runs,): Index of the surface that ended the run, or -1 [-]
    last_step: np.ndarray  #: shape (runs,): Last step that was not cut short [s]
    status: np.ndarray  #: shape (runs,): Index into `STATUS`: 0 and 1 are success [-]
    last: tuple[LastSteps, ...] = ()  #: Of each run, where they were to be kept


_LONGS = ("segments", "times", "tables", "surfaces", "kinks", "kinked", "keep", "kept_states", "max_steps")
_DOUBLES = ("rtol", "atol", "first_step")
_ARRAYS = (
    "constants", "until", "held", "grid", "kink_angles", "kink_periods", "kink_states", "kinked_states",
    "table", "surface", "t", "y", "samples", "kept", "last_step",
    "steps", "rejected", "sampled", "met", "status",
)  # fmt: skip


class _Table(ctypes.Structure):
    _fields_ = [
        *((name, ctypes.c_long) for name in ("slot", "state", "pieces", "terms")),
        *((name, ctypes.c_void_p) for name in ("breaks", "coefficients")),
    ]


class _Surface(ctypes.Structure):
    _fields_ = [("state", ctypes.c_long), ("direction", ctypes.c_long), ("level", ctypes.c_void_p)]


class _Run(ctypes.Structure):
    # the same fields in the same order as ms_run in c/run.h
    _fields_ = [
        *((name, ctypes.c_long) for name in _LONGS),
        *((name, ctypes.c_double) for name in _DOUBLES),
        *((name, ctypes.c_void_p) for name in _ARRAYS),
    ]


def structure(runs: Runs, arrays: dict[str, np.ndarray], chosen: Pure[Array]) -> tuple[_Run, list[object]]:
    """The argument of the C function, and what must stay alive with it. chosen: run of each lane, shape (lanes,)."""
    alive: list[object] = [arrays]
    known: dict[tuple[int, int], np.ndarray] = {}
    every = (_table(t, c, alive, known) for t in runs.tables for c in chosen)
    tables = (_Table * (len(runs.tables) * len(chosen)))(*every)
    surfaces = (_Surface * len(runs.surfaces))(*(_surface(s, chosen, alive) for s in runs.surfaces))
    alive += [tables, surfaces]
    structure = _Run(
        segments=len(arrays["until"]), times=arrays["grid"].shape[1], tables=len(runs.tables),
        surfaces=len(runs.surfaces), kinks=len(arrays["kink_angles"]), kinked=len(arrays["kinked_states"]),
        keep=runs.keep, kept_states=runs.kept_states, max_steps=runs.max_steps, rtol=runs.rtol, atol=runs.atol,
        first_step=runs.first_step,
        table=ctypes.addressof(tables), surface=ctypes.addressof(surfaces),
        **{name: a.ctypes.data for name, a in arrays.items()},
    )  # fmt: skip
    return structure, alive


def _table(table: Table, run: int, alive: list[object], known: dict[tuple[int, int], np.ndarray]) -> _Table:
    breaks, coefficients = table.polynomials[run if len(table.polynomials) > 1 else 0]
    breaks, terms = np.ascontiguousarray(breaks, dtype=float), max(len(c) for _, c in table.polynomials)
    rows = known.get((id(coefficients), terms))
    if rows is None:  # one polynomial after another, of as many terms in all runs; those that are alike read the same
        rows = np.zeros((coefficients.shape[1], terms))
        rows[:, terms - len(coefficients) :] = coefficients.T
        known[id(coefficients), terms] = rows
    alive += [breaks, rows]
    return _Table(
        slot=table.held,
        state=table.state,
        pieces=len(breaks) - 1,
        terms=rows.shape[1],
        breaks=breaks.ctypes.data,
        coefficients=rows.ctypes.data,
    )


def _surface(surface: Level, chosen: np.ndarray, alive: list[object]) -> _Surface:
    level = np.array(np.take(np.atleast_1d(surface.level), chosen, mode="clip"), dtype=float)
    alive.append(level)
    return _Surface(state=surface.state, direction=surface.direction, level=level.ctypes.data)
