"""The public bench: enough of it, its labels by two truths, and what its open half taught the reader."""

from collections import Counter

import pytest
from audit.public.labels import label

from benchmarks.auditor import public
from benchmarks.auditor.matrix import stored
from mechsym.audit.hosts.formula import check_formula

ROWS = public.formulas()
WRONG = [row for row in ROWS if row["label"] == "wrong"]
QUICK = ("piston_speed", "wiebe", "epicyclic", "trochoid", "inline_balance", "heat_transfer")


def where(row):
    return f"{row['against']} {row['text'][:30]}"


def test_there_is_enough_of_it():
    named = {row["where"] for row in ROWS if not row["where"].startswith("unnamed")}
    assert len(ROWS) >= 200
    assert len(named) >= 40
    assert len({(row["against"], row["text"]) for row in ROWS}) == len(ROWS)
    halves = Counter(public.half_of(row["where"]) for row in ROWS)
    assert min(halves.values()) > 0.4 * len(ROWS)
    assert {row["label"] for row in ROWS} == set(public.LABELS)


@pytest.mark.parametrize("row", [row for row in WRONG if row["against"].partition(".")[0] in QUICK], ids=where)
def test_what_is_labelled_wrong_is_wrong_by_both_truths(row):
    assert label(row) == "wrong"
    assert label({**row, "text": row["right"], "plain": row["right"]}) == "right"


@pytest.mark.slow
@pytest.mark.parametrize("row", ROWS, ids=where)
def test_every_label_by_both_truths(row):
    assert label(row) == row["label"]


def test_the_record_counts_every_row():
    if "public" not in stored():
        pytest.skip("the bench is not recorded yet")
    for half in public.HALVES:
        found, rows = stored()["public"][half], public.formulas(half)
        assert found["formulas"] == len(rows)
        assert found["sources"] == len({row["where"] for row in rows})
        labelled = Counter(row["label"] for row in rows)
        assert {k: sum(v.values()) for k, v in found["answers"].items()} == {k: labelled[k] for k in public.LABELS}


def test_a_correction_is_judged_by_an_evaluator_of_its_own():
    row = next(row for row in WRONG if row["against"] == "wiebe.burn_rate" and row["text"].startswith("n*a*(1-xb)*"))
    assert public.asked(row)["repaired"]
    assert not public.asked({**row, "right": "2*burned"})["repaired"]


@pytest.mark.parametrize(
    ("text", "against", "letters"),
    [
        ("(pi/4).*bore.^2*(2.*r)", "cylinder_volume.V_d", "bore=B"),
        ("0.25*%pi*B^2", "cylinder_volume.A_piston", ""),
        ("Math.PI*B**2/4", "cylinder_volume.A_piston", ""),
        ("r*COS(t)", "scotch_yoke.from_centre", "t=phi"),
        ("p₀*k/(R*T₀)", "nozzle.density", "p₀=p_0, T₀=T_0, k=x**(1/gamma)"),
        ("√R*√T_0*√(gamma*k)*mach", "nozzle.velocity", "k=x**((gamma-1)/gamma)"),
        (r"\frac{1}{E^*} = \frac{1-\nu_1^2}{E_1} + \frac{1-\nu_2^2}{E_2}", "strength.E_star", "E^*=E_star"),
        (r"\text{stroke length} \times {\pi\over 4} \mbox{bore}^2", "cylinder_volume.V_d", "stroke length=2*r, bore=B"),
        (r"\frac{\Delta E}{C_s \omega^2}", "flywheel.needed", r"\Delta E=swing, C_s=0.02, \omega=w"),
        (r"asin(\frac{R}{l} sin \theta)", "slider_crank.beta", r"R=r, \theta=phi"),
        (r"n_p \cdot z_p = n_c \left(z_p + z_s\right) - w_s z_s", "epicyclic.w_p", "n_p=w_p, n_c=w_c"),
    ],
)
def test_spellings_of_programs_and_papers(text, against, letters):
    assert check_formula(text, against, letters=letters)["verdict"] == "exact"


def test_a_bracket_that_closes_too_soon():
    row = check_formula("(R - q)*cos(phi) + b*cos((R - q)/q)*phi", "trochoid.x")
    assert row["verdict"] == "misprint"
    assert check_formula(row["correction"], "trochoid.x")["verdict"] == "exact"


@pytest.mark.slow
def test_an_angle_is_the_same_after_whole_turns():
    text = "2*atan((a*sin(alpha) - b*sin(g))/(a*cos(alpha) + c - d0 - b*cos(g)))"
    row = check_formula(text, "four_bar.gamma", letters="g=transmission")
    assert (row["verdict"], row["note"]) == ("exact", "up to whole turns")
    assert check_formula(f"{text} + 1e-9", "four_bar.gamma", letters="g=transmission")["verdict"] != "exact"
