"""Integration in C: one run, or many side by side in the lanes of the processor and on its cores.

Runs of one right-hand side y' = f(t, y, p) differ in start, held values p, times and constants. A held value is
constant in a segment of time, or follows a state as a periodic piecewise polynomial (a pressure over the crank angle).
"""

import ctypes
import dataclasses
import functools
import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import casadi
import numpy as np

from mechsym.errors import BadInput
from mechsym.native import adams, cache, integrators
from mechsym.native.kernels import constant_table
from mechsym.native.runs import LastSteps, Outcome, Runs, structure
from mechsym.native.source import Program, program
from mechsym.native.tape import ANALYTIC
from mechsym.quantities import record

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
