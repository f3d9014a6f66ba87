r"""Equations of motion checked against T - V by automatic differentiation, at random states.

.. math:: \frac{d}{dt}\frac{\partial T}{\partial \dot q} - \frac{\partial T}{\partial q} = M \ddot q + h

T is a sum over the bodies whose velocities CasADi differentiates from the positions, not the tape; textbook.py does the
same exactly, which takes too long where closed loops stand in loops.
"""

import random
from typing import Any

import casadi as ca
import numpy as np

from mechsym.derive.lagrange import Equations
from mechsym.derive.printer import to_casadi
from mechsym.derive.rates import accelerations, velocities

_WANTED, _TRIES = 20, 2000


def disagreement(equations: Equations, *, seed: int = 1) -> tuple[int, float]:
    """How far M qdd + h is from the equation of T, relative to the size of the terms.

    Parameters
    ----------
    equations : Equations
        Derived equations
    seed : int
        Seed of the random states

    Returns
    -------
    states : int
        Random states at which all loops close and which were compared, at most 20
    difference : float
        Largest relative difference [-]
    """
    if equations.mechanism.given is not None:
        return 0, 0.0
    function = _both(equations)
    generator, found, worst = random.Random(seed), 0, 0.0
    for _ in range(_TRIES):
        letters = [_draw(equations, function.name_in(i), generator) for i in range(function.n_in())]
        textbook, geometric = (np.asarray(v).ravel() for v in function.call(letters))
        if not (np.all(np.isfinite(textbook)) and np.all(np.isfinite(geometric))):
            continue
        size = float(np.max(np.abs(geometric)) + np.max(np.abs(textbook)))
        if size > 1e6:  # near a dead centre digits are lost on both sides
            continue
        found += 1
        worst = max(worst, float(np.max(np.abs(textbook - geometric))) / (size or 1.0))
        if found == _WANTED:
            break
    return found, worst


def _draw(equations: Equations, name: str, generator: random.Random) -> float:
    bounds = equations.mechanism.ranges.get(name, {})
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
    values: dict[str, Any] = {s.name: v for s, v in letters.items()} | {j.name: ca.SX(0) for j in m.joint_list}
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
