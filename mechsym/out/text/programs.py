"""What is written: the functions of a mechanism with its parameters as arguments, or those of a block."""

from collections.abc import Mapping

import casadi as ca

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
        name=block.name, about=block.about, tapes={"rates": read(block.rates), "observed": read(block.observed)},
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
