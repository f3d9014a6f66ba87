"""Bad declarations are refused in one line with file and line."""

import pytest

from mechsym.derive import derive
from mechsym.derive.files import chosen
from mechsym.errors import BadInput

HEAD = """from sympy import Symbol
from mechsym.derive import Mechanism, cos, output, sin


def bad():
    m = Mechanism("bad")
    phi = m.coordinates("phi")
    r, l = m.parameters("r l", "m", above=0)
    M = m.parameters("M", "kg")
"""
LINK = '    crank = m.link("crank", turns=phi, mass=M, centre=(r, 0))\n    m.pin("O", m.frame, crank)\n'
CASES = {
    "unknown letter": ('    m.body("b", mass=M, at=(r * Symbol("q"), 0))\n', 10, "the letter 'q' is not declared"),
    "wrong unit": ('    m.body("b", mass=M, at=(phi**2 + sin(phi) * M, 0))\n', 10, "both must have one unit"),
    "mass in metres": ('    m.body("b", mass=r, at=(r * cos(phi), 0))\n', 10, "is in m, and must be in kg"),
    "torsion spring": ('    k = m.parameters("k", "N/m"); m.spring(k, stretch=phi)\n', 10, "must be in N*m/rad"),
    "open loop": (LINK + '    rod = m.link("rod", mass=M)\n    m.pin("A", crank.at(r), rod)\n', 13, "the loop is open"),
    "hanging link": (LINK + '    rod = m.link("rod", mass=M)\n', 12, "hangs on nothing"),
    "two owners": (LINK + '    m.pin("O", m.frame, crank)\n', 12, "has two owners (first at"),
    "held twice": (LINK + '    m.pin("P", m.frame.at(l), crank.at(r))\n', 12, "constraint(s) too many"),
    "cyclic": (
        '    m.let("a", Symbol("b", real=True) + r, "m")\n    m.let("b", Symbol("a", real=True), "m")\n',
        10,
        "'b'",
    ),
    "missing mass": ('    m.body("b", at=(r * cos(phi), 0))\n', 7, "nothing that moves with phi has a mass"),
    "declared twice": ('    m.parameters("r", "m")\n', 10, "is declared twice"),
    "unknown unit": ('    m.parameters("k", "N/furlong")\n', 10, "is not known"),
    "a word of Python": ('    m.parameters("lambda", "m")\n', 10, "write lambda_"),
    "another letter to Python": ('    m.parameters("\u2113", "m")\n', 10, "Python reads"),
    "name of a rate": ('    m.coordinates("phid")\n', 10, "is the name of a rate of the coordinate 'phi'"),
    "name of a rate, later": ('    m.inputs("qd", "N"); m.coordinates("q")\n', 10, "is the name of a rate"),
    "not finite": ('    m.body("b", mass=M, at=(r * cos(phi) / 0, 0))\n', 10, "is not finite"),
    "degrees in a cosine": (
        '    m.body("b", mass=M, at=(r * cos(phi + 120), 0))\n',
        10,
        "write degrees as 120 * pi / 180",
    ),
    "degrees of a spring": ("    m.spring(1.0, stretch=phi - 90)\n", 10, "write degrees as -90 * pi / 180"),
    "degrees of a line": ("    m.frame.line(angle=-90)\n", 10, "write degrees as -90 * pi / 180"),
    "leaves": ("    raise SystemExit(3)\n", 10, "SystemExit: 3"),
    "any error": ("    1 / 0\n", 10, "ZeroDivisionError"),
    "millimetres": ('    m.parameters("k", "mm")\n', 10, "'k' is in mm, and letters are in SI: write 'm'"),
    "degrees": ('    m.coordinates("psi", "deg")\n', 10, "letters are in SI: write 'rad or -'"),
    "no room": ('    m.parameters("k", "m", above=2, below=1)\n', 10, "nothing is above 2 and below 1"),
    "default outside": ('    m.parameters("k", "m", above=0, default=-1)\n', 10, "is outside its bounds"),
    "rounded": ('    m.body("b", mass=M, at=(r * cos(phi) / 2.5, 0))\n', 10, "holds the floating-point number 0.4"),
    "no name put out": (LINK + "    output(m, crank.at(r).x)\n", 12, "output takes names of the declaration"),
    "a text put out": ('    output(m, "x")\n', 10, "output takes names of the declaration, and x is none"),
    "name taken": ('    m.let("x", r)\n    m.let("x", l)\n', 11, "'x' is taken (first at bad.py:10)"),
    "force along a point": (LINK + "    m.force(M, along=crank.at(r))\n", 12, "crank.at(r, 0) is no expression"),
    "reaction of no joint": (
        LINK + '    m.guide("s", reaction="R_n_G", travel=r * sin(phi))\n',
        12,
        "no joint; there are R_x_O",
    ),
    "one reaction": (LINK + '    m.bearing("O", reactions="R_x_O", turns=phi)\n', 12, "takes two reactions"),
    "radius of what": (
        LINK + '    m.bearing("O", reactions=("R_x_O", "R_y_O"), turns=phi, radius=2 * r)\n',
        12,
        "no parameter in m",
    ),
    "turns by what": ('    m.rotor("s", angle=2 * phi)\n', 10, "turns by 2*phi, which is no coordinate; there are phi"),
    "travel is an angle": (
        '    F = m.inputs("F", "N"); m.piston("p", travel=phi, force=F)\n',
        10,
        "is in -, and must be in m",
    ),
    "drawn by what": ('    m.draw_circle((r, 0), "x")\n', 10, "= 'x' is no expression"),
    "drawn where": ("    m.draw_line((r, 0), phi)\n", 10, "phi is no link and no point of one"),
}


@pytest.mark.parametrize("kind", CASES)
def test_a_bad_declaration_is_refused_with_its_line(tmp_path, kind):
    body, line, message = CASES[kind]
    path = tmp_path / "bad.py"
    path.write_text(HEAD + body + "    return m\n")
    with pytest.raises(BadInput) as refused:
        derive(chosen(path))
    told = str(refused.value)
    assert told.startswith(f"bad.py:{line}: ") and message in told and "\n" not in told


def test_a_file_without_a_mechanism_is_refused(tmp_path):
    path = tmp_path / "none.py"
    path.write_text("def nothing():\n    return None\n")
    with pytest.raises(BadInput, match=r"none\.py:1: nothing\(\) returns nothing, no mechanism; end it with"):
        chosen(path)
    path.write_text("values = 3\n")
    with pytest.raises(BadInput, match="declares no mechanism"):
        chosen(path)


FOUR = """from mechsym.derive import Mechanism
import math


def four():
    m = Mechanism("four")
    phi = m.coordinates("phi")
    crank = m.link("crank", turns=phi, inertia="0.1 kg*m^2", pose="40 deg")
    rod = m.link("rod", mass="1 kg", centre=("0.17 m", 0), inertia=0.01, pose="20 deg")
    rocker = m.link("rocker", mass="1 kg", centre=("0.12 m", 0), inertia=0.01, pose="80 deg")
    m.pin("A", m.frame, crank)
    m.pin("B", crank.at("100 mm"), rod)
    m.pin("D", m.frame.at("300 mm"), rocker)
    m.pin("C", rod.at("350 mm"), rocker.at("250 mm"))
    m.torque(m.inputs("M", "N*m"), along=phi)
    return m
"""


def test_a_whole_number_is_a_number(tmp_path):
    path = tmp_path / "four.py"
    words = {
        'mass="1 kg"': "mass=1",
        '"300 mm"': "1",
        '"350 mm"': "1",
        '"250 mm"': "1",
        "along=phi)\n": "along=phi)\n    m.weight(0, -10)\n",
    }
    text = FOUR
    for old, new in words.items():
        text = text.replace(old, new)
    path.write_text(text)
    declared = chosen(path)
    assert derive(declared) and declared.ranges["weight_y"]["default"] == -10


@pytest.mark.parametrize(
    ("words", "instead", "line", "message"),
    [
        ('m.pin("A", m.frame, crank)', 'm.slider("A", m.frame, crank)', 11, "holds phi, which is to move freely"),
        ('pose="40 deg"', 'pose="40"', 8, "write degrees as"),
        ('coordinates("phi")', 'coordinates("t")', 7, "'t' is the time"),
        ("turns=phi", "turns=math.sin(phi)", 8, "sin, cos, sqrt and pi from mechsym.derive"),
        ("turns=phi", "turn=phi", 8, "link() got an unexpected keyword argument 'turn'; write link(name"),
        ("return m", "return phi", 5, "four() returns a Symbol, no mechanism"),
    ],
)
def test_a_slip_in_a_linkage_is_refused_with_its_line(tmp_path, words, instead, line, message):
    path = tmp_path / "four.py"
    path.write_text(FOUR.replace(words, instead, 1))
    with pytest.raises(BadInput) as refused:
        derive(chosen(path))
    assert str(refused.value).startswith(f"four.py:{line}: ") and message in str(refused.value)


def test_what_a_file_prints_is_no_result(tmp_path, capsys):
    path = tmp_path / "loud.py"
    path.write_text("print('read')\n" + HEAD + LINK + "    print('made')\n    return m\n")
    chosen(path)
    assert capsys.readouterr().out == ""
