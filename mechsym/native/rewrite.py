"""Cheaper forms: a quotient costs as much as ten products, and expressions for machines are full of them.

    a / c                    becomes  a * (1 / c), the reciprocal of a constant being a constant
    a / d and b / d          become   a * r and b * r with one r = 1 / d
    a / sqrt(d)              becomes  a * (sqrt(d) * r), so that root and reciprocal do not wait for each other
    a / d, d known before a  becomes  a * (1 / d), so that the reciprocal is there when a is
    x ** c                   becomes  exp(c * log(x)) for a constant c that is no multiple of one half

The quotients cost one or two more roundings, the power |c log x| units of the last place, so only the mode `fast` does
this. The mode `strict` leaves every operation as it is.
"""

import collections
import dataclasses
import math

from mechsym.native.tape import Tape, prune, wait
from mechsym.quantities import record


@record
class _Work:
    # nodes written so far, the node of each key, and where each old node went
    nodes: list[tuple[str, tuple]] = dataclasses.field(default_factory=list)
    known: dict[tuple[str, tuple], int] = dataclasses.field(default_factory=dict)
    place: dict[int, int] = dataclasses.field(default_factory=dict)


def marked(tape: Tape) -> Tape:
    """The same program with powers whose exponent is a broken constant told apart: they can be vector code.

    Returns
    -------
    tape : Tape
        With the operator `pow_broken`, the same to the last digit
    """
    nodes = [("pow_broken", args) if op == "pow" and _broken(tape, args[1]) else (op, args) for op, args in tape.nodes]
    return dataclasses.replace(tape, nodes=tuple(nodes))


def cheaper(tape: Tape) -> Tape:
    """The same program with reciprocals shared and broken powers taken apart.

    Returns
    -------
    tape : Tape
        By the rules of this module
    """
    multiplied = _multiplied(tape)
    work = _Work()
    for i, (op, args) in enumerate(tape.nodes):
        if op in ("input", "constant"):
            work.place[i] = _put(work, op, args)
        elif op == "inv" or i in multiplied:
            inverse = _reciprocal(tape, work, args[-1])
            work.place[i] = inverse if op == "inv" else _put(work, "mul", (work.place[args[0]], inverse))
        elif op == "pow" and _broken(tape, args[1]):
            exponent = _put(work, "mul", (work.place[args[1]], _put(work, "log", (work.place[args[0]],))))
            work.place[i] = _put(work, "exp", (exponent,))
        else:
            work.place[i] = _put(work, op, tuple([work.place[a] for a in args]))
    nodes, results = prune(work.nodes, [work.place[r] for r in tape.results])
    return dataclasses.replace(tape, nodes=tuple(nodes), results=tuple(results))


def _multiplied(tape: Tape) -> set[int]:
    """Quotients that are better products with a reciprocal."""
    ready: list[int] = []
    uses: collections.Counter[int] = collections.Counter()
    for op, args in tape.nodes:
        ready.append(wait(op) + (0 if op in ("input", "constant") else max([ready[a] for a in args])))
        if op in ("div", "inv"):
            uses[_base(tape, args[-1])] += 1
    return {
        i
        for i, (op, args) in enumerate(tape.nodes)
        if op == "div"
        and (
            tape.nodes[args[1]][0] in ("constant", "sqrt")
            or uses[_base(tape, args[1])] > 1
            or ready[args[0]] > ready[args[1]]
        )
    }


def _base(tape: Tape, d: int) -> int:
    """What is really divided by: sqrt(d) and d * d go through the reciprocal of d."""
    op, args = tape.nodes[d]
    return args[0] if op in ("sqrt", "sq") else d


def _put(work: _Work, op: str, args: tuple) -> int:
    found = work.known.setdefault((op, args), len(work.nodes))
    if found == len(work.nodes):
        work.nodes.append((op, args))
    return found


def _broken(tape: Tape, exponent: int) -> bool:
    op, args = tape.nodes[exponent]
    return op == "constant" and math.isfinite(args[0]) and 2 * args[0] != int(2 * args[0])


def _reciprocal(tape: Tape, work: _Work, d: int) -> int:
    op, args = tape.nodes[d]
    if op == "constant":
        return _put(work, "constant", (1.0 / args[0] if args[0] else float("inf"),))
    if op == "sqrt":
        return _put(work, "mul", (work.place[d], _put(work, "inv", (work.place[args[0]],))))
    if op == "sq":
        return _put(work, "sq", (_put(work, "inv", (work.place[args[0]],)),))
    return _put(work, "inv", (work.place[d],))
