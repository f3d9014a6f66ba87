"""What no load changes is computed once: the same values as when every load is asked alone."""

import mpmath
import pytest

from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.judge.orders import COARSE, ORDER_DIGITS, LongRods
from mechsym.audit.judge.question import Question, bench, digit_values, drawn, small_rods, value
from mechsym.audit.read.algebra import DIGITS
from mechsym.audit.read.reader import read
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import known


@pytest.mark.parametrize("load", ["m", "F", "all"])
def test_one_load_is_as_if_it_were_asked_alone(load):
    found = theory("slider_crank")
    text = "(F - m*(dx_dphi*phidd + q*phid**2))*dx_dphi"
    formula = read(text, known(found), {"q": "r*cos(phi)", "unused": "m*r"}, found.tape)
    question, loads = Question(formula=formula, theory=found, quantity="torque"), ("m", "F")
    values = drawn(question, 3, seed=3)
    shared = LongRods(question=question, values=values, eps=COARSE, loads=loads)
    shared.bench("F"), shared.bench("all")  # what others left behind changes nothing
    asked = shared.bench(load)
    alone = values | {k: [v * 0 for v in values[k]] for k in loads if load not in (k, "all")}
    with mpmath.workdps(ORDER_DIGITS):
        digits = digit_values(small_rods(found, alone, COARSE))
    other = bench(question, digits, DIGITS, ORDER_DIGITS)
    for one, two in ((asked.expected, other.expected), (value(asked, formula.tree), value(other, formula.tree))):
        assert all(a == b for a, b in zip(one, two, strict=True))


def test_the_springs_work_has_its_force_for_a_slope():
    # z = 2 rho0 - 2 rho, and the spring gives what it loses
    assert check_formula("2*spring_force", "guide.dwork_drho")["verdict"] == "exact"
