"""Conventions of an author are said and not blamed; several formulas of one source settle them."""

import pytest

from mechsym.audit.hosts.formula import check_file, check_formula

# one formula for each kind of convention, and words that tell it
READINGS = [
    ("-r*sin(phi + beta)/cos(beta)", "slider_crank.dx_dphi", "reversed"),
    ("r*cos(phi) + l*cos(beta)", "slider_crank.x", "another origin, the other way"),
    ("l - l*cos(beta) - r*cos(phi)", "slider_crank.x", "another origin"),
    ("pi*B**2", "cylinder_volume.A_piston", "B as half of it, as a radius for a diameter"),
    ("2/((1 - nu_1**2)/E_1 + (1 - nu_2**2)/E_2)", "strength.E_star", "twice it, as 2E for E"),
    ("z_r/(z_r + z_s)", "epicyclic.ratio_fixed_sun", "the ratio the other way round"),
    ("-z_s/z_r", "epicyclic.ratio_fixed_carrier", "the ratio the other way round"),
    ("sqrt(k_1*(I_1 + I_2)/(I_1*I_2))/(2*pi)", "torsion.omega_2", "turns per second"),
    ("asin(r*sin(phi)/l)*180/pi", "slider_crank.beta", "degrees"),
    ("r*(1 - cos(phi*pi/180))", "scotch_yoke.x", "phi as degrees"),
    ("stroke*omega/30", "piston_speed.mean_piston_speed", "omega as turns per minute"),
]


@pytest.mark.parametrize(
    ("text", "against", "words"), [r for r in READINGS if r[2]], ids=[r[1] for r in READINGS if r[2]]
)
def test_a_convention_is_said_and_not_blamed(text, against, words):
    row = check_formula(text, against)
    assert row["verdict"] == "untestable" and words in row["note"]


def test_what_several_formulas_count_alike_is_settled(tmp_path):
    texts = ["-r*sin(phi + beta)/cos(beta)", "-(r*sin(phi) + r*cos(phi)*tan(beta))"]
    tables = "".join(f'[[formula]]\ntext = "{t}"\nagainst = "slider_crank.dx_dphi"\n' for t in texts)
    (tmp_path / "page.toml").write_text(tables)
    for row in check_file(tmp_path / "page.toml"):
        assert row["verdict"] == "convention" and row["correction"] is None and "2 formulas" in row["note"]


@pytest.mark.parametrize(
    ("text", "against", "convention"),
    [
        ("z_r/(z_r + z_s)", "epicyclic.ratio_fixed_sun", "inverse"),
        ("sqrt(k_1*(I_1 + I_2)/(I_1*I_2))/(2*pi)", "torsion.omega_2", "turns"),
        ("2/((1 - nu_1**2)/E_1 + (1 - nu_2**2)/E_2)", "strength.E_star", "double"),
    ],
)
def test_a_convention_that_is_named_counts(text, against, convention):
    assert check_formula(text, against, convention=convention)["verdict"] == "convention"


def test_a_slip_that_no_convention_explains_stays_a_misprint():
    row = check_formula("r*sin(phi) - r*lam*sin(phi)*cos(phi)/cos(beta)", "slider_crank.dx_dphi")
    assert row["verdict"] == "misprint"
