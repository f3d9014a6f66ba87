"""Coq scripts of exact verdicts: accepted by coqc, refused with a wrong sign; no script without a proof."""

import math
import random
import re
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
@pytest.mark.heavy
def test_coq_accepts_those_of_a_source(tmp_path):
    found = sources("moroianu2017") + sources("prymak")
    script, without = certificate_of_sources(found, rows(found))
    assert script.count("Theorem") >= 15 and len(without) == 1  # a quotient of two sums
    done = checked(tmp_path, script)
    assert done.returncode == 0, done.stderr


def value(text, letters):
    """Value of a Coq expression of plain arithmetic."""
    spelled = re.sub(r"\b(sin|cos|tan|sqrt|asin) (\w+)", r"\1(\2)", text.replace("^", "**"))
    return eval(
        spelled, {"PI": math.pi, **{k: getattr(math, k) for k in ("sin", "cos", "tan", "sqrt", "asin")}, **letters}
    )


def sides(statement, generator):
    """Both sides of a theorem at random letters; None where they have no value."""
    letters = {k: generator.uniform(0.3, 1.5) for k in re.findall(r"\b\w+_\b", statement)}
    try:
        for named, text in re.findall(r"let (\w+) := (.*) in\n", statement):
            letters[named] = value(text, letters)
        return [value(side, letters) for side in statement.rstrip(". \n").splitlines()[-1].split(" = ")]
    except (ValueError, ZeroDivisionError, OverflowError):
        return None


def is_wrong(statement):
    """Whether a theorem is false at some state, by numbers."""
    generator = random.Random(3)
    pairs = [pair for _ in range(40) if (pair := sides(statement, generator))]
    return any(abs(a - b) > 1e-6 * (abs(a) + abs(b)) for a, b in pairs)


OTHER = {"+": "-", "-": "+", "*": "+", "sin": "cos", "cos": "sin", "2": "3"}


def mutants(statement, generator):
    """Wrong statements that differ in one sign, operation, function or number, or in one letter."""
    begin = statement.find("  let ") if "  let " in statement else statement.rindex("\n", 0, -2)
    letters = sorted(set(re.findall(r"\b\w+_\b", statement)))
    spots = [m for m in re.finditer(r" [-+*] |\b(?:sin|cos) |\b2\b|\b\w+_\b", statement) if m.start() > begin]
    for spot in generator.sample(spots, len(spots)):
        old = spot[0].strip()
        new = OTHER.get(old) or generator.choice([k for k in letters if k != old] or [old])
        mutant = statement[: spot.start()] + spot[0].replace(old, new) + statement[spot.end() :]
        if ":=" not in mutant[spot.start() - 30 : spot.start()] + spot[0] and is_wrong(mutant):
            yield mutant


@needs_coq
@pytest.mark.slow
@pytest.mark.heavy
def test_coq_refuses_a_hundred_mutants(tmp_path):
    found = sources("moroianu2017") + sources("zotov2024") + sources("chmielewski2015")
    script, _ = certificate_of_sources(found, rows(found))
    generator, parts, asked, right = random.Random(7), [], 0, 0
    for piece in re.split(r"(?=^\(\* )", script, flags=re.M):
        statement, _, proof = piece[piece.find("Theorem") :].partition("Proof.")
        if "Theorem" not in piece or re.search(r"Rpower|\(/ ", statement):
            parts.append(piece if "Theorem" not in piece else "")
            continue
        named = statement.split()[1]
        parts.append(f"{piece}\nCheck {named}.\n")
        right += 1
        wanted = [m for m, _ in zip(mutants(statement, generator), range(5), strict=False)]
        for mutant in wanted:
            asked += 1
            wrong = re.sub(r"Theorem \w+", f"Theorem mutant{asked}", mutant)
            parts.append(f"{wrong}Proof.{proof}\nAbort All.\nCheck mutant{asked}.\n")
    assert asked >= 100
    run = ["coqtop", "-q", "-color", "no"]
    done = subprocess.run(run, input="\n".join(parts), cwd=tmp_path, capture_output=True, text=True, timeout=1200)
    accepted = re.findall(r"^(?:Coq < )*(\w+)\n +:", done.stdout, flags=re.M)
    assert len(accepted) == right, done.stdout[-500:]
    assert not [k for k in accepted if k.startswith("mutant")]


@pytest.mark.parametrize("formula", ["r*sin(phi)", "r*cos(phi) - r*cos(phi)"])
def test_what_is_not_proved_has_no_script(formula):
    with pytest.raises(BadInput, match="has a Coq script"):
        text(formula, "slider_crank.dx_dphi")
