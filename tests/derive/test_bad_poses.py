"""Slips of the hand in poses, watched points and numbers with units: one line with file, line and the way out."""

import pytest

from mechsym.derive.files import build
from mechsym.errors import BadInput

HEAD = """from mechsym.derive import *


def bad():
    m = Mechanism("bad")
    phi = m.coordinates("phi")
    r, l = m.parameters("r l", "m", above=0)
    M = m.parameters("M", "kg")
    T = m.inputs("T", "N*m")
    m.torque(T, along=phi)
    crank = m.link("crank", turns=phi, mass=M, centre=(r, 0))
    rod, rocker = m.link("rod", mass=M), m.link("rocker", mass=M)
    m.pin("O", m.frame, crank)
"""
JOINTS = """    m.pin("A", crank.at("100 mm"), rod)
    m.pin("D", m.frame.at("300 mm"), rocker)
    m.pin("B", rod.at("350 mm"), rocker.at("250 mm"))
"""
LINE = HEAD.count("\n") + 1
#: line of the declaration: what is told of it
SLIPS = {
    "m.pose(1)": "write pose(**places)",
    "m.pose(phi='1 m')": "pose of phi = '1 m' has the wrong dimension; give it in rad",
    "m.pose(phi=None)": "pose of phi = None is no number",
    "m.pose(phi=(1, 2))": "pose of phi = (1, 2) is no number",
    "m.pose(phi=190)": "the pose of phi = 190 is in rad; write degrees as '190 deg'",
    "m.pose(phi=1), m.pose(phi=2)": "the pose of phi is said twice; say it once",
    "m.pose(rod=M)": "pose of rod = M is no number",
    "m.pose(rod=True)": "pose of rod = True is no number",
    "m.pose(rod='')": "pose of rod = '' is not a number in rad",
    "m.pose(rod=[1])": "pose of rod = [1] is no number",
    "m.pose(rod=(1, 2, 3))": "pose of rod = (1, 2, 3) is no number",
    "m.pose(rod=('1 m', 'x'))": "pose of rod = 'x' is not a number in m",
    "m.pose(rod=float('inf'))": "pose of rod = inf is no number",
    "m.pose(rod='1 rad'), m.pose(rod='60 deg')": "the pose of rod is said twice",
    "m.pose(ro=1)": "which is no link and no coordinate of bad; there are phi, crank, rod, rocker",
    "m.pose(frame=1)": "the pose names 'frame', which is no link",
    "m.pose(phi=1, O=3)": "the pose names 'O', which is no link and no coordinate",
    "m.pose(crank=1)": "the pose of crank comes after its loop has closed; say it before the joints",
    "m.link('a', pose='left')": "pose of a = 'left' is not a number in rad",
    "m.link('a', pose=phi)": "pose of a = phi is no number",
    "m.link('a', pose=(1,))": "pose of a = (1,) is no number",
    "m.link('phi')": "the link 'phi' has the name of a coordinate (first at bad.py:6)",
    "m.link('frame')": "the link 'frame' is declared twice",
    "m.link('a', mass='')": "mass of a = '' is not a number in kg",
    "m.link('a', mass='-1 kg')": "mass of a = -1 kg is below zero",
    "m.link('a', mass=-1.5)": "mass of a = -1.5 is below zero",
    "m.link('a', mass='nan kg')": "is not a number in kg",
    "m.link('a', mass=float('inf'))": "mass of a = inf is no number",
    "m.link('a', mass={})": "is no expression",
    "m.link('a', inertia='1 kg')": "has the wrong dimension; give it in kg*m^2",
    "m.link('a', inertia=-0.1)": "inertia of a = -0.1 is below zero",
    "m.link('a', centre='0.1 m')": "is no pair; mechanisms are planar",
    "m.link('a', centre=('0.1 m', 'x'))": "centre of a = 'x' is not a number in m",
    "m.link('a', turns='90 deg')": "angle of a = '90 deg' is no expression",
    "crank.at('1 kg')": "point of crank = '1 kg' has the wrong dimension; give it in m",
    "crank.at(None)": "is no expression",
    "crank.at(0.1, 'x')": "point of crank = 'x' is not a number in m",
    "crank.at(float('nan'))": "point of crank = nan is no number",
    "crank.line(angle='90 m')": "line = '90 m' has the wrong dimension; give it in rad",
    "m.gear('G', crank, rod, radii=('1 m', '1 kg'))": "pitch radii of G = '1 kg' has the wrong dimension",
    "m.gear('G', crank, rod, radii=(0.1, -0.1))": "both must be above 0",
    "m.gear('G', crank, rod, radii=(r, r), inside=True)": "one radius for the ring and for what rolls in it, r",
    "m.gear('G', crank, rod)": "write gear(name, first, second, *, radii, inside=False)",
    "m.slider('S', crank.at(r), rod)": "crank.at(r, 0) is no link and no line of one",
    "m.slot('S', crank.at(r), rod.at(l))": "takes a line of one link and a point of the other",
    "m.slot('S', crank.line(), rod.line())": "takes a line of one link and a point of the other",
    "m.pin('A', crank.at(r), crank.at(l))": "the joint 'A' joins crank to itself; name two links",
    "m.pin('O', crank.at(r), rod)": "the joint 'O' has two owners (first at bad.py:13)",
    "m.watch(crank)": "write watch(point, name)",
    "m.watch(5, 'P')": "5 is no link and no point of one",
    "m.watch(crank.at(r), 5)": "'5_x' is not a usable name",
    "m.watch(crank.at(r), 'my point')": "'my point_x' is not a usable name",
    "m.watch((r, M), 'P')": "watched P = M is in kg, and must be in m",
    "m.watch((r, 0, 0), 'P')": "is no pair; mechanisms are planar",
    "m.watch(crank.at(r), 'P'), m.watch(crank.at(l), 'P')": "the name 'P_x' is taken (first at bad.py:14)",
    "m.weight('9.81', '1 kg')": "weight = '1 kg' has the wrong dimension; give it in m/s^2",
    "m.weight(phi, 0)": "weight = phi is in -, and must be in m/s^2",
    "m.parameters('k', 'm', default='1 kg')": "default of k = '1 kg' has the wrong dimension; give it in m",
    "m.parameters('k', 'm', above=True)": "above of k = True is no number",
    "m.parameters('k', 'm', abov=0)": "there are above, below, low, high, default, about",
    "m.spring('100 N/m', stretch=phi)": "stiffness = '100 N/m' has the wrong dimension; give it in N*m/rad",
    "m.damper(0.5, along=phi)": "write damper(damping, *, stretch)",
    "output(m, rod)": "output takes names of the declaration, and rod is none",
}
#: pose before joints of given lengths: what is told where the loop closes
MISFITS = {
    "rod=1.0": "the pose leaves phi open; say m.pose(phi=..), in rad",
    "phi=1.0, rod='200 deg', rocker='200 deg'": "rod and rocker at 26.6 deg, 74.5 deg (branch = 1) or -64.4 deg",
    "phi=1.0, rod=0.0, rocker=0.0": "the pose fits no solution at the joint 'B'",
    "phi=1.0, rod=(1, 1)": "rod at (0.054, 0.0841) m (branch = 1)",
}


@pytest.mark.parametrize("slip", SLIPS)
def test_a_slip_is_told_in_one_line(tmp_path, slip):
    path = tmp_path / "bad.py"
    path.write_text(f"{HEAD}    {slip}\n    return m\n")
    with pytest.raises(BadInput) as refused:
        build(path, "", "0" * 16)
    told = str(refused.value)
    assert told.startswith(f"bad.py:{LINE}: ") and SLIPS[slip] in told and "\n" not in told


@pytest.mark.parametrize("pose", MISFITS)
def test_a_pose_that_does_not_fit_is_told_where_the_loop_closes(tmp_path, pose):
    path = tmp_path / "bad.py"
    path.write_text(f"{HEAD}    m.pose({pose})\n{JOINTS}    return m\n")
    with pytest.raises(BadInput) as refused:
        build(path, "", "0" * 16)
    told = str(refused.value)
    assert told.startswith(f"bad.py:{LINE + 3}: ") and MISFITS[pose] in told and "\n" not in told


def test_numbers_with_units_are_taken_wherever_a_letter_is(tmp_path):
    path = tmp_path / "good.py"
    lines = ["k = m.parameters('k', 'm', above=0, default='10 mm')", "m.weight(0, -9.81)", "m.pose(phi=1, rod=0.5)"]
    path.write_text(HEAD + "".join(f"    {line}\n" for line in lines) + JOINTS + "    return m\n")
    _, listing = build(path, "", "0" * 16)
    assert listing["ranges"]["k"]["default"] == 0.01 and listing["ranges"]["weight_y"]["default"] == -9.81
    assert listing["parameters"]["weight_y"] == "m/s^2" and "weight_x" not in listing["parameters"]
