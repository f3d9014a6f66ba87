"""Integration in C: one run, or many side by side in the lanes of the processor and on its cores."""

import ctypes
import dataclasses
import functools
import os
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import casadi
import numpy as np

from mechsym.errors import BadInput
from mechsym.native import adams, integrators, library
from mechsym.native.kernels import constant_table
from mechsym.native.layout import structure
from mechsym.native.runs import Outcome, Runs
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

    Parameters
    ----------
    method : str
        `dop853`: adaptive steps of order 8, a run in each lane. `collocation`: adaptive steps of order 16, each run in
        all lanes, for equations without kinks and tables. `auto`: `collocation` for few runs of analytic equations, as
        long as it converges fast, else `dop853`. `gauss`: Gauss-Legendre, 4 stages, order 8, equal steps of at most
        `first_step`, for conservative runs without kinks and surfaces. `adams`: steps of order 11 that look back, a run
        in each lane, along the arc lengths of its angles; `auto` takes it for long smooth ensembles with few wanted
        times

    Returns
    -------
    outcome : Outcome
        One row for each run; a failure is a status

    Raises
    ------
    mechsym.native.compiler.NoCompiler
        No compiler; `mechsym.simulate` then goes on with scipy
    """
    batch = _spread(runs, mode)
    if method == "auto":
        method = _chosen(batch, mode)
        found = _integrated(batch, method, mode)
        return _integrated(batch, "dop853", mode) if np.isin(found.status, _UNSOLVED).any() else found
    return _integrated(batch, method, mode)


def _integrated(batch: _Batch, method: str, mode: str) -> Outcome:
    count = len(batch.start)
    lanes, together = _shape(batch, method, count)
    texts, batch = _texts(batch, method, lanes, mode)
    loaded = {text: library.load(text, mode) for text in dict.fromkeys(texts)}
    blocks = _blocks(texts if len(texts) > 1 else texts * count, together)
    result = _empty(count, batch.start.shape[1], batch.times.shape[1])

    def work(block: tuple[str, list[int]]) -> None:
        _run_block(loaded[block[0]][f"ms_{method}"], batch, block[1], lanes, result)

    if len(blocks) == 1:
        work(blocks[0])
    else:
        with ThreadPoolExecutor(max_workers=min(len(blocks), os.cpu_count() or 1)) as pool:
            list(pool.map(work, blocks))
    return Outcome(**result)


def _texts(batch: _Batch, method: str, lanes: int, mode: str) -> tuple[list[str], _Batch]:
    """The C file of each function, and the batch with the constants that it reads."""
    if method != "adams":
        followed = tuple(sorted({t.state for t in batch.runs.tables})) if method == "dop853" else ()
        return [_text(p, method, lanes, *([followed] if followed else [])) for p in batch.programs], batch
    made, rates = _looking_back(batch, mode), batch.programs[0]
    if made is None:
        raise BadInput(
            "method 'adams' takes runs of one smooth function, in which an inertia depends on its own angle only and "
            "surfaces are of angles and speeds; use dop853"
        )
    return [adams.text(rates, lanes, made)], dataclasses.replace(batch, constants=adams.constants(rates, made))


def _looking_back(batch: _Batch, mode: str) -> adams.LookingBack | None:
    """What `adams` needs, where it can be taken."""
    runs = batch.runs
    if runs.tables or runs.kinks or len(batch.programs) > 1:
        return None
    functions: Any = runs.rhs
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
    made = _looking_back(batch, mode)
    return "adams" if made and len(made.parts.form.angles) <= _MOST_ANGLES and not made.parts.form.read else "dop853"


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
            _check_gauss(batch)
            return lanes, lanes
    raise BadInput(f"method = {method!r} is not an option; options are auto, dop853, collocation, adams, gauss")


def _check_gauss(batch: _Batch) -> None:
    runs = batch.runs
    if runs.surfaces or runs.kinks:
        raise BadInput("method 'gauss' knows no surfaces and kinks; use dop853")
    if not runs.first_step > 0:
        raise BadInput("method 'gauss' needs first_step, its constant step in s")
    if not (batch.until == batch.until[0]).all():
        raise BadInput("method 'gauss' takes one list of segment ends for all runs; use dop853")


def _spread(runs: Runs, mode: str) -> _Batch:
    if not (runs.rtol >= 0 and runs.atol > 0):
        raise BadInput(
            f"rtol = {runs.rtol:g}, atol = {runs.atol:g}: atol must be above 0, because states pass through 0"
        )
    single = isinstance(runs.rhs, casadi.Function)
    functions: list[Any] = [runs.rhs] if single else list(runs.rhs)  # type: ignore[arg-type]
    programs = [program(f, mode) for f in functions]
    n, p = integrators.sizes(programs[0])
    arrays: dict[str, tuple[Any, int]] = {
        "start": (runs.start, 1),
        "until": (runs.until, 1),
        "held": (runs.held, 2),
        "times": (runs.times, 1),
    }
    arrays["kinks"] = (_side_by_side([k.angles for k in runs.kinks]), 1)
    found = {name: np.asarray(value, float) for name, (value, _) in arrays.items()}
    counts = {len(found[name]) for name, (_, alone) in arrays.items() if found[name].ndim > alone}
    counts |= set() if single else {len(functions)}
    if len(counts) > 1:
        raise BadInput(f"start, until, held, times and rhs are for {sorted(counts)} runs; they must agree")
    count, segments = counts.pop() if counts else 1, found["until"].shape[-1]
    if not p:
        found["held"] = np.zeros((segments, 0))
    if found["start"].shape[-1] != n or found["held"].shape[-2:] != (segments, p):
        raise BadInput(
            f"{programs[0].tape.name} has {n} states and {p} held values in {segments} segments; start has shape "
            f"{found['start'].shape}, held {found['held'].shape}"
        )
    spread = {name: np.broadcast_to(a, (count, *a.shape[-arrays[name][1] :])) for name, a in found.items()}
    constants = [constant_table(q.kernels) for q in programs]
    return _Batch(runs=runs, programs=programs, constants=constants, **spread)


@functools.lru_cache(maxsize=256)
def _text(of: Program, method: str, lanes: int, *followed: tuple[int, ...]) -> str:
    return getattr(integrators, method)(of, lanes, *followed)


def _side_by_side(angles: list[np.ndarray]) -> np.ndarray:
    """Angles (k,) or (runs, k) of several states as one array (k,) or (runs, k)."""
    rows = np.broadcast_shapes(*(np.shape(a)[:-1] for a in angles))
    return np.concatenate([np.zeros((*rows, 0)), *(np.broadcast_to(a, (*rows, np.shape(a)[-1])) for a in angles)], -1)


def _blocks(texts: list[str], lanes: int) -> list[tuple[str, list[int]]]:
    families: dict[str, list[int]] = {}
    for index, text in enumerate(texts):
        families.setdefault(text, []).append(index)
    return [(text, members[i : i + lanes]) for text, members in families.items() for i in range(0, len(members), lanes)]


def _empty(count: int, n: int, times: int) -> dict[str, np.ndarray]:
    whole = {name: np.zeros(count, dtype=int) for name in ("steps", "rejected", "met", "status")}
    # each state of a run lies in one piece, as it is looked at
    samples = np.empty((count, n, times)).swapaxes(1, 2)
    return {**whole, "t": np.zeros(count), "y": np.zeros((count, n)), "samples": samples, "last_step": np.zeros(count)}


def _run_block(advance: Any, batch: _Batch, members: list[int], lanes: int, result: dict[str, np.ndarray]) -> None:
    # an incomplete block is filled up with copies of its last run
    chosen = np.array(members + [members[-1]] * (lanes - len(members)))
    arrays = _arrays(batch, chosen)
    arrays["samples"] = np.array([result["samples"][run].ctypes.data for run in chosen], dtype=np.uintp)
    argument, alive = structure(batch.runs, arrays, chosen)
    advance(ctypes.byref(argument))
    del alive
    used = slice(0, len(members))
    result["y"][members] = arrays["y"].T[used]
    for run, count in zip(members, arrays["sampled"], strict=False):
        result["samples"][run, count:] = np.nan
    for name in ("t", "last_step", "steps", "rejected", "met", "status"):
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
