r"""The textbook Lagrangian as the check of the geometric form.

.. math:: \frac{d}{dt}\frac{\partial T}{\partial \dot q} - \frac{\partial T}{\partial q} = M \ddot q + h

with T written out in closed form and differentiated by sympy, not by the tape. Both sides must agree exactly.

Where closed loops stand in loops that takes too long: `disagreement` checks at random states, T a sum over the bodies
whose velocities CasADi differentiates from the positions, not the tape.
"""

import random

import casadi as ca
import numpy as np
from sympy import Expr, Integer

from mechsym.derive.identity import random_state, vanishes, vanishes_at_random_points
from mechsym.derive.lagrange import Equations
from mechsym.derive.printer import to_casadi
from mechsym.derive.rates import accelerations, velocities
from mechsym.quantities.units import Pure


def lagrange_left_side(equations: Equations) -> list[Expr]:
    """d/dt(dT/dqdot) - dT/dq in closed form.

    equations: derived equations with a kinetic energy. Returns left: one expression a coordinate, in coordinates,
    velocities, accelerations and parameters.
    """
    m = equations.mechanism
    T = _held(equations, equations.kinetic_energy)
    q, u, a = m.q, velocities(m), accelerations(m)
    left = []
    for i, v in enumerate(q):
        momentum = T.diff(u[i])
        rate = sum((momentum.diff(q[j]) * u[j] + momentum.diff(u[j]) * a[j] for j in range(len(q))), Integer(0))
        left.append(rate - T.diff(v))
    return left


def geometric_left_side(equations: Equations) -> list[Expr]:
    """M qdd + h in closed form. Returns left: one expression a coordinate."""
    a = accelerations(equations.mechanism)
    rows = zip(equations.mass_matrix, equations.bias, strict=True)
    return [_held(equations, sum((e * x for e, x in zip(row, a, strict=True)), bias)) for row, bias in rows]


def _held(equations: Equations, expression: Expr) -> Expr:
    flat = equations.mechanism.tape.flat(expression)
    return flat.xreplace(dict.fromkeys(equations.mechanism.joint_list, Integer(0)))


def disagreements(equations: Equations, *, seed: int = 1) -> list[str]:
    """Coordinates in which the two forms differ.

    equations: derived equations with a kinetic energy; seed: seed of the random states. Returns names: empty when the
    forms agree at 20 random states to 40 digits.
    """
    generator, wrong = random.Random(seed), []
    pairs = zip(equations.mechanism.q, lagrange_left_side(equations), geometric_left_side(equations), strict=True)
    for v, textbook, geometric in pairs:
        letters = sorted((textbook.free_symbols | geometric.free_symbols), key=lambda s: s.name)
        states = [random_state(letters, generator) for _ in range(20)]
        for state in states:  # rods are longer than cranks: every letter that starts with l gets 2 more
            state |= {s: v + 2 for s, v in state.items() if s.name.startswith("l")}
        if not vanishes_at_random_points(textbook - geometric, textbook, states):
            wrong.append(v.name)
    return wrong


_TERMS = 1_000_000  # a declaration is proved once, in minutes if need be; formulas are not


def proved(equations: Equations) -> bool:
    """Whether the agreement of the two forms has a polynomial certificate.

    equations: derived equations with a kinetic energy. Returns proved: True is a proof for all states and parameters.
    """
    pairs = zip(lagrange_left_side(equations), geometric_left_side(equations), strict=True)
    return all(vanishes(textbook - geometric, _TERMS) for textbook, geometric in pairs)


_WANTED, _TRIES = 20, 2000


def disagreement(equations: Equations, *, seed: int = 1) -> tuple[int, Pure]:
    """How far M qdd + h is from the equation of T, relative to the size of the terms.

    seed: seed of the random states. Returns states: random states at which all loops close and which were compared, at
    most 20; difference: largest relative difference.
    """
    if equations.mechanism.given is not None:
        return 0, 0.0
    if equations.checked is not None:
        return equations.checked()
    function = _both(equations)
    generator, compared, worst = random.Random(seed), 0, 0.0
    for _ in range(_TRIES):
        letters = [_draw(equations, function.name_in(i), generator) for i in range(function.n_in())]
        textbook, geometric = (np.asarray(v).ravel() for v in function.call(letters))
        if not (np.all(np.isfinite(textbook)) and np.all(np.isfinite(geometric))):
            continue
        size = float(np.max(np.abs(geometric)) + np.max(np.abs(textbook)))
        if size > 1e6:  # near a dead centre digits are lost on both sides
            continue
        compared += 1
        worst = max(worst, float(np.max(np.abs(textbook - geometric))) / (size or 1.0))
        if compared == _WANTED:
            break
    return compared, worst


def _draw(equations: Equations, name: str, generator: random.Random) -> float:
    bounds: dict[str, float] = equations.mechanism.ranges.get(name, {})
    low = max(bounds.get("above", bounds.get("low", 0.1)), 0.1)
    high = bounds.get("below", bounds.get("high", low + 2.0))
    if name in {q.name for q in equations.mechanism.q}:
        return generator.uniform(-3.0, 3.0)
    return generator.uniform(min(low, high), max(low, high))


def _both(equations: Equations) -> ca.Function:
    """Both left-hand sides as one function of coordinates, velocities, accelerations and parameters."""
    m = equations.mechanism
    known = [*m.q, *velocities(m), *accelerations(m), *m.input_list, *m.parameter_list]
    letters = {s: ca.SX.sym(s.name) for s in known}
    values: dict[str, ca.SX] = {s.name: v for s, v in letters.items()} | {j.name: ca.SX(0) for j in m.joint_list}
    q, u, a = (ca.vertcat(*(letters[s] for s in group)) for group in (m.q, velocities(m), accelerations(m)))
    wanted = [e for row in equations.mass_matrix for e in row] + list(equations.bias)
    positions = [e for b in m.bodies for e in (*b.at, b.turns, b.mass, b.inertia)]
    for symbol in m.tape.needed([*positions, *wanted]):
        values[symbol.name] = to_casadi(m.tape.entries[symbol], values)
    kinetic = ca.SX(0)
    for body in m.bodies:
        parts = [] if body.about_axis else [(body.mass, p) for p in body.at]
        for inertia, position in [*parts, (body.inertia, body.turns)]:
            rate = ca.jtimes(ca.SX(to_casadi(position, values)), q, u)
            kinetic += to_casadi(inertia, values) * rate**2 / 2
    momentum = ca.gradient(kinetic, u)
    textbook = ca.jtimes(momentum, ca.vertcat(q, u), ca.vertcat(u, a)) - ca.gradient(kinetic, q)
    n, sides = len(m.q), [to_casadi(e, values) for e in wanted]
    mass = ca.vertcat(*(ca.horzcat(*sides[i * n : (i + 1) * n]) for i in range(n)))
    geometric = ca.mtimes(mass, a) + ca.vertcat(*sides[n * n :])
    return ca.Function(
        "both",
        list(letters.values()),
        [textbook, geometric],
        [s.name for s in known],
        ["left_of_textbook", "left_of_geometric"],
    )
