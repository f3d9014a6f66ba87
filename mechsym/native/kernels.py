"""Equal parts of a program found and rolled into loops.

A machine with N throws has N times the same instructions with other inputs and constants. Outputs that share a costly
value (a sine, a root, a quotient) belong together; two such groups are of one form when their programs differ only in
which inputs and which constants stand at the leaves. Groups of one form become one kernel with several instances, so
that the text, and with it the time to compile it, does not grow with N.

Constants are data, not text: two sets of parameters share the compiled file.

In a collocation the derivative by the state at a node is a sum of what its two neighbours contribute. Taken as a whole
such a program is one chain that cannot be rolled. `split` makes two stages of it: everything that depends on the costly
values of one group only is computed first, group by group; what mixes groups, cheap sums in practice, comes second and
reads the values of the first stage as inputs.
"""

import dataclasses

import numpy as np

from mechsym.native.tape import CHEAP, Node, Tape, literal, prune
from mechsym.quantities import record

# a loop is worth its index tables only when it saves this many operations and assignments
_WORTH = 32
# rolling computes shared cheap values once per instance; not if that costs more than this factor
_DEARER = 1.2


@record
class Kernel:
    """One body of straight-line code and the places it is applied to."""

    #: As in `Tape`, but `("input", (i,))` and `("constant", (j,))` count leaves of the instance
    nodes: tuple[Node, ...]
    results: tuple[int, ...]  #: Node of each result of an instance
    #: For each instance the program's inputs and outputs that it reads and writes
    inputs: tuple[tuple[int, ...], ...]
    outputs: tuple[tuple[int, ...], ...]
    constants: tuple[tuple[float, ...], ...]  #: numbers of the program text [-]


@record
class _Part:
    nodes: tuple[Node, ...]
    results: tuple[int, ...]
    inputs: tuple[int, ...]
    outputs: tuple[int, ...]
    constants: tuple[float, ...]  #: numbers of the program text [-]


def kernels(tape: Tape) -> tuple[Kernel, ...]:
    """The program as kernels, one where nothing repeats; every output is written by exactly one instance."""
    families: dict[tuple[tuple[Node, ...], tuple[int, ...]], list[_Part]] = {}
    for group in _groups(tape):
        part = _part(tape, group)
        families.setdefault((part.nodes, part.results), []).append(part)
    rolled: list[Kernel] = []
    single: list[int] = []
    for parts in families.values():
        size = _operations(parts[0]) + len(parts[0].outputs)
        if size * (len(parts) - 1) >= _WORTH:
            rolled.append(_kernel(parts))
        else:
            single += [o for p in parts for o in p.outputs]
    if single:
        rolled.append(_kernel([_part(tape, sorted(single))]))
    total = sum(_operations(p) * len(p.inputs) for p in rolled)
    return tuple(rolled) if total <= _DEARER * _operations(tape) else (whole(tape),)


def whole(tape: Tape) -> Kernel:
    """The program as one kernel with one instance."""
    return _kernel([_part(tape, list(range(len(tape.results))))])


def _operations(part: _Part | Kernel | Tape) -> int:
    return sum(op not in ("input", "constant", "literal") for op, _ in part.nodes)


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
    nodes: list[Node] = []
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


def constant_table(kernels: tuple[Kernel, ...]) -> np.ndarray:
    """Constants in the order in which the C code reads them, instance after instance; never empty [SI]."""
    values = [v for kernel in kernels for row in kernel.constants for v in row]
    return np.array(values or [0.0])


def split(tape: Tape) -> tuple[Tape, Tape] | None:
    """The two stages of a program.

    Returns stages: the first gives intermediate values; the second takes the program's inputs followed by these. None
    where nothing mixes.
    """
    labels = _labels(tape)
    mixed = [len(groups) > 1 for groups in labels]
    if not any(mixed):
        return None
    values = {r for r in tape.results if not mixed[r] and labels[r]}
    for i, (op, args) in enumerate(tape.nodes):
        if mixed[i] and op not in ("input", "constant"):
            values |= {a for a in args if labels[a] and not mixed[a]}
    return cut(tape, sorted(values))


def cut(tape: Tape, values: list[int]) -> tuple[Tape, Tape]:
    """A program that gives the values of some nodes, and the rest, which takes them behind its inputs."""
    nodes, results = prune(list(tape.nodes), values)
    outputs = tuple(f"v{i}" for i in range(len(values)))
    first = dataclasses.replace(
        tape, name=f"{tape.name}_first", outputs=outputs, nodes=tuple(nodes), results=tuple(results)
    )
    place = {node: len(tape.inputs) + k for k, node in enumerate(values)}
    rest: list[Node] = []
    number: dict[int, int] = {}
    for i, (op, args) in enumerate(tape.nodes):
        if i in place:
            op, args = "input", (place[i],)
        elif op not in ("input", "constant"):
            if any(a not in number for a in args):
                continue  # inside the first stage
            args = tuple(number[a] for a in args)
        number[i] = len(rest)
        rest.append((op, args))
    rest, results = prune(rest, [number[r] for r in tape.results])
    second = dataclasses.replace(
        tape,
        name=f"{tape.name}_second",
        inputs=(*tape.inputs, *first.outputs),
        nodes=tuple(rest),
        results=tuple(results),
    )
    return first, second


def _labels(tape: Tape) -> list[set[int]]:
    """Groups of costly values that each node depends on; a costly node makes one group of all it depends on."""
    parent: dict[int, int] = {}

    def root(i: int) -> int:
        while parent[i] != i:
            parent[i] = parent[parent[i]]
            i = parent[i]
        return i

    labels: list[set[int]] = []
    for i, (op, args) in enumerate(tape.nodes):
        below = set() if op in ("input", "constant") else {root(c) for a in args for c in labels[a]}
        if op not in CHEAP and op not in ("input", "constant"):
            parent[i] = i
            for c in below:
                parent[c] = i
            below = {i}
        labels.append(below)
    return [{root(c) for c in group} for group in labels]
