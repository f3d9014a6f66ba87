"""Zotov et al. (2024): each printed formula that is used, with its number."""

import numpy as np
import pytest

from mechsym.mechanisms import crosshead
from mechsym.mechanisms.record import curves
from mechsym.mechanisms.state import state
from mechsym.papers.zotov2024.equations_printed import (
    cos_psi_printed,
    dinertia_dphi_printed,
    dx_dphi_printed,
    gravity_torque_printed,
)

PHI = np.linspace(0, 2 * np.pi, 1441)


def relative(printed, exact):
    return np.max(np.abs(printed - exact) / np.maximum(np.abs(exact), 0.1 * np.max(np.abs(exact))))


def reduced_inertia(p, phi, sign):
    """Zotov et al. (2024), eq. (2), whose term of the rod is printed with the sign -1 [kg*m^2]."""
    r, l = p.r1 + p.r2, p.l1 + p.l2
    lam = r / l
    rod = (np.sin(phi) + sign * p.l1 * lam / (2 * l) * np.sin(2 * phi)) ** 2 + (p.l2 * np.cos(phi) / l) ** 2
    turning = p.IC2 * (lam * np.cos(phi)) ** 2 / cos_psi_printed(p, phi) ** 2
    sliding = (p.m3 + p.m4 + p.m5) * r**2 * (np.sin(phi) + lam / 2 * np.sin(2 * phi)) ** 2
    return p.I01 + p.m2 * r**2 * rod + turning + sliding


def test_2_printed_sign_is_wrong_by_eleven_per_cent(zotov):
    exact = curves(crosshead.build(zotov), PHI)["inertia"]
    assert relative(reduced_inertia(zotov, PHI, -1), exact) == pytest.approx(0.111, abs=5e-4)


def test_2_with_the_sign_turned_is_right_to_one_per_cent(zotov):
    exact = curves(crosshead.build(zotov), PHI)["inertia"]
    assert relative(reduced_inertia(zotov, PHI, 1), exact) == pytest.approx(0.0098, abs=5e-5)


def test_2_printed_sign_is_no_slip_of_the_typesetter_7_uses_it_too(zotov):
    step = 1e-6
    slope = (reduced_inertia(zotov, PHI + step, -1) - reduced_inertia(zotov, PHI - step, -1)) / (2 * step)
    assert np.max(np.abs(slope - dinertia_dphi_printed(zotov, PHI))) < 1e-6


def test_3_transmission_is_the_first_order_of_the_exact_one(zotov):
    exact = curves(crosshead.build(zotov), PHI)["dx_dphi"]
    assert relative(dx_dphi_printed(zotov, PHI), exact) < 0.05


def test_3_cosine_of_the_rod_angle(zotov):
    psi = curves(crosshead.build(zotov), PHI)["psi"]
    assert relative(cos_psi_printed(zotov, PHI), np.cos(psi)) < 0.002


def test_6_weights(zotov):
    mechanism = crosshead.build(zotov)
    exact = np.array([state(mechanism, {"phi": p}).generalized_force[0] for p in PHI[::40]])
    assert relative(gravity_torque_printed(zotov, PHI[::40]), exact) < 0.002
