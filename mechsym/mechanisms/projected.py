r"""Motion of a mechanism with loops from all of its coordinates, without a choice of which depend on which.

.. math:: q \leftarrow q - J^+ g(q), \qquad u \leftarrow u - J^+ J u, \qquad
          \begin{pmatrix} M & J^T \\ J & 0 \end{pmatrix} \begin{pmatrix} \ddot q \\ -\mu \end{pmatrix} =
          \begin{pmatrix} Q - h \\ -\gamma \end{pmatrix}

A fixed number of Newton's steps from the last pose, so that it can be written as code; no dead point of a coordinate
disturbs it. Where the loops lose rank, what they do not determine stays as it is.
"""

import casadi as ca

from mechsym.mechanisms.record import Mechanism

_STEPS = 4
_DAMPED = 1e-9  # of the trace of what is solved: below it a direction is left alone, whose rounding no step endures
_REFINED = 2  # times, which takes the damping away elsewhere


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
        return gap, jacobian, bias

    at = q
    for _ in range(_STEPS):
        gap, J, _ = constraints(at, ca.SX(n, 1))
        at = at - ca.mtimes(J.T, _solved(ca.mtimes(J, J.T), gap))
    _, J, _ = constraints(at, ca.SX(n, 1))
    speeds = u - ca.mtimes(J.T, _solved(ca.mtimes(J, J.T), ca.mtimes(J, u)))
    closed = ca.Function("closed", [q, u, p], [at, speeds])
    _, J, gamma = constraints(q, u)
    mass, bias, force = functions["dynamics"](*ca.vertsplit(q), *ca.vertsplit(u), *(ca.vertsplit(w)), *more)
    # with the stiffness of the loops a rod without mass has some
    stiff = ca.mtimes(J.T, J) * (ca.trace(mass) / ca.trace(ca.mtimes(J, J.T)))
    both = _solved(mass + stiff, ca.horzcat(force - bias, J.T), 0.0)
    free, shares = both[:, 0], both[:, 1:]
    mu = -_solved(ca.mtimes(J, shares), ca.mtimes(J, free) + gamma)
    acceleration = free + ca.mtimes(shares, mu)
    rest = ca.mtimes(mass, acceleration) + bias - force  # J^T mu, whatever the stiffness has added to it
    mu = _solved(ca.mtimes(J, J.T), ca.mtimes(J, rest))
    return closed, ca.Function("moved", [q, u, w, p], [acceleration, mu])


def _solved(matrix: ca.SX, right: ca.SX, damped: float = _DAMPED) -> ca.SX:
    """The solution of symmetric positive equations, which a direction that is hardly determined does not blow up."""
    n = matrix.shape[0]
    A, b = ca.densify(matrix) + damped * ca.trace(matrix) * ca.SX.eye(n), ca.densify(right)
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

    x = substituted(b)
    for _ in range(_REFINED if damped else 0):
        x += substituted(b - ca.mtimes(matrix, x))
    return x
