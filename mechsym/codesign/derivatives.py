"""Exact derivatives of a programme in pieces: each row or column that touches everything is kept to itself.

A mean over the turn touches every unknown of its point, and the flywheel touches every row. Coloured together they ask
for hundreds of directions; piece by piece a dozen are enough, and the programme stands in a second.
"""

from collections.abc import Sequence
from typing import Any

import casadi as ca


def solver(x: Any, p: Any, objective: Any, groups: Sequence[Sequence[Any]], options: dict[str, Any]) -> ca.Function:
    """IPOPT for min objective(x, p) subject to bounds on rows: groups share terms, pieces share what they touch."""
    g = ca.vertcat(*(piece for group in groups for piece in group))
    jacobian = ca.vertcat(*(ca.jacobian(piece, x) for group in groups for piece in group))
    by_objective, by_rows = ca.SX.sym("by_objective"), ca.SX.sym("by_rows", g.numel())
    hessian, at = _hessian(by_objective * objective, x), 0
    for group in groups:
        rows = ca.vertcat(*group)
        hessian += _hessian(ca.dot(by_rows[at : at + rows.numel()], rows), x)
        at += rows.numel()
    first = ca.Function("nlp_jac_g", [x, p], [g, jacobian], ["x", "p"], ["g", "jac_g_x"])
    second = ca.Function(
        "nlp_hess_l", [x, p, by_objective, by_rows], [hessian], ["x", "p", "lam_f", "lam_g"], ["triu_hess_gamma_x_x"]
    )
    problem = {"x": x, "p": p, "f": objective, "g": g}
    return ca.nlpsol("codesign", "ipopt", problem, {**options, "jac_g": first, "hess_lag": second})


def _hessian(scalar: Any, x: Any) -> Any:
    return ca.triu(ca.hessian(scalar, x)[0])
