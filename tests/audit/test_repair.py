"""The repair search finds the way back by itself; honest approximations are left alone."""

import pytest

from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.judge.question import max_rel_error, turn
from mechsym.audit.row import formula_row
from mechsym.audit.verdict import decide

REPAIRED = [
    ("r*sin(phi - psi)/cos(psi)", "dx_dphi", "r*sin(phi + psi)/cos(psi)", "sign"),
    ("3*r*sin(phi + psi)/cos(psi)", "dx_dphi", "r*sin(phi + psi)/cos(psi)", "factor"),
    ("r*sin(phi + psi)*cos(psi)", "dx_dphi", "r*sin(phi + psi)/cos(psi)", "inverted"),
    ("r*sin(phi + psi)", "dx_dphi", "r*sin(phi + psi)/cos(psi)", "put back"),
    ("r*cos(phi + psi)/cos(psi)", "dx_dphi", "r*sin(phi + psi)/cos(psi)", "sine and cosine"),
    ("r1*sin(phi + psi)/cos(psi)", "dx_dphi", "r*sin(phi + psi)/cos(psi)", "letter"),
    ("lam*cos(phi)/(1 - lam**2*sin(phi)**2)", "dpsi_dphi", "lam*cos(phi)/sqrt(1 - lam**2*sin(phi)**2)", "root"),
    ("lam*cos(phi)/sqrt(1 - lam*sin(phi)**2)", "dpsi_dphi", "lam*cos(phi)/sqrt(1 - lam**2*sin(phi)**2)", "power"),
    ("1/2*inertia*phid", "kinetic_energy", "1/2*inertia*phid**2", "power"),
    ("r*(1 - cos(phi)) + l*1 - cos(psi)", "x", "r*(1 - cos(phi)) + l*(1 - cos(psi))", "bracket"),
    ("l*(1 - cos(psi))", "x", "l*(1 - cos(psi)) + r - r*cos(phi)", None),
    ("r*cos(phi) + r**2*sin(2*phi)/(2*sqrt(l**2 + r**2*sin(phi)**2))", "dx_dphi",
     "r*sin(phi) + r**2*sin(2*phi)/(2*sqrt(l**2 - r**2*sin(phi)**2))", "sign, sine and cosine"),
    ("sqrt(sum(P_jy**2 + P_jx**2))", "rodless.inertia_resultant", "sqrt(sum(P_jy)**2 + sum(P_jx)**2)", "squares"),
    ("2*pi*N/60*Tq", "cylinder.power_kw", "2*pi*N/60*Tq/1000", "unit"),
    ("CR**(-gamma)", "otto.p4", "CR**(-gamma)*p3", "put back"),
]  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(("text", "quantity", "wanted", "kind"), REPAIRED, ids=[t for t, *_ in REPAIRED])
def test_slips_are_repaired(ask, text, quantity, wanted, kind):
    question = ask(text, quantity, {}, hold={"alphadd": 0.0} if "rodless" in quantity else {})
    verdict = decide(question)
    if kind is None:
        assert verdict.verdict == "wrong"  # two terms are missing: not a single slip
        return
    assert verdict.verdict == "misprint"
    best = verdict.repairs[0]
    assert best.exact and best.max_rel_error < 1e-12
    assert ", ".join(e.kind for e in best.edits) == kind
    same = ask(wanted, quantity, {}, hold=question.hold).formula.tree
    assert max_rel_error(turn(question), same) < 1e-12  # what is wanted is right, so the repair is the same function


@pytest.mark.slow
def test_sign_of_the_rod_term_is_found_by_search(ask, inertia):
    question = ask(inertia["-"], "inertia")
    verdict = decide(question)
    row = formula_row(question, verdict, "", "", "")
    assert verdict.verdict == "misprint" and verdict.order == 1
    assert row["max_rel_error"] == pytest.approx(0.111, abs=5e-4)
    assert row["corrected_max_rel_error"] == pytest.approx(0.0098, abs=5e-5)
    assert row["correction"] == inertia["+"]
    assert len(verdict.repairs) == 1  # the edit is the only one
    assert verdict.counterexample["printed"] != verdict.counterexample["derived"]


@pytest.mark.parametrize(
    ("text", "quantity", "order"),
    [
        ("r*sin(phi)", "dx_dphi", 1),
        ("r*sin(phi) + 0.5*l*lam**2*sin(2*phi)", "dx_dphi", 3),
        ("1 - 0.25*lam**2 + 0.25*lam**2*cos(2*phi)", "cos_psi", 4),
        ("r*(1 - cos(phi) + lam/4*(1 - cos(2*phi)))", "x", 3),
    ],
)
def test_honest_approximations_are_no_misprints(ask, text, quantity, order):
    verdict = decide(ask(text, quantity))
    assert verdict.verdict == "truncation" and verdict.order == order and not verdict.repairs


@pytest.mark.slow
def test_sign_turned_inertia_is_an_honest_approximation(ask, inertia):
    verdict = decide(ask(inertia["+"], "inertia"))
    assert verdict.verdict == "mixed" and verdict.order == 3


def test_rounded_constants_are_no_misprints(ask):
    verdict = decide(ask("6.28*n_R*Tq/V_displaced", "cylinder.mep", {}))
    assert verdict.verdict == "truncation" and "6.28" in verdict.note


@pytest.mark.parametrize("text", ["m2", "0.785*inertia*phid**2", "0", "phid", "inertia + phid"])
def test_nonsense_is_wrong(ask, text):
    assert decide(ask(text, "kinetic_energy")).verdict == "wrong"


def test_an_error_carried_through_is_found_once(ask):
    text = (
        "-r*sin(phi) - lam*r*sin(phi)*cos(phi)/sqrt(1 + lam**2*sin(phi)**2)"
        " + 2*(r*sin(phi) + lam*r*sin(phi)*cos(phi)/sqrt(1 + lam**2*sin(phi)**2))"
    )
    verdict = decide(ask(text, "dx_dphi"))
    assert verdict.verdict == "misprint" and verdict.repairs[0].exact
    assert verdict.repairs[0].edits[0].kind == "everywhere"


@pytest.mark.parametrize(
    ("text", "against", "letters"),
    [
        ("total_force*sin(beta)", "slider_crank.normal_force", ""),
        ("pi*B**2/4*2*r/r_c", "cylinder_volume.V_c", ""),
        ("p_0/(R*T_0)*x**gamma", "nozzle.density", ""),
    ],
)
def test_slips_of_strangers(text, against, letters):
    """A sine for a tangent, a ratio for one less, an exponent upside down."""
    row = check_formula(text, against, letters=letters)
    assert row["verdict"] == "misprint"
    again = check_formula(row["correction"], against, letters=letters)
    assert again["verdict"] in ("exact", "convention")
