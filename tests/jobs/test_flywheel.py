"""`mechsym flywheel`: closed form, limits, the run in time as judge, and what is refused."""

import json
import math
from pathlib import Path

import pytest
from click.testing import CliRunner

from mechsym import cases
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.flywheel import flywheel, shaft
from mechsym.simulate.angle import tabulate
from mechsym.simulate.engine import reduced


@pytest.mark.parametrize(
    ("case", "overrides"),
    [
        ("zotov-89", {}),
        ("moroianu", {"load.law": "constant"}),
        ("alpha-stirling", {"cycle.kind": "stirling-adiabatic"}),
        ("opposed-pistons", {}),
        ("balandin", {}),
    ],
)
def test_the_run_in_time_has_the_wanted_ripple(case, overrides):
    found = flywheel(cases.load(case, overrides), 0.02)
    assert found.status == "found"
    assert found.trial.result.status == "converged"
    assert found.trial.speed_ripple == pytest.approx(0.02, rel=2e-3)
    assert abs(found.trial.result.energy.residual) < 1e-7
    assert found.ripple_bare is None or found.ripple_bare > 0.02


@pytest.mark.parametrize("case", ["zotov-89", "opposed-pistons"])
def test_fine_ripple_is_the_closed_form(case):
    # work at constant speed = ripple (J + mean I) omega^2, the smaller the ripple the better
    found = [flywheel(cases.load(case, {"load.law": "constant"}), ripple, turns=4) for ripple in (0.04, 0.004)]
    coarse, fine = (abs(f.inertia / f.estimate - 1) for f in found)
    assert fine < coarse / 5
    assert fine < 3e-3


def test_a_coarse_wish_needs_none():
    found = flywheel(cases.load("opposed-pistons"), 0.5, turns=4)
    assert (found.status, found.inertia) == ("not needed", 0.0)


def test_the_shaft_balances():
    machine = shaft(cases.load("alpha-stirling"), 0.3)
    panels = tabulate(reduced(machine))
    bare = tabulate(reduced(shaft(cases.load("alpha-stirling"), 0.0)))
    assert panels.inertia.mean() - bare.inertia.mean() == pytest.approx(0.3, rel=1e-12)
    assert machine.omega == pytest.approx(600 * math.pi / 30)


def test_command():
    found = CliRunner().invoke(mechsym, ["flywheel", "zotov-89", "--ripple", "5%", "--json"])
    assert found.exit_code == 0
    result = json.loads(found.stdout)
    assert result["check"]["speed_ripple"] == pytest.approx(0.05, rel=1e-3)
    assert result["ripple_bare"] is None


def test_a_torque_that_is_round_off_is_none():
    case = "examples/mechanisms/atkinson.toml"
    done = CliRunner().invoke(mechsym, ["flywheel", str(Path(__file__).parents[2] / case)], catch_exceptions=False)
    assert "mean torque 0 N*m, work that swings 20.395 J" in done.stdout


def test_refusals():
    with pytest.raises(BadInput, match="ripple"):
        flywheel(cases.load("zotov-89"), 2.0)
    with pytest.raises(BadInput, match="crankshaft_flywheel has 2 coordinates"):
        shaft(cases.load("chmielewski"), 0.0)
