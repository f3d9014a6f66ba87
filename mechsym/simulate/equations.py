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

from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.mechanisms.record import Mechanism, acceleration_function, velocities
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.units import Scalar, Second
from mechsym.simulate.problem import Along, FormulaForce, Part, Periodic, Problem, Steps

RUBS = "loss_"  #: Before the name of a friction: the column of the energy that it has turned into heat


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


def system(problem: Problem, letters: Sequence[ca.SX] = (), numbers: Sequence[ca.SX] = ()) -> System:
    r"""The equations of a problem, with the power balance beside the motion.

    .. math:: \dot W_j = w_j\, v_j,\quad v_j = \sum_i \frac{\partial Q_i}{\partial w_j} u_i,\qquad
              \dot D = -\sum_i u_i \Big(Q_i(q, u, 0) + \frac{\partial V}{\partial q_i}\Big)

    letters: sequence of casadi.SX, parameters that the mechanism leaves open; numbers: likewise, of formulas; both
    become the last inputs of the function. Raises BadInput: the mechanism has constraints, which need multipliers.
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
    last = w.shape[0] - (2 if problem.inertia else 0)
    curves = ca.vertsplit(w[last - len(problem.curves) : last]) if problem.curves else []
    along = (u, curves, ca.vertsplit(y[len(columns) - len(problem.states) :]))
    values = part_values(problem, t, q, u, w, along)
    inputs = [sum((v for p, v in values if p.input == name), ca.SX(0)) for name in mechanism.inputs]
    qdd = _carrying(problem, q, u, w, acceleration_function(mechanism)(*q, *u, *inputs, *letters))
    rates, loss = power(mechanism, q, u, letters)
    powers = [value * rates[part.input] for part, value in values]
    inner = [s.rate.function(*along) for s in problem.states]
    ydot = ca.vertcat(*u, qdd, *powers, loss, *inner)
    return System(
        function=ca.Function("system", [t, y, ca.vertcat(w, *letters, *numbers)], [ydot], ["t", "y", "w"], ["ydot"]),
        columns=columns,
        units=mechanism.state_units + ("J",) * (len(works) + 1) + tuple(s.unit for s in problem.states),
        values=outer,
        size=n,
        audited="energy" in mechanism.functions,
    )


def start_of(problem: Problem, equations: System) -> np.ndarray:
    """The state at the start, no work done yet. Returns y: in the order of the columns [SI], shape (m,)."""
    states = [s.start for s in problem.states]
    none = np.zeros(len(equations.columns) - 2 * equations.size - len(states))
    return np.concatenate([problem.q0, problem.u0, none, states])


def outer_values(problem: Problem) -> tuple[Steps | Periodic | Callable[..., float], ...]:
    """The values that no formula gives, in the order of w: of the parts, the curves, the inertia and its slope."""
    parts = (p.value for p in problem.parts if not isinstance(p.value, FormulaForce | Along))
    return (*parts, *problem.curves, *(problem.inertia or ()))


def part_values(
    problem: Problem,
    t: Scalar,
    q: Sequence[Scalar],
    u: Sequence[Scalar],
    w: Scalar,
    along: tuple[Sequence[Scalar], ...] = ((), (), ()),
) -> list[tuple[Part, Scalar]]:
    """Each part with the symbol or the formula of its value [SI]; `along` is what those of `Along` take."""
    values, next_w = [], 0
    for part in problem.parts:
        if isinstance(part.value, FormulaForce):
            values.append((part, ca.SX(part.value.function(t, q, u, *part.value.numbers))))
        elif isinstance(part.value, Along):
            values.append((part, ca.SX(part.value.function(*along))))
        else:
            values.append((part, w[next_w]))
            next_w += 1
    return values


def _carrying(problem: Problem, q: Sequence[Scalar], u: Sequence[Scalar], w: Scalar, qdd: Scalar) -> Scalar:
    r"""Acceleration of a shaft that turns more inertia than its mechanism has.

    .. math:: (I + I_h)\,\ddot q = I \ddot q_0 - \tfrac12 I_h' \dot q^2
    """
    if problem.inertia is None:
        return qdd
    without = [0.0] * len(problem.mechanism.inputs)
    own = problem.mechanism.functions["dynamics"](*q, *u, *without)[0]
    return (own * qdd - w[-1] * u[0] ** 2 / 2) / (own + w[-2])


def power(
    mechanism: Mechanism, q: Sequence[Scalar], u: Sequence[Scalar], letters: Sequence[ca.SX] = ()
) -> tuple[dict[str, ca.SX], ca.SX]:
    """Speed conjugate to each input [m/s or rad/s], and power lost inside [W]. q, u: coordinates, velocities [SI]."""
    inputs = ca.SX.sym("inputs", len(mechanism.inputs))
    force = mechanism.functions["dynamics"](*q, *u, *ca.vertsplit(inputs), *letters)[2]
    speeds = ca.jacobian(force, inputs).T @ ca.vertcat(*u)
    rates = dict(zip(mechanism.inputs, ca.vertsplit(speeds), strict=True))
    if "energy" not in mechanism.functions:
        return rates, ca.SX(0)
    potential = mechanism.functions["energy"](*q, *u, *letters)[1]
    passive = ca.substitute(force, inputs, ca.SX.zeros(inputs.shape))
    return rates, -ca.dot(ca.vertcat(*u), passive + ca.gradient(potential, ca.vertcat(*q)))


def held(system: System, t: Second) -> np.ndarray:
    """Values of the inputs [N*m or N], shape (k,), at a time right of any jump; a callable's place stays 0."""
    now = [0.0] * len(system.values)
    for i, value in enumerate(system.values):
        if isinstance(value, Steps):
            now[i] = value.values[int(np.searchsorted(value.times, t, side="right"))]
    return np.array([*now, *system.fixed], dtype=float)


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
def fitted(value: Periodic) -> PPoly:
    """Periodic piecewise polynomial of a value, to round-off; one that is such a polynomial stays as it is."""
    if isinstance(value.value, PPoly):
        return value.value
    return periodic.fit(value.value, value.kinks, value.period)


def right_side(
    system: System, w: np.ndarray, t_end: Second, spans: Sequence[Any] = ()
) -> Callable[[float, np.ndarray], np.ndarray]:
    """The equations as a fast Python function, for one phase.

    w: held values of the phase [N*m or N], shape (k,). t_end: end of the phase; callables are asked just before it, so
    that a jump there belongs to the next phase. spans: sequence of Span, intervals of coordinates beyond which
    callables are not asked, for the same reason. Returns f: (t, y) to dy/dt, a new array each time.
    """
    t_now, y_now, w_now = np.zeros(1), np.zeros(len(system.columns)), np.array(w)
    rates = through_buffer(system.function, t_now, y_now, w_now)
    sampled = [(i, _asked(system, v)) for i, v in enumerate(system.values) if not isinstance(v, Steps)]
    n, last = system.size, float(np.nextafter(t_end, -np.inf))

    def f(t: float, y: np.ndarray) -> np.ndarray:
        y_now[:] = y
        t_now[0] = now = t if t < last else last
        if sampled:
            q, u = y[:n].tolist(), y[n : 2 * n].tolist()
            for s in spans:
                q[s.state] = min(max(q[s.state], s.low), s.high)
            for i, value in sampled:
                w_now[i] = value(now, q, u)
        return rates()

    return f


def through_buffer(function: ca.Function, *inputs: np.ndarray) -> Callable[[], np.ndarray]:
    """A function that reads its inputs [SI] where they stand; each call returns its first output as a new array."""
    buffer: Any
    buffer, call = function.buffer()
    for i, array in enumerate(inputs):
        buffer.set_arg(i, array.data)
    out = np.zeros(function.size1_out(0))
    buffer.set_res(0, out.data)

    # the default argument keeps the buffer alive as long as the function; without it casadi reads freed memory
    def evaluate(_alive: object = buffer) -> np.ndarray:
        call()
        return out.copy()

    return evaluate
