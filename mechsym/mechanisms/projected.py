r"""Motion of a mechanism with loops from all of its coordinates, without a choice of which depend on which.

.. math:: q \leftarrow q - A^{-1} J^T S^{-1} g(q), \qquad u \leftarrow u - A^{-1} J^T S^{-1} J u, \qquad
          S = J A^{-1} J^T, \qquad A = M + \kappa J^T J

.. math:: \ddot q = a - A^{-1} J^T S^{-1} (J a + \gamma), \qquad a = A^{-1} (Q - h)

A fixed number of Newton's steps from the last pose, so that it can be written as code; no dead point of a coordinate
disturbs it. Where the loops lose rank, what they do not determine stays as it is. What is off the loops is taken away
in the metric of the masses, as their forces would: none of it turns into motion along them. With the stiffness kappa of
the loops a rod without mass has some.
"""

from collections.abc import Callable

import casadi as ca

from mechsym.mechanisms.record import Mechanism

Solver = Callable[[ca.SX], ca.SX]
_STEPS = 4
_DAMPED = 1e-12  # of the trace of what is solved: below it a direction is left alone, whose rounding no step endures
_PLACED, _PUSHED = 1e-8, 1e-7  # the same of places and of speeds, which the motion has brought along well
_REFINED = 2  # times, which takes the damping away elsewhere; Newton's steps do so by themselves


def projected(mechanism: Mechanism, letters: int = 0) -> tuple[ca.Function, ca.Function]:
    """`closed(q, u, letters)`: coordinates and velocities on the loops; `moved(q, u, inputs, letters)`: accelerations
    and multipliers there.

    letters: how many parameters the functions take behind their own inputs.
    """
    n, functions = len(mechanism.coordinates), mechanism.functions
    q, u = ca.SX.sym("q", n), ca.SX.sym("u", n)
    w, p = ca.SX.sym("w", len(mechanism.inputs)), ca.SX.sym("p", letters)
    more = ca.vertsplit(p) if letters else []

    def constraints(at: ca.SX, speeds: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
        gap, jacobian, bias = functions["constraints"](*ca.vertsplit(at), *ca.vertsplit(speeds), *more)
        return gap, ca.densify(jacobian), bias

    def dynamics(at: ca.SX, speeds: ca.SX, inputs: ca.SX) -> tuple[ca.SX, ca.SX, ca.SX]:
        letters_of = (*ca.vertsplit(at), *ca.vertsplit(speeds), *ca.vertsplit(inputs), *more)
        mass, bias, force = functions["dynamics"](*letters_of)
        return ca.densify(mass), bias, force

    still = ca.SX(n, 1)

    def metric(at: ca.SX) -> ca.SX:
        mass, _, _ = dynamics(at, still, ca.SX(w.shape[0], 1))
        _, J, _ = constraints(at, still)
        return mass + ca.mtimes(J.T, J) * (ca.trace(mass) / ca.trace(ca.mtimes(J, J.T)))

    def normal(solved: Solver, J: ca.SX, off: ca.SX, damped: float, refined: int) -> ca.SX:
        shares = solved(J.T)
        return ca.mtimes(shares, _solver(ca.mtimes(J, shares), damped, refined)(off))

    at, solved = q, _solver(metric(q))
    for _ in range(_STEPS):
        gap, J, _ = constraints(at, still)
        at = at - normal(solved, J, gap, _PLACED, 0)
    _, J, _ = constraints(at, still)
    closed = ca.Function("closed", [q, u, p], [at, u - normal(solved, J, ca.mtimes(J, u), _PUSHED, _REFINED)])
    _, J, gamma = constraints(q, u)
    mass, bias, force = dynamics(q, u, w)
    solved = _solver(metric(q))
    free = solved(force - bias)
    acceleration = free - normal(solved, J, ca.mtimes(J, free) + gamma, _DAMPED, _REFINED)
    rest = ca.mtimes(mass, acceleration) + bias - force  # J^T mu, whatever the stiffness has added to it
    mu = _solver(ca.mtimes(J, J.T), _DAMPED, _REFINED)(ca.mtimes(J, rest))
    return closed, ca.Function("moved", [q, u, w, p], [acceleration, mu])


def _solver(matrix: ca.SX, damped: float = 0.0, refined: int = 0) -> Solver:
    """Solves symmetric positive equations, in which a direction that is hardly determined does not blow up."""
    n = matrix.shape[0]
    A = ca.densify(matrix) + damped * ca.trace(matrix) * ca.SX.eye(n)
    L, d = ca.SX.eye(n), [ca.SX(0)] * n
    for j in range(n):
        d[j] = A[j, j] - sum((L[j, k] ** 2 * d[k] for k in range(j)), ca.SX(0))
        for i in range(j + 1, n):
            L[i, j] = (A[i, j] - sum((L[i, k] * L[j, k] * d[k] for k in range(j)), ca.SX(0))) / d[j]

    def substituted(b: ca.SX) -> ca.SX:
        rows = [b[i, :] for i in range(n)]
        for i in range(n):
            for k in range(i):
                rows[i] -= L[i, k] * rows[k]
        for i in reversed(range(n)):
            rows[i] = rows[i] / d[i]
            for k in range(i + 1, n):
                rows[i] -= L[k, i] * rows[k]
        return ca.vertcat(*rows)

    def solved(right: ca.SX) -> ca.SX:
        b = ca.densify(right)
        x = substituted(b)
        for _ in range(refined):
            x += substituted(b - ca.mtimes(matrix, x))
        return x

    return solved
