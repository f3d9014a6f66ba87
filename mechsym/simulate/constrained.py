r"""Runs of mechanisms whose loops close by constraint.

    y = (q, u, work of each part, dissipation, ln |det J_d|)

The independent coordinates are integrated; the others are their functions: the right-hand side closes the loop by
Newton's method from the dependent states, which are only its guesses, so that the projection takes no energy. Which
coordinates depend changes when det J_d has fallen to a twentieth and another choice is twice as good; where none is,
because J itself loses rank, the run ends with the event `locked`.
"""

from collections.abc import Callable
from dataclasses import replace

import casadi as ca
import numpy as np
import scipy

from mechsym.errors import BadInput
from mechsym.mechanisms import loops
from mechsym.mechanisms.record import Mechanism, velocities
from mechsym.native.runs import Level
from mechsym.quantities import record
from mechsym.quantities.units import Array, Second
from mechsym.simulate import equations as plain
from mechsym.simulate.equations import System
from mechsym.simulate.integrate import integrate as whole_run
from mechsym.simulate.phase import Raw
from mechsym.simulate.problem import Periodic, Problem, Steps
from mechsym.simulate.settings import Settings

LOCKED = "locked"
_FALLEN = float(np.log(0.05))
_SINGULAR = 1e-5  # smallest singular value of the scaled Jacobian against the largest; nearer, digits are lost
_MOST_CHANGES = 100_000


def system(problem: Problem, dependents: tuple[str, ...]) -> System:
    """The equations of a problem for a choice of dependent coordinates."""
    mechanism, n = problem.mechanism, len(problem.mechanism.coordinates)
    free, held_ = loops.split(mechanism, dependents)
    core, outer = _core(problem, dependents)
    works = tuple(f"work_{p.name}" for p in problem.parts)
    t, y, w = ca.SX.sym("t"), ca.SX.sym("y", 2 * n + len(works) + 2), ca.SX.sym("w", len(outer))
    q = loops.closed(mechanism, y[:n], dependents)
    u = y[n : 2 * n]
    ydot = core(t, *ca.Function("pose", [y], [q, u[free]])(y), w)
    return System(
        function=ca.Function("system", [t, y, w], [ydot], ["t", "y", "w"], ["ydot"]),
        columns=(*mechanism.coordinates, *velocities(mechanism), *works, "dissipation", "margin"),
        units=mechanism.state_units + ("J",) * (len(works) + 1) + ("-",),
        values=outer,
        size=n,
        audited="energy" in mechanism.functions,
    )


def _core(
    problem: Problem, dependents: tuple[str, ...]
) -> tuple[ca.Function, tuple[Steps | Periodic | Callable[..., float], ...]]:
    """Rates at a closed pose, as a function of (t, q, velocities of the independent coordinates, w)."""
    mechanism = problem.mechanism
    n = len(mechanism.coordinates)
    free, held_ = loops.split(mechanism, dependents)
    t, q, u_free = ca.SX.sym("t"), ca.SX.sym("q", n), ca.SX.sym("u", len(free))
    T, c = loops.motion(mechanism, q, u_free, dependents)
    u = ca.SX.sym("u_all", n)
    outer = plain.outer_values(problem)
    w = ca.SX.sym("w", len(outer))
    values = plain.part_values(problem, t, ca.vertsplit(q), ca.vertsplit(u), w)
    inputs = [sum((v for p, v in values if p.input == name), ca.SX(0)) for name in mechanism.inputs]
    mass, bias, force = mechanism.functions["dynamics"](*ca.vertsplit(q), *ca.vertsplit(u), *inputs)
    reduced, right = ca.mtimes(T.T, ca.mtimes(mass, T)), ca.mtimes(T.T, force - bias - ca.mtimes(mass, c))
    acceleration = ca.mtimes(T, ca.solve(reduced, right)) + c
    rates, loss = plain.power(problem.mechanism, ca.vertsplit(q), ca.vertsplit(u))
    powers = [value * rates[part.input] for part, value in values]
    jacobian = mechanism.functions["constraints"](*ca.vertsplit(q), *([0] * n))[1][:, held_]
    margin = ca.trace(ca.solve(jacobian, ca.reshape(ca.jtimes(ca.vec(jacobian), q, u), jacobian.shape)))
    all_rates = ca.Function("rates", [t, q, u_free, u, w], [ca.vertcat(u, acceleration, *powers, loss, margin)])
    return ca.Function("core", [t, q, u_free, w], [all_rates(t, q, u_free, ca.mtimes(T, u_free), w)]), outer


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
    scale = np.abs(jacobian).max(axis=0)
    scaled = jacobian / np.where(scale > 0, scale, 1.0)
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


def integrate(problem: Problem, settings: Settings, wanted: Second[Array], ends: list[Second]) -> tuple[System, Raw]:
    """A whole run, from one choice of dependent coordinates to the next.

    ends: ends of the stretches in which nothing jumps.
    """
    mechanism, n = problem.mechanism, len(problem.mechanism.coordinates)
    dependents = tuple(mechanism.dependents)
    q, u = start(problem)
    extra = np.zeros(len(problem.parts) + 2)
    t, steps, end, failure = problem.t_start, 0, "t_end", ""
    times, states = [np.array([t])], [np.concatenate([q, u, extra])[None]]
    for _ in range(_MOST_CHANGES):
        chosen = choose(mechanism, q, dependents)
        if chosen.condition < _SINGULAR:
            end = LOCKED
            break
        if chosen.determinant < 0.5 * chosen.best_determinant:
            dependents = chosen.best
        y = np.concatenate([q, u, extra])
        y[-1] = 0.0
        equations = system(problem, dependents)
        turns = problem.turns and problem.turns - (y[0] - problem.q0[0]) / (2 * np.pi)
        here = replace(problem, q0=tuple(y[:n]), u0=tuple(y[n : 2 * n]), t_start=t, turns=turns)
        fallen = Level(state=len(y) - 1, level=_FALLEN, direction=-1)
        later = [e for e in ends if e > t]
        leg = whole_run(here, equations, settings, wanted[wanted > t], later, y, {"margin": fallen})
        times.append(leg.t[1:])
        states.append(_projected(mechanism, leg.y[1:], dependents))
        t, last, steps, end, failure = float(leg.t[-1]), states[-1][-1], steps + leg.steps, leg.end, leg.failure
        q, u, extra = last[:n], last[n : 2 * n], last[2 * n :]
        if end != "margin":
            break
    else:
        failure = "the choice of dependent coordinates changes without end"
    all_t, values = np.concatenate(times), np.concatenate(states)[:, :-1]
    once = np.append(np.diff(all_t) > 0, True)  # a change of the choice is no wanted time of its own
    rows = once & (np.isin(all_t, wanted) | (all_t == all_t[0]) | (all_t == all_t[-1]))
    reduced = replace(equations, columns=equations.columns[:-1], units=equations.units[:-1])
    return reduced, Raw(t=all_t[rows], y=values[rows], steps=steps, end=end, failure=failure)


def _projected(mechanism: Mechanism, y: np.ndarray, dependents: tuple[str, ...]) -> np.ndarray:
    """States with the dependent coordinates and velocities put on the closure."""
    if not len(y):
        return y
    n = len(mechanism.coordinates)
    q, u = ca.SX.sym("q", n), ca.SX.sym("u", n)
    free, _ = loops.split(mechanism, dependents)
    at = loops.closed(mechanism, q, dependents)
    T, _ = loops.motion(mechanism, at, u[free], dependents)
    closed = ca.Function("closed", [q, u], [at, ca.mtimes(T, u[free])])
    q_u = closed.map(len(y))(y[:, :n].T, y[:, n : 2 * n].T)
    return np.hstack([*(np.asarray(v).T for v in q_u), y[:, 2 * n :]])
