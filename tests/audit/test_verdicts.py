"""Verdicts that can be trusted: domains of both signs, pure truncations, conditions, claims, laws, traps."""

import ast
import inspect

import pytest

from benchmarks.auditor import spoiler
from benchmarks.auditor.matrix import trapped
from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.judge.question import peak
from mechsym.errors import BadInput

ACCELERATION = "r*omega**2*(cos(phi) + lam*cos(2*phi))"
MORE = {"letters": "omega=phid"}


@pytest.mark.parametrize(
    ("text", "against"),
    [
        ("abs(F)*dx_dphi", "crosshead.gas_torque"),
        ("sqrt(F**2)*dx_dphi", "crosshead.gas_torque"),
        ("dx_dphi*abs(phid)", "slider_crank.x_d"),
    ],
)
def test_one_sign_is_not_exact(text, against):
    assert check_formula(text, against)["verdict"] not in ("exact", "truncation", "convention")


def test_a_size_for_a_signed_force_is_repaired_and_the_zero_error_explained():
    row = check_formula("abs(F)*dx_dphi", "crosshead.gas_torque")
    assert row["verdict"] == "misprint" and row["correction"] == "F*dx_dphi"
    assert row["max_rel_error"] == 0 and "at the case's own data it agrees" in row["note"]


@pytest.mark.parametrize("end", ["", "/sqrt(1 - lam**2*sin(phi*pi/180)**2)"])
def test_degrees_in_all_places_are_a_slip_or_a_convention(end):
    text = f"r*sin(phi*pi/180) + r*lam/2*sin(2*phi*pi/180){end}"
    row = check_formula(text, "slider_crank.dx_dphi")
    # of what is no more than a truncation the slip is told
    assert row["verdict"] == ("untestable" if end else "misprint") and ("phi as degrees" in row["note"]) == bool(end)
    assert row["correction"] == text.replace("phi*pi/180", "phi")


def test_no_trap_is_called_exact():
    found = list(trapped())
    assert len(found) >= 200 and set(found) == {"not exact"}


def test_an_error_beyond_bounds_is_not_passed():
    row = check_formula("F*sin(phi)*r*(1+100*lam**2)", "slider_crank.torque", "F=total_force")
    assert row["verdict"] in ("misprint", "nearer", "mixed", "wrong") and row["max_rel_error"] > 15


def test_constant_speed_is_named():
    row = check_formula(ACCELERATION, "slider_crank.piston_acceleration", **MORE)
    assert row["verdict"] == "convention" and "constant speed (phidd = 0)" in row["note"]
    row = check_formula(ACCELERATION, "slider_crank.piston_acceleration", **MORE, assume="phidd = 0")
    assert row["verdict"] == "truncation" and row["order"] == 3


@pytest.mark.parametrize(
    ("claim", "kept"), [("lam^2", True), ("lam^3", False), ("approx", True), ("=", False), ("within 2 %", True)]
)
def test_claims(claim, kept):
    row = check_formula("r*sin(phi) + r*lam/2*sin(2*phi)", "slider_crank.dx_dphi", claim=claim)
    assert row["claim_kept"] is kept and claim in row["note"]


def test_a_law_is_compared_side_with_side():
    assert check_formula(r"l\sin\beta = r\sin\varphi", "slider_crank.beta")["verdict"] == "exact"
    assert check_formula(r"l\sin\beta = r\cos\varphi", "slider_crank.beta")["verdict"] == "misprint"


def test_a_sign_slip_of_the_rod_says_which_convention_would_hide_it():
    row = check_formula("r*sin(phi) - r*lam*sin(phi)*cos(phi)/cos(beta)", "slider_crank.dx_dphi")
    assert row["verdict"] == "misprint" and "bottom dead centre" in row["note"]
    row = check_formula(row["printed"], "slider_crank.dx_dphi", convention="bottom, sign")
    assert row["verdict"] == "convention"


def test_a_relation_ties_a_letter():
    row = check_formula(
        "V_displacement/(CR - 1) + 2*A_piston*x",
        "opposed_slider_crank.chamber_volume",
        assume="V_c = V_displacement/(CR - 1)",
    )
    assert row["verdict"] == "exact"


@pytest.mark.parametrize(
    ("more", "reason"),
    [
        ({"letters": "pi=3"}, "has its meaning already"),
        ({"letters": "sin=r"}, "has its meaning already"),
        ({"letters": "l=r"}, "l is a letter of slider_crank already; write another letter"),
        ({"assume": "nothing"}, "is no relation"),
        ({"assume": "x = 0"}, "must be one free letter"),
        ({"claim": "nearly"}, "within 1 %"),
        ({"convention": "upwards"}, "is not known"),
    ],
)
def test_bad_words_are_refused_with_the_way_out(more, reason):
    with pytest.raises(BadInput, match=reason):
        check_formula("r", "slider_crank.x", **more)


@pytest.mark.parametrize(
    ("text", "letters", "told"),
    [
        ("r=2", "", "'r = ..': r is a letter of slider_crank already and cannot be redefined; write 'x = ..'"),
        (r"\varphi = 2", "", "phi is a letter of slider_crank already"),
        ("sin = 2", "", "sin is a constant or a function already"),
        ("pi = 3", "", "pi is a constant or a function already"),
        ("R = 2", "R=r", "R is r already, by --letters"),
    ],
)
def test_a_left_side_redefines_nothing(text, letters, told):
    with pytest.raises(BadInput) as refused:
        check_formula(text, "slider_crank.x", letters)
    assert told in str(refused.value)


@pytest.mark.parametrize(
    ("left", "letters"), [("x", ""), ("s", "s=x"), ("s", ""), ("2*x/2", ""), ("S", "S=2*x/2"), (r"\xi", "")]
)
def test_a_left_side_may_name_the_quantity_or_be_a_law(left, letters):
    text = f"{left} = r*(1 - cos(phi)) + l*(1 - cos(beta))"
    assert check_formula(text, "slider_crank.x", letters)["verdict"] == "exact"


def test_a_derived_name_may_be_told_again_in_data():
    row = check_formula("r*(1-cos(phi))+r**2/(4*l)*(1-cos(2*phi))", "crosshead.x", letters="r=r1+r2,l=l1+l2")
    assert row["verdict"] == "truncation"


def test_the_spoiler_shares_no_code_with_the_repair_search():
    tree = ast.parse(inspect.getsource(spoiler))
    modules = {n.module for n in ast.walk(tree) if isinstance(n, ast.ImportFrom)}
    names = {a.name for n in ast.walk(tree) if isinstance(n, ast.Import) for a in n.names}
    assert not {m for m in modules | names if m and m.startswith("mechsym")}


def test_a_letter_that_stands_for_itself_changes_nothing():
    assert check_formula("r*sin(phi)", "scotch_yoke.dx_dphi", letters="x=x,r=r")["verdict"] == "exact"


def test_the_peak_of_nothing_is_zero_without_a_warning():
    assert peak([float("nan")] * 2) == 0 and peak([float("nan"), -3.0]) == 3


def test_a_term_that_has_lost_what_constant_speed_makes_zero_gets_it_back():
    # at constant speed alone it would be a term too many
    text = "sin(phi + beta)/cos(beta) + phid**2*r*(cos(phi + beta)/cos(beta) + lam*cos(phi)**2/cos(beta)**3)"
    row = check_formula(text, "slider_crank.piston_acceleration")
    assert row["verdict"] == "misprint" and "phidd" in row["correction"]
    assert check_formula(row["correction"], "slider_crank.piston_acceleration")["verdict"] == "exact"
