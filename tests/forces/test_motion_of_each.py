"""Driven coordinates by rises of their own; `check` says what none can follow; a sweep over such motions."""

import json

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cases.check import check_file
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.forces import motion

CARRIED = """from mechsym.derive import Mechanism


def carrier():
    m = Mechanism("carrier", about="Two carriages on one rail, each with its drive.")
    x, y = m.coordinates("x y", "m")
    m_1, m_2 = m.parameters("m_1 m_2", "kg", above=0)
    F, G = m.inputs("F G", "N")
    m.body("one", mass=m_1, at=(x, 0))
    m.body("other", mass=m_2, at=(x + y, 0))
    m.force(F, along=x)
    m.force(G, along=y)
    return m
"""


def written(tmp_path, section):
    (tmp_path / "carrier.py").write_text(CARRIED)
    file = tmp_path / "carrier.toml"
    file.write_text(f'mechanism = "./carrier.py"\n[parameters]\nm_1 = 4.0\nm_2 = 2.0\n[motion]\n{section}\n')
    return str(file)


BOTH = 'x = "cycloid 300 mm"\ny = "cycloid -0.1 m"\nduration = "0.5 s"'


def test_each_ends_at_its_own_rise_and_its_force_is_that_of_newton(tmp_path):
    """Acceleration of a cycloid 2 pi h/T^2 sin(2 pi t/T); the drive of x moves both, that of y the other one."""
    table = motion(cases.load(written(tmp_path, BOTH))).columns
    assert table["x"][-1] == pytest.approx(0.3) and table["y"][-1] == pytest.approx(-0.1)
    wave = 2 * np.pi / 0.5**2 * np.sin(2 * np.pi * table["t"] / 0.5)
    both, one = 4.0 * 0.3 * wave + 2.0 * (0.3 - 0.1) * wave, 2.0 * (0.3 - 0.1) * wave
    assert table["driving_x"] == pytest.approx(both, abs=1e-9)
    assert table["driving_y"] == pytest.approx(one, abs=1e-9)


@pytest.mark.parametrize(
    ("section", "words"),
    [
        ('x = "cycloyd 3 mm"\nduration = 1', "did you mean 'cycloid'"),
        ('x = "cycloid 3 deg"\nduration = 1', "motion.x"),
        ('x = "cycloid"\nduration = 1', "needs motion.rise"),
        ('x = "cycloid 3 mm"', "motion.duration"),
        ('x = "cycloid 3 mm"\nrise = "2 mm"\nduration = 1', "motion.rise is for"),
        ('x = ""', "motion.x"),
    ],
)
def test_what_cannot_be_followed_is_said_by_check_as_by_forces(tmp_path, section, words):
    case = written(tmp_path, section)
    (problem,) = check_file(case, trust=True).problems
    assert words in problem.why
    with pytest.raises(BadInput, match=words):
        motion(cases.load(case))


def test_a_sweep_over_a_motion_gives_what_forces_gives(tmp_path):
    """The largest force of a cycloid goes with 1/T^2."""
    case = written(tmp_path, BOTH)
    words = ["sweep", case, "--over", "motion.duration=0.25,0.5", "--show", "max.driving_x", "--json"]
    found = json.loads(CliRunner().invoke(mechsym, words, catch_exceptions=False).stdout)
    quick, slow = found["data"]["max.driving_x"]
    assert slow == pytest.approx(2 * np.pi / 0.5**2 * (4.0 * 0.3 + 2.0 * 0.2), rel=1e-5)
    assert quick == pytest.approx(4 * slow, rel=1e-9)
