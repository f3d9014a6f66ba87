"""Errors of a co-design beside machines that are made with them, by another way to the steady motion."""

import dataclasses

import numpy as np
import pytest

from mechsym.codesign import running
from mechsym.codesign.points import even_angles
from mechsym.codesign.task import CoDesign, Track
from mechsym.codesign.unknowns import closing
from mechsym.codesign.verify import spread, worst
from mechsym.hinge.guide import setting_of
from mechsym.periodic.pieces import PPoly
from tests import codesigns

POINT = 2
NEAR = 5e-5  # 720 even angles pass a peak of the speed by up to a quarter of a degree; measured: 2e-5


@pytest.fixture(scope="module")
def design():
    """A guide that is cut for one point as if its rollers had no mass, with a flywheel."""
    task = codesigns.task(at=(POINT,))
    (point,), hardware = task.points, task.hardware
    phi, setting = even_angles(point), setting_of(hardware.spring)
    work = point.work(phi)
    stored = float(hardware.spring.energy(hardware.z_margin)) + work.max() - work
    z = closing(hardware, stored, setting, hardware.spring.H * (1 - 1e-6))
    track = Track(hardware=hardware, z=PPoly.spline(np.append(phi, point.period), np.append(z, z[0]), periodic=True),
                  p0=np.array([setting]))  # fmt: skip
    return CoDesign(
        task=task, status="optimal", reason="", flywheel=3000.0, tracks=(track,), ripple=np.zeros(1), active=(),
        iterations=0, wall=0.0, solution={},
    )  # fmt: skip


def ripple_of(design, hardware=None, flywheel=1.0, pressure=1.0):
    """The ripple of a machine with other numbers, by collocation over the angle."""
    (track,), (point,) = design.tracks, design.task.points
    other = dataclasses.replace(track, hardware=hardware or track.hardware, p0=pressure * track.p0)
    return running.steady(running.running(point, (other,), 0, flywheel * design.flywheel)).speed_ripple


def test_nothing_off_leaves_what_the_masses_of_the_rollers_do(design):
    assert worst(design, {}) == pytest.approx(ripple_of(design), rel=NEAR) and worst(design, {}) > 1e-3
    (track,) = design.tracks
    light = track.hardware.changed({"moving_mass": 0.0, "roller_inertia": 0.0})
    massless = dataclasses.replace(design, tracks=(dataclasses.replace(track, hardware=light),))
    assert worst(massless, {}) < 1e-2 * worst(design, {})


@pytest.mark.parametrize("share", [-0.2, 0.3])
def test_the_mass_on_the_rollers(design, share):
    hardware = design.tracks[0].hardware
    other = hardware.changed({"moving_mass": (1 + share) * hardware.moving_mass})
    assert worst(design, {"moving_mass": share}) == pytest.approx(ripple_of(design, other), rel=NEAR)


def test_flywheel_and_pressure(design):
    assert worst(design, {"flywheel": -0.2}) == pytest.approx(ripple_of(design, flywheel=0.8), rel=NEAR)
    assert worst(design, {"p0": 0.05}) == pytest.approx(ripple_of(design, pressure=1.05), rel=NEAR)


def test_numbers_of_the_spring_by_their_share_and_an_index_by_what_it_is_off(design):
    hardware = design.tracks[0].hardware
    for name in ("A", "H"):
        other = hardware.changed({name: 1.02 * getattr(hardware.spring, name)})
        assert worst(design, {name: 0.02}) == pytest.approx(ripple_of(design, other), rel=NEAR)
    other = hardware.changed({"n": hardware.spring.n + 0.03})
    assert worst(design, {"n": 0.03}) == pytest.approx(ripple_of(design, other), rel=NEAR)


def test_more_load_is_more_work_of_the_gas_and_not_of_the_masses(design):
    (point,) = design.task.points
    own = point.omega**2 / 2

    def heavier(phi):
        return own * point.inertia(phi) + 1.1 * (point.work(phi) - own * point.inertia(phi))

    task = dataclasses.replace(design.task, points=(dataclasses.replace(point, work=heavier),))
    assert worst(design, {"load": 0.1}) == pytest.approx(worst(dataclasses.replace(design, task=task), {}), rel=1e-9)
    assert worst(design, {"load": 0.1}) > 1.5 * worst(design, {})


def test_each_error_alone_at_two_sigma_and_all_drawn(design):
    result = spread(design, count=40)
    assert {name: result.errors[name] for name in ("load", "moving_mass", "flywheel", "p0")} == {
        "load": 0.01, "moving_mass": 0.05, "flywheel": 0.01, "p0": 0.005,
    }  # fmt: skip
    for name, sigma in result.errors.items():
        assert result.alone[name] == (worst(design, {name: -2 * sigma}), worst(design, {name: 2 * sigma}))
    assert result.samples.shape == (40,) and (np.diff(result.samples) >= 0).all()
    assert result.samples[0] < worst(design, {}) < result.samples[-1]
    assert result.samples[0] < result.p95 <= result.samples[-1]
