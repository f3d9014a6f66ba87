"""Laws of machines without links, by their closed forms."""

import math

import pytest

from mechsym.cases.links import by_links, by_sign

TURNING = {"coordinates": {"phi": "rad", "s": "m"}, "parameters": {"r": "m"}, "inputs": {}}
SHAFT = {
    "coordinates": {"phi": "rad", "psi": "rad"},
    "parameters": {"I": "kg*m^2", "J": "kg*m^2", "k": "N*m/rad", "c": "N*m*s/rad"},
    "inputs": {"M": "N*m"},
    "springs": ["k"],
    "dampers": ["c"],
}


def told(doubts):
    return {d.code: d.value for d in doubts}


def test_a_body_on_an_arm_is_as_fast_as_its_end():
    listing = {**TURNING, "bodies": {"bob": ["r*cos(phi)", "r*sin(phi)"]}}
    assert told(by_links(listing, {"r": 3.0}, {}, {"phi": -50.0})) == {"point_speed": pytest.approx(150.0)}
    assert told(by_links(listing, {"r": 1.0}, {}, {"phi": 50.0})) == {}
    geared = {**TURNING, "bodies": {"car": ["r*phi/8", "0"]}}
    assert told(by_links(geared, {"r": 3.0}, {}, {"phi": 400.0})) == {"point_speed": pytest.approx(150.0)}


def test_a_body_that_slides_along_an_arm_is_where_it_was_assembled():
    listing = {**TURNING, "bodies": {"slider": ["s*cos(phi)", "s*sin(phi)"]}}
    assert told(by_links(listing, {"r": 1.0}, {}, {"phi": 500.0, "s": 1.0})) == {}
    assembled = by_links({**listing, "pose": {"s": 0.5}}, {"r": 1.0}, {}, {"phi": 500.0, "s": 1.0})
    assert told(assembled) == {"point_speed": pytest.approx(250.0)}


def test_a_spring_is_wound_up_by_the_largest_torque():
    letters = {"I": 2.0, "J": 1.0, "k": 10.0, "c": 0.0}
    assert told(by_links(SHAFT, letters, {"M": 20 * math.pi}, {})) == {}  # one turn
    assert told(by_links(SHAFT, letters, {"M": -100.0, "phi": 5.0}, {})) == {"spring_wound": pytest.approx(10.0)}


def test_inertias_and_dampers_are_held_against_their_neighbours():
    letters = {"I": 2.0, "J": 1e-6, "k": 8.0, "c": 1600.0}
    assert told(by_links(SHAFT, letters, {}, {})) == {"inertia_spread": pytest.approx(2e6)}
    assert told(by_sign(SHAFT, letters)) == {"damping_share": pytest.approx(200.0)}  # of critical, 2 sqrt(k I) = 8
