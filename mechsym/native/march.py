"""Marching a recurrence over stages for many lanes side by side: an engine cycle over crank angles at many speeds."""

import ctypes
import logging
from collections.abc import Callable

import casadi
import numpy as np

from mechsym.errors import BadInput
from mechsym.native import cache, fallback, source
from mechsym.native.compiler import NoCompiler
from mechsym.native.kernels import constant_table, cut, whole
from mechsym.native.source import header, preamble, program
from mechsym.native.tape import CHEAP, NUMPY, Tape

_LOG = logging.getLogger("mechsym.native")
# gcc then puts chains that do not wait for each other side by side: of a march it takes 8 and 17 % off at 97 and 116
# nodes, and adds 7 % at 211, because the registers no longer hold what is begun
_SHORT = 150
_SCHEDULED = '#if defined(__GNUC__) && !defined(__clang__)\n#pragma GCC optimize("schedule-insns")\n#endif'

March = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def marcher(step: casadi.Function, mode: str = "fast") -> March:
    r"""A function that marches lanes through stages.

    .. math:: x_{k+1} = f(x_k, s_k, z), \qquad r_k = g(x_k, s_k, z)

    step: (state, stage, lane) -> state, or state and record.

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
    if step.n_in() != 3 or step.n_out() not in (1, 2) or step.numel_out(0) != step.numel_in(0):
        raise BadInput(
            f"{step.name()} is no step: it must take (state, stage, lane) and return (state) or (state, record)"
        )
    sizes = step.numel_in(0), step.numel_in(1), step.numel_in(2)
    tape = program(step, mode).tape
    once, turn = separated(tape, sizes)
    try:
        advance = _compiled(turn, sizes, mode)
    except NoCompiler as error:
        _LOG.warning("numpy instead of C: %s", error)
        advance = _interpreted(turn)
    before = fallback.numpy_function(once)

    def march(start: np.ndarray, stages: np.ndarray, lanes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        state = np.array(start, dtype=float, order="C")
        stages, lanes = (np.ascontiguousarray(a, dtype=float) for a in (stages, lanes))
        if state.ndim != 2 or (len(state), stages.shape[1], len(lanes)) != sizes or lanes.shape[1:] != state.shape[1:]:
            raise BadInput(
                f"{step.name()} takes {sizes[0]} states, {sizes[1]} stage values and {sizes[2]} lane values; start has "
                f"shape {state.shape}, stages {stages.shape}, lanes {lanes.shape}"
            )
        record = np.empty((len(stages), len(tape.outputs) - sizes[0], state.shape[1]))
        known = np.empty((len(once.outputs), state.shape[1]))
        with np.errstate(all="ignore"):
            before([None] * (sizes[0] + sizes[1]) + [*lanes], known)
        advance(state, stages, np.concatenate([lanes, known]), record)
        return state, record

    return march


def separated(tape: Tape, sizes: tuple[int, int, int]) -> tuple[Tape, Tape]:
    """What a lane's own values decide, to be computed once, and the step, which takes it as further lane values.

    sizes: numbers of states, stage values, lane values.
    """
    # whether a node is the lane's own, and whether it is worth a place in memory
    own: list[bool] = []
    dear: list[bool] = []
    read = set(tape.results)  # by the step
    for op, args in tape.nodes:
        leaf = op in ("input", "constant")
        mine = args[0] >= sizes[0] + sizes[1] if op == "input" else op == "constant" or all(own[a] for a in args)
        own.append(mine and (leaf or op in NUMPY))
        dear.append(not leaf and (op not in CHEAP or any(dear[a] for a in args)))
        read.update(() if leaf or own[-1] else args)
    return cut(tape, sorted(i for i in read if own[i] and dear[i]))


def _compiled(turn: Tape, sizes: tuple[int, int, int], mode: str) -> Callable[..., None]:
    loaded, constants = cache.load(text(turn, sizes), mode), constant_table((whole(turn),))

    def advance(state: np.ndarray, stages: np.ndarray, lanes: np.ndarray, record: np.ndarray) -> None:
        places = [ctypes.c_void_p(a.ctypes.data) for a in (constants, stages, lanes, state, record)]
        loaded.ms_march(ctypes.c_long(len(stages)), ctypes.c_long(state.shape[1]), *places)

    return advance


def _interpreted(turn: Tape) -> Callable[..., None]:
    run = fallback.numpy_function(turn)

    def advance(state: np.ndarray, stages: np.ndarray, lanes: np.ndarray, record: np.ndarray) -> None:
        following = np.empty_like(state)
        with np.errstate(all="ignore"):
            for values, row in zip(stages, record, strict=True):
                run([*state, *values, *lanes], [*following, *row])
                state[:] = following

    return advance


def text(turn: Tape, sizes: tuple[int, int, int]) -> str:
    """A file that exports `ms_march` for the step of `separated`. sizes: of states, stage values, lane values."""
    name, kernel = turn.name, whole(turn)
    states, stages, _ = sizes
    lanes, records = len(turn.inputs) - states - stages, len(turn.outputs) - states
    return "\n".join(
        [
            _SCHEDULED if len(turn.nodes) < _SHORT else "",
            preamble(),
            source.bodies((kernel,), name),
            "enum { MS_W = 64 };",
            source.stage(kernel, name, sizes),
            f"enum {{ MS_NS = {states}, MS_NK = {stages}, MS_NL = {lanes}, MS_NR = {records} }};",
            f"#define MS_NAME {name}",
            header("march.h"),
        ]
    )
