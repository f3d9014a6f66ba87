"""Moroianu (2017): the printed chain against the exact forces, and what its two-mass rod leaves out.

The paper prints curves without numbers and no data; its relations are tested on the engine of Zotov et al. (2024).
"""

import dataclasses
import math

import numpy as np
import pytest
from slider_crank import piston_inertia_printed
from small_machines import machine, smooth_gas, turn_of

from mechsym.forces.loads import loads, radial, tangential
from mechsym.forces.textbook import chain, errors, slider_crank, terskih, weight_shares
from mechsym.mechanisms.crosshead import CrossheadParameters

MARINE = CrossheadParameters(
    r1=0.2, r2=0.3, l1=0.8, l2=0.75, m1=80, m2=150, m3=150, m4=200, m5=110, I01=30, IC2=50, g=9.81
)


def marine(**changes):
    p = dataclasses.replace(MARINE, **changes)
    return turn_of(machine("crosshead", p, 14.87), smooth_gas(1.0, bore=0.3))


@pytest.mark.parametrize(("rpm", "ratio"), [(0, 0.4), (1000, 0.3), (100, 0.2 * 2.01 / 1.01), (1e6, 0.2)])
def test_terskih_eq_3(rpm, ratio):
    assert terskih(rpm * math.pi / 30) == pytest.approx(ratio, rel=1e-6)


def test_chain_eqs_2_to_13_written_out():
    one = marine()
    R, L, w, ratio = 0.5, 1.55, one.omega, 0.4
    alpha = one.phi
    beta = np.arcsin(R / L * np.sin(alpha))
    # acceleration of the piston at constant speed, from the closed travel by hand
    q = np.sqrt(L**2 - (R * np.sin(alpha)) ** 2)
    a_p = w**2 * (R * np.cos(alpha) + R**2 * np.cos(2 * alpha) / q + R**4 * np.sin(2 * alpha) ** 2 / (4 * q**3))
    m_bp, m_bm = 150 * ratio, 150 * (1 - ratio)
    F = one.inputs["F"] - (150 + 200 + 110 + m_bp) * a_p
    B, N = F / np.cos(beta), F * np.tan(beta)
    found = chain(one, ratio)
    assert pytest.approx(F, rel=1e-10) == found.F
    assert pytest.approx(B, rel=1e-10) == found.B
    assert pytest.approx(N, rel=1e-10, abs=1e-6) == found.N
    assert found.Z_B == pytest.approx(B * np.cos(alpha + beta), rel=1e-10, abs=1e-6)
    assert pytest.approx(B * np.sin(alpha + beta), rel=1e-10, abs=1e-6) == found.T
    assert found.F_ibm == pytest.approx(np.full_like(alpha, -m_bm * R * w**2), rel=1e-12)
    assert pytest.approx(found.Z_B + found.F_ibm, rel=1e-12) == found.Z
    assert pytest.approx(R * found.T, rel=1e-12) == found.M


def test_a_massless_rod_leaves_no_error():
    one = marine(m2=0, IC2=0, g=0)
    for ratio in (0.2, terskih(one.omega), 0.5):
        assert max(errors(one, chain(one, ratio)).values()) < 1e-12


def test_a_rod_that_is_two_masses_leaves_no_error():
    l1 = 0.8
    one = marine(IC2=150 * l1 * 0.75, g=0)
    assert max(errors(one, chain(one, l1 / 1.55)).values()) < 1e-12
    assert errors(one, chain(one, terskih(one.omega)))["M"] > 1e-3


def test_two_mass_error_of_the_torque_in_closed_form():
    r"""M_chain - M = (I_C2 - m_b a b) omega^2 psi' psi'': what the wrong inertia of the rod does."""
    one = marine(g=0)
    lam, s, c = 0.5 / 1.55, np.sin(one.phi), np.cos(one.phi)
    cos_psi = np.sqrt(1 - (lam * s) ** 2)
    dpsi = lam * c / cos_psi
    d2psi = -lam * s * (1 - lam**2) / cos_psi**3
    wanted = (50 - 150 * 0.8 * 0.75) * one.omega**2 * dpsi * d2psi
    difference = chain(one, 0.8 / 1.55).M - one.torque
    assert difference == pytest.approx(wanted, rel=1e-9, abs=1e-9 * np.abs(one.torque).max())
    assert np.abs(wanted).max() > 100  # the rod of the marine engine is far from two masses


def test_errors_leave_the_weight_out_and_name_it_beside():
    heavy, light = marine(), marine(g=0)
    ratio = slider_crank(heavy).L_m / slider_crank(heavy).L
    assert errors(heavy, chain(heavy, ratio)) == pytest.approx(errors(light, chain(light, ratio)), rel=1e-9)
    assert weight_shares(light) == pytest.approx(weight_shares(heavy), rel=1e-9)
    # the engine lies down: the guide carries crosshead, piston rod, piston and the rod's share
    share = weight_shares(heavy)["N"] * np.abs(loads(light).guides["side_force"]).max()
    assert share == pytest.approx(9.81 * (150 + 200 + 110 + 150 * 0.8 / 1.55), rel=1e-9)


def test_chain_and_exact_forces_count_alike():
    one = marine(m2=0, IC2=0, g=0)
    found, pin = chain(one, 0.4), loads(one).pins[0]
    assert pytest.approx(-radial(pin), rel=1e-9, abs=1e-6) == found.Z
    assert pytest.approx(tangential(pin), rel=1e-9, abs=1e-6) == found.T
    assert pytest.approx(loads(one).guides["side_force"], rel=1e-9, abs=1e-6) == found.N


def test_two_harmonics_of_the_piston_inertia_miss_the_fourth():
    one = marine()
    s, lam = slider_crank(one), 0.5 / 1.55
    printed = piston_inertia_printed(one)
    exact = -(s.m_p + s.m_b * s.L_m / s.L) * one.kinematics["d2x_dphi2"] * one.omega**2
    assert np.abs(printed - exact).max() / np.abs(exact).max() < lam**3
    assert printed[0] == pytest.approx(exact[0], rel=1e-12)  # equal at the dead centres
