"""Formulas nobody here has seen, made at random: right ones are proved, spoiled ones come back."""

import ast
import random

from hypothesis import assume, given, settings
from hypothesis import strategies as st

from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.judge.prover import is_exact
from mechsym.audit.judge.question import Question
from mechsym.audit.read import tree as trees
from mechsym.audit.read.reader import read
from mechsym.audit.read.spelling import to_latex, to_python
from mechsym.audit.repair.edits import apply, places
from mechsym.audit.repair.examination import examine, fingerprint, standing
from mechsym.audit.repair.rules import Words, listed_edits
from mechsym.audit.repair.search import search
from mechsym.audit.row import formula_row
from mechsym.audit.theory.record import Letter, Theory, known
from mechsym.audit.verdict import decide

LETTERS = {
    "r": Letter(unit="m", value=0.4), "l": Letter(unit="m", value=1.4), "m": Letter(unit="kg", value=3.0),
    "omega": Letter(unit="rad/s", value=12.0), "phi": Letter(unit="rad", value=1.0), "F": Letter(unit="N", value=700.0),
}  # fmt: skip
# what printed formulas are made of
FACTORS = ("r", "l", "m", "omega", "F", "r**2", "omega**2", "sin(phi)", "cos(phi)", "sin(2*phi)", "cos(2*phi)")
ROOTS = ("sqrt(l**2 - r**2*sin(phi)**2)", "sqrt(1 + r/l*cos(phi))", "(l + r*cos(phi))", "(1 - r/l*cos(2*phi))")


@st.composite
def terms(draw):
    above = draw(st.lists(st.sampled_from(FACTORS), min_size=1, max_size=3, unique=True))
    below = draw(st.lists(st.sampled_from(ROOTS), max_size=1))
    number = draw(st.sampled_from(["", "2*", "1/2*", "3/4*"]))
    return number + "*".join(above) + "".join(f"/{d}" for d in below)


@st.composite
def formulas(draw):
    chosen = draw(st.lists(terms(), min_size=1, max_size=3, unique=True))
    signs = draw(st.lists(st.sampled_from([" + ", " - "]), min_size=2, max_size=2))
    return chosen[0] + "".join(sign + term for sign, term in zip(signs, chosen[1:], strict=False))


def question(text, derived):
    names = [*LETTERS, "pi"]
    right = read(derived, names).tree
    theory = Theory(name="random", letters=LETTERS, tape={"q": right}, results=("q",), angle="phi")
    return Question(formula=read(text, known(theory)), theory=theory, quantity="q")


@settings(deadline=None, derandomize=True, max_examples=15)
@given(formulas())
def test_right_formulas_are_proved_in_either_syntax(text):
    tree = read(text, [*LETTERS, "pi"]).tree
    for form in (text, f"${to_latex(tree, {})}$"):
        verdict = decide(question(form, text))
        assert verdict.verdict == "exact" and verdict.certificate == "polynomial", form


WRONG = {"sign", "factor", "power", "root", "sine and cosine"}  # a wrong sign, a lost square, a wrong factor ...


@settings(deadline=None, derandomize=True, max_examples=25)
@given(formulas(), st.integers(0, 10**6))
def test_wrong_signs_squares_and_factors_are_repaired(text, seed):
    asked = question(text, text)
    exam, right = examine(asked), asked.formula.tree
    edits = [e for e in listed_edits(right, Words()) if e.kind in WRONG]
    spoiled = apply(right, random.Random(seed).choice(edits))
    assume(fingerprint(exam, spoiled) != fingerprint(exam, right))
    assume(not is_exact(exam.judged, spoiled))
    answer = search(exam, standing(exam, spoiled))
    assert answer.repairs, to_python(spoiled)
    repaired = answer.repairs[0]
    assert repaired.exact and fingerprint(exam, repaired.tree) == fingerprint(exam, right)


@settings(deadline=None, derandomize=True, max_examples=15)
@given(formulas(), st.integers(0, 10**6))
def test_a_lost_factor_is_put_back(text, seed):
    asked = question(text, text)
    exam, right = examine(asked), asked.formula.tree
    products = [p for p in places(right) if trees.is_operation(p.node, ast.Mult)]
    assume(products)
    place = random.Random(seed).choice(products)
    lost = trees.replace(right, place.path, place.node.left)
    assume(fingerprint(exam, lost) != fingerprint(exam, right))
    answer = search(exam, standing(exam, lost))
    if answer.repairs:  # a formula with little left of it is wrong, not misprinted
        assert answer.repairs[0].exact
    else:
        assert not answer.mixed and answer.nearer is None


def test_the_correction_is_printed_in_the_authors_form():
    asked = question(r"\frac{m r \omega \sin\varphi}{2}", "m*r*omega**2*sin(phi)/2")
    row = formula_row(asked, decide(asked), "", "", "")
    assert row["correction"] == r"\frac{m r \omega^{2} \sin \varphi}{2}"
    asked = question("m*r*omega*sin(phi)/2", "m*r*omega**2*sin(phi)/2")
    assert formula_row(asked, decide(asked), "", "", "")["correction"] == "m*r*omega**2*sin(phi)/2"


def test_a_condition_is_no_part_to_repair():
    row = check_formula("piecewise(F < 1, F, F)", "scotch_yoke.torque")
    assert row["verdict"] in ("wrong", "nearer")
