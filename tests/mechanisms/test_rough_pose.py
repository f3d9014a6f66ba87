"""Cylinders that close loops: the lengths that a rough pose asks for, poses of `eval`, and rest without a run."""

import json
import math

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym.cli import mechsym
from mechsym.errors import BadInput

BOOM = """
from mechsym.derive import Mechanism, sqrt

def boom():
    m = Mechanism("boom", about="A boom on its cylinder.")
    s = m.coordinates("s", "m")
    m.pose(s="LENGTH")
    arm = m.link("arm", mass="300 kg", centre=("1.5 m", "0.1 m"), inertia="250 kg*m^2", pose="40 deg")
    m.pin("O", m.frame, arm)
    arm.settle()
    foot, top = m.frame.at("0.5 m", "-0.3 m"), arm.at("1.2 m", "-0.05 m")
    m.constraint("cylinder", sqrt((top.x - foot.x) ** 2 + (top.y - foot.y) ** 2) - s)
    m.force(m.inputs("F", "N"), along=s)
    m.spring("SPRING", stretch=s - m.parameters("free", "m", default="1.6 m"))
    m.weight(0, -9.81)
    return m
"""
FOOT, TOP = np.array([0.5, -0.3]), np.array([1.2, -0.05])


def length(angle):
    c, s = math.cos(angle), math.sin(angle)
    return float(np.hypot(*(np.array([[c, -s], [s, c]]) @ TOP - FOOT)))


@pytest.fixture
def run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    def typed(said, *words, spring="20 kN/m"):
        (tmp_path / "boom.py").write_text(BOOM.replace("LENGTH", said).replace("SPRING", spring))
        (tmp_path / "boom.toml").write_text('mechanism = "./boom.py"\n')
        return CliRunner().invoke(mechsym, list(words), catch_exceptions=False)

    return typed


def test_a_length_that_no_pose_has_is_told_with_the_one_of_the_rough_pose(run):
    with pytest.raises(BadInput) as refused:
        run("3 m", "eval", "./boom.py")
    fitting = 1e3 * length(math.radians(40))
    assert f"as its links are said to stand roughly, it closes with s = {fitting:.4g} mm" in str(refused.value)


def test_eval_stands_as_the_declaration_says(run):
    at = length(math.radians(55))
    outputs = json.loads(run(f"{at} m", "eval", "./boom.py", "--json").stdout)["outputs"]
    given = json.loads(run("1.1 m", "eval", "./boom.py", "--set", f"s={at}", "--json").stdout)["outputs"]
    assert outputs == given and outputs["theta_arm"] == pytest.approx(math.radians(55), abs=1e-9)


def test_rest_needs_no_length_of_a_run(run):
    told = json.loads(run("1.1 m", "simulate", "boom.toml", "--rest", "--json").stdout)
    assert {pose["kind"] for pose in told["rests"]} == {"stable", "unstable"}
    for pose in told["rests"]:
        # the weight turns the arm as the spring pushes it: m g dy_c/da = k (free - s) ds/da
        angle, step = pose["at"]["theta_arm"], 1e-6
        slope = (length(angle + step) - length(angle - step)) / (2 * step)
        lever = 1.5 * math.cos(angle) - 0.1 * math.sin(angle)
        assert pose["at"]["s"] == pytest.approx(length(angle), rel=1e-9)
        assert 300 * 9.81 * lever == pytest.approx(20e3 * (1.6 - length(angle)) * slope, rel=1e-6)
