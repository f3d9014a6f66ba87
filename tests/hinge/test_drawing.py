"""The elastic hinge as it is drawn: rollers on their tracks, rods of constant length, the gas as long as it is."""

import math

import numpy as np
import pytest

from mechsym import cases
from mechsym.hinge.guide import closing, path
from mechsym.hinge.plots import elastic_hinge
from mechsym.jobs.hinge import hinge
from mechsym.mechanisms.drawing import Circle, Line

ANGLES = np.linspace(0, 2 * math.pi, 9)


@pytest.fixture(scope="module")
def design():
    return hinge(cases.load("zotov-89"))


def far(track, centre):
    """Distance of a point from a closed line of many corners."""
    corners = np.array(track.points)
    start, way = corners[:-1], np.diff(corners, axis=0)
    share = np.clip(((centre - start) * way).sum(axis=1) / (way**2).sum(axis=1), 0, 1)
    return np.hypot(*(start + share[:, None] * way - centre).T).min()


def test_each_roller_touches_its_track(design):
    drawn, r = elastic_hinge(design.guide, design.rollers), design.rollers.radius
    for angle in ANGLES:
        shapes = drawn(angle)
        rollers = [s for s in shapes if s.role == "roller"]
        tracks = [next(s for s in shapes if s.role == role) for role in ("track", "second_track")]
        assert len(rollers) == 2
        for roller, track in zip(rollers, tracks, strict=True):
            assert roller.radius == r
            assert far(track, roller.centre) == pytest.approx(r, abs=1e-3 * design.guide.parameters.rho0)


def test_rods_keep_their_length_and_the_gas_is_as_long_as_it_is(design):
    drawn, spring = elastic_hinge(design.guide, design.rollers), design.guide.spring
    rods = []
    for angle in ANGLES[:-1]:
        shapes = drawn(angle)
        rods.append([math.dist(*s.points) for s in shapes if isinstance(s, Line) and s.role == "rod"])
        (gas,) = (s for s in shapes if s.role == "gas")
        sides = sorted({round(math.dist(a, b), 9) for a, b in zip(gas.points, gas.points[1:], strict=False)})
        rho = path(design.guide)(angle * design.guide.parameters.shaft_ratio)
        wanted = [math.sqrt(4 * spring.A / math.pi), spring.H - float(closing(design.guide, rho))]
        assert sides == pytest.approx(sorted(wanted), abs=1e-8)
    assert np.ptp(rods, axis=0) == pytest.approx([0, 0], abs=1e-12) and np.min(rods) > 0


def test_the_spring_turns_with_the_shaft(design):
    drawn = elastic_hinge(design.guide, design.rollers)
    for angle in ANGLES[:-1]:
        (first, _) = (s.centre for s in drawn(angle) if isinstance(s, Circle) and s.role == "roller")
        assert math.atan2(first[1], first[0]) % (2 * math.pi) == pytest.approx(angle, abs=1e-9)
