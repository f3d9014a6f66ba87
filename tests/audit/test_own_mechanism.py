"""Formulas against a mechanism from a file: all names of its declaration are quantities."""

import re

import pytest

from mechsym.audit.hosts.formula import check_file, check_formula
from mechsym.audit.hosts.program import check_code
from mechsym.audit.judge.asked import Asked
from mechsym.audit.repair import pairs
from mechsym.errors import BadInput

SLIDER = """from mechsym.derive import Mechanism


def slider():
    m = Mechanism("slider")
    phi = m.coordinates("phi")
    r, l = m.parameters("r l", "m", above=0)
    m_p = m.parameters("m_p", "kg", low=0)
    I = m.parameters("I", "kg*m^2", above=0)
    F = m.inputs("F", "N")
    crank = m.link("crank", turns=phi, inertia=I)
    rod, piston = m.link("rod"), m.link("piston", mass=m_p)
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(r), rod)
    m.slider("G", m.frame, piston)
    m.pin("B", rod.at(l), piston)
    x = m.let("x", r + l - piston.at().x, "m")
    m.let("psi", rod.angle, "rad")
    m.force(F, along=x)
    m.piston("p", travel=x, force=F)
    return m
"""
CASE = """mechanism = "./slider.py"
[parameters]
r = 0.04
l = 0.15
m_p = 0.5
I = 0.05
[operation]
speed = "3000 rpm"
"""
SLOPE = "r*sin(phi) + r*cos(phi)*r*sin(phi)/sqrt(l**2 - r**2*sin(phi)**2)"


@pytest.fixture
def folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "slider.py").write_text(SLIDER)
    (tmp_path / "slider.toml").write_text(CASE)
    return tmp_path


def test_formulas_of_the_textbooks(folder):
    row = check_formula(SLOPE, "./slider.py:dx_dphi")
    assert row["verdict"] == "exact" and row["max_rel_error"] < 1e-12
    assert row["evidence"]["data"].endswith("slider.toml")  # the case beside the file
    assert (
        check_formula(f"I + m_p*({SLOPE})**2", "./slider.py:slider.inertia", case="slider.toml")["verdict"] == "exact"
    )
    series = check_formula("r*(1 - cos(phi)) + r**2/(2*l)*sin(phi)**2", "./slider.py:x")
    lam = 0.04 / 0.15
    assert series["verdict"] == "truncation" and series["order"] == 3
    assert lam**3 / 16 / 2 < series["max_rel_error"] < lam**3


def test_angles_of_links_and_names_that_nothing_is_put_out_of(folder):
    for quantity in ("angle_rod", "psi"):
        row = check_formula("-asin(r*sin(phi)/l)", f"./slider.py:{quantity}")
        assert row["verdict"] == "exact" and row["max_rel_error"] < 1e-12
    with pytest.raises(BadInput, match="has no quantity 'angle_conrod'; it has .*angle_rod"):
        check_formula("phi", "./slider.py:angle_conrod")


@pytest.mark.slow
def test_the_search_for_two_slips_ends_and_says_so(folder, monkeypatch):
    formula = "r*cos(phi) + l*sin(phi)**2 - 2*r/l + phi*r"
    monkeypatch.setattr(pairs, "MAX_WORK", 0)
    row = check_formula(formula, "./slider.py:x")
    assert row["verdict"] == "wrong" and re.search(r"only the first 0 of \d+ were tried", row["note"])


def test_a_slip_is_found_and_repaired(folder):
    row = check_formula("r*(1 - cos(phi)) + l*(1 - sqrt(1 - r**2/l**2*sin(phi)))", "./slider.py:x")
    assert row["verdict"] == "misprint" and "sin(phi)**2" in row["correction"]


def test_code_and_files_take_it_too(folder):
    (folder / "mine.py").write_text(f"from math import cos, sin, sqrt\n\n\ndef slope(r, l, phi):\n    return {SLOPE}\n")
    (row,) = check_code("mine.py::slope", "./slider.py:dx_dphi", Asked(text="", against=""))
    assert row["verdict"] == "exact"
    (folder / "mine.toml").write_text(f'[[formula]]\nname = "v"\ntext = "{SLOPE}"\nagainst = "./slider.py:dx_dphi"\n')
    assert check_file(folder / "mine.toml", "")[0]["verdict"] == "exact"


@pytest.mark.parametrize(
    ("against", "case", "message"),
    [
        ("./slider.py:nothing", "", "slider has no quantity 'nothing'; it has .*dx_dphi"),
        ("./other.py:x", "", "there is no file other.py"),
        ("./slider.py:rocker.x", "", "declares no mechanism 'rocker'"),
        ("./slider.py:inertia", "zotov-89", "is of the mechanism crosshead, not of ./slider.py"),
        ("./slider.py", "", "is not THEORY.QUANTITY.* nor ./FILE.py:QUANTITY"),
    ],
)
def test_what_is_not_there_is_refused_in_one_line(folder, against, case, message):
    with pytest.raises(BadInput, match=message) as refused:
        check_formula("a", against, case=case)
    assert "\n" not in str(refused.value)
