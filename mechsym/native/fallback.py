"""Without a compiler: the same program as numpy text over chunks that fit the cache, and CasADi for single points."""

import functools
import threading
from collections.abc import Callable
from itertools import accumulate
from typing import Any

import casadi
import numpy as np

from mechsym.errors import BadInput
from mechsym.native.tape import NUMPY, Tape, expression, read, unknown
from mechsym.quantities.units import Scalar

_CHUNK = 2048
_LONGEST = 4000  # instructions; CasADi is sooner done with a longer program than numpy's text of it is compiled


def columns(name: str, count: int, values: tuple[object, ...]) -> list[np.ndarray]:
    """Arguments of a batch as contiguous arrays of one length or of length 1 [SI].

    name: name of the function, for messages; count: number of arguments that it takes; values: arrays of shape (n,) and
    numbers.
    """
    if len(values) != count:
        raise BadInput(f"{name} takes {count} arrays or numbers, not {len(values)}")
    arrays = [np.ascontiguousarray(v, dtype=float).reshape(-1) for v in values]
    sizes = sorted({a.size for a in arrays} - {1})
    if len(sizes) > 1:
        raise BadInput(f"{name}: arrays have lengths {', '.join(map(str, sizes))}; they must be equal or 1")
    return arrays


def target(name: str, shape: tuple[int, int], out: np.ndarray | None) -> np.ndarray:
    """Where a batch is written to.

    name: name of the function, for messages; shape: number of outputs and number of points, as (m, n); out: the
    caller's own array [SI]. Returns target: new unless the caller has one [SI].
    """
    if out is None:
        return np.empty(shape)
    if out.shape != shape or out.dtype != float or not out.flags.c_contiguous:
        raise BadInput(
            f"{name}: out must be a contiguous array of floats of shape {shape}, not {out.dtype} {out.shape}"
        )
    return out


def numpy_text(tape: Tape) -> str:
    """Python text of `function(x, y)` over lists of columns to read and to write."""
    names: list[str] = []
    lines = []
    for i, (op, args) in enumerate(tape.nodes):
        if op == "input":
            names.append(f"x[{args[0]}]")
        elif op == "constant":
            names.append(f"({args[0]!r})")
        else:
            exponent = tape.nodes[args[-1]][1][0] if tape.nodes[args[-1]][0] == "constant" else None
            lines.append(f"t{i} = {expression(NUMPY, op, [names[a] for a in args], exponent)}")
            names.append(f"t{i}")
    lines += [f"y[{i}][:] = {names[r]}" for i, r in enumerate(tape.results)]
    return "\n".join(["def function(x, y):", *("    " + line for line in lines or ["pass"])])


def numpy_function(tape: Tape) -> Callable[[Scalar, Scalar], None]:
    """The program as a Python function (x, y) of lists of columns to read and to write."""
    if unknown(tape, NUMPY):
        raise BadInput(f"{tape.name}: numpy has no {', '.join(unknown(tape, NUMPY))}; install a C compiler")
    scope: dict[str, Any] = {"np": np, "inf": np.inf, "nan": np.nan}
    exec(compile(numpy_text(tape), f"<numpy {tape.name}>", "exec"), scope)
    return scope["function"]


def batch(function: casadi.Function, tape: Tape) -> Callable[..., np.ndarray]:
    """As `Compiled.batch`: numpy text over chunks, or CasADi point by point where numpy has no such operator."""
    run = None if unknown(tape, NUMPY) else numpy_function(tape)

    def batch(*values: object, out: np.ndarray | None = None) -> np.ndarray:
        inputs = columns(tape.name, len(tape.inputs), values)
        n = max((c.size for c in inputs), default=1)
        result = target(tape.name, (len(tape.outputs), n), out)
        if run is None:
            single = point(function, tape)
            rows = np.array([np.broadcast_to(c, n) for c in inputs]).T
            result[:] = np.array([np.atleast_1d(single(*row)) for row in rows]).T
            return result
        with np.errstate(all="ignore"):
            for start in range(0, n, _CHUNK):
                piece = slice(start, start + _CHUNK)
                run([c[piece] if c.size > 1 else c for c in inputs], result[:, piece])
        return result

    return batch


@functools.lru_cache(maxsize=256)
def arrays(function: casadi.Function) -> Callable[..., np.ndarray] | None:
    """A function over arrays as numpy text, made in the time that CasADi takes for 200 points.

    No compiler and no cache decides about it, so equal data give equal digits on the first run and on every other.

    Returns
    -------
    batch : callable or None
        As `Compiled.batch`; None where CasADi has to do it: it calls other functions, or is too long

    Examples
    --------
    >>> x = casadi.SX.sym("x")
    >>> arrays(casadi.Function("square", [x], [x * x]))(np.array([1.0, 2.0, 3.0])).tolist()
    [[1.0, 4.0, 9.0]]
    """
    if not function.is_a("SXFunction") or function.n_instructions() > _LONGEST:
        return None
    tape = read(function)
    return None if unknown(tape, NUMPY) else batch(function, tape)


def point(function: casadi.Function, tape: Tape) -> Callable[..., float | tuple[float, ...]]:
    """As `Compiled.scalar`, by CasADi."""
    # one buffer for each thread: it is written to and must outlive the call
    local = threading.local()
    sizes = [function.numel_in(i) for i in range(function.n_in())]
    results = [function.numel_out(i) for i in range(function.n_out())]

    def prepare() -> tuple[Any, ...]:
        # a buffer holds stored elements only; here every element is stored
        symbols = [casadi.SX.sym(function.name_in(i), *function.size_in(i)) for i in range(function.n_in())]
        dense = [casadi.densify(o) for o in function.call(symbols)]
        buffer: Any
        buffer, call = casadi.Function(function.name(), symbols, dense).buffer()
        x, y = np.zeros(max(sum(sizes), 1)), np.zeros(len(tape.outputs))
        for i, end in enumerate(accumulate(sizes)):
            buffer.set_arg(i, x[end - sizes[i] : end].data)
        for i, end in enumerate(accumulate(results)):
            buffer.set_res(i, y[end - results[i] : end].data)
        return buffer, call, x, y

    def scalar(*values: float) -> float | tuple[float, ...]:
        if len(values) != len(tape.inputs):
            raise TypeError(f"{tape.name} takes {len(tape.inputs)} numbers, not {len(values)}")
        if not hasattr(local, "held"):
            local.held = prepare()
        _, call, x, y = local.held
        try:
            x[: len(values)] = values
        except ValueError:
            raise TypeError(f"{tape.name} takes numbers, not {values}") from None
        call()
        return float(y[0]) if y.size == 1 else tuple(y.tolist())

    return scalar
