"""What turns in a page stands where the equations say: parts of the SVG at ten angles, to a pixel."""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest

from mechsym import cases, mechanisms
from mechsym.jobs.export import turning
from mechsym.jobs.machine import one_coordinate
from mechsym.mechanisms.turning import FRAMES, rules
from mechsym.page import page

OWN = Path(__file__).parents[2] / "examples" / "mechanisms"
BUILT_IN = ("zotov-89", "generator", "nunes-hypocycloid", "alpha-stirling", "opposed-pistons", "moroianu")
UNDRAWN = ("valve-float", "valve-train")  # cams have no drawing
ANGLES = range(0, FRAMES, FRAMES // 10)


def svg_of(name):
    """The scene of a case, and the text of its page."""
    (scene,) = turning(cases.load(name))
    text = page("mechanism.html", title="t", scenes=[scene], readouts=[], rules=rules())
    (read,) = json.loads(re.search(r"const scenes = (.*?), readouts", text)[1])
    return read | {"shapes": [unpacked(shape) for shape in read["shapes"]]}, text


def unpacked(shape):
    """A shape of a page with its corners at each frame, from the steps in tenths of a pixel."""
    wide = 2 if shape.get("shifts") else len(shape["at"])
    moves = np.cumsum(np.reshape(shape["moves"], (-1, wide)), axis=0) / 10
    corners = np.tile(moves, len(shape["at"]) // 2) + shape["at"] if shape.get("shifts") else moves
    return shape | {"moves": corners.tolist()}


def middles(scene, role, k):
    """Middles of the shapes of a role in a frame [px]."""
    found = [(s, s["moves"][k] if s["moves"] else s["at"]) for s in scene["shapes"] if s["role"] == role]
    rows = [(shape["closed"], np.reshape(points, (-1, 2))) for shape, points in found]
    return [np.mean(points[:-1] if closed and len(points) > 1 else points, axis=0) for closed, points in rows]


def travels(name):
    """Travel of every piston over the frames [m]."""
    case = cases.load(name)
    mechanism = one_coordinate(case)
    names = [role.travel for role in mechanisms.roles_of(case.mechanism).pistons]
    phi = [2 * math.pi * k / FRAMES for k in range(FRAMES)]
    function = mechanism.functions["kinematics"]
    found = [dict(zip(function.name_out(), function.call([at]), strict=True)) for at in phi]
    return {one: [float(row[one]) for row in found] for one in names if one in found[0]}


@pytest.mark.parametrize(
    "name", [*BUILT_IN, *(str(p) for p in sorted(OWN.glob("*.toml")) if p.stem not in ("whitworth", *UNDRAWN))]
)
def test_pistons_stand_where_their_travel_says(name):
    scene, _ = svg_of(name)
    moved = travels(name)
    if not moved:
        pytest.skip("no piston is declared")
    start = middles(scene, "piston", 0)
    for travel in moved.values():
        ways = [scene["scale"] * abs(travel[k] - travel[0]) for k in ANGLES]
        worst = [max(abs(float(np.linalg.norm(middles(scene, "piston", k)[i] - start[i])) - way)
                     for k, way in zip(ANGLES, ways, strict=True)) for i in range(len(start))]  # fmt: skip
        assert min(worst) < 1.0, name


# the crank of a swash plate is the plate, seen from its side
@pytest.mark.parametrize(
    "name", [str(path) for path in sorted(OWN.glob("*.toml")) if path.stem not in ("swash-plate", *UNDRAWN)]
)
def test_cranks_of_own_mechanisms_turn_by_the_angle(name):
    scene, _ = svg_of(name)
    cranks = [s for s in scene["shapes"] if s["role"] == "crank" and s["moves"] and not s["closed"]]
    assert cranks, name
    for crank in cranks:
        start, *others = (np.reshape(crank["moves"][k], (-1, 2)) for k in ANGLES)
        arms = [complex(*(pose[1] - pose[0])) for pose in (start, *others)]
        for k, arm in zip(ANGLES, arms, strict=True):
            turn = np.exp(-2j * math.pi * k / FRAMES)  # y of a picture points downwards
            assert min(abs(arm - arms[0] * turn), abs(arm - arms[0] * turn.conjugate())) < 1.0, (name, k)


def test_the_svg_begins_with_the_first_frame_and_a_hinge_turns_beside_the_machine():
    scene, text = svg_of("zotov-89")
    drawn = re.findall(r'<path class="(\w+)[^"]*" d="M([^"Z]*)Z?"', text)
    lines = [s for s in scene["shapes"] if not s["r"]]
    assert [role for role, _ in drawn] == [s["role"] for s in lines]
    for (_, points), shape in zip(drawn, lines, strict=True):
        assert list(map(float, points.split())) == shape["at"] == (shape["moves"] or [shape["at"]])[0]


def test_links_of_a_declaration_end_in_pins():
    scene, _ = svg_of(str(OWN / "whitworth.toml"))
    pins = [s for s in scene["shapes"] if s["role"] == "joint"]
    assert len(pins) == 5 and len([s for s in pins if s["moves"]]) == 3  # O and D stand still
