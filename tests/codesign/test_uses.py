"""What is done with a co-design: lost combustion, controller, losses, map, cylinders, other hardware, small errors."""

import dataclasses

import numpy as np
import pytest
from codesigns import bound, design, task
from hinges import monotone_seal_torque

from mechsym import cases
from mechsym.codesign import running, scenarios
from mechsym.codesign.front import ripple_map
from mechsym.codesign.loss import gas_turn, losses, with_losses
from mechsym.codesign.machines import from_curve, places
from mechsym.codesign.manoeuvres import hold
from mechsym.codesign.points import bare_flywheel
from mechsym.codesign.rank import even_firing, rank, together
from mechsym.codesign.realise import realise
from mechsym.codesign.verify import worst
from mechsym.cycle.pressure import unfired
from mechsym.errors import BadInput
from mechsym.hinge.rollers import HingeLosses
from mechsym.jobs.codesign import points as points_of
from mechsym.jobs.machine import machine
from mechsym.mechanisms.record import curves


@pytest.mark.parametrize(("inertia", "shares"), [(2056.0, (0.698, 0.714, 0.720)), (1000.0, (0.349, 0.403, 0.421))])
def test_lost_combustion(inertia, shares):
    found = [scenarios.misfire(design(), k, inertia) for k in (0, 2, 5)]
    assert [s.speed_min for s in found] == pytest.approx(shares, abs=0.01)
    assert all(abs(s.run.energy_residual) < 1e-5 for s in found)


@pytest.mark.slow
def test_a_small_flywheel_stalls_and_is_made_heavy_enough():
    assert scenarios.misfire(design(), 0, 700.0).run.stalled
    needed = scenarios.misfire_flywheel(design(0.05), 0.5)
    assert min(scenarios.misfire_shares(design(0.05), needed)) == pytest.approx(0.5, abs=2e-3)
    least = scenarios.misfire_flywheel(design(), 0.5, 0.0)  # of a design that has more than that
    assert least < design().flywheel == scenarios.misfire_flywheel(design(), 0.5)
    assert min(scenarios.misfire_shares(design(), least)) == pytest.approx(0.5, abs=2e-3)


def test_a_turn_without_combustion_is_the_compression_line_both_ways():
    case = cases.load("zotov-89")
    engine, cycle = machine(case), case.need("cycle")
    area, phi = np.pi / 4 * cycle.bore**2, np.linspace(0, 2 * np.pi, 721)
    x = curves(engine.mechanism, phi)["x"]
    volume = area * (x + x.max() / (cycle.compression_ratio - 1))
    from_dead_centre = np.abs((phi + np.pi) % (2 * np.pi) - np.pi)
    line = 0.9749 * cycle.p_s - 0.1029e5  # while scavenging
    at_evc = np.interp(-cycle.evc, phi, volume)
    closed = from_dead_centre < -cycle.evc
    expected = (np.where(closed, line * (at_evc / volume) ** cycle.n_c, line) - cycle.p_back) * area
    assert unfired(engine.gas.force, 2 * np.pi)(phi) == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("k", [2, 5])
def test_controller_takes_ten_per_cent_away_in_a_turn(k):
    held = hold(design(), k, 0.10, turns=3)
    assert held.pressure_error[0, 0] == pytest.approx(0.10)
    assert np.abs(held.pressure_error[1:]).max() < 0.003
    slow = hold(design(), k, 0.10, turns=2, rate=0.02)
    assert slow.pressure_error[1, 0] == pytest.approx(0.08, abs=1e-9)


def test_losses_of_the_specification():
    lost, loads = losses(design(), HingeLosses()), [p.load_torque for p in task().points]
    for kind, share in (("bearing", 0.03), ("seal", 0.024), ("guide", 0.023)):
        assert getattr(lost[2], kind) / loads[2] == pytest.approx(share, abs=0.0025)
    stored = running.spring_energy(design().tracks[0], design().tracks[0].p0[2], np.linspace(0, 2 * np.pi, 1441))
    assert lost[2].seal == pytest.approx(monotone_seal_torque(float(np.ptp(stored)), 0.01), rel=0.01)


@pytest.mark.parametrize(("tau", "index"), [(10.0, 1.400), (1.0, 1.397), (0.139, 1.272), (0.05, 1.101)])
def test_index_of_the_gas_on_the_designed_guide(tau, index):
    made = gas_turn(design().tracks[0], design().tracks[0].p0[2], task().points[2], HingeLosses(tau=tau))
    assert made.n_effective == pytest.approx(index, abs=2e-3)


def test_ripple_with_losses_is_small_when_the_fill_is_set_anew():
    found = with_losses(design(), 2, HingeLosses())
    assert found.ripple < 0.02 and 1.0 < found.fill < 1.15


def test_map_agrees_with_the_programme_at_its_points():
    case = cases.load("zotov-89")
    loads = dataclasses.replace(case.need("codesign"), curve="constant_speed", speeds=(task().points[5].omega,),
                                loads=(0.3, 0.5, 0.75, 1.0))  # fmt: skip
    found = ripple_map(design(), points_of(case, loads), np.array([task().points[5].omega]), np.array([20e5]))
    assert found.ripple[0, 0] == pytest.approx(design().ripple[5], rel=2e-3)
    assert found.p0[0, 0] == pytest.approx(design().tracks[0].p0[5], rel=1e-3)


def test_cylinders_add_up_and_cancel():
    one = task().points[2]
    two = together(one, even_firing(2, one.period))
    phi = np.linspace(0, 2 * np.pi, 61)
    swing = two.work(phi) - two.work(phi)[0]
    assert swing == pytest.approx(one.work(phi) + one.work(phi + np.pi) - one.work(0) - one.work(np.pi), abs=1e-3)
    assert two.load_torque == pytest.approx(2 * one.load_torque)
    six = together(one, even_firing(6, one.period))
    assert bare_flywheel([six], 0.02) < 0.3 * bare_flywheel([one], 0.02)
    # a spread of the cylinders' pressures brings the lower orders back
    uneven = together(one, even_firing(6, one.period), (1.1, 1, 1, 1, 1, 0.9))
    assert bare_flywheel([uneven], 0.02) > bare_flywheel([six], 0.02)
    assert uneven.torque(phi).mean() == pytest.approx(six.torque(phi).mean(), rel=0.1)


def test_other_hardware_gives_the_same_works_for_less_loss():
    made = realise(design(), "bearing_loss")
    assert made.status == "optimal"
    assert made.after[0] < 0.8 * made.before[0]
    (new,), (old,) = made.design.tracks, design().tracks
    phi = np.linspace(0, 2 * np.pi, 181)
    stored = [running.spring_energy(t, t.p0[5], phi) for t in (new, old)]
    assert np.ptp(stored[0] - stored[1]) < 5e-3 * np.ptp(stored[1])
    with pytest.raises(BadInput, match="goal"):
        realise(design(), "beauty")


def test_small_errors_cost_ripple():
    ideal = worst(design(), {})
    assert ideal == pytest.approx(0.02, rel=2e-3)
    assert worst(design(), {"load": 0.02}) > ideal < worst(design(), {"p0": 0.01})
    assert worst(design(), {"flywheel": 0.02}) < ideal < worst(design(), {"flywheel": -0.02})


def test_any_torque_curve_is_a_point():
    phi = np.arange(360) * np.pi / 180
    made = from_curve(phi, 100 * np.cos(phi) - 50, 2.0, 75.0)
    assert made.load_torque == pytest.approx(-50)
    assert np.ptp(made.work(phi)) == pytest.approx(200, rel=1e-4)
    assert rank([made], 1).bare == pytest.approx(200 / 75**2, rel=1e-3)
    with pytest.raises(BadInput, match="ascending"):
        from_curve([0, 1, 1, 2, 3, 4, 5, 6], np.zeros(8), 1.0, 1.0)


def test_points_from_a_file(tmp_path):
    file = tmp_path / "points.csv"
    file.write_text("speed [rpm],load [bar],weight\n60,4,0.2\n142,20,0.8\n")
    settings = dataclasses.replace(cases.load("zotov-89").need("codesign"), curve=str(file))
    found = places(settings)
    assert [(p.mep, p.weight) for p in found] == [(4e5, 0.2), (20e5, 0.8)]
    assert found[1].omega == pytest.approx(142 * np.pi / 30)
    file.write_text("n,load [bar]\n60,4\n")
    with pytest.raises(BadInput, match="headings"):
        places(settings)


@pytest.mark.slow
def test_scenarios_of_a_point_are_told_in_words():
    rows = scenarios.table(design(), [5])
    names = {
        "misfire",
        "load step",
        "load step, governed",
        "scatter 1%",
        "scatter 3%",
        "burst",
        "standing still",
        "astern",
    }
    assert {row.name for row in rows} == names
    assert "stops" in next(row for row in rows if row.name == "burst").outcome
    step = next(row for row in rows if row.name == "load step")
    assert step.speed_min < 1 and not step.run.stalled
    assert bound().pays == 3
