"""For many lanes side by side: a recurrence over stages, and equal steps of an explicit Runge-Kutta method.

An engine cycle over crank angles at many speeds is the one, at many designs the other.
"""

import ctypes
import logging
from collections.abc import Callable

import casadi
import numpy as np

from mechsym.errors import BadInput
from mechsym.native import cache, evaluate, integrators, source
from mechsym.native.compiler import NoCompiler
from mechsym.native.kernels import constant_table, cut, whole
from mechsym.native.source import Program, header, preamble, program
from mechsym.native.tape import CHEAP, NUMPY, Tape
from mechsym.quantities import record

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

    Returns march: start (states, n), stages (k, values), lanes (values, n) -> state after the last stage (states, n)
    and what every stage recorded (k, records, n). Stage values are the same in all lanes, lane values in all stages;
    the callable raises BadInput for arrays that do not fit. Raises BadInput: the function is no step.
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
    before = evaluate.numpy_function(once)

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
    run = evaluate.numpy_function(turn)

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


_LANES = 16

Fold = Callable[[np.ndarray, np.ndarray, int], np.ndarray]


@record
class Method:
    """An explicit Runge-Kutta method."""

    #: For each stage the weights of the stages before it, counted from 0; their sum is the stage's node [-]
    rows: tuple[dict[int, float], ...]
    weights: dict[int, float]  #: Weights of the stages in the step [-]


def folder(rate: casadi.Function, method: Method, mode: str = "fast") -> Fold:
    r"""A function that integrates runs over s from 0 to 1 in equal steps.

    .. math:: \frac{\mathrm{d}y}{\mathrm{d}s} = f(s, y, z)

    Returns fold: y at 0 (states, n), z (values, n), number of steps -> y at the ends of all steps (steps, states, n).
    Raises BadInput: the inputs are not s, y, z.
    """
    rates = program(rate, mode)
    integrators.sizes(rates)
    try:
        loaded = cache.load(fold_text(rates, method), mode)
        constants = np.repeat(constant_table(rates.kernels)[:, None], _LANES, axis=1)

        def fold(start: np.ndarray, held: np.ndarray, steps: int) -> np.ndarray:
            start, held = (np.ascontiguousarray(a, dtype=float) for a in (start, held))
            history = np.empty((steps, *start.shape))
            places = [ctypes.c_void_p(a.ctypes.data) for a in (constants, start, held, history)]
            loaded.ms_fold(ctypes.c_long(steps), ctypes.c_long(start.shape[1]), *places)
            return history

        return fold
    except NoCompiler as error:
        _LOG.warning("numpy instead of C: %s", error)
        return _interpreted_fold(rates, method)


def fold_text(rates: Program, method: Method) -> str:
    """A file that exports `ms_fold`, see `c/fold.h`."""
    stages = " ".join(
        f"F({j}, {sum(row.values())!r}, {integrators.weighted(row) or '0.0'})" for j, row in enumerate(method.rows)
    )
    numbers = [
        f"enum {{ MS_STAGES_NUMBER = {len(method.rows)} }};",
        f"#define MS_FOLD_STAGES(F) {stages}",
        f"#define MS_FOLD_WEIGHTS {integrators.weighted(method.weights)}",
    ]
    return "\n".join([integrators.system(rates, _LANES), *numbers, header("fold.h")])


def _interpreted_fold(rates: Program, method: Method) -> Fold:
    run = evaluate.numpy_function(rates.tape)

    def fold(start: np.ndarray, held: np.ndarray, steps: int) -> np.ndarray:
        history, y, h = np.empty((steps, *start.shape)), np.array(start, dtype=float), 1 / steps
        slopes = np.empty((len(method.rows), *start.shape))
        with np.errstate(all="ignore"):
            for n in range(steps):
                for j, row in enumerate(method.rows):
                    shifted = y + h * sum(a * slopes[i] for i, a in row.items())
                    run([(n + sum(row.values())) * h, *shifted, *held], slopes[j])
                y = y + h * sum(b * slopes[i] for i, b in method.weights.items())
                history[n] = y
        return history

    return fold
