"""Compiled functions with exact derivatives that CasADi calls itself: for optimisation with IPOPT.

A node function is compiled together with its Jacobian, its reverse derivative and the Jacobian of that, under the names
at which CasADi looks for them. Mapping it over the nodes of a collocation then needs no interpreter at all.
"""

import logging
from collections.abc import Sequence

import casadi

from mechsym.native import cache, emit
from mechsym.native.compiler import NoCompiler
from mechsym.native.kernels import constant_table, kernels, split
from mechsym.native.source import header, preamble, prepared
from mechsym.native.tape import Tape

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
            _point(tape),
            _tables(function),
            f"#define MS_NAME {name}\n#define MS_NX {len(tape.inputs)}\n#define MS_NY {len(tape.outputs)}",
            f"#define MS_INPUTS {function.n_in()}\n#define MS_OUTPUTS {function.n_out()}",
            header("external.h"),
            *(f"#undef MS_{macro}" for macro in ("NAME", "NX", "NY", "INPUTS", "OUTPUTS")),
        ]
    )


def _point(tape: Tape) -> str:
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
    return "\n".join([constants, emit.bodies(parts, name), emit.rows(parts, name, 1)])


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
