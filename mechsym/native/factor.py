"""Common factors taken out of sums: a b w + c d w becomes (a b + c d) w.

Equations of motion are full of them: every term of the bias carries the square of a speed. Only products that are used
once are taken apart, so nothing is computed twice. The order of the factors changes, so only the mode `fast` does it.
"""

import collections
import dataclasses
import math

from mechsym.native.tape import Tape, prune, wait
from mechsym.quantities import record

_PRODUCTS, _SUMS = ("mul", "sq"), ("add", "sub")


@record
class _Factoring:
    # nodes written so far and when they are known, the node of each key, where old nodes went, and products that are
    # not written yet
    nodes: list[tuple[str, tuple]] = dataclasses.field(default_factory=list)
    ready: list[int] = dataclasses.field(default_factory=list)
    known: dict[tuple[str, tuple], int] = dataclasses.field(default_factory=dict)
    place: dict[int, int] = dataclasses.field(default_factory=dict)
    waiting: dict[int, list[int]] = dataclasses.field(default_factory=dict)


def factored(tape: Tape) -> Tape:
    """The same program with common factors of two terms taken out.

    Returns
    -------
    tape : Tape
        With as many sums and fewer products
    """
    only = _only_users(tape)
    work = _Factoring()
    for i, (op, args) in enumerate(tape.nodes):
        once = only[i] >= 0 and tape.nodes[only[i]][0] in ("mul", "add", "sub")
        factors = _factors(work, op, args)
        if factors and once:
            work.waiting[i] = factors
        elif factors:
            work.place[i] = _written(work, factors)
        elif op in ("input", "constant"):
            work.place[i] = _put(work, op, args)
        else:
            work.place[i] = _put(work, op, tuple([_value(work, a) for a in args]))
    nodes, results = prune(work.nodes, [work.place[r] for r in tape.results])
    return dataclasses.replace(tape, nodes=tuple(nodes), results=tuple(results))


def _only_users(tape: Tape) -> list[int]:
    """For each node the only one that uses it, -1 where there are several or it is a result."""
    only, seen = [-1] * len(tape.nodes), [False] * len(tape.nodes)
    for i, (op, args) in enumerate(tape.nodes):
        for a in args if op not in ("input", "constant") else ():
            only[a], seen[a] = -1 if seen[a] else i, True
    for r in tape.results:
        only[r] = -1
    return only


def _factors(work: _Factoring, op: str, args: tuple) -> list[int]:
    """The node as a product, empty when it is none."""
    if op == "mul":
        return _parts(work, args[0]) + _parts(work, args[1])
    if op == "sq":
        return [work.place[args[0]]] * 2
    if op not in _SUMS:
        return []
    left, right = (_parts(work, a) for a in args)
    if set(left).isdisjoint(right):
        return []
    rest = collections.Counter(right)
    common = []
    for factor in list(left):
        if rest[factor] and len(left) > 1 and sum(rest.values()) > 1:
            rest[factor] -= 1
            left.remove(factor)
            common.append(factor)
    if not common:
        return []
    remaining = [f for f in right if _taken(rest, f)]
    return [*common, _put(work, op, (_written(work, left), _written(work, remaining)))]


def _taken(rest: collections.Counter, factor: int) -> bool:
    if rest[factor]:
        rest[factor] -= 1
        return True
    return False


def _parts(work: _Factoring, node: int) -> list[int]:
    return list(work.waiting.get(node) or [work.place[node]])


def _value(work: _Factoring, node: int) -> int:
    return work.place[node] if node in work.place else _written(work, work.waiting[node])


def _written(work: _Factoring, factors: list[int]) -> int:
    """Multiply factors; constants among them become one."""
    if len(factors) == 1:
        return factors[0]
    constants = [f for f in factors if work.nodes[f][0] == "constant"]
    others = [f for f in factors if work.nodes[f][0] != "constant"]
    if len(constants) > 1:
        constants = [_put(work, "constant", (math.prod([work.nodes[f][1][0] for f in constants]),))]
    # what is known first is multiplied first, so that the latest value waits for one product only; equal ones keep
    # their order, so that equal parts of a program stay equal
    product, *more = sorted(constants + others, key=work.ready.__getitem__)
    for f in more:
        product = _put(work, "sq", (f,)) if f == product else _put(work, "mul", (product, f))
    return product


def _put(work: _Factoring, op: str, args: tuple) -> int:
    found = work.known.setdefault((op, args), len(work.nodes))
    if found == len(work.nodes):
        work.nodes.append((op, args))
        work.ready.append(wait(op) + (0 if op in ("input", "constant") else max([work.ready[a] for a in args])))
    return found
