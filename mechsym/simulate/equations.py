"""First-order equations of a problem: motion, the work of every part, and what the dampers take.

    y = (q, u, work of each part, dissipation, states),   dy/dt = f(t, y, w)

w holds the values that no formula gives: the steps, constant in a phase, and the plain callables. f is one CasADi
function, so that any backend can take it; scipy calls it through a buffer (0.5 microseconds a call).
"""

from collections.abc import Callable, Sequence
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np
import scipy

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.mechanisms.record import Mechanism, acceleration_function, velocities
from mechsym.quantities import record
from mechsym.simulate.problem import Along, FormulaForce, Periodic, Problem, Steps


@record
class System:
    """The equations of a problem."""

    function: ca.Function
    columns: tuple[str, ...]
    units: tuple[str, ...]
    values: tuple[Steps | Periodic | Callable[..., float], ...]  #: What gives each entry of w
    size: int
    audited: bool  #: Whether the mechanism has energies; without them dissipation stays 0
    #: Last entries of w, the same at all times: what the rates take of parameters that differ in a family [SI]
    fixed: tuple[float, ...] = ()
    shared: Mechanism | None = None  #: Of a family; its functions take `letters` behind their own inputs
    letters: tuple[float, ...] = ()  #: Parameters that differ in the family [SI]


def system(problem: Problem, letters: Sequence[Any] = ()) -> System:
    r"""The equations of a problem, with the power balance beside the motion.

    .. math:: \dot W_j = w_j\, v_j,\quad v_j = \sum_i \frac{\partial Q_i}{\partial w_j} u_i,\qquad
              \dot D = -\sum_i u_i \Big(Q_i(q, u, 0) + \frac{\partial V}{\partial q_i}\Big)

    Parameters
    ----------
    letters : sequence of casadi.SX
        Parameters that the mechanism leaves open; they become the last inputs of the function

    Raises
    ------
    BadInput
        The mechanism has constraints, which need multipliers
    """
    mechanism = problem.mechanism
    if "constraints" in mechanism.functions:
        why = "its constraints name no dependent coordinates"
        raise BadInput(f"{mechanism.name} cannot run in time: {why}; declare them with m.dependents(..)")
    n, names = len(mechanism.coordinates), velocities(mechanism)
    works = tuple(f"work_{p.name}" for p in problem.parts)
    columns = (*mechanism.coordinates, *names, *works, "dissipation", *(s.name for s in problem.states))
    t, y = ca.SX.sym("t"), ca.SX.sym("y", len(columns))
    q, u = ca.vertsplit(y[:n]), ca.vertsplit(y[n : 2 * n])
    outer = outer_values(problem)
    w = ca.SX.sym("w", len(outer))
    along = (u, _curves(problem, w), ca.vertsplit(y[len(columns) - len(problem.states) :]))
    values = part_values(problem, t, q, u, w, along)
    inputs = [sum((v for p, v in values if p.input == name), ca.SX(0)) for name in mechanism.inputs]
    qdd = _carrying(problem, q, u, w, acceleration_function(mechanism)(*q, *u, *inputs, *letters))
    rates, loss = power(mechanism, q, u, letters)
    powers = [value * rates[part.input] for part, value in values]
    inner = [s.rate.function(*along) for s in problem.states]
    found = ca.vertcat(*u, qdd, *powers, loss, *inner)
    return System(
        function=ca.Function("system", [t, y, ca.vertcat(w, *letters)], [found], ["t", "y", "w"], ["ydot"]),
        columns=columns,
        units=("rad",) * n + ("rad/s",) * n + ("J",) * (len(works) + 1) + tuple(s.unit for s in problem.states),
        values=outer,
        size=n,
        audited="energy" in mechanism.functions,
    )


def start_of(problem: Problem, equations: System) -> np.ndarray:
    """The state at the start, no work done yet.

    Returns
    -------
    y : ndarray, shape (m,)
        In the order of the columns [SI]
    """
    states = [s.start for s in problem.states]
    none = np.zeros(len(equations.columns) - 2 * equations.size - len(states))
    return np.concatenate([problem.q0, problem.u0, none, states])


def outer_values(problem: Problem) -> tuple[Any, ...]:
    """The values that no formula gives, in the order of w: of the parts, the curves, the inertia and its slope."""
    parts = (p.value for p in problem.parts if not isinstance(p.value, FormulaForce | Along))
    return (*parts, *problem.curves, *(problem.inertia or ()))


def part_values(
    problem: Problem, t: Any, q: Sequence[Any], u: Sequence[Any], w: Any, along: tuple[Any, Any, Any] = ((), (), ())
) -> list[tuple[Any, Any]]:
    """Each part with the symbol or the formula of its value; `along` is what the formulas of `Along` are made of."""
    found, next_w = [], 0
    for part in problem.parts:
        if isinstance(part.value, FormulaForce):
            found.append((part, ca.SX(part.value.function(t, q, u))))
        elif isinstance(part.value, Along):
            found.append((part, ca.SX(part.value.function(*along))))
        else:
            found.append((part, w[next_w]))
            next_w += 1
    return found


def _curves(problem: Problem, w: Any) -> list[Any]:
    last = w.shape[0] - (2 if problem.inertia else 0)
    return ca.vertsplit(w[last - len(problem.curves) : last]) if problem.curves else []


def _carrying(problem: Problem, q: Sequence[Any], u: Sequence[Any], w: Any, qdd: Any) -> Any:
    r"""Acceleration of a shaft that turns more inertia than its mechanism has.

    .. math:: (I + I_h)\,\ddot q = I \ddot q_0 - \tfrac12 I_h' \dot q^2
    """
    if problem.inertia is None:
        return qdd
    without = [0.0] * len(problem.mechanism.inputs)
    own = problem.mechanism.functions["dynamics"](*q, *u, *without)[0]
    return (own * qdd - w[-1] * u[0] ** 2 / 2) / (own + w[-2])


def power(
    mechanism: Mechanism, q: Sequence[Any], u: Sequence[Any], letters: Sequence[Any] = ()
) -> tuple[dict[str, Any], Any]:
    """The speed conjugate to each input, and the power that is lost inside the mechanism."""
    inputs = ca.SX.sym("inputs", len(mechanism.inputs))
    force = mechanism.functions["dynamics"](*q, *u, *ca.vertsplit(inputs), *letters)[2]
    speeds = ca.jacobian(force, inputs).T @ ca.vertcat(*u)
    rates = dict(zip(mechanism.inputs, ca.vertsplit(speeds), strict=True))
    if "energy" not in mechanism.functions:
        return rates, ca.SX(0)
    potential = mechanism.functions["energy"](*q, *u, *letters)[1]
    passive = ca.substitute(force, inputs, ca.SX.zeros(inputs.shape))
    return rates, -ca.dot(ca.vertcat(*u), passive + ca.gradient(potential, ca.vertcat(*q)))


def held(system: System, t: float) -> np.ndarray:
    """The values w at a time, right of any jump; a callable's place stays 0.

    Parameters
    ----------
    t : float
        Start of a phase [s]

    Returns
    -------
    w : ndarray, shape (k,)
        In the units of the inputs [N*m or N]
    """
    now = [_step(v, t) if isinstance(v, Steps) else 0.0 for v in system.values]
    return np.array([*now, *system.fixed], dtype=float)


def _step(steps: Steps, t: float) -> float:
    return steps.values[int(np.searchsorted(steps.times, t, side="right"))]


def _asked(system: System, value: Periodic | Callable[..., float]) -> Callable[..., float]:
    """A value as a function of floats (t, q, u)."""
    if not isinstance(value, Periodic):
        return value
    index = system.columns.index(value.coordinate)
    if value.point is not None:
        point = value.point
        return lambda t, q, u: point(q[index])
    # one angle at a time costs numpy functions 20 to 100 microseconds, a polynomial one
    both = periodic.scalar(fitted(value))
    return lambda t, q, u: both(q[index])[0]


@lru_cache(maxsize=64)
def fitted(value: Periodic) -> Any:
    """Periodic piecewise polynomial of a value, to round-off; one that is such a polynomial stays as it is."""
    if isinstance(value.value, scipy.interpolate.PPoly):
        return value.value
    return periodic.fit(value.value, value.kinks, value.period)


def right_side(
    system: System, w: np.ndarray, t_end: float, spans: Sequence[Any] = ()
) -> Callable[[float, np.ndarray], np.ndarray]:
    """The equations as a fast Python function, for one phase.

    Parameters
    ----------
    w : ndarray, shape (k,)
        Held values of the phase [N*m or N]
    t_end : float
        End of the phase; callables are asked just before it, so that a jump there belongs to the next phase [s]
    spans : sequence of Span
        Intervals of coordinates beyond which callables are not asked, for the same reason

    Returns
    -------
    f : callable
        (t, y) to dy/dt, a new array each time
    """
    buffer: Any
    buffer, call = system.function.buffer()
    t_now, y_now, w_now = np.zeros(1), np.zeros(len(system.columns)), np.array(w)
    out = np.zeros(len(system.columns))
    for i, array in enumerate((t_now, y_now, w_now)):
        buffer.set_arg(i, array.data)
    buffer.set_res(0, out.data)
    sampled = [(i, _asked(system, v)) for i, v in enumerate(system.values) if not isinstance(v, Steps)]
    n, last = system.size, float(np.nextafter(t_end, -np.inf))

    # the default argument keeps the buffer alive as long as the function; without it casadi reads freed memory
    def f(t: float, y: np.ndarray, _alive: Any = buffer) -> np.ndarray:
        y_now[:] = y
        t_now[0] = now = t if t < last else last
        if sampled:
            q, u = y[:n].tolist(), y[n : 2 * n].tolist()
            for s in spans:
                q[s.state] = min(max(q[s.state], s.low), s.high)
            for i, value in sampled:
                w_now[i] = value(now, q, u)
        call()
        return out.copy()

    return f
