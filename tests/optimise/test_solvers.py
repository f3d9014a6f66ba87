"""How IPOPT ends, and what is said of it: problems of one or two unknowns, solved by hand."""

import casadi as ca
import pytest

from mechsym.errors import BadInput
from mechsym.optimise.solvers import ipopt

QUIET = {"ipopt": {"print_level": 0, "sb": "yes"}, "print_time": False}


def solver(f, g, x):
    return ca.nlpsol("one", "ipopt", {"x": x, "f": f, "g": g}, QUIET)


def test_the_nearest_point_of_a_line():
    x = ca.SX.sym("x", 2)  # x + y = 2 is sqrt(2) from the origin, at (1, 1); moving it by 1 moves f = x^2 + y^2 by 2
    found = ipopt(solver(ca.sumsqr(x), x[0] + x[1], x), {"x0": [3.0, -1.0], "lbg": 2.0, "ubg": 2.0})
    assert found.status == "optimal"
    assert found.values["x"].full().ravel() == pytest.approx([1.0, 1.0], abs=1e-7)
    assert abs(float(found.values["lam_g"])) == pytest.approx(2.0, abs=1e-6)


def test_limits_that_nothing_keeps_are_told_as_such():
    x = ca.SX.sym("x")
    found = ipopt(solver(x, x**2, x), {"x0": 1.0, "lbg": -2.0, "ubg": -1.0})
    assert found.status == "infeasible" and "no design near it keeps all limits" in found.reason


def test_a_formula_without_a_value_is_told_as_such():
    x = ca.SX.sym("x")
    found = ipopt(solver(ca.sqrt(x), x, x), {"x0": -1.0, "lbg": -2.0, "ubg": -0.5})
    assert found.status == "not converged" and "root of a negative number" in found.reason


def test_what_casadi_throws_is_one_line_for_people():
    x = ca.SX.sym("x")
    with pytest.raises(BadInput, match="the design problem cannot be solved") as told:
        ipopt(solver(x, x, x), {"x0": [1.0, 2.0, 3.0]})
    assert "\n" not in str(told.value)
