"""Cylinders on one shaft: harmonics add up as arrows, angle by angle; a lost combustion is one arrow less."""

import dataclasses
import math

import numpy as np
import pytest

from mechsym import periodic
from mechsym.codesign.machines import from_curve
from mechsym.codesign.manoeuvres import _integral
from mechsym.codesign.rank import counts, even_firing, together

TURN = 2 * math.pi
PHI = np.linspace(0.0, TURN, 25)


def one():
    """Torque 50 + 30 cos(phi) + 20 sin(2 phi), inertia 3 + cos(phi), without combustion 7 sin(phi)."""
    angle = np.arange(360) * TURN / 360
    made = from_curve(angle, torque(angle), 3.0, 20.0)
    inertia = periodic.fit(lambda phi: 3.0 + np.cos(phi), [], TURN, 1e-12)
    return dataclasses.replace(
        made, inertia=inertia, kinks=(1.0, 2.0), misfire=lambda phi: 7.0 * np.sin(phi), misfire_kinks=(3.0,)
    )


def torque(phi):
    return 50.0 + 30.0 * np.cos(phi) + 20.0 * np.sin(2 * phi)


def gas_work(phi):
    """Of the mean torque less the torque, from phi = 0, without what the masses take."""
    return -30.0 * np.sin(phi) - 10.0 * (1 - np.cos(2 * phi)) - 200.0 * np.cos(phi)


def test_uneven_cylinders_add_up_angle_by_angle():
    angles, shares = (0.0, 0.7, 2.0), (1.0, 0.5, 0.9)
    sum_of = together(one(), angles, shares)
    assert sum_of.torque(PHI) == pytest.approx(
        sum(s * torque(PHI + a) for s, a in zip(shares, angles, strict=True)), rel=1e-7
    )
    assert sum_of.inertia(PHI) == pytest.approx(sum(3 + np.cos(PHI + a) for a in angles), rel=1e-9)
    assert sum_of.load_torque == pytest.approx(50.0 * 2.4)
    assert sum_of.misfire(PHI) == pytest.approx(7 * np.sin(PHI) + torque(PHI + 0.7) + torque(PHI + 2.0), rel=1e-7)
    # the energy of the masses at 20 rad/s, omega^2 / 2 cos(phi) of each, has no share
    work = sum_of.work(PHI) - sum_of.work(0.0)
    wanted = sum(200.0 * np.cos(PHI + a) + s * gas_work(PHI + a) for s, a in zip(shares, angles, strict=True))
    assert work == pytest.approx(wanted - wanted[0], abs=1e-3)
    assert sum_of.kinks == pytest.approx(sorted((k - a) % TURN for k in (1.0, 2.0) for a in angles))
    assert set(sum_of.misfire_kinks) == {*sum_of.kinks, 3.0}


def test_a_single_cylinder_that_is_lost_leaves_no_other():
    assert together(one(), (0.4,)).misfire(PHI) == pytest.approx(7 * np.sin(PHI + 0.4), rel=1e-12, abs=1e-12)
    assert together(dataclasses.replace(one(), misfire=None), (0.0, 1.0)).misfire is None


def test_even_firing_divides_the_period():
    assert even_firing(4, 2 * TURN) == pytest.approx((0.0, math.pi, TURN, 3 * math.pi))


def test_two_cylinders_lose_their_first_order():
    """Of 30 cos(phi) + 12 cos(2 phi) half a turn apart a work of 12 sin(2 phi) is kept, on twice the inertia."""
    angle = np.arange(360) * TURN / 360
    rows = counts([from_curve(angle, 50 + 30 * np.cos(angle) + 12 * np.cos(2 * angle), 0.1, 20.0)], 0.02, most=2)
    assert [row.cylinders for row in rows] == [1, 2]
    one = np.ptp(30 * np.sin(angle) + 6 * np.sin(2 * angle))
    assert rows[0].flywheel_inertia_bare == pytest.approx(one / 400 / 0.02 - 0.1, rel=1e-2)
    assert rows[1].flywheel_inertia_bare == pytest.approx(24 / 400 / 0.02 - 0.2, rel=1e-2)
    assert rows[0].swing == pytest.approx(0.0, abs=1e-9)  # one spring takes what one point wants


def test_the_work_of_a_straight_torque_is_a_parabola():
    phi = np.array([0.0, 0.5, 1.5, 1.75])
    assert _integral(3.0 * phi + 2.0, phi) == pytest.approx(1.5 * phi**2 + 2.0 * phi, rel=1e-14, abs=1e-14)
