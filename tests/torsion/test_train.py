"""Criticals of a crank train: against two discs by hand, against runs in time, and what is doubted of them."""

import json
import math
import re

import numpy as np
import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.jobs.forces import vibration
from mechsym.jobs.machine import turn
from mechsym.jobs.run import run
from mechsym.torsion.twist import ShaftLimits, doubts, operating_range, twist_words, words

NAME = "alpha-stirling"


def shown(*words):
    return json.loads(CliRunner().invoke(mechsym, [*words, "--json"], catch_exceptions=False).stdout)


@pytest.mark.parametrize("c", [0.0, 2.0, 10.0])
def test_two_discs_by_hand(c):
    """Through the only section goes what the flywheel is pushed with: transmissibility of one resonator."""
    case = cases.load(NAME, {"c": c})
    found, p = vibration(case), case.need("parameters")
    (natural,) = found.natural
    # both pistons in quadrature: their mean inertia is r^2 (1 + lambda^2/4 ..) m / 2 each
    crank = p.I_f * p.k / (natural**2 * p.I_f - p.k)
    assert crank == pytest.approx(p.I0 + 2 * p.m_piston * p.r**2 / 2, rel=5e-3)
    (critical,) = found.criticals
    r, damped = 3 * found.omega / natural, c * natural / p.k
    magnified = math.sqrt((1 + (damped * r) ** 2) / ((1 - r**2) ** 2 + (damped * r) ** 2))
    assert (critical.order, critical.speed) == (3.0, pytest.approx(natural / 3))
    assert critical.magnification == pytest.approx(magnified, rel=1e-9)
    one = turn(case)
    third = 2 * abs(np.fft.rfft(one.torque)[3]) / one.phi.size  # of load and rigid shaft together
    assert critical.torque_rigid == pytest.approx(third * p.I_f / (p.I_f + crank), rel=2e-3)


def test_the_linear_swing_is_that_of_a_run_in_time():
    case = cases.load(NAME, {"simulation.turns": 30})
    found = run(case, check="none")
    (section,), (limit,) = found.twist, found.vibration.twist_limit
    assert found.vibration.torque_amplitude[0] == pytest.approx(section.torque_amplitude, rel=0.04)
    assert section.twist_peak < limit == 0.1
    assert found.doubts == ()
    assert found.vibration.natural == pytest.approx(found.natural_frequencies, rel=1e-9)


def test_the_shipped_case_is_damped_and_without_damper_doubted():
    found = vibration(cases.load(NAME))
    assert doubts(found) == () and found.criticals[0].magnification < 4
    bare = shown("simulate", NAME, "--set", "c=0", "--no-check")
    assert [d["code"] for d in bare["doubts"]] == ["critical", "twist"]
    assert bare["twist"][0]["torque_amplitude"] == pytest.approx(634, abs=5)
    assert any("the model does not hold" in line for line in bare["findings"])
    told = next(line for line in bare["findings"] if line.startswith("order 3 is critical at"))
    assert "rpm, 0.4 % above" in told and float(told.split()[5]) * np.pi / 30 == pytest.approx(63.09, abs=5e-3)


def test_away_from_a_critical_nothing_is_doubted():
    found = vibration(cases.load(NAME, {"c": 0.0, "operation.speed": "525 rpm"}))
    assert doubts(found) == ()
    assert [c.order for c in found.criticals] == [4.0, 3.0]  # the nearest first
    assert sorted(c.away > 0 for c in found.criticals) == [False, True]
    near = vibration(cases.load(NAME, {"c": 0.0, "operation.speed": "590 rpm"}))
    assert [d.code for d in doubts(near)] == ["critical"]


def test_forces_of_every_crank_train_report_them():
    found = shown("forces", "opposed-pistons")
    assert len(found["vibration"]["natural"]) == 2 and found["vibration"]["criticals"] == []
    assert any(line.startswith("no order is critical") for line in found["facts"])
    assert shown("forces", NAME)["vibration"]["criticals"][0]["order"] == 3.0
    assert shown("forces", "moroianu")["vibration"] is None


def test_a_diameter_says_what_twist_the_shaft_bears(tmp_path):
    file = tmp_path / "train.toml"
    file.write_text(cases.text(NAME) + '\n[shaft]\ndiameter = "12 mm"\nshear_limit = "250 MPa"\n')
    case = cases.load(str(file))
    found = vibration(case)
    yields = 250e6 * math.pi * 0.012**3 / 16
    assert found.twist_limit == (pytest.approx(yields / 6500),)
    done = run(case, check="none")
    assert [d.code for d in done.doubts] == ["twist"]
    told = twist_words(found, done.twist, case.sections["shaft"])
    stress = 16 * done.twist[0].torque_peak / (math.pi * 0.012**3)
    assert f"{stress / 1e6:.3g} MPa of shear in the shaft, which yields at 250 MPa" in told[0]
    assert "the model does not hold" in told[1]
    assert told[1] in [finding.words for finding in done.view.findings()]


def test_without_a_diameter_the_one_is_told_that_bears_the_torque():
    done = run(cases.load(NAME), check="none")
    (told,) = twist_words(done.vibration, done.twist, ShaftLimits())
    needed = float(re.search(r"a solid shaft of ([\d.]+) mm or more bears it with 200 MPa of shear", told)[1])
    assert 16 * done.twist[0].torque_peak / (math.pi * (1e-3 * needed) ** 3) == pytest.approx(200e6, rel=0.01)


def test_the_operating_range():
    assert operating_range(100.0, None, None) == (100.0, 80.0, 120.0)
    assert operating_range(100.0, 30.0, None)[1] == 30.0
    assert operating_range(100.0, 30.0, (50.0, 70.0)) == (100.0, 50.0, 70.0)
    start = vibration(cases.load(NAME, {"simulation.speed_start": "250 rpm"}))
    assert [c.order for c in start.criticals] == [3.0, 4.0, 5.0, 6.0]
    assert "below the speed of operation" in " ".join(words(start))
