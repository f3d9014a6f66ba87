"""One diagram over another motion: equal pressure at equal travel, or at equal shares of two strokes."""

import dataclasses
import math

import casadi as ca
import numpy as np
import pytest
from small_machines import smooth_gas

from mechsym.cycle.gas import at_same_travel, over_travel

THETA = np.linspace(-7.0, 14.0, 211)


def travel(x):
    """Travel and slope of a piston from its formula in the angle."""
    phi = ca.SX.sym("phi")
    return ca.Function("travel", [phi], [x(phi), ca.jacobian(x(phi), phi)], ["phi"], ["x", "dx_dphi"])


def rod(phi, lam=0.3):
    return 0.3 * (1 - ca.cos(phi)) + 0.3 / lam * (1 - ca.sqrt(1 - (lam * ca.sin(phi)) ** 2))


def cosine(phi):
    return 0.3 * (1 - ca.cos(phi))


def of_travel(own, law):
    """A gas whose pressure is a law of its travel on that motion."""

    def absolute(phi):
        return law(np.asarray(own(np.reshape(phi, (1, -1)))[0]).reshape(np.shape(phi)))

    gas = smooth_gas(0.6)
    return dataclasses.replace(gas, pressure=dataclasses.replace(gas.pressure, absolute=absolute))


def law(x):
    return 1e5 * (0.7 / (0.05 + x)) ** 1.3


@pytest.mark.parametrize(("own", "other"), [(rod, cosine), (cosine, rod), (rod, rod)])
def test_a_pressure_of_the_travel_stays_one(own, other):
    own, other = travel(own), travel(other)
    moved = at_same_travel(of_travel(own, law), own, other).pressure
    assert moved.absolute(THETA) == pytest.approx(of_travel(other, law).pressure.absolute(THETA), rel=1e-9)
    assert moved.p_max == pytest.approx(law(0.0), rel=1e-9)


def test_one_half_of_the_turn_is_not_the_other():
    # a pressure of the angle itself keeps the half that it belongs to
    gas, own, other = smooth_gas(0.6), travel(cosine), travel(rod)
    theta = np.array([0.4, 2.0, -0.4, 2 * math.pi - 2.0])
    x = np.asarray(other(theta.reshape(1, -1))[0]).ravel()
    half = np.arccos(1 - x / 0.3)
    angle = np.array([half[0], half[1], -half[2], 2 * math.pi - half[3]])
    moved = at_same_travel(gas, own, other)
    assert moved.pressure.absolute(theta) == pytest.approx(gas.pressure.absolute(angle), rel=1e-9)


@pytest.mark.parametrize("late", [0.0, 0.35])
def test_shares_of_another_stroke(late):
    # half of the stroke by the same cosine is the same share at the same angle, whenever it fires
    gas, own = smooth_gas(0.6), travel(cosine)
    gas = dataclasses.replace(gas, pressure=dataclasses.replace(gas.pressure, kinks=(0.7, 4.1), phi_p_max=0.3))
    moved = over_travel(gas, own, travel(lambda phi: cosine(phi) / 2), late)
    assert moved.pressure.kinks == pytest.approx([0.7, 4.1], abs=1e-9)
    assert moved.pressure.phi_p_max == pytest.approx(0.3, abs=1e-9)
    assert moved.pressure.absolute(THETA) == pytest.approx(gas.pressure.absolute(THETA), rel=1e-9)
    assert moved.chamber.stroke == pytest.approx(0.3, rel=1e-9)
    assert moved.chamber.displacement == pytest.approx(gas.chamber.displacement / 2, rel=1e-9)
    assert moved.chamber.clearance == pytest.approx(gas.chamber.clearance / 2, rel=1e-9)


def test_shares_over_a_motion_that_is_not_even():
    # an offset crank: at the angle where so much of its own stroke is passed the pressure is that of the share
    r, length, offset = 0.3, 0.9, 0.15
    top = math.asin(offset / (length + r))

    def skew(phi):
        turned = phi + top
        return (
            ca.sqrt((length + r) ** 2 - offset**2)
            - r * ca.cos(turned)
            - ca.sqrt(length**2 - (r * ca.sin(turned) - offset) ** 2)
        )

    stroke = math.sqrt((length + r) ** 2 - offset**2) - math.sqrt((length - r) ** 2 - offset**2)
    moved = over_travel(of_travel(travel(cosine), law), travel(cosine), travel(skew))
    x = np.asarray(travel(skew)(THETA.reshape(1, -1))[0]).ravel()
    assert moved.pressure.absolute(THETA) == pytest.approx(law(x / stroke * 0.6), rel=1e-6)


def test_formulas_begin_where_the_piston_fires():
    gas = smooth_gas(0.6)
    pieces = ((0.0, 2.0, lambda phi: 1e5 + 3e5 * phi), (2.0, 2 * math.pi, lambda phi: 7e5 + 0 * phi))
    gas = dataclasses.replace(gas, pressure=dataclasses.replace(gas.pressure, formulas=pieces))
    (low, high, first), (_, end, second) = gas.formulas(1.5)
    assert (low, high, end) == (1.5, 3.5, 2 * math.pi + 1.5)
    assert [piece[0] for piece in gas.formulas()] == [0.0, 2.0]
    area = math.pi * 0.2**2 / 4
    assert first(2.5) == pytest.approx(3e5 * area, rel=1e-12)
    assert second(4.0) == pytest.approx(6e5 * area, rel=1e-12)
