"""Equal parts of a program found and rolled into loops.

A machine with N throws has N times the same instructions with other inputs and constants. Outputs that share a costly
value (a sine, a root, a quotient) belong together; two such groups are of one form when their programs differ only in
which inputs and which constants stand at the leaves. Groups of one form become one kernel with several instances, so
that the text, and with it the time to compile it, does not grow with N.

Constants are data, not text: two sets of parameters share the compiled file.
"""

import numpy as np

from mechsym.native.dialects import literal
from mechsym.native.tape import CHEAP, Tape
from mechsym.quantities import record

# a loop is worth its index tables only when it saves this many operations and assignments
_WORTH = 32
# rolling computes shared cheap values once per instance; not if that costs more than this factor
_DEARER = 1.2


@record
class Kernel:
    """One body of straight-line code and the places it is applied to."""

    #: As in `Tape`, but `("input", (i,))` and `("constant", (j,))` count leaves of the instance
    nodes: tuple[tuple[str, tuple], ...]
    results: tuple[int, ...]  #: Node of each result of an instance
    #: For each instance the program's inputs and outputs that it reads and writes
    inputs: tuple[tuple[int, ...], ...]
    outputs: tuple[tuple[int, ...], ...]
    constants: tuple[tuple[float, ...], ...]  #: numbers of the program text [-]


@record
class _Part:
    nodes: tuple[tuple[str, tuple], ...]
    results: tuple[int, ...]
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    constants: tuple[float, ...]  #: numbers of the program text [-]


def kernels(tape: Tape) -> tuple[Kernel, ...]:
    """The program as kernels.

    Returns
    -------
    kernels : tuple of Kernel
        One with one instance where nothing repeats; every output is written by exactly one instance
    """
    families: dict[tuple, list[_Part]] = {}
    for group in _groups(tape):
        part = _part(tape, group)
        families.setdefault((part.nodes, part.results), []).append(part)
    rolled = [parts for parts in families.values() if _size(parts[0]) * (len(parts) - 1) >= _WORTH]
    single = sorted(o for parts in families.values() if parts not in rolled for p in parts for o in p.outputs)
    loops = [_kernel(parts) for parts in rolled]
    rest = [_kernel([_part(tape, single)])] if single else []
    found = tuple(loops + rest)
    total = sum(_operations(p) * len(p.inputs) for p in found)
    return found if total <= _DEARER * _operations(tape) else (whole(tape),)


def whole(tape: Tape) -> Kernel:
    """The program as one kernel with one instance."""
    return _kernel([_part(tape, list(range(len(tape.results))))])


def _operations(part: _Part | Kernel | Tape) -> int:
    return sum(op not in ("input", "constant", "literal") for op, _ in part.nodes)


def _size(part: _Part) -> int:
    return _operations(part) + len(part.outputs)


def _groups(tape: Tape) -> list[list[int]]:
    # bit set of the costly values that each node depends on; outputs with a common bit are linked
    masks: list[int] = []
    bit = 1
    for op, args in tape.nodes:
        mask = 0
        if op not in ("input", "constant"):
            for a in args:
                mask |= masks[a]
            if op not in CHEAP:
                mask |= bit
                bit <<= 1
        masks.append(mask)
    groups: list[tuple[int, list[int]]] = []
    for output, result in enumerate(tape.results):
        mask, members = masks[result], [output]
        apart = []
        for other, outputs in groups:
            if other & mask:
                mask, members = mask | other, outputs + members
            else:
                apart.append((other, outputs))
        groups = [*apart, (mask, sorted(members))]
    return sorted(members for _, members in groups)


def _part(tape: Tape, outputs: list[int]) -> _Part:
    nodes: list[tuple[str, tuple]] = []
    place: dict[int, int] = {}
    inputs: list[int] = []
    constants: list[float] = []
    for root in (tape.results[o] for o in outputs):
        for i in _order(tape, root, place):
            op, args = tape.nodes[i]
            if op == "input":
                args = (len(inputs),)
                inputs.append(tape.nodes[i][1][0])
            elif op == "constant" and literal(args[0]) is not None:
                op = "literal"
            elif op == "constant":
                constants.append(args[0])
                args = (len(constants) - 1,)
            else:
                args = tuple([place[a] for a in args])
            place[i] = len(nodes)
            nodes.append((op, args))
    return _Part(
        nodes=tuple(nodes),
        results=tuple(place[tape.results[o]] for o in outputs),
        inputs=tuple(inputs),
        outputs=tuple(outputs),
        constants=tuple(constants),
    )


def _order(tape: Tape, root: int, done: dict[int, int]) -> list[int]:
    # operands before their users, visited from left to right: equal programs come out in equal order; what is found
    # has no number in `done` yet
    order: list[int] = []
    stack = [root]
    while stack:
        node = stack.pop()
        if node < 0:
            order.append(~node)
        elif node not in done:
            done[node] = -1
            op, args = tape.nodes[node]
            if op in ("input", "constant"):
                order.append(node)
            else:
                stack.append(~node)  # again, when its operands are there
                stack.extend(reversed(args))
    return order


def _kernel(parts: list[_Part]) -> Kernel:
    return Kernel(
        nodes=parts[0].nodes,
        results=parts[0].results,
        inputs=tuple(p.inputs for p in parts),
        outputs=tuple(p.outputs for p in parts),
        constants=tuple(p.constants for p in parts),
    )


def constant_table(found: tuple[Kernel, ...]) -> np.ndarray:
    """The constants of all kernels in the order in which the C code reads them.

    Returns
    -------
    table : ndarray, shape (n,)
        Instance after instance, kernel after kernel; never empty [SI]
    """
    values = [v for kernel in found for row in kernel.constants for v in row]
    return np.array(values or [0.0])
