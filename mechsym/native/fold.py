"""Equal steps of an explicit Runge-Kutta method for many runs side by side: an engine cycle at many designs."""

import ctypes
import logging
from collections.abc import Callable

import casadi
import numpy as np

from mechsym.native import cache, fallback, integrators
from mechsym.native.compiler import NoCompiler
from mechsym.native.kernels import constant_table
from mechsym.native.source import Program, header, program
from mechsym.quantities import record

_LOG = logging.getLogger("mechsym.native")
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
        return _compiled(rates, method, mode)
    except NoCompiler as error:
        _LOG.warning("numpy instead of C: %s", error)
        return _interpreted(rates, method)


def text(rates: Program, method: Method) -> str:
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


def _compiled(rates: Program, method: Method, mode: str) -> Fold:
    loaded = cache.load(text(rates, method), mode)
    constants = np.repeat(constant_table(rates.kernels)[:, None], _LANES, axis=1)

    def fold(start: np.ndarray, held: np.ndarray, steps: int) -> np.ndarray:
        start, held = (np.ascontiguousarray(a, dtype=float) for a in (start, held))
        history = np.empty((steps, *start.shape))
        places = [ctypes.c_void_p(a.ctypes.data) for a in (constants, start, held, history)]
        loaded.ms_fold(ctypes.c_long(steps), ctypes.c_long(start.shape[1]), *places)
        return history

    return fold


def _interpreted(rates: Program, method: Method) -> Fold:
    run = fallback.numpy_function(rates.tape)

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
