"""Friction from the frictionless reactions, the comparison of mechanisms, and friction as a law of the cycle."""

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from small_machines import machine, smooth_gas, turn_of

from mechsym.cases.settings import Operation
from mechsym.cycle.gas import at_same_travel
from mechsym.cycle.motion import piston_travel
from mechsym.errors import BadInput
from mechsym.forces.friction import (
    ContactPressure,
    Friction,
    NoRings,
    Patton1989,
    losses,
    mesh_power,
    patton_pressure,
    ring_power,
)
from mechsym.forces.loads import loads
from mechsym.forces.result import ComparisonSettings, compare
from mechsym.mechanisms.closing import RodlessFaces
from mechsym.mechanisms.crosshead import CrossheadParameters
from mechsym.mechanisms.hypocycloid import HypocycloidParameters
from mechsym.mechanisms.rodless import CrankFreeRadially, RodlessParameters
from mechsym.quantities.results import tell

CRANK = CrossheadParameters(r1=0, r2=0.3, l1=0.4, l2=0.5, m1=0, m2=0, m3=3, m4=2, m5=4, I01=2, IC2=0, g=0)
PLANET = HypocycloidParameters(e=0.15, I1=0.1, m2=0, I2=0, m3=9, alpha_n=math.radians(25))
LINK = RodlessParameters(r=0.15, I1=0.1, m_link=0, I_link=0, m_a=9, m_b=0)
FACES = RodlessFaces(sides=("a+",), areas=(math.pi / 4 * 0.04,), firing=(0.0,))
COEFFICIENTS = ("mu_guide", "mu_pin", "mu_main", "mu_mesh")
NONE = Friction(mu_guide=0, mu_pin=0, mu_main=0, mu_mesh=0, radius_piston_pin=0.05, radius_crank_pin=0.06,
                radius_main=0.07, module=0.01)  # fmt: skip
SOME = dataclasses.replace(NONE, mu_guide=0.04, mu_pin=0.01, mu_main=0.008, mu_mesh=0.05)
RINGS = ContactPressure(mu=0.05, heights=(0.004, 0.004), gas_shares=(0.7, 0.2), elastic=1e5)

CASES = {
    "crosshead": machine("crosshead", CRANK),
    "hypocycloid": machine("hypocycloid", PLANET),
    "rodless": machine("rodless", LINK, closing=CrankFreeRadially(), faces=FACES),
}


def lost(name, friction, rings=None):
    one = turn_of(CASES[name], smooth_gas(0.6))
    return one, losses(one, friction, rings or NoRings())


@pytest.mark.parametrize("name", CASES)
def test_without_coefficients_nothing_is_lost(name):
    _, found = lost(name, NONE)
    assert found.mechanical_efficiency == 1
    assert found.friction_mean_pressure == 0


@pytest.mark.slow
@settings(max_examples=15)
@given(st.sampled_from(sorted(CASES)), st.sampled_from(COEFFICIENTS), st.floats(0.001, 0.2))
def test_each_coefficient_costs_in_proportion(name, letter, mu):
    _, base = lost(name, SOME)
    _, more = lost(name, dataclasses.replace(SOME, **{letter: getattr(SOME, letter) + mu}))
    _, alone = lost(name, dataclasses.replace(NONE, **{letter: mu}))
    assert more.mechanical_efficiency <= base.mechanical_efficiency
    absent = (name == "hypocycloid" and letter == "mu_guide") or (name != "hypocycloid" and letter == "mu_mesh")
    assert (more.mechanical_efficiency < base.mechanical_efficiency) != absent
    together = sum(base.places.values()) + sum(alone.places.values())
    assert sum(more.places.values()) == pytest.approx(together, rel=1e-12)


def test_losses_of_a_slider_crank_by_hand():
    one, found = lost("crosshead", SOME, RINGS)
    r, l, w = 0.3, 0.9, one.omega
    s, c = np.sin(one.phi), np.cos(one.phi)
    psi = np.arcsin(r / l * s)
    swing = r / l * c / np.cos(psi) * w
    speed = (r * s + r**2 * s * c / (l * np.cos(psi))) * w
    F = one.inputs["F"] - 9 * one.kinematics["d2x_dphi2"] * w**2
    rod = np.abs(F) / np.cos(psi)
    p = smooth_gas(0.6).pressure.absolute(one.phi) - 1e5
    wanted = {
        "guides": 0.04 * np.abs(F * np.tan(psi) * speed),
        "piston_pins": 0.01 * 0.05 * rod * np.abs(swing),
        "crank_pins": 0.01 * 0.06 * rod * np.abs(w + swing),
        "main_bearings": 0.008 * 0.07 * rod * w,
        "rings": 0.05 * math.pi * 0.2 * 0.004 * (2e5 + 0.9 * p) * np.abs(speed),
    }
    for place, power in wanted.items():
        assert found.curves[place] == pytest.approx(power, rel=1e-9, abs=1e-6), place
    total = sum(power.mean() for power in wanted.values())
    assert found.mechanical_efficiency == pytest.approx(1 - total / (one.torque.mean() * w), rel=1e-12)
    swept = math.pi / 4 * 0.2**2 * 0.6
    assert found.friction_mean_pressure == pytest.approx(total * 2 * math.pi / w / swept, rel=1e-12)


def test_the_planet_turns_twice_as_fast_in_the_crank():
    one, found = lost("hypocycloid", SOME)
    pin, w = loads(one).pins[0], one.omega
    assert found.curves["crank_pins"] == pytest.approx(0.01 * 0.06 * np.hypot(pin.x, pin.y) * 2 * w, rel=1e-12)
    assert found.curves["piston_pins"] == pytest.approx(0.01 * 0.05 * np.abs(one.reactions["pin_force"]) * w, rel=1e-12)


def test_teeth_slide_a_quarter_of_the_path_on_average():
    # points spread evenly over the path of contact, pitch point in its middle
    path = SOME.contact_ratio * math.pi * SOME.module
    distance = np.abs(np.linspace(-path / 2, path / 2, 100_001)).mean()
    assert mesh_power(SOME, np.array([-2000.0]), 30.0)[0] == pytest.approx(0.05 * 2000 * 30 * distance, rel=1e-4)


def test_ring_rules():
    gas, phi = smooth_gas(0.6), np.arange(720) * math.pi / 360
    speed = np.sin(phi)
    assert not ring_power(NoRings(), gas, phi, speed, 20.0).any()
    law = Patton1989()
    power = ring_power(law, gas, phi, speed, 20.0)
    assert power.mean() == pytest.approx(
        patton_pressure(law, gas, 20.0) * gas.chamber.area * gas.chamber.stroke * 20 / (2 * math.pi)
    )
    with pytest.raises(BadInput, match="mu"):
        dataclasses.replace(RINGS, mu=-0.1)


@pytest.mark.parametrize("own", ["crosshead", "hypocycloid"])
@pytest.mark.parametrize("other", ["crosshead", "hypocycloid"])
def test_same_travel_means_same_work(own, other):
    gas, motions = (
        smooth_gas(0.6),
        {name: piston_travel(name, p) for name, p in (("crosshead", CRANK), ("hypocycloid", PLANET))},
    )
    moved = at_same_travel(gas, motions[own], motions[other])
    work = [turn_of(CASES[name], g).torque.mean() for name, g in ((own, gas), (other, moved))]
    assert work[0] == pytest.approx(work[1], rel=1e-5)
    theta = np.linspace(-7, 14, 50)
    if own == other:
        assert moved.pressure.absolute(theta) == pytest.approx(gas.pressure.absolute(theta), rel=1e-7)


def rows(name):
    one = turn_of(CASES[name], smooth_gas(0.6))
    found = compare(one, SOME, RINGS, ComparisonSettings(lam=1 / 3, alpha_n=math.radians(25)))
    return one, {row.mechanism: tell(row) for row in found}


@pytest.mark.parametrize(("name", "row"), [("crosshead", "slider crank"), ("hypocycloid", "hypocycloid"),
                                           ("rodless", "rodless, one piston, crank free radially")])  # fmt: skip
def test_a_case_stands_in_its_own_comparison(name, row):
    one, found = rows(name)
    pin = loads(one).pins[0]
    assert found[row]["crank_pin_max"] == pytest.approx(np.hypot(pin.x, pin.y).max(), rel=1e-6)
    assert found[row]["torque_max"] == pytest.approx(one.torque.max(), rel=1e-6)
    _, own = lost(name, SOME, RINGS)
    assert found[row]["mechanical_efficiency"] == pytest.approx(own.mechanical_efficiency, rel=1e-6)


def test_all_get_the_same_work_and_only_the_slider_crank_has_a_second_order():
    _, found = rows("crosshead")
    work = {row["torque_mean"] / row["pistons"] for row in found.values()}
    assert max(work) / min(work) == pytest.approx(1, rel=1e-5)
    assert found["slider crank"]["shaking_order_2"] > 100
    assert max(row["shaking_order_2"] for name, row in found.items() if name != "slider crank") < 1e-9
    assert found["hypocycloid"]["side_force_max"] == 0
    four = found["rodless, four pistons, crank free radially"]
    assert four["shaking_rms_after_counterweight"] < 1e-9 * four["shaking_order_1"]


def test_friction_as_a_law_of_the_cycle():
    from mechsym.cases import load
    from mechsym.jobs.machine import fitted_law

    case = load("zotov-89")
    case = dataclasses.replace(case, sections={**case.sections, "friction": SOME, "rings": RINGS})
    one_speed = fitted_law(case, [9.0])
    assert one_speed.law.constant == pytest.approx(one_speed.computed[0], rel=1e-12)
    assert one_speed.misfit < 1e-12
    several = fitted_law(case, [6.0, 9.0, 12.0, 15.0])
    assert several.misfit < 0.02
    assert several.computed == pytest.approx(several.fitted, rel=0.02)
    slower = dataclasses.replace(case, sections={**case.sections, "operation": Operation(speed=6.0)})
    from mechsym.jobs.machine import turn

    one = turn(slower)
    wanted = losses(one, SOME, RINGS).friction_mean_pressure
    assert several.computed[0] == pytest.approx(wanted, rel=1e-12)
    none = fitted_law(
        dataclasses.replace(case, sections={**case.sections, "friction": NONE, "rings": NoRings()}), [9.0]
    )
    assert none.law.constant == 0
