"""Linkages of the textbooks from joints and one rough pose: Peaucellier's cell, Chebyshev's and Hoeken's, a press,
a shaper, a scissor lift, two legs and a robot close, obey Newton and Euler, and draw what they are known for."""

import functools
from math import cos, pi, sin
from pathlib import Path

import numpy as np
import pytest
from newton_euler import Oracle

from mechsym.derive import derive
from mechsym.derive.emit import module_text
from mechsym.derive.files import declared_in
from mechsym.derive.textbook import disagreement
from mechsym.mechanisms.own import _module
from mechsym.mechanisms.record import bind_module
from mechsym.mechanisms.state import state

NAMES = ("chebyshev", "hoeken", "peaucellier", "toggle", "shaper", "klann", "scissor", "fivebar", "jansen")
STRAIGHT = (0.6**2 - 0.25**2) / (2 * 0.2)  # OP OB = l^2 - s^2 = 2 c x of Peaucellier's cell


@functools.cache
def linkages():
    return declared_in(Path(__file__).parents[2] / "examples" / "mechanisms" / "linkages.py")


@functools.cache
def derived(name):
    m = linkages()[name]
    equations = derive(m)
    assert not m.dependent_list and all(side.by == "pose" for side in m.sides)
    values = {letter: m.ranges[letter]["default"] for letter in map(str, m.parameter_list)}
    mechanism = bind_module(_module(Path("ten.py"), module_text(equations, "ten.py", "0" * 16)), values)
    return equations, mechanism, values, {q.name: m.poses[q.name] for q in m.q}


def moved(pose, step):
    given = {q: at + step for q, at in pose.items()}
    return given | {f"{q}d": 3.0 - k for k, q in enumerate(pose)} | {f"{q}dd": 2.0 + k for k, q in enumerate(pose)}


@pytest.mark.slow
@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.heavy) if n == "jansen" else n for n in NAMES])
def test_a_mechanism_from_one_pose_closes_and_obeys_newton_and_euler(name):
    assert (*linkages(),) == NAMES
    equations, mechanism, values, pose = derived(name)
    assert disagreement(equations)[1] < 1e-9
    f = mechanism.functions["reactions"]
    for step in (-0.1, 0.0, 0.15):
        given = moved(pose, step)
        oracle, found = Oracle(equations, values | given), state(mechanism, given)
        for joint in (j for j in equations.mechanism.link_joints if j.kind == "pin"):
            assert oracle.pair(joint.first.xy) == pytest.approx(oracle.pair(joint.second.xy), abs=1e-12)
        if len(pose) > 1:
            continue  # the oracle turns one shaft
        torque = found.mass_matrix[0][0] * given["phidd"] + found.bias[0] - found.generalized_force[0]
        reactions = {
            n: float(v) for n, v in zip(f.name_out(), f(*(given.get(n, 0.0) for n in f.name_in())), strict=True)
        }
        left, size = oracle.residuals(reactions, torque)
        assert max(np.abs(v).max() for v in left.values()) < 1e-9 * size, name


@pytest.mark.slow
def test_peaucelliers_tip_runs_on_a_straight_line():
    equations, _, values, pose = derived("peaucellier")
    for step in np.linspace(-0.3, 0.3, 7):
        oracle = Oracle(equations, values | moved(pose, step))
        tip = next(s for s in equations.mechanism.tape.entries if s.name == "tip_x")
        assert oracle.value(tip) == pytest.approx(STRAIGHT, abs=1e-12)


@pytest.mark.slow
def test_a_scissor_lifts_by_two_storeys():
    equations, _, values, pose = derived("scissor")
    for step in (0.0, 0.3):
        angle = pi / 6 + step
        oracle = Oracle(equations, values | moved(pose, step))
        top = next(k for k in equations.mechanism.links if k.name == "top")
        assert oracle.pair(top.origin) == pytest.approx((0.0, 2 * sin(angle)), abs=1e-12)
        foot = next(k for k in equations.mechanism.links if k.name == "foot")
        assert oracle.pair(foot.origin) == pytest.approx((cos(angle), 0.0), abs=1e-12)
