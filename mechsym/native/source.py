"""One C file: elementary functions, the bodies of some functions, their entries, and perhaps an integrator.

C text of a program: one body for each kernel, and loops of that body over points or lanes.

    body      f_0(k0, .., x0, .., *y0, ..)     one instance at one point: constants, inputs, results
    rows      f_rows8(k, x, y)                 8 lanes; row i of x holds input i of all lanes; constants per lane
    block     f_block(m, k, x, y)              m points; x[i] and y[i] point to columns
    stage     f_stage(m, k, state, stage, ..)  m lanes; some inputs are the same in all of them

No value of a parameter is in the text: constants are read from a table, before the loop where all points share them.
Inside it a compiler moves the reading into branches, which then cannot become vector code.
"""

import dataclasses
import functools
from collections.abc import Callable, Container, Sequence
from importlib import resources
from typing import Any

import casadi

from mechsym.native import tape
from mechsym.native.kernels import Kernel, kernels
from mechsym.native.tape import Tape, cheaper, factored, marked, read
from mechsym.quantities import record


# compared by identity: `program` gives the same one for the same function, and texts are cached by it
@dataclasses.dataclass(frozen=True, kw_only=True, eq=False)
class Program:
    """A function ready to be written as C.

    tape: its straight-line program. kernels: the same with equal parts rolled.
    """

    tape: Tape
    kernels: tuple[Kernel, ...]


def program(function: casadi.Function, mode: str = "fast") -> Program:
    """Read a CasADi function and roll its equal parts.

    function: function of scalars or small vectors; mode: `fast` shares reciprocals and factors, `strict` leaves every
    operation as it is.
    """
    return stored_program(_Stored(text=_text(function), function=function), mode)


# a run with events asks for its function at each of them
@functools.lru_cache(maxsize=16)
def _text(function: casadi.Function) -> str:
    return function.serialize()


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
            bodies(p.kernels, name),
            rows(p.kernels, name, 1),
            block(p.kernels, name),
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


Place = Callable[[str], str]


def bodies(kernels: tuple[Kernel, ...], name: str) -> str:
    """The bodies of a program, and the places of its repeated kernels."""
    text = []
    for number, kernel in enumerate(kernels):
        text.append(body(kernel, f"{name}_{number}"))
        if len(kernel.inputs) > 1:
            text.append(_tables(kernel, f"{name}_{number}"))
    return "\n".join(text)


def body(kernel: Kernel, name: str) -> str:
    """A kernel as an inline function of scalars."""
    count = len(kernel.inputs[0])
    arguments = [
        *(f"const double k{i}" for i in range(len(kernel.constants[0]))),
        *(f"const double x{i}" for i in range(count)),
        *(f"double *restrict y{i}" for i in range(len(kernel.results))),
    ]
    names: list[str] = []
    lines: list[str] = []
    angles: set[int] = set()
    for i, (op, args) in enumerate(kernel.nodes):
        text, declared = _value(kernel, names, op, args)
        if op in ("sin", "cos") and args[0] not in angles:
            a = args[0]
            angles.add(a)
            lines.append(f"double s{a}, c{a};\n    ms_sincos({names[a]}, &s{a}, &c{a});")
        if declared:
            lines.append(f"const double t{i} = {text};")
        names.append(f"t{i}" if declared else text)
    lines += [f"*y{i} = {names[r]};" for i, r in enumerate(kernel.results)]
    return _function(f"MS_INLINE void {name}({', '.join(arguments)})", lines)


def _value(kernel: Kernel, names: list[str], op: str, args: tuple[Any, ...]) -> tuple[str, bool]:
    # text of a node, and whether it needs a variable of its own
    match op:
        case "input":
            return f"x{args[0]}", False
        case "literal":
            return str(tape.literal(args[0])), False
        case "constant":
            return f"k{args[0]}", False
        case "sin" | "cos":
            return f"{op[0]}{args[0]}", False
    kind, value = kernel.nodes[args[-1]][0], kernel.nodes[args[-1]][1]
    exponent = value[0] if kind == "literal" else None
    return tape.expression(tape.C, op, [names[a] for a in args], exponent), True


def rows(kernels: tuple[Kernel, ...], name: str, lanes: int) -> str:
    """A function over a fixed number of lanes.

    lanes: number of lanes; 1 gives the function at one point. Returns text: C function `<name>_rows<lanes>(k, x, y)`
    with x[input * lanes + lane].
    """
    head = f"MS_INLINE void {name}_rows{lanes}(const double *restrict k, const double *restrict x, double *restrict y)"
    lines = [f"enum {{ m = {lanes} }};"]
    lines += _loops(kernels, name, (lambda i: f"x + {i} * m", lambda i: f"y + {i} * m"), lanes)
    return _function(head, lines)


def block(kernels: tuple[Kernel, ...], name: str) -> str:
    """C function `<name>_block(m, k, x, y)`: over m points in columns, the same constants at all of them."""
    head = f"static void {name}_block(const long m, const double *restrict k, const double **x, double **y)"
    return _function(head, _loops(kernels, name, (lambda i: f"x[{i}]", lambda i: f"y[{i}]")))


def stage(kernel: Kernel, name: str, sizes: tuple[int, int, int]) -> str:
    """One step of a march in m lanes: state and lane values in columns, stage values common to all lanes.

    kernel: the whole step as one kernel with one instance; sizes: numbers of states, of stage values and of lane
    values, the inputs in this order. Returns text: C function `<name>_stage(m, k, state, stage, lane, lanes, record)`;
    states lie `MS_W` apart and are replaced, lane values and records `lanes`.
    """
    states, stages, _ = sizes
    head = (
        f"static void {name}_stage(const long m, const double *restrict k, double *restrict state, "
        "const double *restrict stage, const double *restrict lane, const long lanes, double *restrict record)"
    )

    def source(place: str) -> str:
        i = int(place)
        if i < states:
            return f"state + {i} * MS_W"
        return f"stage + {i - states}" if i < states + stages else f"lane + {i - states - stages} * lanes"

    def target(place: str) -> str:
        i = int(place)
        return f"state + {i} * MS_W" if i < states else f"record + {i - states} * lanes"

    common = range(states, states + stages)
    return _function(head, [_loop(kernel, f"{name}_0", (source, target), common=common)])


def _loops(kernels: tuple[Kernel, ...], name: str, places: tuple[Place, Place], lanes: int = 1) -> list[str]:
    lines = []
    for number, kernel in enumerate(kernels):
        lines.append(_loop(kernel, f"{name}_{number}", places, lanes))
        if number < len(kernels) - 1:
            lines.append(f"k += {len(kernel.constants[0]) * len(kernel.inputs) * lanes};")
    return lines


def _loop(kernel: Kernel, name: str, places: tuple[Place, Place], lanes: int = 1, common: Container[int] = ()) -> str:
    """Loop of a body over m points, for every instance; inputs in `common` are the same at all of them."""
    single, count = len(kernel.inputs) == 1, len(kernel.constants[0])
    inputs = [str(i) if single else f"{name}_in[i][{j}]" for j, i in enumerate(kernel.inputs[0])]
    outputs = [str(o) if single else f"{name}_out[i][{j}]" for j, o in enumerate(kernel.outputs[0])]
    same = [i in common for i in kernel.inputs[0]]
    lines = [f"const double *restrict c = k{'' if single else f' + i * {count * lanes}'};"] if count else []
    lines += [f"const double k{j} = c[{j}];" for j in range(count) if lanes == 1]
    names = {}
    for j, i in enumerate(inputs):
        place = places[0](i)
        names[place] = f"x{j}"
        # not const: gcc 12 has no vector type for a conditional load of a const double
        lines.append(f"const double x{j} = *({place});" if same[j] else f"double *restrict x{j} = (double *)({place});")
    for j, place in enumerate(map(places[1], outputs)):
        # what is read and written goes by one name, as `restrict` wants it
        if names.setdefault(place, f"y{j}") == f"y{j}":
            lines.append(f"double *restrict y{j} = {place};")
    points = [f"k{j}" if lanes == 1 else f"c[{j * lanes} + p]" for j in range(count)]
    points += [f"x{j}" if same[j] else f"x{j}[p]" for j in range(len(inputs))]
    points += [f"{names[places[1](o)]} + p" for o in outputs]
    lines += ["MS_LANES", "for (long p = 0; p < m; p++)", f"    {name}({', '.join(points)});"]
    head = "{" if single else f"for (int i = 0; i < {len(kernel.inputs)}; i++) {{"
    return "\n    ".join([head, *("    " + line for line in lines), "}"])


def _tables(kernel: Kernel, name: str) -> str:
    text = ""
    for suffix, table in (("in", kernel.inputs), ("out", kernel.outputs)):
        places = ",\n    ".join("{" + ", ".join(map(str, row or (0,))) + "}" for row in table)
        text += f"static const int {name}_{suffix}[{len(table)}][{max(len(table[0]), 1)}] = {{\n    {places}}};\n"
    return text


def _function(head: str, lines: list[str]) -> str:
    return "\n".join([head, "{", *("    " + line for line in lines), "}", ""])
