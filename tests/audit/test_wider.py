"""Slips of several parts at once, lost factors of pi, wrong digits, and how plainly a correction is written."""

import pytest

from mechsym.audit.hosts.formula import check_formula

SLIPS = [
    # a root that lost its whole run of a sum; a run of a product turned over
    ("atan((v/w - e)/(s + (R_b+R_r)**2-e**2))", "roller_cam.pressure_angle", "w=phid",
     "atan((v/w - e)/(s + sqrt((R_b + R_r)**2 - e**2)))"),
    ("sqrt(k_1*I_1*I_2/(I_1+I_2))", "torsion.omega_2", "", "sqrt(k_1*(I_1 + I_2)/(I_1*I_2))"),
    # letters for each other, functions throughout
    ("asin(l*sin(phi)/r)", "slider_crank.beta", "", "asin(r*sin(phi)/l)"),
    ("(pi + 2*acos(r/d))/(pi - 2*acos(r/d))", "slotted_link.time_ratio", "d=d0",
     "(pi + 2*asin(r/d))/(pi - 2*asin(r/d))"),
    # a share for the rest of it
    ("m_b*L_m/L", "two_mass_rod.mass_on_crank", "", "m_b*(1 - L_m/L)"),
    # a letter lost inside a cosine, a factor 1 + t, a rate of a name that the formula has
    ("(R-q)*cos(phi) + b*cos((R-q)*phi)", "trochoid.x", "", "(R - q)*cos(phi) + b*cos((R - q)*phi/q)"),
    ("atan((v - e)/(s + d0))", "roller_cam.pressure_angle", "", "atan((v/phid - e)/(s + d0))"),
    # pi
    ("B**2/4", "cylinder_volume.A_piston", "", "B**2/4*pi"),
    ("stroke*omega", "piston_speed.mean_piston_speed", "", "stroke*omega/pi"),
    # digits
    ("(4*c-1)/(4*c-4)+0.651/c", "helical_spring.wahl", "c=index", "(4*c - 1)/(4*c - 4) + 0.615/c"),
    ("3.26*B**(-0.2)*(p/1000)**0.8*T**(-0.53)*w**0.8", "heat_transfer.woschni", "",
     "3.26*B**(-0.2)*(p/1000)**0.8*T**(-0.55)*w**0.8"),
    # nobody writes m - 1 + 1
    ("(theta-theta_s)**(m+1)*(m+1)*a/duration**(m+1)*(1-burned)", "wiebe.burn_rate", "",
     "(theta - theta_s)**m*(m + 1)*a/duration**(m + 1)*(1 - burned)"),
]  # fmt: skip


# what is printed, of what quantity, what was meant; two slips each
TWICE = [
    ("r*sin(phi*(pi/180))/cos(beta)", "slider_crank.dx_dphi", "r*sin(phi + beta)/cos(beta)"),
    ("l*cos(beta)/(r*cos(phi*(pi/180)))", "slider_crank.dbeta_dphi", "r*cos(phi)/(l*cos(beta))"),
    ("p0*A*(H/(H - 2*rho0 + 2*rho0))", "guide.spring_force", "p0*A*(H/(H - 2*rho0 + 2*rho))**n"),
    ("p0*A*(H*(H - 2*rho0 + 2*rho))", "guide.spring_force", "p0*A*(H/(H - 2*rho0 + 2*rho))**n"),
    ("1 - V1/V1", "otto.efficiency", "1 - (V2/V1)**(gamma - 1)"),
    (
        "T1*(V1/V1)**(gamma - 1) + Q_23*T1/(p1*V1)",
        "otto.T3",
        "T1*(V1/V2)**(gamma - 1) + Q_23*T1/(p1*V1)*(gamma - 1)",
    ),
]


@pytest.mark.parametrize(("text", "against", "right"), TWICE, ids=[s[1] + " " + s[0][:20] for s in TWICE])
def test_two_slips_are_repaired(text, against, right):
    assert check_formula(text, against)["correction"] == right


@pytest.mark.parametrize(("text", "against", "letters", "right"), SLIPS, ids=[s[1] + " " + s[0][:20] for s in SLIPS])
def test_it_is_repaired(text, against, letters, right):
    row = check_formula(text, against, letters=letters)
    assert (row["verdict"], row["correction"]) == ("misprint", right)
    assert check_formula(right, against, letters=letters)["verdict"] == "exact"


@pytest.mark.parametrize("text", ["3*omega*stroke", "stroke*omega/5", "stroke**2*omega**2"])
def test_a_number_that_is_no_misreading_is_not_mended_by_digits(text):
    assert "number" not in check_formula(text, "piston_speed.mean_piston_speed")["note"]


@pytest.mark.parametrize("text", ["(0 - 2)/(0)", "0/phi", "0*r1 + 0.0", "2**0 - 0"])
def test_a_nought_is_no_misread_number(text):
    assert check_formula(text, "crosshead.dx_dphi")["verdict"] in ("wrong", "untestable")


def test_constant_speed_counts_for_names_that_hold_the_acceleration():
    row = check_formula("R_b + s + a/w**2", "flat_cam.radius", letters="w=phid")
    assert row["verdict"] == "convention"
    assert "constant speed" in row["note"]
    assert check_formula("R_b + s - a/w**2", "flat_cam.radius", letters="w=phid")["verdict"] == "misprint"
