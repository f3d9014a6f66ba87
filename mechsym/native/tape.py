"""A CasADi function as a list of plain instructions, each value named once.

CasADi keeps an SX function as a tape: instructions over a work vector whose places are used again and again. Here
every place is renamed on each write, so that a value has one definition, equal instructions are merged and unused ones
dropped. Everything that writes code (`dialects`, `emit`) starts from this record.
"""

import collections
import functools

import casadi

from mechsym.errors import BadInput
from mechsym.quantities import record

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
    #: Operator and operands. Operands are indices of earlier nodes, except for `("input", (i,))` and `("constant",
    #: (value,))`
    nodes: tuple[tuple[str, tuple], ...]
    results: tuple[int, ...]


@functools.cache
def _operators() -> dict[int, str]:
    names = {getattr(casadi, n): n[3:].lower() for n in dir(casadi) if n.startswith("OP_")}
    return {code: _SAME.get(name, name) for code, name in names.items()}


def _slots(function: casadi.Function, side: str) -> list[tuple[str, int]]:
    count, name, size = (
        (function.n_in(), function.name_in, function.numel_in)
        if side == "in"
        else (function.n_out(), function.name_out, function.numel_out)
    )
    return [(name(i), size(i)) for i in range(count)]


def _names(slots: list[tuple[str, int]]) -> tuple[str, ...]:
    return tuple(name if size == 1 else f"{name}[{j}]" for name, size in slots for j in range(size))


def _offsets(slots: list[tuple[str, int]]) -> list[int]:
    starts = [0]
    for _, size in slots:
        starts.append(starts[-1] + size)
    return starts


def read(function: casadi.Function) -> Tape:
    """The tape of a CasADi function, merged and without dead code.

    Parameters
    ----------
    function : casadi.Function
        SX function, or an MX function that can be expanded

    Returns
    -------
    tape : Tape
        Its straight-line program; elements of a sparse output that are not stored are zero
    """
    if not function.is_a("SXFunction"):
        function = _expanded(function)
    ins, outs = _slots(function, "in"), _slots(function, "out")
    nodes, results = _rename(function, _offsets(ins), _offsets(outs))
    nodes, results = prune(nodes, results)
    return Tape(
        name=function.name(), inputs=_names(ins), outputs=_names(outs), nodes=tuple(nodes), results=tuple(results)
    )


def _expanded(function: casadi.Function) -> casadi.Function:
    try:
        found = function.expand()
        calls = [k for k in range(found.n_instructions()) if found.instruction_id(k) == casadi.OP_CALL]
        reason = "it calls another function"
    except RuntimeError as error:
        calls, reason = [-1], str(error).strip().splitlines()[-1]
    if calls:
        raise BadInput(
            f"function {function.name()} cannot be written as elementary operations ({reason}); "
            "build it from SX expressions"
        )
    return found


def _dense(function: casadi.Function, side: str, index: int) -> list[int]:
    # stored elements of a sparse matrix, as places in the dense one (column by column)
    sparsity = function.sparsity_in(index) if side == "in" else function.sparsity_out(index)
    return sparsity.find()


def _rename(function: casadi.Function, inputs: list[int], outputs: list[int]) -> tuple[list[tuple[str, tuple]], list]:
    names = _operators()
    nodes: list[tuple[str, tuple]] = []
    known: dict[tuple[str, tuple], int] = {}
    work: dict[int, int] = {}

    def node(op: str, args: tuple) -> int:
        key = (op, args)
        found = known.setdefault(key, len(nodes))
        if found == len(nodes):
            nodes.append(key)
        return found

    places_in = [_dense(function, "in", i) for i in range(function.n_in())]
    places_out = [_dense(function, "out", i) for i in range(function.n_out())]
    results = [-1] * outputs[-1]
    code, reads, writes = function.instruction_id, function.instruction_input, function.instruction_output
    for k in range(function.n_instructions()):
        op, args, out = names[code(k)], reads(k), writes(k)
        if op == "input":
            work[out[0]] = node(op, (inputs[args[0]] + places_in[args[0]][args[1]],))
        elif op == "output":
            results[outputs[out[0]] + places_out[out[0]][out[1]]] = work[args[0]]
        elif op == "const":
            work[out[0]] = node("constant", (function.instruction_constant(k),))
        elif op == "assign":
            work[out[0]] = work[args[0]]
        else:
            work[out[0]] = node(op, tuple([work[a] for a in args]))
    return nodes, [node("constant", (0.0,)) if r < 0 else r for r in results]


def prune(nodes: list[tuple[str, tuple]], results: list[int]) -> tuple[list[tuple[str, tuple]], list[int]]:
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
    kept: list[tuple[str, tuple]] = []
    for i, node in enumerate(nodes):
        if needed[i]:
            place[i] = len(kept)
            leaf = node[0] in ("input", "constant")
            kept.append(node if leaf else (node[0], tuple([place[a] for a in node[1]])))
    return kept, [place[r] for r in results]


def wait(op: str) -> int:
    """How long a result has to be waited for."""
    return _WAIT.get(op, 4)


def operation_counts(tape: Tape) -> dict[str, int]:
    """How often each operator occurs; a sine and a cosine of one angle count as one `sincos`."""
    angles = collections.defaultdict(set)
    counts: collections.Counter[str] = collections.Counter()
    for op, args in tape.nodes:
        if op in ("sin", "cos"):
            angles[args[0]].add(op)
        elif op not in ("input", "constant"):
            counts[op] += 1
    if angles:
        counts["sincos"] = len(angles)
    return {**dict(sorted(counts.items())), "total": sum(counts.values())}
