"""Drawings are to scale: lengths stay, pistons move as the mechanism says, every mechanism has one."""

import json
import math
import re

import numpy as np
import pytest

from mechsym import cases, mechanisms
from mechsym.errors import BadInput
from mechsym.mechanisms.crank_throw import CrankThrowParameters
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters
from mechsym.mechanisms.drawing import Circle, Line, extent_of, shapes
from mechsym.mechanisms.plots import animation, figure
from mechsym.mechanisms.record import curves

OF_CASES = {
    "crosshead": "moroianu",
    "hypocycloid": "nunes-hypocycloid",
    "rodless": "balandin",
    "crank_train": "opposed-pistons",
    "crankshaft_flywheel": "chmielewski",
}
ANGLES = (0.0, 0.8, 2.5, 4.0)


def parameters(mechanism):
    if mechanism == "crank_throw":
        data = {"m_rod": 1, "m_piston": 1, "I_rod": 0.01, "I0": 0.1}
        return CrankThrowParameters(r=0.05, l1=0.05, l2=0.12, offset=0.01, **data)
    return cases.load(OF_CASES[mechanism]).need("parameters")


def lengths(found, role):
    for shape in found:
        if isinstance(shape, Line) and shape.role == role:
            yield [math.dist(a, b) for a, b in zip(shape.points, shape.points[1:], strict=False)]


@pytest.mark.parametrize("mechanism", [*OF_CASES, "crank_throw"])
@pytest.mark.parametrize("role", ["crank", "rod", "planet", "piston"])
def test_links_keep_their_lengths(mechanism, role):
    first, *rest = ([*lengths(shapes(mechanism, parameters(mechanism), a), role)] for a in ANGLES)
    for other in rest:
        for a, b in zip(first, other, strict=True):
            assert a == pytest.approx(b, rel=1e-9)


def piston_place(found):
    boxes = [s for s in found if isinstance(s, Line) and s.role == "piston" and s.points[0] == s.points[-1]]
    return [np.mean(box.points[:-1], axis=0) for box in boxes]


@pytest.mark.parametrize("mechanism", ["crosshead", "hypocycloid", "crank_throw", "crankshaft_flywheel"])
def test_the_piston_moves_as_derived(mechanism):
    p = parameters(mechanism)
    if mechanism == "crankshaft_flywheel":
        kinematics = mechanisms.build(mechanism, p).functions["kinematics"]
        travel = [float(kinematics(phi0=a, phi2=a)["x0"]) for a in ANGLES]
    else:
        travel = curves(mechanisms.build(mechanism, p), np.array(ANGLES))["x"]
    places = [piston_place(shapes(mechanism, p, a))[-1][0] for a in ANGLES]
    assert np.array(places[0]) - places == pytest.approx(np.array(travel) - travel[0], abs=1e-12)


def test_rodless_sliders_move_as_derived():
    p = parameters("rodless")
    found = curves(mechanisms.build("rodless", p), np.array(ANGLES))
    for angle, a, b in zip(ANGLES, found["x_a"], found["x_b"], strict=True):
        joints = [s.centre for s in shapes("rodless", p, angle) if isinstance(s, Circle) and s.role == "joint"]
        assert any(math.dist(c, (a, 0)) < 1e-12 for c in joints)
        assert any(math.dist(c, (0, b)) < 1e-12 for c in joints)


def test_the_planet_touches_the_ring():
    p = parameters("hypocycloid")
    for angle in ANGLES:
        circles = {s.role: s for s in shapes("hypocycloid", p, angle) if isinstance(s, Circle)}
        ring, planet = circles["frame"], circles["planet"]
        assert math.dist(ring.centre, planet.centre) + planet.radius == pytest.approx(ring.radius, rel=1e-12)


def test_opposed_pistons_meet_in_the_middle():
    places = piston_place(shapes("crank_train", parameters("crank_train"), 0.0))
    middle = 0.5 * parameters("crank_train").axis_x[1]
    assert places[0][0] < middle < places[1][0]
    assert places[0][0] + places[1][0] == pytest.approx(2 * middle, rel=1e-12)


@pytest.mark.parametrize("mechanism", OF_CASES)
def test_pictures_and_pages_are_made(mechanism):
    p = parameters(mechanism)
    left, right, low, high = extent_of(lambda angle: shapes(mechanism, p, angle))
    assert right > left and high > low
    assert figure(mechanism, p, 0.8).axes
    page = animation(mechanism, p, "A <title>")
    (drawn,) = json.loads(re.search(r"const scenes = (.*?), readouts", page)[1])
    moving = [shape for shape in drawn["shapes"] if shape["moves"]]
    wide = [2 if shape["shifts"] else len(shape["at"]) for shape in moving]
    assert {len(shape["moves"]) // n for shape, n in zip(moving, wide, strict=True)} == {120}
    assert "A &lt;title&gt;" in page
    assert {"crank", "piston"} <= {shape["role"] for shape in moving}


def test_every_mechanism_has_a_drawing_and_others_are_refused():
    for name in mechanisms.names():
        known = {"rodless_constraints": "rodless", "crankshaft_flywheel_printed": "crankshaft_flywheel"}.get(name, name)
        assert shapes(name, parameters(known), 0.3)
    with pytest.raises(BadInput, match="no drawing"):
        shapes("clock", None, 0.0)


def train(cylinders, bank=0.0, **more):
    data = {"m_rod": 0.5, "m_piston": 0.5, "I_rod": 1e-3, "I0": 0.01, "I_f": 0.1, "k": 1e5}
    phase = tuple(2 * math.pi * k / cylinders for k in range(cylinders))
    throws = tuple(range(1, cylinders + 1))
    return CrankTrainParameters(throw=throws, phase=phase, bank=bank, r=0.043, l1=0.05, l2=0.1, **data, **more)


def overlapping(boxes):
    edges = [np.array([box.min(axis=0), box.max(axis=0)]) for box in boxes]
    return [(a, b) for i, a in enumerate(edges) for b in edges[:i] if np.all(a[0] < b[1]) and np.all(b[0] < a[1])]


@pytest.mark.parametrize("bank", [0.0, (0.5, -0.5) * 3])
@pytest.mark.parametrize("z", [0.0, tuple(0.12 * k for k in range(6))])
def test_pistons_of_a_train_do_not_hide_each_other(bank, z):
    for angle in ANGLES:
        found = shapes("crank_train", train(6, bank, z=z), angle, 0.086)
        boxes = [s for s in found if isinstance(s, Line) and s.role == "piston"]
        upright = [np.array(s.points) for s in boxes if s.points[0][1] == s.points[1][1]]
        assert len(boxes) == 6 + (1 if bank == 0.0 else 2) and not overlapping(upright)


def test_pistons_along_the_shaft_stand_as_high_as_at_the_end():
    p = train(6)
    for angle in ANGLES:
        boxes = piston_place(shapes("crank_train", p, angle, 0.086))
        own = [angle + phase for phase in p.phase]
        wanted = [0.043 * math.cos(a) + math.sqrt(0.15**2 - (0.043 * math.sin(a)) ** 2) for a in own]
        assert np.array(boxes[1:])[:, 1] - 0.06 * 0.086 == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize("mechanism", ["crosshead", "hypocycloid", "crank_throw", "crankshaft_flywheel"])
def test_a_bore_is_to_scale(mechanism):
    boxes = [s for s in shapes(mechanism, parameters(mechanism), 0.8, 0.123) if s.role == "piston"]
    assert np.ptp(np.array(boxes[-1].points)[:, 1]) == pytest.approx(0.123)


@pytest.mark.parametrize("case", ["moroianu", "zotov-89"])
def test_the_crosshead_stays_out_of_the_cylinder(case):
    for angle in np.linspace(0, 2 * math.pi, 25):
        found = shapes("crosshead", cases.load(case).need("parameters"), angle, 0.5)
        head, *_, top = (np.array(s.points) for s in found if s.role == "piston")
        wall = next(np.array(s.points) for s in found if s.role == "frame" and len(s.points) == 4)
        assert head[:, 0].max() < wall[:, 0].min() <= top[:, 0].min() + 1e-12 < top[:, 0].max() < wall[:, 0].max()
