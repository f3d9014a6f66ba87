"""Standing still, starting, turning the other way, and a governor."""

import dataclasses
import re

import numpy as np
import pytest
from codesigns import design

from mechsym.codesign import manoeuvres, running, scenarios


def machine(k=2):
    return running.running(design().task.points[k], design().tracks, k, design().flywheel)


def test_a_resting_shaft_feels_no_torque_and_is_pushed_back():
    found, made = manoeuvres.standstill(machine()), machine()
    for angle in found.angles:
        aside = np.array([angle - 0.02, angle + 0.02])
        torque = made.point.misfire(aside) + running.spring_torque(made.tracks[0], made.pressures[0], aside)
        assert torque[0] > 0 > torque[1]
    assert found.torque > found.vented > 0


@pytest.mark.parametrize(("share", "stalls"), [(0.98, True), (1.02, False)])
def test_the_starting_torque_is_that_of_a_run_in_time(share, stalls):
    found = manoeuvres.start(machine(), share)
    assert found.stalled is stalls
    assert abs(found.energy_residual) < 1e-6


def test_a_guide_met_backwards_twice_is_the_guide():
    track, phi = design().tracks[0], np.linspace(-7, 7, 301)
    back = manoeuvres.mirrored(track, 2 * np.pi)
    assert back.z(phi) == pytest.approx(track.z(-phi), abs=1e-13)
    assert manoeuvres.mirrored(back, 2 * np.pi).z(phi) == pytest.approx(track.z(phi), abs=1e-13)


def test_the_wrong_sense_of_rotation_spoils_the_ripple():
    ahead, back = (running.steady(m) for m in (machine(), manoeuvres.astern(machine())))
    assert ahead.speed_ripple < 0.021 < 0.1 < (back.speed_ripple or 1.0)


@pytest.mark.slow
def test_a_governor_brings_the_speed_back_after_a_jump_of_the_load():
    made = machine(5)
    start = running.steady(made)
    heavier = dataclasses.replace(made, load=dataclasses.replace(made.load, torque=1.1 * made.load.torque))
    found = manoeuvres.governed(heavier, float(start.omega[0]), 20)
    speed = [2 * np.pi / np.ptp(found.t[(found.phi >= a) & (found.phi <= a + 2 * np.pi)]) for a in (0, 38 * np.pi)]
    assert speed[0] < 0.995 * made.point.omega
    assert speed[1] == pytest.approx(made.point.omega, rel=2e-3)
    assert abs(found.energy_residual) < 1e-5


def test_a_stopped_shaft_rests_where_it_is_pushed_to():
    made = machine()
    angles = manoeuvres.standstill(made).angles
    for angle in angles:
        assert manoeuvres.rest_from(made, angle + 0.05) == pytest.approx(angle, abs=1e-9)
        aside = manoeuvres.rest_from(made, angle - 0.3)
        assert min(abs(aside - a) for a in angles) < 1e-9


@pytest.mark.slow
def test_what_else_happens_is_told():
    found = {row.name: row for row in scenarios.rows(design(), 5)}
    assert set(found) == {"leak", "controller", "start", "stop"}
    assert "turns more, stands at" in found["stop"].outcome and found["stop"].run.stalled
    assert found["start"].speed_max > 0 and not found["start"].run.stalled
    first, last = re.search(r"ripple ([\d.]+) % to ([\d.]+) %", found["controller"].outcome).groups()
    assert float(first) > 1.5 * float(last) and float(last) == pytest.approx(2, abs=0.3)
    assert all(abs(row.run.energy_residual) < 1e-5 for row in found.values())
