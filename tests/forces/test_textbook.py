"""Moroianu (2017) and Prymak: each printed formula that is used, beside the exact forces."""

import dataclasses
import math

import numpy as np
import pytest
from slider_crank import piston_inertia_printed

from mechsym import cases
from mechsym.errors import BadInput
from mechsym.forces import textbook
from mechsym.forces.loads import loads, radial, tangential
from mechsym.jobs.machine import turn


@pytest.fixture(scope="module")
def moroianu():
    return turn(cases.load("moroianu"))


def changed(case, **values):
    parameters = dataclasses.replace(case.need("parameters"), **values)
    return dataclasses.replace(case, sections={**case.sections, "parameters": parameters})


def test_3_terskih_moves_the_centre_of_mass_towards_the_pin():
    assert textbook.terskih(0.0) == pytest.approx(0.4)
    assert textbook.terskih(89 * math.pi / 30) == pytest.approx(0.2 * (0.089**2 + 2) / (0.089**2 + 1), rel=1e-14)
    assert textbook.terskih(1e9) == pytest.approx(0.2, rel=1e-6)


def test_7_to_13_hold_together(moroianu):
    c = textbook.chain(moroianu, textbook.terskih(moroianu.omega))
    beta, alpha = moroianu.kinematics["psi"], moroianu.phi
    assert pytest.approx(c.F_p + c.F_it) == c.F
    assert np.hypot(c.F, c.N) == pytest.approx(np.abs(c.B))
    assert np.hypot(c.Z_B, c.T) == pytest.approx(np.abs(c.B))
    assert c.T * np.cos(beta) == pytest.approx(c.F * np.sin(alpha + beta))
    assert c.M == pytest.approx(c.F * moroianu.kinematics["dx_dphi"], abs=1e-6)  # virtual work
    assert c.Z - c.Z_B == pytest.approx(c.F_ibm)


def test_a_rod_of_two_real_masses_is_exact():
    """With I_C2 = m a b the two masses are the rod: the chain must give the rigid-body forces."""
    case = cases.load("moroianu")
    p = case.need("parameters")
    one = turn(changed(case, IC2=p.m2 * p.l1 * p.l2, I01=5000.0))
    s = textbook.slider_crank(one)
    assert max(textbook.errors(one, textbook.chain(one, s.L_m / s.L)).values()) < 1e-12


def test_the_two_mass_error_is_the_missing_inertia(moroianu):
    s, psi = textbook.slider_crank(moroianu), moroianu.kinematics["psi"]
    lam, phi, w = s.R / s.L, moroianu.phi, moroianu.omega
    slope = lam * np.cos(phi) / np.cos(psi)
    curvature = (-lam * np.sin(phi) + np.sin(psi) * slope**2) / np.cos(psi)
    missing = (s.I_b - s.m_b * s.L_m * (s.L - s.L_m)) * w**2 * slope * curvature
    pin = loads(moroianu).pins[0]
    exact = pin.radius * tangential(pin)
    gap = textbook.chain(moroianu, s.L_m / s.L).M - exact
    assert gap == pytest.approx(missing, abs=1e-10 * np.abs(exact).max())
    assert np.abs(gap).max() > 1e-3 * np.abs(exact).max()


def test_an_exact_massless_rod_makes_the_chain_exact(moroianu):
    one = turn(changed(cases.load("moroianu"), m2=0.0, IC2=0.0))
    found = loads(one)
    c = textbook.chain(one, 0.4)
    assert pytest.approx(found.guides["side_force"], abs=1e-6) == c.N
    assert pytest.approx(-radial(found.pins[0]), abs=1e-6) == c.Z


def test_prymak_6_is_the_first_order_of_the_inertia_force():
    case, errors = cases.load("moroianu"), []
    for l in (1.035, 10.35):
        one = turn(changed(case, l1=l, l2=l, m2=0.0, IC2=0.0))
        exact = -1 * sum(getattr(one.drive.parameters, n) for n in ("m3", "m4", "m5"))
        exact = exact * one.kinematics["d2x_dphi2"] * one.omega**2
        errors.append(np.abs(piston_inertia_printed(one) - exact).max() / np.abs(exact).max())
    assert 0.001 < errors[0] < 0.1
    assert errors[1] < 0.01 * errors[0]  # lam^3


def test_the_chain_belongs_to_slider_cranks():
    with pytest.raises(BadInput, match="slider crank, not of hypocycloid"):
        textbook.slider_crank(turn(cases.load("nunes-hypocycloid")))
