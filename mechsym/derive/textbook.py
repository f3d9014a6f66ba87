r"""The textbook Lagrangian as the check of the geometric form.

.. math:: \frac{d}{dt}\frac{\partial T}{\partial \dot q} - \frac{\partial T}{\partial q} = M \ddot q + h

with T written out in closed form and differentiated by sympy, not by the tape. Both sides must agree exactly.
"""

import random

from sympy import Expr, Integer, Symbol

from mechsym.derive.identity import random_state, vanishes, vanishes_at_random_points
from mechsym.derive.lagrange import Equations
from mechsym.derive.rates import accelerations, velocities


def lagrange_left_side(equations: Equations) -> list[Expr]:
    """d/dt(dT/dqdot) - dT/dq in closed form.

    Parameters
    ----------
    equations : Equations
        Derived equations with a kinetic energy

    Returns
    -------
    left : list of Expr
        One expression a coordinate, in coordinates, velocities, accelerations and parameters
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
    """M qdd + h in closed form.

    Parameters
    ----------
    equations : Equations
        Derived equations

    Returns
    -------
    left : list of Expr
        One expression a coordinate
    """
    a = accelerations(equations.mechanism)
    rows = zip(equations.mass_matrix, equations.bias, strict=True)
    return [_held(equations, sum((e * x for e, x in zip(row, a, strict=True)), bias)) for row, bias in rows]


def _held(equations: Equations, expression: Expr) -> Expr:
    flat = equations.mechanism.tape.flat(expression)
    return flat.xreplace(dict.fromkeys(equations.mechanism.joint_list, Integer(0)))


def disagreements(equations: Equations, *, seed: int = 1) -> list[str]:
    """Coordinates in which the two forms differ.

    Parameters
    ----------
    equations : Equations
        Derived equations with a kinetic energy
    seed : int
        Seed of the random states

    Returns
    -------
    names : list of str
        Empty when the forms agree at 20 random states to 40 digits
    """
    generator, wrong = random.Random(seed), []
    pairs = zip(equations.mechanism.q, lagrange_left_side(equations), geometric_left_side(equations), strict=True)
    for v, textbook, geometric in pairs:
        letters = sorted((textbook.free_symbols | geometric.free_symbols), key=lambda s: s.name)
        states = [_admissible(letters, generator) for _ in range(20)]
        if not vanishes_at_random_points(textbook - geometric, textbook, states):
            wrong.append(v.name)
    return wrong


def _admissible(letters: list[Symbol], generator: random.Random) -> dict[Symbol, Expr]:
    # rods are longer than cranks: every letter that starts with l gets 2 more
    return {s: v + (2 if s.name.startswith("l") else 0) for s, v in random_state(letters, generator).items()}


def proved(equations: Equations) -> bool:
    """Whether the agreement of the two forms has a polynomial certificate.

    Parameters
    ----------
    equations : Equations
        Derived equations with a kinetic energy

    Returns
    -------
    proved : bool
        True is a proof for all states and parameters
    """
    pairs = zip(lagrange_left_side(equations), geometric_left_side(equations), strict=True)
    return all(vanishes(textbook - geometric) for textbook, geometric in pairs)
