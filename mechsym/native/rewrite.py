"""Cheaper forms: a quotient costs as much as ten products, and expressions for machines are full of them.

    a / c                 becomes  a * (1 / c), the reciprocal of a constant being a constant
    a / d and b / d       become   a * r and b * r with one r = 1 / d
    a / d and b / sqrt(d) become   a * r * r and b * r with one r = 1 / sqrt(d)
    x ** c                becomes  exp(c * log(x)) for a constant c that is no multiple of one half

The first three cost one more rounding, the last |c log x| units of the last place, so only the mode `fast` does it.
"""

import dataclasses
import math

from mechsym.native.tape import Tape, prune


@dataclasses.dataclass(frozen=True, kw_only=True)
class _Work:
    # nodes written so far, the node of each key, and where each old node went
    nodes: list[tuple[str, tuple]] = dataclasses.field(default_factory=list)
    known: dict[tuple[str, tuple], int] = dataclasses.field(default_factory=dict)
    place: dict[int, int] = dataclasses.field(default_factory=dict)


def cheaper(tape: Tape) -> Tape:
    """The same program with reciprocals shared and broken powers taken apart.

    Parameters
    ----------
    tape : Tape
        A program

    Returns
    -------
    tape : Tape
        By the rules of this module
    """
    denominators = [_denominator(op, args) for op, args in tape.nodes]
    uses = {d: denominators.count(d) for d in denominators if d is not None}
    roots = {args[0]: i for i, (op, args) in enumerate(tape.nodes) if op == "sqrt"}
    work = _Work()
    for i, (op, args) in enumerate(tape.nodes):
        if op in ("input", "constant"):
            work.place[i] = _put(work, op, args)
        elif op in ("div", "inv") and _shared(tape, uses, roots, args[-1]):
            inverse = _reciprocal(tape, work, uses, roots, args[-1])
            work.place[i] = inverse if op == "inv" else _put(work, "mul", (work.place[args[0]], inverse))
        elif op == "pow" and _broken(tape, args[1]):
            exponent = _put(work, "mul", (work.place[args[1]], _put(work, "log", (work.place[args[0]],))))
            work.place[i] = _put(work, "exp", (exponent,))
        else:
            work.place[i] = _put(work, op, tuple(work.place[a] for a in args))
    nodes, results = prune(work.nodes, [work.place[r] for r in tape.results])
    return dataclasses.replace(tape, nodes=tuple(nodes), results=tuple(results))


def _denominator(op: str, args: tuple) -> int | None:
    return args[-1] if op in ("div", "inv") else None


def _broken(tape: Tape, exponent: int) -> bool:
    op, args = tape.nodes[exponent]
    return op == "constant" and math.isfinite(args[0]) and 2 * args[0] != int(2 * args[0])


def _shared(tape: Tape, uses: dict[int, int], roots: dict[int, int], d: int) -> bool:
    op, args = tape.nodes[d]
    return op == "constant" or uses[d] > 1 or roots.get(d) in uses or (op == "sq" and args[0] in uses)


def _put(work: _Work, op: str, args: tuple) -> int:
    if (op, args) not in work.known:
        work.known[op, args] = len(work.nodes)
        work.nodes.append((op, args))
    return work.known[op, args]


def _reciprocal(tape: Tape, work: _Work, uses: dict[int, int], roots: dict[int, int], d: int) -> int:
    op, args = tape.nodes[d]
    if op == "constant":
        return _put(work, "constant", (1.0 / args[0] if args[0] else float("inf"),))
    if roots.get(d) in uses:
        # the root may come later in the program; what it is taken of is there already
        root = _put(work, "sqrt", (work.place[d],))
        return _put(work, "sq", (_put(work, "inv", (root,)),))
    if op == "sq" and args[0] in uses:
        return _put(work, "sq", (_put(work, "inv", (work.place[args[0]],)),))
    return _put(work, "inv", (work.place[d],))
