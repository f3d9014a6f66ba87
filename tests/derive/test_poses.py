"""A rough pose chooses the side of every loop, whatever closes it; numbers with units make letters."""

from math import atan2, cos, sin, sqrt

import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from mechsym.derive import Mechanism, derive, velocity
from mechsym.derive.files import build, explained
from mechsym.errors import BadInput

SIZES = {"a": 0.1, "b": 0.35, "c": 0.25, "d": 0.3}


def started(sizes=SIZES):
    m = Mechanism("posed")
    phi = m.coordinates("phi")
    letters = [m.parameters(n, "m", above=0, **({"default": v} if sizes else {})) for n, v in (sizes or SIZES).items()]
    crank = m.link("crank", turns=phi, inertia=m.parameters("I", "kg*m^2", above=0))
    m.pin("O", m.frame, crank)
    return m, crank, letters


def fourbar(sizes=SIZES, branch=0, **pose):
    m, crank, (a, b, c, d) = started(sizes)
    rod, rocker = m.link("rod"), m.link("rocker")
    m.pose(**pose)
    m.pin("B", crank.at(a), rod)
    m.pin("D", m.frame.at(d), rocker)
    m.pin("C", rod.at(b), rocker.at(c), branch=branch)
    return m


def closed(phi, side, a=0.1, b=0.35, c=0.25, d=0.3):
    """Angles of rod and rocker, by the intersection of two circles."""
    bx, by = a * cos(phi), a * sin(phi)
    wx, wy = d - bx, -by
    square = wx * wx + wy * wy
    share = (1 + (b * b - c * c) / square) / 2
    high = side * sqrt(b * b / square - share**2)
    x, y = bx + share * wx - high * wy, by + share * wy + high * wx
    return atan2(y - by, x - bx), atan2(y, x - d)


@settings(max_examples=12, deadline=None)
@given(
    phi=some.floats(-3, 3),
    side=some.sampled_from([-1, 1]),
    off=some.tuples(*[some.floats(-0.3, 0.3)] * 2),
    sized=some.booleans(),
)
def test_a_pose_that_is_off_by_a_third_of_a_radian_chooses_its_side(phi, side, off, sized):
    rod, rocker = (angle + slip for angle, slip in zip(closed(phi, side), off, strict=True))
    try:
        m = fourbar(SIZES if sized else None, phi=phi, rod=rod, rocker=rocker)
    except BadInput as refused:  # near the flat pose, where no length is known
        assert not sized and abs(sin(rod - rocker)) < 0.6 and "hangs on lengths" in str(refused)
    else:
        assert [(s.branch, s.by) for s in m.sides] == [(side, "pose")]


@pytest.mark.parametrize("side", [1, -1])
def test_equations_by_a_pose_are_those_by_the_branch(side):
    rod, rocker = closed(1.0, side)
    posed, named = fourbar(phi=1.0, rod=rod), fourbar(branch=side)
    assert posed.tape.entries == named.tape.entries
    letter = posed.links[1].turns
    assert velocity(posed, letter) == velocity(named, letter)
    assert fourbar(phi="57 deg", rocker=f"{rocker} rad").sides[0].branch == side


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("lengths", [SIZES, None], ids=["sizes", "letters"])
def test_the_piston_stands_where_the_pose_has_its_rod(side, lengths):
    m, crank, (a, b, _, _) = started(lengths)
    rod, piston = m.link("rod"), m.link("piston")
    m.pose(phi=0.5, rod=0.1 if side == 1 else 3.0)
    m.pin("A", crank.at(a), rod)
    m.slider("G", m.frame, piston)
    m.pin("P", rod.at(b), piston)
    assert m.sides[0].branch == side


@pytest.mark.parametrize("side", [1, -1])
def test_a_slot_takes_the_end_that_the_pose_names(side):
    m, crank, (a, _, _, d) = started()
    rocker = m.link("rocker")
    away = atan2(0.1 * sin(1.0) + 0.3, 0.1 * cos(1.0))
    m.pose(phi=1.0, rocker=away + (0.2 if side == 1 else 3.0))
    m.pin("D", m.frame.at(0, -d), rocker)
    m.slot("S", rocker.line(), crank.at(a))
    assert m.sides[0].branch == side


def test_a_place_chooses_as_an_angle_does():
    m, crank, (a, b, _, _) = started()
    rod, piston = m.link("rod"), m.link("piston")
    m.pose(phi=0.5, piston=("-250 mm", 0.0))
    m.pin("A", crank.at(a), rod)
    m.slider("G", m.frame, piston)
    m.pin("P", rod.at(b), piston)
    assert m.sides[0].branch == -1


@pytest.mark.parametrize(
    "pose, words",
    [
        ({"rod": 0.5}, "leaves phi open"),
        ({"phi": 1.0, "rod": 3.0}, r"fits no solution at the joint 'C': rod at 26\.6 deg \(branch = 1\) or -64\."),
        ({"phi": 0.0, "rod": 0.0}, "fits both solutions"),
        ({"phi": 1.0, "rod": (0.05, 0.08)}, "fits both solutions"),
        ({"phi": 1.0, "rood": 1.0}, "no link and no coordinate of posed; there are phi, crank, rod, rocker"),
        ({"phi": 1.0, "rod": "12 mm"}, "pose of rod = '12 mm' has the wrong dimension"),
    ],
)
def test_a_pose_that_says_too_little_or_another_mechanism_is_refused(pose, words):
    with pytest.raises(BadInput, match=rf"test_poses.py:\d+: .*{words}"):
        fourbar(**pose)


def test_lengths_that_do_not_reach_are_no_side():
    with pytest.raises(BadInput, match="does not close at the joint 'C' in the pose"):
        fourbar({**SIZES, "d": 0.9}, phi=1.0, rod=0.5)


def test_a_pose_is_the_guess_where_a_loop_closes_by_constraint():
    m, crank, (a, b, _, _) = started()
    rod = m.link("rod", pose=0.7)
    m.pin("A", crank.at(a), rod)
    rod.settle()
    assert m.guesses == {"theta_rod": 0.7}
    with pytest.raises(BadInput, match="comes after its loop has closed"):
        m.pose(rod=1.0)


def test_sizes_with_units_are_letters_with_values():
    m = Mechanism("sized")
    phi = m.coordinates("phi")
    crank = m.link("crank", turns=phi, mass="1.4 kg", inertia=0.0021, centre=("20 mm", 0))
    m.pin("O", m.frame, crank)
    one, other, again = crank.at("150 mm"), crank.at("0.2 m"), crank.at(0.15)
    assert (one.u, again.u) == (again.u, one.u)
    assert str(other.u) == "crank_u2"
    equations = derive(m)
    assert {k: v["default"] for k, v in m.ranges.items()} == {
        "crank_mass": 1.4, "crank_inertia": 0.0021, "crank_centre_u": 0.02, "crank_u": 0.15, "crank_u2": 0.2
    }  # fmt: skip
    I, mass, u = (s for n in ("inertia", "mass", "centre_u") for s in m.parameter_list if s.name == f"crank_{n}")
    assert m.tape.flat(equations.mass_matrix[0][0] - I - mass * u**2).simplify() == 0
    with pytest.raises(BadInput, match="below zero"):
        m.link("weight", mass="-2 kg")


def test_letters_of_the_declaration_go_before_those_of_joints():
    m = Mechanism("clash")
    phi = m.coordinates("phi")
    x_A, R_x_A, angle_rod = m.parameters("x_A R_x_A angle_rod", "m")
    crank, rod, piston = (
        m.link("crank", turns=phi, inertia=m.parameters("J", "kg*m^2")),
        m.link("rod"),
        m.link("piston"),
    )
    m.pin("O", m.frame, crank)
    m.pin("A", crank.at(x_A), rod)
    m.slider("G", m.frame, piston)
    m.pin("P", rod.at(angle_rod), piston)
    reactions = [s.name for s in derive(m).mechanism.reaction_of.values()]
    assert "R_x_A_" in reactions and R_x_A in m.parameter_list
    assert m.let("slide_of_piston", m.links[2].origin[0], "m") is not None


WATCHED = """from mechsym.derive import Mechanism


def crank():
    m = Mechanism("crank")
    phi = m.coordinates("phi")
    body = m.link("body", turns=phi, mass="1 kg", inertia=1.0)
    m.pin("O", m.frame, body)
    m.watch(body.at("0.2 m"), "P")
    return m
"""


def test_a_watched_point_moves_under_its_own_name(tmp_path):
    import casadi as ca

    (tmp_path / "crank.py").write_text(WATCHED)
    code, listing = build(tmp_path / "crank.py", "", "0" * 16)
    assert {"P_x": "m", "dP_y_dphi": "m/rad", "P_x_d": "m/s", "P_y_dd": "m/s^2"}.items() <= listing["outputs"].items()
    space = {"ca": ca}
    exec(code, space)
    names, outputs = space["FUNCTIONS"]["reactions"]
    given = {"phi": 0.7, "phid": 3.0, "phidd": -2.0, "body_mass": 1.0, "body_inertia": 1.0, "body_u": 0.2}
    found = dict(zip(outputs, space["reactions"](*(given[n] for n in names)), strict=True))
    assert float(found["P_x_dd"]) == pytest.approx(0.2 * (2.0 * sin(0.7) - 9.0 * cos(0.7)))
    assert float(found["P_y_d"]) == pytest.approx(0.6 * cos(0.7))


def test_the_way_of_closing_is_explained(tmp_path):
    text = WATCHED.replace("    return m\n", """    rod, piston = m.link("rod"), m.link("piston")
    m.pin("A", body.at("0.1 m"), rod)
    m.slider("G", m.frame, piston)
    m.pin("B", rod.at("0.3 m"), piston)
    return m
""")  # fmt: skip
    (tmp_path / "crank.py").write_text(text)
    (line,) = explained(tmp_path / "crank.py", "")
    assert line.startswith("rod and piston close at the joint B, branch = 1 (chosen by nobody")
