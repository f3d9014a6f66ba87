"""Orders, counterweights against brute force, and arrangements that cannot have the balance that was asked for."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize, minimize_scalar
from small_machines import machine, turn_of

from mechsym.errors import BadInput
from mechsym.forces.loads import BalanceWanted, orders, shaking, verdict, whole
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters
from mechsym.mechanisms.crosshead import CrossheadParameters
from mechsym.mechanisms.hypocycloid import HypocycloidParameters
from mechsym.mechanisms.rodless import CrankFreeRadially, RodlessParameters

PLANET = HypocycloidParameters(e=0.05, I1=0.1, u1=0.0, m2=1.3, I2=2e-3, m3=2.4, alpha_n=0.4)
LINK = RodlessParameters(r=0.05, I1=0.1, u1=0.0, m_link=1.3, I_link=2e-3, m_a=2.4, m_b=2.4)
CRANK = CrossheadParameters(r1=0.1, r2=0.2, l1=0.4, l2=0.5, m1=9, m2=7, m3=3, m4=2, m5=4, I01=2, IC2=0.9, g=0)


def inline(phases, **changes):
    d = math.pi / 180
    given = dict(
        throw=tuple(range(1, len(phases) + 1)), phase=tuple(a * d for a in phases), r=0.05, l1=0.05, l2=0.1, m_rod=0.6,
        m_piston=0.5, I_rod=2e-3, I0=0.01, I_f=0.3, k=5e5, z=tuple(0.1 * i for i in range(len(phases))),
    )  # fmt: skip
    return CrankTrainParameters(**(given | changes))


def rms(force):
    return float(np.sqrt(np.mean(np.abs(force) ** 2)))


def frame_force(one):
    return -(one.momentum["momentum_rate_x"] + 1j * one.momentum["momentum_rate_y"])


@settings(max_examples=20)
@given(st.lists(st.floats(-9, 9), min_size=5, max_size=5), st.sampled_from([1, 2]))
def test_orders_put_a_curve_together_again(parts, turns):
    phi = np.arange(96) * 2 * math.pi * turns / 96
    a, b, c, d, mean = parts
    values = mean + a * np.cos(phi) + b * np.sin(2 * phi) + c * np.cos(5 * phi / turns) + d * np.sin(3 * phi)
    found = orders(values, 2 * math.pi * turns, highest=100)
    again = sum(
        size * np.cos(k * phi - late)
        for k, size, late in zip(found.order[1:], found.amplitude[1:], found.phase[1:], strict=True)
    )
    assert found.amplitude[0] + again == pytest.approx(values, abs=1e-11)
    assert abs(whole(found, 2)) == pytest.approx(abs(b), abs=1e-11)


def test_counterweight_is_the_best_size_that_trials_on_the_mechanism_find():
    case = machine("hypocycloid", PLANET)
    found = shaking(turn_of(case, None, 90)).counterweight
    assert found.rms_before == pytest.approx(rms(frame_force(turn_of(case, None, 90))))

    def left(u1):
        changed = dataclasses.replace(PLANET, u1=u1)
        return rms(frame_force(turn_of(machine("hypocycloid", changed), None, 90)))

    best = minimize_scalar(left, bounds=(-1, 1), method="bounded", options={"xatol": 1e-10})
    assert best.x == pytest.approx(found.unbalance * math.cos(found.angle), rel=1e-6)
    assert best.fun == pytest.approx(found.rms_after, rel=1e-9)


def test_counterweight_of_a_slider_crank_takes_half_of_what_swings():
    p, found = CRANK, shaking(turn_of(machine("crosshead", CRANK), None, 90)).counterweight
    r, l = p.r1 + p.r2, p.l1 + p.l2
    turning = p.m1 * p.r1 + p.m2 * r * p.l2 / l
    swinging = (p.m2 * p.l1 / l + p.m3 + p.m4 + p.m5) * r
    assert found.unbalance == pytest.approx(turning + swinging / 2, rel=1e-12)
    assert found.angle == pytest.approx(math.pi)


def test_no_unbalance_in_any_direction_is_better():
    one = turn_of(machine("crosshead", CRANK), None, 180)
    force, found = frame_force(one), shaking(one).counterweight
    wheel = np.exp(1j * one.phi) * one.omega**2

    def left(u):
        return rms(force + (u[0] + 1j * u[1]) * wheel)

    best = minimize(left, [0.0, 0.0], method="Nelder-Mead", options={"xatol": 1e-9, "fatol": 1e-9, "maxiter": 4000})
    wanted = found.unbalance * np.array([math.cos(found.angle), math.sin(found.angle)])
    assert best.x == pytest.approx(wanted, abs=1e-6 * found.unbalance)
    assert best.fun == pytest.approx(found.rms_after, rel=1e-9)


def test_counterweight_of_the_hypocycloid_and_the_rodless_engine():
    planet = shaking(turn_of(machine("hypocycloid", PLANET), None, 90)).counterweight
    assert planet.unbalance == pytest.approx((PLANET.m2 + PLANET.m3) * PLANET.e, rel=1e-12)
    assert planet.angle == pytest.approx(math.pi)
    link = shaking(turn_of(machine("rodless", LINK, closing=CrankFreeRadially()), None, 90)).counterweight
    assert link.unbalance == pytest.approx((2 * LINK.m_a + LINK.m_link) * LINK.r, rel=1e-12)
    assert link.rms_after < 1e-12 * link.rms_before


@pytest.mark.parametrize("phases", [(0, 120, 240), (0, 90, 270, 180), (0, 70, 200)])
def test_two_planes_are_the_least_squares_of_force_and_couple(phases):
    train = inline(phases)
    one = turn_of(machine("crank_train", train), None, 180)
    found = shaking(one)
    z = np.array([p.z for p in found.planes])
    u = np.array([p.unbalance * np.exp(1j * p.angle) for p in found.planes])
    force = found.curves["force_x"] + 1j * found.curves["force_y"]
    couple = found.curves["rocking_y"] - 1j * found.curves["rocking_x"]
    wheel = one.omega**2 * np.exp(1j * one.phi)
    rows = np.concatenate([np.outer(wheel, [1, 1]), np.outer(wheel, z)])
    truth = np.linalg.lstsq(rows, -np.concatenate([force, couple]), rcond=None)[0]
    assert u == pytest.approx(truth, abs=1e-9 * np.abs(truth).max())
    assert rms(couple + wheel * (u @ z)) <= rms(couple)


def test_two_planes_need_a_shaft_of_several_throws():
    assert shaking(turn_of(machine("crank_train", inline((0,), z=0.0)), None, 90)).planes == ()
    assert shaking(turn_of(machine("hypocycloid", PLANET), None, 90)).planes == ()


def reasons(case, *wanted):
    one = turn_of(case, None, 180)
    return verdict(one, shaking(one), BalanceWanted(orders=wanted))


def test_equal_phases_have_the_balance_that_unequal_ones_do_not():
    mirrored = inline((0, 240, 120, 120, 240, 0))
    assert reasons(machine("crank_train", mirrored), 1.0, 2.0) == []
    unequal = reasons(machine("crank_train", inline((0, 240, 120, 120, 240, 15))), 1.0, 2.0)
    assert unequal and "do not add up to zero" in unequal[0] and "15 deg" in unequal[0]
    three = reasons(machine("crank_train", inline((0, 120, 240))), 1.0)
    assert three and all("mirror image" in reason for reason in three)


def test_rodless_advice_names_the_masses_or_the_counterweight():
    def of(**changes):
        return reasons(machine("rodless", dataclasses.replace(LINK, **changes), closing=CrankFreeRadially()), 1.0)

    balanced = -(2 * LINK.m_a + LINK.m_link) * LINK.r
    assert of(u1=balanced) == []
    assert all(f"u1 = {balanced:.4g} kg m" in reason for reason in of())
    assert all("m_b = 2.3 kg" in r and "against the crank" in r for r in of(u1=balanced, m_b=2.3))


def test_a_single_crank_is_told_what_a_counterweight_can_do():
    assert "cannot balance itself" in reasons(machine("crosshead", CRANK), 1.0, 2.0)[0]


def test_too_short_rods_are_explained():
    with pytest.raises(BadInput, match="rod too short: l1 \\+ l2 = 0.04 m"):
        inline((0, 120, 240), l1=0.02, l2=0.02)
    with pytest.raises(BadInput, match="rod too short"):
        dataclasses.replace(CRANK, l1=0.1, l2=0.1)
