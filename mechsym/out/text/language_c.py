"""C99 of tapes and of blocks: one header, one file, no allocation, no vector types, nothing but math.h.

A function reads one array and writes one: `void name(const double *v, double *y)`.
"""

from collections.abc import Sequence
from importlib import resources

import casadi as ca

from mechsym.native.integrators import dop853_numbers
from mechsym.native.tape import Tape, read
from mechsym.out.block import Block, Curve
from mechsym.out.fmi.describe import identifier, variables
from mechsym.out.text.dialects import C99, Written, number, statements, told


def function(tape: Tape, name: str, kind: str = "static void") -> str:
    """A tape as a C function of one array."""
    lines, results = statements(tape, C99, lambda i: f"v[{i}]")
    stores = [f"    y[{i}] = {text};" for i, text in enumerate(results)]
    unused = [] if any(op == "input" for op, _ in tape.nodes) else ["    (void)v;"]
    return "\n".join([f"{kind} {name}(const double *v, double *y)", "{", *unused, *lines, *stores, "}", ""])


def model(block: Block) -> str:
    """A block as `model.h`: sizes, numbers, curves, rates and outputs with their directional derivatives."""
    p = [port.name for port in block.parameters]
    times = [p.index(name) for name in block.switches]
    sizes = {
        "NQ": len(block.states) // 2, "NX": len(block.states), "NU": len(block.inputs), "NP": len(p),
        "NY": len(block.outputs), "NC": len(block.curves), "NS": len(times), "NK": len(block.kinks),
        "NA": sum(len(k.angles) for k in block.kinks), "NE": len(block.stops),
    }  # fmt: skip
    q = [s.name for s in block.states]
    rows = [(q.index(k.coordinate), k) for k in block.kinks]
    own = [f"{{{i}, {len(k.angles)}, {number(C99, k.period)}, kinks_{n}}}" for n, (i, k) in enumerate(rows)]
    angles = [array(f"kinks_{n}", k.angles) for n, k in enumerate(block.kinks)]
    text = ", ".join(own) or "{0, 0, 1.0, start_x}"
    loops = () if block.closed is None else (block.closed,)
    head = "struct kinks { int state, count; double period; const double *angles; };"
    return "\n".join(
        [
            C99.says(f"{block.name}: {block.about}"),
            "#include <math.h>",
            "enum { " + ", ".join(f"{k} = {v}" for k, v in sizes.items()) + " };",
            "/* v = t, x, u, p, w (value and slope of each curve), s (switches) */",
            "enum { VX = 1, VU = VX + NX, VP = VU + NU, VW = VP + NP, VS = VW + 2 * NC, NV = VS + NS };",
            array("start_x", [s.start for s in block.states]),
            array("start_p", [s.start for s in block.parameters]),
            array("switch_time", times, "int"),
            curve_tables(block.curves),
            "\n".join([*angles, head, f"static const struct kinks kinks[] = {{{text}}};"]),
            _stops(block),
            *(function(read(f), f.name()) for f in (block.rates, block.observed)),
            f"#define LOOPS {len(loops)}",
            *(function(read(f), f.name()) for f in loops),
            *(function(read(forward(f)), f"{f.name()}_forward") for f in (block.rates, block.observed, *loops)),
        ]
    )


def forward(function: ca.Function) -> ca.Function:
    """Directional derivative: the inputs of `function` and a direction of each, to the change of its output."""
    arguments = [ca.SX.sym(function.name_in(i), function.size1_in(i)) for i in range(function.n_in())]
    direction = [ca.SX.sym(f"d_{function.name_in(i)}", function.size1_in(i)) for i in range(function.n_in())]
    change = ca.jtimes(function(*arguments), ca.vertcat(*arguments), ca.vertcat(*direction))
    return ca.Function(f"{function.name()}_forward", [*arguments, *direction], [ca.densify(change)])


def array(name: str, values: Sequence[float], kind: str = "double") -> str:
    """A constant array [any unit]; one entry where it would be empty, which C does not allow."""
    texts = [str(v) if kind == "int" else number(C99, v) for v in values] or ["0"]
    rows = [", ".join(texts[i : i + 6]) for i in range(0, len(texts), 6)]
    return f"static const {kind} {name}[{len(texts)}] = {{\n    " + ",\n    ".join(rows) + "};"


def curve_tables(curves: Sequence[Curve]) -> str:
    """Curves as constant tables of C, all of them in the array `curves`."""
    lines, alike = [], dict[int, int]()  # equal cylinders have one table, each from its own angle on
    for i, curve in enumerate(curves):
        if alike.setdefault(id(curve.poly.c), i) == i:
            lines += [array(f"breaks_{i}", curve.poly.x.tolist()), array(f"rows_{i}", curve.poly.c.T.ravel().tolist())]
    of = [alike[id(curve.poly.c)] for curve in curves]
    entries = [
        f"    {{{c.state}, {len(c.poly.x) - 1}, {len(c.poly.c)}, {int(c.periodic)}, {number(C99, c.ratio)}, "
        f"{number(C99, c.poly.x[0] - curves[k].poly.x[0])}, breaks_{k}, rows_{k}}}"
        for k, c in zip(of, curves, strict=True)
    ] or ["    {0, 1, 1, 0, 0.0, 0.0, start_x, start_x}"]
    head = (
        "/* curve: state, pieces, coefficients (highest first), periodic, argument per unit of the state, start */\n"
        "struct curve { int state, pieces, terms, periodic; double ratio, shift; const double *breaks, *rows; };\n"
    )
    text = ",\n".join(entries)
    return "\n".join(lines) + f"\n{head}static const struct curve curves[] = {{\n{text}}};"


def _stops(block: Block) -> str:
    x, sense = [s.name for s in block.states], {"falling": -1, "rising": 1, "either": 0}
    rows = [f'{{{x.index(s.of)}, {sense[s.direction]}, {number(C99, s.level)}, "{s.name}"}}' for s in block.stops]
    text = ", ".join(rows) or '{0, 0, 0.0, ""}'
    head = "struct stop { int state, sense; double level; const char *name; };"
    return f"{head}\nstatic const struct stop stops[] = {{{text}}};"


def files(written: Written) -> dict[str, str]:
    """NAME.h and NAME.c."""
    name = identifier(written.name)
    if written.block is None:
        header, source = list[str](), ["#include <math.h>"]
        for group, tape in written.tapes.items():
            header += [C99.says(line) for line in told(written, group)]
            header += [f"void {name}_{group}(const double *v, double *y);"]
            source.append(function(tape, f"{name}_{group}", "void"))
    else:
        header, source = _machine(written.block, name)
    guard = f"{name.upper()}_H"
    head = C99.says(f"{written.name}: {written.about} SI units, angles in rad.")
    head += f"\n#ifndef {guard}\n#define {guard}\n"
    body = "\n".join([f"{head}{_OPEN}", *header, _CLOSE, "#endif", ""])  # the same functions from C++
    return {f"{name}.h": body, f"{name}.c": "\n".join([f'#include "{name}.h"', *source])}


_OPEN = '#include <stddef.h>\n#ifdef __cplusplus\nextern "C" {\n#endif'
_CLOSE = "#ifdef __cplusplus\n}\n#endif"


def _machine(block: Block, name: str) -> tuple[list[str], list[str]]:
    places = [
        f"    {name}_{identifier(v.port.name)} = {v.reference}, /* {v.port.unit}, {v.kind} */" for v in variables(block)
    ]
    header = [
        "/* places of the values that can be got; states, inputs and parameters can be set */",
        "enum {",
        *places,
        "};",
        f"size_t {name}_size(void); /* bytes that a machine needs; the caller gives them, aligned for double */",
        f"void {name}_start(void *machine, double tolerance);",
        f"int {name}_set(void *machine, unsigned place, double value); /* 0: cannot be set, or no number */",
        f"double {name}_get(void *machine, unsigned place);",
        f"int {name}_advance(void *machine, double t); /* 1: t reached, 2: a stop ended the run before, 0: failed */",
        f"/* exact change of {name}_get of the places `of` while the places `by` change so much; 0: no such place */",
        f"int {name}_change(const void *machine, const unsigned *of, size_t count_of,",
        "    const unsigned *by, size_t count_by, const double *so_much, double *change);",
    ]
    core = (resources.files("mechsym.out") / "c" / "core.h").read_text(encoding="utf-8")
    return header, [model(block), dop853_numbers(), core, _calls(name)]


def _calls(name: str) -> str:
    """What the header offers, by what `core.h` has."""
    return f"""
size_t {name}_size(void) {{ return sizeof(machine); }}
void {name}_start(void *own, double tolerance)
{{
    core_start((machine *)own);
    ((machine *)own)->tolerance = tolerance;
}}
int {name}_set(void *own, unsigned place, double value) {{ return core_set((machine *)own, place, value); }}
double {name}_get(void *own, unsigned place)
{{
    double value = 0.0;
    return core_get((machine *)own, place, &value) ? value : NAN;
}}
int {name}_advance(void *own, double t)
{{
    return !core_advance((machine *)own, t) ? 0 : ((machine *)own)->stopped < 0 ? 1 : 2;
}}
int {name}_change(const void *own, const unsigned *of, size_t count_of,
    const unsigned *by, size_t count_by, const double *so_much, double *change)
{{
    return core_directional((const machine *)own, of, count_of, by, count_by, so_much, change);
}}
"""
