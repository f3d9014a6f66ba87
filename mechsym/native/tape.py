"""A CasADi function as a list of plain instructions, each value named once.

CasADi keeps an SX function as a tape: instructions over a work vector whose places are used again and again. Here
every place is renamed on each write, so that a value has one definition, equal instructions are merged and unused ones
dropped. Everything that writes code (`source`) starts from this record.

How each operator is written in C and in numpy. C names with the prefix `ms_` are in `c/elementary.h`: branch-free, so
that a loop over them becomes vector instructions. What stays a call of the C library is right but is computed one
number at a time.
"""

import functools
import math
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
        function = _expanded(function)
    ins = [(function.name_in(i), function.numel_in(i)) for i in range(function.n_in())]
    outs = [(function.name_out(i), function.numel_out(i)) for i in range(function.n_out())]
    nodes, results = prune(*_renamed(function, [n for _, n in ins], [n for _, n in outs]))
    return Tape(
        name=function.name(), inputs=_names(ins), outputs=_names(outs), nodes=tuple(nodes), results=tuple(results)
    )


def _expanded(function: casadi.Function) -> casadi.Function:
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
    return expanded


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

C = {
    "add": "{0} + {1}", "sub": "{0} - {1}", "mul": "{0} * {1}", "div": "{0} / {1}",
    "neg": "-{0}", "inv": "1.0 / {0}", "sq": "{0} * {0}", "twice": "{0} + {0}",
    "sqrt": "sqrt({0})", "fabs": "fabs({0})", "floor": "floor({0})", "ceil": "ceil({0})",
    "exp": "ms_exp({0})", "log": "ms_log({0})", "pow": "ms_pow({0}, {1})", "pow_broken": "ms_pow_broken({0}, {1})",
    "asin": "ms_asin({0})", "acos": "acos({0})", "atan": "atan({0})", "tan": "ms_tan({0})",
    "lt": "({0} < {1} ? 1.0 : 0.0)", "le": "({0} <= {1} ? 1.0 : 0.0)",
    "eq": "({0} == {1} ? 1.0 : 0.0)", "ne": "({0} != {1} ? 1.0 : 0.0)",
    "not": "({0} == 0.0 ? 1.0 : 0.0)",
    "and": "({0} != 0.0 & {1} != 0.0 ? 1.0 : 0.0)", "or": "({0} != 0.0 | {1} != 0.0 ? 1.0 : 0.0)",
    "if_else_zero": "({0} != 0.0 ? {1} : 0.0)",
    "sign": "({0} > 0.0 ? 1.0 : ({0} < 0.0 ? -1.0 : {0}))",
    "fmin": "ms_fmin({0}, {1})", "fmax": "ms_fmax({0}, {1})", "copysign": "copysign({0}, {1})",
    "fmod": "fmod({0}, {1})", "remainder": "remainder({0}, {1})", "hypot": "ms_hypot({0}, {1})",
    "atan2": "atan2({0}, {1})", "erf": "erf({0})", "log1p": "log1p({0})", "expm1": "expm1({0})",
    "sinh": "sinh({0})", "cosh": "cosh({0})", "tanh": "tanh({0})",
    "asinh": "asinh({0})", "acosh": "acosh({0})", "atanh": "atanh({0})",
}  # fmt: skip

NUMPY = {
    "add": "{0} + {1}", "sub": "{0} - {1}", "mul": "{0} * {1}", "div": "{0} / {1}",
    "neg": "-{0}", "inv": "1.0 / {0}", "sq": "{0} * {0}", "twice": "{0} + {0}",
    "sqrt": "np.sqrt({0})", "fabs": "np.fabs({0})", "floor": "np.floor({0})", "ceil": "np.ceil({0})",
    "exp": "np.exp({0})", "log": "np.log({0})", "pow": "np.power({0}, {1})", "pow_broken": "np.power({0}, {1})",
    "sin": "np.sin({0})", "cos": "np.cos({0})", "tan": "np.tan({0})",
    "asin": "np.arcsin({0})", "acos": "np.arccos({0})", "atan": "np.arctan({0})",
    "lt": "({0} < {1}) * 1.0", "le": "({0} <= {1}) * 1.0", "eq": "({0} == {1}) * 1.0", "ne": "({0} != {1}) * 1.0",
    "not": "({0} == 0.0) * 1.0",
    "and": "np.logical_and({0}, {1}) * 1.0", "or": "np.logical_or({0}, {1}) * 1.0",
    "if_else_zero": "np.where({0}, {1}, 0.0)", "sign": "np.sign({0})",
    "fmin": "np.fmin({0}, {1})", "fmax": "np.fmax({0}, {1})", "copysign": "np.copysign({0}, {1})",
    "fmod": "np.fmod({0}, {1})", "hypot": "np.hypot({0}, {1})", "atan2": "np.arctan2({0}, {1})",
    "log1p": "np.log1p({0})", "expm1": "np.expm1({0})",
    "sinh": "np.sinh({0})", "cosh": "np.cosh({0})", "tanh": "np.tanh({0})",
    "asinh": "np.arcsinh({0})", "acosh": "np.arccosh({0})", "atanh": "np.arctanh({0})",
}  # fmt: skip


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
