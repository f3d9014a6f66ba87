"""A CasADi function as a list of plain instructions, each value named once.

CasADi keeps an SX function as a tape: instructions over a work vector whose places are used again and again. Here
every place is renamed on each write, so that a value has one definition, equal instructions are merged and unused ones
dropped. Everything that writes code (`source`) starts from this record.

How each operator is written in C and in numpy. C names with the prefix `ms_` are in `c/elementary.h`: branch-free, so
that a loop over them becomes vector instructions. What stays a call of the C library is right but is computed one
number at a time.

Cheaper forms: a quotient costs as much as ten products, and expressions for machines are full of them.

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
import csv
import dataclasses
import functools
import math
from collections.abc import Callable
from importlib import resources
from typing import Any

import casadi

from mechsym.errors import BadInput
from mechsym.quantities import record
from mechsym.quantities.units import Pure

#: Operator and operands. Operands are indices of earlier nodes, except for `("input", (i,))` and `("constant",
#: (value,))`
Node = tuple[str, tuple[Any, ...]]

# opcodes whose meaning is another one's
_SAME = {"constpow": "pow"}
# operators that cost about one cycle; everything else is called expensive here
CHEAP = frozenset({"add", "sub", "mul", "neg", "sq", "twice", "fabs"})
# operators that have all derivatives wherever they have a value
ANALYTIC = frozenset({
    "input", "constant", "add", "sub", "mul", "div", "neg", "inv", "sq", "twice", "sqrt", "exp", "log", "pow",
    "pow_broken", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh", "tanh",
})  # fmt: skip
# processor cycles until a result is there, roughly alike on all processors of today; 4 where nothing is said
_WAIT = {"input": 0, "constant": 0, "div": 14, "inv": 14, "sqrt": 18, "sin": 45, "cos": 45, "exp": 60, "log": 50,
         "pow": 120, "pow_broken": 120}  # fmt: skip


@record
class Tape:
    """Straight-line program of a function of scalars."""

    name: str
    #: Names of the scalar inputs and outputs, elements of a vector as `y[0]`, `y[1]`
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    nodes: tuple[Node, ...]
    results: tuple[int, ...]


class Nodes:
    """A program while it is written: equal nodes become one."""

    def __init__(self) -> None:
        self.nodes: list[Node] = []
        self.ready: list[int] = []  # processor cycles until each value is there
        self.known: dict[Node, int] = {}

    def put(self, op: str, args: tuple[Any, ...]) -> int:
        """The place of a node, which is written where it is new."""
        place = self.known.setdefault((op, args), len(self.nodes))
        if place == len(self.nodes):
            self.nodes.append((op, args))
            self.ready.append(wait(op) + (0 if op in ("input", "constant") else max([self.ready[a] for a in args])))
        return place


@functools.cache
def _operators() -> dict[int, str]:
    names = {getattr(casadi, n): n[3:].lower() for n in dir(casadi) if n.startswith("OP_")}
    return {code: _SAME.get(name, name) for code, name in names.items()}


def _names(slots: list[tuple[str, int]]) -> tuple[str, ...]:
    return tuple(name if size == 1 else f"{name}[{j}]" for name, size in slots for j in range(size))


def read(function: casadi.Function) -> Tape:
    """The tape of a CasADi function, merged and without dead code.

    function: SX function, or an MX function that can be expanded. Returns tape: its straight-line program; elements of
    a sparse output that are not stored are zero.
    """
    if not function.is_a("SXFunction"):
        try:
            expanded = function.expand()
            calls = [k for k in range(expanded.n_instructions()) if expanded.instruction_id(k) == casadi.OP_CALL]
            reason = "it calls another function"
        except RuntimeError as error:
            calls, reason = [-1], str(error).strip().splitlines()[-1]
        if calls:
            raise BadInput(
                f"function {function.name()} cannot be written as elementary operations ({reason}); "
                "build it from SX expressions"
            )
        function = expanded
    ins = [(function.name_in(i), function.numel_in(i)) for i in range(function.n_in())]
    outs = [(function.name_out(i), function.numel_out(i)) for i in range(function.n_out())]
    nodes, results = prune(*_renamed(function, [n for _, n in ins], [n for _, n in outs]))
    return Tape(
        name=function.name(), inputs=_names(ins), outputs=_names(outs), nodes=tuple(nodes), results=tuple(results)
    )


def _renamed(function: casadi.Function, inputs: list[int], outputs: list[int]) -> tuple[list[Node], list[int]]:
    """Nodes and results of a function whose inputs and outputs have so many elements."""
    names, written = _operators(), Nodes()
    work: dict[int, int] = {}
    # stored elements of a sparse matrix as places in the dense one, column by column, all matrices one after another
    places_in = [[sum(inputs[:i]) + j for j in function.sparsity_in(i).find()] for i in range(len(inputs))]
    places_out = [[sum(outputs[:i]) + j for j in function.sparsity_out(i).find()] for i in range(len(outputs))]
    results = [-1] * sum(outputs)
    code, reads, writes = function.instruction_id, function.instruction_input, function.instruction_output
    for k in range(function.n_instructions()):
        op, args, out = names[code(k)], reads(k), writes(k)
        if op == "input":
            work[out[0]] = written.put(op, (places_in[args[0]][args[1]],))
        elif op == "output":
            results[places_out[out[0]][out[1]]] = work[args[0]]
        elif op == "const":
            work[out[0]] = written.put("constant", (function.instruction_constant(k),))
        elif op == "assign":
            work[out[0]] = work[args[0]]
        else:
            work[out[0]] = written.put(op, tuple([work[a] for a in args]))
    return written.nodes, [written.put("constant", (0.0,)) if r < 0 else r for r in results]


def prune(nodes: list[Node], results: list[int]) -> tuple[list[Node], list[int]]:
    """Drop what no result needs."""
    needed = [False] * len(nodes)
    for r in results:
        needed[r] = True
    for i in range(len(nodes) - 1, -1, -1):
        if needed[i] and nodes[i][0] not in ("input", "constant"):
            for a in nodes[i][1]:
                needed[a] = True
    if all(needed):
        return nodes, results
    place = [-1] * len(nodes)
    live: list[Node] = []
    for i, node in enumerate(nodes):
        if needed[i]:
            place[i] = len(live)
            leaf = node[0] in ("input", "constant")
            live.append(node if leaf else (node[0], tuple([place[a] for a in node[1]])))
    return live, [place[r] for r in results]


def wait(op: str) -> int:
    """How long a result has to be waited for."""
    return _WAIT.get(op, 4)


# exponents that become products; beyond them the generic power is as exact and not slower
_PRODUCTS = {2.0: "{0} * {0}", 3.0: "{0} * {0} * {0}", 4.0: "({0} * {0}) * ({0} * {0})"}

_WRITTEN = (resources.files("mechsym.native") / "operators.csv").read_text(encoding="utf-8")
_OPERATORS = list(csv.DictReader(_WRITTEN.splitlines()))
C, NUMPY = ({row["operator"]: row[name] for row in _OPERATORS if row[name]} for name in ("c", "numpy"))


def unknown(tape: Tape, dialect: dict[str, str]) -> list[str]:
    """Operators of a program that a dialect cannot write. Returns operators: sorted; empty when all can be written."""
    known = {*dialect, "input", "constant", "sin", "cos"}
    return sorted({op for op, _ in tape.nodes} - known)


def expression(dialect: dict[str, str], op: str, args: list[str], exponent: Pure | None = None) -> str:
    """One operation as text. exponent: value of a constant exponent, which may become products."""
    if op == "pow" and exponent in _PRODUCTS:
        return _PRODUCTS[exponent].format(args[0])
    if op == "pow" and exponent == 0.5:
        return dialect["sqrt"].format(args[0])
    if op not in dialect:
        raise BadInput(f"operator {op!r} cannot be compiled; allowed are {', '.join(sorted(dialect))}")
    return dialect[op].format(*args)


def literal(value: float) -> str | None:
    """Text of a constant that every dialect writes in place, or None when it belongs into the table of constants.

    value: the constant [SI]. Returns text: small integers and halves have a text.
    """
    small = math.isfinite(value) and abs(value) <= 16 and value * 2 == int(value * 2)
    return f"{value!r}" if small and value >= 0 else f"({value!r})" if small else None


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


_PRODUCT_WORDS, _SUMS = ("mul", "sq"), ("add", "sub")


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
