"""Rollers of finite radius: curvature, parallel curve, undercut, reactions, contact stress, losses."""

import numpy as np
import pytest
from hinges import HIGHER, LOWER, section, whole
from hypothesis import assume, given
from hypothesis import strategies as st

from mechsym.hinge import guide, rollers
from mechsym.hinge import limits as turn
from mechsym.hinge.limits import undercut_radius
from mechsym.hinge.rollers import RollerParameters

THETA = np.linspace(0, 2 * np.pi, 2001)[:-1]


def eccentric(radius=0.5, e=0.1):
    """A circle of that radius seen from an axis off its centre: rho with its derivatives."""
    root = np.sqrt(radius**2 - (e * np.sin(THETA)) ** 2)
    droot = -(e**2) * np.sin(THETA) * np.cos(THETA) / root
    d2root = -(e**2) * np.cos(2 * THETA) / root - droot**2 / root
    return e * np.cos(THETA) + root, -e * np.sin(THETA) + droot, -e * np.cos(THETA) + d2root


def wave(a, k, theta=THETA):
    return 1 + a * np.cos(k * theta), -a * k * np.sin(k * theta), -a * k**2 * np.cos(k * theta)


def cut(name=LOWER):
    return guide.cut(whole(name), section("spring", name), section("guide", name))


def around(name=LOWER):
    parameters = section("rollers", name)
    return turn.at_angles(cut(name), parameters, THETA)


def test_curvature_of_a_circle_is_its_own_from_any_axis():
    assert rollers.curvature(*eccentric(0.5)) == pytest.approx(np.full(THETA.size, 2.0), rel=1e-12)


def test_curvature_is_that_of_three_neighbouring_points():
    h = 1e-4
    (x0, y0), (x1, y1), (x2, y2) = (
        (rho * np.cos(angle), rho * np.sin(angle))
        for angle in (THETA - h, THETA, THETA + h)
        for rho in (wave(0.1, 3, angle)[0],)
    )
    cross = (x1 - x0) * (y2 - y1) - (y1 - y0) * (x2 - x1)
    sides = np.hypot(x1 - x0, y1 - y0) * np.hypot(x2 - x1, y2 - y1) * np.hypot(x2 - x0, y2 - y0)
    assert rollers.curvature(*wave(0.1, 3)) == pytest.approx(2 * cross / sides, abs=1e-5)


def test_parallel_of_a_circle_is_a_circle():
    rho, drho, _ = eccentric(0.5, 0.1)
    x, y = rollers.parallel(rho, drho, THETA, 0.08)
    assert np.hypot(x - 0.1, y) == pytest.approx(np.full(THETA.size, 0.58), rel=1e-13)


def test_parallel_is_not_a_larger_rho():
    rho, drho, _ = wave(0.1, 3)
    x, y = rollers.parallel(rho, drho, THETA, 0.08)
    angle = np.unwrap(np.arctan2(y, x))
    shifted = np.interp(THETA, angle, np.hypot(x, y), period=2 * np.pi)
    assert np.max(np.abs(shifted - (rho + 0.08))) > 1e-3


@pytest.mark.parametrize("name", [LOWER, HIGHER])
def test_profile_lies_at_the_roller_radius_along_the_normal(name):
    path, radius = cut(name).rho, 0.1
    rho, drho = path(THETA), path.derivative()(THETA)
    x, y = rollers.parallel(rho, drho, THETA, radius)
    px, py = rho * np.cos(THETA), rho * np.sin(THETA)
    tx, ty = drho * np.cos(THETA) - py, drho * np.sin(THETA) + px
    assert np.hypot(x - px, y - py) == pytest.approx(np.full(THETA.size, radius), rel=1e-12)
    assert (x - px) * tx + (y - py) * ty == pytest.approx(np.zeros(THETA.size), abs=1e-13)
    assert np.all(np.hypot(x, y) > rho)  # outside
    # no other roller centre is nearer to a point of the profile than its own
    fine = np.linspace(0, 2 * np.pi, 20001)
    fx, fy = path(fine) * np.cos(fine), path(fine) * np.sin(fine)
    nearest = [np.min(np.hypot(fx - a, fy - b)) for a, b in zip(x[::50], y[::50], strict=True)]
    assert nearest == pytest.approx(np.full(len(nearest), radius), abs=1e-6)


def test_a_cutter_smaller_than_the_roller_cuts_the_same_profile():
    rho, drho, _ = wave(0.1, 3)
    x, y = rollers.parallel(rho, drho, THETA, 0.08)
    cx, cy = rollers.parallel(rho, drho, THETA, 0.08 - 0.03)
    assert np.hypot(x - cx, y - cy) == pytest.approx(np.full(THETA.size, 0.03), rel=1e-12)


def test_profile_curvature_is_that_of_the_profile():
    rho, drho, d2rho = wave(0.05, 4)
    kappa = rollers.curvature(rho, drho, d2rho)
    x, y = rollers.parallel(rho, drho, THETA, 0.1)
    order = np.fft.fftfreq(THETA.size, 1 / THETA.size)

    def derivative(values):
        return np.fft.ifft(1j * order * np.fft.fft(values)).real

    dx, dy = derivative(x), derivative(y)
    expected = (dx * derivative(dy) - dy * derivative(dx)) / np.hypot(dx, dy) ** 3
    assert kappa / (1 + 0.1 * kappa) == pytest.approx(expected, abs=1e-6)


def crosses_itself(x, y):
    """Brute force: does any edge of the closed polygon cross another?"""
    p = np.column_stack([x, y])
    q = np.roll(p, -1, axis=0)
    d = q - p

    def side(a, direction, b):
        return direction[:, None, 0] * (b[None, :, 1] - a[:, None, 1]) - direction[:, None, 1] * (
            b[None, :, 0] - a[:, None, 0]
        )

    ps, qs = side(p, d, p), side(p, d, q)
    apart = ps * qs < 0
    both = apart & apart.T
    index = np.arange(len(x))
    gap = np.abs(index[:, None] - index[None, :])
    return bool(np.any(both & (np.minimum(gap, len(x) - gap) > 1)))


@given(st.floats(0.02, 0.2), st.integers(2, 6), st.floats(0.3, 2.5))
def test_undercut_is_where_the_profile_crosses_itself(a, k, share):
    theta = np.linspace(0, 2 * np.pi, 601)[:-1]
    limit = undercut_radius(rollers.curvature(*wave(a, k, theta)))
    assume(limit is not None and abs(share - 1) > 0.1)
    rho, drho, _ = wave(a, k, theta)
    x, y = rollers.parallel(rho, drho, theta, share * limit)
    assert crosses_itself(x, y) == (share > 1)


def test_a_path_that_never_bends_inwards_has_no_undercut():
    assert undercut_radius(rollers.curvature(*eccentric())) is None
    rho, drho, _ = eccentric()
    assert not crosses_itself(*(v[::4] for v in rollers.parallel(rho, drho, THETA, 5.0)))


@pytest.mark.parametrize("name", [LOWER, HIGHER])
def test_reactions_do_the_work_of_the_torque(name):
    found = around(name)
    lever = found.rho * np.sin(found.pressure_angle)
    torque = (found.reaction_1 + found.reaction_2) * lever
    assert torque == pytest.approx(found.torque, rel=1e-12, abs=1e-6)
    assert found.torque == pytest.approx(whole(name).torque(THETA), abs=1e-5)
    assert found.reaction_1 * np.cos(found.pressure_angle) == pytest.approx(found.force, rel=1e-13)


def test_one_roller_rests_on_its_seat():
    spring = section("spring")
    chosen = guide.GuideParameters(arrangement="one_roller", rho0=1.2)
    found = turn.at_angles(guide.cut(whole(), spring, chosen), section("rollers"), THETA)
    assert found.reaction_2 == pytest.approx(found.force)
    assert np.all(found.tilting_couple == 0)


def test_offset_planes_tilt_with_the_reaction_times_the_offset():
    found = around()
    assert found.tilting_couple == pytest.approx(0.15 * found.reaction_1)


def test_hertz_number_of_the_handbooks():
    """Steel on steel, nu = 0.3: p_H = 0.418 sqrt(N E / (w R)) for a roller on a flat track."""
    parameters = RollerParameters(radius=0.1, width=0.1, E=2.06e11, nu=0.3)
    stress = rollers.hertz_stress(np.array([2.5e5]), np.array([0.0]), parameters)
    assert stress[0] == pytest.approx(0.418 * np.sqrt(2.5e5 * 2.06e11 / (0.1 * 0.1)), rel=1e-3)


@given(st.floats(-8, 20))
def test_hertz_radius_joins_roller_and_track(kappa):
    parameters = RollerParameters(radius=0.1, width=0.1)
    stress = rollers.hertz_stress(np.array([1e5]), np.array([kappa]), parameters)
    joined = 1 / 0.1 - kappa / (1 + 0.1 * kappa)
    flat = rollers.hertz_stress(np.array([1e5]), np.array([0.0]), parameters)
    assert stress[0] == pytest.approx(flat[0] * np.sqrt(joined * 0.1), rel=1e-12)


def test_hertz_stress_is_infinite_where_the_profile_is_undercut():
    parameters = RollerParameters(radius=0.1, width=0.1)
    assert np.isinf(rollers.hertz_stress(np.array([1.0]), np.array([-10.5]), parameters))[0]


def test_rolling_resistance_loses_the_arm_times_the_rolled_angle():
    parameters = RollerParameters(radius=0.1, width=0.1, friction="rolling", rolling_arm=1e-6)
    rho, drho, _ = eccentric(0.5, 0.1)
    N = np.full_like(rho, 2e5)
    lost = np.mean(rollers.loss_torque(N, rho, drho, parameters)) * 2 * np.pi
    # the roller's centre runs once around a circle of 0.5 m
    assert lost == pytest.approx(1e-6 * 2e5 * (2 * np.pi * 0.5) / 0.1, rel=1e-9)
    assert np.all(rollers.loss_torque(N, rho, drho, RollerParameters(radius=0.1, width=0.1)) == 0)


def test_inertia_force_of_a_roller_that_turns_with_the_spring():
    rho, _, d2rho = wave(0.1, 2)
    order = np.fft.fftfreq(THETA.size, 1 / THETA.size)
    acceleration = np.fft.ifft(-(order**2) * np.fft.fft(rho * np.exp(1j * THETA))) * 3.0**2
    outwards = -(acceleration * np.exp(-1j * THETA)).real
    assert rollers.inertia_force(rho, d2rho, 3.0) == pytest.approx(outwards, abs=1e-6)


def test_both_sides_of_a_kink_are_seen():
    path = cut().rho
    found = turn.at_pieces(cut(), section("rollers"))
    same = np.flatnonzero(np.diff(found.theta) == 0)
    assert same.size == path.x.size - 2
    jump = np.abs(found.curvature[same + 1] - found.curvature[same])
    at = path.x[1:-1][np.argmax(jump)]
    # the largest jump is where the scavenge ports open and the blow-down ends
    assert at == pytest.approx(np.radians(140), abs=1e-12)
    assert np.max(jump) > 0.01
