"""C99: one header, one file, no allocation."""

from importlib import resources

from mechsym.native.integrators import dop853_numbers
from mechsym.out.fmi.describe import identifier, variables
from mechsym.out.text.c import function, model
from mechsym.out.text.programs import Written, told


def files(written: Written) -> dict[str, str]:
    """NAME.h and NAME.c."""
    name = identifier(written.name)
    make = _mechanism if written.block is None else _machine
    header, source = make(written, name)
    guard = f"{name.upper()}_H"
    head = f"/* {written.name}: {written.about} SI units, angles in rad. */\n#ifndef {guard}\n#define {guard}\n"
    header = f"{_OPEN}{header}\n{_CLOSE}"  # the same functions from C++
    return {f"{name}.h": f"{head}{header}\n#endif\n", f"{name}.c": f'#include "{name}.h"\n{source}'}


_OPEN = '#include <stddef.h>\n#ifdef __cplusplus\nextern "C" {\n#endif\n'
_CLOSE = "#ifdef __cplusplus\n}\n#endif"


def _mechanism(written: Written, name: str) -> tuple[str, str]:
    header, source = [], ["#include <math.h>"]
    for group, tape in written.tapes.items():
        header += [f"/* {line} */" for line in told(written, group)]
        header += [f"void {name}_{group}(const double *v, double *y);"]
        source.append(function(tape, f"{name}_{group}", "void"))
    return "\n".join(header), "\n".join(source)


def _machine(written: Written, name: str) -> tuple[str, str]:
    assert written.block is not None
    places = [
        f"    {name}_{identifier(v.port.name)} = {v.reference}, /* {v.port.unit}, {v.kind} */"
        for v in variables(written.block)
    ]
    header = [
        "/* places of the values that can be got; states, inputs and parameters can be set */",
        "enum {", *places, "};",
        f"size_t {name}_size(void); /* bytes that a machine needs; the caller gives them, aligned for double */",
        f"void {name}_start(void *machine, double tolerance);",
        f"int {name}_set(void *machine, unsigned place, double value); /* 0: cannot be set, or no number */",
        f"double {name}_get(void *machine, unsigned place);",
        f"int {name}_advance(void *machine, double t); /* 1: t reached, 2: a stop ended the run before, 0: failed */",
        f"/* exact change of {name}_get of the places `of` while the places `by` change so much; 0: no such place */",
        f"int {name}_change(const void *machine, const unsigned *of, size_t count_of,",
        "    const unsigned *by, size_t count_by, const double *so_much, double *change);",
    ]  # fmt: skip
    core = (resources.files("mechsym.out") / "c" / "core.h").read_text(encoding="utf-8")
    return "\n".join(header), "\n".join([model(written.block), dop853_numbers(), core, _calls(name)])


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
