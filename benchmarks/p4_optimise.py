"""P4: the torque of an elastic hinge with least effort that keeps a period's speed within bounds, 200 midpoint nodes.

Minimise the mean square of the torque u over a period in which the crosshead engine turns once; at every node
x_{k+1} - x_k = h f((x_k + x_{k+1})/2, u_k), the motion is periodic and the speed stays within 2 per cent of its mean.
"""

from collections.abc import Callable
from typing import Any

import casadi as ca
import numpy as np

from benchmarks import models, nlp, translate
from benchmarks.measure import Route, Row, take_turns
from mechsym.native.evaluate import external

NODES, SPEED, RIPPLE = 200, 9.32, 0.02
_FORCE, _LOAD = 4e4, 5e3  # a gas force that looks like one, and the load


def rows(skipped: list[str]) -> list[Row]:
    """Measure repeated solves.

    Parameters
    ----------
    skipped : list of str
        Names of alternatives that are not installed are added

    Returns
    -------
    rows : list of Row
        Time of one solve
    """
    solvers = {
        "casadi interpreted (map)": _mapped(_node(), _interpreted),
        "casadi SX expanded": _mapped(_node(), _expanded),
        "mechsym (node compiled)": _mapped(external(_node()), _interpreted),
        "mechsym (all compiled)": _mapped(_node(), nlp.nlpsol),
    }
    routes, wanted = [], None
    for name, solve in solvers.items():
        found = solve()
        wanted = found if wanted is None else wanted
        error = float(np.max(np.abs(found - wanted)) / np.max(np.abs(wanted)))
        routes.append(Route(name=name, call=solve, error=_checked(name, error)))
    try:
        solve = _opty()
    except ImportError:
        skipped.append("opty")
    else:
        error = float(np.max(np.abs(solve() - wanted)) / np.max(np.abs(wanted)))
        routes.append(Route(name="opty", call=solve, error=_checked("opty", error), rounds=3))
    return take_turns("P4 repeated solve", f"{NODES} nodes", routes)


def _checked(name: str, error: float) -> float:
    # opty gives IPOPT no second derivatives, which then ends as soon as the objective is flat
    if not error < (1e-2 if name == "opty" else 1e-5):
        raise AssertionError(f"{name} finds another torque: relative difference {error:.3g}")
    return error


def _node() -> ca.Function:
    a, b, u, h = (ca.SX.sym(n, k) for n, k in (("a", 2), ("b", 2), ("u", 1), ("h", 1)))
    phi, omega = ca.vertsplit((a + b) / 2)
    force = _FORCE * (0.5 + 0.5 * ca.cos(phi)) ** 4
    slope = ca.vertcat(omega, models.acceleration("1-DOF")(phi, omega, force, _LOAD / 10, u))
    return ca.Function("node", [a, b, u, h], [b - a - h * slope], ["a", "b", "u", "h"], ["defect"])


def _interpreted(name: str, problem: Any, options: Any) -> ca.Function:
    return ca.nlpsol(name, "ipopt", problem, options)


def _expanded(name: str, problem: Any, options: Any) -> ca.Function:
    return ca.nlpsol(name, "ipopt", problem, options | {"expand": True})


def _mapped(node: ca.Function, make: Callable[[str, Any, Any], ca.Function]) -> Callable[[], np.ndarray]:
    x, u, load = ca.MX.sym("x", 2, NODES + 1), ca.MX.sym("u", 1, NODES), ca.MX.sym("load")
    h = 2 * np.pi / SPEED / NODES
    defects = node.map(NODES)(x[:, :-1], x[:, 1:], u - load, h)
    ends = ca.vertcat(x[0, 0], x[0, -1] - 2 * np.pi, x[1, -1] - x[1, 0])
    problem = {
        "x": ca.vertcat(ca.vec(x), ca.vec(u)), "p": load, "f": ca.sumsqr(u) / NODES * 1e-8,
        "g": ca.vertcat(ca.vec(defects), ends),
    }  # fmt: skip
    solver = make("solver", problem, {"ipopt.print_level": 0, "print_time": False, "ipopt.sb": "yes"})
    guess = np.concatenate([_guess().ravel(order="F"), np.zeros(NODES)])
    low = np.full(guess.size, -np.inf)
    high = np.full(guess.size, np.inf)
    low[1 : 2 * NODES + 2 : 2], high[1 : 2 * NODES + 2 : 2] = SPEED * (1 - RIPPLE / 2), SPEED * (1 + RIPPLE / 2)

    def solve() -> np.ndarray:
        found = solver(x0=guess, p=0.0, lbx=low, ubx=high, lbg=0, ubg=0)
        if not solver.stats()["success"]:
            raise AssertionError(f"IPOPT ended with {solver.stats()['return_status']}")
        return np.asarray(found["x"]).ravel()[-NODES:]

    return solve


def _opty() -> Callable[[], np.ndarray]:
    import sympy
    from opty import Problem

    t, count, duration = sympy.Symbol("t"), NODES + 1, 2 * np.pi / SPEED
    phi, omega, u = (sympy.Function(n)(t) for n in ("phi", "omega", "u"))
    symbols, (acceleration,) = translate.sympy_expressions(models.acceleration("1-DOF"))
    force = _FORCE * ((1 + sympy.cos(phi)) / 2) ** 4
    motion = acceleration.subs(dict(zip(symbols, (phi, omega, force, _LOAD / 10, u), strict=True)))
    problem = Problem(
        lambda free: 1e-8 / NODES * np.sum(_midpoints(free) ** 2),
        lambda free: 1e-8 / NODES * np.concatenate([np.zeros(2 * count), _spread(_midpoints(free))]),
        sympy.Matrix([phi.diff(t) - omega, omega.diff(t) - motion]), (phi, omega), count, duration / NODES,
        instance_constraints=(
            phi.func(0), phi.func(duration) - 2 * sympy.pi.evalf(), omega.func(0) - omega.func(duration)
        ),
        bounds={omega: (SPEED * (1 - RIPPLE / 2), SPEED * (1 + RIPPLE / 2))}, integration_method="midpoint",
        time_symbol=t,
    )  # fmt: skip
    problem.add_option("print_level", 0)
    problem.add_option("sb", "yes")
    guess = np.concatenate([*_guess(), np.zeros(count)])

    def solve() -> np.ndarray:
        free, report = problem.solve(guess)
        if report["status"] != 0:
            raise AssertionError(f"opty ended with {report['status_msg']}")
        return _midpoints(free)

    return solve


def _midpoints(free: np.ndarray) -> np.ndarray:
    # opty has a torque at every node and takes the mean of two in between
    u = free[2 * (NODES + 1) :]
    return (u[1:] + u[:-1]) / 2


def _spread(slopes: np.ndarray) -> np.ndarray:
    return np.concatenate([slopes, [0.0]]) + np.concatenate([[0.0], slopes])


def _guess() -> np.ndarray:
    return np.stack([np.linspace(0, 2 * np.pi, NODES + 1), np.full(NODES + 1, SPEED)])
