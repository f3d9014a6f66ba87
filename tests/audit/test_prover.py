"""Exactness: digits decide, the certificate proves; orders and honesty of approximations; dimensions."""

import math

import mpmath
import numpy as np
import pytest
import sympy

from mechsym.audit.judge.dimensions import is_consistent, rescaled
from mechsym.audit.judge.orders import groups, orders
from mechsym.audit.judge.prover import is_exact, judges, proves_equal
from mechsym.audit.judge.question import max_rel_error, turn
from mechsym.audit.read.algebra import DIGITS, FLOATS, SYMBOLS, evaluate
from mechsym.audit.read.reader import read_expression
from mechsym.audit.repair.examination import examine, standing
from mechsym.audit.repair.search import truncated

EXACT = [
    ("r*sin(phi + psi)/cos(psi)", "dx_dphi"),
    ("r*sin(phi) + r**2*sin(2*phi)/(2*sqrt((l1 + l2)**2 - r**2*sin(phi)**2))", "dx_dphi"),
    ("r*(1 - cos(phi) + 1/lam*(1 - sqrt(1 - lam**2*sin(phi)**2)))", "x"),
    ("lam*cos(phi)/sqrt(1 - lam**2*sin(phi)**2)", "dpsi_dphi"),
    ("1/2*inertia*phid**2", "kinetic_energy"),
    ("sqrt(1 - sin(psi)**2)", "cos_psi"),
]
WRONG = [
    ("r*sin(phi - psi)/cos(psi)", "dx_dphi"),
    ("r*sin(phi)", "dx_dphi"),
    ("r*sin(phi + psi)/cos(psi)*(1 + 1e-25)", "dx_dphi"),
    ("r*abs(sin(phi + psi)/cos(psi))", "dx_dphi"),
    ("sqrt(-r)", "dx_dphi"),
]


@pytest.mark.parametrize(("text", "quantity"), EXACT)
def test_exact_formulas_are_proved(ask, text, quantity):
    question = ask(text, quantity)
    assert is_exact(judges(question), question.formula.tree)
    assert proves_equal(question, question.formula.tree)
    assert max_rel_error(turn(question), question.formula.tree) < 1e-12


@pytest.mark.parametrize(("text", "quantity"), WRONG)
def test_the_rest_is_refuted_down_to_the_last_digits(ask, text, quantity):
    question = ask(text, quantity)
    assert not is_exact(judges(question), question.formula.tree)
    assert not proves_equal(question, question.formula.tree)


def test_orders_by_group(ask, inertia):
    question = ask(inertia["-"], "inertia")
    found = orders(groups(question), question.formula.tree)
    assert found == {"m2": 1, "m3": 3, "m4": 3, "m5": 3, "I01": math.inf, "IC2": 4}
    assert orders(groups(question), ask(inertia["+"], "inertia").formula.tree)["m2"] == 3


@pytest.mark.parametrize(
    ("text", "quantity", "order", "honest"),
    [
        ("r*sin(phi)", "dx_dphi", 1, True),
        ("r*sin(phi) + 0.5*l*lam**2*sin(2*phi)", "dx_dphi", 3, True),
        ("r*sin(phi) - 0.5*l*lam**2*sin(2*phi)", "dx_dphi", 1, False),
        ("r*cos(phi)", "dx_dphi", -1, False),
        ("1 - 0.25*lam**2 + 0.25*lam**2*cos(2*phi)", "cos_psi", 4, True),
        ("1 - 0.5*lam**2 + 0.25*lam**2*cos(2*phi)", "cos_psi", 2, False),
        ("m2*g*l2*lam*cos(phi)*(1 - lam**4)", "gravity_torque", -1, False),
    ],
)
def test_orders_and_honest_truncations(ask, text, quantity, order, honest):
    question = ask(text, quantity, hold={"axis_tilt": 0.0})
    exam = examine(question)
    start = standing(exam, question.formula.tree)
    assert min(start.orders.values()) == order
    assert (truncated(exam, start) is not None) is honest


def test_without_rods_there_is_no_order(ask):
    assert groups(ask("p1*V1/(R*T1)", "otto.m1", {})) == []


@pytest.mark.parametrize(
    ("text", "consistent"),
    [("r*sin(phi)", True), ("r**2*sin(phi)", False), ("r + 1", False), ("m2*r/m1", True), ("r*lam", True)],
)
def test_dimensions_by_scaling(ask, text, consistent):
    question = ask(text, "dx_dphi")
    assert is_consistent(rescaled(question), question.formula.tree) is consistent


NAMES = {"r": 0.7, "phi": 1.2}


@pytest.mark.parametrize(
    "text", ["r**2*sin(phi)/(1 + cos(2*phi))", "sqrt(r) - abs(-r) + exp(r)*log(r)", "1/3 + atan(r)"]
)
def test_three_number_systems_agree(text):
    tree = read_expression(text, [*NAMES])[0]
    with mpmath.workdps(30):
        digits = evaluate(tree, {k: mpmath.mpf(v) for k, v in NAMES.items()}, DIGITS)
    symbols = evaluate(tree, {k: sympy.Float(v, 30) for k, v in NAMES.items()}, SYMBOLS)
    assert float(digits) == pytest.approx(float(evaluate(tree, NAMES, FLOATS)), rel=1e-14)
    assert float(symbols) == pytest.approx(float(digits), rel=1e-14)


@pytest.mark.parametrize("text", ["sqrt(-r)", "1/(r - r)", "log(-r)", "asin(2 + r)", "9**9**9**9**9", "sin(9**9**9)"])
def test_what_has_no_value_is_nan_and_costs_nothing(text):
    tree = read_expression(text, [*NAMES])[0]
    value = evaluate(tree, {k: np.array([mpmath.mpf(v)]) for k, v in NAMES.items()}, DIGITS)
    assert mpmath.isnan(np.atleast_1d(value)[0])
    with np.errstate(all="ignore"):
        assert not np.all(np.isfinite(evaluate(tree, NAMES, FLOATS)))
