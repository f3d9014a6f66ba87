"""Formulas of programs: a mean piston speed in Modelica, a rod's angular acceleration in C, Python and MATLAB."""

from dataclasses import replace

import pytest

from mechsym.audit.hosts.code import read_code
from mechsym.audit.hosts.program import check_code
from mechsym.audit.judge.asked import Asked
from mechsym.errors import BadInput

MODELICA = """
partial model HeatTransfer
  Modelica.SIunits.Velocity c_m "Mean piston speed";
equation
  if time > 0 then
    omega_m = crankshaftAngle/time "Use continuous input";
  end if;
  c_m = omega_m/2/pi*stroke;
end HeatTransfer;
"""
C = """
double rod_alpha(double t, double r, double l, double w)
{
    const double lam = r/l;           // crank over rod
    double s = sin(t), q = sqrt(1.0 - lam*lam*s*s);
    return lam*w*w*(lam*lam {sign} 1.0)*s/pow(q, 3);
}
"""
PYTHON = """def velocity(r, l, phi, w):
    lam = r/l
    b = np.arcsin(lam*np.sin(phi))
    return r*w*np.sin(phi + b)/np.cos(b)
"""
MATLAB = "function v = velocity(r, l, t, w)\nlam = r/l; % ratio\nv = r*w*(sin(t) - lam/2*sin(2*t));\n"
pytest.importorskip("tree_sitter")
NONE = Asked(text="", against="")
LETTERS = Asked(text="", against="", letters="t=phi,w=phid")


def write(path, text):
    path.write_text(text)
    return str(path)


def test_a_mean_piston_speed_is_found_by_what_is_said_of_it(tmp_path):
    (row,) = check_code(write(tmp_path / "h.mo", MODELICA) + "::HeatTransfer", "", NONE)
    assert row["verdict"] == "misprint" and row["max_rel_error"] == pytest.approx(0.5)
    assert "c_m" in row["equation"] and row["claim"] == "piston_speed.mean_piston_speed"
    assert "omega_m taken for omega" in row["note"]


@pytest.mark.parametrize(("sign", "verdict"), [("-", "convention"), ("+", "misprint")])
def test_a_sign_in_c(tmp_path, sign, verdict):
    file = write(tmp_path / "rod.c", C.replace("{sign}", sign))
    (row,) = check_code(f"{file}::rod_alpha", "slider_crank.beta_dd", LETTERS)
    assert row["verdict"] == verdict and (row["correction"] is None) == (verdict == "convention")


def test_python_and_matlab(tmp_path):
    (row,) = check_code(write(tmp_path / "v.py", PYTHON) + "::velocity", "slider_crank.x_d", LETTERS)
    assert row["verdict"] == "exact"
    (row,) = check_code(write(tmp_path / "v.m", MATLAB) + "::velocity", "slider_crank.x_d", LETTERS)
    assert row["verdict"] == "misprint" and row["corrected_max_rel_error"] < 0.02


def test_own_variables_are_put_in(tmp_path):
    found = {a.name: a.text for a in read_code(write(tmp_path / "rod.c", C.replace("{sign}", "-")) + "::rod_alpha")}
    assert found["q"] == "sqrt(1.0 - r/l*(r/l)*sin(t)*sin(t))"


@pytest.mark.parametrize(
    ("place", "reason"),
    [
        ("v.py", "is not FILE::FUNCTION"),
        ("/nowhere.py::f", "cannot be read"),
        ("v.txt::f", "files that are read"),
        ("v.py::nothing", "there is no function nothing"),
    ],
)
def test_bad_places_are_refused(tmp_path, monkeypatch, place, reason):
    monkeypatch.chdir(tmp_path)
    for name in ("v.py", "v.txt"):
        write(tmp_path / name, PYTHON)
    with pytest.raises(BadInput, match=reason):
        check_code(place, "slider_crank.x_d", NONE)


JAVA = """class Piston {
  double rate(double t) {
    double q = Math.sqrt(l*l - r*r*Math.sin(t)*Math.sin(t));
    return w*(-r*Math.sin(t) + r*r*Math.sin(t)*Math.cos(t)/q);
  }
}
"""


def test_a_return_without_a_name_is_told_by_its_numbers(tmp_path):
    # a public program: velocity from the crank's centre with the sign of the rod's term wrong, 28 %
    (row,) = check_code(write(tmp_path / "p.java", JAVA) + "::rate", "slider_crank", LETTERS)
    assert row["claim"] == "slider_crank.x_d" and "by its numbers" in row["note"]
    assert row["verdict"] == "misprint" and row["corrected_max_rel_error"] < 1e-9


def test_numbers_that_several_theories_have_are_asked_back(tmp_path, monkeypatch):
    monkeypatch.setattr("mechsym.audit.hosts.program.shipped", lambda: ["rhombic_drive"])
    with pytest.raises(BadInput, match="near to rhombic_drive.gap_d, slider_crank.x_d; say which with --against"):
        check_code(write(tmp_path / "p.java", JAVA) + "::rate", "", LETTERS)


def test_numbers_of_another_dimension_are_no_match(tmp_path):
    place = write(tmp_path / "p.py", "def f(r, l, phi):\n    return r*l*np.sin(phi)/r**3\n") + "::f"
    with pytest.raises(BadInput, match="near to one in its numbers; name one with"):
        check_code(place, "slider_crank", NONE)


ROD = """
double rod_acc(double phi, double phid, double phidd, double r, double l, double e) {
    double s = (r*sinf(phi) - e)/l, cb = sqrtf(1.0 - s*s);
    double bd = r*phid*cosf(phi)/(l*cb);
    return (r*phidd*cosf(phi) - r*phid*phid*sinf(phi) %s l*bd*bd*s)/(l*cb);
}
"""


@pytest.mark.parametrize(("sign", "verdict"), [("+", "exact"), ("-", "misprint")])
def test_a_slip_beside_a_root_that_would_have_to_be_negative_is_no_rounded_constant(tmp_path, sign, verdict):
    place = write(tmp_path / "r.c", ROD % sign) + "::rod_acc"
    (row,) = check_code(place, "offset_slider_crank.rod_acceleration", replace(NONE, letters="e=offset"))
    assert row["verdict"] == verdict and (sign == "+") == (row["correction"] is None)


@pytest.mark.parametrize(
    ("suffix", "text"),
    [
        ("py", "def f(x):\n    for i in range(3):\n        x = x*2\n    return x\n"),
        ("py", "def f(r, phi):\n    x = r*(1 - cos(phi))\n    x += r\n    return x\n"),
        ("c", "double f(double r, double phi) { double x = r; if (r > 0) { x = x*2; } return x; }"),
        ("m", "function y = f(x)\nwhile x < 3\n x = x + 1;\nend\ny = x;\n"),
    ],
)
def test_what_a_loop_or_a_branch_changes_is_not_read_as_it_was(tmp_path, suffix, text):
    (row,) = check_code(write(tmp_path / f"l.{suffix}", text) + "::f", "cylinder_volume.s", NONE)
    assert row["verdict"] == "untestable" and "x is assigned in a loop or a branch" in row["note"]


def test_letters_of_a_theory_of_ones_own_stay_letters_and_no_other_theory_is_asked(tmp_path):
    theory = write(tmp_path / "cam.toml", 'angle = "th"\n[letters]\nh = "8 mm"\n[define]\nlift = "h*sin(th)"\n')
    text = "model Cam\n  parameter Real h = 0.008, beta = 1.2;\nequation\n  lift = h*cos(th);\nend Cam;\n"
    (row,) = check_code(write(tmp_path / "c.mo", text) + "::Cam", "", replace(NONE, theory=theory))
    assert (row["verdict"], row["correction"]) == ("misprint", "h*sin(th)")


WIEBE = """
model Wiebe
  Real theta "crank angle";
  Real xb "burned fraction";
  Real dxb "rate of burned fraction";
  Real y;
equation
  y = (theta - theta_s)/dur;
  xb = 1 - exp(-a*y^(m + 1));
  dxb = a*(m + 1)*y^m*exp(-a*y^(m + 1));
end Wiebe;
"""


def test_a_step_on_the_way_is_no_quantity_and_what_matches_nothing_is_told(tmp_path):
    asked = Asked(text="", against="", letters="dur=duration")
    rows = check_code(write(tmp_path / "w.mo", WIEBE) + "::Wiebe", "wiebe", asked)
    assert [(r["equation"].partition(" ")[0], r["verdict"]) for r in rows] == [("xb", "exact"), ("dxb", "misprint")]
    assert all(r["unmatched"] == ["y"] for r in rows)
    assert "read, and no quantity by name or numbers: y" in rows[-1]["note"]


def test_outputs_without_a_telling_name_are_matched_beside_those_with_one(tmp_path):
    text = (
        "function [x, v] = slider(r, l, th, w)\nlam = r/l;\n"
        "x = r*((1 - cos(th)) + 1/lam*(1 - sqrt(1 - lam^2*sin(th).^2)));\n"
        "v = r*w*(sin(th) + lam*sin(2*th)/(2*sqrt(1 - lam^2*sin(th)^2)));\nend\n"
    )
    asked = Asked(text="", against="", letters="th=phi,w=phid")
    rows = check_code(write(tmp_path / "s.m", text) + "::slider", "slider_crank", asked)
    assert {r["claim"]: r["verdict"] for r in rows if r["equation"] in "xv"} == {
        "slider_crank.x": "exact", "slider_crank.x_d": "exact",
    }  # fmt: skip


def test_the_l_of_self_is_a_letter(tmp_path):
    text = "def s(self, t):\n    return self.r*cos(t) + 1.0*sqrt(self.l**2 - self.r**2*sin(t)**2)\n"
    asked = Asked(text="", against="", letters="t=phi")
    (row,) = check_code(write(tmp_path / "s.py", text) + "::s", "cylinder_volume.s", asked)
    assert row["verdict"] == "exact"


JULIA = """
# slider crank
function piston_velocity(r, l, t, w)
    n = l / r  # rod ratio
    r * w * sin(t) * (1 {sign} cos(t) /
        sqrt(n^2 - sin(t)^2))
end
rod_rate(r, l, t, w) = w*r*cos(t)/(l*sqrt(1 - (r*sin(t)/l)^2))
"""
LINES = """function v = f(r, l, t, w)
q = sqrt((l/r)^2 ...
    - sin(t)^2) % root
v = r*w*sin(t)*(1 {sign} cos(t)/q)
end
"""
FORTRAN = """
real(8) function piston_velocity(r, l, t, w) result(v)
  implicit none
  real(8), intent(in) :: r, l, t, w
  real(8) :: n, q
  n = l / r
  q = SQRT(n**2 - sin(t)**2) ! root
  if (t > 9.0d0) q = 1.0d0
  v = r*w*sin(t)*(1.0d0 {sign} &
      cos(t)/{q})
end function piston_velocity
"""


@pytest.mark.parametrize(
    ("name", "text", "function"),
    [
        ("v.jl", JULIA, "piston_velocity"),
        ("v.f90", FORTRAN.replace("{q}", "sqrt(n**2 - sin(t)**2)"), "piston_velocity"),
        ("v.m", LINES, "f"),
    ],
)  # fmt: skip
@pytest.mark.parametrize(("sign", "verdict"), [("+", "exact"), ("-", "misprint")])
def test_languages_whose_statements_end_with_the_line(tmp_path, name, text, function, sign, verdict):
    file = write(tmp_path / name, text.replace("{sign}", sign))
    (row,) = [r for r in check_code(f"{file}::{function}", "slider_crank", LETTERS) if r["claim"].endswith("x_d")]
    assert row["verdict"] == verdict


def test_a_julia_function_of_one_line(tmp_path):
    (row,) = check_code(write(tmp_path / "v.jl", JULIA) + "::rod_rate", "slider_crank.beta_d", LETTERS)
    assert row["verdict"] == "exact"


def test_what_a_branch_of_fortran_sets_is_not_followed(tmp_path):
    file = write(tmp_path / "v.f90", FORTRAN.replace("{q}", "q").replace("{sign}", "+"))
    (row,) = [r for r in check_code(f"{file}::piston_velocity", "slider_crank.x_d", LETTERS)]
    assert row["verdict"] == "untestable" and "q is assigned in a loop or a branch" in row["note"]
