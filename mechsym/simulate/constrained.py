r"""Runs of mechanisms whose loops close by constraint.

    y = (q, u, work of each part, dissipation, ln |det J_d|)

The independent coordinates are integrated; the others are their functions: the right-hand side closes the loop by
Newton's method from the dependent states, which are only its guesses, so that the projection takes no energy. Which
coordinates depend changes when det J_d has fallen to a twentieth and another choice is twice as good, so that a dead
point of the declared coordinate is passed and told. Where J itself loses rank two motions meet, and the run goes on in
the direction in which it came (see `crossing`); where none goes on it ends with the event `locked`.
"""

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import casadi as ca
import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.mechanisms import loops
from mechsym.mechanisms.record import Mechanism, velocities
from mechsym.native.runs import Level
from mechsym.quantities import record
from mechsym.quantities.units import Array, Second
from mechsym.simulate import crossing as crossings
from mechsym.simulate import equations as plain
from mechsym.simulate.crossing import Crossing, crossing
from mechsym.simulate.equations import System
from mechsym.simulate.integrate import integrate as whole_run
from mechsym.simulate.phase import Raw
from mechsym.simulate.problem import Problem
from mechsym.simulate.result import Happened, RunEvent
from mechsym.simulate.settings import Settings

LOCKED = "locked"
_FALLEN = 0.05  # of the largest
_SINGULAR = 1e-5  # smallest singular value of the scaled Jacobian against the largest; nearer, digits are lost
_NEAR = 0.1  # the same, below which a singular pose is looked for
_AT_REST = 1e-9  # speeds below it turn back, and are in no dead point [rad/s] or [m/s]
_MOST_CHANGES = 100_000


def system(problem: Problem, dependents: tuple[str, ...]) -> System:
    """The equations of a problem for a choice of dependent coordinates."""
    mechanism, n = problem.mechanism, len(problem.mechanism.coordinates)
    free, held_ = loops.split(mechanism, dependents)
    q, u_free = ca.SX.sym("q", n), ca.SX.sym("u", len(free))
    T, c = loops.motion(mechanism, q, u_free, dependents)
    jacobian = mechanism.functions["constraints"](*ca.vertsplit(q), *([0] * n))[1][:, held_]
    u = ca.SX.sym("u_all", n)
    margin = ca.trace(ca.solve(jacobian, ca.reshape(ca.jtimes(ca.vec(jacobian), q, u), jacobian.shape)))
    core = _core(problem, [q, u_free], (q, u, T, c, ca.mtimes(T, u_free), margin))
    y = ca.SX.sym("y", 2 * n + len(problem.parts) + 2)
    at = ca.Function("pose", [y], [loops.closed(mechanism, y[:n], dependents), y[n : 2 * n][free]])
    return _system(problem, y, lambda t, w: core(t, w, *at(y)))


def crossing_system(problem: Problem, one: Crossing) -> System:
    """The equations of a problem on one of the motions that meet."""
    n, i = len(problem.mechanism.coordinates), one.coordinate
    s, v, fixed = ca.SX.sym("s"), ca.SX.sym("v"), ca.SX.sym("fixed", len(one.fixed))
    q, T, c = crossings.motion(n, i)(s, fixed)
    core = _core(problem, [s, v, fixed], (q, ca.SX.sym("u_all", n), T, c * v**2, T * v, ca.SX(0)))
    y = ca.SX.sym("y", 2 * n + len(problem.parts) + 2)
    return _system(problem, y, lambda t, w, more: core(t, w, y[i], y[n + i], more), one.fixed)


def _system(problem: Problem, y: ca.SX, rates: Callable[..., ca.SX | ca.DM], fixed: tuple[float, ...] = ()) -> System:
    mechanism, outer = problem.mechanism, plain.outer_values(problem)
    works = tuple(f"work_{p.name}" for p in problem.parts)
    t, w, more = ca.SX.sym("t"), ca.SX.sym("w", len(outer)), ca.SX.sym("fixed", len(fixed))
    ydot = rates(t, w, *((more,) if fixed else ()))
    return System(
        function=ca.Function("system", [t, y, ca.vertcat(w, more)], [ydot], ["t", "y", "w"], ["ydot"]),
        columns=(*mechanism.coordinates, *velocities(mechanism), *works, "dissipation", "margin"),
        units=mechanism.state_units + ("J",) * (len(works) + 1) + ("-",),
        values=outer,
        size=len(mechanism.coordinates),
        audited="energy" in mechanism.functions,
        fixed=fixed,
    )


def _core(
    problem: Problem, letters: list[ca.SX], moving: tuple[ca.SX, ca.SX, ca.SX, ca.SX, ca.SX, ca.SX]
) -> ca.Function:
    """Rates at a closed pose, as a function of (t, w, letters).

    moving: coordinates; a symbol for their velocities; T and c of their accelerations; the velocities; rate of the
    margin.
    """
    mechanism, (q, u, T, c, speeds, margin) = problem.mechanism, moving
    t, w = ca.SX.sym("t"), ca.SX.sym("w", len(plain.outer_values(problem)))
    at = ca.SX.sym("q_all", q.numel())
    values = plain.part_values(problem, t, ca.vertsplit(at), ca.vertsplit(u), w)
    inputs = [sum((v for p, v in values if p.input == name), ca.SX(0)) for name in mechanism.inputs]
    mass, bias, force = mechanism.functions["dynamics"](*ca.vertsplit(at), *ca.vertsplit(u), *inputs)
    T_, c_ = ca.SX.sym("T", T.sparsity()), ca.SX.sym("c", q.numel())
    reduced, right = ca.mtimes(T_.T, ca.mtimes(mass, T_)), ca.mtimes(T_.T, force - bias - ca.mtimes(mass, c_))
    acceleration = ca.mtimes(T_, ca.solve(reduced, right)) + c_
    rates, loss = plain.power(problem.mechanism, ca.vertsplit(at), ca.vertsplit(u))
    powers = [value * rates[part.input] for part, value in values]
    m = ca.SX.sym("margin")
    all_rates = ca.Function("rates", [t, w, at, u, T_, c_, m], [ca.vertcat(u, acceleration, *powers, loss, m)])
    margin_at = ca.Function("margin", [*letters, u], [margin])
    return ca.Function("core", [t, w, *letters], [all_rates(t, w, q, speeds, T, c, margin_at(*letters, speeds))])


@record
class DependentChoice:
    """Which coordinates depend at a pose, and how far the pose is from a singular one."""

    dependents: tuple[str, ...]
    determinant: float  #: of their columns, scaled [-]
    best: tuple[str, ...]
    best_determinant: float  #: [-]
    condition: float  #: smallest singular value against the largest [-]


def choose(mechanism: Mechanism, q: np.ndarray, now: tuple[str, ...]) -> DependentChoice:
    """The best choice of dependent coordinates beside the one in use.

    q: a closed pose [rad] or [m].
    """
    jacobian = np.asarray(mechanism.functions["constraints"].call([*q, *([0.0] * len(q))])[1])
    scaled = loops.scaled(mechanism, jacobian)
    _, held_ = loops.split(mechanism, now)
    columns = np.sort(scipy.linalg.qr(scaled, pivoting=True, mode="r")[1][: jacobian.shape[0]])
    sizes = np.linalg.svd(scaled, compute_uv=False)
    return DependentChoice(
        dependents=now,
        determinant=float(abs(np.linalg.det(scaled[:, held_]))),
        best=tuple(mechanism.coordinates[i] for i in columns),
        best_determinant=float(abs(np.linalg.det(scaled[:, columns]))),
        condition=float(sizes[-1] / sizes[0]),
    )


def start(problem: Problem) -> tuple[np.ndarray, np.ndarray]:
    """Closed start: the declared independent coordinates and velocities as given, the rest following.

    Returns q, u: coordinates [rad or m] and velocities [rad/s or m/s].

    Raises BadInput: the loop does not close there.
    """
    mechanism = problem.mechanism
    dependents = tuple(mechanism.dependents)
    both = dict(zip(mechanism.coordinates, problem.q0, strict=True))
    free = {n: v for n, v in both.items() if n not in dependents}
    q = loops.close(mechanism, free, {n: both[n] for n in dependents})
    if q is None:
        shown = ", ".join(f"{n} = {v:g}" for n, v in both.items())
        raise BadInput(
            f"{mechanism.name}: the loop does not close at the start ({shown}); give other guesses in [start]"
        )
    u = np.array(problem.u0, dtype=float)
    i_free, i_held = loops.split(mechanism, dependents)
    jacobian = np.asarray(mechanism.functions["constraints"].call([*q, *([0.0] * len(q))])[1])
    u[i_held] = -np.linalg.lstsq(jacobian[:, i_held], jacobian[:, i_free] @ u[i_free], rcond=None)[0]
    return q, u


def integrate(
    problem: Problem, settings: Settings, wanted: Second[Array], ends: list[Second]
) -> tuple[System, Raw, Happened]:
    """A whole run, from one choice of dependent coordinates to the next.

    ends: ends of the stretches in which nothing jumps.
    """
    mechanism, n = problem.mechanism, len(problem.mechanism.coordinates)
    now = _Now(t=problem.t_start, dependents=tuple(mechanism.dependents))
    now.q, now.u = start(problem)
    extra, known = np.zeros(len(problem.parts) + 2), dict[tuple[str, ...], System]()
    steps, end, failure = 0, "t_end", ""
    times, states = [np.array([now.t])], [np.concatenate([now.q, now.u, extra])[None]]
    for _ in range(_MOST_CHANGES):
        if now.crossing is None and not _partition(mechanism, now):
            end = LOCKED
            break
        y = np.concatenate([now.q, now.u, extra])
        y[-1] = 0.0
        if now.crossing is None:
            if now.dependents not in known:
                known[now.dependents] = system(problem, now.dependents)
            equations = known[now.dependents]
        else:
            equations = crossing_system(problem, now.crossing)
        turns = problem.turns and problem.turns - (y[0] - problem.q0[0]) / (2 * np.pi)
        here = replace(problem, q0=tuple(y[:n]), u0=tuple(y[n : 2 * n]), t_start=now.t, turns=turns)
        levels = _levels(mechanism, now, len(y) - 1)
        leg = whole_run(here, equations, settings, wanted[wanted > now.t], [e for e in ends if e > now.t], y, levels)
        times.append(leg.t[1:])
        states.append(_projected(mechanism, leg.y[1:], now))
        now.t, steps, end, failure = float(leg.t[-1]), steps + leg.steps, leg.end, leg.failure
        now.q, now.u, extra = np.split((states[-1] if len(states[-1]) else y[None])[-1], [n, 2 * n])
        if end not in levels:
            break
        _pass(mechanism, now, end)
    else:
        failure = "the choice of dependent coordinates changes without end"
    all_t, values = np.concatenate(times), np.concatenate(states)[:, :-1]
    once = np.append(np.diff(all_t) > 0, True)  # a change of the choice is no wanted time of its own
    rows = once & (np.isin(all_t, wanted) | (all_t == all_t[0]) | (all_t == all_t[-1]))
    bare = known.get(now.dependents) or system(problem, now.dependents)
    reduced = replace(bare, columns=bare.columns[:-1], units=bare.units[:-1])
    raw = Raw(t=all_t[rows], y=values[rows], steps=steps, end=end, failure=failure)
    return reduced, raw, Happened(events=tuple(now.events))


@dataclass(kw_only=True)
class _Now:
    """Where a run stands."""

    t: float
    dependents: tuple[str, ...]
    q: np.ndarray = field(default_factory=lambda: np.zeros(0))
    u: np.ndarray = field(default_factory=lambda: np.zeros(0))
    crossing: Crossing | None = None  # the way through a singular pose that it is on
    met: bool = False  # whether it has met that pose
    fall: float = 0.0  # to this, of where a leg starts, its determinant may fall [-]
    largest: dict[tuple[str, ...], float] = field(default_factory=dict)  # of its determinants
    way: float = 0.0  # sense of the declared coordinate, where it is not to be seen from its speed
    events: list[RunEvent] = field(default_factory=list)


def _declared(mechanism: Mechanism) -> int | None:
    """The one coordinate that the declaration lets move freely."""
    free, _ = loops.split(mechanism, tuple(mechanism.dependents))
    return free[0] if len(free) == 1 else None


def _partition(mechanism: Mechanism, now: _Now) -> bool:
    """Choose which coordinates depend, or the way through a singular pose; whether the mechanism goes on."""
    chosen = choose(mechanism, now.q, now.dependents)
    if chosen.condition > _SINGULAR and chosen.determinant < 0.5 * chosen.best_determinant:
        now.dependents = chosen.best
    size = max(chosen.determinant, chosen.best_determinant if now.dependents == chosen.best else 0.0)
    largest = now.largest[now.dependents] = max(size, now.largest.get(now.dependents, 0.0))
    now.fall = min(_FALLEN * largest / size, 0.5) if size else 0.5
    if chosen.condition > _NEAR:
        return True
    if _declared(mechanism) is None:
        if chosen.condition > _SINGULAR:
            return True
        raise BadInput(
            f"{mechanism.name}: at t = {now.t:.6g} s the loops do not say which way they go on, where several "
            "coordinates move freely; start otherwise, or hold one of them"
        )
    now.crossing, now.met = crossing(mechanism, now.q, now.u, chosen.best), False
    return now.crossing is not None or chosen.condition > _SINGULAR


def _levels(mechanism: Mechanism, now: _Now, margin: int) -> dict[str, Level]:
    """What ends a leg: a choice that has worsened, a dead point of the declared coordinate, ends of a way through.

    margin: index of its state.
    """
    n, first = len(mechanism.coordinates), _declared(mechanism)
    here = loops.split(mechanism, now.dependents)[0] if now.crossing is None else [now.crossing.coordinate]
    levels = {"margin": Level(state=margin, level=float(np.log(now.fall)), direction=-1)}
    if now.crossing is not None:
        levels = dict(now.crossing.levels(now.met))
    if first is not None and first not in here:
        way = now.way or np.sign(now.u[first])
        levels["dead point"] = Level(state=n + first, level=0.0, direction=-int(way))
    return levels


def _pass(mechanism: Mechanism, now: _Now, end: str) -> None:
    """Take note of what ended a leg."""
    first, sense = _declared(mechanism), 0.0
    if end == "dead point" and first is not None:
        sense = -(now.way or np.sign(now.u[first]))
        others = np.delete(now.u, first)
        if np.abs(others).max() > _AT_REST * max(1.0, np.abs(now.q).max()):
            now.events.append(RunEvent(name=mechanism.coordinates[first], kind="dead_point", t=now.t))
    elif end == "meet" and now.crossing is not None:
        name = mechanism.coordinates[now.crossing.coordinate]
        now.events.append(RunEvent(name=name, kind="bifurcation", t=now.t))
        now.met = True
    elif end in ("back", "past"):
        now.crossing = None
    now.way = sense


def _projected(mechanism: Mechanism, y: np.ndarray, now: _Now) -> np.ndarray:
    """States with the dependent coordinates and velocities put on the closure."""
    if not len(y):
        return y
    n = len(mechanism.coordinates)
    q, u = ca.SX.sym("q", n), ca.SX.sym("u", n)
    if now.crossing is None:
        free, _ = loops.split(mechanism, now.dependents)
        at = loops.closed(mechanism, q, now.dependents)
        T, _ = loops.motion(mechanism, at, u[free], now.dependents)
    else:
        free = [now.crossing.coordinate]
        at, T, _ = crossings.motion(n, free[0])(q[free], now.crossing.fixed)
    closed = ca.Function("closed", [q, u], [at, ca.mtimes(T, u[free])])
    q_u = closed.map(len(y))(y[:, :n].T, y[:, n : 2 * n].T)
    return np.hstack([*(np.asarray(v).T for v in q_u), y[:, 2 * n :]])
