"""CasADi functions as fast functions of numbers: compiled C where there is a compiler, otherwise numpy and CasADi.

    compiled(f).scalar(0.1, 2.0)        floats in, float or tuple of floats out: about 0.1 microseconds in C
    compiled(f).batch(phi, 2.0)         arrays and numbers in, array (outputs, n) out: nanoseconds a point in C

Both routes take the same arguments and agree with the interpreted function to 1e-12 in mode `strict` and 1e-10 in mode
`fast` (relative; tests/native/test_evaluate.py).

Without a compiler the same program is numpy text over chunks that fit the cache, and CasADi for single points.

Compiled functions with exact derivatives that CasADi calls itself: for optimisation with IPOPT. A node function is
compiled together with its Jacobian, its reverse derivative and the Jacobian of that, under the names at which CasADi
looks for them. Mapping it over the nodes of a collocation then needs no interpreter at all.
"""

import ctypes
import functools
import logging
import threading
from collections.abc import Callable, Mapping, Sequence
from itertools import accumulate
from typing import Any

import casadi
import numpy as np

from mechsym.errors import BadInput
from mechsym.native import cache, source
from mechsym.native.compiler import NoCompiler
from mechsym.native.kernels import constant_table, kernels, split
from mechsym.native.source import header, preamble, prepared
from mechsym.native.tape import NUMPY, Tape, expression, read, unknown
from mechsym.quantities import record
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

    Returns batch: as `Compiled.batch`; None where CasADi has to do it: it calls other functions, or is too long.

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


_LOG = logging.getLogger("mechsym.native")


def external(function: casadi.Function, mode: str = "fast") -> casadi.Function:
    """The same function compiled, with derivatives up to the second.

    function: SX function; parameters that change between solves should be inputs, as constants are compiled in. Returns
    function: same name, inputs and outputs; the given function itself when there is no compiler.
    """
    reverse = function.reverse(1)
    try:
        return externals([function, function.jacobian(), reverse, reverse.jacobian()], mode)[0]
    except NoCompiler as error:
        _LOG.warning("interpreted instead of C: %s", error)
        return function


def externals(functions: Sequence[casadi.Function], mode: str = "fast") -> list[casadi.Function]:
    """Functions compiled into one file, each without derivatives of its own unless they are among the others."""
    loaded = cache.load("\n".join([preamble(), *(_one(f, mode) for f in functions)]), mode)
    return [casadi.external(f.name(), loaded._name) for f in functions]


def _one(function: casadi.Function, mode: str) -> str:
    expanded = function if function.is_a("SXFunction") else function.expand()
    # the function of stored elements only, inputs and outputs as columns
    symbols = [casadi.SX.sym(expanded.name_in(i), expanded.sparsity_in(i)) for i in range(expanded.n_in())]
    outputs = [o.nz[:] for o in expanded.call(symbols)]
    tape = prepared(casadi.Function(expanded.name(), [s.nz[:] for s in symbols], outputs, {"allow_free": False}), mode)
    name = tape.name
    return "\n".join(
        [
            _point_external(tape),
            _tables(function),
            f"#define MS_NAME {name}\n#define MS_NX {len(tape.inputs)}\n#define MS_NY {len(tape.outputs)}",
            f"#define MS_INPUTS {function.n_in()}\n#define MS_OUTPUTS {function.n_out()}",
            header("external.h"),
            *(f"#undef MS_{macro}" for macro in ("NAME", "NX", "NY", "INPUTS", "OUTPUTS")),
        ]
    )


def _point_external(tape: Tape) -> str:
    """The function `<name>_at(x, y)` at one point, in two stages where that lets equal parts be rolled."""
    name, parts = tape.name, split(tape)
    if parts is None:
        return "\n".join([_stage(tape), f"#define {name}_at(x, y) {name}_rows1({name}_constants, x, y)"])
    first, second = parts
    nx, values = len(first.inputs), len(first.outputs)
    return f"""{_stage(first)}
{_stage(second)}
static void {name}_at(const double *x, double *y)
{{
    double all[{nx + values}];
    memcpy(all, x, {nx} * sizeof(double));
    {first.name}_rows1({first.name}_constants, x, all + {nx});
    {second.name}_rows1({second.name}_constants, all, y);
}}"""


def _stage(tape: Tape) -> str:
    name, parts = tape.name, kernels(tape)
    numbers = ", ".join(repr(v) for v in constant_table(parts).tolist())
    constants = f"static const double {name}_constants[] = {{{numbers}}};"
    return "\n".join([constants, source.bodies(parts, name), source.rows(parts, name, 1)])


def _tables(function: casadi.Function) -> str:
    name, text = function.name(), []
    for side in ("in", "out"):
        count = function.n_in() if side == "in" else function.n_out()
        sparsities = [getattr(function, f"sparsity_{side}")(i) for i in range(count)]
        names = [getattr(function, f"name_{side}")(i) for i in range(count)]
        for i, sparsity in enumerate(sparsities):
            entries = ", ".join(map(str, sparsity.compress()))
            text.append(f"static const long long {name}_s{side}{i}[] = {{{entries}}};")
        lists = {
            f"long {name}_size_{side}": [str(s.nnz()) for s in sparsities],
            f"char *const {name}_names_{side}": [f'"{n}"' for n in names],
            f"long long *const {name}_sparsities_{side}": [f"{name}_s{side}{i}" for i in range(count)],
        }
        text += [f"static const {declared}[] = {{{', '.join(values or ['0'])}}};" for declared, values in lists.items()]
    return "\n".join(text)


@record
class Compiled:
    """A function of scalars in two forms."""

    name: str
    #: Scalar inputs and outputs in order; the elements of a vector y are `y[0]`, `y[1]`, a matrix goes by columns
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    scalar: Callable[
        ..., float | tuple[float, ...]
    ]  #: Floats -> float, or tuple of floats where there are several outputs
    #: Arrays of shape (n,) or numbers -> ndarray of shape (outputs, n); `out=` takes an array to write into
    batch: Callable[..., np.ndarray]
    route: str
    reason: str  #: Why it is not C, else empty


def compiled(function: casadi.Function, mode: str = "fast") -> Compiled:
    """One CasADi function as fast functions.

    function: SX function, or an MX function that can be expanded; mode: `strict` (IEEE arithmetic as written) or `fast`
    (contracted products, reciprocals).

    >>> x = casadi.SX.sym("x")
    >>> compiled(casadi.Function("square", [x], [x * x])).scalar(3.0)
    9.0
    """
    return compiled_all({function.name(): function}, mode)[function.name()]


def compiled_all(functions: Mapping[str, casadi.Function], mode: str = "fast") -> dict[str, Compiled]:
    """Several CasADi functions of different names compiled into one file, as those of a mechanism."""
    programs = [source.program(f, mode) for f in functions.values()]
    names = [p.tape.name for p in programs]
    if len(set(names)) < len(names):
        raise BadInput(f"functions share a name ({', '.join(names)}); give each its own")
    try:
        loaded = cache.load(source.evaluation(programs), mode)
    except NoCompiler as error:
        _LOG.warning("numpy instead of C: %s", error)
        pairs = zip(functions.values(), programs, strict=True)
        both = [_without_compiler(f, p, str(error)) for f, p in pairs]
    else:
        both = [_in_c(loaded, number, p) for number, p in enumerate(programs)]
    return dict(zip(functions, both, strict=True))


def _without_compiler(function: casadi.Function, program: source.Program, reason: str) -> Compiled:
    tape = program.tape
    return Compiled(
        name=tape.name,
        inputs=tape.inputs,
        outputs=tape.outputs,
        scalar=point(function, tape),
        batch=batch(function, tape),
        route="numpy",
        reason=reason,
    )


def _in_c(loaded: ctypes.CDLL, number: int, program: source.Program) -> Compiled:
    tape, constants = program.tape, constant_table(program.kernels)
    batch = _batch(loaded, program, constants)
    extension = cache.module(loaded._name)
    if extension:
        scalar = extension.bind(number, constants.tobytes())
        # columns are looked at in C where all are plain; the rest, and every complaint, is the other's
        batch = extension.bind(number, (constants.tobytes(), np.empty, np.dtype(float), batch))
    else:
        scalar = _point(loaded, program, constants)
    return Compiled(
        name=tape.name, inputs=tape.inputs, outputs=tape.outputs, scalar=scalar, batch=batch, route="C", reason=""
    )


def _point(
    loaded: ctypes.CDLL, program: source.Program, constants: np.ndarray
) -> Callable[..., float | tuple[float, ...]]:
    nx, ny = len(program.tape.inputs), len(program.tape.outputs)
    call, inputs, outputs = loaded[f"{program.tape.name}_point"], ctypes.c_double * nx, ctypes.c_double * ny
    call.restype, call.argtypes = None, [ctypes.c_void_p] * 3

    def scalar(*values: float) -> float | tuple[float, ...]:
        if len(values) != nx:
            raise TypeError(f"{program.tape.name} takes {nx} numbers, not {len(values)}")
        result = outputs()
        call(constants.ctypes.data, inputs(*values), result)
        return result[0] if ny == 1 else tuple(result)

    return scalar


def _batch(loaded: ctypes.CDLL, program: source.Program, constants: np.ndarray) -> Callable[..., np.ndarray]:
    nx, ny, name = len(program.tape.inputs), len(program.tape.outputs), program.tape.name
    call, inputs, outputs = loaded[f"{name}_batch"], ctypes.c_void_p * nx, ctypes.c_void_p * ny
    flags = ctypes.c_bool * nx
    call.restype, call.argtypes = ctypes.c_int, [ctypes.c_long, *[ctypes.c_void_p] * 4]
    table = constants.ctypes.data

    def batch(*values: object, out: np.ndarray | None = None) -> np.ndarray:
        arrays = columns(name, nx, values)
        n = max((c.size for c in arrays), default=1)
        result = target(name, (ny, n), out)
        start = result.ctypes.data
        moving = flags(*(c.size > 1 for c in arrays))
        places = inputs(*(c.ctypes.data for c in arrays))
        if call(n, table, places, moving, outputs(*range(start, start + 8 * n * ny, 8 * n))):
            raise MemoryError(f"{name}: no memory for a batch of {n} points")
        return result

    batch.__dict__["constants"] = constants  # alive as long as it is
    return batch
