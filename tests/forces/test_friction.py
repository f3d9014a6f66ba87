"""Friction by hand where it can be done by hand, the rules for rings, and the comparison at equal stroke."""

import dataclasses
import math

import numpy as np
import pytest

from mechsym import cases, jobs
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
    swept_volume,
)
from mechsym.forces.result import ComparisonSettings, compare
from mechsym.jobs.machine import turn
from mechsym.quantities.results import tell

NOTHING = {"mu_guide": 0.0, "mu_pin": 0.0, "mu_main": 0.0, "mu_mesh": 0.0}
RADII = {"radius_piston_pin": 0.01, "radius_crank_pin": 0.012, "radius_main": 0.013, "module": 1e-3}


def only(**changes):
    return Friction(**(NOTHING | RADII | changes))


FRICTION = cases.load("nunes-slider-crank").need("friction")


@pytest.fixture(scope="module")
def slider():
    return turn(cases.load("nunes-slider-crank"))


@pytest.fixture(scope="module")
def planet():
    return turn(cases.load("nunes-hypocycloid"))


def test_guide_friction_by_hand(slider):
    found = losses(slider, only(mu_guide=0.1), NoRings())
    p = slider.drive.parameters
    lam = (p.r1 + p.r2) / (p.l1 + p.l2)
    xdd = slider.kinematics["d2x_dphi2"] * slider.omega**2
    side = (slider.inputs["F"] - p.m5 * xdd) * np.tan(np.arcsin(lam * np.sin(slider.phi)))
    power = 0.1 * np.abs(side * slider.kinematics["dx_dphi"] * slider.omega)
    assert found.places["guides"] == pytest.approx(power.mean(), rel=1e-10)
    assert sum(found.places.values()) == pytest.approx(found.places["guides"])


def test_bearing_friction_by_hand(planet):
    """Planet and crank turn against each other at twice the speed, planet and rod at once."""
    found = losses(planet, only(mu_pin=0.01, mu_main=0.02), NoRings())
    journal = np.hypot(planet.reactions["journal_force_x"], planet.reactions["journal_force_y"]).mean()
    assert found.places["crank_pins"] == pytest.approx(0.01 * 0.012 * journal * 2 * planet.omega, rel=1e-12)
    pin = np.abs(planet.reactions["pin_force"]).mean()
    assert found.places["piston_pins"] == pytest.approx(0.01 * 0.01 * pin * planet.omega, rel=1e-12)
    assert found.places["main_bearings"] == pytest.approx(0.02 * 0.013 * journal * planet.omega, rel=1e-12)
    assert found.places["guides"] == 0


def test_mesh_friction_is_the_sliding_of_involute_flanks():
    """By quadrature along the path of contact: sliding speed = omega_rel times the distance from the pitch point."""
    friction, alpha = only(mu_mesh=0.06), math.radians(25)
    path = friction.contact_ratio * math.pi * friction.module * math.cos(alpha)
    distance = np.abs(np.linspace(-path / 2, path / 2, 20001))
    wanted = 0.06 * (1000.0 / math.cos(alpha)) * 300.0 * distance.mean()
    assert mesh_power(friction, np.array([1000.0]), 300.0)[0] == pytest.approx(wanted, rel=1e-4)


def test_efficiency_and_mean_pressure_follow_from_the_lost_power(slider):
    found = losses(slider, FRICTION, Patton1989())
    lost = sum(found.places.values())
    assert found.mechanical_efficiency == pytest.approx(1 - lost / found.indicated_power, rel=1e-12)
    per_cycle = lost * 4 * math.pi / slider.omega
    assert found.friction_mean_pressure == pytest.approx(per_cycle / swept_volume(slider), rel=1e-12)
    assert 0.8 < found.mechanical_efficiency < 1


def test_ring_rules(slider):
    room = dataclasses.replace(
        slider.gas.chamber, bore=0.08, stroke=0.08, area=math.pi / 4 * 0.08**2, compression_ratio=9.0
    )
    gas = dataclasses.replace(slider.gas, chamber=room)
    omega = 3000 * math.pi / 30
    tension = 4.06e4 * (1 + 500 / 3000) / 80**2
    loading = 6.89 * (0.088 * 9 + 0.182 * 9 ** (1.33 - 0.0238 * 8))
    assert patton_pressure(Patton1989(), gas, omega) == pytest.approx(1e3 * (tension + loading), rel=1e-12)
    speed = np.abs(np.sin(slider.phi))
    spread = ring_power(Patton1989(), gas, slider.phi, speed, omega)
    work = spread.mean() * gas.pressure.period / omega
    assert work == pytest.approx(
        patton_pressure(Patton1989(), gas, omega) * gas.chamber.area * gas.chamber.stroke, rel=1e-12
    )
    law = ContactPressure(mu=0.1, heights=(2e-3, 2e-3), gas_shares=(0.5, 0.0), elastic=1e5)
    held = dataclasses.replace(gas.pressure, absolute=lambda phi: np.full(np.shape(phi), gas.p_back + 1e6))
    at_rest = dataclasses.replace(gas, pressure=held)
    power = ring_power(law, at_rest, slider.phi, np.ones_like(slider.phi), omega)
    assert power[0] == pytest.approx(0.1 * math.pi * 0.08 * 2e-3 * (1e5 + 1e5 + 5e5), rel=1e-12)


@pytest.fixture(scope="module")
def rows(slider):
    found = compare(slider, FRICTION, NoRings(), ComparisonSettings())
    return {row.mechanism: tell(row) for row in found}


def test_the_compared_machines_have_equal_gas_and_mass(rows, slider):
    assert {row["power_residual"] < 1e-12 for row in rows.values()} == {True}
    one = [row["shaking_order_1"] for row in rows.values() if row["pistons"] == 1]
    assert max(one) == pytest.approx(0.25 * 0.026 * slider.omega**2, rel=1e-6)
    four = rows["rodless, four pistons, crank free radially"]
    assert four["torque_mean"] == pytest.approx(4 * rows["hypocycloid"]["torque_mean"], rel=1e-9)
    base = losses(slider, FRICTION, NoRings())
    # the blow-down is a step at bottom dead centre: the angle that stands there may take either side of it
    assert rows["slider crank"]["friction_per_piston"] == pytest.approx(sum(base.places.values()), rel=1e-4)
    per_piston = [row["torque_mean"] / row["pistons"] for row in rows.values()]
    assert per_piston == pytest.approx([per_piston[0]] * len(rows), rel=1e-3)


def test_no_side_force_has_its_price(rows, planet):
    """The hypocycloid's planet journal carries F_n sqrt(1 + 3 sin^2); the rodless guides more than F_n |sin|."""
    assert rows["hypocycloid"]["side_force_max"] == 0
    assert rows["hypocycloid"]["crank_pin_max"] > rows["slider crank"]["crank_pin_max"]
    for rule in ("crank free radially", "equal stiffnesses"):
        rodless = rows[f"rodless, one piston, {rule}"]
        assert rodless["side_force_max"] > 3 * rows["slider crank"]["side_force_max"]
        assert rodless["friction_per_piston"] > rows["slider crank"]["friction_per_piston"]


def test_guides_of_a_rodless_engine_carry_at_least_the_tangential_part(slider):
    """Whatever the closing rule, X_a cos - X_b sin = F_n sin, so that sqrt(X_a^2 + X_b^2) >= F_n |sin|."""
    case = cases.load("balandin", {"faces.sides": ["a+"], "faces.areas": [5e-3], "faces.firing": [0.0],
                                   "parameters.m_b": 0.0, "parameters.u1": 0.0})  # fmt: skip
    for rule in ({"k_a": 1.0, "k_b": 1.0, "k_c": 1.0}, {"k_a": 1e9, "k_b": 1.0, "k_c": 1e6}):
        closing = dataclasses.replace(case.need("closing"), **rule)
        one = turn(dataclasses.replace(case, sections={**case.sections, "closing": closing}))
        p, R = case.need("parameters"), one.reactions
        net = one.inputs["F_a"] - p.m_a * one.kinematics["d2x_a_dalpha2"] * one.omega**2
        least = np.abs(net * np.sin(one.phi))
        assert R["guide_combination"] == pytest.approx(-net * np.sin(one.phi), abs=1e-8 * least.max())
        assert np.all(np.hypot(R["X_a"], R["X_b"]) >= least * (1 - 1e-12))


def test_a_comparison_needs_gas(slider):
    bare = dataclasses.replace(slider, acting=())
    with pytest.raises(BadInput, match="needs a \\[cycle\\]"):
        compare(bare, None, NoRings(), ComparisonSettings())


def test_a_comparison_needs_a_gas_of_each_cylinder():
    with pytest.raises(BadInput, match="here all pistons share one"):
        jobs.forces(cases.load("alpha-stirling"), comparison=True)
