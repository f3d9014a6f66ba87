r"""Equations of motion along the arc length of each angle, where its inertia depends on that angle only.

    J(q) q'' = T - J'(q) q'^2 / 2,   dx = sqrt(J) dq / c,   G = dq/dx = c / sqrt(J)

    x'' = T G / c^2

The term in the square of the speed is gone, and with it a root and a quotient: q(x) - x and G are short series in
cos x and sin x. c is the mean of sqrt(J) over a turn, so that x turns with q.
"""

import functools

import casadi as ca

from mechsym.native.tape import ANALYTIC, Tape, read
from mechsym.quantities import record


@record
class Form:
    """Rates in a form for methods that look back."""

    rates: ca.Function  #: (t, y, p) to the rates
    forces: ca.Function  #: (t, y, p) to the torque, or the acceleration where J is constant, and the rates of `read`
    works: ca.Function  #: (t, y, p) to the rates of `unread`
    #: For each angle (q, p) to J and dJ/dq; None where it is constant [SI]
    inertia: tuple[ca.Function | None, ...]
    #: States that are angles, and the speed of each
    angles: tuple[int, ...]
    speeds: tuple[int, ...]
    #: Other states, which rates depend on or not
    read: tuple[int, ...]
    unread: tuple[int, ...]


@functools.lru_cache(maxsize=256)
def form(stored: str) -> Form | None:
    """The form of a right-hand side.

    Parameters
    ----------
    stored : str
        A function (t, y, p) to the rates as CasADi stores it

    Returns
    -------
    form : Form or None
        None where nothing moves, or where an inertia depends on more than its own angle
    """
    rates = ca.Function.deserialize(stored)
    tape = read(rates)
    if not {op for op, _ in tape.nodes} <= ANALYTIC:
        return None
    t, y, p = (ca.SX.sym(rates.name_in(i), rates.numel_in(i)) for i in range(3))
    found, states = ca.vertsplit(rates(t, y, p)), ca.vertsplit(y)
    pairs = _pairs(tape, len(states))
    parts = [_torque(found[u], (states[q], states[u]), p) for q, u in pairs]
    good = [part for part in parts if part is not None]
    if not pairs or len(good) < len(parts):
        return None
    used = {args[0] - 1 for op, args in tape.nodes if op == "input"}
    others = [i for i in range(len(states)) if i not in {i for pair in pairs for i in pair}]
    reading, unread = (tuple(i for i in others if (i in used) == wanted) for wanted in (True, False))
    inertia = [None if J is None else _inertia(J, states[q], p) for (_, J), (q, _) in zip(good, pairs, strict=True)]
    above = [*(torque for torque, _ in good), *(found[i] for i in reading)]
    return Form(
        rates=rates, forces=_function(f"{rates.name()}_forces", (t, y, p), above),
        works=_function(f"{rates.name()}_works", (t, y, p), [found[i] for i in unread]),
        inertia=tuple(inertia),
        angles=tuple(q for q, _ in pairs), speeds=tuple(u for _, u in pairs), read=reading, unread=unread,
    )  # fmt: skip


def _pairs(tape: Tape, n: int) -> list[tuple[int, int]]:
    """States whose rate is another state that has a rate of its own, and that state."""
    ends = [tape.nodes[r] for r in tape.results]
    same = {i: args[0] - 1 for i, (op, args) in enumerate(ends) if op == "input" and 1 <= args[0] <= n}
    pairs = [(q, u) for q, u in same.items() if u not in same]
    return pairs if len({u for _, u in pairs}) == len(pairs) else []


def _function(name: str, inputs: tuple[ca.SX, ...], found: list[ca.SX]) -> ca.Function:
    return ca.Function(name, list(inputs), [ca.vertcat(ca.SX(0, 1), *found)])


def _inertia(inertia: ca.SX, q: ca.SX, p: ca.SX) -> ca.Function:
    return ca.Function("inertia", [q, p], [ca.vertcat(inertia, ca.gradient(inertia, q))])


def _torque(rate: ca.SX, state: tuple[ca.SX, ca.SX], p: ca.SX) -> tuple[ca.SX, ca.SX | None] | None:
    """Torque and inertia of one angle; the rate itself and None where no inertia changes."""
    q, u = state
    below = rate.dep(1) if not rate.is_leaf() and rate.op() == ca.OP_DIV else ca.SX(1)
    above = rate.dep(0) if ca.depends_on(below, q) else rate
    # with J(q) the square of the speed goes with dJ/dq, which `arcs` holds by numbers
    slope = ca.gradient(above, u)
    square = ca.depends_on(slope, u)
    if above is rate:
        return None if square else (rate, None)
    if any(not ca.depends_on(ca.vertcat(q, p), s) for s in ca.symvar(below)):
        return None
    return ca.substitute(above, u, 0) + u * ca.substitute(slope, u, 0), below
