"""Compiled functions with exact derivatives that CasADi calls itself: for optimisation with IPOPT.

A node function is compiled together with its Jacobian, its reverse derivative and the Jacobian of that, under the names
at which CasADi looks for them. Mapping it over the nodes of a collocation then needs no interpreter at all.
"""

import logging

import casadi

from mechsym.native import cache, emit
from mechsym.native.compiler import NoCompiler
from mechsym.native.kernels import constant_table
from mechsym.native.source import Program, header, preamble, program

_LOG = logging.getLogger("mechsym.native")


def external(function: casadi.Function, mode: str = "fast") -> casadi.Function:
    """The same function compiled, with derivatives up to the second.

    Parameters
    ----------
    function : casadi.Function
        SX function; parameters that change between solves should be inputs, as constants are compiled in
    mode : str
        `fast` or `strict`

    Returns
    -------
    function : casadi.Function
        Same name, inputs and outputs; the given function itself when there is no compiler
    """
    try:
        path = cache.shared_object(text(function, mode), mode)
    except NoCompiler as error:
        _LOG.warning("interpreted instead of C: %s", error)
        return function
    return casadi.external(function.name(), str(path))


def text(function: casadi.Function, mode: str) -> str:
    """A file with a function and its derivatives in CasADi's calling convention.

    Parameters
    ----------
    function : casadi.Function
        SX function
    mode : str
        `fast` or `strict`

    Returns
    -------
    text : str
        C text
    """
    reverse = function.reverse(1)
    family = [function, function.jacobian(), reverse, reverse.jacobian()]
    return "\n".join([preamble(), *(_one(f, mode) for f in family)])


def _one(function: casadi.Function, mode: str) -> str:
    expanded = function if function.is_a("SXFunction") else function.expand()
    found = program(_stored(expanded), mode)
    name = found.tape.name
    return "\n".join(
        [
            emit.bodies(found.kernels, name),
            emit.rows(found.kernels, name, 1),
            _tables(function, found),
            f"#define MS_NAME {name}\n#define MS_NX {len(found.tape.inputs)}\n#define MS_NY {len(found.tape.outputs)}",
            f"#define MS_INPUTS {function.n_in()}\n#define MS_OUTPUTS {function.n_out()}",
            header("external.h"),
            *(f"#undef MS_{macro}" for macro in ("NAME", "NX", "NY", "INPUTS", "OUTPUTS")),
        ]
    )


def _stored(function: casadi.Function) -> casadi.Function:
    """The function of stored elements only, inputs and outputs as columns."""
    symbols = [casadi.SX.sym(function.name_in(i), function.sparsity_in(i)) for i in range(function.n_in())]
    outputs = [o.nz[:] for o in function.call(symbols)]
    return casadi.Function(function.name(), [s.nz[:] for s in symbols], outputs, {"allow_free": False})


def _tables(function: casadi.Function, found: Program) -> str:
    name = function.name()
    numbers = ", ".join(repr(v) for v in constant_table(found.kernels).tolist())
    text = [f"static const double {name}_constants[] = {{{numbers}}};"]
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
