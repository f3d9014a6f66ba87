"""Cams against their own outline: envelope of the moving follower, its curvature and normal by finite differences."""

import importlib
import math
from pathlib import Path

import cams
import numpy as np
import pytest
from numpy.polynomial import chebyshev

from mechsym.derive import derive
from mechsym.derive.emit import module_text
from mechsym.derive.files import chosen
from mechsym.derive.listing import listing as listing_of
from mechsym.errors import BadInput
from mechsym.mechanisms.drawing import declared
from mechsym.mechanisms.record import bind_module
from mechsym.periodic.rises import RISES

_NODES = 17


def built(m):
    """A mechanism with the default values of its letters."""
    return bound(m, derive(m))


def bound(m, equations):
    text = module_text(equations, "test", "0")
    module = importlib.util.module_from_spec(importlib.machinery.ModuleSpec("built", None))
    exec(text, module.__dict__)
    return bind_module(module, {p: m.ranges[p]["default"] for p in module.PARAMETERS})


def outputs(mechanism, group, *values):
    function = mechanism.functions[group]
    return dict(zip(function.name_out(), map(float, function.call(list(values))), strict=True))


def lift(mechanism, phi):
    return outputs(mechanism, "kinematics", phi)["lift_cam"]


class Smooth:
    """A function of an angle by an interpolation near one place: finite differences of all its nodes together."""

    def __init__(self, function, at, half):
        nodes = np.cos(np.pi * (np.arange(_NODES) + 0.5) / _NODES)
        self.at, self.half = at, half
        self.c = chebyshev.chebfit(nodes, np.array([function(at + half * x) for x in nodes]), _NODES - 1)

    def __call__(self, order=0, x=0.0):
        c = chebyshev.chebder(self.c, order) if order else self.c
        return chebyshev.chebval((x - self.at) / self.half if x else 0.0, c) / self.half**order


def turned(angle, point):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([c * point[0] - s * point[1], s * point[0] + c * point[1]])


def outline_of_lines(line):
    """Outline that lines a x + b y = c touch, each told with its angle: a point and its derivative."""

    def point(at, half=0.02):
        rows = Smooth(lambda x: np.array(line(x)), at, half)
        (a, b, c), (da, db, dc) = rows(), rows(1)
        return np.linalg.solve([[a, b], [da, db]], [c, dc])

    return point


def placed(m, kind, swings):
    """Where the follower is at a lift: its centre and radius, or its line (a, b, c) with the side a x + b y < c."""
    v = {p: m.ranges[p]["default"] for p in m.ranges}
    base, roller = v["cam_base"], v.get("cam_roller", 0.0)
    if not swings:
        aside = v.get("cam_offset", 0.0)
        if kind == "flat":
            return lambda s: (0.0, 1.0, base + s)
        return lambda s: (aside, math.sqrt((base + roller) ** 2 - aside**2) + s)
    apart = v["cam_centres"]
    if kind == "flat":
        start = math.asin((base - v["cam_face"]) / apart)
        # the line through the pivot's side: its normal leans as the face is swung
        return lambda s: (
            math.sin(start + s), math.cos(start + s), apart * math.sin(start + s) + v["cam_face"]
        )  # fmt: skip
    arm, pitch = v["cam_arm"], base + roller
    start = math.acos((arm**2 + apart**2 - pitch**2) / (2 * arm * apart))
    return lambda s: (apart - arm * math.cos(start + s), arm * math.sin(start + s))


CASES = [(kind, swings, "cycloid") for kind in ("knife", "roller", "flat") for swings in (False, True)]
CASES += [("roller", False, law) for law in RISES]


@pytest.mark.parametrize("kind, swings, law", CASES)
def test_curvature_pressure_angle_and_force_are_those_of_the_outline(kind, swings, law):
    m = (cams.swing if swings else cams.slide)(law, kind)
    follower, mechanism = placed(m, kind, swings), built(m)
    half, radius = 0.02, m.ranges.get("cam_roller", {}).get("default", 0.0)

    def line(x):
        a, b, c = follower(lift(mechanism, x))
        return (*turned(-x, (a, b)), c)

    def pitch(x):
        return turned(-x, follower(lift(mechanism, x)))

    def under_roller(x):
        tangent = Smooth(pitch, x, half)(1)
        normal = np.array([-tangent[1], tangent[0]]) / np.hypot(*tangent)  # outwards: it runs clockwise
        return pitch(x) - radius * normal

    outline = {"flat": outline_of_lines(line), "knife": pitch, "roller": under_roller}[kind]
    for phi in np.radians([41.0, 100.0, 168.0, 205.0]):
        curve = Smooth(outline, phi, half)
        first, second = curve(1), curve(2)
        curvature = -(first[0] * second[1] - first[1] * second[0]) / np.hypot(*first) ** 3
        tangent = turned(phi, first / np.hypot(*first))
        normal, point = np.array([-tangent[1], tangent[0]]), turned(phi, curve())
        if kind == "flat":
            normal = np.array(follower(lift(mechanism, phi))[:2])
            tangent = np.array([normal[1], -normal[0]])
        told = outputs(mechanism, "kinematics", phi)
        assert told["curvature_cam"] == pytest.approx(curvature, rel=1e-8, abs=1e-8)
        # how the follower's own point moves with the lift
        pivot = np.array([m.ranges["cam_centres"]["default"], 0.0]) if swings else None
        centre = point if kind != "roller" else np.array(follower(told["lift_cam"]))
        way = np.array([0.0, 1.0]) if pivot is None else np.array([(centre - pivot)[1], -(centre - pivot)[0]])
        angle = math.atan2(way @ tangent, way @ normal)
        assert told["pressure_angle_cam"] == pytest.approx(angle, abs=1e-8)
        # the contact force by the follower's own balance, and by the moment that it has about the cam's centre
        speed, torque = 100.0, 0.0
        rate = Smooth(lambda x: lift(mechanism, x), phi, half)
        spring, inertia, preload = (80.0, 1e-3, math.radians(10)) if swings else (5e4, 0.2, 8e-3)
        thrust = inertia * rate(2) * speed**2 + spring * (rate() + preload)
        force = thrust / (way @ normal)
        reactions = outputs(mechanism, "reactions", phi, speed, 0.0, torque)
        assert reactions["force_cam"] == pytest.approx(force, rel=1e-8)
        dynamics = mechanism.functions["dynamics"](phi, speed, torque)
        moment = -force * (point[0] * normal[1] - point[1] * normal[0])
        if kind != "knife":
            assert float(dynamics[2]) - float(dynamics[1]) == pytest.approx(moment, rel=1e-7, abs=1e-7 * abs(force))


def of_rows(folder):
    """A flat follower on the profile that lies in a folder, declared there."""
    own = Path(cams.__file__).read_text() + "\n\ndef rows():\n    return slide('lift.csv', 'flat')\n"
    (folder / "own.py").write_text(own)
    return chosen(folder / "own.py", "slide_flat")


def test_a_profile_of_rows_goes_through_them_and_bends_without_jumps(tmp_path):
    """Rows of a law at every 5 degrees give that law back; value, slope and bend repeat across the first row."""
    angles = np.arange(72) * 5.0 + 2.0
    rows = [0.004 * (1 - math.cos(a)) ** 2 for a in np.radians(angles)]
    (tmp_path / "lift.csv").write_text(
        "angle [deg], lift [mm]\n" + "\n".join(f"{a},{1e3 * s!r}" for a, s in zip(angles, rows, strict=True))
    )
    mechanism = built(of_rows(tmp_path))
    for phi in (*np.radians(angles[::7]), 0.0, 0.03, 2.0, 6.2):
        told = outputs(mechanism, "kinematics", phi)
        exact = 0.004 * (1 - math.cos(phi)) ** 2
        assert told["lift_cam"] == pytest.approx(exact, abs=2e-10)
        assert told["dlift_cam_dphi"] == pytest.approx(0.008 * (1 - math.cos(phi)) * math.sin(phi), abs=2e-8)
    for edge in (*np.radians(angles[:3]), 0.0, 2 * math.pi):
        before, after = (outputs(mechanism, "kinematics", edge + d) for d in (-1e-9, 1e-9))
        for name in ("lift_cam", "dlift_cam_dphi", "d2lift_cam_dphi2", "curvature_cam"):
            assert before[name] == pytest.approx(after[name], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize(
    "rows, words",
    [
        ("angle [deg], lift [mm]\n0,1\n10,2\n5,3\n", "line 4: angle must rise"),
        ("angle [deg], lift [mm]\n0,1\n10,2\n", "2 rows; a profile has 7 to 1000"),
        ("angle [deg], rise [mm]\n0,1\n", "is no angle and no lift"),
        ("angle [deg], lift [kg]\n0,1\n", "has the wrong dimension"),
        ("angle [deg], lift [mm]\n" + "".join(f"{60 * k},{k}\n" for k in range(7)), "does not close after a turn"),
        ("angle [deg], lift [mm]\n0,x\n", "is not a number"),
    ],
)
def test_a_bad_profile_is_told_with_its_line(tmp_path, rows, words):
    (tmp_path / "lift.csv").write_text(rows)
    with pytest.raises(BadInput) as refused:
        of_rows(tmp_path)
    assert words in str(refused.value)
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize("kind", ["knife", "roller", "flat"])
@pytest.mark.parametrize("make", [cams.slide, cams.swing])
def test_a_cam_is_drawn_with_its_follower_on_it(make, kind):
    m = make(kind=kind)
    equations = derive(m)
    drawn = declared(bound(m, equations), listing_of(equations))
    for angle in np.linspace(0.1, 6.2, 11):
        shapes = drawn(float(angle))
        (corners,) = (np.array(s.points) for s in shapes if s.role == "cam")
        *_, (x, y), (u, v) = next(s for s in shapes if s.role == "piston").points
        if kind == "flat":  # the whole cam lies on one side of the face and reaches it
            side = ((corners - [x, y]) @ [y - v, u - x]) / math.hypot(u - x, v - y)
            gap = min(side.max(), -side.min(), key=abs)
        else:
            x, y = next(s for s in shapes if s.role == "piston").points[0]
            gap = np.hypot(*(corners - [x, y]).T).min() - (0.008 if kind == "roller" else 0.0)
        assert abs(gap) < 5e-4, angle
