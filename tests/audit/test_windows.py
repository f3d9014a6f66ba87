"""Traps of size, domain, window, branch and unit: none is passed, and their right twins are."""

import pytest

from benchmarks.auditor import windows
from mechsym.audit.hosts.formula import check_formula


@pytest.mark.slow
@pytest.mark.heavy
def test_no_trap_is_passed_and_every_twin_is():
    assert sum(not fine for *_, fine in windows.asked()) == 300
    assert not windows.missed()


@pytest.mark.parametrize("text", ["woschni*abs(T - T_w)", "woschni*max(T - T_w, 0)", "woschni*sqrt((T - T_w)**2)"])
def test_a_branch_that_the_data_do_not_reach_is_no_proof(text):
    row = check_formula(text, "heat_transfer.flux_woschni")
    assert row["verdict"] == "untestable" and "assume" in row["note"]
    assert check_formula(text, "heat_transfer.flux_woschni", assume="T > T_w")["verdict"] == "exact"


def test_a_branch_of_an_inverse_function_is_an_assumption_that_is_printed():
    row = check_formula("asin(r*sin(phi)/reach)", "slotted_link.theta")
    assert row["verdict"] == "exact" and "d0 + r*cos(phi) > 0" in row["evidence"]["domain"]


def test_what_is_sampled_is_what_is_printed():
    row = check_formula("2*stroke*omega/(2*pi)", "piston_speed.mean_piston_speed")
    assert "from 1/1000 to 1000 of the data" in row["evidence"]["domain"]
    row = check_formula("a*alphad*sin(beta - alpha)/(c*sin(beta - gamma))", "four_bar.rocker_speed")
    assert "from 0.7 to 1.4 of the data" in row["evidence"]["domain"]
