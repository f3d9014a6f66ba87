"""Coq scripts of exact verdicts: accepted by coqc, refused with a wrong sign; no script without a proof."""

import shutil
import subprocess

import pytest

from mechsym.audit.hosts.sources import certificate_of_formula, certificate_of_sources, rows
from mechsym.audit.judge.asked import Asked
from mechsym.audit.row import answer
from mechsym.errors import BadInput
from mechsym.papers import sources

needs_coq = pytest.mark.skipif(shutil.which("coqc") is None, reason="coqc is missing; on Debian: apt-get install coq")
ROOT = "sqrt(l**2 - r**2*sin(phi)**2)"
ACCELERATION = f"r*cos(phi) + r**2*cos(2*phi)/{ROOT} + r**4*sin(2*phi)**2/(4*{ROOT}**3)"


def text(formula, against):
    asked = Asked(text=formula, against=against)
    return certificate_of_formula(asked, answer(asked))


def checked(path, script):
    (path / "c.v").write_text(script)
    return subprocess.run(["coqc", "c.v"], cwd=path, capture_output=True, text=True, timeout=120)


SPELLED = "((r_ * (sin (phi_ + the_beta))) / (cos the_beta)) = the_dx_dphi"
# of the statement of the theorem: of what is printed, and of what is declared
MUTANTS = [
    ("(phi_ + the_beta)", "(phi_ - the_beta)"),
    ("(r_ * (sin (phi_ + the_beta)))", "(l_ * (sin (phi_ + the_beta)))"),
    ("/ (cos the_beta)) =", "* (cos the_beta)) ="),
    ("(sin (phi_ + the_beta))", "(cos (phi_ + the_beta))"),
    ("= the_dx_dphi", "= the_dbeta_dphi"),
    ("let the_lam := (r_ * (1 / l_))", "let the_lam := (r_ * l_)"),
    ("let the_sin_phi := (sin phi_)", "let the_sin_phi := (cos phi_)"),
    ("let the_beta := (asin the_sin_beta)", "let the_beta := (asin the_lam)"),
    ("let the_dx_dphi := ((r_ * the_sin_phi) -", "let the_dx_dphi := ((r_ * the_sin_phi) +"),
    ("(1 / the_cos_beta)", "(1 * the_cos_beta)"),
]


@needs_coq
@pytest.mark.slow
def test_coq_accepts_what_is_printed_and_refuses_mutants(tmp_path):
    script = text("r*sin(phi + beta)/cos(beta)", "slider_crank.dx_dphi")
    done = checked(tmp_path, script)
    assert done.returncode == 0, done.stderr
    assert SPELLED in script and "let the_beta := (asin the_sin_beta)" in script
    theorem = script.index("Theorem")
    for right, wrong in MUTANTS:
        assert right in script[theorem:]
        mutant = script[:theorem] + script[theorem:].replace(right, wrong, 1)
        assert checked(tmp_path, mutant).returncode != 0, wrong


@needs_coq
@pytest.mark.slow
def test_coq_accepts_a_longer_one(tmp_path):
    done = checked(tmp_path, text(ACCELERATION, "slider_crank.d2x_dphi2"))
    assert done.returncode == 0, done.stderr


def test_no_theorem_says_that_a_formula_is_itself():
    script = text("r*sin(phi + beta)/cos(beta)", "slider_crank.dx_dphi")
    left, _, right = SPELLED.partition(" = ")
    assert SPELLED in script and left != right


@needs_coq
@pytest.mark.slow
def test_coq_accepts_those_of_a_source(tmp_path):
    found = sources("moroianu2017") + sources("prymak")
    script, without = certificate_of_sources(found, rows(found))
    assert script.count("Theorem") >= 15 and len(without) == 1  # a quotient of two sums
    done = checked(tmp_path, script)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("formula", ["r*sin(phi)", "r*cos(phi) - r*cos(phi)"])
def test_what_is_not_proved_has_no_script(formula):
    with pytest.raises(BadInput, match="has a Coq script"):
        text(formula, "slider_crank.dx_dphi")
