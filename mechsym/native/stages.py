"""A program in two stages, so that sums over nodes do not tie all nodes together.

In a collocation the derivative by the state at a node is a sum of what its two neighbours contribute. Taken as a whole
such a program is one chain that cannot be rolled (see `kernels`). Here everything that depends on the costly values of
one group only is computed first, group by group; what mixes groups, cheap sums in practice, comes second and reads
the values of the first stage as inputs.
"""

import dataclasses

from mechsym.native.tape import CHEAP, Tape, prune


def split(tape: Tape) -> tuple[Tape, Tape] | None:
    """The two stages of a program.

    Returns
    -------
    stages : tuple of Tape, or None
        The first gives intermediate values; the second takes the program's inputs followed by these. None where
        nothing mixes
    """
    labels = _labels(tape)
    mixed = [len(found) > 1 for found in labels]
    if not any(mixed):
        return None
    kept = {r for r in tape.results if not mixed[r] and labels[r]}
    for i, (op, args) in enumerate(tape.nodes):
        if mixed[i] and op not in ("input", "constant"):
            kept |= {a for a in args if labels[a] and not mixed[a]}
    return cut(tape, sorted(kept))


def cut(tape: Tape, values: list[int]) -> tuple[Tape, Tape]:
    """A program that gives the values of some nodes, and the rest, which takes them behind its inputs."""
    nodes, results = prune(list(tape.nodes), values)
    first = dataclasses.replace(
        tape, name=f"{tape.name}_first", outputs=tuple(f"v{i}" for i in range(len(values))), nodes=tuple(nodes),
        results=tuple(results),
    )  # fmt: skip
    return first, _second(tape, values)


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
    return [{root(c) for c in found} for found in labels]


def _second(tape: Tape, values: list[int]) -> Tape:
    place = {node: len(tape.inputs) + k for k, node in enumerate(values)}
    nodes: list[tuple[str, tuple]] = []
    number: dict[int, int] = {}
    for i, (op, args) in enumerate(tape.nodes):
        if i in place:
            op, args = "input", (place[i],)
        elif op not in ("input", "constant"):
            if any(a not in number for a in args):
                continue  # inside the first stage
            args = tuple(number[a] for a in args)
        number[i] = len(nodes)
        nodes.append((op, args))
    nodes, results = prune(nodes, [number[r] for r in tape.results])
    return dataclasses.replace(
        tape,
        name=f"{tape.name}_second",
        inputs=(*tape.inputs, *(f"v{k}" for k in range(len(values)))),
        nodes=tuple(nodes),
        results=tuple(results),
    )
