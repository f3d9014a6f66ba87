"""CasADi functions as fast functions of numbers: compiled C where there is a compiler, otherwise numpy and CasADi.

    compiled(f).scalar(0.1, 2.0)        floats in, float or tuple of floats out: about 0.1 microseconds in C
    compiled(f).batch(phi, 2.0)         arrays and numbers in, array (outputs, n) out: nanoseconds a point in C

Both routes take the same arguments and agree with the interpreted function to 1e-12 in mode `strict` and 1e-10 in mode
`fast` (relative; tests/native/test_evaluate.py).

Compiled functions with exact derivatives that CasADi calls itself: for optimisation with IPOPT. A node function is
compiled together with its Jacobian, its reverse derivative and the Jacobian of that, under the names at which CasADi
looks for them. Mapping it over the nodes of a collocation then needs no interpreter at all.
"""

import ctypes
import logging
from collections.abc import Callable, Mapping, Sequence

import casadi
import numpy as np

from mechsym.errors import BadInput
from mechsym.native import cache, fallback, source
from mechsym.native.compiler import NoCompiler
from mechsym.native.kernels import constant_table, kernels, split
from mechsym.native.source import header, preamble, prepared
from mechsym.native.tape import Tape
from mechsym.quantities import record

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
        scalar=fallback.point(function, tape),
        batch=fallback.batch(function, tape),
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
    call, inputs, outputs, flags = (
        loaded[f"{name}_batch"],
        ctypes.c_void_p * nx,
        ctypes.c_void_p * ny,
        ctypes.c_bool * nx,
    )
    call.restype, call.argtypes = ctypes.c_int, [ctypes.c_long, *[ctypes.c_void_p] * 4]
    table = constants.ctypes.data

    def batch(*values: object, out: np.ndarray | None = None) -> np.ndarray:
        columns = fallback.columns(name, nx, values)
        n = max((c.size for c in columns), default=1)
        result = fallback.target(name, (ny, n), out)
        start = result.ctypes.data
        moving = flags(*(c.size > 1 for c in columns))
        places = inputs(*(c.ctypes.data for c in columns))
        if call(n, table, places, moving, outputs(*range(start, start + 8 * n * ny, 8 * n))):
            raise MemoryError(f"{name}: no memory for a batch of {n} points")
        return result

    batch.__dict__["constants"] = constants  # alive as long as it is
    return batch
