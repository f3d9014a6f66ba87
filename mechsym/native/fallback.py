"""Without a compiler: the same program as numpy text over chunks that stay in the cache, and CasADi for single points."""

import threading
from collections.abc import Callable
from typing import Any, TypeVar

import casadi
import numpy as np

from mechsym.errors import BadInput
from mechsym.native.dialects import NUMPY, expression, unknown
from mechsym.native.tape import Tape

_CHUNK = 2048
T = TypeVar("T")


def columns(name: str, count: int, values: tuple[Any, ...]) -> list[np.ndarray]:
    """Arguments of a batch as contiguous arrays of one length or of length 1.

    Parameters
    ----------
    name : str
        Name of the function, for messages
    count : int
        Number of arguments that it takes
    values : tuple
        Arrays of shape (n,) and numbers

    Returns
    -------
    columns : list of ndarray
        Of shape (n,) or (1,)

    Raises
    ------
    BadInput
        Wrong number of arguments, or lengths that do not fit
    """
    if len(values) != count:
        raise BadInput(f"{name} takes {count} arrays or numbers, not {len(values)}")
    found = [np.ascontiguousarray(v, dtype=float).reshape(-1) for v in values]
    sizes = sorted({c.size for c in found} - {1})
    if len(sizes) > 1:
        raise BadInput(f"{name}: arrays have lengths {', '.join(map(str, sizes))}; they must be equal or 1")
    return found


def record(kind: Callable[..., T], function: casadi.Function, tape: Tape, reason: str) -> T:
    """The two forms of a function without a compiler.

    Parameters
    ----------
    kind : type
        Record to fill
    function : casadi.Function
        The function
    tape : Tape
        Its program
    reason : str
        Why it is not compiled

    Returns
    -------
    record : kind
        Route `numpy`
    """
    return kind(
        name=tape.name,
        inputs=tape.inputs,
        outputs=tape.outputs,
        scalar=_scalar(function, tape),
        batch=_batch(function, tape),
        route="numpy",
        reason=reason,
    )


def numpy_text(tape: Tape) -> str:
    """The program as a Python function of arrays.

    Parameters
    ----------
    tape : Tape
        The program

    Returns
    -------
    text : str
        Defines `function(x, y)`: lists of columns to read and to write
    """
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
    return "\n".join(["def function(x, y):", *("    " + line for line in lines)])


def _batch(function: casadi.Function, tape: Tape) -> Callable[..., np.ndarray]:
    if unknown(tape, NUMPY):
        return _mapped(function, tape)
    scope: dict[str, Any] = {"np": np, "inf": np.inf, "nan": np.nan}
    exec(compile(numpy_text(tape), f"<numpy {tape.name}>", "exec"), scope)
    run = scope["function"]

    def batch(*values: Any) -> np.ndarray:
        found = columns(tape.name, len(tape.inputs), values)
        n = max((c.size for c in found), default=1)
        result = np.empty((len(tape.outputs), n))
        with np.errstate(all="ignore"):
            for start in range(0, n, _CHUNK):
                piece = slice(start, start + _CHUNK)
                run([c[piece] if c.size > 1 else c for c in found], result[:, piece])
        return result

    return batch


def _mapped(function: casadi.Function, tape: Tape) -> Callable[..., np.ndarray]:
    def batch(*values: Any) -> np.ndarray:
        found = columns(tape.name, len(tape.inputs), values)
        n = max((c.size for c in found), default=1)
        table = np.array([np.broadcast_to(c, n) for c in found])
        point = _scalar(function, tape)
        return np.array([np.atleast_1d(point(*row)) for row in table.T]).T

    return batch


def _scalar(function: casadi.Function, tape: Tape) -> Callable[..., Any]:
    # one buffer for each thread: it is written to and must outlive the call
    local = threading.local()
    sizes = [function.numel_in(i) for i in range(function.n_in())]

    def prepare() -> tuple[Any, Callable[[], None], np.ndarray, np.ndarray]:
        buffer, call = function.buffer()
        x, y = np.zeros(max(sum(sizes), 1)), np.zeros(len(tape.outputs))
        start = 0
        for i, size in enumerate(sizes):
            buffer.set_arg(i, memoryview(x[start : start + size]))
            start += size
        start = 0
        for i in range(function.n_out()):
            buffer.set_res(i, memoryview(y[start : start + function.numel_out(i)]))
            start += function.numel_out(i)
        return buffer, call, x, y

    def scalar(*values: float) -> Any:
        if len(values) != len(tape.inputs):
            raise TypeError(f"{tape.name} takes {len(tape.inputs)} numbers, not {len(values)}")
        if not hasattr(local, "held"):
            local.held = prepare()
        _, call, x, y = local.held
        x[: len(values)] = values
        call()
        return float(y[0]) if y.size == 1 else tuple(y.tolist())

    return scalar
