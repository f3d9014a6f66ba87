"""Slips of the hand in declarations: each ends in one line with file, line, what is wrong and the way out."""

import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym
from mechsym.derive.files import build
from mechsym.errors import BadInput

HEAD = """from sympy import Derivative, Function, I, Symbol, gamma
from mechsym.derive import *


def bad():
    m, other = Mechanism("bad"), Mechanism("other")
    phi = m.coordinates("phi")
    r, l, b = m.parameters("r l b", "m", above=0)
    M, k = m.parameters("M", "kg"), m.parameters("k", "N*m/rad")
    F, T = m.inputs("F", "N"), m.inputs("T", "N*m")
    crank = m.link("crank", turns=phi, mass=M, centre=(r, 0))
    m.pin("O", m.frame, crank)
    rod, rocker = m.link("rod", mass=M), m.link("rocker", mass=M)
    m.pin("B", crank.at(r), rod)
    m.pin("D", m.frame.at(l), rocker)
    x = m.let("x", r * cos(phi), "m")
"""
CLOSED = '    m.pin("C", rod.at(l), rocker.at(b))\n'
#: line of the declaration: what is told of it
SLIPS = {
    "m.link(5)": "5 is not a usable name",
    "m.link('my rod', mass=M)": "'my rod' is not a usable name",
    "m.link('a', mass='heavy')": "mass of a = 'heavy' is not a number in kg",
    "m.link('a', mass='2 m')": "has the wrong dimension; give it in kg",
    "m.link('a', mass=None)": "mass of a = None is no expression",
    "m.link('a', mass=[M])": "is no expression",
    "m.link('a', mass=True)": "mass of a = True is no expression",
    "m.link('a', mass=M > 2)": "is no expression",
    "m.link('a', mass=I * M)": "'ImaginaryUnit' in I*M has no CasADi counterpart",
    "m.link('a', mass=-M)": "mass of a = -M is below zero; write it with the other sign",
    "m.link('a', inertia=-3 * M * r**2 / 2)": "inertia of a = -3*M*r**2/2 is below zero",
    "m.link('a', mass=M * cos(phi))": "mass of a = M*cos(phi) changes with phi; that of a rigid body does not",
    "m.body('p', mass=M * x / r, at=(x, 0))": "mass of p = M*x/r changes with x",
    "m.link('a', mass=M, centre=r)": "is no pair; mechanisms are planar",
    "m.link('a', mass=M, centre=(r, 0, 0))": "is no pair; mechanisms are planar",
    "m.link('a', mass=M, centre=None)": "is no pair",
    "m.link('a', turns=Symbol('phi'))": "'phi' is not the letter of that name",
    "m.link('a', guess='left')": "guess of a = 'left' is no number",
    "m.link('a', guess=phi)": "guess of a = phi is no number",
    "m.link('a', guess=float('nan'))": "is no number",
    "m.link('a', turns=phi, guess=1)": "leaves its guess without use",
    "m.link('a', length=r)": "write link(name, *, turns=None, mass=0, centre=(0, 0), inertia=0, guess=None, pose=None)",
    "m.pin('A', crank)": "write pin(name, first, second, *, branch=0)",
    "m.pin('A', m.frame, 3)": "3 is no link and no point of one",
    "m.pin('A', (r, 0), crank)": "is no link and no point of one",
    "m.pin(3, rod.at(l), rocker.at(b))": "3 is not a usable name",
    "m.pin('C', rod.at(l), rocker.at(b), branch=None)": "must be 1 or -1",
    "m.pin('C', rod.at(l), other.frame)": "takes frame.at(0, 0) of other; name links of bad",
    "crank.at(r, 0, 0)": "write at(u=0, v=0)",
    "crank.angel": "did you mean 'angle'?",
    "m.pinn('A', crank, rod)": "did you mean 'pin'?",
    "m.gear('T', crank.at(), rocker.at(), radii=r)": "is no pair",
    "m.gear('T', crank.at(), rocker.at(), radii=(r, 0))": "both must be above 0",
    "m.gear('T', crank.at(), rocker.at(), radii=(r, l), inside='yes')": "must be True or False",
    "m.let('sin_phi', r, 'm')": "the name 'sin_phi' is taken",
    "m.let('q', None)": "q = None is no expression",
    "m.let(3, phi)": "3 is not a usable name",
    "m.let('q', (r, l), 'm')": "is no expression",
    "m.let('q', r, 5)": "the unit 5 is no text",
    "reaction(m, 'x_O')": "'x_O' is no joint displacement of bad; there are sx_O",
    "reaction(m, phi)": "phi is no joint displacement of bad",
    "velocity(m, None)": "what moves = None is no expression",
    "velocity(phi, x)": "phi is no mechanism; write velocity(m, x)",
    "acceleration(m, crank)": "crank is no expression",
    "m.body('p', mass=M, at=(x, 0, 0))": "is no pair; mechanisms are planar",
    "m.body('p', mass=M, at=x)": "is no pair",
    "m.body('p', mass=M, at=(x, 0)), m.body('p', mass=M, at=(0, x))": "the body 'p' is declared twice",
    "m.body('p', turns=phi, inertia=M * r**2, inertia_about_axis=M * r**2)": "has two inertias",
    "m.coordinates(['u', 'v'])": "write names divided by spaces",
    "m.coordinates('u, v')": "'u,' is not a usable name",
    "m.coordinates('u', None)": "the unit None is no text",
    "m.parameters('q', 'm', above='zero')": "above of q = 'zero' is not a number in m",
    "m.parameters('q', 'm', default=float('nan'))": "default of q = nan is no number",
    "m.force(F, along=None)": "displacement = None is no expression",
    "m.torque(T, along=3)": "displacement = 3 moves with no coordinate; there are phi",
    "m.force_at((F, 0, 0), crank.at(r))": "is no pair",
    "m.force_at((F, 0), None)": "None is no link and no point of one",
    "m.weight(None, 0)": "weight = None is no expression",
    "m.constraint('c', 0)": "moves with no coordinate",
    "m.constraint('c', (x, x, x))": "is no pair",
    "m.joints('p q', 'a on b', reactions='R_x')": "'R_x' names 1: name each",
    "output(m, phi, order=3)": "derivatives of order 0, 1 or 2",
    "output(phi)": "phi is no mechanism; write output(m, x, order=2)",
    "output_dynamic(m, 'q', F, 'm')": "is in N, and must be in m",
    "output_dynamic(m, 'R_x_O', F, 'N')": "the name 'R_x_O' is taken",
    "m.piston('p', travel=r, force=F)": "travel_p = r moves with no coordinate",
    "m.piston('p', travel=x, force=T)": "takes T, which is no input in N; there are F",
    "m.piston('p', travel=x, force=F, fires='pi')": "fires of p = 'pi' is no number",
    "m.piston('p', travel=x, force=F, fires=180)": "is beyond two turns; it is in rad: 180 deg are pi",
    "m.piston('p', travel=x, force=F, masses=(M, M))": "a mass of the piston 'p' is named twice: M, M",
    "m.piston('my piston', travel=x, force=F)": "is not a usable name",
    "m.piston('p', travel=x, force=F), m.piston('q', travel=-x, force=F)": "'p' and 'q' are pushed by one input, F",
    "m.rotor('', angle=phi, load=T)": "'' is not a usable name",
    "m.rotor('s', angle=phi, load=T, drive=T)": "T drives the rotor 's' and is its load",
    "m.rotor('s', angle=phi, load=T), m.rotor('t', angle=phi, drive=T)": "the rotors 's' and 't' take one input, T",
    "m.bearing('O', reactions=('R_x_O', 'R_x_O'), turns=phi)": "the bearing 'O' takes two reactions",
    "m.teeth('t', force='R_t_T', radius=M)": "M is no parameter in m",
    "m.gear('T', crank.at(), rocker.at(), radii=(-r, l))": "both must be above 0",
    "Mechanism('my press')": "'my press' is not a usable name of a mechanism",
    "Mechanism('class')": "'class' is not a usable name of a mechanism",
    "m.rotor('s', angle=phi, load=F)": "takes F, which is no input in N*m; there are T",
    "m.draw_line((r, 0))": "two points or more, and 1 is named",
    "m.draw_line((r, 0, 0), (0, 0))": "is no pair",
    "m.angle('beta', 2)": "sine of beta = 2 is that of no angle",
    "given_equations(m, [[M]], [0, 0], [0])": "1 coordinates have 1 equations",
    "m.torque(Piecewise((T, phi > 0)), along=phi)": "has no value where no condition holds; end it with (value, True)",
    "m.torque(T * gamma(phi), along=phi)": "'gamma' in T*gamma(phi) has no CasADi counterpart",
    "m.torque(T * Derivative(Function('f')(phi), phi), along=phi)": "has no CasADi counterpart",
}


#: role that takes a reaction of what is not of its kind: what is told of it
STRANGERS = {
    "m.bearing('b', reactions=('R_x_B', 'R_y_D'), turns=phi)": "takes reactions of two joints, B and D",
    "m.guide('g', reaction='R_x_B', travel=x)": "is the reaction of a pin; name that of a slider or slot",
    "m.teeth('t', force='R_y_B', radius=r)": "is the reaction of a pin; name that of a gear",
}


@pytest.mark.parametrize("role", STRANGERS)
def test_a_role_takes_the_reaction_of_a_joint_of_its_kind(tmp_path, role):
    path = tmp_path / "bad.py"
    path.write_text(f"{HEAD}{CLOSED}    m.torque(T, along=phi)\n    {role}\n    return m\n")
    with pytest.raises(BadInput, match=r"bad\.py:\d+: ") as refused:
        build(path, "", "0" * 16)
    assert STRANGERS[role] in str(refused.value)


def test_a_slider_that_holds_a_held_turn_is_told(tmp_path):
    path = tmp_path / "bad.py"
    lines = ["p = m.link('p', mass=M, turns=0)", "m.pin('P', rod.at(l), p)", "m.slider('G', m.frame.line(), p.line())"]
    path.write_text(HEAD + CLOSED + "".join(f"    {line}\n" for line in [*lines, "return m"]))
    with pytest.raises(
        BadInput, match="the slider 'G' holds the turn of frame and p in one another, which is held already"
    ):
        build(path, "", "0" * 16)


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_is_told_in_one_line(tmp_path, slip):
    path = tmp_path / "bad.py"
    path.write_text(f"{HEAD}    {slip}\n    return m\n")
    with pytest.raises(BadInput) as refused:
        build(path, "", "0" * 16)
    told = str(refused.value)
    assert told.startswith(f"bad.py:{HEAD.count(chr(10)) + 1}: ") and SLIPS[slip] in told and "\n" not in told


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (
            f"{HEAD}{CLOSED}    m.let('angle_rod', 2 * rod.angle)\n    return m\n",
            "the name 'angle_rod' is taken (first at",
        ),
        ("from mechsym.derive import Mechanism\n\nm = Mechanism(5)\n", "bad.py:3: 5 names no mechanism"),
        (
            "from mechsym.derive import Mechanism\n\nm = Mechanism()\n",
            "write Mechanism(name, source='own', about='', *, space=2)",
        ),
        ("a = '\0'\n", "bad.py: SyntaxError: source code string cannot contain null bytes"),
        ("", "declares no mechanism; write a function that makes one and returns it"),
    ],
    ids=["name taken", "number as name", "no name", "null byte", "empty"],
)
def test_files_are_refused_in_one_line_by_the_command(tmp_path, text, told):
    path = tmp_path / "bad.py"
    path.write_text(text)
    error = CliRunner().invoke(mechsym, ["derive", str(path)]).exception
    assert isinstance(error, BadInput) and told in str(error) and "\n" not in str(error)


def test_slopes_carry_the_name_of_their_output(tmp_path):
    path = tmp_path / "named.py"
    lines = [
        "p = m.let('p', x, 'm')",
        "n = m.let('n', -x, 'm')",
        "s = m.let('s', r * phi, 'm')",
        "output(m, p, n, s, order=2)",
    ]
    path.write_text(HEAD + CLOSED + "".join(f"    {line}\n" for line in lines) + "    return m\n")
    _, listing = build(path, "", "0" * 16)
    units = {n: u for n, u in listing["outputs"].items() if not n.startswith(("R_", "inertia", "dinertia"))}
    slopes = {f"d{n}_dphi": "m/rad" for n in "pns"} | {f"d2{n}_dphi2": "m/(rad*rad)" for n in "pn"}
    assert units == {"p": "m", "n": "m", "s": "m", **slopes}
