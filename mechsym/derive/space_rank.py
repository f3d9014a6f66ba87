r"""What closes in space, by numbers: ranks at closed poses, the rows and coordinates that they choose, and checks.

Rows whose rank is less than their number hold what others hold already. What a column of null(J^T) balances within the
joints is not determined by the motion, and a reaction that it changes is left out, whatever code would give.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import casadi as ca
import numpy as np
import scipy
from sympy import Expr, Symbol

from mechsym.derive.printer import casadi_text
from mechsym.derive.rates import accelerations, velocities
from mechsym.derive.refuse import refuse
from mechsym.derive.space_rows import ClosureRow
from mechsym.derive.vectors import NONE
from mechsym.quantities.units import Pure

Declaration = Any  # of space.py, which these numbers serve

_TOLERANCE = 1e-8  # of the largest: a singular value below it is 0
_SAMPLES, _TRIES = 4, 200
_OPEN = 1e-6  # change of a reaction by a self-balanced force, against the largest, from which it hangs on it
_WANTED = 20


@dataclass(frozen=True)
class ClosureChoice:
    """Which rows close the loops, and which coordinates they hold."""

    rows: list[str]
    dependents: list[Symbol]
    guesses: dict[Symbol, float]
    count: int
    free: list[np.ndarray] = field(default_factory=list)  #: At each pose, multipliers in balance with themselves
    poses: list[np.ndarray] = field(default_factory=list)  #: Letters at closed poses, in the order of `_letters`
    names: tuple[str, ...] = ()
    redundant: list[str] = field(default_factory=list)

    def open_reactions(
        self, m: Declaration, rows: Mapping[str, ClosureRow], reactions: Mapping[str, Expr]
    ) -> list[str]:
        """Names of reactions that self-balanced forces change; what is told of them goes into `redundant`."""
        if len(self.rows) == self.count:
            return []
        multipliers = [Symbol(f"force_{n}", real=True) for n in self.names]
        letters = [*_letters(m), *velocities(m), *accelerations(m), *m.input_list, *multipliers]
        at, values = _evaluated(m, letters, list(reactions.values()))
        slopes = ca.jacobian(ca.vertcat(*values), ca.vertcat(*at[-len(multipliers) :]))
        function = ca.Function("slopes", at, [slopes])
        worst = np.zeros(len(reactions))
        for pose, free in zip(self.poses, self.free, strict=True):
            rest = [0.0] * (len(letters) - len(pose))
            worst = np.maximum(worst, np.abs(np.asarray(function(*pose, *rest)) @ free).max(axis=1, initial=0.0))
        names = [n for n, w in zip(reactions, worst, strict=True) if w > _OPEN * worst.max()]
        joints = [j.name for j in m.space_joints if any(n.endswith(f"_{j.name}") for n in names)]
        few, many = self.count - len(self.rows), self.count
        line = f"{few} of {many} conditions are redundant: the joints {', '.join(joints)} hold one another; "
        self.redundant.append(f"{line}not determined are {', '.join(names)}")
        m.words.append(self.redundant[0])
        return names


def _letters(m: Declaration) -> list[Symbol]:
    return [*m.q, *m.parameter_list]


def _evaluated(
    m: Declaration, letters: Sequence[Symbol], wanted: Sequence[Expr], known: Mapping[str, ca.SX] | None = None
) -> tuple[list[ca.SX], list[ca.SX]]:
    """CasADi symbols of letters, and expressions of the tape in them."""
    at = {s.name: ca.SX.sym(s.name) for s in letters}
    names: dict[str, Any] = {**at, **(known or {}), "ca": ca}
    lines = [f"{s.name} = {casadi_text(m.tape.entries[s])}" for s in m.tape.needed(wanted)]
    lines += [f"_{i} = {casadi_text(m.tape.named(e))}" for i, e in enumerate(wanted)]
    exec(compile("\n".join(lines), "<space>", "exec"), {"__builtins__": {}}, names)
    return list(at.values()), [ca.SX(names[f"_{i}"]) for i in range(len(wanted))]


def choose(
    m: Declaration, closures: Mapping[str, Expr], jacobian: Mapping[str, list[Expr]], mass: list[list[Expr]]
) -> ClosureChoice:
    """Rows and dependent coordinates at closed poses. Raises BadInput: nothing closes, is open, or is held twice."""
    names, n = tuple(closures), len(m.q)
    flat = [e for row in jacobian.values() for e in row] + [e for row in mass for e in row]
    at, values = _evaluated(m, _letters(m), [*closures.values(), *flat])
    gap = ca.vertcat(*values[: len(names)]) if names else ca.SX(0, 1)
    J = ca.reshape(ca.vertcat(*values[len(names) : len(names) * (n + 1)]), n, len(names)).T if names else ca.SX(0, n)
    M = ca.reshape(ca.vertcat(*values[len(names) * (n + 1) :]), n, n)
    functions = (ca.Function("pose", [ca.vertcat(*at)], [gap, J, ca.jacobian(gap, ca.vertcat(*at))]),
                 ca.Function("mass", [ca.vertcat(*at)], [M]))  # fmt: skip
    poses = _poses(m, functions[0])
    slopes = [np.asarray(functions[0](x)[1]) for x in poses]
    loose = [i for i, q in enumerate(m.q) if q in m.own or q in m.dependent_list]
    ranks = [(_rank(j[:, loose]), _rank(j)) for j in slopes]
    rank = max(r for r, _ in ranks)
    if any(whole > r for r, whole in ranks):
        held = [q for q in m.q if q not in m.own and q not in m.dependent_list]
        refuse(f"the loops hold what is declared to move, {', '.join(map(str, held))}: they close in single poses "
               "only; free a link, or leave a joint away", m.where[m.name])  # fmt: skip
    rows = _rows(slopes, rank)
    dependents = _dependents(m, slopes[0][rows][:, loose], loose, rank)
    _require_held(m, [np.asarray(functions[1](x)) for x in poses], slopes)
    guesses = {**{q: m.guesses.get(q.name, 0.0) for q in m.dependent_list}, **m.own}
    guesses |= _assembled(m, functions[0], guesses, poses[0])
    free = [scipy.linalg.null_space(j.T, rcond=_TOLERANCE) for j in slopes]
    return ClosureChoice(rows=[names[i] for i in rows], dependents=dependents, guesses=guesses, count=len(names),
                  free=free, poses=poses, names=names)  # fmt: skip


def _rank(J: np.ndarray) -> int:
    sizes = np.linalg.svd(J, compute_uv=False) if J.size else np.zeros(1)
    return int((sizes > _TOLERANCE * max(sizes.max(), 1e-300)).sum())


def _rows(slopes: list[np.ndarray], rank: int) -> list[int]:
    """As many rows as the rank says, with the largest of the least singular values over the poses."""
    count = len(slopes[0])
    if rank == count:
        return list(range(count))

    def least(rows: list[int]) -> float:
        return min(float(np.linalg.svd(j[rows], compute_uv=False)[-1]) if rows else 1.0 for j in slopes)

    pivots = [scipy.linalg.qr(j.T, pivoting=True, mode="r")[1][:rank] for j in slopes]
    return max((sorted(int(i) for i in p) for p in pivots), key=least)


def _dependents(m: Declaration, J: np.ndarray, loose: list[int], rank: int) -> list[Symbol]:
    """The coordinates that the rows hold; others of quaternions and free bodies move by themselves."""
    by_itself = {q for joint in m.space_joints for q in _unasked(joint)}
    must = [k for k, i in enumerate(loose) if m.q[i] not in by_itself]
    may = [k for k in range(len(loose)) if k not in must]
    q, r, order = (
        scipy.linalg.qr(J[:, must], pivoting=True, mode="economic") if rank and must else (J[:, :0], J[:0], ())
    )
    sizes = np.abs(np.diag(r)) if rank and must else np.zeros(0)
    sure = int((sizes > _TOLERANCE * max(sizes.max(initial=0.0), 1e-300)).sum())
    if (
        open_ := [str(m.q[loose[k]]) for k in sorted(must[j] for j in order[sure:])]
        if rank
        else [str(m.q[loose[k]]) for k in must]
    ):
        refuse(f"the loop is open: {len(open_)} freedom(s) more than coordinates ({', '.join(open_)}); add a joint or "
               "name a coordinate at one: turns=, slides=", m.where[m.name])  # fmt: skip
    rest = J[:, may] - q @ (q.T @ J[:, may])
    more = scipy.linalg.qr(rest, pivoting=True, mode="r")[1][: rank - sure] if rank > sure else []
    return [m.q[loose[k]] for k in sorted([*must, *(may[int(j)] for j in more)])]


def _unasked(joint: Any) -> list[Expr]:
    """Coordinates that may move freely though nobody has named them."""
    return [f.value for f in joint.freedoms] if joint.kind == "free" or joint.kind == "spherical" else []


def _require_held(m: Declaration, masses: list[np.ndarray], slopes: list[np.ndarray]) -> None:
    """Refuse what moves without mass: a rod that spins between two spheres with no inertia about its line."""
    for M, J in zip(masses, slopes, strict=True):
        ways = scipy.linalg.null_space(J, rcond=_TOLERANCE) if len(J) else np.eye(len(M))
        sizes, modes = np.linalg.eigh(ways.T @ M @ ways)
        if sizes.size and not sizes[0] > 1e-13 * sizes[-1]:
            q = m.q[int(np.abs(ways @ modes[:, 0]).argmax())]
            refuse(f"nothing that moves with {q} has a mass: a rod that spins between two spheres needs an inertia "
                   "about its line, or a universal joint at one end", m.where[m.name])  # fmt: skip


def _poses(m: Declaration, function: ca.Function) -> list[np.ndarray]:
    """Letters at closed poses near the guesses: those without a value take one with which the loops close."""
    generator, poses = np.random.default_rng(1), list[np.ndarray]()
    letters = _letters(m)
    first = {**{q: m.guesses.get(q.name, m.poses.get(q.name, 0.0)) for q in m.q}, **m.own}
    fixed = {s for s in m.parameter_list if "default" in m.ranges.get(s.name, {})}
    moves = np.array(
        [s not in fixed and (s in m.parameter_list or s in m.own or s in m.dependent_list) for s in letters]
    )
    free = np.array([s not in fixed for s in letters])
    for k in range(2 * _TRIES):  # at last the declared coordinates give way, so that it can be said what holds them
        start = np.array([_drawn(m, s, first, fixed, generator, k % _TRIES) for s in letters])
        x = _closed(function, start, moves if k < _TRIES else free)
        if x is not None and all(_within(m, s, v) for s, v in zip(letters, x, strict=True)):
            poses.append(x)
        if len(poses) == _SAMPLES or poses and k == _TRIES:
            break
    if not poses:
        refuse(
            f"the loops of {m.name} close nowhere near their pose; give joints a pose=, or other sizes", m.where[m.name]
        )
    return poses


def _assembled(
    m: Declaration, function: ca.Function, guesses: Mapping[Symbol, float], near: np.ndarray
) -> dict[Symbol, float]:
    """Where the loops close near the guesses, declared coordinates in their pose; nothing where letters lack values."""
    letters, fixed = _letters(m), set(m.parameter_list)
    if any("default" not in m.ranges.get(s.name, {}) for s in fixed):
        return {}
    first = {**{q: m.poses.get(q.name, 0.0) for q in m.q}, **guesses}
    generator, moves = np.random.default_rng(1), np.array([s in guesses for s in letters])
    for k in range(_TRIES):
        drawn = [_drawn(m, s, first, fixed, generator, k) for s in letters]
        start = np.array([v if s in guesses and k else first.get(s, v) for s, v in zip(letters, drawn, strict=True)])
        x = _closed(function, start, moves)
        if x is not None:
            return {s: float(v) for s, v in zip(letters, x, strict=True) if s in guesses}
    at = [f"{s} = {v:.4g}" for s, v in zip(letters, near, strict=True) if s in m.q]
    refuse(f"the loops of {m.name} do not close near its pose; they do at {', '.join(at)}; say m.pose(..) and pose= of "
           "the joints, or other sizes", m.where[m.name])  # fmt: skip


def _drawn(m: Declaration, s: Symbol, first: Any, fixed: set[Symbol], generator: np.random.Generator, k: int) -> float:
    bounds = m.ranges.get(s.name, {})
    if s in fixed:
        return float(bounds["default"])
    if s in first:
        width = 0.4 if s not in m.own and s not in m.dependent_list else 0.05 + 0.005 * k
        return float(first[s]) + float(generator.uniform(-width, width)) * (0.1 if m.units[s.name] == "m" else 1.0)
    low = max(bounds.get("above", bounds.get("low", 0.3)), 0.1)
    high = bounds.get("below", bounds.get("high", low + 0.7))
    return float(generator.uniform(min(low, high), max(low, high)))


def _within(m: Declaration, s: Symbol, value: float) -> bool:
    bounds = m.ranges.get(s.name, {})
    low = bounds.get("above", bounds.get("low", -np.inf))
    return bool(low <= value <= bounds.get("below", bounds.get("high", np.inf)))


def _closed(function: ca.Function, x: np.ndarray, moves: np.ndarray) -> np.ndarray | None:
    """The nearest closed pose, by Newton's method on what may move."""
    x = x.copy()
    for _ in range(60):
        gap, _, slopes = (np.asarray(v) for v in function(x))
        if not gap.size:
            return x
        if not (np.isfinite(gap).all() and np.isfinite(slopes).all()):
            return None
        step = np.linalg.lstsq(slopes[:, moves], gap.ravel(), rcond=1e-9)[0]
        x[moves] -= step * min(1.0, 0.3 / max(float(np.abs(step).max(initial=0.0)), 1e-300))
        if np.abs(step).max(initial=0.0) < 1e-15:
            break
    gap = np.asarray(function(x)[0])
    return x if np.abs(gap).max() < 1e-12 * max(1.0, np.abs(x).max()) else None


def difference(m: Declaration, equations: Any, chosen: ClosureChoice) -> tuple[int, Pure]:
    """How far M qdd + h and the rows are from the derivatives of energy and closure that CasADi takes, relative."""
    u, a = velocities(m), accelerations(m)
    letters = [*m.q, *m.parameter_list, *u, *a]
    quaternions = [row.e for row in m.norms.values()]
    wanted = [e for row in equations.mass_matrix for e in row] + list(equations.bias)
    bodies = [p for p in m.tree.parts if p.mass != 0 or p.inertia != (NONE, NONE, NONE)]
    links = [next(k for k in m.space_links if k.part is p) for p in bodies]
    for body, link in zip(bodies, links, strict=True):
        wanted += [e for row in body.world for e in row] + [*body.origin, *link.centre, link.mass]
        wanted += [e for row in link.inertia for e in row]
    held = [
        *m.constraints.values(),
        *(e for row in equations.constraint_jacobian for e in row),
        *equations.constraint_bias,
    ]
    at, values = _evaluated(m, letters, [*wanted, *held])
    n = len(m.q)
    q, v, w = ca.vertcat(*at[:n]), ca.vertcat(*at[-2 * n : -n]), ca.vertcat(*at[-n:])
    size = {q_: ca.sqrt(sum(at[m.q.index(x)] ** 2 for x in e)) for e in quaternions for q_ in e}
    unit = ca.vertcat(*(x / size[s] if s in size else x for x, s in zip(at[:n], m.q, strict=True)))
    M, h = ca.reshape(ca.vertcat(*values[: n * n]), n, n), ca.vertcat(*values[n * n : n * n + n])
    positions = ca.substitute([ca.vertcat(*values[n * n + n :])], [q], [unit])[0]
    gaps = ca.substitute([ca.vertcat(*values[len(wanted) : len(wanted) + len(m.constraints)])], [q], [unit])[0]
    T = sum((_kinetic(positions[25 * k : 25 * k + 25], q, v) for k in range(len(bodies))), ca.SX(0))
    momentum = ca.gradient(T, v)
    textbook = ca.jtimes(momentum, ca.vertcat(q, v), ca.vertcat(v, w)) - ca.gradient(T, q)
    sides = [textbook, ca.mtimes(M, w) + h]
    count = len(m.constraints)
    if count:
        rest = ca.vertcat(*values[len(wanted) + count :])
        J, bias = ca.reshape(rest[: count * n], n, count).T, rest[count * n :]
        keep = [i for i, name in enumerate(m.constraints) if name not in m.norms]
        rate = ca.jtimes(gaps, q, v)
        sides = [ca.vertcat(sides[0], rate[keep], ca.jtimes(rate, q, v)[keep]),
                 ca.vertcat(sides[1], ca.mtimes(J, v)[keep], bias[keep])]  # fmt: skip
    return _compared(m, ca.Function("sides", at, sides), letters, quaternions)


def _kinetic(x: ca.SX, q: ca.SX, v: ca.SX) -> ca.SX:
    """Kinetic energy of a body from its rotation, origin, centre, mass and inertia."""
    R, r, c = ca.reshape(x[:9], 3, 3).T, x[9:12], x[12:15]
    rate = ca.jtimes(r + ca.mtimes(R, c), q, v)
    spun = ca.mtimes(R.T, ca.reshape(ca.jtimes(ca.vec(R), q, v), 3, 3))
    w = ca.vertcat(spun[2, 1], spun[0, 2], spun[1, 0])
    return (x[15] * ca.dot(rate, rate) + ca.dot(w, ca.mtimes(ca.reshape(x[16:25], 3, 3), w))) / 2


def _compared(
    m: Declaration, function: ca.Function, letters: list[Symbol], quaternions: list[tuple[Symbol, ...]]
) -> tuple[int, float]:
    generator, compared, worst = np.random.default_rng(2), 0, 0.0
    index = {s.name: i for i, s in enumerate(letters)}
    fixed = {s for s in m.parameter_list if "default" in m.ranges.get(s.name, {})}
    for k in range(10 * _WANTED):
        x = np.array([_drawn(m, s, {}, fixed, generator, k) if s in m.parameter_list else generator.uniform(-2, 2)
                      for s in letters])  # fmt: skip
        for e in quaternions:
            at, rates = ([index[f"{s.name}{d}"] for s in e] for d in ("", "d"))
            x[at] /= np.linalg.norm(x[at])
            x[rates] -= x[at] * (x[at] @ x[rates])
        one, other = (np.asarray(v).ravel() for v in function(*x))
        if not (np.isfinite(one).all() and np.isfinite(other).all()):
            continue
        compared += 1
        worst = max(worst, float(np.abs(one - other).max() / (np.abs(one).max() or 1.0)))
        if compared == _WANTED:
            break
    return compared, worst
