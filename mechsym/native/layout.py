"""The argument of an integrator in C: runs as `ms_run` of c/run.h describes them."""

import ctypes
from typing import Any

import numpy as np

from mechsym.native.runs import Level, Runs, Table

_LONGS = ("segments", "times", "tables", "surfaces", "kinks", "kinked", "max_steps")
_DOUBLES = ("rtol", "atol", "first_step")
_ARRAYS = (
    "constants", "until", "held", "grid", "kink_angles", "kink_periods", "kink_states", "kinked_states",
    "table", "surface", "t", "y", "samples", "last_step",
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


def structure(runs: Runs, arrays: dict[str, np.ndarray], chosen: np.ndarray) -> tuple[_Run, list[Any]]:
    """The argument of the C function, and what must stay alive as long as it is used.

    Parameters
    ----------
    chosen : ndarray, shape (lanes,)
        Run of each lane [-]
    """
    alive: list[Any] = [arrays]
    tables = (_Table * (len(runs.tables) * len(chosen)))(*(_table(t, c, alive) for t in runs.tables for c in chosen))
    surfaces = (_Surface * len(runs.surfaces))(*(_surface(s, chosen, alive) for s in runs.surfaces))
    alive += [tables, surfaces]
    structure = _Run(
        segments=len(arrays["until"]), times=arrays["grid"].shape[1], tables=len(runs.tables),
        surfaces=len(runs.surfaces), kinks=len(arrays["kink_angles"]), kinked=len(arrays["kinked_states"]),
        max_steps=runs.max_steps, rtol=runs.rtol, atol=runs.atol, first_step=runs.first_step,
        table=ctypes.addressof(tables), surface=ctypes.addressof(surfaces),
        **{name: a.ctypes.data for name, a in arrays.items()},
    )  # fmt: skip
    return structure, alive


def _table(table: Table, run: int, alive: list[Any]) -> _Table:
    breaks, coefficients = table.polynomials[run if len(table.polynomials) > 1 else 0]
    breaks = np.ascontiguousarray(breaks, dtype=float)
    # one polynomial after another, as the C code reads them
    rows = np.ascontiguousarray(coefficients.T, dtype=float)
    alive += [breaks, rows]
    return _Table(
        slot=table.held, state=table.state, pieces=len(breaks) - 1, terms=rows.shape[1], breaks=breaks.ctypes.data,
        coefficients=rows.ctypes.data,
    )  # fmt: skip


def _surface(surface: Level, chosen: np.ndarray, alive: list[Any]) -> _Surface:
    level = np.array(np.take(np.atleast_1d(surface.level), chosen, mode="clip"), dtype=float)
    alive.append(level)
    return _Surface(state=surface.state, direction=surface.direction, level=level.ctypes.data)
