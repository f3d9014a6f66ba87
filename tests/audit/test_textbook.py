"""The shipped theories against what textbooks print in closed form: every theory is asked, and is what they say."""

import tomllib
from pathlib import Path

import pytest

from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.theory.catalogue import shipped, theory

FORMULAS = tomllib.loads((Path(__file__).parent / "textbook.toml").read_text())["formula"]
# Schmidt's own letters: phase of the pressure, and its swing
SCHMIDT = {
    "a": "atan((V_SC/V_SE)*sin(dx)/(t + (V_SC/V_SE)*cos(dx)))",
    "c": "sqrt(t**2 + 2*t*(V_SC/V_SE)*cos(dx) + (V_SC/V_SE)**2)"
    "/(t + 2*t*V_DE/V_SE + 4*t*V_R/V_SE/(1 + t) + V_SC/V_SE + 2*V_DC/V_SE)",
}


def test_anyone_finds_a_quantity():
    assert sum(len(theory(name).results) for name in shipped()) >= 150
    assert {f["against"].partition(".")[0] for f in FORMULAS} == set(shipped())
    assert all("\nsource = " in text for text in shipped().values())


@pytest.mark.slow
@pytest.mark.parametrize("formula", FORMULAS, ids=lambda f: f["against"])
def test_what_textbooks_print_is_right(formula):
    letters, assume = SCHMIDT if "schmidt" in formula else "", formula.get("assume", "")
    row = check_formula(formula["text"], formula["against"], letters=letters, assume=assume)
    assert row["verdict"] == formula["verdict"], row["note"]
