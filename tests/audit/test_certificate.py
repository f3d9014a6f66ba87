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


@needs_coq
@pytest.mark.slow
def test_coq_accepts_what_is_right_and_refuses_a_wrong_sign(tmp_path):
    script = text(ACCELERATION, "slider_crank.d2x_dphi2")
    done = checked(tmp_path, script)
    assert done.returncode == 0, done.stderr
    assert "sin2_cos2" in script and "sqrt" in script
    assert script.count("((cos_phi_ * r_) + ") >= 2
    assert checked(tmp_path, script.replace("((cos_phi_ * r_) + ", "((cos_phi_ * r_) - ", 1)).returncode != 0
    assert checked(tmp_path, text("r*sin(phi + beta)/cos(beta)", "slider_crank.dx_dphi")).returncode == 0


@needs_coq
@pytest.mark.slow
def test_coq_accepts_those_of_a_source(tmp_path):
    found = sources("moroianu2017") + sources("prymak")
    script, without = certificate_of_sources(found, rows(found))
    assert script.count("Theorem") >= 10 and not without
    done = checked(tmp_path, script)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("formula", ["r*sin(phi)", "r*cos(phi) - r*cos(phi)"])
def test_what_is_not_proved_has_no_script(formula):
    with pytest.raises(BadInput, match="has a Coq script"):
        text(formula, "slider_crank.dx_dphi")
