"""Operating points: the family of the built-in case, the bare engine, the bound that knows no guide."""

import dataclasses

import numpy as np
import pytest
from codesigns import bound, cut, task

from mechsym.codesign.basis import basis, curve, fitted, matrices
from mechsym.codesign.machines import scavenge_pressure
from mechsym.codesign.points import bare_flywheel, bare_ripple, grid, sample
from mechsym.codesign.rank import flywheel_estimate, rank
from mechsym.errors import BadInput


def test_family_of_the_propeller_curve():
    points = task().points
    speeds = np.array([p.omega for p in points]) * 30 / np.pi
    assert speeds == pytest.approx([60, 75, 89, 105, 120, 142])
    assert [p.load / 1e5 for p in points] == pytest.approx(20 * (speeds / 142) ** 2)
    # mean torque is mean pressure by swept volume: bore 0.3 m, stroke 1 m
    swept = np.pi / 4 * 0.3**2
    assert [p.load_torque * 2 * np.pi / p.load / swept for p in points] == pytest.approx([1] * 6, rel=1e-9)


def test_bare_engine_needs_what_the_prototype_found():
    assert bare_flywheel(task().points, 0.02) == pytest.approx(41517, rel=3e-3)
    assert bare_flywheel(task().points, 0.05) == pytest.approx(16674, rel=3e-3)


def test_bare_ripple_is_that_of_weak_ripple_for_a_heavy_flywheel():
    point = task().points[0]
    swing = np.ptp(point.work(np.linspace(0, 2 * np.pi, 721))) / point.omega**2
    inertia = np.mean(point.inertia(np.linspace(0, 2 * np.pi, 721)))
    assert bare_ripple(point, 1e6) == pytest.approx(swing / (1e6 + inertia), rel=1e-3)
    assert bare_ripple(point, 10.0) is None


def test_bound_of_one_two_and_three_springs():
    assert bound().swing[0] == pytest.approx(44.80, abs=0.05)
    assert bound().swing[1] == pytest.approx(10.08, abs=0.05)
    assert bound().swing[2] < 0.5
    assert bound().singular_values[:4] == pytest.approx([1, 0.040, 0.010, 0.0002], abs=5e-4)
    assert bound().pays == 3
    shares = bound().best[0].shares[:, 0] * np.array([p.omega for p in task().points]) ** 2
    assert shares / shares[0] == pytest.approx([1, 1.381, 1.990, 2.805, 3.680, 5.151], rel=1e-3)


@pytest.mark.parametrize(("at", "swing"), [((1, 2, 3, 4, 5), 17.22), ((2, 3, 4, 5), 10.20)])
def test_bound_of_narrower_ranges(at, swing):
    assert rank(task(at=at).points, 1).swing[0] == pytest.approx(swing, abs=0.02)


def test_bound_is_what_its_shapes_leave():
    for best in bound().best:
        left = np.ptp(bound().wanted - best.shares @ best.shapes, axis=1)
        assert left.max() == pytest.approx(best.swing, rel=1e-9)


def test_as_many_springs_as_points_leave_nothing():
    assert rank(task(at=(0, 5)).points, 2).swing[1] == 0.0
    assert flywheel_estimate(task().points, bound(), 0.02) == pytest.approx(44.80 / 0.02 - 115, rel=2e-3)


def test_guide_cut_for_one_speed():
    assert cut().flywheel == pytest.approx(3530, rel=5e-3)
    assert cut().ripple.max() == pytest.approx(0.02, abs=1e-6)
    assert cut().ripple[2] < 1e-5  # where it was cut


def test_grid_contains_the_kinks():
    phi = grid(2 * np.pi, (1.0, 4.0), 180)
    assert all(np.abs(phi - k).min() < 1e-11 for k in (0.0, 1.0, 4.0))
    assert np.diff(phi).max() < 1.05 * 2 * np.pi / 180
    assert sample(task().points, 180).weights.sum() == pytest.approx(1)


def test_splines_are_periodic_and_their_derivatives_true():
    made = basis(2 * np.pi, (0.05, 1.9, 4.36), 60)
    assert {0.05, 1.9, 4.36} <= set(made.knots)
    phi = np.linspace(0, 2 * np.pi, 181)
    c = fitted(made, np.cos(phi), phi)
    for order, (matrix, true) in enumerate(zip(matrices(made, phi), (np.cos, lambda x: -np.sin(x)), strict=False)):
        values = np.asarray((matrix @ c).full()).ravel()
        assert values == pytest.approx(true(phi), abs=1e-4)
        poly = curve(made, c).derivative(order) if order else curve(made, c)
        assert values == pytest.approx(poly(phi), abs=1e-9)


def test_scavenge_pressure_is_read_from_text():
    text = "p_s = max(1.05, 1.6 + (mep-8)/6) bar"
    assert [scavenge_pressure(text, mep * 1e5) / 1e5 for mep in (2, 8, 20)] == pytest.approx([1.05, 1.6, 3.6])


@pytest.mark.parametrize("text", ["mep.real", "__import__('os')", "9**9**9", "1/(mep-8)", "-1", "mep +"])
def test_scavenge_pressure_refuses_other_texts(text):
    with pytest.raises(BadInput, match=r"codesign\.scavenge"):
        scavenge_pressure(text, 8e5)


def test_points_of_different_periods_are_refused():
    first = task().points[0]
    with pytest.raises(BadInput, match="periods"):
        sample((first, dataclasses.replace(first, period=4 * np.pi)), 60)
