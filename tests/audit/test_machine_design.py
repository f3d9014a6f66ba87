"""Programs of machine design: slips of fatigue, belts, shifted gears and AGMA's stresses are told."""

import pytest
from audited import rows_of

GERBER = """def safety(Sut, Se_fan, sigma_a_fan, sigma_m_fan):  # fatigue
    ratio = 2*sigma_m_fan*Se_fan/(Sut*sigma_a_fan)
    n_g_fan = 0.5*(Sut/sigma_m_fan)**2*(sigma_a_fan/Se_fan)*(-1 + sqrt(1 + ratio{power}))
    return n_g_fan
"""


def test_the_place_behind_every_name_is_no_part_of_it(tmp_path):
    assert rows_of(tmp_path / "right", {"fan.py": GERBER.replace("{power}", "**2")}) == []
    (row,) = rows_of(tmp_path / "wrong", {"fan.py": GERBER.replace("{power}", "")})
    assert (row["verdict"], row["claim"]) == ("misprint", "fatigue_life.gerber_factor")


def test_an_angle_that_is_turned_the_wrong_way(tmp_path):
    text = (
        "import math\ndef f(Ft, m, beta):\n    Fw = Ft*math.sqrt(m**2 + 1 - 2*m*math.cos(beta*{turn}))\n    return Fw\n"
    )
    assert rows_of(tmp_path / "right", {"belt.py": text.replace("{turn}", "math.pi/180")}) == []
    row = rows_of(tmp_path / "wrong", {"belt.py": text.replace("{turn}", "180/math.pi")})[0]
    assert "turned into degrees where radians are taken" in row["note"]
    matlab = "function f = f(a, beta)\nf = a*cosd(beta*180/pi);\nend\n"
    pytest.importorskip("tree_sitter")
    assert rows_of(tmp_path / "degrees", {"f.m": matlab}) == []


PAIR = """// spur gears with coefficient of profile shift xp, xg and working pressure angle aw
double all(double m, double a, double aw, double zp, double zg, double xp, double xg) {
    // Center Distance Increment Factor
    double y = ((zg + zp)/2)*((cos(a)/cos(aw)) - 1);
    // Pitch Diameter
    double dp = zp*m;
    double dg = zg*m;
    // Addendum
    double hap = (1 + y - xg)*m;
    double hag = (1 + y - xp)*m;
    // Whole Depth
    double h = (2.25 + y - (xp + xg))*m;
    // Dedendum
    double hdp = h - hap;
    double hdg = h - hag;
    // Root Diameter
    double drp = dp - 2*hdp;
    // Base Pitch
    double pb = m*M_PI*cos(a);
    return pb;
}
"""


@pytest.mark.parametrize(
    ("old", "new", "claim"),
    [
        ("hap = (1 + y - xg)", "hap = (1 + y - xp)", "profile_shift.h_a1"),
        ("dp - 2*hdp", "dp - 2*hap", "profile_shift.d_f1"),
        ("M_PI*cos(a)", "M_PI*cos(aw)", "profile_shift.base_pitch"),
    ],
)
def test_a_letter_a_sign_away_is_mistaken_for_another(tmp_path, old, new, claim):
    pytest.importorskip("tree_sitter")
    assert rows_of(tmp_path / "right", {"pair.c": PAIR}) == []
    assert [row["claim"] for row in rows_of(tmp_path / "wrong", {"pair.c": PAIR.replace(old, new)})][0] == claim


AGMA = """% AGMA stresses
Kv = 1.4; Ks_p = 1.1; St = 300;
function bSp = stress(Wt, Ko, Kv, Ks_p, Pt, Km, Kb, F, Jp)
bSp = Wt*Ko*Kv*Ks_p*Pt*Km*Kb/{below};
end
function Cpf = proportion(F, dP)
Cpf = F/(10*dP) - 0.0375 + 0.0125*F;
end
"""


def test_a_stroke_that_reaches_one_factor_only(tmp_path):
    pytest.importorskip("tree_sitter")
    assert rows_of(tmp_path / "right", {"agma.m": AGMA.replace("{below}", "(F*Jp)")}) == []
    (row,) = rows_of(tmp_path / "wrong", {"agma.m": AGMA.replace("{below}", "F*Jp")})
    assert (row["claim"], "(F*Jp)" in row["correction"]) == ("agma_gears.bending_stress", True)
