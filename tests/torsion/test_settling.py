"""Where an engine settles after a start, and what holds it: synthetic runs, and the built-in engine held by order 2."""

from types import SimpleNamespace

import numpy as np
import pytest

from mechsym import cases
from mechsym.jobs.run import run
from mechsym.torsion.twist import sentences, settling

PERIOD = 2 * np.pi
ADIABATIC = {"cycle.kind": "stirling-adiabatic", "simulation.speed_start": "250 rpm"}


def risen(end, time=40.0):
    """A run whose speed rises from 20 rad/s to an end."""
    t = np.linspace(0, time, 20001)
    phi = end * t - (end - 20.0) * 4.0 * (1 - np.exp(-t / 4.0))
    return SimpleNamespace(t=t, columns={"phi_f": phi})


def test_balance_away_from_criticals():
    found = settling(risen(80.0), "phi_f", PERIOD, (189.0,), 80.0)
    assert found.settled
    assert found.speed_end == pytest.approx(80.0, rel=1e-3)
    assert found.at is None and not found.held
    assert [order for order, _ in found.passed] == [6.0, 5.0, 4.0, 3.0]
    assert "it runs at no critical speed" in sentences(found)


@pytest.mark.parametrize(("rigid", "held"), [(120.0, True), (94.0, False), (None, True)])
def test_at_a_critical_the_rigid_shaft_tells_whether_it_holds(rigid, held):
    found = settling(risen(94.5), "phi_f", PERIOD, (189.0,), rigid)
    assert found.at == (2.0, 94.5)
    assert found.held is held


def test_four_stroke_has_half_orders():
    found = settling(risen(126.0), "phi_f", 2 * PERIOD, (189.0,), 150.0)
    assert found.at == (1.5, 126.0)


def test_a_run_that_still_rises_is_not_settled():
    assert not settling(risen(80.0, time=8.0), "phi_f", PERIOD, (189.0,), 80.0).settled


@pytest.mark.slow
def test_adiabatic_engine_finds_the_balance_of_gas_and_load():
    case = cases.load("alpha-stirling", ADIABATIC | {"simulation.turns": "300", "c": "5 N*m*s/rad"})
    found = run(case, check="none").settling
    assert found.settled and not found.held
    assert found.speed_end == pytest.approx(found.speed_rigid, rel=0.02)


@pytest.mark.slow
def test_adiabatic_engine_with_half_the_load_is_held_by_order_two():
    half = {
        "operation.speed": "1200 rpm",
        "load.torque": "8",
        "load.speed": "600 rpm",
        "simulation.turns": "1200",
        "c": "0",
    }
    found = run(cases.load("alpha-stirling", ADIABATIC | half), check="none").settling
    assert found.at[0] == 2.0
    assert found.held and found.settled
    assert found.speed_rigid > 1.3 * found.speed_end


def test_other_runs_are_left_alone():
    assert run(cases.load("alpha-stirling", {"simulation.turns": "5"}), check="none").settling is None
