"""The cylinder over a mechanism: volumes, and the same travel as a slider crank written by hand."""

import math

import casadi as ca
import numpy as np
import pytest
from slider_crank import slider_crank

from mechsym.cycle.chamber import chamber_over, dvolume_dphi, travel, volume
from mechsym.cycle.gas import periodic, wrapped
from mechsym.errors import BadInput
from mechsym.mechanisms import crosshead


@pytest.fixture(scope="module")
def derived():
    parameters = crosshead.CrossheadParameters(
        r1=0.2, r2=0.3, l1=0.8, l2=0.75, m1=80, m2=150, m3=150, m4=200, m5=110, I01=30, IC2=50
    )
    return chamber_over(crosshead.build(parameters).functions["kinematics"], 0.3, 17.0)


def test_volumes(derived):
    assert derived.displacement == pytest.approx(math.pi / 4 * 0.09, rel=1e-12)
    assert volume(derived, 0.0) == pytest.approx(derived.clearance, rel=1e-14)
    assert volume(derived, math.pi) == pytest.approx(17 * derived.clearance, rel=1e-12)


def test_travel_of_the_derived_mechanism(derived):
    by_hand, phi = slider_crank(0.5, 1.55, 0.3, 17.0), np.linspace(-8, 8, 301).reshape(7, 43)
    assert volume(derived, phi).shape == (7, 43) and isinstance(volume(derived, 1.0), float)
    assert np.allclose(travel(derived.motion, phi)[0], travel(by_hand.motion, phi)[0], atol=1e-14)
    assert np.allclose(dvolume_dphi(derived, phi), dvolume_dphi(by_hand, phi), atol=1e-14)


def test_slope_is_the_derivative_of_the_volume(derived):
    phi, h = np.linspace(0, 6, 50), 1e-5
    slope = (volume(derived, phi + h) - volume(derived, phi - h)) / (2 * h)
    assert np.allclose(dvolume_dphi(derived, phi), slope, atol=1e-9)


@pytest.mark.parametrize("changes", [{"bore": 0.0}, {"compression_ratio": 1.0}])
def test_impossible_cylinder_is_refused(changes):
    values = {"bore": 0.3, "compression_ratio": 17.0, **changes}
    with pytest.raises(BadInput, match=next(iter(changes))):
        slider_crank(0.5, 1.55, **values)


def test_a_piston_that_does_not_leave_the_head_is_refused():
    phi = ca.SX.sym("phi")
    back = ca.Function("back", [phi], [ca.cos(phi) - 1, -ca.sin(phi)], ["phi"], ["x", "dx_dphi"])
    with pytest.raises(BadInput, match="stroke = -2"):
        chamber_over(back, 0.3, 17.0)


def test_periodic_continuation_and_wrapping():
    saw = periodic(lambda phi: phi, 4 * math.pi, start=-1.0)
    assert saw(np.array([-1.0, 0.5, 4 * math.pi - 1.0, -2.0])) == pytest.approx([-1.0, 0.5, -1.0, 4 * math.pi - 2.0])
    assert wrapped(-1e-20, 2 * math.pi) == 0.0
    assert wrapped(np.array([7.0, -1.0]), 2 * math.pi) == pytest.approx([7.0 - 2 * math.pi, 2 * math.pi - 1.0])
