"""Loads over the turn against Newton-Euler in absolute coordinates and against balances written down by hand."""

import dataclasses
import math

import casadi as ca
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid_bodies import System, motion
from small_machines import machine, smooth_gas, turn_of

from mechsym import cases
from mechsym.forces.loads import loads, polar, power_residual, radial, tangential
from mechsym.forces.table import columns
from mechsym.forces.turn import at, crank_drive
from mechsym.jobs.turn import turn
from mechsym.mechanisms.crosshead import CrossheadParameters
from mechsym.mechanisms.hypocycloid import HypocycloidParameters
from mechsym.mechanisms.rodless import CrankFreeRadially, RodlessParameters, Stiffnesses
from mechsym.mechanisms.rodless_faces import RodlessFaces

PLANET = HypocycloidParameters(e=0.05, I1=0.1, u1=-0.2, m2=1.3, I2=2e-3, m3=2.4, alpha_n=math.radians(25))
LINK = RodlessParameters(r=0.05, I1=0.1, u1=-0.1, m_link=1.3, I_link=2e-3, m_a=2.4, m_b=1.9)


def numbers(low, high):
    return st.floats(low, high, allow_nan=False)


@st.composite
def slider_cranks(draw):
    r1, r2 = draw(numbers(0.0, 0.3)), draw(numbers(0.05, 0.3))
    l1, l2 = (draw(numbers(0.6, 2.0)) * (r1 + r2) for _ in range(2))
    masses = {name: draw(numbers(0.1, 50)) for name in ("m1", "m2", "m3", "m4", "m5")}
    weight = {"g": draw(st.sampled_from([0.0, 9.81])), "axis_tilt": draw(numbers(-2, 2))}
    return CrossheadParameters(r1=r1, r2=r2, l1=l1, l2=l2, I01=draw(numbers(0.1, 20)), IC2=draw(numbers(0, 9)),
                               **masses, **weight)  # fmt: skip


def absolute(p: CrossheadParameters, F: float, M: float) -> System:
    """Crank, rod and piston, each with x, y and an angle of its own."""
    r, l = p.r1 + p.r2, p.l1 + p.l2
    down = -p.g * math.sin(p.axis_tilt), -p.g * math.cos(p.axis_tilt)

    def joints(X):
        xc, yc, a, xr, yr, b, xp, yp, turn = (X[i] for i in range(9))
        return ca.vertcat(
            xc - p.r1 * ca.cos(a),
            yc - p.r1 * ca.sin(a),
            xr - p.l1 * ca.cos(b) - r * ca.cos(a),
            yr - p.l1 * ca.sin(b) - r * ca.sin(a),
            xp - r * ca.cos(a) - l * ca.cos(b),
            yp - r * ca.sin(a) - l * ca.sin(b),
            yp,
            turn,
        )

    m = p.m3 + p.m4 + p.m5

    def forces(X):
        weights = [(mass * down[0], mass * down[1]) for mass in (p.m1, p.m2, m)]
        return [*weights[0], -M, *weights[1], 0, weights[2][0] - F, weights[2][1], 0]

    return System((p.m1, p.m2, m), (p.I01 - p.m1 * p.r1**2, p.IC2, 1.0), joints, forces)


@settings(max_examples=25)
@given(slider_cranks(), numbers(0, 2 * math.pi), numbers(1, 60))
def test_bearing_loads_and_torque_agree_with_newton_euler(p, phi, speed):
    one = at(crank_drive("crosshead", p), smooth_gas(2 * (p.r1 + p.r2)), speed, np.array([phi]))
    r, l, torque = p.r1 + p.r2, p.l1 + p.l2, float(one.torque[0])
    c, s = math.cos(phi), math.sin(phi)
    b = -math.asin(r * s / l)
    pose = [p.r1 * c, p.r1 * s, phi, r * c + p.l1 * math.cos(b), r * s + p.l1 * math.sin(b), b, r * c + l * math.cos(b)]
    truth = motion(absolute(p, float(one.inputs["F"][0]), torque), np.array([*pose, 0, 0]), 2, phi, speed)
    forces, found = truth.joint_forces, loads(one)
    size = np.abs(forces).max() + abs(torque) / r
    # with this load the crank neither gains nor loses speed
    assert abs(truth.acceleration[2]) * p.I01 < 1e-9 * size * r
    # the rod's centre hangs on the crank by the first pair of joints, the piston on the rod's end by the second
    on_crank = -(forces[2:4] + forces[4:6])
    assert (found.pins[0].x[0], found.pins[0].y[0]) == pytest.approx(tuple(on_crank), abs=1e-9 * size)
    assert found.guides["side_force"][0] == pytest.approx(forces[6], abs=1e-9 * size)
    main = forces[0:2] - on_crank
    bearing = found.bearings["main_bearing"]
    assert (bearing[0][0], bearing[1][0]) == pytest.approx(tuple(main), abs=1e-9 * size)
    curves = polar(one, found)
    assert curves["main_bearing"][0][0] == pytest.approx(-main[0], abs=1e-9 * size)
    across = on_crank[0] * c + on_crank[1] * s, on_crank[1] * c - on_crank[0] * s
    assert (curves["crank_pin"][0][0], curves["crank_pin"][1][0]) == pytest.approx(across, abs=1e-9 * size)


@settings(max_examples=25)
@given(slider_cranks(), numbers(1, 60))
def test_power_of_the_forces_is_the_change_of_energy(p, speed):
    one = turn_of(machine("crosshead", p, speed), smooth_gas(2 * (p.r1 + p.r2)), 90)
    assert power_residual(one, loads(one)) < 1e-12


@pytest.mark.parametrize("rule", [CrankFreeRadially(), Stiffnesses(k_a=2e8, k_b=1e8, k_c=5e7)])
def test_power_of_the_other_mechanisms(rule):
    faces = RodlessFaces(sides=("a+", "b-"), areas=(0.03, 0.02), firing=(0.0, 1.5 * math.pi))
    link = machine("rodless", LINK, closing=rule, faces=faces)
    for case in (machine("hypocycloid", PLANET), link):
        one = turn_of(case, smooth_gas(0.2))
        assert power_residual(one, loads(one)) < 1e-12


def test_work_of_a_turn_is_that_of_the_gas():
    case = machine("hypocycloid", PLANET)
    gas = smooth_gas(0.2)
    one = turn_of(case, gas)
    # integral of p A x' with x' = 2 e sin: only the sine of the pressure, 20e5 / 3, gives work
    work = math.pi * 20e5 / 3 * gas.chamber.area * 2 * PLANET.e
    assert one.torque.mean() * 2 * math.pi == pytest.approx(work, rel=1e-12)
    assert one.gas_power.mean() / one.omega * 2 * math.pi == pytest.approx(work, rel=1e-12)


def test_hypocycloid_loads_by_hand():
    """Planet: F_n on the pin, W = F_n sin(theta) - I2 theta''/e at the teeth, the rest in the journal."""
    one = turn_of(machine("hypocycloid", PLANET), smooth_gas(0.2))
    s, c, w = np.sin(one.phi), np.cos(one.phi), one.omega
    F_n = one.inputs["F"] - PLANET.m3 * 2 * PLANET.e * c * w**2
    W = F_n * s
    R = np.abs(W) * math.tan(PLANET.alpha_n)
    centripetal = PLANET.m2 * PLANET.e * w**2
    journal_x = F_n + W * s + R * c - centripetal * c  # crank on planet
    journal_y = -W * c + R * s - centripetal * s
    pin = loads(one).pins[0]
    assert one.reactions["tooth_force"] == pytest.approx(W, rel=1e-11, abs=1e-6)
    assert -pin.x == pytest.approx(journal_x, rel=1e-11, abs=1e-6)
    assert -pin.y == pytest.approx(journal_y, rel=1e-11, abs=1e-6)
    assert one.torque == pytest.approx(2 * PLANET.e * F_n * s, rel=1e-11, abs=1e-7)


def test_massless_planet_without_separating_force():
    light = dataclasses.replace(PLANET, m2=0.0, I2=0.0, alpha_n=0.0)
    one = turn_of(machine("hypocycloid", light), smooth_gas(0.2))
    pin = loads(one).pins[0]
    F_n = one.reactions["pin_force"]
    assert np.hypot(pin.x, pin.y) == pytest.approx(np.abs(F_n) * np.sqrt(1 + 3 * np.sin(one.phi) ** 2), rel=1e-11)


def test_roll_moment_is_what_guides_and_teeth_do_to_the_frame():
    p = CrossheadParameters(r1=0.1, r2=0.2, l1=0.4, l2=0.5, m1=9, m2=7, m3=3, m4=2, m5=4, I01=2, IC2=0.9, g=0)
    one = turn_of(machine("crosshead", p), smooth_gas(0.6))
    table = columns(one, loads(one))
    arm = p.r1 + p.r2 + p.l1 + p.l2 - table["x"]
    assert table["roll_moment"] == pytest.approx(-table["side_force"] * arm, rel=1e-10, abs=1e-6)
    planet = turn_of(machine("hypocycloid", PLANET), smooth_gas(0.2))
    table = columns(planet, loads(planet))
    assert table["roll_moment"] == pytest.approx(-2 * PLANET.e * table["tooth_force"], rel=1e-10, abs=1e-7)
    faces = RodlessFaces(sides=("a+",), areas=(0.03,), firing=(0.0,))
    link = turn_of(machine("rodless", LINK, closing=CrankFreeRadially(), faces=faces), smooth_gas(0.2))
    table = columns(link, loads(link))
    assert table["roll_moment"] == pytest.approx(-2 * LINK.r * table["guide_combination"], rel=1e-10, abs=1e-7)


@pytest.mark.parametrize("name", ["zotov-89", "nunes-hypocycloid", "alpha-stirling"])
def test_builtin_cases_balance(name):
    one = turn(cases.load(name))
    found = loads(one)
    assert power_residual(one, found) < 1e-10
    for pin in found.pins:
        assert np.hypot(radial(pin), tangential(pin)) == pytest.approx(np.hypot(pin.x, pin.y), rel=1e-12)
