"""Cheaper forms: a quotient costs as much as ten products, and expressions for machines are full of them.

    a / c                    becomes  a * (1 / c), the reciprocal of a constant being a constant
    a / d and b / d          become   a * r and b * r with one r = 1 / d
    a / sqrt(d)              becomes  a * (sqrt(d) * r), so that root and reciprocal do not wait for each other
    a / d, d known before a  becomes  a * (1 / d), so that the reciprocal is there when a is
    x ** c                   becomes  exp(c * log(x)) for a constant c that is no multiple of one half

    a b w + c d w            becomes  (a b + c d) w, as every term of the bias carries the square of a speed

The quotients cost one or two more roundings, the power |c log x| units of the last place, and factors change their
order, so only the mode `fast` does this; the mode `strict` leaves every operation as it is. Only products that are used
once are taken apart into factors, so nothing is computed twice.
"""

import collections
import dataclasses
import math
from collections.abc import Callable
from typing import Any

from mechsym.native.tape import Nodes, Tape, prune, wait


def marked(tape: Tape) -> Tape:
    """The same program with powers whose exponent is a broken constant told apart: they can be vector code.

    Returns tape: with the operator `pow_broken`, the same to the last digit.
    """
    nodes = [("pow_broken", args) if op == "pow" and _broken(tape, args[1]) else (op, args) for op, args in tape.nodes]
    return dataclasses.replace(tape, nodes=tuple(nodes))


def cheaper(tape: Tape) -> Tape:
    """The same program with reciprocals shared and broken powers taken apart, by the rules of this module."""
    multiplied = _multiplied(tape)
    written, place = Nodes(), {}
    put = written.put
    for i, (op, args) in enumerate(tape.nodes):
        if op in ("input", "constant"):
            place[i] = put(op, args)
        elif op == "inv" or i in multiplied:
            inverse = _reciprocal(tape, put, place, args[-1])
            place[i] = inverse if op == "inv" else put("mul", (place[args[0]], inverse))
        elif op == "pow" and _broken(tape, args[1]):
            place[i] = put("exp", (put("mul", (place[args[1]], put("log", (place[args[0]],)))),))
        else:
            place[i] = put(op, tuple([place[a] for a in args]))
    nodes, results = prune(written.nodes, [place[r] for r in tape.results])
    return dataclasses.replace(tape, nodes=tuple(nodes), results=tuple(results))


def _multiplied(tape: Tape) -> set[int]:
    """Quotients that are better products with a reciprocal."""
    ready: list[int] = []
    uses: collections.Counter[int] = collections.Counter()
    for op, args in tape.nodes:
        ready.append(wait(op) + (0 if op in ("input", "constant") else max([ready[a] for a in args])))
        if op in ("div", "inv"):
            uses[_base(tape, args[-1])] += 1
    multiplied = set()
    for i, (op, args) in enumerate(tape.nodes):
        if op == "div":
            simple = tape.nodes[args[1]][0] in ("constant", "sqrt")
            if simple or uses[_base(tape, args[1])] > 1 or ready[args[0]] > ready[args[1]]:
                multiplied.add(i)
    return multiplied


def _base(tape: Tape, d: int) -> int:
    """What is really divided by: sqrt(d) and d * d go through the reciprocal of d."""
    op, args = tape.nodes[d]
    return args[0] if op in ("sqrt", "sq") else d


def _broken(tape: Tape, exponent: int) -> bool:
    op, args = tape.nodes[exponent]
    return op == "constant" and math.isfinite(args[0]) and 2 * args[0] != int(2 * args[0])


def _reciprocal(tape: Tape, put: Callable[[str, tuple[Any, ...]], int], place: dict[int, int], d: int) -> int:
    op, args = tape.nodes[d]
    if op == "constant":
        return put("constant", (1.0 / args[0] if args[0] else float("inf"),))
    if op == "sqrt":
        return put("mul", (place[d], put("inv", (place[args[0]],))))
    if op == "sq":
        return put("sq", (put("inv", (place[args[0]],)),))
    return put("inv", (place[d],))


_PRODUCTS, _SUMS = ("mul", "sq"), ("add", "sub")


class _Factoring(Nodes):
    """Nodes written so far, where old ones went, and products that are not written yet."""

    def __init__(self) -> None:
        super().__init__()
        self.place: dict[int, int] = {}
        self.waiting: dict[int, list[int]] = {}


def factored(tape: Tape) -> Tape:
    """The same program with common factors of two terms taken out: as many sums and fewer products."""
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
            work.place[i] = work.put(op, args)
        else:
            places = [work.place[a] if a in work.place else _written(work, work.waiting[a]) for a in args]
            work.place[i] = work.put(op, tuple(places))
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


def _factors(work: _Factoring, op: str, args: tuple[Any, ...]) -> list[int]:
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
    remaining = []
    for factor in right:
        if rest[factor]:
            rest[factor] -= 1
            remaining.append(factor)
    return [*common, work.put(op, (_written(work, left), _written(work, remaining)))]


def _parts(work: _Factoring, node: int) -> list[int]:
    return list(work.waiting.get(node) or [work.place[node]])


def _written(work: _Factoring, factors: list[int]) -> int:
    """Multiply factors; constants among them become one."""
    if len(factors) == 1:
        return factors[0]
    constants = [f for f in factors if work.nodes[f][0] == "constant"]
    others = [f for f in factors if work.nodes[f][0] != "constant"]
    if len(constants) > 1:
        constants = [work.put("constant", (math.prod([work.nodes[f][1][0] for f in constants]),))]
    # what is known first is multiplied first, so that the latest value waits for one product only; equal ones keep
    # their order, so that equal parts of a program stay equal
    product, *more = sorted(constants + others, key=work.ready.__getitem__)
    for f in more:
        product = work.put("sq", (f,)) if f == product else work.put("mul", (product, f))
    return product
