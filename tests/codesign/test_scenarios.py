"""What happens to a machine whose motion has a formula: a constant torque, one harmonic, no guide.

The energy I omega^2/2 changes by what gas gives and load takes, so every speed at a dead centre is a square root.
"""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
import pytest

from mechsym import periodic
from mechsym.codesign import manoeuvres, running, scenarios
from mechsym.codesign.manoeuvres import _FUEL, _INTEGRAL, _PROPORTIONAL
from mechsym.codesign.points import Point
from mechsym.codesign.running import Running, TimeRun
from mechsym.machine.loads import ConstantLoad

OMEGA, INERTIA, TORQUE, SWING, UNFIRED = 12.0, 900.0, 800.0, 3000.0, -60.0
TURN = 2 * math.pi


def constant(value):
    return periodic.fit(lambda phi: np.full_like(np.asarray(phi, dtype=float), value), [], TURN)


def machine(swing=SWING, flywheel=0.0):
    torque = periodic.fit(lambda phi: TORQUE + swing * np.cos(2 * phi), [], TURN)
    point = Point(
        omega=OMEGA, load_torque=TORQUE, law="constant", period=TURN, kinks=(), torque=torque,
        work=constant(0.0), inertia=constant(INERTIA), misfire=constant(UNFIRED),
    )  # fmt: skip
    load = ConstantLoad(torque=TORQUE)
    return Running(point=point, tracks=(), pressures=(), flywheel=flywheel, load=load, torque=torque, kinks=())


def speed_after(start, work):
    return math.sqrt(start**2 + 2 * work / INERTIA)


def test_a_load_step_brakes_by_its_work():
    row, (start, mean) = scenarios._load_step(machine(), 3), scenarios.steady_speed(machine())
    # sin 2 phi has its mean in time a little beside that in angle
    assert start == pytest.approx(mean, rel=1e-3) and mean == pytest.approx(OMEGA, rel=1e-6)
    end = speed_after(start, -0.1 * TORQUE * 10 * TURN)
    assert row.run.omega[-1] == pytest.approx(end, rel=1e-9) and row.point == 3
    assert row.outcome == f"{100 * end / mean:.3g} % of the speed after 10 turns"


def test_a_governor_sets_the_fuel_by_the_turn_before():
    heavier = dataclasses.replace(machine(), load=ConstantLoad(torque=1.1 * TORQUE))
    start = 11.97
    turned = running.run(heavier, start, 1.0)
    error = 1 - TURN / turned.t[-1] / OMEGA
    one_turn = INERTIA * OMEGA**2 / (TORQUE * TURN)
    fuel = 1 + one_turn * (_PROPORTIONAL + _INTEGRAL) * error
    assert 1 < fuel < _FUEL[1]
    first = speed_after(start, -0.1 * TORQUE * TURN)
    second = speed_after(first, (fuel * TORQUE + (1 - fuel) * UNFIRED - 1.1 * TORQUE) * TURN)
    governed = manoeuvres.governed(heavier, start, 2)
    assert governed.omega[-1] == pytest.approx(second, rel=1e-8) and governed.phi[-1] == pytest.approx(2 * TURN)
    held = scenarios._governed(machine(), 0)
    assert held.outcome == "100 % of the speed after 40 turns"
    assert held.run.omega.min() < 0.999 * OMEGA < held.speed_max * OMEGA


def test_a_governed_machine_that_stops_is_told():
    brake = dataclasses.replace(machine(0.0), load=ConstantLoad(torque=30 * TORQUE))
    stopped = manoeuvres.governed(brake, OMEGA, 5)
    taken = INERTIA * (OMEGA**2 - (0.02 * OMEGA) ** 2) / 2  # down to a fiftieth of the speed
    assert stopped.stalled and stopped.phi[-1] == pytest.approx(taken / (29 * TORQUE), rel=1e-6)


def test_the_mean_speed_of_the_last_turn():
    t = np.linspace(0, 3, 30001)
    run = TimeRun(t=t, phi=4 * t + t**2, omega=4 + 2 * t, stalled=False, energy_residual=0.0)
    begin = math.sqrt(4 + run.phi[-1] - TURN) - 2  # of phi = 4 t + t^2
    assert scenarios._last_turn(run) == pytest.approx(TURN / (3 - begin), rel=1e-3)


def test_scattered_turns_add_up():
    row, (start, mean) = scenarios._scatter(machine(0.0), 1, 0.03), scenarios.steady_speed(machine(0.0))
    drawn = 0.03 * np.random.default_rng(20).standard_normal(20)
    speeds = [speed_after(start, TORQUE * TURN * work) for work in (0.0, *np.cumsum(drawn))]
    assert row.run.omega[-1] == pytest.approx(speeds[-1], rel=1e-9)
    assert row.outcome == f"ripple over all turns {100 * np.ptp(speeds) / mean:.3g} %"
    assert row.speed_min == pytest.approx(min(speeds) / mean, rel=1e-6)


def test_without_fuel_a_shaft_coasts_and_stops():
    slow = dataclasses.replace(machine(0.0, 4000.0), load=ConstantLoad(torque=100.0))
    vented = scenarios._vented(slow, 0)
    end = math.sqrt(OMEGA**2 + 2 * (UNFIRED - 100.0) * 20 * TURN / (INERTIA + 4000.0))
    assert vented.run.omega[-1] == pytest.approx(end, rel=1e-9)
    assert vented.outcome == f"still {end / OMEGA:.2f} after 20 turns"
    turned = INERTIA * (OMEGA**2 - (0.02 * OMEGA) ** 2) / 2 / (TORQUE - UNFIRED)
    fast = scenarios._vented(machine(0.0), 0)
    assert fast.outcome == f"the shaft stops after {math.degrees(turned):.0f} deg"
    assert (fast.speed_min, fast.speed_max) == (None, None)
    unknown = dataclasses.replace(machine(), point=dataclasses.replace(machine().point, misfire=None))
    assert scenarios._vented(unknown, 0).run is None


@pytest.fixture
def design(monkeypatch):
    """Two points of the machine without guides, which take the flywheel that is asked for."""
    points = (machine(0.0).point, machine(0.0).point)
    monkeypatch.setattr(scenarios, "machine_at", lambda _, k, flywheel: machine(0.0, flywheel))
    return SimpleNamespace(task=SimpleNamespace(points=points), flywheel=100.0, points=points)


@pytest.mark.parametrize("share", [0.9, 0.99])
def test_the_flywheel_that_a_lost_combustion_asks_for(design, share):
    lost = (TORQUE - UNFIRED) * TURN
    wanted = 2 * lost / (OMEGA**2 * (1 - share**2)) - INERTIA
    assert scenarios.misfire_flywheel(design, share) == pytest.approx(max(wanted, 100.0), rel=2e-3)
    assert scenarios.misfire_flywheel(design, share, 1e6) == 1e6
    left = math.sqrt(OMEGA**2 - 2 * lost / (INERTIA + 100.0)) / OMEGA
    assert scenarios.misfire_shares(design) == pytest.approx([left, left], rel=1e-6)
    assert scenarios.misfire(design, 1, 500.0).outcome.startswith("lowest speed ")


def test_a_stall_leaves_no_speed_and_an_unknown_misfire_no_flywheel(design, monkeypatch):
    heavy = dataclasses.replace(machine(0.0).point, misfire=constant(-1e5))
    monkeypatch.setattr(scenarios, "machine_at", lambda *_: dataclasses.replace(machine(0.0), point=heavy))
    design.task.points = (heavy,)
    assert scenarios.misfire_shares(design) == [0.0]
    unknown = dataclasses.replace(heavy, misfire=None)
    design.task.points = (heavy, unknown)
    monkeypatch.setattr(scenarios, "machine_at", lambda *_: dataclasses.replace(machine(0.0), point=unknown))
    assert scenarios.misfire_shares(design)[1] is None and scenarios.misfire_flywheel(design, 0.5) is None


@pytest.mark.parametrize(
    ("ripples", "words"),
    [
        (lambda share: 0.03 + abs(share - 0.9), "ripple 13 %, with 90 % of the pressures 3 %"),
        (
            lambda share: None if share > 0.95 else 0.03 + abs(share - 0.9),
            "no steady motion, with 90 % of the pressures 3 %",
        ),
        (lambda share: None, "no steady motion"),
    ],
)
def test_after_a_scavenge_step_a_ripple_is_told_where_there_is_one(monkeypatch, ripples, words):
    made = machine()
    monkeypatch.setattr(scenarios, "steady_speed", lambda one: (OMEGA, OMEGA))
    monkeypatch.setattr(scenarios.running, "running", lambda *a: dataclasses.replace(made, pressures=(2.0,)))
    monkeypatch.setattr(scenarios.running, "run", lambda *a: None)
    monkeypatch.setattr(
        scenarios.running, "steady", lambda one: SimpleNamespace(speed_ripple=ripples(one.pressures[0] / 2.0))
    )  # fmt: skip
    monkeypatch.setattr(scenarios, "told", lambda name, about, k, mean, run, words: words(run))
    design = SimpleNamespace(tracks=(), flywheel=0.0)
    assert scenarios._scavenge_step(design, made, made.point, 0) == words
