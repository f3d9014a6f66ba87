"""Quantities that anyone declares: a cam, a burn rate, a four-bar; derivatives and harmonics of every name."""

import math

import numpy as np
import pytest
import scipy

from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.judge.asked import Asked
from mechsym.audit.read.algebra import FLOATS
from mechsym.audit.row import answer
from mechsym.audit.theory.catalogue import shipped, theory
from mechsym.audit.theory.declared import theory_of
from mechsym.audit.theory.record import complete
from mechsym.errors import BadInput

CAM = """
angle = "phi"
[letters]
R_b = "30 mm"
h = "10 mm"
[define]
s = "h*(1 - cos(phi))/2"
x = "-(R_b + s)*sin(phi) - d(s, phi)*cos(phi)"
y = "(R_b + s)*cos(phi) - d(s, phi)*sin(phi)"
rho = "curve(x, y).radius"
"""
BURN = """
angle = "theta"
[letters]
theta = { unit = "rad", domain = [0.3, 1.0] }
theta_s = { unit = "rad", domain = [0.05, 0.2] }
duration = { unit = "rad", value = 1.0, sign = "positive" }
a = 5.0
m = 2.0
[define]
xb = "1 - exp(-a*((theta - theta_s)/duration)**(m + 1))"
rate = "d(xb, theta)"
"""
FOUR_BAR = """
angle = "alpha"
[letters]
a = "40 mm"
b = "120 mm"
c = "80 mm"
d0 = "100 mm"
[define]
gamma = "root('(a*cos(alpha) - d0 - c*cos(g))**2 + (a*sin(alpha) - c*sin(g))**2 - b**2', g, 2)"
beta = "atan2(c*sin(gamma) - a*sin(alpha), d0 + c*cos(gamma) - a*cos(alpha))"
"""
WIEBE = "a*(m + 1)*((theta - theta_s)/duration)**m*exp(-a*((theta - theta_s)/duration)**(m + 1))"
ASKED = [
    (CAM, "rho", "R_b + s - d2s_dphi2", "R_b + s + d2s_dphi2"),
    (BURN, "rate", WIEBE, f"{WIEBE}/duration"),
    (
        FOUR_BAR,
        "dgamma_dalpha",
        "a*sin(alpha + beta)/(c*sin(gamma - beta))",
        "a*sin(alpha - beta)/(c*sin(gamma - beta))",
    ),
]


@pytest.mark.parametrize(("declared", "quantity", "wrong", "right"), ASKED, ids=["cam", "burn", "four-bar"])
def test_anyone_may_ask(tmp_path, declared, quantity, wrong, right):
    file = tmp_path / "mine.toml"
    file.write_text(declared)
    assert len(declared.strip().splitlines()) <= 12
    assert check_formula(right, f"mine.{quantity}", theory=str(file))["verdict"] == "exact"
    row = check_formula(wrong, f"mine.{quantity}", theory=str(file))
    assert row["verdict"] == "misprint" and row["corrected_max_rel_error"] < 1e-9


RANGES = """
angle = "phi"
[letters]
k = { unit = "-", value = 0.5, domain = [0.2, 0.8] }
r = "50 mm"
l = "180 mm"
t_1 = { unit = "s", value = 2.0, sign = "positive" }
[define]
K = "integral(1/sqrt(1 - k**2*sin(t)**2), t, 0, pi/2)"
E = "integral(sqrt(1 - k**2*sin(t)**2), t, 0, pi/2)"
K_slope = "d(K, k)"
x = "r*cos(phi) + sqrt(l**2 - r**2*sin(phi)**2)"
deceleration = "-d(x, phi, 2)"
most = "peak(deceleration)"
height = "r*sin(phi) + k*r*abs(cos(phi))"
highest = "peak(height)"
upto = "integral(t_1*cos(u*k), u, 0, k)"
ends = "d(upto, k)"
turned = "integral(deceleration*r, phi, 0, pi)"
low = "least((u - k)**2 + r/l, u, -1, 1)"
edge = "least(u*(1 + k), u, 0.5, 2)"
cap = "table(k, [0.3, 0.5, 0.7], [1, 4, 2])"
"""
OVER_RANGES = [
    ("K_slope", "(E - (1 - k**2)*K)/(k*(1 - k**2))", "(E + (1 - k**2)*K)/(k*(1 - k**2))"),
    ("most", "r + r**2/l", "r - r**2/l"),
    ("highest", "r*sqrt(1 + k**2)", "r*sqrt(1 - k**2)"),
    ("upto", "t_1*sin(k**2)/k", "t_1*cos(k**2)/k"),
    ("ends", "2*t_1*cos(k**2) - t_1*sin(k**2)/k**2", "2*t_1*cos(k**2) + t_1*sin(k**2)/k**2"),
    ("low", "r/l", "l/r"),
    ("edge", "(1 + k)/2", "(1 - k)/2"),
    ("cap", "piecewise(k < 0.3, 1, piecewise(k < 0.5, 15*k - 3.5, piecewise(k < 0.7, 9 - 10*k, 2)))", "15*k - 3.5"),
]


@pytest.mark.parametrize(("quantity", "right", "wrong"), OVER_RANGES, ids=[row[0] for row in OVER_RANGES])
def test_integrals_peaks_and_tables_are_their_closed_forms(tmp_path, quantity, right, wrong):
    file = tmp_path / "mine.toml"
    file.write_text(RANGES)
    assert check_formula(right, f"mine.{quantity}", theory=str(file))["verdict"] == "exact"
    assert check_formula(wrong, f"mine.{quantity}", theory=str(file))["verdict"] not in ("exact", "truncation")


def test_an_integral_over_the_angle_is_that_of_numbers():
    names = {"r": np.array([0.05, 0.06]), "l": np.array([0.18, 0.2]), "k": np.array([0.5, 0.4])}
    names |= {"phi": np.array([0.7, 1.0]), "t_1": np.array([2.0, 1.0]), "pi": np.float64(math.pi)}
    complete(theory_of(RANGES, "mine", "mine"), names, ["turned", "K"], FLOATS)
    # from dead centre to dead centre the speed comes back to nought
    assert names["turned"] == pytest.approx([0.0, 0.0], abs=1e-14)
    assert names["K"] == pytest.approx(scipy.special.ellipk(names["k"] ** 2), rel=1e-13)


def test_an_integral_without_a_value_is_none():
    text = "[letters]\nk = 2.0\n[define]\nx = 'integral(1/(u - k/4), u, 0, 1)'"
    names = {"k": np.array([2.0]), "pi": np.float64(math.pi)}
    complete(theory_of(text, "mine", "mine"), names, ["x"], FLOATS)
    assert np.isnan(names["x"]).all()


def test_rates_and_harmonics_are_those_of_numbers():
    found = theory_of(CAM, "cam", "cam")
    names = {"R_b": np.array([0.03]), "h": np.array([0.01]), "phi": np.array([0.7]), "phid": np.array([2.0])}
    names |= {"phidd": np.array([0.5]), "pi": np.float64(math.pi)}
    complete(found, names, ["s_d", "s_dd", "s_mean", "s_cos1", "s_sin1"], FLOATS)
    assert names["s_d"] == pytest.approx(0.005 * math.sin(0.7) * 2)
    assert names["s_dd"] == pytest.approx(0.005 * (math.cos(0.7) * 4 + math.sin(0.7) * 0.5))
    assert names["s_mean"] == pytest.approx(0.005) and names["s_cos1"] == pytest.approx(-0.005)
    assert names["s_sin1"] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("name", sorted(shipped()))
def test_shipped_theories_have_values_everywhere(name):
    found = theory(name)
    names = {k: np.array([v.value]) for k, v in found.letters.items()} | {"pi": np.float64(math.pi)}
    complete(found, names, found.results, FLOATS)
    assert all(np.isfinite(names[k]).all() for k in found.results)


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("x = 1", "is not a key of a theory"),
        ("[letters]\nr = 'm'", r"nothing in \[define\]"),
        ("[letters]\nr = 'm'\n[define]\nx = 'q'", "define.x: unknown letter 'q'"),
        ("[letters]\nr = '3 furlongs'\n[define]\nx = 'r'", "unit"),
        ("[letters]\nr = 'm'\n[define]\nx = 'd(r, q)'", "not a free letter"),
        ("[letters]\nr = 'm'\n[define]\nx = 'curve(r, r).curvature'", "needs the angle"),
        ("[letters]\nr = 'm'\n[define]\nx = 'root(r, u, 1)'", "root is written"),
        ("[letters]\nr = 'm'\n[define]\nx = 'integral(r, u, 1)'", r"integral is written integral\(e, u, from, to\)"),
        ("[letters]\nr = 'm'\n[define]\nx = '2*integral(r, u, 0, 1)'", "give it a name and use that"),
        ("[letters]\nr = 'm'\n[define]\nx = 'r'\ny = 'peak(r, x, 0, 1)'", "x is defined above"),
        ("[letters]\nr = 'm'\n[define]\nx = 'peak(r*u, u, 0, 1)'\ny = 'd(x, r)'", "has no derivative"),
        ("[letters]\nr = 'm'\n[define]\nx = 'table(r, [2, 1], [0, 1])'", "places of a table ascend"),
        ("[letters]\nr = 'm'\n[define]\nx = 'table(r, [1], 2)'", "a table is written"),
        ("[letters]\npi = 3.0\n[define]\nx = 'pi'", "not pi"),
        ("[letters]\nsin = 3.0\n[define]\nx = 'sin'", "nor a function"),
        ("[letters]\nr = 'm'\n[define]\nsin = 'r'", "no letter or function yet"),
    ],
)
def test_bad_declarations_name_the_place(text, reason):
    with pytest.raises(BadInput, match=reason):
        theory_of(text, "mine", "mine.toml")


@pytest.mark.parametrize(("typed", "unit"), [
    ("0.1 MPa", "Pa"), ("2 kN", "N"), ("3 kN*m", "N*m"), ("2 N/mm", "N/m"), ("1 g/cm^3", "kg/m^3"), ("5 L/s", "m^3/s"),
])  # fmt: skip
def test_a_letter_has_the_si_unit_that_one_would_write(typed, unit):
    declared = theory_of(f'[letters]\na = "{typed}"\n[define]\ny = "2*a"', "mine", "mine.toml")
    assert declared.letters["a"].unit == unit


def test_a_name_that_is_called_like_a_derivative_is_none():
    # the displacement V_d of a cylinder is no rate of its volume V
    rate = check_formula("A_piston*r*w*sin(phi + b)/cos(b)", "cylinder_volume.V_rate", "w=phid, b=asin(r*sin(phi)/l)")
    assert rate["verdict"] == "exact"
    assert check_formula("pi/4*B**2*2*r", "cylinder_volume.V_d")["verdict"] == "exact"


def test_derivatives_of_names_beside_names_like_derivatives():
    text = """
angle = "phi"
[letters]
r = "1 m"
x_d = "2 m"
[define]
x = "r*sin(phi) + x_d"
dx_dphi = "r*(3 + phi)"
v = "dt(x)"
a = "dt(v)"
s = "d(x, phi, 2)"
q = "d(dx_dphi, phi)"
"""
    own = theory_of(text, "own", "own.toml")
    right = {
        "v": "r*cos(phi)*phid", "a": "r*cos(phi)*phidd - r*sin(phi)*phid**2",
        "x_dd": "r*cos(phi)*phidd - r*sin(phi)*phid**2",
        "s": "-r*sin(phi)", "d2x_dphi2": "-r*sin(phi)", "q": "r",
    }  # fmt: skip
    for quantity, formula in right.items():
        assert answer(Asked(text=formula, against=f"own.{quantity}", given=own))["verdict"] == "exact", quantity


def test_a_name_that_has_no_derivative_stops_no_file():
    # W_E is made of a mean over a turn, which has none; a program's name may ask for one
    tape = theory("schmidt_alpha").tape
    assert "W_E" in tape and "dW_E_dphi" not in tape
