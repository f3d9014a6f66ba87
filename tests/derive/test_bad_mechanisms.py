"""Slips in mechanisms of one's own: one line with file, line, way out; of cams and laws listed before the code."""

import pytest

from mechsym.derive.files import build
from mechsym.errors import BadInput

HEAD = """from mechsym.derive import *


def bad():
    m = Mechanism("bad")
    phi = m.coordinates("phi")
    x = m.coordinates("x", "m")
    r, l = m.parameters("r l", "m", above=0)
    M, k = m.parameters("M", "kg"), m.parameters("k", "N/m")
    mu, N = m.parameters("mu", "-"), m.parameters("N", "N")
    T = m.inputs("T", "N*m")
    m.torque(T, along=phi)
    crank = m.link("crank", turns=phi, mass=M, centre=(r, 0), inertia="1 kg*m^2")
    m.pin("O", m.frame, crank)
    block = m.link("block", turns=phi, mass=M)
    m.pin("Q", crank.at(r), block)
    m.body("mass", mass=M, at=(x, 0))
"""
LINE = HEAD.count("\n") + 1
CAM = "m.cam('c', turns=phi, profile='cycloid', lift='5 mm', rise='90 deg', fall='90 deg', base='20 mm'"
#: line of the declaration: what is told of it
SLIPS = {
    # joints and links
    "m.pin('A', crank.at(r))": "write pin(",
    "m.pin('A', crank, crank.at(r))": "joins crank to itself",
    "m.pin('A', crank.at(r), rod)": "NameError: name 'rod' is not defined",
    "m.pin('A', 'crank', block)": "is no link and no point of one",
    "m.pin('O', crank.at(r), block)": "has two owners (first at bad.py:14)",
    "m.pin('A', crank.at(M), block)": "must be in m",
    "m.pin('A', crank.at(r, 0, 0), block)": "write at(",
    "m.pin('A', crank.at('10 kg'), block)": "has the wrong dimension; give it in m",
    "m.pin('A', crank.at(0.1, '20 x'), block)": "unit 'x' is not known",
    "m.pin('A', crank.at(r), block, branch=2)": "branch = 2 of the joint 'A' must be 1 or -1",
    "m.pin('', crank.at(r), block)": "is not a usable name",
    "m.slider('S', crank.at(r), block)": "is no link and no line of one",
    "m.slot('S', crank, block)": "takes a line of one link and a point of the other",
    "m.gear('G', crank, block, radii=(r, 0))": "both must be above 0",
    "m.gear('G', crank, block, radii=(r, r), inside=True)": "one radius for the ring",
    "m.gear('G', crank, block, radii='30 mm')": "is no pair",
    "m.link('crank')": "is declared twice",
    "m.link('x')": "has the name of a coordinate",
    "m.link('a b')": "is not a usable name",
    "m.link('rod', turns=x)": "must be in rad",
    "m.link('rod', turns=x / r, guess=0.1)": "leaves its guess without use",
    "m.link('rod', length=l)": "write link(",
    "m.lnk('rod')": "has no attribute 'lnk'",
    "m.pose(x='40 x')": "unit 'x' is not known",
    "m.pose(x='40 deg')": "has the wrong dimension; give it in m",
    "m.watch(crank.at(r), 'a b')": "is not a usable name",
    "m.watch(crank.at(r))": "write watch(",
    "m.watch((r, phi), 'P')": "must be in m",
    "m.coordinates('phi')": "the letter 'phi' is declared twice",
    "m.coordinates('phid')": "'phid' is the name of a rate of the coordinate 'phi'",
    "m.parameters('a', 'metre')": "metre",
    "m.parameters('a', 'mm')": "letters are in SI",
    "m.parameters('a', 'm', above=1, below=0)": "nothing is above 1 and below 0",
    "m.parameters('a', 'm', default='-1 mm', above=0)": "is outside its bounds",
    "m.parameters('a', 'm', minimum=0)": "minimum is no bound of a parameter",
    "m.parameters('lambda', 'm')": "has a meaning",
    # what acts
    "m.spring(k, stretch=phi)": "must be in N*m",
    "m.spring(k, stretch=l)": "moves with no coordinate",
    "m.spring(k)": "write spring(",
    "m.damper(mu, stretch=x)": "must be in N*s/m",
    "m.force(T, along=x)": "must be in N",
    "m.force_at((N, N, N), crank.at(r))": "is no pair",
    "m.weight(0, -9.81, 0)": "write weight(",
    "m.weight('9.81 m', 0)": "has the wrong dimension",
    "m.torque('2 N', along=phi)": "has the wrong dimension; give it in N*m",
    "m.body('mass', mass=M)": "the body 'mass' is declared twice",
    "m.body('b', mass=M * phi)": "changes with phi",
    "m.body('b', mass=-M)": "is below zero",
    "m.constraint('c', x - phi)": "adds",
    "m.constraint('c', r - l)": "moves with no coordinate",
    # unilateral
    "m.stop(x)": "takes restitution, or stiffness and damping",
    "m.stop(x, at=0.1, restitution='0.5 m')": "has the wrong dimension",
    "m.stop(crank, restitution=0)": "is no expression",
    "m.stop(x, restitution=1.5)": "at most 1",
    "m.contact('c', crank.at(r), block, restitution=0)": "give radii=(r1, r2), or a line",
    "m.contact('c', crank.at(r), m.frame.line(), radii=0.1, restitution=0)": "is no pair",
    "m.contact('c', crank.at(r), m.frame.line(), length=-0.1, radii=(r, 0), restitution=0)": "is below zero",
    "m.contact('c', crank.at(r), block.at(l), length=l, radii=(r, 0), restitution=0)": "has no length",
    "m.contact('c', crank.at(r), m.frame.line(), restitution=0.5, friction=mu)": "may gain energy",
    "m.backlash('b', x, angle='1 deg', restitution=0)": "has the wrong dimension; give it in m",
    "m.friction('B', mu=mu)": "names the joint 'B', which is none; there are O",
    "m.friction('O', mu=mu)": "give the radius at which it acts",
    "m.friction(x, mu=mu)": "is pressed by nothing",
    "m.friction(x, mu='0.1 N', normal=N)": "has the wrong dimension",
    "m.friction(x, mu=(mu,), normal=N)": "must be one value, or two",
    # cams
    CAM.replace("'cycloid'", "'cyclod'") + ", roller='5 mm')": "profile = 'cyclod' of the cam 'c' is no law",
    CAM.replace("'cycloid'", "'lift.csv'") + ", roller='5 mm')": "lift.csv",
    CAM.replace("'cycloid'", "phi") + ", roller='5 mm')": "profile = phi of the cam 'c'",
    CAM.replace("lift='5 mm', ", "") + ", roller='5 mm')": "needs lift, rise and fall",
    CAM.replace("rise='90 deg'", "rise='9 mm'") + ", roller='5 mm')": "has the wrong dimension; give it in rad",
    CAM.replace("rise='90 deg'", "rise=4.0, dwell=3.0") + ", roller='5 mm')": "together they are more than a turn",
    CAM.replace("rise='90 deg'", "rise=0.0") + ", roller='5 mm')": "must be above 0",
    CAM.replace("turns=phi", "turns=x") + ", roller='5 mm')": "must be in rad",
    CAM.replace("turns=phi", "turns=mu") + ", roller='5 mm')": "moves with no coordinate",
    CAM.replace(", base='20 mm'", "") + ", roller='5 mm')": "needs the radius of its base circle",
    CAM + ", follower='sharp')": "follower = 'sharp' of the cam 'c' is not known; there are knife, flat, roller",
    CAM + ", follower='roller')": "needs the radius of its roller",
    CAM + ", follower='knife', roller='5 mm')": "has no roller",
    CAM + ", follower='flat', offset='3 mm')": "has no offset",
    CAM + ", follower='knife', arm='50 mm')": "arm and centres",
    CAM + ", follower='knife', offset='30 mm')": "beyond its base circle",
    CAM + ", follower='knife', restitution=2)": "at most 1",
    CAM + ", follower='knife'), m.cam('c', turns=phi)": "write cam(",
    CAM + ", follower='knife'), " + CAM + ", follower='knife')": "is taken",
    # laws
    "m.gas_spring('g', x, pressure='2 bar', area='3 cm', length='0.1 m')": "has the wrong dimension; give it in m^2",
    "m.gas_spring('g', phi, pressure='2 bar', area='3 cm^2', length='0.1 m')": "must be in m",
    "m.belleville('b', x, outer='20 mm', inner='30 mm', height='1 mm', thickness='1 mm')": "inner is not below outer",
    "m.table_spring('t', x, file='missing.csv')": "missing.csv",
    "m.motor('E', x, k='0.1 N*m/A', R='2 ohm')": "must be in rad",
    "m.motor('E', phi, k='0.1 N*m/A')": "needs k and R, or a file",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("bad")


@pytest.mark.parametrize("line", SLIPS)
def test_a_slip_is_told_in_one_line(folder, line):
    file = folder / "bad.py"
    file.write_text(f"{HEAD}    {line}\n    return m\n")
    with pytest.raises(BadInput) as refused:
        build(file, "", "0" * 16)
    text = str(refused.value)
    assert SLIPS[line] in text
    assert text.startswith(f"bad.py:{LINE}:") and "\n" not in text
