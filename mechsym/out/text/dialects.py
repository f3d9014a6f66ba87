"""What is written, the functions of a mechanism or of a block, and how each language writes a number and a statement.

Statements of a tape in a dialect: each value has one name and is written once. `dialects.csv` has a column a language:
its patterns for a statement (name, value) and a comment, its infinity, then an operator a row, places for operands;
an empty field: the language has no word for it.
"""

import csv
import math
from collections.abc import Callable, Mapping
from importlib import resources

import casadi as ca

from mechsym.errors import BadInput
from mechsym.mechanisms.record import bind, generated, listing
from mechsym.native.tape import Tape, read
from mechsym.out.block import Block
from mechsym.quantities import record


@record
class Written:
    """Functions of one array v each, to be written in any language."""

    name: str
    about: str
    tapes: Mapping[str, Tape]  #: by the name of the function
    inputs: Mapping[str, tuple[str, ...]]  #: names of the entries of v, by function
    outputs: Mapping[str, tuple[str, ...]]
    units: Mapping[str, str]  #: by name of an input or output
    block: Block | None = None  #: curves, starts and events of a machine


def of_mechanism(name: str) -> Written:
    """The functions of a derived mechanism: coordinates, velocities, inputs and parameters are arguments.

    Raises BadInput: no such mechanism, or one that is put together from data.
    """
    mechanism = bind(name, {p: ca.SX.sym(p) for p in generated(name).PARAMETERS})
    known = listing(name)
    units = known["coordinates"] | known["parameters"] | known["inputs"] | known["outputs"]
    groups = {group: f for group, f in mechanism.functions.items() if f.numel_out()}
    return Written(
        name=known["name"],
        about=known["about"],
        tapes={g: read(f) for g, f in groups.items()},
        inputs={g: tuple(f.name_in()) for g, f in groups.items()},
        outputs={g: read(f).outputs for g, f in groups.items()},
        units=units,
    )


def of_block(block: Block) -> Written:
    """The functions of a block: rates of the states, and its outputs."""
    names = ["time", *(p.name for p in (*block.states, *block.inputs, *block.parameters))]
    names += [f"{c.name}_{what}" for c in block.curves for what in ("value", "slope")]
    names += [f"switch_{i + 1}" for i in range(len(block.switches))]
    ports = (*block.states, *block.inputs, *block.parameters, *block.outputs)
    return Written(
        name=block.name, about=block.about,
        tapes={f.name(): read(block.whole(f)) for f in (block.rates, block.observed)},
        inputs={"rates": tuple(names), "observed": tuple(names)},
        outputs={"rates": tuple(f"der_{s.name}" for s in block.states),
                 "observed": tuple(p.name for p in block.outputs)},
        units={p.name: p.unit for p in ports}, block=block,
    )  # fmt: skip


def told(written: Written, function: str) -> list[str]:
    """What stands in v and y of a function, with units, one line each."""
    sides = {"v": written.inputs[function], "y": written.outputs[function]}
    rows = {side: [f"{n} [{written.units.get(n, 'SI')}]" for n in names] for side, names in sides.items()}
    return [f"{side}: {', '.join(names)}" for side, names in rows.items()]


@record
class Dialect:
    """A language: operators with places for operands, a pattern for a statement (name, value), and its infinity."""

    name: str
    operators: Mapping[str, str]
    statement: str
    infinity: str
    comment: str

    def says(self, text: str) -> str:
        """A comment of one line; words of a user cannot end it and go on as code."""
        return self.comment.format(" ".join(text.split()).replace("*/", "* /").replace("/*", "/ *"))


def _dialect(name: str) -> Dialect:
    text = (resources.files("mechsym.out.text") / "dialects.csv").read_text(encoding="utf-8")
    words = {row["operator"]: row[name] for row in csv.DictReader(text.splitlines()) if row[name]}
    statement, infinity, comment = (words.pop(what) for what in ("statement", "infinity", "comment"))
    return Dialect(name=name, operators=words, statement=statement, infinity=infinity, comment=comment)


C99, JULIA, MATLAB, JAX, MODELICA = (_dialect(name) for name in ("c", "julia", "matlab", "jax", "modelica"))


def number(dialect: Dialect, value: float) -> str:
    """A constant in a language, to the last digit [any unit]."""
    if math.isnan(value):
        raise BadInput("the function holds a constant that is not a number; check the parameters")
    if math.isinf(value):
        return dialect.infinity if value > 0 else f"(-{dialect.infinity})"
    return repr(float(value)) if value >= 0 else f"({float(value)!r})"


def operation(dialect: Dialect, operator: str, operands: list[str]) -> str:
    """One operation on names and numbers."""
    if operator not in dialect.operators:
        known = ", ".join(sorted(dialect.operators))
        raise BadInput(f"operator {operator!r} has no word in {dialect.name}; it has {known}")
    return dialect.operators[operator].format(*operands)


def statements(tape: Tape, dialect: Dialect, place: Callable[[int], str]) -> tuple[list[str], list[str]]:
    """Statements that compute a tape, and the text of each result; `place` says where input i is read."""
    names: list[str] = []
    lines: list[str] = []
    for i, (operator, operands) in enumerate(tape.nodes):
        if operator == "input":
            names.append(place(operands[0]))
        elif operator == "constant":
            names.append(number(dialect, operands[0]))
        else:
            names.append(f"t{i}")
            value = operation(dialect, operator, [names[k] for k in operands])
            lines.append(dialect.statement.format(names[-1], value))
    return lines, [names[r] for r in tape.results]
