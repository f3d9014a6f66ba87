"""Operating points whose motion, flywheel and bound have a formula: one harmonic of work on a constant inertia."""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from codesigns import OMEGA, OWN, TURN, constant_load, point

from mechsym.codesign.points import bare_flywheel, bare_ripple, grid, motion, sample
from mechsym.codesign.rank import flywheel_estimate, rank
from mechsym.codesign.task import path_of, roller_inertia


@pytest.mark.parametrize("ratio", [1.05, 2.0, 30.0])
def test_a_constant_load_leaves_an_elliptic_integral(ratio):
    inertia, ripple = constant_load(200.0, ratio)
    flywheel = inertia - OWN
    one = point(lambda phi: 200.0 * np.sin(2 * phi))
    assert bare_ripple(one, flywheel) == pytest.approx(ripple, rel=1e-5)
    assert bare_flywheel([one], ripple) == pytest.approx(flywheel, rel=1e-4)
    # of several points the worst counts, and more inertia than is needed needs no flywheel
    calm = point(lambda phi: 20.0 * np.sin(2 * phi))
    assert bare_flywheel([calm, one], ripple) == pytest.approx(flywheel, rel=1e-4)
    heavy = point(lambda phi: 200.0 * np.sin(2 * phi), own=1.01 * inertia)
    assert bare_flywheel([heavy], ripple) == 0.0
    phi, speed = motion(one, one.work, lambda phi: one.inertia(phi) + flywheel)
    energy = inertia * speed**2 / 2 + 200.0 * np.sin(2 * phi)
    assert np.ptp(energy) < 1e-5 * energy.mean()


def test_a_load_with_the_square_of_the_speed_is_a_linear_filter():
    # E' = -w' - a E with a = 2 M / (I omega^2), for w = A cos 2 phi
    amplitude, torque, inertia = 300.0, 2000.0, 10.0
    one = point(lambda phi: amplitude * np.cos(2 * phi), own=inertia, law="propeller", load_torque=torque)
    phi, speed = motion(one, one.work, one.inertia)
    a = 2 * torque / (inertia * OMEGA**2)
    energy = np.real(-2j * amplitude / (2j + a) * np.exp(2j * phi))
    assert speed == pytest.approx(np.sqrt(OMEGA**2 + 2 * energy / inertia), rel=1e-5)
    # without a load to lean on it turns as under a constant one
    free = point(lambda phi: amplitude * np.cos(2 * phi), own=inertia, law="propeller", load_torque=0.0)
    governed = point(lambda phi: amplitude * np.cos(2 * phi), own=inertia)
    assert bare_ripple(free, 0.0) == bare_ripple(governed, 0.0)


@pytest.mark.parametrize(("more", "stops"), [(0.99, False), (1.01, True)])
def test_a_crank_stops_where_the_energy_swings_by_more_than_it_has(more, stops):
    torque, inertia = 2000.0, 10.0
    a = 2 * torque / (inertia * OMEGA**2)
    amplitude = more * inertia * OMEGA**2 / 2 * math.hypot(2, a) / 2
    one = point(lambda phi: amplitude * np.cos(2 * phi), own=inertia, law="propeller", load_torque=torque)
    assert (bare_ripple(one, 0.0) is None) is stops
    assert bare_ripple(one, 0.1 * inertia) is not None


def test_angles_hold_the_kinks_and_means_are_those_of_trapezia():
    assert grid(TURN, (), 8) == pytest.approx(np.arange(8) * TURN / 8)
    assert grid(TURN, (TURN, 1.0 + TURN), 4) == pytest.approx([0, 1, *(1 + (TURN - 1) / 3 * np.arange(1, 3))])
    kinked = [point(lambda phi: 3 + np.sin(phi), kinks=(1.0,)), point(np.cos, omega=5.0, own=9.0, kinks=(2.5,))]
    found = sample(kinked, 50)
    assert {1.0, 2.5} <= set(found.phi) and found.step.sum() == pytest.approx(TURN)
    assert found.omega == pytest.approx([OMEGA, 5.0]) and found.inertia == pytest.approx(OWN)
    assert found.work[1] == pytest.approx(np.cos(found.phi), abs=1e-6)
    ends = np.append(found.phi, TURN)
    values = np.append(found.phi**2, 0.0)
    assert found.weights @ found.phi**2 == pytest.approx(np.trapezoid(values, ends) / TURN)
    assert found.weights.sum() == pytest.approx(1.0)


def test_works_of_one_shape_need_one_spring():
    shape = lambda phi: np.sin(2 * phi) + np.cos(phi) / 2  # noqa: E731
    size = np.ptp(shape(np.linspace(0, TURN, 181)))
    three = [
        point(lambda phi: 5 + 100 * shape(phi)),
        point(lambda phi: 200 * shape(phi), omega=2 * OMEGA),
        point(lambda phi: -150 * shape(phi)),
    ]
    found = rank(three, 2)
    assert found.bare == pytest.approx(150 * size / OMEGA**2, rel=1e-3)
    assert found.singular_values == pytest.approx([1, 0, 0], abs=1e-6)
    assert found.swing == pytest.approx((0, 0), abs=1e-5 * found.bare)
    assert found.pays == 1 and found.best[0].status == "optimal"
    rows = np.array([100, 50, -150])[:, None] * shape(found.phi) / OMEGA**2
    assert found.wanted == pytest.approx(rows, abs=1e-3)  # about their means
    made = found.best[0].shares @ found.best[0].shapes
    assert np.ptp(found.wanted - made, axis=1).max() < 1e-5 * found.bare


def test_as_many_springs_as_points_leave_nothing_and_the_estimate_is_swing_by_ripple():
    # two works that share nothing: half of the sum of both stays at the least, whatever one shape is taken
    two = [point(lambda phi: 90 * np.sin(phi)), point(lambda phi: 90 * np.sin(4 * phi))]
    found = rank(two)
    assert [one.springs for one in found.best] == [1, 2, 3]
    assert found.best[1].status == "exact" and found.swing[1:] == (0.0, 0.0)
    assert found.singular_values == pytest.approx([1, 1], abs=1e-6)
    assert 0.5 * found.bare < found.swing[0] < found.bare
    assert found.pays == 0
    left = found.swing[0] / 0.05 - OWN
    assert flywheel_estimate(two, found, 0.05) == pytest.approx(left, rel=1e-9)
    assert flywheel_estimate(two, found, 0.05, 2.0) == pytest.approx(left - 2.0, rel=1e-9)
    assert flywheel_estimate(two, found, 10.0) == 0.0


def test_a_cycle_of_two_turns_is_looked_at_over_both():
    half = point(lambda phi: 90 * np.sin(phi / 2), period=2 * TURN)
    found = rank([half, half], 1)
    assert found.phi.size == 360 and found.bare == pytest.approx(180 / OMEGA**2, rel=1e-3)
    assert found.pays == 1


def test_the_path_of_rollers_is_that_of_the_closing_over_the_angle_of_their_own_shaft():
    # c = 2 rollers close z = 0.1 sin^2 phi; the guide's shaft turns three times as fast as the crank
    hardware = SimpleNamespace(count=2, shaft_ratio=3.0)
    phi = np.linspace(0.1, 3.0, 7)
    path = path_of(hardware, 0.6, 0.1 * np.sin(phi) ** 2, 0.1 * np.sin(2 * phi), 0.2 * np.cos(2 * phi))
    rho = lambda theta: 0.6 - 0.05 * np.sin(theta / 3) ** 2  # noqa: E731
    theta, step = 3 * phi, 1e-4
    assert path.rho == pytest.approx(rho(theta), rel=1e-12)
    assert path.drho == pytest.approx((rho(theta + step) - rho(theta - step)) / (2 * step), rel=1e-6)
    second = (rho(theta + step) - 2 * rho(theta) + rho(theta - step)) / step**2
    assert path.d2rho == pytest.approx(second, rel=1e-5, abs=1e-7)


def test_rollers_add_the_inertia_of_what_they_move():
    # energy of c rollers that roll without slip: of mass m with the pin, of inertia J about it
    rho, drho, mass, spin, radius, omega = 0.7, -0.2, 90.0, 0.6, 0.1, 5.0
    speed = omega * math.hypot(rho, drho)
    energy = 3 * (mass * speed**2 / 2 + spin * (speed / radius) ** 2 / 2)
    assert roller_inertia(rho, drho, mass, spin, radius, 3) * omega**2 / 2 == pytest.approx(energy, rel=1e-12)
