"""Whole files and folders of programs: slips are found, and what only looks alike is left alone."""

import ast
import json
import random

import pytest
from audited import NONE, rows_of
from click.testing import CliRunner

from mechsym.audit.hosts import findings as told
from mechsym.audit.hosts.findings import counts
from mechsym.audit.hosts.repository import audited, programs
from mechsym.audit.judge.lexicon import Lexicon
from mechsym.audit.read.programs.claims import read_program
from mechsym.audit.read.spelling import to_python
from mechsym.audit.theory.catalogue import named
from mechsym.cli import mechsym
from mechsym.errors import BadInput

# a piston's place with a sign under the root, in the manner of each language; {sign} is - where it is right
PLACES = {
    "p.py": "def place(crank_radius, rod_length, theta):\n"
    "    s = crank_radius*np.cos(theta) + np.sqrt(rod_length**2 {sign} (crank_radius*np.sin(theta))**2)\n"
    "    return s\n",
    "p.m": "function s = place(theta)\n% theta: crank angle [deg]\ncrank_rad = 5; rod_len = 18; % cm\n"
    "s = crank_rad*cosd(theta) + sqrt(rod_len^2 {sign} crank_rad^2*sind(theta).^2);\nend\n",
    "p.cpp": "double Crank::place(double theta) const {\n  double s = crankRadius*std::cos(theta) // place\n"
    "    + std::sqrt(rodLength*rodLength {sign} pow(crankRadius*sin(theta), 2));\n  return s;\n}\n",
    "P.java": "class P { double rodLength, crankRadius; double place(double theta) { double s ="
    " crankRadius*Math.cos(theta) + Math.sqrt(rodLength*rodLength {sign} Math.pow(this.crankRadius"
    "*Math.sin(theta), 2)); return s; } }\n",
    "p.js": "function place(c, theta) {\n  const s = c.crankRadius*Math.cos(theta) + Math.sqrt(c.rodLength**2 {sign} "
    "(c.crankRadius*Math.sin(theta))**2);\n  return s;\n}\n",
    "p.jl": "function place(crank_radius, rod_length, theta)\n    s = crank_radius*cos(theta) + "
    "sqrt(rod_length^2 {sign} crank_radius^2*sin(theta)^2)\n    return s\nend\n",
    "p.f90": "real(8) function place(crank_radius, rod_length, theta) result(s)\n  real(8) :: crank_radius\n"
    "  s = crank_radius*cos(theta) + SQRT(rod_length**2 &\n    {sign} (crank_radius*sin(theta))**2)\nend function\n",
    "P.mo": 'model P "piston"\n  parameter Real crank_radius = 0.05;\n  parameter Real rod_length(unit = "m") = 0.18;\n'
    "equation\n  s = crank_radius*cos(theta) + sqrt(rod_length^2 {sign} (crank_radius*sin(theta))^2);\nend P;\n",
}


@pytest.mark.parametrize("name", PLACES)
def test_a_sign_under_the_root_in_every_language(tmp_path, name):
    if name not in ("p.py", "P.mo"):
        pytest.importorskip("tree_sitter")
    assert rows_of(tmp_path / "right", {name: PLACES[name].replace("{sign}", "-")}) == []
    (row,) = rows_of(tmp_path / "wrong", {name: PLACES[name].replace("{sign}", "+")})
    assert (row["verdict"], row["claim"], row["file"]) == ("misprint", "cylinder_volume.s", name)
    assert row["correction"] and row["max_rel_error"] > 0.05


# attacks on precision: none of these is wrong
ATTACKS = {
    "a parameter": 'model K\n  parameter Real b = 0.69 "Peclet exponent";\n  parameter Real a = 0.56;\nend K;\n',
    "a thin disc about two axes": "# gyroscope\nM = 3  # rotor mass\nR = 0.125  # rotor radius\n"
    "I1 = M*R**2/4  # rotor moment of inertia about b_1, b_3\nI2 = 2*I1  # rotor moment of inertia about b_2\n",
    "kN beside MPa in one term": "# bolt\ndef f(S_p, A_t, F_i, C, P):\n"
    "    n_l = (S_p*A_t*10**-3 - F_i)/(C*P)\n    return n_l\n",
    "polar coordinates": "def f(r, phi, l):\n    x = r*cos(phi)\n    y = r*sin(phi)\n    v = r*sin(phi)*l\n",
    "another unit": "def f(bore, stroke):\n    V_d = 3.14159265358979/4*bore**2*stroke/1000\n    return V_d\n",
    "degrees": "def f(crank_radius, rod_length, theta):\n    x = theta*pi/180\n"
    "    s = crank_radius*cos(theta*pi/180) + sqrt(rod_length**2 - (crank_radius*sin(theta*pi/180))**2)\n",
    "the other sense": "def f(crank_radius, rod_length, theta):\n"
    "    s = -crank_radius*cos(theta) - sqrt(rod_length**2 - (crank_radius*sin(theta))**2)\n    return s\n",
    "the other origin": "def f(crank_radius, rod_length, theta):\n    x = crank_radius*cos(theta) + "
    "sqrt(rod_length**2 - (crank_radius*sin(theta))**2)\n    return x\n",
    "a step on the way": "def f(crank_radius, rod_length, theta):\n"
    "    root = sqrt(rod_length**2 - (crank_radius*sin(theta))**2)\n    return crank_radius*cos(theta) + root\n",
    "other letters of the same names": "def f(r, l, B, p):\n    s = r + l*B\n    V = p*r/l\n    return s*V\n",
    "a speed by revolutions": "def f(stroke, rpm):\n    mean_piston_speed = 2*stroke*rpm/60\n",
    "a derivative by degrees": "def f(a, t):\n    V = a*sin(t*pi/180)\n    dV_dt = a*cos(t*pi/180)*pi/180\n",
    "a partial derivative": "def f(a, t):\n    y = interp(a, t)\n    V = a*y\n    dV_dt = a*0 + y*t\n    return V\n",
    "changed in place": "def f(bore, stroke):\n    V_d = bore**2*stroke\n    V_d *= 0.785398\n    return V_d\n",
    "a sum under a comment": "def f(base_radius, roller_radius):\n    # check of the radius of curvature\n"
    "    Rp = base_radius + roller_radius\n    return Rp\n",
    "an exponent counted otherwise": "def burned(a, m, theta, theta0, dtheta):\n"
    "    x = (theta - theta0)/dtheta\n    return 1 - np.exp(-a*x**m)  # mass fraction burned\n",
    "millimetres and cubic centimetres": "def f(bore, volume):\n"
    "    surface_area = np.pi*bore*(bore/2 + volume*1000/(np.pi*(bore/2)**2))\n    return surface_area\n",
    "the height of a pitch cone": "def f(module, num_teeth, pitch_angle):\n"
    "    height = module*num_teeth/2/tan(pitch_angle)  # largest, from the cone's apex\n    return height\n",
    "a sign for what is called otherwise": "def f(module, num_teeth, pressure_angle_deg):\n"
    "    phi = np.radians(pressure_angle_deg)\n    r_base = module*num_teeth/2*np.cos(phi)\n    return r_base\n",
    "the first of two terms": "def velocity(crank_radius, omega, theta, rod_length, offset):\n"
    "    term1 = -crank_radius*omega*np.sin(theta)  # slider velocity\n    return term1\n",
    "a contact of two spheres by the same modulus": "def f(E1, E2, nu1, nu2):\n"
    "    k = (1 - nu1**2)/(pi*E1) + (1 - nu2**2)/(pi*E2)\n    return k\n",
    "doubled in its place": "def f(crank_radius, bore, opposed):\n    vd = crank_radius*np.pi*bore**2/2\n"
    "    if opposed:\n        vd = 2.0*vd\n    return vd\n",
    "the larger of two radii": "def f(module, teeth, pressure_angle):\n"
    "    base_r = module*teeth/2*np.cos(pressure_angle)\n    root_r = module*teeth/2 - 1.25*module\n"
    "    start_r = (base_r + root_r + abs(base_r - root_r))/2  # below the pitch radius\n    return start_r\n",
    "heat at constant pressure": "def f(T1, P1, P2, T3, Cv, k):\n    V1 = 8.314e-2*T1/P1\n    V2 = V1*(P1/P2)**(1/k)\n"
    "    T2 = T1*(P2/P1)**((k - 1)/k)\n    V3 = V2/T3*T3\n    W2 = P2*(V3 - V2)\n    U2 = Cv*(T3 - T2)\n"
    "    Q_in = W2 + U2\n    return Q_in\n",
    "in a branch": "def f(bore, stroke, n):\n    if n > 1:\n        stroke = stroke/2\n    V = bore*stroke\n",
}


@pytest.mark.parametrize("attack", ATTACKS)
def test_what_only_looks_alike_is_no_finding(tmp_path, attack):
    assert rows_of(tmp_path, {f"a{'.mo' if 'model' in ATTACKS[attack] else '.py'}": ATTACKS[attack]}) == []


NEWTON = "def solve(a):\n    def inv(x):\n        return np.tan(x) - x\n    def f(x):\n        return inv(x) - a\n"


def test_a_derivative_that_is_none_is_found_by_the_program_itself(tmp_path):
    wrong = NEWTON + "    def d_f(x):\n        return 1.0/np.cos(x) - 1\n    return root(f, d_f)\n"
    (row,) = rows_of(tmp_path / "1", {"n.py": wrong})
    assert row["verdict"] == "derivative" and row["correction"] == "1.0/cos(x)**2 - 1" and row["line"] == 7
    assert rows_of(tmp_path / "2", {"n.py": wrong.replace("np.cos(x) -", "np.cos(x)**2 -")}) == []
    wrong = "def g(r, t):\n    V = r*sin(t)**2\n    dV_dt = r*sin(t)*cos(t)\n    return dV_dt\n"
    (row,) = rows_of(tmp_path / "3", {"n.py": wrong})
    assert row["claim"] == "the derivative of V by t"


def test_a_mean_speed_that_counts_one_stroke_and_a_fraction_turned_over(tmp_path):
    text = "def f(stroke, rpm):\n    u = rpm/60*stroke  # mean piston speed [m/s]\n    return u\n"
    (row,) = rows_of(tmp_path / "1", {"u.py": text})
    assert row["claim"] == "piston_speed.mean_piston_speed" and row["max_rel_error"] == pytest.approx(0.5)
    text = "def f(Vd, compression_ratio):\n    clearance_volume = (compression_ratio - 1)/Vd\n"
    (row,) = rows_of(tmp_path / "2", {"v.py": text})
    assert row["claim"] == "cylinder_volume.V_c" and "inverted" in row["note"]


def test_the_size_of_a_cams_pressure_angle_by_the_steps_of_its_program(tmp_path):
    text = (
        "def largest(base_radius, roller_radius, offset, motion):\n    rate = motion.velocity/motion.omega\n"
        "    y = motion.lift\n"
        "    foot = sqrt((base_radius + roller_radius)**2 {sign} offset**2)\n"
        "    phi = np.abs(np.arctan((rate - offset)/(y + foot)))\n    return phi\n"
    )
    assert rows_of(tmp_path / "right", {"a.py": text.format(sign="-")}) == []
    rows = rows_of(tmp_path / "wrong", {"a.py": text.format(sign="+")})
    assert [row["claim"] for row in rows] == ["roller_cam.d0", "roller_cam.pressure_angle"]
    assert all("by sign" in row["note"] for row in rows)


def test_a_slip_that_stands_in_both_halves_of_a_sum(tmp_path):
    text = "def modulus(E1, E2, nu1, nu2):\n    return 1/((1 - nu1{power})/E1 + (1 - nu2{power})/E2)\n"
    assert rows_of(tmp_path / "right", {"a.py": text.format(power="**2")}) == []
    (row,) = rows_of(tmp_path / "wrong", {"a.py": text.format(power="")})
    assert row["note"].count("by power") == 2
    # of two slips of different kinds nothing is said
    assert rows_of(tmp_path / "two", {"a.py": text.format(power="").replace("(1 - nu2)", "(1 + nu2**2)")}) == []


def test_whole_numbers_of_c_divide_as_c_divides_them():
    pytest.importorskip("tree_sitter")
    (claim,) = read_program("double f(double r, double h) { return 1/3*r*r*h; }", ".c").claims
    assert to_python(claim.tree) == "0*r*r*h"


@pytest.mark.parametrize(
    "text", ["b/4*(r + a)", "b**2*(r + a)", "b + 4 + (r + a)", "b**2 - (r + a)", "b*2.5**(r - a)", "b/2/(r + a)"]
)
def test_numbers_before_brackets_of_julia(text):
    pytest.importorskip("tree_sitter")
    (claim,) = read_program(f"y = {text.replace('**', '^').replace(' ', '')}\n", ".jl").claims
    assert to_python(claim.tree) == to_python(ast.parse(text, mode="eval").body)


def test_fields_indices_loops_and_other_letters():
    text = "for i = 1:3\n  y(i) = c.CD*x(i)^2; z = y(i) + 1;\nend\nth3(2) = acos(q.L/c.CD); %% no\n"
    pytest.importorskip("tree_sitter")
    claims = {c.name: to_python(c.tree) for c in read_program(text, ".m").claims}
    assert claims == {"y": "c·CD*x**2", "z": "y + 1", "th3_2": "acos(q·L/c·CD)"}


def test_latin_1_broken_and_absent(tmp_path):
    rows = rows_of(tmp_path, {"a.py": "# Stra\xdfe\nx = r*2\n".encode("latin-1"), "b.py": "def f(:\n", "c.py": b"\0\1"})
    files = list(audited(tmp_path, NONE, programs(tmp_path)))
    assert rows == [] and [bool(f.why) for f in files] == [False, True, True] and counts(files)["read"] == 1
    with pytest.raises(BadInput, match="no such file or folder"):
        programs(tmp_path / "nowhere")


WORDS = "x = ( ) + * / ^ [ ] { } ; \n if end for def return : , . ' % // 1 2.5e3 sin r_1 & λ function model".split(" ")


@pytest.mark.parametrize("suffix", [".py", ".mo", ".c", ".m", ".jl", ".f90", ".java", ".js"])
def test_random_programs_give_an_answer_or_one_line(suffix):
    if suffix not in (".py", ".mo"):
        pytest.importorskip("tree_sitter")
    draw = random.Random(7)
    for _ in range(40):
        text = " ".join(draw.choices(WORDS, k=draw.randint(1, 60)))
        try:
            read_program(text, suffix)
        except BadInput as error:
            assert "\n" not in str(error)
    for deep in ("(" * 3000 + "x" + ")" * 3000, "x = " + "-" * 3000 + "1", "if x\n" * 2000):
        try:
            read_program(f"y = {deep}", suffix)
        except BadInput as error:
            assert "\n" not in str(error)


def test_the_command_tells_coverage_writes_sarif_and_fails_on_what_is_new(tmp_path):
    place, log, page = tmp_path / "src", tmp_path / "f.sarif", tmp_path / "page"
    rows_of(place, {"p.py": PLACES["p.py"].replace("{sign}", "+")})
    run = CliRunner().invoke(mechsym, ["audit", "--code", str(place), "--sarif", str(log), "--out", str(page)])
    assert run.exit_code == 1 and "1 of 1 files read" in run.output and "p.py:2:" in run.output
    (result,) = json.loads(log.read_text())["runs"][0]["results"]
    assert result["locations"][0]["physicalLocation"]["region"] == {"startLine": 2}
    assert "Findings" in (page / "audit.html").read_text()
    again = CliRunner().invoke(mechsym, ["audit", "--code", str(place), "--baseline", str(log), "--json"])
    assert again.exit_code == 0 and json.loads(again.output)["coverage"]["findings"] == 1
    # a line above moves the finding and does not make it new
    (place / "p.py").write_text("import numpy as np\n\n" + PLACES["p.py"].replace("{sign}", "+"))
    assert CliRunner().invoke(mechsym, ["audit", "--code", str(place), "--baseline", str(log)]).exit_code == 0
    (place / "q.py").write_text("def f(stroke, rpm):\n    mean_piston_speed = stroke*rpm/60\n    return 1\n")
    assert CliRunner().invoke(mechsym, ["audit", "--code", str(place), "--baseline", str(log)]).exit_code == 1
    log.write_text("[]")
    refused = CliRunner().invoke(mechsym, ["audit", "--code", str(place), "--baseline", str(log)])
    assert "neither a SARIF nor a JSON file of findings" in str(refused.exception)


def test_a_log_says_what_sarif_asks_for(tmp_path):
    rows = rows_of(tmp_path, {"p.py": PLACES["p.py"].replace("{sign}", "+")})
    log = told.sarif(rows, "1.0")
    (run,) = log["runs"]
    assert log["version"] == "2.1.0" and {r["ruleId"] for r in run["results"]} <= {
        r["id"] for r in run["tool"]["driver"]["rules"]
    }
    assert run["results"][0]["message"]["text"] and run["results"][0]["partialFingerprints"]


MOTION = """
import numpy as np
crank_radius = 0.05
rod_length = 0.18
omega = 100.0
def slider_position(theta):
    beta = np.arcsin(crank_radius*np.sin(theta)/rod_length)
    return crank_radius*np.cos(theta) + rod_length*np.cos(beta)
def slider_velocity(theta):
    root = np.sqrt(rod_length**2 - (crank_radius*np.sin(theta))**2)
    return -crank_radius*omega*np.sin(theta) - crank_radius**2*omega*np.sin(theta)*np.cos(theta)/root
def slider_acceleration(theta):
    root = np.sqrt(rod_length**2 - (crank_radius*np.sin(theta))**2)
    return (-crank_radius*omega**2*np.cos(theta) - (crank_radius*omega)**2*np.cos(2*theta)/root
            - (crank_radius**2*omega*np.sin(theta)*np.cos(theta))**2/root**3)
"""
#: Two slips in one formula, and more
WRONG = MOTION.replace("np.cos(2*theta)/root", "np.cos(theta)**2/root").replace("**2/root**3", "/root**2")


def test_without_an_offset_and_at_constant_speed_a_slider_is_a_slider(tmp_path):
    (tmp_path / "a.py").write_text(MOTION)
    (file,) = audited(tmp_path, NONE, programs(tmp_path))
    # place, velocity, acceleration and the angle of the rod; what stands on the way is none of them
    assert not file.rows and file.judged >= 4


def test_more_than_a_slip_is_told_where_its_neighbours_agree(tmp_path):
    (row,) = rows_of(tmp_path / "a", {"a.py": WRONG})
    assert (row["verdict"], row["claim"]) == ("wrong", "offset_slider_crank.acceleration")
    assert "s and velocity" in row["note"] and row["correction"] is None
    alone = WRONG[: WRONG.index("def slider_position")] + WRONG[WRONG.index("def slider_acceleration") :]
    assert rows_of(tmp_path / "b", {"b.py": alone}) == []
    other = WRONG.replace("def slider_acceleration", "def its_own_measure")
    assert rows_of(tmp_path / "c", {"c.py": other}) == []


def test_a_notebook_is_its_code(tmp_path):
    cells = [
        {"cell_type": "markdown", "source": ["# A slider"]},
        {"cell_type": "code", "source": ["%matplotlib inline\n"]},
    ]
    cells += [{"cell_type": "code", "source": "this is = no Python\n"}]
    cells += [{"cell_type": "code", "source": WRONG.splitlines(keepends=True), "outputs": [{"png": "A" * 2_000_000}]}]
    (row,) = rows_of(tmp_path / "a", {"a.ipynb": json.dumps({"cells": cells, "nbformat": 4})})
    assert row["verdict"] == "wrong"
    cells[-1] |= {"input": cells[-1].pop("source")}  # as the third format has it
    (row,) = rows_of(tmp_path / "c", {"c.ipynb": json.dumps({"worksheets": [{"cells": cells}], "nbformat": 3})})
    assert row["verdict"] == "wrong"
    (tmp_path / "b.ipynb").write_text("{}")
    (file,) = audited(tmp_path / "b.ipynb", NONE, [tmp_path / "b.ipynb"])
    assert "no notebook" in file.why


def test_letters_of_one_sign_are_told_by_neighbours_that_agree(tmp_path):
    """Ways and speeds are counted in either direction; a slip is told in the direction of its author."""
    place = "def piston_position(theta, r, L):\n    return r*cos(theta) + sqrt(L*L - r*r*sin(theta)*sin(theta))\n"
    angle = "def rod_angle(theta, r, L):\n    return asin(r*sin(theta)/L)\n"
    speed = (
        "def piston_velocity(theta, r, L, omega):\n"
        "    return -r*omega*(sin(theta) + r*sin(2*theta)/{}sqrt(L*L - r*r*sin(theta)**2){})\n"
    )
    assert rows_of(tmp_path / "a", {"a.py": place + angle + speed.format("(2*", ")")}) == []
    (row,) = rows_of(tmp_path / "b", {"b.py": place + angle + speed.format("", "")})
    assert row["verdict"] == "misprint" and row["claim"].endswith(".velocity")
    assert row["correction"].startswith("-") and row["max_rel_error"] < 0.5
    (row,) = rows_of(tmp_path / "c", {"c.py": speed.format("", "")})  # its name and its size tell enough
    assert row["verdict"] == "misprint"
    assert rows_of(tmp_path / "d", {"d.py": speed.format("", "").replace("piston_velocity", "measure")}) == []


def test_what_counts_from_another_place_and_is_cut_short_is_none_of_it(tmp_path):
    """A truncated way from the dead centre that is called a position, beside a volume and an exact way."""
    text = (
        "def cylinder(crankRadius, connectingRodLength, theta, V_c, A_piston):\n"
        "    x = crankRadius + connectingRodLength - crankRadius*cos(theta)"
        " - sqrt(connectingRodLength**2 - (crankRadius*sin(theta))**2)\n"
        "    V = V_c + A_piston*x\n"
        "    return V\n"
        "def pistonPosition(crankRadius, connectingRodLength, theta):\n"
        "    return crankRadius*(1 - cos(theta)) + crankRadius**2*sin(theta)**2/(2*connectingRodLength)\n"
    )
    assert rows_of(tmp_path, {"a.py": text}) == []


def test_units_in_brackets_are_no_words(tmp_path):
    """An angular velocity in rad/s is no crank rad."""
    text = (
        "a = 0.04  % crank length (m)\nb = 0.12; % connecting rod length (m)\nc = 0.01; % vertical slider offset (m)\n"
        "omega2 = 10; % angular velocity of crank (rad/sec)\nfor i = 1:9\n  theta2 = i/9;\n"
        "  theta3 = asin((c - a*sin(theta2))/b);\n  d = a*cos(theta2) + b*cos(theta3);\n"
        "  ddot = -a*omega2*sin(theta2) {} a*omega2*cos(theta2)*tan(theta3);\nend\n"
    )
    pytest.importorskip("tree_sitter")
    place = tmp_path / "p.m"
    place.write_text(text.format("+"))
    (file,) = audited(place, NONE, [place])
    assert not file.rows and file.judged == 3


def test_a_number_in_the_place_of_a_letter_is_no_error(tmp_path):
    """A rod of one and a half strokes, beside formulas with the letter of the rod."""
    text = (
        "def place(bore, stroke, connecting_rod_length, theta):\n    crank_radius = stroke/2\n"
        "    s = crank_radius*cos(theta) + sqrt(connecting_rod_length**2 - (crank_radius*sin(theta))**2)\n"
        "    x = crank_radius + connecting_rod_length - s\n    return x\n"
        "def volume(bore, stroke, clearance_volume, theta):\n"
        "    return clearance_volume + pi*(bore/2)**2*(1.5*stroke + stroke/2 - (stroke/2*cos(theta)"
        " + sqrt((1.5*stroke)**2 - (stroke/2*sin(theta))**2)))\n"
    )
    assert rows_of(tmp_path, {"a.py": text}) == []


@pytest.mark.parametrize(("name", "text"), [
    ("a.cpp", "double pistonAcceleration(double theta, double crankRadius, double rodLength, double omega) {\n"
              "  double lambda = crankRadius/rodLength;\n"
              "  return crankRadius*omega*omega*(cos(theta) + lambda*cos(2*theta));\n}\n"),
    ("a.m", "function acceleration = piston(theta, crankRadius, rodLength, omega)\nlambda = crankRadius/rodLength;\n"
            "acceleration = crankRadius*omega^2*(cos(theta) + lambda*cos(2*theta));\nend\n"),
])  # fmt: skip
def test_words_of_python_are_letters_elsewhere(tmp_path, name, text):
    pytest.importorskip("tree_sitter")
    place = tmp_path / name
    place.write_text(text)
    (file,) = audited(place, NONE, [place])
    assert file.formulas == 2 and file.judged == 1 and not file.rows
    (tree,) = (c.tree for c in read_program(text, place.suffix).claims if c.name == "lambda")
    assert to_python(tree) == "crankRadius/rodLength"


def test_a_slip_is_told_beside_one_neighbour_that_agrees(tmp_path):
    right = (
        "def otto(T1, p1, compression_ratio, gamma):\n    T2 = T1*compression_ratio**(gamma - 1)\n"
        "    p2 = p1*compression_ratio**gamma\n    return T2, p2\n"
    )
    assert rows_of(tmp_path / "a", {"a.py": right}) == []
    (row,) = rows_of(tmp_path / "b", {"b.py": right.replace("(gamma - 1)", "(gamma + 1)")})
    assert row["verdict"] == "misprint" and row["claim"] in ("otto_cycle.T_2", "polytropic.T_2")
    assert rows_of(tmp_path / "c", {"c.py": right.replace("(gamma - 1)", "(gamma + 1)").replace("p2 =", "q =")}) == []


def test_each_function_has_names_of_its_own(tmp_path):
    """Pressure and radii under one name here and another there: what agrees in both is no slip in either."""
    text = (
        "def s_hoop(r, ri, ro, pin, pout):\n"
        '    """r: [m] radius; ri: [m] inner radius; ro: [m] outer radius; pin: [Pa] inside pressure"""\n'
        "    s_hoop = (pin*ri**2 - pout*ro**2)/(ro**2 - ri**2) - ri**2*ro**2*(pout - pin)/(r**2*(ro**2 - ri**2))\n"
        "    return s_hoop\n"
        "def stress_in_wall(P_internal, r_inner, r_outer):\n"
        "    return P_internal*(r_outer**2 + r_inner**2)/(r_outer**2 - r_inner**2)\n"
    )
    assert not rows_of(tmp_path, {"right.py": text})
    assert counts(list(audited(tmp_path, NONE, programs(tmp_path))))["judged"] == 2


def test_a_comment_is_read_without_its_unit():
    lexicon = Lexicon(named("offset_slider_crank"))
    assert (
        lexicon.meaning("w", "speed (rad/sec) of it")[1] == "phid" and lexicon.meaning("q", "crank (rad/sec)")[1] == ""
    )
    assert lexicon.meaning("q", "(crank radius)")[1] == "r"  # no unit
    assert (
        lexicon.meaning("q", "of the (connectingrodlengthofanenginethatisverylongandneverclosed" * 3)[1] == ""
    )  # at once
