"""One C file: elementary functions, the bodies of some functions, their entries, and perhaps an integrator."""

import dataclasses
import functools
from collections.abc import Sequence
from importlib import resources

import casadi

from mechsym.native import emit
from mechsym.native.kernels import Kernel, kernels
from mechsym.native.rewrite import cheaper, factored, marked
from mechsym.native.tape import Tape, read
from mechsym.quantities import record


# compared by identity: `program` gives the same one for the same function, and texts are cached by it
@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class Program:
    """A function ready to be written as C.

    Parameters
    ----------
    tape : Tape
        Its straight-line program
    kernels : tuple of Kernel
        The same with equal parts rolled
    """

    tape: Tape
    kernels: tuple[Kernel, ...]


def program(function: casadi.Function, mode: str = "fast") -> Program:
    """Read a CasADi function and roll its equal parts.

    function: function of scalars or small vectors; mode: `fast` shares reciprocals and factors, `strict` leaves every
    operation as it is.
    """
    return stored_program(_Stored(text=function.serialize(), function=function), mode)


@record
class _Stored:
    # a function, told from others by its text
    text: str
    function: casadi.Function = dataclasses.field(compare=False)


# a run, its check, its energies and the next trial ask for the same function again
@functools.lru_cache(maxsize=1024)
def stored_program(stored: _Stored, mode: str) -> Program:
    """As `program`; the same for the same text."""
    tape = prepared(stored.function, mode)
    return Program(tape=tape, kernels=kernels(tape))


def prepared(function: casadi.Function, mode: str) -> Tape:
    """The tape of a function in the form that a mode compiles. function: function of scalars or small vectors."""
    tape = read(function)
    return factored(cheaper(tape)) if mode == "fast" else marked(tape)


@functools.cache
def header(name: str) -> str:
    """A C file of the package."""
    return (resources.files("mechsym.native") / "c" / name).read_text(encoding="utf-8")


def preamble() -> str:
    """What every emitted file starts with."""
    includes = "#ifdef MS_PYTHON\n#define PY_SSIZE_T_CLEAN\n#include <Python.h>\n#endif\n#include <stdlib.h>\n"
    return includes + header("elementary.h") + header("prelude.h")


def evaluation(programs: Sequence[Program]) -> str:
    """A file that evaluates functions at one point and in batches."""
    parts = [preamble()]
    for p in programs:
        name = p.tape.name
        parts += [
            f"/* {signature(p.tape)} */",
            emit.bodies(p.kernels, name),
            emit.rows(p.kernels, name, 1),
            emit.block(p.kernels, name),
            f"#define MS_NAME {name}\n#define MS_NX {len(p.tape.inputs)}\n#define MS_NY {len(p.tape.outputs)}",
            header("entries.h"),
            "#undef MS_NAME\n#undef MS_NX\n#undef MS_NY",
        ]
    methods, batched = (", ".join(f"&{p.tape.name}_{kind}" for p in programs) for kind in ("method", "batched"))
    tables = f"*const ms_methods[] = {{{methods}}}, *const ms_batched[] = {{{batched}}}"
    parts += [f"#ifdef MS_PYTHON\nstatic PyMethodDef {tables};\n#endif", header("module.h")]
    return "\n".join(parts)


def signature(tape: Tape) -> str:
    """Inputs and outputs in one line."""
    return f"{tape.name}({', '.join(tape.inputs)}) -> {', '.join(tape.outputs)}"
