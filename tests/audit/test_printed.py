"""Formulas as a page prints them: products without a sign, letters told beside them, laws, doubtful slashes."""

import tomllib
from pathlib import Path

import pytest

from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.read.reader import read
from mechsym.audit.read.spelling import to_python
from mechsym.audit.read.statement import statement
from mechsym.errors import BadInput

KNOWN = "r l lam phi phid m p_0 p_i I_1 I_2 k T_s E_star theta_2 a d pi dV_dphi".split()
FORMULAS = tomllib.loads((Path(__file__).parent / "printed.toml").read_text())["formula"]

READ = [
    ("2r", "2*r"),
    ("r l", "r*l"),
    ("(r) l", "r*l"),
    ("[r]", "r"),
    ("r(1 − cosφ)", "r*(1 - cos(phi))"),
    ("r*2(1-cos(phi))", "r*2*(1 - cos(phi))"),
    ("½ m r²", "1/2*m*r**2"),
    ("2ad cos θ2", "2*a*d*cos(theta_2)"),
    ("√(k(I₁+I₂)/(I₁I₂))", "sqrt(k*(I_1 + I_2)/(I_1*I_2))"),
    ("r φ̇² sin²φ", "r*phid**2*sin(phi)**2"),
    ("λ/4 cos 2φ", "lam/4*cos(2*phi)"),
    ("0,5 r", "0.5*r"),
    ("3.2e-3 r", "3.2*10**(-3)*r"),
    ("p_i r + π", "p_i*r + pi"),
    ("m e^(−λ φ)", "m*exp(-lam*phi)"),
    ("r/(l E*)", "r/(l*E_star)"),
    ("cos 2(φ + λ)", "cos(2*(phi + lam))"),
    (r"\cos 2(\varphi + \lambda)", "cos(2*(phi + lam))"),
    (r"\frac{p_i}{\pi} r", "p_i/pi*r"),
    ("p_0 dV/dφ", "p_0*dV_dphi"),
    ("1/2 π r", "1/2*pi*r"),
]


@pytest.mark.parametrize(("text", "meaning"), READ, ids=[t for t, _ in READ])
def test_reads_what_a_page_prints(text, meaning):
    assert to_python(read(text, KNOWN).tree) == meaning


@pytest.mark.parametrize("text", ["p_i*r", r"p_i r", r"p_{i} r", "p_i r"])
def test_an_inner_pressure_is_not_the_constant(text):
    with pytest.raises(BadInput, match="unknown letter 'p_i'"):
        read(text, ["r", "pi"])


def test_a_length_with_an_index_is_no_logarithm():
    assert to_python(read(r"r + l_{n}", ["r"], {"l_{n}": "2*r"}).tree) == "r + l_n"


@pytest.mark.parametrize(
    ("text", "doubt"),
    [("16T_s/πd³", "divisor"), (r"r_1/g m_{2}", "divisor"), ("sin φ r", "argument")],
)
def test_a_doubt_is_asked_about(text, doubt):
    with pytest.raises(BadInput, match=doubt):
        read(text, [*KNOWN, "r_1", "g", "m_2"])


def test_a_doubt_is_settled_by_what_is_right_and_said():
    row = check_formula("16T/πd³", "strength.shear")
    assert row["verdict"] == "exact" and "read as 16*T/(pi*d**3)" in row["note"]
    row = check_formula("15T/πd³", "strength.shear")
    assert row["verdict"] in ("misprint", "wrong") and "it is not right in any way" in row["note"]
    row = check_formula("σe = √(σ² + 3τ²), σ = 32M/πd³, τ = 16T/πd³", "strength.equivalent")
    assert row["verdict"] == "exact"


@pytest.mark.parametrize(("text", "against"), [("dβ/dφ = λ cos φ/cos β", "beta"), ("ẋ = r φ̇ sin(φ + β)/cos β", "x")])
def test_a_derivative_is_not_compared_with_its_quantity(text, against):
    with pytest.raises(BadInput, match=f"a derivative of {against}"):
        check_formula(text, f"slider_crank.{against}", "λ=r/l")


def test_the_authors_name_may_be_a_datum_that_the_formula_does_not_read():
    row = check_formula("F = m r ω² (cos θ + cos 2θ/n)", "slider_forces.inertia_force", "ω=phid, θ=phi, n=l/r")
    assert row["verdict"] == "exact"
    with pytest.raises(BadInput, match="cannot be redefined"):
        check_formula("F = 2 F", "slider_forces.inertia_force")


def _marked(number, formula):
    # each third in the fast suite
    return pytest.param(formula, id=formula["text"], marks=[pytest.mark.slow, pytest.mark.heavy] if number % 3 else [])


@pytest.mark.parametrize("formula", [_marked(i, f) for i, f in enumerate(FORMULAS)])
def test_a_printed_formula_has_its_verdict(formula):
    asked = {k: formula[k] for k in ("text", "against", "letters") if k in formula}
    assert check_formula(**asked)["verdict"] == formula["verdict"]


def test_letters_are_told_beside_a_formula():
    text = "C = D/d; τ = 8 K F D/(π d³), K = (4C − 1)/(4C − 4) + 0,615/C"
    said = statement(text, "stress")
    assert said.left == "τ" and set(said.letters) == {"C", "K"}
    assert check_formula(text, "helical_spring.stress")["verdict"] == "exact"
    wrong = check_formula(text.replace("0,615", "0,651"), "helical_spring.stress")
    assert wrong["verdict"] != "exact"


def test_letters_that_come_back_to_themselves_are_refused():
    with pytest.raises(BadInput, match="comes back"):
        read("u*r", ["r"], {"u": "2*w", "w": "u/2"})


def test_a_letter_in_another_unit_is_said():
    row = check_formula("3.26 B^(−0.2) p^0.8 T^(−0.55) w^0.8", "heat_transfer.woschni")
    assert row["verdict"] == "untestable" and "p as a number of kPa" in row["note"]


def test_a_datum_may_be_renamed_and_not_become_another():
    assert check_formula("φ = M L/(G Ip)", "strength.twist", "M=T, Ip=J")["verdict"] == "exact"
    with pytest.raises(BadInput, match="write another letter"):
        check_formula("φ = M T L/(G Ip)", "strength.twist", "M=T, Ip=J")


def test_what_is_zero_is_a_law():
    law = r"n_s + \frac{z_r}{z_s} n_r - \left(1+\frac{z_r}{z_s}\right) n_c = 0"
    letters = "n_s=w_s, n_r=w_r, n_c=w_c"
    assert check_formula(law, "epicyclic.w_r", letters)["verdict"] == "exact"
    assert check_formula(law.replace("1+", "2+"), "epicyclic.w_r", letters)["verdict"] != "exact"
    with pytest.raises(BadInput, match="right side is 0"):
        statement("n_s = 0")


@pytest.mark.parametrize("text", ["x = x", "x − x = 0", "x = r/2 - 0.5 r + x", "x = A, A = x", "2 x = x + x"])
def test_what_holds_of_anything_is_refused(text):
    with pytest.raises(BadInput, match="whatever it is"):
        check_formula(text, "slider_crank.x")


def test_fields_of_records_are_letters_and_points_between_letters_times():
    assert check_formula("F = m.r.ω².cos φ", "slider_forces.primary_force", "ω=phid")["verdict"] == "exact"
    assert check_formula("self.R*np.sin(c.th)", "scotch_yoke.dx_dphi", "R=r, c.th=phi")["verdict"] == "exact"


def test_an_argument_without_brackets_is_read_as_it_is_right():
    row = check_formula("s = h(θ/β − sin 2πθ/β / 2π)", "cam_motion.cycloidal")
    assert row["verdict"] == "exact" and "sin(2*pi*theta/beta)" in row["understood"]


def test_a_ratio_of_strange_letters_is_a_name():
    text = "Sp/S̄p = (π/2) sin θ [1 + cos θ/√(R² − sin²θ)]"
    assert check_formula(text, "cylinder_volume.speed_ratio", "R=l/r, θ=phi")["verdict"] == "exact"
