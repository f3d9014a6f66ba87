"""Marching a recurrence over stages for many lanes side by side: an engine cycle over crank angles at many speeds."""

import ctypes
import logging
from collections.abc import Callable

import casadi
import numpy as np

from mechsym.errors import BadInput
from mechsym.native import emit, fallback, library
from mechsym.native.compiler import NoCompiler
from mechsym.native.kernels import constant_table, whole
from mechsym.native.source import Program, header, preamble, program

_LOG = logging.getLogger("mechsym.native")


March = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def marcher(step: casadi.Function, mode: str = "fast") -> March:
    r"""A function that marches lanes through stages.

    .. math:: x_{k+1} = f(x_k, s_k, z), \qquad r_k = g(x_k, s_k, z)

    Parameters
    ----------
    step : casadi.Function
        (state, stage, lane) -> state, or state and record

    Returns
    -------
    march : callable
        start (states, n), stages (k, values), lanes (values, n) -> state after the last stage (states, n) and what
        every stage recorded (k, records, n). Stage values are the same in all lanes, lane values in all stages; the
        callable raises BadInput for arrays that do not fit

    Raises
    ------
    BadInput
        The function is no step
    """
    sizes, found = _sizes(step), program(step, mode)
    try:
        advance = _compiled(found, sizes, mode)
    except NoCompiler as error:
        _LOG.warning("numpy instead of C: %s", error)
        advance = _interpreted(found)

    def march(start: np.ndarray, stages: np.ndarray, lanes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        state = np.array(start, dtype=float, order="C")
        stages, lanes = (np.ascontiguousarray(a, dtype=float) for a in (stages, lanes))
        if state.ndim != 2 or (len(state), stages.shape[1], len(lanes)) != sizes or lanes.shape[1:] != state.shape[1:]:
            raise BadInput(
                f"{step.name()} takes {sizes[0]} states, {sizes[1]} stage values and {sizes[2]} lane values; start has "
                f"shape {state.shape}, stages {stages.shape}, lanes {lanes.shape}"
            )
        record = np.empty((len(stages), len(found.tape.outputs) - sizes[0], state.shape[1]))
        advance(state, stages, lanes, record)
        return state, record

    return march


def _compiled(found: Program, sizes: tuple[int, int, int], mode: str) -> Callable[..., None]:
    loaded, constants = library.load(text(found, sizes), mode), constant_table((whole(found.tape),))

    def advance(state: np.ndarray, stages: np.ndarray, lanes: np.ndarray, record: np.ndarray) -> None:
        places = [ctypes.c_void_p(a.ctypes.data) for a in (constants, stages, lanes, state, record)]
        loaded.ms_march(ctypes.c_long(len(stages)), ctypes.c_long(state.shape[1]), *places)

    return advance


def _interpreted(found: Program) -> Callable[..., None]:
    run = fallback.numpy_function(found.tape)

    def advance(state: np.ndarray, stages: np.ndarray, lanes: np.ndarray, record: np.ndarray) -> None:
        following = np.empty_like(state)
        with np.errstate(all="ignore"):
            for values, kept in zip(stages, record, strict=True):
                run([*state, *values, *lanes], [*following, *kept])
                state[:] = following

    return advance


def text(found: Program, sizes: tuple[int, int, int]) -> str:
    """A file that exports `ms_march` for a step.

    Parameters
    ----------
    sizes : tuple of int
        Numbers of states, stage values, lane values
    """
    name, kernel = found.tape.name, whole(found.tape)
    states, stages, lanes = sizes
    records = len(found.tape.outputs) - states
    return "\n".join(
        [
            preamble(),
            emit.bodies((kernel,), name),
            "enum { MS_W = 64 };",
            emit.stage(kernel, name, sizes),
            f"enum {{ MS_NS = {states}, MS_NK = {stages}, MS_NL = {lanes}, MS_NR = {records} }};",
            f"#define MS_NAME {name}",
            header("march.h"),
        ]
    )


def _sizes(step: casadi.Function) -> tuple[int, int, int]:
    if step.n_in() != 3 or step.n_out() not in (1, 2) or step.numel_out(0) != step.numel_in(0):
        raise BadInput(
            f"{step.name()} is no step: it must take (state, stage, lane) and return (state) or (state, record)"
        )
    return step.numel_in(0), step.numel_in(1), step.numel_in(2)
