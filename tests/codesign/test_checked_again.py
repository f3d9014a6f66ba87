"""A design held against its limits, under errors, tried again and started: by numbers that are made for it."""

import dataclasses
import importlib
import math
from types import SimpleNamespace as Made

import numpy as np
import pytest
from codesigns import design, task

from mechsym.codesign import manoeuvres, running, scenarios
from mechsym.codesign.points import sample
from mechsym.codesign.running import TimeRun
from mechsym.codesign.unknowns import shapes
from mechsym.errors import BadInput

# the room gives functions of the same names
front, realise, verify = (
    importlib.import_module(f"mechsym.codesign.{name}") for name in ("front", "realise", "verify")
)


def _leg(phi, omega, stalled=False):
    phi, omega = np.array(phi, float), np.array(omega, float)
    t = np.concatenate([[0.0], np.cumsum(np.diff(phi) / ((omega[1:] + omega[:-1]) / 2))])
    return TimeRun(t=t, phi=phi, omega=omega, stalled=stalled, energy_residual=0.0)


def test_only_the_last_turn_counts():
    # two turns at 10 and one at 20 rad/s
    turned = np.array([0.0, 2.0, 4.0, 5.0, 6.0]) * math.pi
    run = TimeRun(
        t=np.array([0.0, 0.2, 0.4, 0.45, 0.5]) * math.pi, phi=turned, omega=turned, stalled=False, energy_residual=0.0
    )
    assert scenarios._last_turn(run) == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({}, []),
        ({"rho_max": 1.0}, ["radius that the rollers reach"]),
        ({"reaction_min": np.array([5.0, 0.0])}, ["a roller leaves its track"]),
        ({"reaction_min": np.array([5.0, 1e-3])}, []),
        ({"z_min": 0.0}, ["smallest closing 0 mm"]),
    ],
)
def test_what_a_guide_breaks(monkeypatch, changes, words):
    monkeypatch.setattr(verify, "_asked", lambda track, design: ())
    track = design().tracks[0]
    h = track.hardware
    loads = {"rho_max": 1.0 - h.radius, "reaction_min": np.array([5.0]), "z_min": h.z_margin, **changes}
    told = verify._broken(Made(**loads), track, Made(task=Made(widest=1.0)))
    assert len(told) == len(words) and all(one.startswith(start) for one, start in zip(told, words, strict=True))


def test_a_rounding_breaks_nothing(monkeypatch):
    monkeypatch.setattr(verify, "_asked", lambda track, design: ())
    track = design().tracks[0]
    h, slack = track.hardware, verify._SLACK
    for share, count in ((0.5, 0), (2.0, 2)):  # of the slack that is allowed for
        loads = Made(
            rho_max=1 + share * slack - h.radius,
            reaction_min=np.array([5.0]),
            z_min=h.z_margin - share * slack * h.spring.H,
        )
        told = verify._broken(loads, track, Made(task=Made(widest=1.0)))
        assert len(told) == count


def test_a_point_that_stops_has_no_run_and_others_have_turns_by_their_period(monkeypatch):
    asked = []
    steady = [
        Made(speed_mean=None, speed_ripple=None, omega=None),
        Made(speed_mean=9.0, speed_ripple=0.02, omega=np.array([9.5])),
    ]
    monkeypatch.setattr(verify.running, "steady", lambda machine: steady.pop(0))
    monkeypatch.setattr(verify, "machine_at", lambda design, k: k)
    monkeypatch.setattr(
        verify.running,
        "run",
        lambda machine, start, turns: asked.append((machine, start, turns)) or Made(energy_residual=1e-9),
    )
    monkeypatch.setattr(verify.running, "ripple_of_last_turn", lambda run, period: period / 100)
    monkeypatch.setattr(verify, "used", lambda design: {})
    two_turns = Made(points=(Made(period=4 * math.pi),) * 2, losses=None)
    checked = verify.verify(Made(task=two_turns, tracks=(), ripple=np.array([0.01, 0.02])))
    assert asked == [(1, 9.5, verify.PERIODS * 2)]
    assert (
        np.isnan(checked.steady_ripple[0]) and np.isnan(checked.time_ripple[0]) and np.isnan(checked.energy_residual[0])
    )
    assert checked.steady_ripple[1] == 0.02 and checked.time_ripple[1] == pytest.approx(0.04 * math.pi)


def test_errors_of_a_spring_are_shares_but_of_its_index():
    track = design().tracks[0]
    spring = track.hardware.spring
    off = verify._changed(track, {"n": 0.01, "A": 0.02, "moving_mass": 0.1}).hardware
    assert off.spring.n == pytest.approx(spring.n + 0.01) and off.spring.A == pytest.approx(1.02 * spring.A)
    assert off.moving_mass == pytest.approx(1.1 * track.hardware.moving_mass)
    assert verify._changed(track, {}).hardware == track.hardware


def test_more_flywheel_makes_less_ripple():
    wide = dataclasses.replace(design(), flywheel=400.0)
    less, same, more = (verify.worst(wide, {"flywheel": share}) for share in (-0.5, 0.0, 0.5))
    assert less > same > more
    assert verify.worst(wide, {}) == same


def test_a_second_spring_starts_with_one_swing_in_a_period():
    two = dataclasses.replace(task(), springs=2)
    samples = sample(two.points, 64)
    first, second = shapes(two, samples)
    H, period = two.hardware.spring.H, two.points[0].period
    assert first.min() >= 0 and first.max() < H
    places = np.array([0.0, 0.25, 0.5, 0.75])
    there = np.interp(places * period, samples.phi, second)
    assert there == pytest.approx(H * (0.15 + 0.05 * np.cos(2 * math.pi * places)), abs=1e-3 * H)


def test_gas_is_a_goal_where_there_is_gas():
    none = dataclasses.replace(design(), tracks=())
    done = realise.realise(none, "gas_volume")
    assert done.status == "optimal" and done.before == done.after == ()
    coil = Made(task=Made(hardware=Made(spring=Made(gas=False))))
    with pytest.raises(BadInput, match="asks for gas"):
        realise.realise(coil, "spring_pressure")
    with pytest.raises(BadInput, match="is not an option"):
        realise.realise(none, "price")


def test_what_fails_from_a_neighbour_is_tried_from_the_start(monkeypatch):
    asked = []

    def solved(wanted, ready, near=None):
        asked.append((wanted.ripple, near))
        status = "infeasible" if wanted.ripple == 0.02 and near is not None else "optimal"
        return Made(status=status, task=wanted, flywheel=100 * wanted.ripple)

    monkeypatch.setattr(front, "solve", solved)
    monkeypatch.setattr(front, "bare_flywheel", lambda points, ripple: 1.0)
    monkeypatch.setattr(front, "worth_it", lambda one, bare, saving: one)
    designs = front.front(task(), (0.05, 0.02, 0.01), ready=object())
    assert [d.task.ripple for d in designs] == [0.01, 0.02, 0.05] and {d.status for d in designs} == {"optimal"}
    assert [(ripple, near and near.task.ripple) for ripple, near in asked] == [
        (0.01, None), (0.02, 0.01), (0.02, None), (0.05, 0.02)
    ]  # fmt: skip


def test_other_numbers_of_springs_are_told_where_they_work(monkeypatch):
    monkeypatch.setattr(front, "front", lambda wanted, ripples: [
        Made(task=Made(ripple=ripple), status=status, flywheel=7.0)
        for ripple, status in zip(ripples, ("optimal", "infeasible"), strict=True)
    ])  # fmt: skip
    rows = front.springs_of(task(), (0.02, 0.01), 2)
    assert [(r.name, r.ripple, r.flywheel_inertia) for r in rows] == [
        ("two springs", 0.02, 7.0),
        ("two springs", 0.01, None),
    ]


def test_measured_speeds_scatter_by_their_noise(monkeypatch):
    seen = []
    leg = _leg([0.0, math.pi, 2 * math.pi], [10.0, 11.0, 10.0])
    ripples = [0.03, None, 0.01]
    monkeypatch.setattr(running, "run", lambda machine, start, turns: leg)
    monkeypatch.setattr(running, "ripple_of_last_turn", lambda run, period: ripples[len(seen)])
    monkeypatch.setattr(
        manoeuvres, "pressure_error", lambda machine, turn: seen.append(turn.omega / leg.omega - 1) or np.zeros(1)
    )
    held = manoeuvres.hold(design(), 1, 0.1, turns=3, noise=0.02)
    first = 0.02 * np.random.default_rng(9).standard_normal(3)
    assert (
        len(seen) == 3
        and seen[0] == pytest.approx(first)
        and held.pressure_error == pytest.approx(np.full((3, 1), 0.1))
    )
    assert held.ripple == pytest.approx([0.03, math.nan, 0.01], nan_ok=True)


def test_a_controller_takes_its_share_and_no_more_than_its_rate(monkeypatch):
    leg = _leg([0.0, math.pi, 2 * math.pi], [10.0, 11.0, 10.0])
    monkeypatch.setattr(running, "run", lambda machine, start, turns: leg)
    monkeypatch.setattr(
        manoeuvres,
        "pressure_error",
        lambda machine, turn: np.array([0.1 * float(design().tracks[0].p0[1])]),
    )
    whole = manoeuvres.hold(design(), 1, 0.1, turns=3, gain=0.5)
    assert whole.pressure_error[:, 0] == pytest.approx([0.1, 0.05, 0.0])
    slow = manoeuvres.hold(design(), 1, 0.1, turns=3, gain=0.5, rate=0.02)
    assert slow.pressure_error[:, 0] == pytest.approx([0.1, 0.08, 0.06])
    monkeypatch.setattr(running, "run", lambda machine, start, turns: dataclasses.replace(leg, stalled=True))
    assert len(manoeuvres.hold(design(), 1, 0.1, turns=3).pressure_error) == 1
