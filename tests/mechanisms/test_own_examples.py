"""Examples of declarations: they turn, run, and balance their energy; travels against the formulas of the trade."""

from pathlib import Path

import numpy as np
import pytest

from mechsym import cases
from mechsym.jobs import own_turn
from mechsym.jobs.problem import problem_of, settings_of
from mechsym.simulate import simulate

EXAMPLES = Path(__file__).parents[2] / "examples" / "mechanisms"


@pytest.mark.parametrize("name", ["whitworth", "v-twin", "radial-engine", "walking-leg"])
def test_an_example_turns_and_runs(name):
    case = cases.load(str(EXAMPLES / f"{name}.toml"))
    found = own_turn.turn(case)
    assert found.power_residual < 1e-12
    result = simulate(problem_of(case), settings_of(case))
    assert result.status == "converged" and abs(result.energy.residual) < 1e-8


def test_the_ram_returns_faster_than_it_goes():
    found = own_turn.turn(cases.load(str(EXAMPLES / "whitworth.toml")))
    x = found.columns["x"]
    top, bottom = found.phi[np.argmax(x)], found.phi[np.argmin(x)]
    there = (bottom - top) % (2 * np.pi)
    # the rocker is at its ends where the crank is across it: cos = r / h
    wanted = np.pi + 2 * np.arcsin(60 / 150)
    assert max(there, 2 * np.pi - there) == pytest.approx(wanted, abs=4 * np.pi / 720)
    angle = found.columns["rocker_angle"]
    assert angle.max() == pytest.approx(np.arcsin(60 / 150), abs=1e-4)


def test_the_master_piston_is_a_slider_crank_and_the_other_is_not():
    found = own_turn.turn(cases.load(str(EXAMPLES / "v-twin.toml")))
    r, l, phi = 0.05, 0.2, found.phi
    plain = r * (1 - np.cos(phi)) + l - np.sqrt(l**2 - (r * np.sin(phi)) ** 2)
    np.testing.assert_allclose(found.columns["x1"], plain, atol=1e-14)
    assert np.ptp(found.columns["x2"]) > 2 * r + 1e-5  # an articulated rod lengthens the stroke
