"""Orders, shaking forces, the best counterweight, and balance that was asked for."""

import dataclasses
import math

import numpy as np
import pytest
from scipy.optimize import minimize

from mechsym import cases
from mechsym.forces.loads import BalanceWanted, loads, orders, shaking, verdict, whole
from mechsym.jobs.machine import turn


def test_orders_of_a_known_curve():
    phi = np.arange(1440) * 4 * np.pi / 1440
    found = orders(3 + 2 * np.cos(0.5 * phi - 0.3) + 5 * np.cos(2 * phi + 1.1), 4 * np.pi)
    by_order = dict(zip(found.order, zip(found.amplitude, found.phase, strict=True), strict=True))
    assert by_order[0.0][0] == pytest.approx(3)
    assert by_order[0.5] == pytest.approx((2, 0.3))
    assert by_order[2.0] == pytest.approx((5, -1.1))
    assert abs(whole(found, 2)) == pytest.approx(5)
    assert max(a for k, (a, _) in by_order.items() if k not in (0.0, 0.5, 2.0)) < 1e-13


def test_the_shaking_force_is_what_the_frame_bears():
    """Bearing, guide and gas on the head, with opposite signs: the sum of what the moving parts push."""
    one = turn(cases.load("moroianu"))
    found, shake = loads(one), shaking(one)
    x, y = found.bearings["main_bearing"]
    assert shake.curves["force_x"] == pytest.approx(-x + one.inputs["F"], abs=1e-6 * np.abs(x).max())
    assert shake.curves["force_y"] == pytest.approx(-y - found.guides["side_force"], abs=1e-6 * np.abs(y).max())


def test_half_of_the_reciprocating_mass_is_the_best_counterweight():
    one = turn(cases.load("nunes-hypocycloid"))
    p, found = one.drive.parameters, shaking(one).counterweight
    assert found.unbalance == pytest.approx(0.5 * p.m3 * 2 * p.e, rel=1e-10)
    assert math.degrees(found.angle) == pytest.approx(180, abs=1e-6)
    assert found.rms_after == pytest.approx(found.rms_before / math.sqrt(2), rel=1e-10)


@pytest.mark.parametrize("name", ["moroianu", "alpha-stirling"])
def test_no_other_counterweight_is_better(name):
    one = turn(cases.load(name))
    shake = shaking(one)
    force = shake.curves["force_x"] + 1j * shake.curves["force_y"]

    def rms(u):
        return np.sqrt(np.mean(np.abs(force + (u[0] + 1j * u[1]) * one.omega**2 * np.exp(1j * one.phi)) ** 2))

    scale = shake.counterweight.unbalance
    best = minimize(lambda u: rms(u * scale), [0.1, 0.1], tol=1e-12)
    assert math.hypot(*best.x) == pytest.approx(1, rel=1e-4)
    assert math.atan2(best.x[1], best.x[0]) % (2 * math.pi) == pytest.approx(shake.counterweight.angle, abs=1e-4)
    assert best.fun == pytest.approx(shake.counterweight.rms_after, rel=1e-8)


def test_rodless_with_its_counterweight_is_in_full_balance():
    one = turn(cases.load("balandin"))
    shake = shaking(one)
    size = 2 * 2.1 * 0.02 * one.omega**2
    assert shake.counterweight.rms_before < 1e-12 * size
    assert verdict(one, shake, BalanceWanted(orders=(1.0, 2.0))) == []


def test_missing_balance_is_explained():
    case = cases.load("balandin", {"parameters.u1": 0.0})
    one = turn(case)
    reasons = verdict(one, shaking(one), case.need("shaking"))
    assert len(reasons) == 2 and "order 1 of force_x" in reasons[0]
    assert "a counterweight of u1 = -0.1 kg m on the crank takes all of it" in reasons[0]


def in_line(degrees, z):
    base = cases.load("opposed-pistons")
    p = base.need("parameters")
    n = len(degrees)
    phase = tuple(math.radians(d) for d in degrees)
    train = dataclasses.replace(
        p, throw=tuple(range(1, n + 1)), bank=0.0, phase=phase, firing=(), sense=1.0, axis_x=0.0, k=2e5, z=z
    )
    sections = {k: v for k, v in base.sections.items() if k != "cycle"}
    return turn(dataclasses.replace(base, sections={**sections, "parameters": train}))


def test_unequal_phases_are_explained():
    z = (-0.1, 0.0, 0.1)
    even, uneven = in_line((0, 120, 240), z), in_line((0, 100, 240), z)
    wanted = BalanceWanted(orders=(1.0, 2.0))
    only_couples = verdict(even, shaking(even), wanted)
    assert only_couples and all("rocking" in reason for reason in only_couples)
    assert "no mirror image" in only_couples[0]
    found = verdict(uneven, shaking(uneven), wanted)
    assert any("force_x" in reason and "cranks at 0, 100, 240 deg" in reason for reason in found)
    assert any("3 equal throws 120 deg apart" in reason for reason in found)


def test_a_mirrored_six_is_in_full_balance():
    z = (-0.25, -0.15, -0.05, 0.05, 0.15, 0.25)
    six = in_line((0, 240, 120, 120, 240, 0), z)
    assert verdict(six, shaking(six), BalanceWanted(orders=(1.0, 2.0))) == []
