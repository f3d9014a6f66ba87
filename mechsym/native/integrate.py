"""Integration in C: one run, or many side by side in the lanes of the processor and on its cores.

Runs of one right-hand side y' = f(t, y, p) differ in start, held values p, times and constants. A held value is
constant in a segment of time, or follows a state as a periodic piecewise polynomial (a pressure over the crank angle).
"""

import ctypes
import dataclasses
import functools
import os
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor

import casadi
import numpy as np

from mechsym.errors import BadInput
from mechsym.native import adams, cache, integrators
from mechsym.native.kernels import constant_table
from mechsym.native.source import Program, program
from mechsym.native.tape import ANALYTIC
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
    #: Last steps whose dense output is kept, and how many of the first states; only steps of `dop853` are
    keep: int = 0
    kept_states: int = 0


@record
class LastSteps:
    """Dense output of the last steps of a run."""

    t: np.ndarray  #: shape (k,): Where each begins [s]
    step: np.ndarray  #: shape (k,): Its length [s]
    terms: np.ndarray  #: shape (8, n, k): Of the first states, see `ms_inside` in c/dop853.h [SI]

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
    known: dict[int, np.ndarray] = {}
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


def _table(table: Table, run: int, alive: list[object], known: dict[int, np.ndarray]) -> _Table:
    breaks, coefficients = table.polynomials[run if len(table.polynomials) > 1 else 0]
    breaks = np.ascontiguousarray(breaks, dtype=float)
    # one polynomial after another, as the C code reads them; runs and cylinders that are alike read the same
    rows = known.setdefault(id(coefficients), np.ascontiguousarray(coefficients.T, dtype=float))
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


# runs in one block of an ensemble: one vector register of doubles, or two, which wait less for each other
LANES = (1, 8, 16)
# Runs that one by one, in all lanes, take less time than side by side in one lane each. Two start-ups: 5.4 against
# 7.1 ms at 1e-8. Three: 8.7 against 6.8 at 1e-8, 20.9 against 18.3 at 1e-10 with results, 11.2 against 16.6 at 1e-12.
_FEW, _FEW_TIGHT, _TIGHT = 2, 3, 1e-11
# Where steps that look back win: 16 start-ups of 99 s take 3.1 against 4.4 ms each at 1e-8, 6.0 against 12.2 at 1e-12,
# with 236 wanted times a second 8.4 against 8.1 and 11.4 against 19.3, at no larger error (a quarter of it at 1e-8);
# three angles with damping the same.
_MOST_ANGLES = 2
_UNSOLVED = (5, 6)  # indices into STATUS: what explicit steps may still do


@record
class _Batch:
    """Runs with every array spread to shape (runs, ..), and the program of each."""

    runs: Runs
    programs: list[Program]
    #: in the units of the program, as in `Runs` [SI]
    constants: list[np.ndarray]
    start: np.ndarray
    until: np.ndarray
    held: np.ndarray
    times: np.ndarray
    kinks: np.ndarray


def integrate(runs: Runs, method: str = "auto", mode: str = "fast") -> Outcome:
    """Integrate runs in C.

    Returns outcome: one row for each run; a failure is a status.

    method: `dop853`: adaptive steps of order 8, a run in each lane. `collocation`: adaptive steps of order 16, each run
    in all lanes, for equations without kinks and tables. `auto`: `collocation` for few runs of analytic equations, as
    long as it converges fast, else `dop853`. `gauss`: Gauss-Legendre, 4 stages, order 8, equal steps of at most
    `first_step`, for conservative runs without kinks and surfaces. `adams`: steps of order 11 that look back, a run in
    each lane, along the arc lengths of its angles; `auto` takes it for long smooth ensembles with few wanted times.
    Raises mechsym.native.compiler.NoCompiler: no compiler; `mechsym.simulate` then goes on with scipy.
    """
    batch = _spread(runs, mode)
    if method == "auto":
        outcome = _integrated(batch, _chosen(batch, mode), mode)
        return _integrated(batch, "dop853", mode) if np.isin(outcome.status, _UNSOLVED).any() else outcome
    return _integrated(batch, method, mode)


def _integrated(batch: _Batch, method: str, mode: str) -> Outcome:
    count = len(batch.start)
    lanes, together = _shape(batch, method, count)
    texts, batch = _texts(batch, method, lanes, mode)
    loaded = {text: cache.load(text, mode) for text in dict.fromkeys(texts)}
    families: dict[str, list[int]] = {}
    for index, text in enumerate(texts if len(texts) > 1 else texts * count):
        families.setdefault(text, []).append(index)
    blocks = []
    for text, members in families.items():
        blocks += [(text, members[i : i + together]) for i in range(0, len(members), together)]
    result: dict[str, np.ndarray] = {
        name: np.zeros(count, dtype=int) for name in ("steps", "rejected", "sampled", "met", "status")
    }
    n, times = batch.start.shape[1], batch.times.shape[1]
    result |= {"t": np.zeros(count), "y": np.zeros((count, n)), "last_step": np.zeros(count)}
    result["samples"] = np.empty((count, times, n))
    if method != "dop853" and batch.runs.keep:
        batch = dataclasses.replace(batch, runs=dataclasses.replace(batch.runs, keep=0))
    result["kept"] = np.empty((count, batch.runs.keep, 2 + 8 * batch.runs.kept_states))

    def work(block: tuple[str, list[int]]) -> None:
        _run_block(loaded[block[0]][f"ms_{method}"], batch, block[1], lanes, result)

    if len(blocks) == 1:
        work(blocks[0])
    else:
        with ThreadPoolExecutor(max_workers=min(len(blocks), os.cpu_count() or 1)) as pool:
            list(pool.map(work, blocks))
    sampled, kept = result.pop("sampled"), result.pop("kept")
    result["samples"] = result["samples"][:, : sampled.max(initial=0)]
    for run, reached in enumerate(sampled):
        result["samples"][run, reached:] = np.nan
    last = (_last(rows, steps) for rows, steps in zip(kept, result["steps"], strict=True) if batch.runs.keep)
    return Outcome(**result, last=tuple(last))


def _last(rows: np.ndarray, steps: int) -> LastSteps:
    """The last of so many steps, of the ring that they were written into."""
    keep = len(rows)
    rows = rows[:steps] if steps <= keep else np.roll(rows, -(steps % keep), axis=0)
    return LastSteps(t=rows[:, 0], step=rows[:, 1], terms=rows[:, 2:].reshape(len(rows), 8, -1).transpose(1, 2, 0))


def _texts(batch: _Batch, method: str, lanes: int, mode: str) -> tuple[list[str], _Batch]:
    """The C file of each function, and the batch with the constants that it reads."""
    if method != "adams":
        followed = tuple(sorted({t.state for t in batch.runs.tables})) if method == "dop853" else ()
        return [_text(p, method, lanes, *([followed] if followed else [])) for p in batch.programs], batch
    back, rates = _looking_back(batch, mode), batch.programs[0]
    if back is None:
        raise BadInput(
            "method 'adams' takes runs of one smooth function, in which an inertia depends on its own angle only and "
            "surfaces are of angles and speeds; use dop853"
        )
    return [adams.text(rates, lanes, back)], dataclasses.replace(batch, constants=adams.constants(rates, back))


def _looking_back(batch: _Batch, mode: str) -> adams.LookingBack | None:
    """What `adams` needs, where it can be taken."""
    runs = batch.runs
    if runs.tables or runs.kinks or len(batch.programs) > 1:
        return None
    functions = runs.rhs
    rates = functions if isinstance(functions, casadi.Function) else functions[0]
    return adams.ready(rates, batch.held, {s.state for s in runs.surfaces}, mode)


def _chosen(batch: _Batch, mode: str) -> str:
    """The faster method that is safe: long steps of high order need rates with all derivatives."""
    analytic = all({op for op, _ in p.tape.nodes} <= ANALYTIC for p in batch.programs)
    smooth = analytic and not batch.runs.tables and not batch.runs.kinks
    few = _FEW_TIGHT if batch.runs.rtol < _TIGHT else _FEW
    if smooth and len(batch.start) <= few:
        return "collocation"
    if not smooth or mode != "fast":
        return "dop853"
    back = _looking_back(batch, mode)
    return "adams" if back and len(back.parts.form.angles) <= _MOST_ANGLES and not back.parts.form.read else "dop853"


def _shape(batch: _Batch, method: str, count: int) -> tuple[int, int]:
    """Lanes of a block, and how many runs lie in them."""
    runs, lanes = batch.runs, next((n for n in LANES if n >= count), LANES[-1])
    match method:
        case "dop853" | "adams":
            return lanes, lanes
        case "collocation":
            if runs.kinks or runs.tables:
                raise BadInput("method 'collocation' knows no kinks and tables; use dop853")
            return integrators.STAGES, 1
        case "gauss":
            if runs.surfaces or runs.kinks:
                raise BadInput("method 'gauss' knows no surfaces and kinks; use dop853")
            if not runs.first_step > 0:
                raise BadInput("method 'gauss' needs first_step, its constant step in s")
            if not (batch.until == batch.until[0]).all():
                raise BadInput("method 'gauss' takes one list of segment ends for all runs; use dop853")
            return lanes, lanes
    raise BadInput(f"method = {method!r} is not an option; options are auto, dop853, collocation, adams, gauss")


def _spread(runs: Runs, mode: str) -> _Batch:
    if not (runs.rtol >= 0 and runs.atol > 0):
        raise BadInput(
            f"rtol = {runs.rtol:g}, atol = {runs.atol:g}: atol must be above 0, because states pass through 0"
        )
    single = isinstance(runs.rhs, casadi.Function)
    functions = [runs.rhs] if isinstance(runs.rhs, casadi.Function) else list(runs.rhs)
    programs = [program(f, mode) for f in functions]
    n, p = integrators.sizes(programs[0])
    # angles (k,) or (runs, k) of several kinks side by side
    angles = [np.asarray(k.angles, float) for k in runs.kinks]
    rows = np.broadcast_shapes(*(a.shape[:-1] for a in angles))
    kinks = np.concatenate([np.zeros((*rows, 0)), *(np.broadcast_to(a, (*rows, a.shape[-1])) for a in angles)], -1)
    whole = {"start": runs.start, "until": runs.until, "held": runs.held, "times": runs.times, "kinks": kinks}
    arrays = {name: np.asarray(value, float) for name, value in whole.items()}
    alone = {name: 2 if name == "held" else 1 for name in arrays}  # dimensions of what is for one run
    counts = {len(a) for name, a in arrays.items() if a.ndim > alone[name]}
    counts |= set() if single else {len(functions)}
    if len(counts) > 1:
        raise BadInput(f"start, until, held, times and rhs are for {sorted(counts)} runs; they must agree")
    count, segments = counts.pop() if counts else 1, arrays["until"].shape[-1]
    if not p:
        arrays["held"] = np.zeros((segments, 0))
    if arrays["start"].shape[-1] != n or arrays["held"].shape[-2:] != (segments, p):
        raise BadInput(
            f"{programs[0].tape.name} has {n} states and {p} held values in {segments} segments; start has shape "
            f"{arrays['start'].shape}, held {arrays['held'].shape}"
        )
    spread = {name: np.broadcast_to(a, (count, *a.shape[-alone[name] :])) for name, a in arrays.items()}
    constants = [constant_table(q.kernels) for q in programs]
    return _Batch(runs=runs, programs=programs, constants=constants, **spread)


@functools.lru_cache(maxsize=256)
def _text(of: Program, method: str, lanes: int, *followed: tuple[int, ...]) -> str:
    return getattr(integrators, method)(of, lanes, *followed)


def _run_block(
    advance: Callable[[object], int], batch: _Batch, members: list[int], lanes: int, result: dict[str, np.ndarray]
) -> None:
    # an incomplete block is filled up with copies of its last run
    chosen = np.array(members + [members[-1]] * (lanes - len(members)))
    arrays = _arrays(batch, chosen)
    for name in ("samples", "kept"):
        arrays[name] = np.array([result[name][run].ctypes.data for run in chosen], dtype=np.uintp)
    argument, alive = structure(batch.runs, arrays, chosen)
    advance(ctypes.byref(argument))
    del alive
    used = slice(0, len(members))
    result["y"][members] = arrays["y"].T[used]
    for name in ("t", "last_step", "steps", "rejected", "sampled", "met", "status"):
        result[name][members] = arrays[name][used]


def _arrays(batch: _Batch, chosen: np.ndarray) -> dict[str, np.ndarray]:
    lanes = len(chosen)
    constants = batch.constants if len(batch.constants) > 1 else batch.constants * len(batch.start)
    # a value for each kink
    periods = np.array([k.period for k in batch.runs.kinks for _ in range(np.shape(k.angles)[-1])])
    states = np.array([k.state for k in batch.runs.kinks for _ in range(np.shape(k.angles)[-1])], ctypes.c_long)
    counters = {name: np.zeros(lanes, ctypes.c_long) for name in ("steps", "rejected", "sampled", "met", "status")}
    counters |= {"kink_states": states, "kinked_states": np.array(sorted(set(states)), ctypes.c_long)}
    floats = {
        "constants": np.stack([constants[c] for c in chosen], axis=1),
        "until": batch.until[chosen].T,
        "held": np.moveaxis(batch.held[chosen], 0, 2),
        "grid": batch.times[chosen],
        "kink_angles": np.mod(batch.kinks[chosen].T, periods[:, None]),
        "kink_periods": periods,
        "t": np.full(lanes, float(batch.runs.t)),
        "y": batch.start[chosen].T,
        "last_step": np.zeros(lanes),
    }
    # always a copy: the runs are written into t and y
    return {name: np.array(a, dtype=float, order="C") for name, a in floats.items()} | counters
